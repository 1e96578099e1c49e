#include "scene/transform.h"

#include <math.h>
#include <string.h>

#include "base/triple.h"

#define DEGREE 0.017453292519943295769 /* [rad] */
/* Of a determinant beside the product of its columns' lengths: below, it counts as 0. */
#define SINGULAR 1e-13

struct spec_transform
spec_transform_identity(void)
{
	struct spec_transform identity = {{{0}}, {{0}}};

	for (int i = 0; i < 4; i++)
		identity.m[i][i] = identity.inverse[i][i] = 1;
	return identity;
}

struct spec_transform
spec_transform_inverse(const struct spec_transform *transform)
{
	struct spec_transform inverse;

	memcpy(inverse.m, transform->inverse, sizeof inverse.m);
	memcpy(inverse.inverse, transform->m, sizeof inverse.inverse);
	return inverse;
}

static void
multiply(const double a[4][4], const double b[4][4], double product[4][4])
{
	for (int i = 0; i < 4; i++) {
		for (int j = 0; j < 4; j++) {
			product[i][j] = 0;
			for (int k = 0; k < 4; k++)
				product[i][j] += a[i][k] * b[k][j];
		}
	}
}

static int
is_finite(const struct spec_transform *transform)
{
	for (int i = 0; i < 4; i++)
		for (int j = 0; j < 4; j++)
			if (!isfinite(transform->m[i][j]) ||
				!isfinite(transform->inverse[i][j]))
				return 0;
	return 1;
}

/* transform becomes transform * factor. */
static enum spec_status
append(struct spec_transform *transform, const struct spec_transform *factor,
	struct spec_error *error)
{
	struct spec_transform product = {{{0}}, {{0}}};

	multiply(transform->m, factor->m, product.m);
	multiply(factor->inverse, transform->inverse, product.inverse);
	if (!is_finite(&product))
		return spec_error_set(error, SPEC_ERANGE,
			"the transform is too large or too small for a number");
	*transform = product;
	return SPEC_OK;
}

enum spec_status
spec_transform_translate(
	struct spec_transform *transform, const double offset[3], struct spec_error *error)
{
	struct spec_transform factor = spec_transform_identity();

	for (int i = 0; i < 3; i++) {
		factor.m[i][3] = offset[i];
		factor.inverse[i][3] = -offset[i];
	}
	return append(transform, &factor, error);
}

enum spec_status
spec_transform_scale(
	struct spec_transform *transform, const double factor[3], struct spec_error *error)
{
	struct spec_transform scale = spec_transform_identity();

	for (int i = 0; i < 3; i++) {
		if (factor[i] == 0)
			return spec_error_set(
				error, SPEC_ERANGE, "a scale of 0 has no inverse");
		scale.m[i][i] = factor[i];
		scale.inverse[i][i] = 1 / factor[i];
	}
	return append(transform, &scale, error);
}

/* Rodrigues' formula. */
enum spec_status
spec_transform_rotate(struct spec_transform *transform, double angle_deg,
	const double axis[3], struct spec_error *error)
{
	struct spec_transform rotation = spec_transform_identity();
	double turn = fmod(angle_deg, 360) * DEGREE;
	double sine = sin(turn), cosine = cos(turn), a[3] = {axis[0], axis[1], axis[2]};

	if (!spec_triple_normalise(a))
		return spec_error_set(
			error, SPEC_ERANGE, "the axis of a rotation has no length");
	for (int i = 0; i < 3; i++) {
		int j = (i + 1) % 3, k = (i + 2) % 3;

		rotation.m[i][i] = a[i] * a[i] * (1 - cosine) + cosine;
		rotation.m[i][j] = a[i] * a[j] * (1 - cosine) - a[k] * sine;
		rotation.m[j][i] = a[i] * a[j] * (1 - cosine) + a[k] * sine;
	}
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			rotation.inverse[j][i] = rotation.m[i][j];
	return append(transform, &rotation, error);
}

enum spec_status
spec_transform_look_at(struct spec_transform *transform, const double eye[3],
	const double look[3], const double up[3], struct spec_error *error)
{
	struct spec_transform view = spec_transform_identity();
	double axis[3][3], upwards[3] = {up[0], up[1], up[2]};

	for (int i = 0; i < 3; i++)
		axis[2][i] = look[i] - eye[i];
	if (!spec_triple_normalise(axis[2]))
		return spec_error_set(
			error, SPEC_ERANGE, "the eye is where the camera looks");
	if (!spec_triple_normalise(upwards))
		return spec_error_set(
			error, SPEC_ERANGE, "the direction upwards has no length");
	spec_triple_cross(upwards, axis[2], axis[0]);
	if (!(spec_triple_dot(axis[0], axis[0]) > SINGULAR) ||
		!spec_triple_normalise(axis[0]))
		return spec_error_set(
			error, SPEC_ERANGE, "the camera looks along the direction upwards");
	spec_triple_cross(axis[2], axis[0], axis[1]);
	for (int i = 0; i < 3; i++) {
		for (int j = 0; j < 3; j++)
			view.m[i][j] = view.inverse[j][i] = axis[i][j];
		view.m[i][3] = -spec_triple_dot(axis[i], eye);
		view.inverse[i][3] = eye[i];
	}
	return append(transform, &view, error);
}

/*
 * The inverse of an affine m: of its left upper 3 by 3 by its cofactors, column by column
 * scaled to length 1 first, so that no unit of length looks singular.
 */
static int
invert(struct spec_transform *transform)
{
	double column[3][3], length[3], row[3][3], determinant;

	for (int j = 0; j < 3; j++) {
		for (int i = 0; i < 3; i++)
			column[j][i] = transform->m[i][j];
		length[j] = hypot(hypot(column[j][0], column[j][1]), column[j][2]);
		if (!spec_triple_normalise(column[j]))
			return 0;
	}
	for (int j = 0; j < 3; j++)
		spec_triple_cross(column[(j + 1) % 3], column[(j + 2) % 3], row[j]);
	determinant = spec_triple_dot(column[0], row[0]);
	if (!(fabs(determinant) > SINGULAR))
		return 0;
	for (int i = 0; i < 3; i++) {
		for (int j = 0; j < 3; j++)
			transform->inverse[i][j] = row[i][j] / determinant / length[i];
		transform->inverse[3][i] = 0;
	}
	for (int i = 0; i < 3; i++) {
		transform->inverse[i][3] = 0;
		for (int j = 0; j < 3; j++)
			transform->inverse[i][3] -=
				transform->inverse[i][j] * transform->m[j][3];
	}
	transform->inverse[3][3] = 1;
	return 1;
}

static enum spec_status
make(struct spec_transform *transform, const double column[16], struct spec_error *error)
{
	if (column[3] != 0 || column[7] != 0 || column[11] != 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"perspective transforms are not supported: the last row of the matrix "
			"is not 0 0 0 1");
	if (column[15] == 0)
		return spec_error_set(error, SPEC_ERANGE, "the matrix has no inverse");
	for (int i = 0; i < 4; i++)
		for (int j = 0; j < 4; j++)
			transform->m[i][j] = column[4 * j + i] / column[15];
	if (!invert(transform))
		return spec_error_set(error, SPEC_ERANGE, "the matrix has no inverse");
	return SPEC_OK;
}

enum spec_status
spec_transform_concat(
	struct spec_transform *transform, const double column[16], struct spec_error *error)
{
	struct spec_transform factor;
	enum spec_status status = make(&factor, column, error);

	return status == SPEC_OK ? append(transform, &factor, error) : status;
}

enum spec_status
spec_transform_set(
	struct spec_transform *transform, const double column[16], struct spec_error *error)
{
	struct spec_transform whole = spec_transform_identity();
	enum spec_status status = spec_transform_concat(&whole, column, error);

	if (status == SPEC_OK)
		*transform = whole;
	return status;
}

void
spec_transform_point(
	const struct spec_transform *transform, const double point[3], double result[3])
{
	double copy[3] = {point[0], point[1], point[2]};

	for (int i = 0; i < 3; i++)
		result[i] = spec_triple_dot(transform->m[i], copy) + transform->m[i][3];
}
