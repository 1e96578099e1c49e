/*
 * Levels of detail: a picture from fewer bands than the image has, chosen by the user or by
 * how far it may be from the picture of all bands.
 */
#ifndef SPEC_IMAGE_LEVEL_H
#define SPEC_IMAGE_LEVEL_H

#include <stdio.h>

#include "base/error.h"
#include "image/reader.h"
#include "image/rgb.h"
#include "image/settings.h"

enum spec_level_kind {
	SPEC_LEVEL_ALL,  /* all bands */
	SPEC_LEVEL_STEP, /* bands a step apart, as spec_coarse_stride and _repeat have it */
	SPEC_LEVEL_HALVED, /* a level, as spec_coarse_halve and _interpolate have it */
	SPEC_LEVEL_BOUNDED /* the lowest level whose difference stays within a bound */
};

enum spec_level_formula {
	SPEC_LEVEL_DE76,   /* DeltaE*ab */
	SPEC_LEVEL_DE2000, /* CIEDE2000 */
	SPEC_LEVEL_FORMULAS
};

struct spec_level {
	enum spec_level_kind kind;
	double step_nm;                  /* STEP */
	unsigned number;                 /* HALVED */
	enum spec_level_formula formula; /* BOUNDED, as the next */
	int of_mean;                     /* the mean over the pixels is bounded, not each */
	double bound;                    /* at least 0 */
	int measured; /* the report is to have differences; the parser says no */
};

/*
 * A level as users write it: its number, or "METRIC:BOUND", METRIC one of de76, de2000 (the
 * mean over all pixels), de76-max, de2000-max (every pixel). SPEC_EUSAGE: another text.
 */
enum spec_status spec_level_parse(
	const char *text, struct spec_level *level, struct spec_error *error);

/* "10nm": a step. Errors: those of spec_number_parse_length. */
enum spec_status spec_level_parse_step(
	const char *text, struct spec_level *level, struct spec_error *error);

/* What was chosen, and how far it is from all bands. */
struct spec_level_report {
	int number, finest; /* the level, and the one with all bands; -1 for a step */
	size_t bands, of;   /* that are kept, of how many */
	/* The rest is 0 unless the level was measured or bounded. */
	long long pixels;    /* that were compared */
	long long nonfinite; /* that were not: of all bands or of those kept not finite */
	struct spec_level_difference {
		double mean, rms, most;
		int x, y; /* of the first with the most, in the data window */
	} difference[SPEC_LEVEL_FORMULAS];
};

/*
 * Takes bands out of a plan, by the level. Where that is bounded or to be measured all lines
 * of the image are read and compared, and the reader must have been opened with
 * settings->reread. Without a level nothing is done, and the report stays as it was.
 * Given:    image  the reader's, or a layer of it
 *           setup  what rgb was planned by
 * Compared: CIELAB of X, Y and Z by the same observer, light, rule and exposure, beside their
 *           white, before anything that comes after the sums. At a bound of every pixel no
 *           difference is above it, and a level is no choice where a pixel that is not
 *           finite with all bands becomes finite. Bounded levels always meet their bound:
 *           the finest has all bands. The same bits for any threads.
 * Errors:   those of spec_coarse_stride and spec_rgb_plan, with the image's name, and of
 *           reading; rgb is then as it was
 */
enum spec_status spec_level_apply(const struct spec_level *level,
	struct spec_reader *reader, const struct spec_image *image,
	const struct spec_rgb_setup *setup, struct spec_rgb *rgb,
	struct spec_level_report *report, const struct spec_settings *settings,
	struct spec_error *error);

/* In words, such as "9 of 81 bands, level 3, straight lines between them". */
#define SPEC_LEVEL_TEXT 128
void spec_level_text(const struct spec_level *level, const struct spec_level_report *report,
	char text[SPEC_LEVEL_TEXT]);

/* The report of a level that was bounded or measured, a line for each number. */
void spec_level_print(const struct spec_level_report *report, FILE *stream);

#endif
