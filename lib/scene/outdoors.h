/* Places on the earth in scenes: daylight there, and cameras that look from one to another. */
#ifndef SPEC_SCENE_OUTDOORS_H
#define SPEC_SCENE_OUTDOORS_H

#include "base/error.h"
#include "scene/parameters.h"
#include "scene/scene.h"

/*
 * The sun and the clear sky of
 *   "string place" "string time"         as place/coordinates.h and instant.h read them
 *   "float turbidity" 3  "float albedo" 0.2  of the ground
 *   "vector3 up" [0 1 0]  "vector3 north" [0 0 1]  of light's space
 *   "bool sun" true                      with the sun's own light
 * East is to the right of who looks north on the scene's picture: up cross north, or against
 * it, where the scene's camera mirrors.
 * The result is light->daylight. SPEC_EFORMAT: place or time is missing. SPEC_EUSAGE: they
 * cannot be read. SPEC_ERANGE: the sun is not above the horizon; another value; directions
 * that have no length, or the same. SPEC_EUNSUPPORTED: see place/coordinates.h. SPEC_ENOMEM.
 */
enum spec_status spec_outdoors_daylight(
	const struct spec_arguments *arguments, struct spec_scene_light *light);

/*
 * Turns a camera's transform, from the world, so that it looks from "string place" towards
 * "string toward", along the bearing of the shortest way, and "float elevation" 0 degrees
 * above the horizon. The transform that is there goes to x east, y up and z north. The scene
 * keeps the place. Without any of them all stays what it was. Errors as above;
 * SPEC_EFORMAT: one without the other; SPEC_ERANGE: both are the same place.
 */
enum spec_status spec_outdoors_face(
	const struct spec_arguments *arguments, struct spec_transform *camera);

#endif
