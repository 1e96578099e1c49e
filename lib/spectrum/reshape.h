/* What specconvert makes of curves and spectra in files. */
#ifndef SPEC_SPECTRUM_RESHAPE_H
#define SPEC_SPECTRUM_RESHAPE_H

#include "base/error.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"
#include "spectrum/represent.h"

struct spec_reshape {
	const struct spec_curve *multiply; /* by the first columns of these, in turn */
	size_t multiplies;
	double scale;                 /* and by this */
	const struct spec_grid *grid; /* then at these wavelengths; null: as they are */
	enum spec_extrapolate extrapolate;
	int has_interpolate;               /* 0: what the file says lies between its rows */
	enum spec_interpolate interpolate; /* else this does */
};

/*
 * The curve of that name, as spec_lookup_curve finds it, or "-" for standard input, with all
 * its columns, multiplied, scaled and at the grid. Errors: those of spec_spd_read,
 * spec_curve_multiply, spec_curve_sample and spec_spectrum_combine, SPEC_ERANGE where
 * Sprague's rule has no equal steps. Then curve is empty.
 */
enum spec_status spec_reshape_curve(const char *name, const struct spec_reshape *reshape,
	struct spec_curve *curve, struct spec_error *error);

/*
 * The spectrum of that name, multiplied and scaled, in another representation, saved at
 * path ("-" for standard output). Of samples and tables all columns are kept with their
 * names, as a curve; other kinds have one. The grid plays no part. Errors: as above, those
 * of spec_spectrum_convert and spec_spectrum_save; SPEC_EUSAGE: several columns that cannot
 * become one spectrum.
 */
enum spec_status spec_reshape_save(const char *name, const struct spec_reshape *reshape,
	const struct spec_representation *to, const char *path, struct spec_error *error);

#endif
