/* Fuzzes the reader of .spd files; what it takes must survive being written and read. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "spectrum/spd.h"
#include "spectrum/store.h"

#include "fuzz.h"

static void
compare(const struct spec_curve *one, const struct spec_curve *two)
{
	require(one->count == two->count && one->columns == two->columns, "another size");
	require(memcmp(one->wavelength_nm, two->wavelength_nm,
			one->count * sizeof *one->wavelength_nm) == 0,
		"other wavelengths");
	require(memcmp(one->value, two->value,
			one->count * one->columns * sizeof *one->value) == 0,
		"other values");
	require(strcmp(one->title, two->title) == 0 && strcmp(one->unit, two->unit) == 0 &&
			strcmp(one->quantity, two->quantity) == 0 &&
			strcmp(one->source, two->source) == 0,
		"other texts");
}

static void
write_back(const struct spec_curve *curve)
{
	struct spec_error error = {0};
	struct spec_curve again;
	char *text = NULL;
	size_t size = 0;
	FILE *file = open_memstream(&text, &size);
	enum spec_status status;

	require(file != NULL, "no memory file");
	status = spec_spd_write(file, curve, &error);
	fclose(file);
	require(status == SPEC_OK || status == SPEC_ERANGE, "unable to write to memory");
	if (status == SPEC_OK) {
		status = spec_spd_parse(text, size, "again", &again, &error);
		if (status != SPEC_OK)
			fprintf(stderr, "fuzz: %s\n", error.message);
		require(status == SPEC_OK, "what was written cannot be read");
		compare(curve, &again);
		spec_curve_free(&again);
	}
	free(text);
}

static struct spec_spectrum
read_spectrum(const char *text, size_t size, enum spec_status *status)
{
	FILE *file = fmemopen((void *)(uintptr_t)text, size, "r");
	struct spec_spectrum spectrum = {0};
	struct spec_error error = {0};

	*status = SPEC_EIO;
	if (!file)
		return spectrum;
	*status = spec_spectrum_read(file, "fuzz", &spectrum, &error);
	fclose(file);
	return spectrum;
}

/* The same for a spectrum of any kind: its second text is its first. */
static void
check_spectrum(const char *bytes, size_t size)
{
	char *text[2] = {NULL, NULL};
	size_t sizes[2] = {0, 0};
	enum spec_status status;

	for (int i = 0; i < 2; i++) {
		struct spec_spectrum spectrum = read_spectrum(
			i == 0 ? bytes : text[0], i == 0 ? size : sizes[0], &status);
		FILE *file = open_memstream(&text[i], &sizes[i]);
		struct spec_error error;

		require(file != NULL, "no memory file");
		if (status == SPEC_OK)
			status = spec_spectrum_write(file, &spectrum, &error);
		fclose(file);
		spec_spectrum_free(&spectrum);
		require(i == 0 || status == SPEC_OK, "a spectrum does not come back");
		if (status != SPEC_OK)
			break;
	}
	if (status == SPEC_OK)
		require(sizes[0] == sizes[1] && memcmp(text[0], text[1], sizes[0]) == 0,
			"another spectrum");
	free(text[0]);
	free(text[1]);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	struct spec_error error = {0};
	struct spec_curve curve;

	if (spec_spd_parse((const char *)data, size, "input", &curve, &error) != SPEC_OK) {
		require(error.message[0] && !strchr(error.message, '\n'),
			"not one line's message");
		return 0;
	}
	require(curve.count >= 1 && curve.columns >= 1, "an empty curve");
	for (size_t i = 0; i < curve.count; i++)
		require(curve.wavelength_nm[i] > (i > 0 ? curve.wavelength_nm[i - 1] : 0),
			"wavelengths disordered");
	write_back(&curve);
	spec_curve_free(&curve);
	check_spectrum((const char *)data, size);
	return 0;
}
