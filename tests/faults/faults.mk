# The shim for LD_PRELOAD that tests/faults/run loads into the tools. It is never built with
# a sanitizer, whose functions it puts itself before.

FAULTSHIM = $(BUILD)/tests/faults.so

$(FAULTSHIM): tests/faults/faults.c | $(READY)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) -std=c11 -O2 -g $(WARNFLAGS) $(CWARNFLAGS) -D_GNU_SOURCE -fPIC -fno-builtin \
		-pthread -shared -o $@ $< -ldl
