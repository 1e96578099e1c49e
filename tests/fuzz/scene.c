/*
 * Fuzzes the readers of scenes and of PLY files, by what the bytes begin with. Scenes are
 * said to lie in a folder that is not there, and have no slash, so that they open none but
 * our own spectra.
 */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/parse.h"
#include "scene/ply.h"

#include "fuzz.h"

#define NAME "/no/such/folder/input.pbrt"

int
LLVMFuzzerInitialize(int *argc, char ***argv)
{
	(void)argc;
	(void)argv;
	use_our_spectra();
	return 0;
}

static void
check_error(const struct spec_error *error, const char *name)
{
	require_message(error);
	require(error->status == SPEC_ENOMEM || strstr(error->message, name) != NULL,
		"a message without the file's name");
}

/* ---- meshes ---- */

static void
check_mesh(size_t vertices, size_t triangles, const float *const lists[3],
	const uint32_t *index)
{
	static const int width[] = {3, 3, 2};

	require(vertices > 0 && triangles > 0 && lists[0] && index, "an empty mesh");
	for (int list = 0; list < 3; list++)
		for (size_t i = 0; lists[list] && i < width[list] * vertices; i++)
			require(isfinite(lists[list][i]), "a number that is not finite");
	for (size_t i = 0; i < 3 * triangles; i++)
		require(index[i] < vertices, "no such vertex");
}

static void
try_ply(const uint8_t *data, size_t size)
{
	FILE *file = fmemopen((void *)data, size, "rb");
	struct spec_error error = {0};
	struct spec_ply mesh;

	require(file != NULL, "no memory file");
	if (spec_ply_read(file, "input.ply", &mesh, &error) == SPEC_OK) {
		check_mesh(mesh.vertices, mesh.triangles,
			(const float *const[]){mesh.point, mesh.normal, mesh.uv},
			mesh.index);
	} else {
		check_error(&error, "input.ply");
		require(!mesh.point && !mesh.normal && !mesh.uv && !mesh.index,
			"not left empty");
	}
	spec_ply_free(&mesh);
	fclose(file);
}

/* ---- scenes ---- */

static void
check_transform(const struct spec_transform *transform)
{
	for (int i = 0; i < 4; i++)
		for (int j = 0; j < 4; j++)
			require(isfinite(transform->m[i][j]) &&
					isfinite(transform->inverse[i][j]),
				"a transform that is not finite");
	for (int i = 0; i < 4; i++)
		require(transform->m[3][i] == (i == 3) &&
				transform->inverse[3][i] == (i == 3),
			"a transform that is not affine");
}

static void
check_spectrum(const struct spec_scene_spectrum *spectrum, double least, double most)
{
	const struct spec_curve *curve = &spectrum->curve;

	require((spectrum->kind == SPEC_SCENE_CURVE) == (curve->count > 0), "no curve");
	for (size_t i = 0; i < curve->count; i++)
		require(curve->value[i] >= least && curve->value[i] <= most,
			"a value out of range");
	require(curve->count == 0 || curve->columns == 1, "several columns");
	require((spectrum->kind == SPEC_SCENE_SPECTRUM) ==
			(spectrum->spectrum.title != NULL),
		"no spectrum");
	for (size_t i = 0; i < spectrum->spectrum.lines; i++)
		require(spectrum->spectrum.line[i].weight > 0, "a line out of range");
	if (spectrum->kind == SPEC_SCENE_CONSTANT)
		require(spectrum->value >= least && spectrum->value <= most,
			"a constant out of range");
	if (spectrum->kind == SPEC_SCENE_BLACKBODY)
		require(spectrum->value > 0, "no temperature");
	for (int i = 0; i < 3; i++)
		require(spectrum->rgb[i] >= 0 && spectrum->rgb[i] <= most,
			"a colour out of range");
}

static void
check_place(const struct spec_scene *scene, const struct spec_scene_place *place)
{
	require(place->file < scene->files && place->line >= 1 && place->column >= 1,
		"no place");
}

static void
check_shape(const struct spec_scene *scene, const struct spec_scene_shape *shape)
{
	check_place(scene, &shape->place);
	check_transform(&shape->world);
	require(shape->material < scene->materials, "no such material");
	require(shape->light == SPEC_SCENE_NONE || shape->light < scene->lights,
		"no such light");
	if (shape->kind == SPEC_SCENE_MESH)
		check_mesh(shape->vertices, shape->triangles,
			(const float *const[]){shape->point, shape->normal, shape->uv},
			shape->index);
	else
		require(shape->radius > shape->inner_radius && shape->inner_radius >= 0,
			"no radius");
}

static void
check_material(const struct spec_scene *scene, const struct spec_scene_material *material)
{
	check_place(scene, &material->place);
	check_spectrum(&material->reflectance, 0, 1);
	check_spectrum(&material->eta, 0, 1e6);
	check_spectrum(&material->k, 0, 1e6);
	require(material->id >= 1, "no id");
	for (int i = 0; i < 2; i++)
		require(material->roughness[i] >= 0 && material->roughness[i] <= 1,
			"a roughness out of range");
	require((material->kind == SPEC_SCENE_THINFILM) == (material->stack != NULL),
		"a stack, or none");
	require((material->kind == SPEC_SCENE_DIFFRACTIVE) == (material->preset != NULL),
		"a preset, or none");
}

static void
check_scene(const struct spec_scene *scene)
{
	check_transform(&scene->camera);
	require(scene->fov_deg > 0 && scene->fov_deg < 180, "no field of view");
	require(scene->width > 0 && scene->height > 0 && scene->samples >= 0, "no film");
	for (size_t i = 0; i < scene->shapes; i++)
		check_shape(scene, &scene->shape[i]);
	for (size_t i = 0; i < scene->materials; i++)
		check_material(scene, &scene->material[i]);
	for (size_t i = 0; i < scene->lights; i++) {
		check_place(scene, &scene->light[i].place);
		check_transform(&scene->light[i].world);
		check_spectrum(&scene->light[i].spectrum, 0, DBL_MAX);
		require(scene->light[i].scale >= 0, "a negative scale");
		require(scene->light[i].picture == NULL, "a picture was found");
	}
	for (size_t i = 0; i < scene->warnings; i++)
		require(strncmp(scene->warning[i], NAME, strlen(NAME)) == 0 &&
				!strchr(scene->warning[i], '\n'),
			"no warning");
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	struct spec_error error = {0};
	struct spec_scene scene;

	if (size >= 3 && memcmp(data, "ply", 3) == 0) {
		try_ply(data, size);
		return 0;
	}
	if (memchr(data, '/', size))
		return 0;
	if (spec_scene_parse(&scene, (const char *)data, size, NAME, &error) == SPEC_OK) {
		check_scene(&scene);
	} else {
		check_error(&error, NAME);
		require(!scene.file && !scene.material && !scene.warning, "not left empty");
	}
	spec_scene_free(&scene);
	return 0;
}
