# make fuzz: every target under libFuzzer, ASan and UBSan, FUZZ_SECONDS in all, of which
# the readers of images get two thirds. What is found lies in $(BUILD)/fuzz/found, and the corpus
# stays in $(BUILD)/fuzz/corpus for the next time. Needs clang (Debian: clang
# libclang-rt-14-dev); one target alone: make fuzz FUZZERS=reader.

FUZZCC = clang
FUZZ_SECONDS = 600
FUZZERS = reader formats spd names recipe expression scene place
# clang 14 does not know the name of F16C.
FUZZFLAGS = -std=c11 -g -O1 -Wall -Wextra -fno-omit-frame-pointer -pthread \
	-fsanitize=address,undefined -fno-sanitize-recover=all \
	'-D__builtin_cpu_supports(name)=1'
FUZZSHARE_reader = 43
FUZZSHARE_formats = 20
FUZZSHARE_spd = 10
FUZZSHARE_names = 5
FUZZSHARE_recipe = 5
FUZZSHARE_expression = 5
FUZZSHARE_scene = 10
FUZZSHARE_place = 2

FUZZOBJECTS = $(LIBSOURCES:%.c=$(BUILD)/fuzz/obj/%.o)
FUZZPROGRAMS = $(FUZZERS:%=$(BUILD)/fuzz/fuzz-%)

$(BUILD)/fuzz/obj/%.o: %.c
	@mkdir -p $(@D)
	$(FUZZCC) $(FUZZFLAGS) -fsanitize=fuzzer-no-link $(CPPFLAGS) $(EXRFLAGS) -MMD -MP \
		-c -o $@ $<

$(BUILD)/fuzz/libspectools.a: $(FUZZOBJECTS)
	@rm -f $@
	$(AR) rcs $@ $^

$(FUZZPROGRAMS): $(BUILD)/fuzz/fuzz-%: $(BUILD)/fuzz/obj/tests/fuzz/%.o \
		$(BUILD)/fuzz/libspectools.a
	$(FUZZCC) $(FUZZFLAGS) -fsanitize=fuzzer -o $@ $^ $(LDLIBS)

$(BUILD)/fuzz/seeds: tests/fuzz/seed $(BUILD)/tests/synthesize $(BUILD)/bin/specconvert \
		$(BUILD)/bin/spec2rgb $(PLUGIN) $(DATA)
	@rm -rf $@
	tests/fuzz/seed $(abspath $(BUILD)) $(abspath $@)

# libFuzzer's exit status is not 0 when it found something. OpenEXRCore 3.1 leaks the
# texts of headers that it refuses; that is not counted.
fuzz: $(FUZZPROGRAMS) $(BUILD)/fuzz/seeds
	@for name in $(foreach name,$(FUZZERS),$(name):$(FUZZSHARE_$(name))); do \
		share=$${name#*:}; name=$${name%:*}; at=$(BUILD)/fuzz; \
		mkdir -p $$at/corpus/$$name $$at/found && \
			echo leak:libOpenEXRCore >$$at/leaks || exit 2; \
		echo "fuzzing $$name for $$(($(FUZZ_SECONDS) * share / 100 + 1)) s"; \
		LSAN_OPTIONS=suppressions=$$at/leaks:print_suppressions=0 \
		$$at/fuzz-$$name -max_total_time=$$(($(FUZZ_SECONDS) * share / 100 + 1)) \
			-timeout=20 -rss_limit_mb=1024 -max_len=131072 -verbosity=0 \
			-print_final_stats=1 -artifact_prefix=$$at/found/$$name- \
			$$at/corpus/$$name $$at/seeds/$$name || exit 1; \
	done

-include $(shell find $(BUILD)/fuzz/obj -name '*.d' 2>/dev/null)

.PHONY: fuzz
