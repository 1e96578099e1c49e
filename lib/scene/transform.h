/*
 * Transforms by pbrt's conventions, each with its inverse beside it. Everything but
 * spec_transform_set changes a transform T to T M: M is applied to points first.
 *
 * Errors are SPEC_ERANGE, unless another one is named: there is no inverse, or a number that
 * is not finite comes out. The transform is then as it was. Messages say no place.
 */
#ifndef SPEC_SCENE_TRANSFORM_H
#define SPEC_SCENE_TRANSFORM_H

#include "base/error.h"
#include "scene/scene.h"

struct spec_transform spec_transform_identity(void);
struct spec_transform spec_transform_inverse(const struct spec_transform *transform);

enum spec_status spec_transform_translate(
	struct spec_transform *transform, const double offset[3], struct spec_error *error);
enum spec_status spec_transform_scale(
	struct spec_transform *transform, const double factor[3], struct spec_error *error);

/*
 * Around an axis of any length but 0: around z a positive angle turns x towards y, around x
 * it turns y towards z, around y z towards x.
 */
enum spec_status spec_transform_rotate(struct spec_transform *transform, double angle_deg,
	const double axis[3], struct spec_error *error);

/*
 * The camera's view from eye to look: M takes world to camera, where the camera looks along
 * +z with +y up and +x to the right. Left-handed: x = up cross z.
 */
enum spec_status spec_transform_look_at(struct spec_transform *transform,
	const double eye[3], const double look[3], const double up[3],
	struct spec_error *error);

/*
 * M from 16 numbers column after column, as pbrt's Transform has them: the offset is
 * column[12..14]. SPEC_EUNSUPPORTED: its last row is not 0 0 0 and a number.
 */
enum spec_status spec_transform_set(struct spec_transform *transform,
	const double column[16], struct spec_error *error);
enum spec_status spec_transform_concat(struct spec_transform *transform,
	const double column[16], struct spec_error *error);

void spec_transform_point(
	const struct spec_transform *transform, const double point[3], double result[3]);

#endif
