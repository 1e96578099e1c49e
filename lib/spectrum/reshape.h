/* What specconvert makes of curves and spectra in files. */
#ifndef SPEC_SPECTRUM_RESHAPE_H
#define SPEC_SPECTRUM_RESHAPE_H

#include "base/error.h"
#include "spectrum/abscissa.h"
#include "spectrum/air.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"
#include "spectrum/operation.h"
#include "spectrum/represent.h"

struct spec_reshape {
	const char *quantity;        /* of curves that state none; or null */
	enum spec_abscissa abscissa; /* what the files are tabulated over */
	enum spec_medium medium; /* wavelengths become those in it; unknown: they stay */
	const struct spec_grid *grid; /* then at these wavelengths; null: as they are */
	int rebin;                    /* or as means over the grid's bins */
	const double *edges_nm;       /* of these; null: they meet half-way */
	const struct spec_operation *operation; /* then these are done, in turn */
	size_t operations;
	enum spec_extrapolate extrapolate;
	int has_interpolate;               /* 0: what the file says lies between its rows */
	enum spec_interpolate interpolate; /* else this does */
};

/* What a user should know of a curve that was made. */
struct spec_reshape_notes {
	int left; /* it states no quantity: values over another unit were left as they were */
	char outside[160]; /* as spec_curve_describe_outside: what of the grid it lacks */
};

/*
 * The curve of that name, as spec_lookup_curve finds it, or "-" for standard input, with all
 * its columns, after all that is asked for. Errors: those of spec_spd_read,
 * spec_abscissa_convert, spec_air_convert, spec_curve_rebin, spec_curve_sample,
 * spec_operation_apply and spec_spectrum_combine, SPEC_EUSAGE where a curve is light and
 * quantity is not, or the other way round, SPEC_ERANGE where Sprague's rule has no
 * equal steps. Then curve is empty.
 */
enum spec_status spec_reshape_curve(const char *name, const struct spec_reshape *reshape,
	struct spec_curve *curve, struct spec_reshape_notes *notes,
	struct spec_error *error);

/* The same of a curve that is there, linear between its rows. name: for messages. */
enum spec_status spec_reshape_loaded(const char *name, const struct spec_reshape *reshape,
	struct spec_curve *curve, struct spec_reshape_notes *notes,
	struct spec_error *error);

/*
 * The spectrum of that name, after the operations, in another representation, saved at
 * path ("-" for standard output). Of samples and tables all columns are kept with their
 * names, as a curve; other kinds have one. The grid plays no part. Errors: as above, those
 * of spec_spectrum_convert and spec_spectrum_save; SPEC_EUSAGE: several columns that cannot
 * become one spectrum, another unit or medium.
 */
enum spec_status spec_reshape_save(const char *name, const struct spec_reshape *reshape,
	const struct spec_representation *to, const char *path, struct spec_error *error);

#endif
