#include "scene/scene.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

void
spec_scene_spectrum_free(struct spec_scene_spectrum *spectrum)
{
	spec_curve_free(&spectrum->curve);
	spec_spectrum_free(&spectrum->spectrum);
}

static void
free_texts(char **text, size_t count)
{
	for (size_t i = 0; i < count; i++)
		free(text[i]);
	free(text);
}

static void
free_material(struct spec_scene_material *material)
{
	spec_scene_spectrum_free(&material->reflectance);
	spec_scene_spectrum_free(&material->eta);
	spec_scene_spectrum_free(&material->k);
	free(material->stack);
	free(material->thickness);
	free(material->preset);
}

static void
free_shape(struct spec_scene_shape *shape)
{
	free(shape->point);
	free(shape->normal);
	free(shape->uv);
	free(shape->index);
}

static void
free_light(struct spec_scene_light *light)
{
	spec_scene_spectrum_free(&light->spectrum);
	free(light->picture);
	free(light->daylight);
}

void
spec_scene_free(struct spec_scene *scene)
{
	if (!scene)
		return;
	for (size_t i = 0; i < scene->materials; i++)
		free_material(&scene->material[i]);
	for (size_t i = 0; i < scene->shapes; i++)
		free_shape(&scene->shape[i]);
	for (size_t i = 0; i < scene->lights; i++)
		free_light(&scene->light[i]);
	free(scene->material);
	free(scene->shape);
	free(scene->light);
	free_texts(scene->file, scene->files);
	free_texts(scene->warning, scene->warnings);
	free(scene->integrator);
	free(scene->output);
	*scene = (struct spec_scene){0};
}

void
spec_scene_prefix(const struct spec_scene *scene, const struct spec_scene_place *place,
	struct spec_error *error)
{
	if (place->file < scene->files)
		spec_error_prefix(error, "%s:%d:%d", scene->file[place->file], place->line,
			place->column);
}

enum spec_status
spec_scene_fail(const struct spec_scene *scene, const struct spec_scene_place *place,
	struct spec_error *error, enum spec_status status, const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(error, status, format, arguments);
	va_end(arguments);
	spec_scene_prefix(scene, place, error);
	return status;
}

/* Whether a warning, which begins with a place, says text. */
static int
says(const char *warning, const char *text)
{
	size_t length = strlen(warning), wanted = strlen(text);

	return length >= wanted && strcmp(warning + length - wanted, text) == 0;
}

enum spec_status
spec_scene_warn(struct spec_scene *scene, const struct spec_scene_place *place,
	struct spec_error *error, const char *format, ...)
{
	void *list = scene->warning;
	struct spec_error warning;
	enum spec_status status;
	va_list arguments;
	char *text;

	/* A message of its own, to be prefixed and made plain as errors are. */
	va_start(arguments, format);
	spec_error_vset(&warning, SPEC_OK, format, arguments);
	va_end(arguments);
	for (size_t i = 0; i < scene->warnings; i++)
		if (says(scene->warning[i], warning.message))
			return SPEC_OK;
	spec_scene_prefix(scene, place, &warning);
	status = spec_memory_grow(&list, &scene->warning_room, scene->warnings + 1,
		sizeof *scene->warning, "warnings", error);
	scene->warning = list;
	if (status != SPEC_OK)
		return status;
	text = spec_memory_text(warning.message, strlen(warning.message), error);
	if (!text)
		return SPEC_ENOMEM;
	scene->warning[scene->warnings++] = text;
	return SPEC_OK;
}
