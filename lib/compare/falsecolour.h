/* spec2rgb's false colours: a view of an image becomes a picture, row by row. */
#ifndef SPEC_COMPARE_FALSECOLOUR_H
#define SPEC_COMPARE_FALSECOLOUR_H

#include "base/error.h"
#include "colour/colourmap.h"
#include "compare/view.h"
#include "image/picture.h"
#include "image/reader.h"
#include "image/settings.h"

struct spec_falsecolour_setup {
	const struct spec_view *view;
	const struct spec_colourmap *map; /* of one number */
	double low, high; /* of the scale; equal: the least and the largest finite value */
	int legend;       /* below the picture, of one number */
};

/* What was seen on the way. */
struct spec_falsecolour {
	long long nonfinite;  /* pixels with a number that is not finite */
	int first_x, first_y; /* the first of them, in the data window */
	double low, high;     /* of the scale */
};

/* The size of the picture: the data window's, and the legend below it. */
void spec_falsecolour_size(const struct spec_falsecolour_setup *setup,
	const struct spec_image *image, size_t *width, size_t *height);

/*
 * Reads all lines and writes the picture. A number has its colour of the map, a vector the
 * share (v - low) / (high - low) of each component as its code, clipped to 0..1, not
 * encoded; floats hold the colours decoded, but shares as they are. A pixel that is not
 * finite has spec_colourmap_paint's colour. Where the scale is to be found, the numbers
 * wait in a temporary file; when all values are equal the scale ends 1 above them.
 * Errors: those of reading, of the picture, of the temporary file.
 */
enum spec_status spec_falsecolour_run(struct spec_falsecolour *result,
	const struct spec_falsecolour_setup *setup, struct spec_reader *reader,
	struct spec_picture *picture, enum spec_picture_sample sample,
	const struct spec_settings *settings, struct spec_error *error);

#endif
