/* Recipes: what is read, and where the caret stands under what is not. */
#include <stdlib.h>
#include <string.h>

#include <math.h>
#include <stdio.h>

#include "optics/recipe.h"

#include "files.h"

static void
parse(const char *text, struct spec_recipe *recipe)
{
	struct spec_error error;

	if (spec_recipe_parse(text, recipe, &error) != SPEC_OK)
		fail_msg("%s: %s\n%s", text, error.message, error.place);
}

/* A recipe written out, thicknesses in nm: "air | 1.33 500 | air". */
static void
write_out(const struct spec_recipe *recipe, char *text, size_t size)
{
	size_t end = 0;

	text[0] = '\0';
	for (size_t i = 0; i < recipe->count && end < size; i++) {
		const struct spec_recipe_layer *layer = &recipe->layer[i];
		const char *name = recipe->medium[layer->medium].name;

		if (i == 0 || i == recipe->count - 1)
			end += (size_t)snprintf(
				text + end, size - end, "%s%s", i ? " | " : "", name);
		else if (isnan(layer->thickness_nm))
			end += (size_t)snprintf(text + end, size - end, " | %s *", name);
		else
			end += (size_t)snprintf(text + end, size - end, " | %s %.10g", name,
				layer->thickness_nm);
	}
}

static void
test_stacks(void **state)
{
	static const struct {
		const char *text, *written;
		size_t layers, media, varied;
	} known[] = {
		{"air | N-BK7", "air | N-BK7", 0, 2, 0},
		{"air|air", "air | air", 0, 1, 0},
		{"air | 1.33 500nm | air", "air | 1.33 500 | air", 1, 2, 0},
		{"air | MgF2 99.6nm | N-BK7", "air | MgF2 99.6 | N-BK7", 1, 3, 0},
		{"air|MgF2 99.6|N-BK7", "air | MgF2 99.6 | N-BK7", 1, 3, 0},
		{" \tair\n|  MgF2 \r\n 99.6nm   |N-BK7 \n", "air | MgF2 99.6 | N-BK7", 1, 3,
			0},
		{"air | 1.33 * | air", "air | 1.33 * | air", 1, 2, 1},
		{"air | 1.4 0.2um | 1.33 * | 1.5 1e-3mm | air",
			"air | 1.4 200 | 1.33 * | 1.5 1000 | air", 3, 4, 2},
		{"air | 1.33 0nm | 1.4 0 | 1.5 0.0um | air",
			"air | 1.33 0 | 1.4 0 | 1.5 0 | air", 3, 4, 0},
		{"air | 1.33 1m | 1.4 100cm | air",
			"air | 1.33 1000000000 | 1.4 1000000000 | air", 2, 3, 0},
		{"air | (TiO2 60nm | SiO2 95nm)^2 | N-BK7",
			"air | TiO2 60 | SiO2 95 | TiO2 60 | SiO2 95 | N-BK7", 4, 4, 0},
		{"air|(TiO2 60|SiO2 95)^1|N-BK7", "air | TiO2 60 | SiO2 95 | N-BK7", 2, 4,
			0},
		{"air | ( TiO2 60 ) ^ 3 | N-BK7",
			"air | TiO2 60 | TiO2 60 | TiO2 60 | N-BK7", 3, 3, 0},
		{"air | (1.5 1 | (1.6 2 | 1.7 3)^2 | 1.8 4)^2 | air",
			"air | 1.5 1 | 1.6 2 | 1.7 3 | 1.6 2 | 1.7 3 | 1.8 4"
			" | 1.5 1 | 1.6 2 | 1.7 3 | 1.6 2 | 1.7 3 | 1.8 4 | air",
			12, 5, 0},
		{"air | ((1.5 1)^2)^2 | air", "air | 1.5 1 | 1.5 1 | 1.5 1 | 1.5 1 | air",
			4, 2, 0},
		{"air | ((1.5 1)^2 | 1.6 2)^2 | air",
			"air | 1.5 1 | 1.5 1 | 1.6 2 | 1.5 1 | 1.5 1 | 1.6 2 | air", 6, 3,
			0},
		{"air | (1.5 1)^3 | 1.6 * | (1.5 1)^2 | air",
			"air | 1.5 1 | 1.5 1 | 1.5 1 | 1.6 * | 1.5 1 | 1.5 1 | air", 6, 3,
			4},
		{"air | cauchy(1.4554, 0.004565) 300nm | water",
			"air | cauchy(1.4554, 0.004565) 300 | water", 1, 3, 0},
		{"air | (cauchy(1.5) 1 | sellmeier(1,0.01) 2)^1 | 0.2+3.4i",
			"air | cauchy(1.5) 1 | sellmeier(1,0.01) 2 | 0.2+3.4i", 2, 4, 0},
		{"cauchy(1)|cauchy(1.5)\t7|cauchy(1)",
			"cauchy(1) | cauchy(1.5) 7 | cauchy(1)", 1, 2, 0},
		{"air | glass/F5 1 | \303\266l 2 | F5",
			"air | glass/F5 1 | \303\266l 2 | F5", 2, 4, 0},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		struct spec_recipe recipe;
		char written[512];

		parse(known[i].text, &recipe);
		write_out(&recipe, written, sizeof written);
		assert_string_equal(written, known[i].written);
		assert_string_equal(recipe.text, known[i].text);
		assert_int_equal(spec_recipe_layers(&recipe), known[i].layers);
		assert_int_equal(recipe.media, known[i].media);
		assert_int_equal(recipe.varied, known[i].varied);
		if (recipe.varied)
			assert_int_equal(recipe.text[recipe.varied_at], '*');
		assert_true(recipe.layer[0].thickness_nm == 0);
		assert_true(recipe.layer[recipe.count - 1].thickness_nm == 0);
		spec_recipe_free(&recipe);
		spec_recipe_free(&recipe);
	}
	spec_recipe_free(NULL);
}

static const struct bad {
	const char *text, *caret, *message; /* caret: blanks up to where it stands */
} bad[] = {
	/* The ambient. */
	{"", "^", "expected the ambient medium, but the stack ends"},
	{"  ", "  ^", "expected the ambient medium, but the stack ends"},
	{"| N-BK7", "^", "expected the ambient medium, not '|'"},
	{"* | N-BK7", "^", "expected the ambient medium, not '*'"},
	{"(1.5 1)^2 | N-BK7", "^", "expected the ambient medium, not '('"},
	{") | N-BK7", "^", "a ')' without a '('"},
	{"^ | N-BK7", "^", "expected the ambient medium, not '^'"},
	{"air", "   ^", "expected '|', but the stack ends"},
	{"air ", "    ^", "expected '|', but the stack ends"},
	{"air 5nm | N-BK7", "    ^",
		"expected '|': the first medium, the ambient, has no thickness"},
	{"air * | N-BK7", "    ^", "the first medium, the ambient, has no thickness"},
	{"air ^ N-BK7", "    ^", "expected '|', not '^'"},
	{"air ) N-BK7", "    ^", "a ')' without a '('"},
	{"air (1.5 1)^2 | N-BK7", "    ^", "expected '|', not '('"},
	{"air(1.5 1)^2 | N-BK7", "^", "no dispersion formula is called 'air'"},
	/* The substrate. */
	{"air |", "     ^",
		"expected a layer, a group or the substrate, but the stack ends"},
	{"air | 1.5 1 | ", "              ^",
		"expected a layer, a group or the substrate, but the stack ends"},
	{"air | N-BK7 1mm", "            ^",
		"the last medium, the substrate, has no thickness"},
	{"air | N-BK7 *", "            ^",
		"the last medium, the substrate, has no thickness"},
	{"air | N-BK7 junk", "            ^",
		"the last medium, the substrate, has no thickness"},
	{"air | N-BK7 )", "            ^", "a ')' without a '('"},
	{"air | N-BK7 ^2", "            ^", "expected a thickness, not '^'"},
	{"air | (1.5 1)^2", "               ^",
		"expected '|' and the substrate, but the stack ends"},
	{"air | 1.5 1 | *", "              ^",
		"expected a layer, a group or the substrate, not '*'"},
	/* Layers. */
	{"air | | N-BK7", "      ^", "expected a layer, a group or the substrate, not '|'"},
	{"air || N-BK7", "     ^", "expected a layer, a group or the substrate, not '|'"},
	{"air | 1.5 | N-BK7", "          ^", "expected a thickness, not '|'"},
	{"air|1.5|N-BK7", "       ^", "expected a thickness, not '|'"},
	{"air | 1.5 (1.6 1)^2 | N-BK7", "          ^", "expected a thickness, not '('"},
	{"air | 1.5 1 2 | N-BK7", "            ^", "expected '|', not '2'"},
	{"air | 1.5 500 nm | N-BK7", "              ^", "expected '|', not 'nm'"},
	{"air | 1.5 1 ( | N-BK7", "            ^", "expected '|', not '('"},
	{"air | 1.5 1^8 | N-BK7", "           ^", "expected '|', not '^'"},
	{"air | 1.5 1) | N-BK7", "           ^", "a ')' without a '('"},
	{"air | ) | N-BK7", "      ^", "a ')' without a '('"},
	{"air | 1.5 1nn | N-BK7", "          ^",
		"the thickness is not a length in nm, um, mm, cm or m: '1nn'"},
	{"air | 1.5 0nn | N-BK7", "          ^", "the thickness is not a length"},
	{"air | 1.5 thick | N-BK7", "          ^", "the thickness is not a length"},
	{"air | 1.5 1** | N-BK7", "          ^", "the thickness is not a length"},
	{"air | 1.5 ** | N-BK7", "          ^", "the thickness is not a length"},
	{"air | 1.5 -1nm | N-BK7", "          ^",
		"the thickness is not positive and finite: '-1nm'"},
	{"air | 1.5 1e308m | N-BK7", "          ^",
		"the thickness is not positive and finite"},
	{"air | 1.5 -1e308m | N-BK7", "          ^",
		"the thickness is not positive and finite"},
	{"air | 1.5 1e999 | N-BK7", "          ^", "the thickness is not a length"},
	{"air | 1.5 101cm | N-BK7", "          ^",
		"the thickness is more than 1 m: '101cm'"},
	{"air | 1.5 * | 1.6 * | N-BK7", "                  ^",
		"only one layer can have the thickness *"},
	/* Groups. */
	{"air | () | N-BK7", "       ^", "expected a layer or a group, not ')'"},
	{"air | ()^2 | N-BK7", "       ^", "expected a layer or a group, not ')'"},
	{"air | (1.5)^2 | N-BK7", "          ^", "expected a thickness, not ')'"},
	{"air | (1.5 1 |)^2 | N-BK7", "              ^",
		"expected a layer or a group, not ')'"},
	{"air | (| 1.5 1)^2 | N-BK7", "       ^", "expected a layer or a group, not '|'"},
	{"air | (1.5 1) | N-BK7", "              ^",
		"expected '^' and the number of repeats, not '|'"},
	{"air | (1.5 1)", "             ^",
		"expected '^' and the number of repeats, but the stack ends"},
	{"air | (1.5 1)8 | N-BK7", "             ^",
		"expected '^' and the number of repeats, not '8'"},
	{"air | (1.5 1)^ | N-BK7", "               ^",
		"expected the number of repeats, not '|'"},
	{"air | (1.5 1)^", "              ^",
		"expected the number of repeats, but the stack ends"},
	{"air | (1.5 1)^x | N-BK7", "              ^",
		"the number of repeats is not a whole number: 'x'"},
	{"air | (1.5 1)^2.5 | N-BK7", "              ^",
		"the number of repeats is not a whole number"},
	{"air | (1.5 1)^0 | N-BK7", "              ^",
		"the number of repeats is outside 1..10000: '0'"},
	{"air | (1.5 1)^-3 | N-BK7", "              ^",
		"the number of repeats is outside 1..10000"},
	{"air | (1.5 1)^10001 | N-BK7", "              ^",
		"the number of repeats is outside 1..10000"},
	{"air | (1.5 1)^99999999999999999999 | a", "              ^",
		"the number of repeats is outside 1..10000"},
	{"air | (1.5 1)^2^2 | N-BK7", "               ^", "expected '|', not '^'"},
	{"air | (1.5 1)^2(1.6 2)^2 | N-BK7", "               ^", "expected '|', not '('"},
	{"air | (1.5 1)^2 junk | N-BK7", "                ^", "expected '|', not 'junk'"},
	{"air | (1.5 1)^2) | N-BK7", "               ^", "a ')' without a '('"},
	{"air | (1.5 1 | N-BK7", "      ^", "a '(' without a ')'"},
	{"air | (1.5 1", "      ^", "a '(' without a ')'"},
	{"air | (", "      ^", "a '(' without a ')'"},
	{"air | (1.5 1 | (1.6 1)^2", "      ^", "a '(' without a ')'"},
	{"air | (1.5 1 | (1.6 1 | N-BK7", "               ^", "a '(' without a ')'"},
	{"air | (1.5 1 | (1.6 1)", "      ^", "a '(' without a ')'"},
	{"air | (1.5 *)^2 | N-BK7", "           ^",
		"a layer in a group cannot have the thickness *"},
	{"air | (1.5 *)^1 | N-BK7", "           ^",
		"a layer in a group cannot have the thickness *"},
	{"air | 1.5 * | (1.5 *)^2 | N-BK7", "                   ^",
		"a layer in a group cannot have the thickness *"},
	{"air | (1.5 1 | 1.6 2)^5001 | N-BK7", "                      ^",
		"the stack has more than 10000 layers"},
	{"air | 1.5 1 | (1.5 1)^10000 | air", "                      ^",
		"the stack has more than 10000 layers"},
	{"air | ((1.5 1)^200)^200 | air", "                    ^",
		"the stack has more than 10000 layers"},
	{"air | (1.5 1)^10000 | 1.5 1 | air", "                      ^",
		"the stack has more than 10000 layers"},
	/* Media. */
	{"air | foo 60nm | N-BK7", "      ^", "no spectrum 'foo': it is not in "},
	{"air | MgF3 60nm | N-BK7", "      ^", "did you mean 'MgF2'?"},
	{"foo | MgF2 60nm | N-BK7", "^", "no spectrum 'foo'"},
	{"air | MgF2 60nm | foo", "                  ^", "no spectrum 'foo'"},
	{"air | (MgF2 60nm | foo 1)^2 | air", "                   ^", "no spectrum 'foo'"},
	{"air | 500nm 1.5 | N-BK7", "      ^", "no spectrum '500nm'"},
	{"air | D65 60nm | N-BK7", "      ^",
		"'D65' is a spectral power distribution, not a refractive index"},
	{"air | 1.5-0.1i 60nm | N-BK7", "         ^", "k is negative"},
	{"air | 1,5 60nm | N-BK7", "       ^", "is not an index n or n+ki"},
	{"air | cauchy(1.5 60nm | N-BK7", "            ^", "a '(' without a ')'"},
	{"air | cauchy(1.5", "            ^", "a '(' without a ')'"},
	{"air | cauchy(1.5,x) 60nm | N-BK7", "                 ^",
		"coefficient 2 of cauchy is not a number"},
	{"air | cauchy(1.5)60nm | N-BK7", "                 ^",
		"nothing may follow the ')' of cauchy"},
	{"air | cauchy(1.5)(2) 60nm | N-BK7", "                 ^",
		"nothing may follow the ')' of cauchy"},
	{"air | cauchy (1.5) 60nm | air", "      ^", "no spectrum 'cauchy'"},
	{"air | x^b 60nm | N-BK7", "      ^", "no spectrum 'x'"},
};

static void
test_bad_stacks(void **state)
{
	(void)state;
	for (size_t i = 0; i < COUNT(bad); i++) {
		struct spec_recipe recipe;
		struct spec_error error;
		char place[sizeof error.place];

		if (spec_recipe_parse(bad[i].text, &recipe, &error) != SPEC_EUSAGE)
			fail_msg("'%s' is taken, or no error of use", bad[i].text);
		assert_int_equal(error.status, SPEC_EUSAGE);
		assert_contains(error.message, bad[i].message);
		snprintf(place, sizeof place, "  %s\n  %s", bad[i].text, bad[i].caret);
		assert_string_equal(error.place, place);
		assert_null(recipe.text);
		assert_null(recipe.layer);
		assert_int_equal(
			spec_recipe_parse(bad[i].text, &recipe, NULL), SPEC_EUSAGE);
	}
}

/* A file that is damaged is the file's error, shown in the text. */
static void
test_damaged_medium(void **state)
{
	struct spec_recipe recipe;
	struct spec_error error;

	(void)state;
	assert_int_equal(
		spec_recipe_parse("air | damaged 1 | air", &recipe, &error), SPEC_EFORMAT);
	assert_contains(error.message, "damaged.spd:1: ");
	assert_string_equal(error.place, "  air | damaged 1 | air\n"
					 "        ^");
	assert_int_equal(
		spec_recipe_parse("air | gaining 1 | air", &recipe, &error), SPEC_ERANGE);
	assert_contains(error.message, "'gaining' at 600 nm: k is negative");
	assert_string_equal(error.place, "  air | gaining 1 | air\n"
					 "        ^");
}

/* The caret counts characters, and long words are cut between two. */
static void
test_utf8(void **state)
{
	struct spec_recipe recipe;
	struct spec_error error;

	(void)state;
	assert_int_equal(
		spec_recipe_parse("air | \303\266l 1 | \303\237 2 | air", &recipe, &error),
		SPEC_EUSAGE);
	assert_contains(error.message, "no spectrum '\303\237'");
	assert_string_equal(error.place, "  air | \303\266l 1 | \303\237 2 | air\n"
					 "               ^");
	assert_int_equal(
		spec_recipe_parse("air | 1.5 1 "
				  "a\303\266\303\266\303\266\303\266\303\266\303\266"
				  "\303\266\303\266\303\266\303\266\303\266\303\266"
				  "\303\266\303\266\303\266\303\266\303\266\303\266"
				  "\303\266\303\266\303\266 | air",
			&recipe, &error),
		SPEC_EUSAGE);
	assert_string_equal(error.message,
		"expected '|', not "
		"'a\303\266\303\266\303\266\303\266\303\266\303\266\303\266\303\266\303\266"
		"\303\266\303\266\303\266\303\266\303\266\303\266\303\266\303\266\303\266"
		"\303\266'");
	assert_int_equal(spec_recipe_parse("air | 1.5 0.5\302\265m | air", &recipe, &error),
		SPEC_EUSAGE);
	assert_contains(error.message, "the thickness is not a length");
}

/* first, then part so many times, then last. To be freed. */
static char *
repeat(const char *first, const char *part, size_t times, const char *last)
{
	size_t size = strlen(first) + times * strlen(part) + strlen(last) + 1;
	char *text = malloc(size), *end = text;

	assert_non_null(text);
	end = stpcpy(end, first);
	while (times-- > 0)
		end = stpcpy(end, part);
	strcpy(end, last);
	return text;
}

static void
test_most_layers(void **state)
{
	struct spec_recipe recipe;
	struct spec_error error;
	char *text = repeat("air |", "1.5 1|", SPEC_RECIPE_MOST_LAYERS, "N-BK7");

	(void)state;
	parse(text, &recipe);
	assert_int_equal(spec_recipe_layers(&recipe), SPEC_RECIPE_MOST_LAYERS);
	spec_recipe_free(&recipe);
	free(text);
	text = repeat("air |", "1.5 1|", SPEC_RECIPE_MOST_LAYERS + 1, "N-BK7");
	assert_int_equal(spec_recipe_parse(text, &recipe, &error), SPEC_EUSAGE);
	assert_string_equal(error.message, "the stack has more than 10000 layers");
	assert_string_equal(error.place,
		"  1.5 1|1.5 1|1.5 1|1.5 1|1.5 1|1.5 1|1.5 1|1.5 1|1.5 1|N-BK7\n"
		"                                                  ^");
	free(text);
	parse("air | (1.5 1 | 1.6 2)^5000 | N-BK7", &recipe);
	assert_int_equal(spec_recipe_layers(&recipe), SPEC_RECIPE_MOST_LAYERS);
	near(recipe.layer[9999].thickness_nm, 1, 0, "the last but one");
	near(recipe.layer[10000].thickness_nm, 2, 0, "the last");
	spec_recipe_free(&recipe);
	parse("air | ((1.5 1)^100)^100 | N-BK7", &recipe);
	assert_int_equal(spec_recipe_layers(&recipe), SPEC_RECIPE_MOST_LAYERS);
	spec_recipe_free(&recipe);
}

static void
test_deepest(void **state)
{
	char *open = repeat("air | ", "(", SPEC_RECIPE_DEEPEST, "1.5 1");
	char *text = repeat(open, ")^1", SPEC_RECIPE_DEEPEST, "| air");
	struct spec_recipe recipe;
	struct spec_error error;

	(void)state;
	parse(text, &recipe);
	assert_int_equal(spec_recipe_layers(&recipe), 1);
	spec_recipe_free(&recipe);
	free(text);
	free(open);
	text = repeat("air | ", "(", SPEC_RECIPE_DEEPEST + 1, "1.5 1");
	assert_int_equal(spec_recipe_parse(text, &recipe, &error), SPEC_EUSAGE);
	assert_string_equal(error.message, "more than 32 groups lie in each other");
	assert_string_equal(error.place, "  air | (((((((((((((((((((((((((((((((((1.5 1\n"
					 "                                        ^");
	free(text);
}

/* However often a medium stands in the stack, its curve is there once. */
static void
test_one_curve_each(void **state)
{
	struct spec_recipe recipe;
	size_t curves = 0;

	(void)state;
	parse("air | (TiO2 60nm | SiO2 95nm)^500 | TiO2 30nm | SiO2", &recipe);
	assert_int_equal(recipe.media, 3);
	assert_int_equal(recipe.count, 1003);
	for (size_t i = 0; i < recipe.media; i++)
		curves += recipe.medium[i].index.kind == SPEC_INDEX_CURVE;
	assert_int_equal(curves, 2);
	assert_string_equal(recipe.medium[1].name, "TiO2");
	assert_int_equal(recipe.medium[1].at, 7);
	assert_int_equal(recipe.medium[1].layer, 1);
	for (size_t i = 1; i < recipe.count; i++)
		assert_int_equal(recipe.layer[i].medium, i % 2 ? 1 : 2);
	spec_recipe_free(&recipe);
}

static void
test_varied(void **state)
{
	struct spec_recipe recipe;
	struct spec_error error;
	size_t layer = 0;

	(void)state;
	parse("air | 1.33 100 | air", &recipe);
	assert_int_equal(spec_recipe_find_varied(&recipe, &layer, &error), SPEC_OK);
	assert_int_equal(layer, 1);
	assert_int_equal(spec_recipe_check_fixed(&recipe, &error), SPEC_OK);
	spec_recipe_free(&recipe);

	parse("air | (1.4 1)^2 | 1.33 * | air", &recipe);
	assert_int_equal(spec_recipe_find_varied(&recipe, &layer, &error), SPEC_OK);
	assert_int_equal(layer, 3);
	assert_true(isnan(recipe.layer[layer].thickness_nm));
	assert_int_equal(spec_recipe_check_fixed(&recipe, &error), SPEC_EUSAGE);
	assert_string_equal(
		error.message, "the thickness of layer 3 is *, and none is given for it");
	assert_string_equal(error.place, "  air | (1.4 1)^2 | 1.33 * | air\n"
					 "                         ^");
	assert_int_equal(spec_recipe_check_fixed(&recipe, NULL), SPEC_EUSAGE);
	spec_recipe_free(&recipe);

	parse("air | (1.4 1 | 1.5 2)^4 | air", &recipe);
	assert_int_equal(spec_recipe_find_varied(&recipe, &layer, &error), SPEC_EUSAGE);
	assert_string_equal(error.message,
		"the stack has 8 layers; write * for the thickness "
		"of the one that --thickness sets");
	assert_int_equal(spec_recipe_find_varied(&recipe, &layer, NULL), SPEC_EUSAGE);
	spec_recipe_free(&recipe);

	parse("air | N-BK7", &recipe);
	assert_int_equal(spec_recipe_find_varied(&recipe, &layer, &error), SPEC_EUSAGE);
	assert_string_equal(error.message,
		"the stack has no layer whose thickness --thickness could set");
	spec_recipe_free(&recipe);
}

static void
test_sample(void **state)
{
	enum { BANDS = 3 };
	const double nm[BANDS] = {400, 500, 600};
	struct spec_recipe recipe;
	struct spec_error error;
	double n[6 * BANDS], k[6 * BANDS];

	(void)state;
	parse("air | (step 1 | cauchy(1,0.25) 2)^2 | 1.5+0.5i", &recipe);
	assert_int_equal(recipe.count, 6);
	if (spec_recipe_sample(&recipe, nm, BANDS, SPEC_EXTRAPOLATE_REFUSE, n, k, &error) !=
		SPEC_OK)
		fail_msg("%s", error.message);
	for (size_t i = 0; i < BANDS; i++) {
		double um = nm[i] / 1e3;

		near(n[i], 1, 0, "air");
		near(k[i], 0, 0, "air");
		for (size_t layer = 1; layer < 5; layer += 2) {
			near(n[layer * BANDS + i], 1 + .5 * (double)i, 0, "step");
			near(k[layer * BANDS + i], .25 * (double)i, 0, "step");
			near(n[(layer + 1) * BANDS + i], 1 + .25 / (um * um), 1e-15,
				"cauchy");
			near(k[(layer + 1) * BANDS + i], 0, 0, "cauchy");
		}
		near(n[5 * BANDS + i], 1.5, 0, "substrate");
		near(k[5 * BANDS + i], .5, 0, "substrate");
	}
	assert_int_equal(spec_recipe_sample(&recipe, (double[]){700}, 1,
				 SPEC_EXTRAPOLATE_REFUSE, n, k, &error),
		SPEC_ERANGE);
	assert_contains(
		error.message, "medium 'step': the curve covers 400..600 nm, not 700");
	assert_string_equal(error.place, "  air | (step 1 | cauchy(1,0.25) \n"
					 "         ^");
	assert_int_equal(spec_recipe_sample(&recipe, (double[]){700}, 1,
				 SPEC_EXTRAPOLATE_CONSTANT, n, k, &error),
		SPEC_OK);
	near(n[1], 2, 0, "step's end");
	spec_recipe_free(&recipe);
}

/* Scratch */

/* Our own data, and behind them the files of this test. */
static int
make_scratch(void **state)
{
	(void)state;
	if (scratch_make("recipe") != 0)
		return -1;
	make_folder("glass");
	save_text("glass/step.spd", "# columns: wavelength_nm n k\n400 1 0\n600 2 .5\n");
	save_text("glass/gaining.spd",
		"# columns: wavelength_nm n k\n400 1 0\n600 2 -1e-9\n");
	save_text("glass/damaged.spd", "400\n");
	save_text("glass/\303\266l.spd", "# columns: wavelength_nm n\n400 1\n600 2\n");
	return scratch_search();
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_stacks),
		cmocka_unit_test(test_bad_stacks),
		cmocka_unit_test(test_damaged_medium),
		cmocka_unit_test(test_utf8),
		cmocka_unit_test(test_most_layers),
		cmocka_unit_test(test_deepest),
		cmocka_unit_test(test_one_curve_each),
		cmocka_unit_test(test_varied),
		cmocka_unit_test(test_sample),
	};

	return cmocka_run_group_tests_name("recipe", tests, make_scratch, scratch_remove);
}
