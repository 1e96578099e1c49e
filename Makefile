# spectools: spectral image tools. 'make help' lists the targets.

VERSION = 0.1.0
PREFIX = /usr/local
DESTDIR =

CC = gcc
CXX = g++
AR = gcc-ar
CFLAGS = -O3 -g
# libmvec and vectorised row kernels need both; NaN checks must keep working, so
# -ffast-math is never used.
MATHFLAGS = -fno-math-errno -fno-trapping-math -ffp-contract=off
WARNFLAGS = -Wall -Wextra -Wshadow -Wpointer-arith -Wstrict-prototypes -Wvla \
	-Wmissing-prototypes -Wwrite-strings

ifneq ($(SAN),)
comma = ,
BUILD = build/san-$(subst $(comma),-,$(SAN))
SANFLAGS = -fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer
else
BUILD = build
SANFLAGS =
endif

# Rooms in order: one may include only what stands before it.
ROOMS = base cli spectrum colour image compare
TOOLS = $(patsubst cmd/%.c,%,$(wildcard cmd/*.c))
UNITS = $(patsubst tests/unit/%.c,%,$(wildcard tests/unit/*.c))
BENCHES = $(patsubst tests/bench/%.c,%,$(wildcard tests/bench/*.c))
HELPERS = $(patsubst tests/helper/%.c,%,$(wildcard tests/helper/*.c))
PAGES = $(wildcard man/*.[157])

LIBSOURCES = $(foreach room,$(ROOMS),$(wildcard lib/$(room)/*.c))
LIBOBJECTS = $(LIBSOURCES:%.c=$(BUILD)/obj/%.o)
LIBRARY = $(BUILD)/libspectools.a
PLUGIN = $(BUILD)/lib/spectools/pictures.so
PROGRAMS = $(TOOLS:%=$(BUILD)/bin/%)
UNITTESTS = $(UNITS:%=$(BUILD)/tests/%)
BENCHMARKS = $(BENCHES:%=$(BUILD)/tests/bench-%)
TESTHELPERS = $(HELPERS:%=$(BUILD)/tests/%)

# Debian packages that the build, the tests and the demo need beside gcc, make and git.
DEPS = g++ pkg-config libopenexr-dev libdeflate-dev libpng-dev libopenimageio-dev \
	libcmocka-dev bats

# pkg-config's OpenEXR names all the C++ libraries; the C core is one of them.
EXRFLAGS = $(shell pkg-config --cflags OpenEXR)
EXRLIBS = -lOpenEXRCore-3_1
CPPFLAGS = -Ilib -D_GNU_SOURCE -DSPEC_VERSION='"$(VERSION)"'
LDLIBS = $(EXRLIBS) -ldeflate -lpng16 -ldl -pthread -lm
ALLCFLAGS = -std=c11 $(CFLAGS) $(MATHFLAGS) $(WARNFLAGS) $(SANFLAGS) -pthread -fPIC
ALLLDFLAGS = $(SANFLAGS) $(LDFLAGS)

all: $(PROGRAMS) $(PLUGIN) $(BUILD)/share/spectools/spectra

help:
	@echo 'make deps       install what the build and the tests need (apt-get)'
	@echo 'make            build the tools into build/bin'
	@echo 'make demo       make a spectral test card, show it, compare two of its stages'
	@echo 'make check      run every test; SAN=address,undefined runs them under sanitizers'
	@echo 'make bench      measure speed and memory beside peers'
	@echo 'make figures    make the pictures of the gallery'
	@echo 'make lint       clang-format, cppcheck, shellcheck, mandoc'
	@echo 'make fuzz       fuzz the readers for FUZZ_SECONDS seconds (default 600)'
	@echo 'make install    into PREFIX (default /usr/local), below DESTDIR'
	@echo 'make uninstall  take it away again'
	@echo 'make clean      remove build/'

$(BUILD)/obj/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(ALLCFLAGS) $(CPPFLAGS) $(EXRFLAGS) -MMD -MP -c -o $@ $<

$(LIBRARY): $(LIBOBJECTS)
	@rm -f $@
	$(AR) rcs $@ $(LIBOBJECTS)

$(BUILD)/bin/%: $(BUILD)/obj/cmd/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(CC) $(ALLLDFLAGS) -o $@ $^ $(LDLIBS)

# OpenImageIO costs 0.2 s at every start: it is loaded only when it is needed.
$(PLUGIN): lib/image/pictures.cpp lib/image/pictures.h
	@mkdir -p $(@D)
	$(CXX) -std=c++17 -O2 -g -Wall -Wextra -fPIC -shared $(SANFLAGS) $(CPPFLAGS) \
		$(shell pkg-config --cflags OpenImageIO) $(LDFLAGS) -o $@ $< \
		$(shell pkg-config --libs OpenImageIO)

# The tools find their data and plugin beside themselves, here as when installed.
$(BUILD)/share/spectools/spectra:
	@mkdir -p $(@D)
	ln -sfn $(CURDIR)/spectra $@

$(BUILD)/tests/bench-%: $(BUILD)/obj/tests/bench/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(CC) $(ALLLDFLAGS) -o $@ $^ $(LDLIBS)

$(UNITTESTS): $(BUILD)/tests/%: $(BUILD)/obj/tests/unit/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(CC) $(ALLLDFLAGS) -o $@ $^ $(LDLIBS) -lcmocka

$(TESTHELPERS): $(BUILD)/tests/%: $(BUILD)/obj/tests/helper/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(CC) $(ALLLDFLAGS) -o $@ $^ $(LDLIBS)

unit: $(UNITTESTS) $(BUILD)/share/spectools/spectra
	@for test in $(UNITTESTS); do $$test || exit 1; done

clean:
	rm -rf build

-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)

.PHONY: all help unit clean
.SECONDARY:
.DELETE_ON_ERROR:
