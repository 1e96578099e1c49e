# The README's pictures: a ColorChecker in daylight and in the light of a bulb.

CARD = $(BUILD)/figures/card
FIGURES += $(CARD)-D65.png $(CARD)-A.png
PATCHES = $(sort $(wildcard spectra/reflectance/colorchecker/*.spd))

$(CARD).exr: $(BUILD)/bin/specconvert $(PATCHES)
	@mkdir -p $(@D)
	$< --patches 6x4 --patch 96 --gap 12 --grid 380:780:5 $(PATCHES) -o $@

$(CARD)-%.png: $(CARD).exr $(BUILD)/bin/spec2rgb spectra/illuminants/%.spd | $(DATA)
	$(BUILD)/bin/spec2rgb $< --illuminant $* -o $@
