# The gallery. A row of it is a script, which tests/figures/row runs; its header says how one is
# written. A row is made again when a program, a spectrum, its script or the runner has changed, or
# when one of its checks failed (status 1: the others are made nevertheless). 'make check' runs
# the rows too; both together take turns.

ROWS = $(patsubst tests/figures/%.sh,%,$(wildcard tests/figures/*.sh))
FIGURES += $(ROWS:%=$(BUILD)/figures/%/row.txt)

$(BUILD)/figures/%/row.txt: tests/figures/%.sh tests/figures/row tests/figures/measure.bash \
		$(wildcard tests/figures/*.awk tests/figures/*.pbrt) $(PROGRAMS) $(TESTHELPERS) $(SPECTRA) | \
		$(DATA) $(PLUGIN) $(PLACES) $(filter check,$(MAKECMDGOALS))
	$(SAY) row $*
	$(QUIET)tests/figures/row $(BUILD) $* >/dev/null || [ $$? = 1 ]
