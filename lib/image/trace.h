/* Curves read off pictures of plots. */
#ifndef SPEC_IMAGE_TRACE_H
#define SPEC_IMAGE_TRACE_H

#include "base/error.h"
#include "image/reader.h"
#include "spectrum/curve.h"

/*
 * Two points of a plot whose places in the picture and values are known, such as the ends of
 * its axes. The axes are linear, and run along the picture's rows and columns. Pixels are
 * counted from 0, from the left and from above, and a whole number is a pixel's middle.
 */
struct spec_trace_axes {
	double x[2], y[2]; /* pixels; neither x equal nor y */
	double wavelength_nm[2], value[2];
};

/*
 * Reads "X,Y=WAVELENGTH,VALUE X,Y=WAVELENGTH,VALUE", with a unit of length or nm. SPEC_EUSAGE,
 * SPEC_ERANGE: another text; twice the same X, Y, wavelength or value.
 */
enum spec_status spec_trace_parse(
	const char *text, struct spec_trace_axes *axes, struct spec_error *error);

/*
 * The curve of one colour in a picture.
 * Given:    reader  a picture of channels R, G and B, linear as readers give them
 *           axes    only pixels in the rectangle of the two points count, its edges
 *                   included, and four rows above and below
 *           ink     the curve's colour, encoded as sRGB, in [0, 1]
 *           paper   that of what is behind it
 * Rule:     a pixel's share of ink is where its encoded colour lies on the line from paper to
 *           ink, as drawing programs blend edges; 0 where it is farther than 0.15 beside that
 *           line. A column's value is at the centre of ink of its run of pixels with a share of
 *           0.1 or more, of which one has 0.5 or more. Columns without one are left out; what
 *           lies between is linear.
 * Accuracy: a tenth of a pixel on a line of two pixels' width or more, drawn with smooth edges;
 *           where it turns within a column, the line's width
 * Returned: a curve of one column, ascending, with no quantity; its source names the picture
 * Errors:   SPEC_EFORMAT  no channels R, G, B; SPEC_EUSAGE  ink and paper alike; SPEC_ERANGE
 *           no ink, or in one column alone; two runs in one column, which the message names;
 *           the rectangle leaves the picture. Then curve is empty.
 */
enum spec_status spec_trace_curve(struct spec_reader *reader,
	const struct spec_trace_axes *axes, const double ink[3], const double paper[3],
	struct spec_curve *curve, struct spec_error *error);

#endif
