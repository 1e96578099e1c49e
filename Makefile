# spectools: spectral image tools. 'make help' lists the targets.

VERSION = 0.1.0
PREFIX = /usr/local
DESTDIR =

CC = gcc
CXX = g++
AR = gcc-ar
CFLAGS = -O3 -g
CXXFLAGS = -O2 -g
# libmvec and vectorised row kernels need both; NaN checks must keep working, so
# -ffast-math is never used.
MATHFLAGS = -fno-math-errno -fno-trapping-math -ffp-contract=off
WARNFLAGS = -Wall -Wextra -Wshadow -Wpointer-arith -Wvla -Wwrite-strings
CWARNFLAGS = -Wstrict-prototypes -Wmissing-prototypes

# 'make SAN=address,undefined TARGET' builds beside the ordinary build, in a folder of its own.
ifneq ($(SAN),)
comma = ,
BUILD = build/san-$(subst $(comma),-,$(SAN))
SANFLAGS = -fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer
else
BUILD = build
SANFLAGS =
endif

# Debian packages that the build, the tests and the demo need beside gcc, make and git, and
# those that only lint, bench and fuzz need.
DEPS = g++ pkg-config libopenexr-dev libdeflate-dev libpng-dev liblcms2-dev libopenimageio-dev \
	libembree-dev libcairo2-dev libfontconfig-dev libgeographiclib-dev liberfa-dev libcmocka-dev \
	bats openexr openimageio-tools mandoc jq
LINTDEPS = clang-format clang-tidy cppcheck shellcheck mandoc
BENCHDEPS = openimageio-tools
FUZZDEPS = clang libclang-rt-14-dev

TOOLS = $(patsubst cmd/%.c,%,$(wildcard cmd/*.c))
UNITS = $(patsubst tests/unit/%.c,%,$(wildcard tests/unit/*.c))
BENCHES = $(patsubst tests/bench/%.c,%,$(wildcard tests/bench/*.c))
HELPERS = $(patsubst tests/helper/%.c,%,$(wildcard tests/helper/*.c))
PAGES = $(wildcard man/*.[157])
SPECTRA = $(shell find spectra -name '*.spd')

PLOTSOURCES = $(patsubst %,lib/image/plot%.c,surface spectra diagram)
LIBSOURCES = $(filter-out $(PLOTSOURCES),$(wildcard lib/*/*.c))
LIBOBJECTS = $(LIBSOURCES:%.c=$(BUILD)/obj/%.o)
LIBRARY = $(BUILD)/libspectools.a
PLUGIN = $(BUILD)/lib/spectools/pictures.so
PLOTS = $(BUILD)/lib/spectools/plots.so
PLACES = $(BUILD)/lib/spectools/places.so
DATA = $(BUILD)/share/spectools/spectra
TABLE = $(BUILD)/share/spectools/upsampling/srgb.sigmoids
PROGRAMS = $(TOOLS:%=$(BUILD)/bin/%)
UNITTESTS = $(UNITS:%=$(BUILD)/tests/%)
BENCHMARKS = $(BENCHES:%=$(BUILD)/tests/bench-%)
TESTHELPERS = $(HELPERS:%=$(BUILD)/tests/%)
FIGURES =

# pkg-config is asked inside recipes alone: 'make deps check' installs it on the way.
# Its OpenEXR names all the C++ libraries; the C core is one of them.
EXRFLAGS = $(shell pkg-config --cflags OpenEXR)
EXRLIBS = -lOpenEXRCore-3_1
OIIOFLAGS = $(shell pkg-config --cflags OpenImageIO)
CAIROFLAGS = $(shell pkg-config --cflags cairo fontconfig)
CAIROLIBS = $(shell pkg-config --libs cairo fontconfig)
OIIOLIBS = $(shell pkg-config --libs OpenImageIO)
PLACELIBS = $(shell pkg-config --libs geographiclib)
CPPFLAGS = -Ilib -D_GNU_SOURCE -DSPEC_VERSION='"$(VERSION)"'
LDLIBS = $(EXRLIBS) -ldeflate -lpng16 -Wl,--as-needed -llcms2 -lerfa -Wl,--no-as-needed -ldl \
	-pthread -lm
# Paths go to and fro between files at every surface. clang's would need another AR and ld.
PATHFLAGS = $(if $(filter gcc%,$(CC)),-flto=auto)
ALLCFLAGS = -std=c11 $(CFLAGS) $(MATHFLAGS) $(WARNFLAGS) $(CWARNFLAGS) $(SANFLAGS) -pthread -fPIC
ALLCXXFLAGS = -std=c++17 $(CXXFLAGS) $(MATHFLAGS) $(WARNFLAGS) $(SANFLAGS) -pthread -fPIC
ALLLDFLAGS = $(SANFLAGS) $(LDFLAGS)

# 'make V=1' shows the commands whole.
ifeq ($(V),)
QUIET = @
SAY = @printf '  %-4s %s\n'
else
SAY = @:
endif

# Where packages are installed in the same run, that comes before anything is compiled or run.
READY = $(filter deps %-deps,$(MAKECMDGOALS))
ifneq ($(filter clean,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif

all: $(PROGRAMS) $(PLUGIN) $(PLOTS) $(PLACES) $(DATA) $(TABLE)

help:
	@echo 'make deps       install what the build and the tests need (apt-get)'
	@echo 'make            build the tools into build/bin'
	@echo 'make demo       render a soap bubble and a test card, show them, compare'
	@echo 'make check      run every test; SAN=address,undefined runs them under sanitizers'
	@echo 'make unit       run the unit tests alone'
	@echo 'make bench      measure speed and memory beside peers; bench-deps installs the peers'
	@echo 'make figures    make the gallery, build/figures/index.html, and see what it checks'
	@echo 'make lint-deps  install what make lint needs (apt-get)'
	@echo 'make lint       clang-format, cppcheck, clang-tidy, shellcheck, mandoc'
	@echo 'make fuzz       fuzz the readers for FUZZ_SECONDS seconds (default 600); fuzz-deps'
	@echo '                installs what that needs'
	@echo 'make install    into PREFIX (default /usr/local), below DESTDIR'
	@echo 'make uninstall  take it away again'
	@echo 'make clean      remove build/; V=1 with any target shows the commands whole'

# Building. Two files record what the rest was made with: after other flags everything is
# compiled anew, after another list of objects the library is made anew.

FLAGS = $(CC) $(CXX) $(AR) $(ALLCFLAGS) $(PATHFLAGS) $(ALLCXXFLAGS) $(CPPFLAGS) $(ALLLDFLAGS) \
	$(LDLIBS)
ifneq ($(strip $(file <$(BUILD)/flags)),$(strip $(FLAGS)))
$(BUILD)/flags: FORCE
endif
ifneq ($(strip $(file <$(BUILD)/objects)),$(strip $(LIBOBJECTS)))
$(BUILD)/objects: FORCE
endif
$(BUILD)/flags: RECORD = $(FLAGS)
$(BUILD)/objects: RECORD = $(LIBOBJECTS)
$(BUILD)/flags $(BUILD)/objects:
	@mkdir -p $(@D)
	@printf '%s\n' '$(subst ','\'',$(RECORD))' >$@

$(BUILD)/obj/%.o: %.c $(BUILD)/flags | $(READY)
	@mkdir -p $(@D)
	$(SAY) cc $<
	$(QUIET)$(CC) $(ALLCFLAGS) $(CPPFLAGS) $(EXRFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/obj/%.o: %.cpp $(BUILD)/flags | $(READY)
	@mkdir -p $(@D)
	$(SAY) c++ $<
	$(QUIET)$(CXX) $(ALLCXXFLAGS) $(CPPFLAGS) $(OIIOFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/obj/lib/render/%.o: private CFLAGS += $(PATHFLAGS)

$(LIBRARY): $(LIBOBJECTS) $(BUILD)/objects
	@rm -f $@
	$(SAY) ar $@
	$(QUIET)$(AR) qcs $@ $(LIBOBJECTS)

# OpenImageIO costs 0.2 s at every start: it is loaded only when it is needed.
$(PLUGIN): $(addprefix $(BUILD)/obj/lib/image/,pictures.o pictureinput.o)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CXX) $(ALLLDFLAGS) -shared -o $@ $^ $(OIIOLIBS)

# cairo costs 4 ms at every start.
$(PLOTS): EXRFLAGS = $(CAIROFLAGS)
$(PLOTS): $(PLOTSOURCES:%.c=$(BUILD)/obj/%.o)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) $(ALLLDFLAGS) -shared -o $@ $^ $(CAIROLIBS) -lm

# GeographicLib is C++.
$(PLACES): $(BUILD)/obj/lib/place/places.o
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CXX) $(ALLLDFLAGS) -shared -o $@ $^ $(PLACELIBS)

# The tools find their data and plugins beside themselves, here as when installed.
$(DATA):
	@mkdir -p $(@D)
	ln -sfn $(CURDIR)/spectra $@

# The table of spectra for RGB colours is made again when what makes it changes, not with
# whatever else is in the library. Sanitizers take a minute for it, and seconds for half its side.
TABLEPARTS = $(wildcard lib/colour/make/sigmoids.c $(foreach part,colour/sigmoids \
	colour/upsample colour/difference colour/observer colour/space spectrum/sigmoid, \
	lib/$(part).c lib/$(part).h)) spectra/cmf/cie1931.spd spectra/illuminants/D65.spd

$(BUILD)/make/sigmoids: $(BUILD)/obj/lib/colour/make/sigmoids.o $(LIBRARY)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(LINK)

$(TABLE): $(TABLEPARTS) $(BUILD)/flags | $(BUILD)/make/sigmoids $(DATA)
	@mkdir -p $(@D)
	$(SAY) fit $@
	$(QUIET)SPECTRA_PATH= $(BUILD)/make/sigmoids $@ $(if $(SAN),32)

# What traces rays alone needs Embree, which costs every other program's start.
TRACERS = bin/specrender $(addprefix tests/,render material light sampler world outdoors)
$(TRACERS:%=$(BUILD)/%): LDLIBS += -lembree3

LINK = $(QUIET)$(CC) $(ALLLDFLAGS) -o $@ $^ $(LDLIBS)

$(PROGRAMS): $(BUILD)/bin/%: $(BUILD)/obj/cmd/%.o $(BUILD)/obj/cmd/all/tool.o $(LIBRARY)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(LINK)

$(UNITTESTS): $(BUILD)/tests/%: $(BUILD)/obj/tests/unit/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(LINK) -lcmocka

$(BENCHMARKS): $(BUILD)/tests/bench-%: $(BUILD)/obj/tests/bench/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(LINK)

$(TESTHELPERS): $(BUILD)/tests/%: $(BUILD)/obj/tests/helper/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(LINK)

# Running.

check: all $(UNITTESTS) $(TESTHELPERS) $(BUILD)/tests/faults.so
	@tests/check $(BUILD) faults bats pages figures rooms unit

unit: $(UNITTESTS) $(PLUGIN) $(PLACES) $(DATA) $(TABLE)
	@tests/check $(BUILD) unit

demo: all
	@tests/demo $(BUILD)

bench: all $(BENCHMARKS) $(TESTHELPERS)
	@tests/bench/run $(BUILD)

# A fragment adds its pictures to FIGURES and says how each is made.
-include $(wildcard tests/figures/*.mk) tests/fuzz/fuzz.mk tests/faults/faults.mk
figures: all $(FIGURES)
	@tests/figures/gallery $(BUILD) >$(BUILD)/figures/index.html

# Looking at the source; each step stands alone, and lint is all of them.

LINTS = lint-format lint-cppcheck lint-tidy lint-shell lint-man
CODE = $(wildcard cmd/*.c cmd/all/*.[ch] lib/*/*.[ch] lib/*/*/*.c lib/*/*.cpp tests/*/*.[ch])
SCRIPTS = $(shell grep -slE '^\#!.*(bash|bats)' .ci/* tests/* tests/*/*) $(wildcard tests/*/*.bash tests/figures/*.sh)

lint: $(LINTS)

lint-format: | $(READY)
	clang-format --dry-run -Werror $(CODE)

lint-cppcheck: | $(READY)
	cppcheck -q --std=c11 --enable=warning,performance,portability --inline-suppr \
		--error-exitcode=1 -Ilib $(filter-out %.h,$(CODE))

# Besides findings clang-tidy only counts, and clang 14 does not know every CPU feature's name.
lint-tidy: | $(READY)
	@echo clang-tidy $(filter %.c,$(CODE))
	@! printf '%s\n' $(filter %.c,$(CODE)) | xargs -P 2 -I FILE clang-tidy --quiet FILE -- \
		-std=c11 $(CPPFLAGS) $(EXRFLAGS) $(CAIROFLAGS) '-D__builtin_cpu_supports(name)=1' 2>&1 | \
		grep -vE '^[0-9]+ warnings?( and [0-9]+ errors?)? generated\.$$'

# bats sets $stderr, and a test of a pipe begins with cat.
lint-shell: | $(READY)
	shellcheck -e SC2154,SC2002 $(SCRIPTS)

lint-man: | $(READY)
	mandoc -Tlint -W warning $(PAGES)
	@# There groff takes An for a macro, and loses the rest of the page.
	! grep -n '^\.%[A-Z] An ' $(PAGES)

# Installing. Below build/ everything but the pages already lies as it will be installed.

FILES = $(TOOLS:%=bin/%) $(patsubst %,lib/spectools/%.so,pictures plots places) \
	$(SPECTRA:%=share/spectools/%) \
	$(TABLE:$(BUILD)/%=%)
MANUAL = $(foreach page,$(PAGES),share/man/man$(subst .,,$(suffix $(page)))/$(notdir $(page)))
TO = $(DESTDIR)$(PREFIX)

install: all
	@for file in $(FILES); do \
		case $$file in bin/*) mode=755 ;; *) mode=644 ;; esac; \
		install -D -m $$mode "$(BUILD)/$$file" "$(TO)/$$file" || exit 1; \
	done
	@for file in $(MANUAL); do \
		install -D -m 644 "man/$${file##*/}" "$(TO)/$$file" || exit 1; \
	done

uninstall:
	@for file in $(FILES) $(MANUAL); do rm -f "$(TO)/$$file" || exit 1; done
	@for folder in lib/spectools share/spectools; do \
		[ ! -d "$(TO)/$$folder" ] || find "$(TO)/$$folder" -depth -type d -empty -delete; \
	done

# Packages: nothing is fetched when all are there.

deps: PACKAGES = $(DEPS)
lint-deps: PACKAGES = $(LINTDEPS)
bench-deps: PACKAGES = $(BENCHDEPS)
fuzz-deps: PACKAGES = $(FUZZDEPS)
lint-deps bench-deps fuzz-deps: | $(filter deps,$(MAKECMDGOALS))
deps lint-deps bench-deps fuzz-deps:
	@there=$$(dpkg-query -W -f '$${db:Status-Status} $${Package}\n' $(PACKAGES) 2>/dev/null | \
		grep '^installed ' | sort -u | wc -l); \
	[ "$$there" -lt $(words $(PACKAGES)) ] || exit 0; \
	sudo=; [ "$$(id -u)" = 0 ] || sudo=sudo; \
	apt="$$sudo env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300"; \
	command -v apt-get >/dev/null && command -v $${sudo:-env} >/dev/null && \
		{ $$apt update; $$apt install --no-install-recommends $(PACKAGES); } || \
	{ printf '%s\n' 'make $@: unable to install with apt-get; these packages are needed:' \
		'$(PACKAGES)' >&2; exit 1; }

clean:
	rm -rf build

-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)

.PHONY: all help check unit demo bench figures fuzz lint $(LINTS) install uninstall deps \
	lint-deps bench-deps fuzz-deps clean FORCE
.SECONDARY:
.DELETE_ON_ERROR:
