/*
 * Looks that need the whole picture before its first sample: automatic exposure, and the
 * gamut's scale. Linear rows go to a temporary file, 12 bytes a pixel, are measured on the
 * way, and are read again; so an image is read once, also from a pipe.
 */
#ifndef SPEC_IMAGE_METER_H
#define SPEC_IMAGE_METER_H

#include "image/look.h"
#include "image/settings.h"

struct spec_meter;

/* Whether a look needs it. */
int spec_meter_wanted(const struct spec_look *look);

/*
 * Errors: SPEC_ENOMEM; the temporary file's. Finish must live as long. threads: the most that
 * take rows.
 */
enum spec_status spec_meter_open(struct spec_meter **meter, struct spec_finish *finish,
	size_t width, int threads, struct spec_error *error);

/* What was measured of a row. */
struct spec_meter_row {
	long long lit;       /* pixels with a finite luminance above 0 */
	double logs;         /* the sum over them of the natural logarithm of luminance */
	double most, chroma; /* as spec_gamut_map's */
};

/*
 * A row, of any place, on any thread: width floats of red, then of green, then of blue, which
 * may be changed. y: the row, from 0; worker: the thread, from 0, below threads.
 */
enum spec_status spec_meter_take(struct spec_meter *meter, int worker, float *row, int y,
	struct spec_meter_row *measured, struct spec_error *error);

/* The measures of all rows, in order: one thread at a time. */
void spec_meter_add(struct spec_meter *meter, const struct spec_meter_row *measured);

/* After the last row: fills in what the look's numbers are, and writes the picture. */
enum spec_status spec_meter_finish(struct spec_meter *meter, struct spec_picture *picture,
	const struct spec_settings *settings, struct spec_error *error);

/* Null is harmless. */
void spec_meter_close(struct spec_meter *meter);

#endif
