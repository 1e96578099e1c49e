/*
 * What is done to the values of spectra, one thing after the other: arithmetic with a
 * curve, a number or a range.
 */
#ifndef SPEC_SPECTRUM_OPERATION_H
#define SPEC_SPECTRUM_OPERATION_H

#include "base/error.h"
#include "spectrum/curve.h"

enum spec_operation_kind {
	SPEC_OPERATION_MULTIPLY,      /* by the curve */
	SPEC_OPERATION_DIVIDE,        /* by the curve */
	SPEC_OPERATION_ADD,           /* the curve */
	SPEC_OPERATION_SCALE,         /* by the number */
	SPEC_OPERATION_RAISE,         /* to the power that the number is */
	SPEC_OPERATION_CLAMP,         /* to low..high */
	SPEC_OPERATION_ILLUMINATE,    /* by the curve: reflectance becomes light */
	SPEC_OPERATION_REFLECTANCE_OF /* under the curve: light becomes reflectance */
};

struct spec_operation {
	enum spec_operation_kind kind;
	struct spec_curve curve; /* its first column; empty where there is none */
	const char *value;       /* of the option, or null */
	double number;
	double low, high; /* low <= high */
	int deferred;     /* its curve is still to be filled in */
};

/*
 * The operation that an option stands for: multiply, divide, add, illuminate,
 * reflectance-of (the value names a curve, as spec_lookup_factor and, for the last two,
 * spec_lookup_light find it), scale (-1e30..1e30), raise (-1e3..1e3), clamp (A..B).
 * The operation keeps value. *known: whether it is one of these. Errors as those functions
 * and spec_number_parse. On an error the operation is empty.
 */
enum spec_status spec_operation_parse(const char *option, const char *value,
	struct spec_operation *operation, int *known, struct spec_error *error);

/*
 * The same of an operation with light (illuminate, reflectance-of) whose curve is not known
 * yet: it is deferred. Returns whether the option is one of these; else nothing is done.
 */
int spec_operation_defer(
	const char *option, const char *value, struct spec_operation *operation);
void spec_operation_free(struct spec_operation *operation);

/* What messages call its curve: its title, else what the option says. */
const char *spec_operation_name(const struct spec_operation *operation);

/* Whether it is, at each wavelength, a factor and something added. */
int spec_operation_is_affine(const struct spec_operation *operation);

/*
 * The curve after the operation: all its columns; with another curve as spec_curve_multiply,
 * spec_curve_divide and spec_curve_add. Values that were scaled or raised state no unit;
 * light that was raised no quantity. Errors (SPEC_ERANGE): a value without a finite power;
 * those of these functions. SPEC_EUNSUPPORTED: illuminate and reflectance-of, which are for
 * images. On an error the curve is as it was.
 */
enum spec_status spec_operation_apply(const struct spec_operation *operation,
	struct spec_curve *curve, struct spec_error *error);

#endif
