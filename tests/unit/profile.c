/* Profiles, read back by lcms2: the colours that it finds are those of the space. */
#include <lcms2.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/profile.h"

#include "check.h"

/* ICC.1:2010, 7.2.16: the connection space's white. */
static const double d50[3] = {.9642, 1, .8249};

/* The colour by the space's matrix and Bradford, of encoded components. */
static void
find_wanted(const struct spec_space *space, const struct spec_transfer *transfer,
	const double encoded[3], double xyz[3])
{
	double m[9], adaptation[9], white[3];

	for (int i = 0; i < 3; i++)
		xyz[i] = spec_transfer_decode(transfer, encoded[i]);
	assert_int_equal(spec_space_to_xyz(space, m, NULL), SPEC_OK);
	spec_white_xyz(space->white_xy, white);
	assert_int_equal(spec_adaptation_matrix(
				 SPEC_ADAPTATION_BRADFORD, white, d50, adaptation, NULL),
		SPEC_OK);
	spec_matrix_apply(m, xyz, xyz);
	spec_matrix_apply(adaptation, xyz, xyz);
}

static void
check_profile(const struct spec_space *space, const struct spec_transfer *transfer,
	const char *suffix)
{
	static const double colours[][3] = {
		{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.5, .25, .75}, {.01, .02, .9}};
	struct spec_error error;
	unsigned char *bytes, *again;
	size_t size, size_again;
	char title[100] = "", name[100];
	struct tm made;
	double got[3], wanted[3];
	cmsHPROFILE profile, xyz;
	cmsHTRANSFORM transform;

	assert_int_equal(
		spec_profile_make(space, transfer, &bytes, &size, &error), SPEC_OK);
	assert_int_equal(
		spec_profile_make(space, transfer, &again, &size_again, &error), SPEC_OK);
	assert_int_equal(size, size_again);
	assert_memory_equal(bytes, again, size);
	profile = cmsOpenProfileFromMem(bytes, (cmsUInt32Number)size);
	assert_non_null(profile);
	assert_true(cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", title,
			    sizeof title) > 0);
	snprintf(name, sizeof name, "%s%s%s", space->title, suffix ? ", " : "",
		suffix ? suffix : "");
	assert_string_equal(title, name);
	/* Not that of today. */
	assert_true(cmsGetHeaderCreationDateTime(profile, &made));
	assert_true(made.tm_year == 126 && made.tm_mon == 0 && made.tm_mday == 1);
	xyz = cmsCreateXYZProfile();
	transform = cmsCreateTransform(profile, TYPE_RGB_DBL, xyz, TYPE_XYZ_DBL,
		INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE | cmsFLAGS_NOCACHE);
	assert_non_null(transform);
	for (size_t i = 0; i < COUNT(colours); i++) {
		find_wanted(space, transfer ? transfer : &spec_transfer_linear, colours[i],
			wanted);
		cmsDoTransform(transform, colours[i], got, 1);
		/* The file's numbers have steps of 2^-16; three of them add up. */
		for (int c = 0; c < 3; c++)
			near(got[c], wanted[c], 6e-5, space->name);
	}
	cmsDeleteTransform(transform);
	cmsCloseProfile(xyz);
	cmsCloseProfile(profile);
	free(bytes);
	free(again);
}

static void
test_spaces(void **state)
{
	struct spec_space space;

	(void)state;
	for (size_t i = 0; spec_space_at(i); i++) {
		if (spec_space_at(i)->coordinates != SPEC_COORDINATES_RGB)
			continue;
		check_profile(spec_space_at(i), spec_space_at(i)->transfer, NULL);
		check_profile(spec_space_at(i), NULL,
			spec_space_at(i)->transfer == &spec_transfer_linear ? NULL
									    : "linear");
	}
	assert_int_equal(
		spec_space_parse("0.7,0.29 0.2,0.75 0.14,0.05 0.31,0.33", &space, NULL),
		SPEC_OK);
	check_profile(&space, &spec_transfer_srgb, NULL);
	check_profile(&space, &spec_transfer_adobe, "adobe");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(test_spaces)};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
