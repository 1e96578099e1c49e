/* Dispersion formulas and refractive indices, against published values. */
#include <stdlib.h>
#include <string.h>

#include <math.h>
#include <stdio.h>

#include "optics/dispersion.h"
#include "optics/index.h"

#include "files.h"

/* Formulas */

static const struct material {
	const char *name;
	struct spec_dispersion dispersion;
} materials[] = {
	/* SCHOTT's catalogue of 2017; F5 is the default glass of T, appendix A. */
	{"F5", {SPEC_DISPERSION_SELLMEIER,
		       {1.3104463, .00958633048, .19603426, .0457627627, .96612977,
			       115.011883},
		       6}},
	{"N-BK7", {SPEC_DISPERSION_SELLMEIER,
			  {1.03961212, .00600069867, .231792344, .0200179144, 1.01046945,
				  103.560653},
			  6}},
	{"SF10", {SPEC_DISPERSION_SELLMEIER,
			 {1.61625977, .0127534559, .259229334, .0581983954, 1.07762317,
				 116.60768},
			 6}},
	{"SF11", {SPEC_DISPERSION_SELLMEIER,
			 {1.73848403, .0136068604, .311168974, .0615960463, 1.17490871,
				 121.922711},
			 6}},
	{"SF66", {SPEC_DISPERSION_SELLMEIER,
			 {2.07842233, .0180875134, .407120032, .0679493572, 1.76711292,
				 215.266127},
			 6}},
	/* The others: the sources that their files in spectra/ name. */
	{"polycarbonate", {SPEC_DISPERSION_SELLMEIER, {1.4182, .021304}, 2}},
	{"water", {SPEC_DISPERSION_SELLMEIER,
			  {.5684027565, .005101829712, .1726177391, .01821153936,
				  .02086189578, .02620722293, .1130748688, 10.69792721},
			  8}},
	{"ZnS", {SPEC_DISPERSION_SELLMEIER,
			{.010356, 0, 3.619092, .02345364, .50813, .099946, 2.219955,
				1148.729},
			8}},
	{"fused-silica",
		{SPEC_DISPERSION_SELLMEIER_UM,
			{.6961663, .0684043, .4079426, .1162414, .8974794, 9.896161}, 6}},
	{"diamond", {SPEC_DISPERSION_SELLMEIER_UM, {.3306, .175, 4.3356, .106}, 4}},
	{"MgF2", {SPEC_DISPERSION_SELLMEIER_UM,
			 {.48755108, .04338408, .39875031, .09461442, 2.3120353, 23.793604},
			 6}},
	{"sapphire",
		{SPEC_DISPERSION_SELLMEIER_UM,
			{1.4313493, .0726631, .65054713, .1193242, 5.3414021, 18.028251},
			6}},
	{"oleic-acid", {SPEC_DISPERSION_CAUCHY, {1.4554, .004565, .0001}, 3}},
};

static const struct spec_dispersion *
formula_of(const char *name)
{
	for (size_t i = 0; i < COUNT(materials); i++) {
		if (strcmp(materials[i].name, name) == 0)
			return &materials[i].dispersion;
	}
	fail_msg("no material %s", name);
	return NULL;
}

static double
index_at(const struct spec_dispersion *dispersion, double nm)
{
	struct spec_error error;
	double n;

	if (spec_dispersion_sample(dispersion, &nm, 1, &n, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return n;
}

static double
abbe_of(const struct spec_dispersion *dispersion)
{
	struct spec_error error;
	double abbe;

	if (spec_dispersion_abbe(dispersion, &abbe, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return abbe;
}

static void
test_published_values(void **state)
{
	/*
	 * n_d and V_d as in SCHOTT's data sheets; fused silica: Malitson 1965, table
	 * I, and Corning's 7980 (V_d 67.8); sapphire: as catalogues have the ordinary ray
	 * (1.768, 72.2).
	 */
	static const struct {
		const char *name;
		double n, tolerance, abbe, abbe_tolerance;
	} known[] = {
		{"F5", 1.60342, 5e-6, 38.03, .005},
		{"N-BK7", 1.51680, 5e-6, 64.17, .005},
		{"SF10", 1.72825, 5e-6, 28.41, .005},
		{"SF11", 1.78472, 5e-6, 25.76, .005},
		{"SF66", 1.92286, 5e-6, 20.88, .005},
		{"fused-silica", 1.45846, 5e-6, 67.8, .05},
		{"sapphire", 1.768, 5e-4, 72.2, .15},
	};
	/* Old BK7, SCHOTT's catalogue of the eighties. */
	static const struct spec_dispersion bk7 = {SPEC_DISPERSION_SCHOTT,
		{2.2718929, -1.0108077e-2, 1.0592509e-2, 2.0816965e-4, -7.6472538e-6,
			4.9240991e-7},
		6};
	/* Ethanol, 20 °C, 589.3 nm: 1.3616; Rheims et al., Meas. Sci. Technol. 8 (1997). */
	static const struct spec_dispersion ethanol = {
		SPEC_DISPERSION_CAUCHY, {1.35265, .00306, .00002}, 3};

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		const struct spec_dispersion *dispersion = formula_of(known[i].name);

		near(index_at(dispersion, 587.5618), known[i].n, known[i].tolerance,
			known[i].name);
		near(abbe_of(dispersion), known[i].abbe, known[i].abbe_tolerance,
			known[i].name);
	}
	near(index_at(&bk7, 587.5618), 1.51680, 5e-6, "BK7");
	near(abbe_of(&bk7), 64.17, .005, "BK7");
	near(index_at(&ethanol, 589.3), 1.3616, 5e-5, "ethanol");
	near(index_at(formula_of("diamond"), 589.3), 2.41726, 5e-6, "diamond");
}

/* Where the terms of a formula are no more than a power of two each. */
static void
test_exact_values(void **state)
{
	static const struct {
		struct spec_dispersion dispersion;
		double nm, n;
	} known[] = {
		/* n^2 = 1 + 3 * 4 / (4 - 3.25) + 47 = 64 */
		{{SPEC_DISPERSION_SELLMEIER, {3, 3.25, 47, 0}, 4}, 2000, 8},
		/* n^2 = 1 + 1.75 * 4 / (4 - 1.5^2) + 4 = 9 */
		{{SPEC_DISPERSION_SELLMEIER_UM, {1.75, 1.5, 4, 0}, 4}, 2000, 3},
		{{SPEC_DISPERSION_CAUCHY, {1.5}, 1}, 777, 1.5},
		{{SPEC_DISPERSION_CAUCHY, {1, 2, 4, 8}, 4}, 2000, 1 + .5 + .25 + .125},
		/* n^2 = 1 + 2 * 4 - 4 / 4 + 16 / 16 = 9 */
		{{SPEC_DISPERSION_SCHOTT, {1, 2, -4, 16}, 4}, 2000, 3},
		{{SPEC_DISPERSION_SCHOTT, {4}, 1}, 123, 2},
		{{SPEC_DISPERSION_SCHOTT, {1, 2}, 2}, 2000, 3},
		/* 4^3.5 = 128 */
		{{SPEC_DISPERSION_CONRADY, {1, 2, 32}, 3}, 4000, 1 + .5 + .25},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++)
		near(index_at(&known[i].dispersion, known[i].nm), known[i].n, 0, "exact");
}

/* The rows of our files are the formula's, to the digits that they have. */
static void
test_files(void **state)
{
	(void)state;
	for (size_t i = 0; i < COUNT(materials); i++) {
		struct spec_index index;
		struct spec_error error;
		double *n;

		if (spec_index_parse(materials[i].name, &index, &error) != SPEC_OK)
			fail_msg("%s", error.message);
		assert_int_equal(index.kind, SPEC_INDEX_CURVE);
		n = malloc(index.curve.count * sizeof *n);
		assert_non_null(n);
		assert_int_equal(
			spec_dispersion_sample(&materials[i].dispersion,
				index.curve.wavelength_nm, index.curve.count, n, &error),
			SPEC_OK);
		for (size_t j = 0; j < index.curve.count; j++)
			near(index.curve.value[j], n[j], 5.001e-9, materials[i].name);
		free(n);
		spec_index_free(&index);
	}
}

/* Any count of wavelengths gives the same bits as one after the other. */
static void
test_vectors(void **state)
{
	static const struct spec_dispersion others[] = {
		{SPEC_DISPERSION_SCHOTT, {2.27, -.0101, .0106, 2e-4, -7e-6, 5e-7}, 6},
		{SPEC_DISPERSION_CONRADY, {1.5, .01, .003}, 3},
	};
	enum { MOST = 41 };
	double nm[MOST], n[MOST];
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < MOST; i++)
		nm[i] = 500 + 7.3 * (double)((i * 17) % MOST);
	for (size_t i = 0; i < COUNT(materials) + COUNT(others); i++) {
		const struct spec_dispersion *dispersion =
			i < COUNT(materials) ? &materials[i].dispersion
					     : &others[i - COUNT(materials)];

		for (size_t count = 0; count <= MOST; count++) {
			assert_int_equal(
				spec_dispersion_sample(dispersion, nm, count, n, &error),
				SPEC_OK);
			for (size_t j = 0; j < count; j++)
				near(n[j], index_at(dispersion, nm[j]), 0, "one of many");
		}
	}
}

static void
test_bad_formulas(void **state)
{
	static const struct {
		struct spec_dispersion dispersion;
		double nm;
		enum spec_status status;
		const char *message;
	} cases[] = {
		{{SPEC_DISPERSION_SELLMEIER, {0}, 0}, 500, SPEC_EUSAGE,
			"sellmeier takes 2 to 16 coefficients, not 0"},
		{{SPEC_DISPERSION_SELLMEIER, {1, 2, 3}, 3}, 500, SPEC_EUSAGE,
			"sellmeier takes pairs of coefficients, and 3 is an odd number"},
		{{SPEC_DISPERSION_SELLMEIER_UM, {1, 2}, 1}, 500, SPEC_EUSAGE,
			"sellmeier-um takes 2 to 16 coefficients, not 1"},
		{{SPEC_DISPERSION_CAUCHY, {0}, 17}, 500, SPEC_EUSAGE,
			"cauchy takes 1 to 16 coefficients, not 17"},
		{{SPEC_DISPERSION_SCHOTT, {0}, 0}, 500, SPEC_EUSAGE,
			"schott takes 1 to 16 coefficients, not 0"},
		{{SPEC_DISPERSION_CONRADY, {1, 2}, 2}, 500, SPEC_EUSAGE,
			"conrady takes 3 coefficients, not 2"},
		{{(enum spec_dispersion_kind)99, {1, 2}, 2}, 500, SPEC_EUSAGE,
			"there is no such dispersion formula"},
		{{SPEC_DISPERSION_CAUCHY, {1, NAN}, 2}, 500, SPEC_EUSAGE,
			"coefficient 2 of cauchy is not finite"},
		{{SPEC_DISPERSION_CAUCHY, {1, 2}, 2}, 0, SPEC_ERANGE,
			"the wavelength 0 nm is not positive and finite"},
		{{SPEC_DISPERSION_CAUCHY, {1, 2}, 2}, -500, SPEC_ERANGE,
			"the wavelength -500 nm is not positive and finite"},
		{{SPEC_DISPERSION_CAUCHY, {1, 2}, 2}, INFINITY, SPEC_ERANGE,
			"is not positive and finite"},
		{{SPEC_DISPERSION_CAUCHY, {1, 2}, 2}, NAN, SPEC_ERANGE,
			"is not positive and finite"},
		{{SPEC_DISPERSION_CAUCHY, {-1, .25}, 2}, 500, SPEC_ERANGE,
			"cauchy gives n = 0 at 500 nm"},
		{{SPEC_DISPERSION_CAUCHY, {-2, .25}, 2}, 500, SPEC_ERANGE,
			"cauchy gives n = -1 at 500 nm"},
		/* On its resonance. */
		{{SPEC_DISPERSION_SELLMEIER, {1, .25}, 2}, 500, SPEC_ERANGE,
			"sellmeier gives n^2 = inf at 500 nm"},
		{{SPEC_DISPERSION_SELLMEIER_UM, {1, .5}, 2}, 500, SPEC_ERANGE,
			"sellmeier-um gives n^2 = inf at 500 nm"},
		/* Just below it. */
		{{SPEC_DISPERSION_SELLMEIER, {1, .5}, 2}, 500, SPEC_ERANGE,
			"sellmeier gives n^2 = 0 at 500 nm"},
		{{SPEC_DISPERSION_SELLMEIER, {1, .375}, 2}, 500, SPEC_ERANGE,
			"sellmeier gives n^2 = -1 at 500 nm"},
		{{SPEC_DISPERSION_SCHOTT, {1, -16}, 2}, 500, SPEC_ERANGE,
			"schott gives n^2 = -3 at 500 nm"},
		{{SPEC_DISPERSION_CONRADY, {1, 1e300, 1e300}, 3}, 1e-9, SPEC_ERANGE,
			"conrady gives n = inf at 1e-09 nm"},
	};
	struct spec_error error;
	double n;

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		assert_int_equal(spec_dispersion_sample(
					 &cases[i].dispersion, &cases[i].nm, 1, &n, &error),
			cases[i].status);
		assert_contains(error.message, cases[i].message);
		assert_int_equal(spec_dispersion_sample(
					 &cases[i].dispersion, &cases[i].nm, 1, &n, NULL),
			cases[i].status);
	}
	/* The first bad wavelength is named. */
	assert_int_equal(spec_dispersion_sample(&cases[17].dispersion,
				 (double[]){900, 550, 500}, 3, (double[3]){0}, &error),
		SPEC_ERANGE);
	assert_contains(error.message, "at 550 nm");
}

static void
test_bad_abbe(void **state)
{
	static const struct spec_dispersion constant = {SPEC_DISPERSION_CAUCHY, {1.5}, 1},
					    resonant = {SPEC_DISPERSION_SELLMEIER,
						    {1, .375}, 2};
	struct spec_error error;
	double abbe;

	(void)state;
	assert_int_equal(spec_dispersion_abbe(&constant, &abbe, &error), SPEC_ERANGE);
	assert_contains(error.message, "the Abbe number is infinite");
	assert_int_equal(spec_dispersion_abbe(&resonant, &abbe, &error), SPEC_ERANGE);
	assert_contains(error.message, "at 587.5618 nm");
}

/* Indices */

static void
sample(const char *text, double nm, double *n, double *k)
{
	struct spec_index index;
	struct spec_error error;

	if (spec_index_parse(text, &index, &error) != SPEC_OK ||
		spec_index_sample(&index, &nm, 1, SPEC_EXTRAPOLATE_REFUSE, n, k, &error) !=
			SPEC_OK)
		fail_msg("%s", error.message);
	spec_index_free(&index);
}

static void
test_index_forms(void **state)
{
	static const struct {
		const char *text;
		double nm, n, k, tolerance;
	} known[] = {
		{"air", 500, 1, 0, 0},
		{"vacuum", 500, 1, 0, 0},
		{"Air", 500, 1, 0, 0},
		{"1.33", 500, 1.33, 0, 0},
		{"+1.33", 500, 1.33, 0, 0},
		{".5", 500, .5, 0, 0},
		{"15e-1", 500, 1.5, 0, 0},
		{"1.5+0.01i", 500, 1.5, .01, 0},
		{"0.2+3.4i", 500, .2, 3.4, 0},
		{"0+2i", 500, 0, 2, 0},
		{"1.5+0i", 500, 1.5, 0, 0},
		{"1e0+1e-3i", 500, 1, 1e-3, 0},
		{"1000000", 500, 1e6, 0, 0},
		{"cauchy(1.458,0.00354)", 500, 1.458 + .00354 * 4, 0, 1e-15},
		{"cauchy( 1.458 , 0.00354\t)", 500, 1.458 + .00354 * 4, 0, 1e-15},
		{"sellmeier(3,3.25,47,0)", 2000, 8, 0, 0},
		{"sellmeier-um(1.75,1.5,4,0)", 2000, 3, 0, 0},
		{"schott(1,2,-4,16)", 2000, 3, 0, 0},
		{"conrady(1,2,32)", 4000, 1.75, 0, 0},
		{"N-BK7", 587.5618, 1.51680, 0, 2e-5},
		{"n-bk7", 587.5618, 1.51680, 0, 2e-5},
		{"glass/F5", 587.5618, 1.60342, 0, 2e-5},
		{"Au", 582.1, .29, 2.863, 0},
		{"Ti", 496, 2.36, 3.19, 0},
		{"plain", 500, 1.5, 0, 0},
		{"swapped", 500, 1.5, .25, 0},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		double n, k;

		sample(known[i].text, known[i].nm, &n, &k);
		near(n, known[i].n, known[i].tolerance, known[i].text);
		near(k, known[i].k, fmax(known[i].tolerance, known[i].k ? 0 : 1e-7),
			known[i].text);
	}
}

static void
test_index_tables(void **state)
{
	const double nm[] = {700, 300, 500};
	struct spec_index index;
	struct spec_error error;
	double n[3], k[3];

	(void)state;
	assert_int_equal(spec_index_parse("swapped", &index, &error), SPEC_OK);
	assert_int_equal(
		spec_index_sample(&index, nm, 3, SPEC_EXTRAPOLATE_CONSTANT, n, k, &error),
		SPEC_OK);
	near(n[0], 2, 0, "end");
	near(k[0], .5, 0, "end");
	near(n[1], 1, 0, "start");
	near(k[1], 0, 0, "start");
	near(n[2], 1.5, 0, "between");
	near(k[2], .25, 0, "between");
	assert_int_equal(
		spec_index_sample(&index, nm, 3, SPEC_EXTRAPOLATE_REFUSE, n, k, &error),
		SPEC_ERANGE);
	assert_contains(error.message, "covers 400..600 nm, not 700 nm");
	/* No medium has the index 0. */
	assert_int_equal(
		spec_index_sample(&index, nm, 3, SPEC_EXTRAPOLATE_ZERO, n, k, &error),
		SPEC_ERANGE);
	assert_int_equal(
		spec_index_sample(&index, nm + 2, 1, SPEC_EXTRAPOLATE_ZERO, n, k, &error),
		SPEC_OK);
	near(n[0], 1.5, 0, "between");
	spec_index_free(&index);
	spec_index_free(&index);
	spec_index_free(NULL);
	/* Near its resonance a formula gives more than any medium has. */
	assert_int_equal(
		spec_index_parse("sellmeier(1,0.24999999999999994)", &index, &error),
		SPEC_OK);
	assert_int_equal(
		spec_index_sample(&index, nm + 2, 1, SPEC_EXTRAPOLATE_REFUSE, n, k, &error),
		SPEC_ERANGE);
	assert_string_equal(
		error.message, "sellmeier at 500 nm: n lies outside 0..1000000");
	spec_index_free(&index);
}

static void
test_bad_indices(void **state)
{
	/* caret: blanks up to where it stands. */
	static const struct {
		const char *text, *caret, *message;
	} cases[] = {
		{"1.5-0.01i", "   ^", "k is negative, but in n + ik a medium absorbs"},
		{"-1.5", "^", "n lies outside 0..1000000"},
		{"-1.5+1i", "^", "n lies outside 0..1000000"},
		{"1000001", "^", "n lies outside 0..1000000"},
		{"1+1000001i", " ^", "k lies outside 0..1000000"},
		{"0", "^", "n and k are both 0"},
		{"0+0i", "^", "n and k are both 0"},
		{"3.4i", "   ^", "'3.4i' is not an index n or n+ki"},
		{"0.2+i3.4", "    ^", "is not an index n or n+ki"},
		{"0.2+3.4", "       ^", "is not an index n or n+ki"},
		{"0.2+3.4j", "       ^", "is not an index n or n+ki"},
		{"0.2+3.4ii", "        ^", "is not an index n or n+ki"},
		{"0.2+", "    ^", "is not an index n or n+ki"},
		{"1,33", " ^", "is not an index n or n+ki"},
		{"1.2.3", "   ^", "is not an index n or n+ki"},
		{"1e999", "^", "is not an index n or n+ki"},
		{"1.5+1e999i", "    ^", "is not an index n or n+ki"},
		{"", "^", "no spectrum ''"},
		{"nan", "^", "no spectrum 'nan'"},
		{" 1.33", "^", "no spectrum ' 1.33'"},
		{"N-BK8", "^", "did you mean 'N-BK7'?"},
		{"./gone.spd", "^", "no spectrum './gone.spd': no such file"},
		{"cauchi(1.5)", "^",
			"no dispersion formula is called 'cauchi'; there are sellmeier, "
			"sellmeier-um, cauchy, schott, conrady"},
		{"(1.5)", "^", "no dispersion formula is called ''"},
		{"cauchy()", "       ^", "coefficient 1 of cauchy is not a number"},
		{"cauchy(", "       ^", "coefficient 1 of cauchy is not a number"},
		{"cauchy(1.5", "          ^", "expected ',' or ')' after coefficient 1"},
		{"cauchy(1.5,x)", "           ^",
			"coefficient 2 of cauchy is not a number"},
		{"cauchy(1.5 2)", "           ^",
			"expected ',' or ')' after coefficient 1"},
		{"cauchy(1.5,,2)", "           ^", "coefficient 2 of cauchy is not"},
		{"cauchy(1.5,)", "           ^", "coefficient 2 of cauchy is not"},
		{"cauchy(1.5)2", "           ^", "nothing may follow the ')' of cauchy"},
		{"cauchy(1,2,3,4,5,6,7,8,9,1,1,1,1,1,1,1,1)",
			"                                       ^",
			"cauchy takes at most 16 coefficients"},
		{"sellmeier(1,2,3)", "               ^", "sellmeier takes pairs"},
		{"conrady(1,2,3,4)", "               ^", "conrady takes 3 coefficients"},
		{"D65", "^",
			"'D65' is a spectral power distribution, not a refractive index"},
		{"15-red", "^", "'15-red' is a reflectance, not a refractive index"},
		{"nameless", "^",
			"'nameless' is not a refractive index: it has no column n"},
		{"gaining", "^", "'gaining' at 600 nm: k is negative"},
		{"nothing", "^", "'nothing' at 400 nm: n and k are both 0"},
		{"damaged", "^", "damaged.spd:1: "},
		{"\303\266l\303\266l", "^", "no spectrum '\303\266l\303\266l'"},
	};
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		struct spec_index index;
		char place[sizeof error.place];

		if (spec_index_parse(cases[i].text, &index, &error) == SPEC_OK)
			fail_msg("'%s' is taken", cases[i].text);
		assert_contains(error.message, cases[i].message);
		snprintf(place, sizeof place, "  %s\n  %s", cases[i].text, cases[i].caret);
		assert_string_equal(error.place, place);
		assert_null(index.curve.value);
		assert_int_equal(
			spec_index_parse(cases[i].text, &index, NULL), error.status);
	}
}

/* Where the index is a part of a text, the caret stands in the whole. */
static void
test_index_part(void **state)
{
	const char *text = "water and cauchy(1,x) and so on";
	struct spec_index index;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_index_parse_part(text, 0, 5, &index, &error), SPEC_OK);
	spec_index_free(&index);
	assert_int_equal(spec_index_parse_part(text, 10, 11, &index, &error), SPEC_EUSAGE);
	assert_string_equal(error.place, "  water and cauchy(1,x) and so on\n"
					 "                     ^");
}

/* Scratch */

/* Our own data, and behind them the curves of this test: no index, or a bad one. */
static int
make_scratch(void **state)
{
	(void)state;
	if (scratch_make("dispersion") != 0)
		return -1;
	make_folder("glass");
	save_text("glass/plain.spd", "# columns: wavelength_nm n\n400 1\n600 2\n");
	save_text("glass/swapped.spd",
		"# quantity: refractive index\n"
		"# columns: wavelength_nm dn k n\n400 9 0 1\n600 9 .5 2\n");
	save_text("glass/nameless.spd", "# quantity: refractive index\n400 1\n600 2\n");
	save_text("glass/gaining.spd",
		"# columns: wavelength_nm n k\n400 1 0\n600 2 -1e-9\n");
	save_text("glass/nothing.spd", "# columns: wavelength_nm n k\n400 0 0\n600 2 1\n");
	save_text("glass/damaged.spd", "400\n");
	return scratch_search();
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_published_values),
		cmocka_unit_test(test_exact_values),
		cmocka_unit_test(test_files),
		cmocka_unit_test(test_vectors),
		cmocka_unit_test(test_bad_formulas),
		cmocka_unit_test(test_bad_abbe),
		cmocka_unit_test(test_index_forms),
		cmocka_unit_test(test_index_tables),
		cmocka_unit_test(test_bad_indices),
		cmocka_unit_test(test_index_part),
	};

	return cmocka_run_group_tests_name(
		"dispersion", tests, make_scratch, scratch_remove);
}
