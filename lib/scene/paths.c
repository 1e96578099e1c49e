#include "scene/paths.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"

/* The name, seen from the folder of a scene file. */
static char *
join(const char *file, const char *name, struct spec_error *error)
{
	const char *end = *name == '/' ? NULL : strrchr(file, '/');
	size_t folder = end ? (size_t)(end - file) + 1 : 0, length = strlen(name);
	char *path = spec_memory_new(folder + length + 1, 1, "bytes of a path", error);

	if (!path)
		return NULL;
	memcpy(path, file, folder);
	memcpy(path + folder, name, length);
	return path;
}

/* Keeps that of two paths where there is a file that is no folder, and frees the other. */
static enum spec_status
choose(const struct spec_scene *scene, const struct spec_scene_place *place, char **near,
	char **first, struct spec_error *error)
{
	struct stat a, b;
	int has_near = stat(*near, &a) == 0 && !S_ISDIR(a.st_mode);
	int has_first = stat(*first, &b) == 0 && !S_ISDIR(b.st_mode);
	enum spec_status status = SPEC_OK;

	if (has_near && has_first && (a.st_dev != b.st_dev || a.st_ino != b.st_ino))
		status = spec_scene_fail(scene, place, error, SPEC_EUSAGE,
			"the name fits two files, '%.300s' and '%.300s'", *near, *first);
	if (status != SPEC_OK || !has_near) {
		free(*near);
		*near = NULL;
	}
	if (*near || !has_first) {
		free(*first);
		*first = NULL;
	}
	return status;
}

enum spec_status
spec_scene_find_file(const struct spec_scene *scene, const struct spec_scene_place *place,
	const char *name, char **path, struct spec_error *error)
{
	char *near, *first;
	enum spec_status status;

	*path = NULL;
	near = join(scene->file[place->file], name, error);
	first = join(scene->file[0], name, error);
	if (!near || !first) {
		free(near);
		free(first);
		return SPEC_ENOMEM;
	}
	status = choose(scene, place, &near, &first, error);
	if (status == SPEC_OK)
		*path = near ? near : first;
	else
		free(first);
	return status;
}

enum spec_status
spec_scene_need_file(const struct spec_scene *scene, const struct spec_scene_place *place,
	const char *name, char **path, struct spec_error *error)
{
	enum spec_status status = spec_scene_find_file(scene, place, name, path, error);
	const char *file = scene->file[place->file], *end = strrchr(file, '/');

	if (status != SPEC_OK || *path)
		return status;
	if (*name == '/' || !end)
		return spec_scene_fail(
			scene, place, error, SPEC_EIO, "there is no file '%.300s'", name);
	return spec_scene_fail(scene, place, error, SPEC_EIO,
		"there is no file '%.300s' in the folder '%.*s'", name, (int)(end - file),
		file);
}
