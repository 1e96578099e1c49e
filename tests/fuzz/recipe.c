/* Fuzzes the reader of recipes; what it takes must survive being written out and read. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "optics/recipe.h"

#include "fuzz.h"

#define MOST_WRITTEN 100 /* layers; more of them only take time */

int
LLVMFuzzerInitialize(int *argc, char ***argv)
{
	(void)argc;
	(void)argv;
	use_our_spectra();
	return 0;
}

static void
check_layers(const struct spec_recipe *recipe)
{
	size_t layers = spec_recipe_layers(recipe), number = 0;
	struct spec_error error = {0};

	require(recipe->count >= 2 && layers <= SPEC_RECIPE_MOST_LAYERS, "another size");
	require(recipe->varied <= layers, "a layer that is not there varies");
	for (size_t i = 0; i < recipe->count; i++) {
		double nm = recipe->layer[i].thickness_nm;

		require(recipe->layer[i].medium < recipe->media, "no such medium");
		if (recipe->varied != 0 && i == recipe->varied)
			require(isnan(nm), "* is a thickness");
		else
			require(nm >= 0 && nm <= SPEC_RECIPE_THICKEST_NM, "no thickness");
	}
	if (spec_recipe_find_varied(recipe, &number, &error) == SPEC_OK)
		require(number >= 1 && number <= layers, "no such layer");
	else
		require(error.message[0] != '\0', "a failure without a message");
	require((spec_recipe_check_fixed(recipe, NULL) == SPEC_OK) == (recipe->varied == 0),
		"fixed, or not");
}

static void
check_indices(const struct spec_recipe *recipe)
{
	static const double nm[] = {550, 400, 1e5};
	struct spec_error error = {0};
	size_t total = recipe->count * 3;
	double *n = malloc(total * sizeof *n), *k = malloc(total * sizeof *k);
	enum spec_status status = SPEC_ENOMEM;

	if (n && k)
		status = spec_recipe_sample(
			recipe, nm, 3, SPEC_EXTRAPOLATE_CONSTANT, n, k, &error);
	for (size_t i = 0; status == SPEC_OK && i < total; i++)
		require(n[i] >= 0 && k[i] >= 0 && n[i] + k[i] > 0 && n[i] + k[i] <= 2e6,
			"an index out of range");
	if (n && k && status != SPEC_OK)
		require_caret(&error);
	free(n);
	free(k);
}

/* Every group written out, the recipe is the same. */
static void
write_back(const struct spec_recipe *recipe)
{
	struct spec_error error = {0};
	struct spec_recipe again;
	char *text = NULL;
	size_t size = 0;
	FILE *file = open_memstream(&text, &size);

	require(file != NULL, "no memory file");
	for (size_t i = 0; i < recipe->count; i++) {
		fprintf(file, "%s%s", i ? "|" : "",
			recipe->medium[recipe->layer[i].medium].name);
		if (i > 0 && i == recipe->varied)
			fputs(" *", file);
		else if (i > 0 && i < recipe->count - 1)
			fprintf(file, " %.17g", recipe->layer[i].thickness_nm);
	}
	fclose(file);
	if (spec_recipe_parse(text, &again, &error) != SPEC_OK) {
		fprintf(stderr, "fuzz: %s: %s\n", text, error.message);
		require(0, "what was written out cannot be read");
	}
	require(again.count == recipe->count && again.media == recipe->media &&
			again.varied == recipe->varied,
		"another recipe");
	for (size_t i = 0; i < recipe->count; i++) {
		double nm = recipe->layer[i].thickness_nm;

		require(again.layer[i].medium == recipe->layer[i].medium, "another medium");
		require(isnan(nm) || again.layer[i].thickness_nm == nm,
			"another thickness");
	}
	spec_recipe_free(&again);
	free(text);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	struct spec_error error = {0};
	struct spec_recipe recipe;
	char *text = malloc(size + 1);

	/* A name with a slash in it could be any file of this machine. */
	if (!text || memchr(data, '/', size)) {
		free(text);
		return 0;
	}
	memcpy(text, data, size);
	text[size] = '\0';
	if (spec_recipe_parse(text, &recipe, &error) != SPEC_OK) {
		require_caret(&error);
		require(recipe.text == NULL && recipe.layer == NULL, "not left empty");
	} else {
		check_layers(&recipe);
		check_indices(&recipe);
		if (recipe.count <= MOST_WRITTEN)
			write_back(&recipe);
		spec_recipe_free(&recipe);
	}
	free(text);
	return 0;
}
