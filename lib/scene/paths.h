/* Files that a scene names. */
#ifndef SPEC_SCENE_PATHS_H
#define SPEC_SCENE_PATHS_H

#include "base/error.h"
#include "scene/scene.h"

/*
 * Where the file is that is called name at a place of a scene: in the folder of the scene
 * file that the place is in, or, as pbrt has it, in the folder of the first one. Standard
 * input stands in the working folder. *path, to be freed, is null where there is none; a
 * folder is none.
 * Errors: SPEC_EUSAGE, there are two that differ; SPEC_ENOMEM.
 */
enum spec_status spec_scene_find_file(const struct spec_scene *scene,
	const struct spec_scene_place *place, const char *name, char **path,
	struct spec_error *error);

/* As spec_scene_find_file, but SPEC_EIO where there is none. */
enum spec_status spec_scene_need_file(const struct spec_scene *scene,
	const struct spec_scene_place *place, const char *name, char **path,
	struct spec_error *error);

#endif
