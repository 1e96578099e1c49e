#include "image/strip.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/picture.h"

#define CHANNELS 3

enum spec_status
spec_strip_parse(
	const char *text, enum spec_strip_scaling *scaling, struct spec_error *error)
{
	static const char *const names[] = {"none", "global", "channel"};

	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		if (strcmp(text, names[i]) == 0) {
			*scaling = (enum spec_strip_scaling)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(
		error, SPEC_EUSAGE, "unknown scaling '%.200s' (none global channel)", text);
}

static double
greatest(const double *value, size_t count)
{
	double most = value[0];

	for (size_t i = 1; i < count; i++)
		most = fmax(most, value[i]);
	return most;
}

/* What each channel is divided by. */
static enum spec_status
find_divisors(const struct spec_curve *curve, enum spec_strip_scaling scaling,
	double divisor[CHANNELS], struct spec_error *error)
{
	for (size_t i = 0; i < CHANNELS; i++) {
		size_t column = i % curve->columns;

		divisor[i] = 1;
		if (scaling == SPEC_STRIP_GLOBAL)
			divisor[i] = greatest(curve->value, curve->count * curve->columns);
		if (scaling == SPEC_STRIP_CHANNEL)
			divisor[i] = greatest(
				curve->value + column * curve->count, curve->count);
		if (!(divisor[i] > 0))
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' has nothing above 0 to scale by in '%.100s'",
				spec_curve_name(curve), curve->column[column]);
	}
	return SPEC_OK;
}

static enum spec_status
check_range(const struct spec_curve *curve, const double divisor[CHANNELS],
	struct spec_error *error)
{
	for (size_t i = 0; i < curve->columns; i++) {
		for (size_t j = 0; j < curve->count; j++) {
			double value = curve->value[i * curve->count + j] / divisor[i];

			if (!(value >= 0 && value <= 1))
				return spec_error_set(error, SPEC_ERANGE,
					"'%.200s' is %g at %.10g nm in '%.100s', which integers of "
					"0 to 1 cannot hold (--scaling, or -o FILE.exr)",
					spec_curve_name(curve), value,
					curve->wavelength_nm[j], curve->column[i]);
		}
	}
	return SPEC_OK;
}

/* One row of the picture, which are all alike; newly allocated. */
static void *
make_row(const struct spec_curve *curve, const double divisor[CHANNELS],
	enum spec_picture_sample sample, struct spec_error *error)
{
	void *row =
		spec_memory_new(curve->count, CHANNELS * sizeof(float), "pixels", error);

	for (size_t j = 0; row && j < curve->count; j++) {
		for (size_t i = 0; i < CHANNELS; i++) {
			size_t at = CHANNELS * j + i;
			double value = curve->value[i % curve->columns * curve->count + j] /
				       divisor[i];

			if (sample == SPEC_PICTURE_U8)
				((uint8_t *)row)[at] = (uint8_t)(value * 255 + .5);
			else
				((float *)row)[at] = (float)value;
		}
	}
	return row;
}

static enum spec_status
write_rows(const char *path, const struct spec_picture_kind *kind,
	const struct spec_curve *curve, const void *row, int height,
	struct spec_error *error)
{
	struct spec_picture_file file;
	enum spec_status status = spec_picture_file_open(
		&file, path, kind, curve->count, (size_t)height, NULL, error);

	if (status != SPEC_OK)
		return status;
	for (int y = 0; y < height && status == SPEC_OK; y++)
		status = spec_picture_write(file.picture, row, 1, error);
	if (status == SPEC_OK)
		status = spec_picture_finish(file.picture, error);
	return spec_picture_file_end(&file, status, error);
}

enum spec_status
spec_strip_save(const char *path, const struct spec_curve *curve,
	enum spec_strip_scaling scaling, int height, struct spec_error *error)
{
	struct spec_picture_kind kind;
	double divisor[CHANNELS];
	void *row = NULL;
	enum spec_status status = spec_picture_choose(path, NULL, 0, &kind, error);

	if (status == SPEC_OK && curve->columns != 1 && curve->columns != CHANNELS)
		status = spec_error_set(error, SPEC_ERANGE,
			"'%.200s' has %zu columns; a strip is made of one or of three",
			spec_curve_name(curve), curve->columns);
	if (status == SPEC_OK)
		status = find_divisors(curve, scaling, divisor, error);
	if (status == SPEC_OK && kind.sample != SPEC_PICTURE_FLOAT)
		status = check_range(curve, divisor, error);
	if (status == SPEC_OK) {
		row = make_row(curve, divisor, kind.sample, error);
		status = row ? write_rows(path, &kind, curve, row, height, error)
			     : SPEC_ENOMEM;
	}
	free(row);
	return status;
}
