/*
 * Scenes in the format of pbrt-v4, https://pbrt.org/fileformat-v4: cameras, films, lights,
 * materials and shapes that have a place in struct spec_scene. What would make another
 * picture is an error where it stands; what would not is left out, or is a warning.
 *
 * Ours are
 *   Material "thinfilm" "string stack" "air | 1.33 500nm | air", perhaps "string thickness"
 *   Material "diffractive" "string preset" "cd"
 *   "integer id" of every material, 1 or more
 *   "float" for every spectrum that is the same at all wavelengths
 * Other than in pbrt
 *   spectra of lights are absolute, and must be given; power and illuminance are errors
 *   named files are found as spec_scene_find_file says
 *   a conductor that has eta must have k too
 *   quadrilaterals of PLY files are two triangles
 * The scene has an area light for each AreaLightSource, even if no shape carries it.
 */
#ifndef SPEC_SCENE_PARSE_H
#define SPEC_SCENE_PARSE_H

#include <stddef.h>

#include "base/error.h"
#include "scene/scene.h"

/*
 * Reads the scene in the file at path, "-" is standard input, and in those that it includes;
 * or in size bytes of text, for which name stands in messages and as the file whose folder
 * others are looked for in.
 * Messages begin with "file:line:column: ", but where the first file cannot be read at all.
 * SPEC_EFORMAT: not in this format, or without sense. SPEC_ERANGE: a value outside its
 * range, or a limit. SPEC_EUNSUPPORTED: pbrt has it, and we do not. SPEC_EUSAGE: a name that
 * fits nothing, or two files. SPEC_EIO, SPEC_ENOMEM. On an error scene is empty, and else to
 * be freed by spec_scene_free.
 */
enum spec_status spec_scene_read(
	struct spec_scene *scene, const char *path, struct spec_error *error);
enum spec_status spec_scene_parse(struct spec_scene *scene, const char *text, size_t size,
	const char *name, struct spec_error *error);

#endif
