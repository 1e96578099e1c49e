/*
 * Charts: images of reflectance or transmittance over one or two variables, the first to
 * the right, the second downwards.
 */
#ifndef SPEC_IMAGE_CHART_H
#define SPEC_IMAGE_CHART_H

#include <stddef.h>

#include "base/error.h"
#include "image/image.h"
#include "image/settings.h"
#include "spectrum/grid.h"

#define SPEC_CHART_RUN 256 /* pixels asked for at a time */
#define SPEC_CHART_VARIABLES 4

enum spec_chart_unit { SPEC_CHART_NM, SPEC_CHART_DEGREES };

struct spec_chart_variable {
	const char *name;
	enum spec_chart_unit unit;
	double lowest, highest; /* that an axis may reach */
	double value;           /* where it is on no axis */
};

struct spec_chart_axis {
	size_t variable;    /* its number, or SPEC_CHART_VARIABLES: the axis is not used */
	double first, last; /* at the middle of the first and of the last pixel */
};

struct spec_chart {
	struct spec_chart_variable variable[SPEC_CHART_VARIABLES];
	size_t variables;
	struct spec_chart_axis axis[2];
	int width, height;
	const struct spec_grid *grid;
	const char *quantity; /* of the bands, T */
	/*
	 * Fills value[band * SPEC_CHART_RUN + i] for pixels i = 0..count-1, whose variables
	 * are at[variable][i].
	 */
	void (*evaluate)(
		const void *state, const double *const *at, size_t count, double *value);
	const void *state;
};

/* What every tool that makes charts lets its user set. */
struct spec_chart_options {
	const char *axes, *grid; /* --chart, --grid; null: not given */
	double angle_deg;        /* --angle, 0 to 90; what of, the tool knows */
	int width, height;       /* --size */
	int has_angle, has_size; /* they were given */
};

/* The defaults: no chart, 480 x 270, 0 degrees. */
void spec_chart_options_init(struct spec_chart_options *options);

/*
 * Takes an option by its long name. Returns SPEC_OK with *known 0 where it is none of
 * these; errors as spec_number_parse_size's and spec_number_parse_angle's.
 */
enum spec_status spec_chart_options_take(struct spec_chart_options *options,
	const char *name, const char *value, int *known, struct spec_error *error);

/* The wavelengths of --grid, or 380:780:5. Errors as spec_grid_parse's. */
enum spec_status spec_chart_options_grid(const struct spec_chart_options *options,
	struct spec_grid *grid, struct spec_error *error);

/*
 * Reads "NAME A..B" or "NAME A..B, NAME A..B" into the axes. Errors, with a caret
 * (SPEC_EUSAGE, SPEC_ERANGE): no such variable, no range, twice the same.
 */
enum spec_status spec_chart_parse(
	struct spec_chart *chart, const char *text, struct spec_error *error);

/* Makes the chart's image and writes it; output and *overflows as spec_image_save's. */
enum spec_status spec_chart_save(const struct spec_chart *chart,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
