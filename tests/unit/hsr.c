/* Radiance's spectral pictures against bytes and headers that are put together here. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/hsr.h"

#include "readback.h"

static struct spec_settings settings;

static int
set_up(void **state)
{
	(void)state;
	spec_settings_init(&settings);
	return scratch_make("hsr");
}

#define START "#?RADIANCE\n"
#define SPECTRA "NCOMP=4\nWAVELENGTH_SPLITS= 780 588 480 380\nFORMAT=Radiance_spectra\n"

/* Four bands of 100 nm in two pixels; the file begins with the longest wavelength. */
static const unsigned char pixels[] = {
	0x80, 0xff, 0x01, 0x00, 128, /* exponent 2^0: n + 1/2 stands for (n + 1/2) / 256 */
	0x40, 0x41, 0xa0, 0x42, 131, /* 2^3 */
	7, 8, 9, 10, 0,              /* black, whatever it says */
	200, 0, 0, 0, 40             /* 2^-88 */
};

static void
save_picture(const char *name, const char *header, const char *size)
{
	char text[512];
	int length = snprintf(text, sizeof text, "%s\n%s\n", header, size);

	memcpy(text + length, pixels, sizeof pixels);
	save(name, text, (size_t)length + sizeof pixels);
}

/* A byte is the middle of what was cut to it, and the whole range of 400 nm is as bright. */
static void
bytes_are_radiances(void **state)
{
	struct readback back;
	double edge_nm = 380;

	(void)state;
	save_picture("a.hsr", START SPECTRA, "-Y 2 +X 2");
	reads(&back, "a.hsr", &settings);
	assert_int_equal(back.image->bands, 4);
	assert_int_equal(back.image->role, SPEC_ROLE_EMISSIVE);
	for (size_t band = 0; band < 4; band++, edge_nm += 100) {
		near(back.image->wavelength_nm[band], edge_nm + 50, 1e-9, "a wavelength");
		near(back.image->edges_nm[band], edge_nm, 1e-9, "an edge");
		near(back.image->edges_nm[band + 1], edge_nm + 100, 1e-9, "an edge");
		/* 1e-7: a float's rounding, half a unit in the last place of 24 bits */
		for (int i = 0; i < 4; i++) {
			static const double power[] = {1 / 256., 8 / 256., 0, 0x1p-96};
			double wanted =
				(pixels[5 * i + 3 - (int)band] + .5) * power[i] / 400;

			near(readback_at(&back, band, i % 2, i / 2), wanted, 1e-7 * wanted,
				"a radiance");
		}
	}
	readback_close(&back);
}

static void
an_exposure_is_divided_out(void **state)
{
	struct readback back;

	(void)state;
	save_picture("a.hsr",
		START "rpict -x 2 scene.oct\nEXPOSURE=4\n\tEXPOSURE=100\nPIXASPECT=0.5\n"
		      "EXPOSURE= .5\nVIEW= -vtv\n" SPECTRA,
		"-Y 2 +X 2");
	reads(&back, "a.hsr", &settings);
	/* Their product counts; indented lines are of pictures that went into this one. */
	near(readback_at(&back, 3, 0, 0), 128.5 / 256 / 400 / 2, 1e-10, "a radiance");
	near(back.image->pixel_aspect_ratio, 2, 0, "the aspect");
	{
		const struct spec_attribute *kept =
			spec_image_attribute(back.image, "radiance:header");

		assert_non_null(kept);
		assert_int_equal(kept->size, strlen("rpict -x 2 scene.oct\n\tEXPOSURE=100\n"
						    "VIEW= -vtv\n"));
		assert_memory_equal(kept->value,
			"rpict -x 2 scene.oct\n\tEXPOSURE=100\nVIEW= -vtv\n", kept->size);
	}
	readback_close(&back);
}

static void
both_names_and_any_file_name(void **state)
{
	struct readback back;

	(void)state;
	save_picture("a.hsr",
		START "NCOMP=4\nWAVELENGTH_SPLITS=780 600 500 380\n"
		      "FORMAT=Radiance_rle_spectra\n",
		"-Y 1 +X 4");
	reads(&back, "a.hsr", &settings);
	assert_int_equal(back.image->data.x1, 4);
	readback_close(&back);
	save_picture("picture.other", START SPECTRA, "-Y 4 +X 1");
	reads(&back, "picture.other", &settings);
	assert_int_equal(back.image->data.y1, 4);
	readback_close(&back);
}

static void
bad_headers_are_refused(void **state)
{
	static const struct {
		const char *header, *size, *part;
		enum spec_status status;
	} cases[] = {{START "NCOMP=4\nWAVELENGTH_SPLITS=780 588 480 380\n", "-Y 2 +X 2",
			     "has no FORMAT=", SPEC_EFORMAT},
		{START "FORMAT=32-bit_rle_rgbe\n", "-Y 2 +X 2", "which has no spectra",
			SPEC_EUNSUPPORTED},
		{START "FORMAT=Radiance_spectra\nNCOMP=4\n", "-Y 2 +X 2",
			"has no WAVELENGTH_SPLITS=", SPEC_EFORMAT},
		{START "FORMAT=Radiance_spectra\nWAVELENGTH_SPLITS=780 588 480 380\n",
			"-Y 2 +X 2", "has no NCOMP=", SPEC_EFORMAT},
		{START "NCOMP=3\n", "-Y 2 +X 2", "is no number of bands", SPEC_EFORMAT},
		{START "WAVELENGTH_SPLITS=780 588 480\n", "-Y 2 +X 2",
			"are not four wavelengths", SPEC_EFORMAT},
		{START "NCOMP=4\nFORMAT=Radiance_spectra\nWAVELENGTH_SPLITS=380 480 588 780\n",
			"-Y 2 +X 2", "do not go down", SPEC_EFORMAT},
		{START "EXPOSURE=0\n", "-Y 2 +X 2", "is no exposure", SPEC_EFORMAT},
		{START SPECTRA, "+Y 2 +X 2", "do not go from left to right",
			SPEC_EUNSUPPORTED},
		{START SPECTRA, "+X 2 -Y 2", "do not go from left to right",
			SPEC_EUNSUPPORTED},
		{START SPECTRA, "-Y 2 +X", "do not go", SPEC_EUNSUPPORTED},
		{START SPECTRA, "2 2", "is no size of a picture", SPEC_EFORMAT},
		{START SPECTRA, "-Y 0 +X 2", "has no pixel", SPEC_ERANGE},
		{START SPECTRA, "-Y 2000000000 +X 2000000000", "(--limit pixels=N)",
			SPEC_ERANGE},
		{START SPECTRA, "-Y 3 +X 2", "ends early, in line 2 of 0..2",
			SPEC_EFORMAT}};
	struct spec_settings small = settings;

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		save_picture("a.hsr", cases[i].header, cases[i].size);
		refuses("a.hsr", &settings, cases[i].status, cases[i].part);
	}
	save_text("a.hsr", START SPECTRA);
	refuses("a.hsr", &settings, SPEC_EFORMAT, "the header is cut short");
	small.limits.channels = 3;
	save_picture("a.hsr", START SPECTRA, "-Y 2 +X 2");
	refuses("a.hsr", &small, SPEC_ERANGE, "(--limit channels=N)");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(bytes_are_radiances),
		cmocka_unit_test(an_exposure_is_divided_out),
		cmocka_unit_test(both_names_and_any_file_name),
		cmocka_unit_test(bad_headers_are_refused),
	};

	return cmocka_run_group_tests(tests, set_up, scratch_remove);
}
