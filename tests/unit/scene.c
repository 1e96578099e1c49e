/* lib/scene: what scene files say, and where the faults are in those that say nothing. */
#include <stdlib.h>
#include <string.h>

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "base/nearest.h"
#include "scene/parse.h"
#include "scene/ply.h"
#include "scene/transform.h"

#include "files.h"

static void
assert_begins(const char *text, const char *part)
{
	if (strncmp(text, part, strlen(part)) != 0)
		fail_msg("'%s' does not begin with '%s'", text, part);
}

#define assert_near(got, want) check_near(got, want, __LINE__)

static void
check_near(double got, double want, int line)
{
	if (!(fabs(got - want) <= 1e-12 * (1 + fabs(want))))
		fail_msg("line %d: got %.17g, want %.17g", line, got, want);
}

/* The scene of a text, which must be one. */
static struct spec_scene
parse(const char *text)
{
	struct spec_scene scene;
	struct spec_error error;

	if (spec_scene_parse(&scene, text, strlen(text), "t.pbrt", &error) != SPEC_OK)
		fail_msg("%s\n%s\n%s", text, error.message, error.place);
	return scene;
}

/* The scene of statements in the world. */
static struct spec_scene
parse_world(const char *statements)
{
	char text[4096];

	assert_true(strlen(statements) + 16 < sizeof text);
	snprintf(text, sizeof text, "WorldBegin %s", statements);
	return parse(text);
}

struct fault {
	enum spec_status status;
	const char *text, *message; /* message: its beginning */
};

static void
check_faults(const struct fault *fault, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		struct spec_error error = {0};
		struct spec_scene scene;
		enum spec_status status = spec_scene_parse(
			&scene, fault[i].text, strlen(fault[i].text), "t.pbrt", &error);

		if (status != fault[i].status)
			fail_msg("%s: status %d, '%s'", fault[i].text, status,
				error.message);
		assert_begins(error.message, fault[i].message);
		assert_int_equal(error.status, status);
		assert_null(scene.file);
		assert_null(scene.material);
		assert_int_equal(spec_scene_parse(&scene, fault[i].text,
					 strlen(fault[i].text), "t.pbrt", NULL),
			status);
	}
}

/* ---- words ---- */

static void
an_empty_world_has_defaults(void **state)
{
	struct spec_scene scene = parse("WorldBegin");

	(void)state;
	for (int i = 0; i < 4; i++)
		for (int j = 0; j < 4; j++)
			assert_true(scene.camera.m[i][j] == (i == j));
	assert_true(scene.fov_deg == 90 && scene.has_screen == 0);
	assert_true(scene.lens_radius == 0 && scene.focal_distance == 1e6);
	assert_true(scene.width == 1280 && scene.height == 720);
	assert_true(scene.samples == 0 && scene.max_depth == -1 && scene.seed == 0);
	assert_null(scene.integrator);
	assert_null(scene.output);
	assert_true(scene.materials == 0 && scene.shapes == 0 && scene.lights == 0);
	assert_int_equal(scene.files, 1);
	assert_string_equal(scene.file[0], "t.pbrt");
	assert_int_equal(scene.warnings, 0);
	spec_scene_free(&scene);
	spec_scene_free(&scene);
	spec_scene_free(NULL);
}

static void
words_are_told_apart(void **state)
{
	struct spec_scene scene = parse(
		"\xef\xbb\xbf# a comment \"with [ all\r\nFilm\"rgb\"\"string filename\"[\"a "
		"\\\"b\\\\\\n\"]#\n\t\"integer  xresolution\t\"+007 \" integer yresolution\"["
		"5]WorldBegin #");

	(void)state;
	assert_string_equal(scene.output, "a \"b\\\n");
	assert_true(scene.width == 7 && scene.height == 5);
	spec_scene_free(&scene);
	scene = parse("WorldBegin Translate 1e1 -.5E+0 +2.");
	spec_scene_free(&scene);
}

static void
faults_of_words_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EFORMAT, "", "t.pbrt:1:1: the file ends before a WorldBegin"},
		{SPEC_EFORMAT, "# x\n ", "t.pbrt:2:2: the file ends before a WorldBegin"},
		{SPEC_EFORMAT, "WorldBegin\n\t[",
			"t.pbrt:2:2: '[' stands where a statement"},
		{SPEC_EFORMAT, "WorldBegin\n \"x\"",
			"t.pbrt:2:2: \"x\" stands where a statement should be"},
		{SPEC_EFORMAT, "WorldBegin\n  Shap \"sphere\"",
			"t.pbrt:2:3: there is no statement 'Shap'; did you mean 'Shape'?"},
		{SPEC_EFORMAT, "worldbegin",
			"t.pbrt:1:1: there is no statement 'worldbegin'; did you mean "
			"'WorldBegin'?"},
		{SPEC_EFORMAT, "WorldBegin WorldEnd",
			"t.pbrt:1:12: there is no statement 'WorldEnd'"},
		{SPEC_EFORMAT, "WorldBegin Shape \"sph\nere\"",
			"t.pbrt:1:18: the string that begins here has no end in its line"},
		{SPEC_EFORMAT, "WorldBegin Shape \"sphere",
			"t.pbrt:1:18: the string that begins here has no end in its line"},
		{SPEC_EFORMAT, "WorldBegin Shape \"sphere\\",
			"t.pbrt:1:18: the string that begins here has a \\"},
		{SPEC_EFORMAT, "WorldBegin Shape \"\\x\"",
			"t.pbrt:1:18: the string that begins here has a \\"},
		/* Columns count characters. */
		{SPEC_EFORMAT,
			"Film \"rgb\" \"string filename\" \"\xc3\xa4\xe2\x82\xac\" x",
			"t.pbrt:1:35: there is no statement 'x'"},
		{SPEC_EFORMAT, "Translate 1 2",
			"t.pbrt:1:14: the file ends where a number"},
		{SPEC_EFORMAT, "Translate 1 2 x",
			"t.pbrt:1:15: 'x' stands where a number should be"},
		{SPEC_EFORMAT, "Translate 1 2 nan", "t.pbrt:1:15: 'nan' stands where"},
		{SPEC_EFORMAT, "Translate 1 2 inf", "t.pbrt:1:15: 'inf' stands where"},
		{SPEC_EFORMAT, "Translate 1 2 1e999", "t.pbrt:1:15: '1e999' stands"},
		{SPEC_EFORMAT, "Translate 1 2 3m", "t.pbrt:1:15: '3m' stands where"},
		{SPEC_EFORMAT, "Translate 1 2 \"3\"", "t.pbrt:1:15: \"3\" stands where"},
		{SPEC_EFORMAT, "Translate [1 2 3]", "t.pbrt:1:11: '[' stands where"},
		{SPEC_EFORMAT, "Transform 1 0", "t.pbrt:1:11: '1' stands where a [ should"},
		{SPEC_EFORMAT, "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 2]",
			"t.pbrt:1:44: '2' stands where a ] should be"},
		{SPEC_EFORMAT, "Camera perspective",
			"t.pbrt:1:8: 'perspective' stands where the \"string\" of Camera "
			"should be"},
		{SPEC_EFORMAT, "Camera", "t.pbrt:1:7: the file ends where the \"string\""},
		{SPEC_EFORMAT, "Shape \"sphere\"",
			"t.pbrt:1:1: Shape cannot stand before WorldBegin"},
		{SPEC_EFORMAT, "WorldBegin\nFilm \"rgb\"",
			"t.pbrt:2:1: Film cannot stand behind WorldBegin"},
		{SPEC_EFORMAT, "WorldBegin WorldBegin",
			"t.pbrt:1:12: WorldBegin cannot stand behind WorldBegin"},
	};
	struct spec_scene scene;
	struct spec_error error;

	(void)state;
	check_faults(faults, COUNT(faults));
	assert_int_equal(spec_scene_parse(&scene, "World\0Begin", 11, "t.pbrt", &error),
		SPEC_EFORMAT);
	assert_contains(error.message, "'t.pbrt' has a zero byte in it");
	assert_int_equal(spec_scene_parse(&scene, "\x1f\x8b\x08", 3, "t.pbrt", &error),
		SPEC_EUNSUPPORTED);
	assert_contains(error.message, "'t.pbrt' is compressed");
}

static void
faults_of_parameters_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EFORMAT, "Camera \"perspective\"\n  \"fov\" 30",
			"t.pbrt:2:3: a parameter is declared by its type and its name"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov deg\" 30",
			"t.pbrt:1:22: a parameter is declared"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"\" 30",
			"t.pbrt:1:22: a parameter is declared"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"flaot fov\" 30",
			"t.pbrt:1:22: there is no type 'flaot' of parameters; did you mean "
			"'float'?"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\" [\n30 x ]",
			"t.pbrt:2:4: 'x' stands where a number should be"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\" [30 \"x\"]",
			"t.pbrt:1:38: a value of 'fov' should be a number, not \"x\""},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\" [30",
			"t.pbrt:1:37: a value of 'fov' or a ] is missing here"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\"",
			"t.pbrt:1:33: a value of 'fov' is missing here"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\" [ [30] ]",
			"t.pbrt:1:36: a value of 'fov' or a ] is missing here"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\" []",
			"t.pbrt:1:22: 'fov' has no value"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\" [30 40]",
			"t.pbrt:1:22: 'fov' of Camera \"perspective\" takes 1 value, not 2"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fov\" 3 \"float fov\" 4",
			"t.pbrt:1:36: 'fov' of Camera \"perspective\" is given twice"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"integer fov\" 3",
			"t.pbrt:1:22: 'fov' of Camera \"perspective\" is of type float, not "
			"integer"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float fow\" 3",
			"t.pbrt:1:22: Camera \"perspective\" has no parameter 'fow'; did you "
			"mean 'fov'?"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float length\" 3",
			"t.pbrt:1:22: Camera \"perspective\" has no parameter 'length'"},
		{SPEC_EFORMAT, "Film \"rgb\" \"integer xresolution\" 1.5",
			"t.pbrt:1:34: a value of 'xresolution' should be a whole number, not "
			"'1.5'"},
		{SPEC_EFORMAT, "Film \"rgb\" \"integer xresolution\" -",
			"t.pbrt:1:34: a value of 'xresolution' should be a whole number"},
		{SPEC_ERANGE, "Film \"rgb\" \"integer xresolution\" 2147483648",
			"t.pbrt:1:34: a value of 'xresolution' is larger than 2147483647"},
		{SPEC_ERANGE, "Film \"rgb\" \"integer xresolution\" 0",
			"t.pbrt:1:12: 'xresolution' of Film \"rgb\" is outside 1..2147483647: "
			"0"},
		{SPEC_EFORMAT, "Film \"rgb\" \"string filename\" 5",
			"t.pbrt:1:30: a value of 'filename' should be a string, not '5'"},
		{SPEC_EFORMAT, "Film \"rgb\" \"string filename\" [\"a\" \"b\"]",
			"t.pbrt:1:12: 'filename' of Film \"rgb\" takes 1 value, not 2"},
		{SPEC_EFORMAT, "Integrator \"path\" \"bool regularize\" \"false\"",
			"t.pbrt:1:37: a value of 'regularize' should be true or false "
			"without quotes, not \"false\""},
		{SPEC_EFORMAT, "Integrator \"path\" \"bool regularize\" 1",
			"t.pbrt:1:37: a value of 'regularize' should be true or false"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

static void
names_that_were_meant_are_found(void **state)
{
	static const struct {
		const char *name;
		int other;
	} table[] = {{"Shape", 1}, {"Scale", 2}, {"ConcatTransform", 3}, {NULL, 0}};

	(void)state;
	assert_string_equal(spec_nearest_name("shape", table, sizeof *table), "Shape");
	assert_string_equal(spec_nearest_name("Sclae", table, sizeof *table), "Scale");
	assert_string_equal(spec_nearest_name("ConcatTransfrom", table, sizeof *table),
		"ConcatTransform");
	assert_null(spec_nearest_name("S", table, sizeof *table));
	assert_null(spec_nearest_name("Sphere", table, sizeof *table));
	assert_null(spec_nearest_name("", table, sizeof *table));
}

/* ---- settings ---- */

static void
settings_are_kept(void **state)
{
	struct spec_scene scene =
		parse("Camera \"perspective\" \"float fov\" 30 \"float lensradius\" .1 "
		      "\"float focaldistance\" 4\n"
		      "Film \"spectral\" \"integer xresolution\" 400 \"integer "
		      "yresolution\" 300 \"string filename\" \"out.exr\"\n"
		      "Sampler \"halton\" \"integer pixelsamples\" 64 \"integer seed\" -5\n"
		      "Option \"seed\" 7\n"
		      "Integrator \"path\" \"integer maxdepth\" 12 \"bool regularize\" "
		      "false \"string lightsampler\" \"power\"\n"
		      "PixelFilter \"box\"\nAccelerator \"bvh\" \"string splitmethod\" "
		      "\"sah\"\nColorSpace \"srgb\"\nMediumInterface \"\" \"\"\n"
		      "MediumInterface \"\"\nActiveTransform All\nTransformTimes 0 1\n"
		      "Option \"disable-pixel_Jitter\" false WorldBegin");

	(void)state;
	assert_true(scene.fov_deg == 30 && scene.lens_radius == 0.1);
	assert_true(scene.focal_distance == 4 && !scene.has_screen);
	assert_true(scene.width == 400 && scene.height == 300);
	assert_string_equal(scene.output, "out.exr");
	assert_true(scene.samples == 64 && scene.seed == -5 && scene.max_depth == 12);
	assert_string_equal(scene.integrator, "path");
	assert_int_equal(scene.warnings, 0);
	spec_scene_free(&scene);

	/* The last one holds, and forgets what the one before it said. */
	scene = parse(
		"Camera \"perspective\" \"float fov\" 30 \"float screenwindow\" [0 1 2 3]"
		"Camera \"perspective\" Film \"rgb\" \"string filename\" \"a\" "
		"\"integer xresolution\" 1 Film \"rgb\" Option \"seed\" 7 WorldBegin");
	assert_true(scene.fov_deg == 90 && !scene.has_screen);
	assert_true(scene.width == 1280 && scene.seed == 7);
	assert_null(scene.output);
	spec_scene_free(&scene);
}

static void
screens_have_corners(void **state)
{
	struct spec_scene scene =
		parse("Camera \"perspective\" \"float frameaspectratio\" 2 WorldBegin");

	(void)state;
	assert_true(scene.has_screen);
	assert_true(scene.screen[0] == -2 && scene.screen[1] == 2);
	assert_true(scene.screen[2] == -1 && scene.screen[3] == 1);
	spec_scene_free(&scene);
	scene = parse("Camera \"perspective\" \"float frameaspectratio\" .5 WorldBegin");
	assert_true(scene.screen[0] == -1 && scene.screen[1] == 1);
	assert_true(scene.screen[2] == -2 && scene.screen[3] == 2);
	spec_scene_free(&scene);
	scene = parse("Camera \"perspective\" \"float screenwindow\" [-1 .5 0 2] \"float "
		      "frameaspectratio\" .5 WorldBegin");
	assert_true(scene.screen[0] == -1 && scene.screen[1] == 0.5);
	assert_true(scene.screen[2] == 0 && scene.screen[3] == 2);
	spec_scene_free(&scene);
}

static void
cameras_may_look_all_around(void **state)
{
	struct spec_scene scene = parse("Camera \"perspective\" \"float fov\" 30 Camera "
					"\"spherical\" \"string mapping\" "
					"\"equirectangular\" WorldBegin");

	(void)state;
	assert_true(scene.all_around);
	spec_scene_free(&scene);
	scene = parse("Camera \"spherical\" \"string mapping\" \"equirectangular\" Camera "
		      "\"perspective\" WorldBegin");
	assert_true(!scene.all_around);
	spec_scene_free(&scene);
}

static void
samples_may_be_rows_and_columns(void **state)
{
	struct spec_scene scene = parse("Sampler \"stratified\" \"integer xsamples\" 8 "
					"\"bool jitter\" true WorldBegin");

	(void)state;
	assert_int_equal(scene.samples, 32);
	spec_scene_free(&scene);
	scene = parse("Sampler \"stratified\" WorldBegin");
	assert_int_equal(scene.samples, 0);
	spec_scene_free(&scene);
}

static void
what_makes_no_difference_is_a_warning(void **state)
{
	static const char *const warnings[] = {
		"t.pbrt:1:22: 'shutteropen' of Camera \"perspective\" is not used",
		"t.pbrt:2:12: 'iso' of Film \"rgb\" is not used: ",
		"t.pbrt:2:28: 'sensor' of Film \"rgb\" is not used: ",
		"t.pbrt:3:1: Integrator \"volpath\" is done as Integrator \"path\"",
		"t.pbrt:4:1: PixelFilter \"gaussian\" is done as PixelFilter \"box\"",
		"t.pbrt:5:1: PixelFilter \"box\" is done as PixelFilter \"box\"",
		"t.pbrt:6:1: Option \"pixel-stats\" is not used",
		"t.pbrt:7:44: 'nbuckets' of Film \"spectral\" is not used: ",
	};
	struct spec_scene scene = parse(
		"Camera \"perspective\" \"float shutteropen\" 0\n"
		"Film \"rgb\" \"float iso\" 100 \"string sensor\" \"nikon_d850\"\n"
		"Integrator \"volpath\"\nPixelFilter \"gaussian\" \"float xradius\" 2\n"
		"PixelFilter \"box\" \"float xradius\" 2\nOption \"pixel-stats\" true\n"
		"Film \"rgb\" \"float iso\" 200 Film \"spectral\" \"integer nbuckets\" 4 "
		"WorldBegin");

	(void)state;
	assert_int_equal(scene.warnings, COUNT(warnings));
	for (size_t i = 0; i < COUNT(warnings); i++)
		assert_begins(scene.warning[i], warnings[i]);
	spec_scene_free(&scene);
}

static void
faults_of_settings_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EUNSUPPORTED, "Camera \"orthographic\"",
			"t.pbrt:1:1: Camera \"orthographic\" is not supported"},
		{SPEC_EUNSUPPORTED, "Camera \"spherical\"",
			"t.pbrt:1:1: Camera \"spherical\" must be \"string mapping\""},
		{SPEC_EUNSUPPORTED, "Camera \"spherical\" \"string mapping\" \"equalarea\"",
			"t.pbrt:1:20: 'mapping' of Camera \"spherical\" must be"},
		{SPEC_EFORMAT, "Camera \"spherical\" \"float fov\" 30",
			"t.pbrt:1:20: Camera \"spherical\" has no parameter 'fov'"},
		{SPEC_EFORMAT, "Camera \"perspectiv\"",
			"t.pbrt:1:1: there is no Camera \"perspectiv\"; did you mean "
			"\"perspective\"?"},
		{SPEC_ERANGE, "Camera \"perspective\" \"float fov\" 0",
			"t.pbrt:1:22: 'fov' of Camera \"perspective\" is not positive: 0"},
		{SPEC_ERANGE, "Camera \"perspective\" \"float fov\" 180",
			"t.pbrt:1:22: 'fov' of Camera \"perspective\" is not less than 180 "
			"degrees: 180"},
		{SPEC_ERANGE, "Camera \"perspective\" \"float lensradius\" -1",
			"t.pbrt:1:22: 'lensradius' of Camera \"perspective\" is less than 0: "
			"-1"},
		{SPEC_ERANGE, "Camera \"perspective\" \"float focaldistance\" 0",
			"t.pbrt:1:22: 'focaldistance' of Camera \"perspective\" is not "
			"positive"},
		{SPEC_ERANGE, "Camera \"perspective\" \"float frameaspectratio\" 0",
			"t.pbrt:1:22: 'frameaspectratio' of Camera \"perspective\" is not"},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float screenwindow\" [0 1]",
			"t.pbrt:1:22: 'screenwindow' of Camera \"perspective\" takes 4 "
			"values, not 2"},
		{SPEC_ERANGE, "Camera \"perspective\" \"float screenwindow\" [1 0 0 1]",
			"t.pbrt:1:22: 'screenwindow' of Camera \"perspective\" is not x0"},
		{SPEC_EUNSUPPORTED, "Film \"rgb\" \"float cropwindow\" [0 1 0 1]",
			"t.pbrt:1:12: 'cropwindow' of Film \"rgb\" is not supported: the "
			"renderer's option --crop crops"},
		{SPEC_EUNSUPPORTED, "Film \"rgb\" \"integer pixelbounds\" [0 1 0 1]",
			"t.pbrt:1:12: 'pixelbounds' of Film \"rgb\" is not supported: the "
			"renderer's option --crop crops"},
		{SPEC_EFORMAT, "Film \"image\"", "t.pbrt:1:1: there is no Film \"image\""},
		{SPEC_ERANGE, "Sampler \"x\" \"integer pixelsamples\" 0",
			"t.pbrt:1:13: 'pixelsamples' of Sampler \"x\" is outside 1.."},
		{SPEC_ERANGE, "Sampler \"x\" \"integer xsamples\" 2147483647",
			"t.pbrt:1:1: Sampler \"x\" has more than 2147483647 samples"},
		{SPEC_EUNSUPPORTED, "Integrator \"bdpt\"",
			"t.pbrt:1:1: Integrator \"bdpt\" is not supported"},
		{SPEC_EFORMAT, "Integrator \"pth\"",
			"t.pbrt:1:1: there is no Integrator \"pth\"; did you mean \"path\"?"},
		{SPEC_EUNSUPPORTED, "Integrator \"path\" \"bool regularize\" true",
			"t.pbrt:1:19: 'regularize' of Integrator \"path\" is not supported"},
		{SPEC_ERANGE, "Integrator \"path\" \"integer maxdepth\" -1",
			"t.pbrt:1:19: 'maxdepth' of Integrator \"path\" is outside 0.."},
		{SPEC_EFORMAT, "PixelFilter \"bx\"", "t.pbrt:1:1: there is no PixelFilter"},
		{SPEC_EUNSUPPORTED, "ColorSpace \"rec2020\"",
			"t.pbrt:1:1: ColorSpace \"rec2020\" is not supported"},
		{SPEC_EFORMAT, "ColorSpace \"x\"", "t.pbrt:1:1: there is no ColorSpace"},
		{SPEC_EUNSUPPORTED, "Option \"forcediffuse\" true",
			"t.pbrt:1:1: Option \"forcediffuse\" is not supported"},
		{SPEC_EFORMAT, "Option \"forcediffuse\" 5",
			"t.pbrt:1:1: Option \"forcediffuse\" is neither true nor false"},
		{SPEC_EFORMAT, "Option \"sede\" 5",
			"t.pbrt:1:1: there is no Option \"sede\"; did you mean \"seed\"?"},
		{SPEC_EFORMAT, "Option \"seeds\" 5",
			"t.pbrt:1:1: there is no Option \"seeds\"; did you mean \"seed\"?"},
		{SPEC_EFORMAT, "Option \"seed\" x",
			"t.pbrt:1:15: 'x' stands where a number"},
		{SPEC_ERANGE, "Option \"seed\" 1.5",
			"t.pbrt:1:15: the seed is not a whole"},
		{SPEC_EFORMAT, "Option \"seed\"", "t.pbrt:1:14: a value of Option"},
		{SPEC_EUNSUPPORTED, "ActiveTransform EndTime",
			"t.pbrt:1:1: ActiveTransform EndTime is not supported"},
		{SPEC_EUNSUPPORTED, "MediumInterface \"fog\" \"\"",
			"t.pbrt:1:1: media are not supported"},
		{SPEC_EUNSUPPORTED, "MediumInterface \"\" \"fog\"",
			"t.pbrt:1:1: media are not supported"},
		{SPEC_EUNSUPPORTED, "MakeNamedMedium \"fog\"",
			"t.pbrt:1:1: MakeNamedMedium is not supported"},
		{SPEC_EUNSUPPORTED, "WorldBegin Texture \"a\" \"spectrum\" \"imagemap\"",
			"t.pbrt:1:12: Texture is not supported"},
		{SPEC_EUNSUPPORTED, "WorldBegin\nObjectBegin \"a\"",
			"t.pbrt:2:1: ObjectBegin is not supported"},
		{SPEC_EUNSUPPORTED, "WorldBegin\nObjectInstance \"a\"",
			"t.pbrt:2:1: ObjectInstance is not supported"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

/* ---- transforms ---- */

/* The world transform of the last shape in a text of the world. */
static struct spec_transform
transform_of(const char *statements)
{
	char text[1024];
	struct spec_scene scene;
	struct spec_transform transform;

	snprintf(text, sizeof text, "%s Shape \"sphere\"", statements);
	scene = parse_world(text);
	transform = scene.shape[scene.shapes - 1].world;
	spec_scene_free(&scene);
	return transform;
}

/* Whether the first three rows are those, the last is 0 0 0 1, and the inverse is one. */
static void
check_transform(const struct spec_transform *transform, const double rows[12])
{
	for (int i = 0; i < 4; i++) {
		for (int j = 0; j < 4; j++) {
			double product = 0, wanted = i == j;

			for (int k = 0; k < 4; k++)
				product += transform->m[i][k] * transform->inverse[k][j];
			if (!(fabs(product - wanted) <= 1e-12))
				fail_msg("the inverse is off by %g", product - wanted);
			assert_near(transform->m[i][j], i < 3 ? rows[4 * i + j] : wanted);
		}
	}
}

static void
transforms_are_pbrts(void **state)
{
	static const struct {
		const char *text;
		double rows[12];
	} known[] = {
		{"", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
		{"Translate 1 2 3", {1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3}},
		{"Translate 1 2 3 Identity", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
		{"Scale 2 -3 4", {2, 0, 0, 0, 0, -3, 0, 0, 0, 0, 4, 0}},
		/* The last one is applied to points first. */
		{"Translate 1 2 3 Scale 2 3 4", {2, 0, 0, 1, 0, 3, 0, 2, 0, 0, 4, 3}},
		{"Scale 2 3 4 Translate 1 2 3", {2, 0, 0, 2, 0, 3, 0, 6, 0, 0, 4, 12}},
		{"Rotate 90 0 0 1", {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0}},
		{"Rotate 90 2 0 0", {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0}},
		{"Rotate -270 0 1e-300 0", {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0}},
		{"Rotate 120 1 1 1", {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0}},
		{"Rotate 30 0 0 -5", {0.86602540378443864676, 0.5, 0, 0, -0.5,
					     0.86602540378443864676, 0, 0, 0, 0, 1, 0}},
		{"Translate 9 9 9 Transform [1 2 3 0 4 5 6 0 7 8 10 0 11 12 13 1]",
			{1, 4, 7, 11, 2, 5, 8, 12, 3, 6, 10, 13}},
		{"Transform [2 0 0 0 0 2 0 0 0 0 2 0 6 0 0 2]",
			{1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0}},
		{"Translate 1 0 0 ConcatTransform [0 1 0 0 -1 0 0 0 0 0 1 0 5 6 7 1]",
			{0, -1, 0, 6, 1, 0, 0, 6, 0, 0, 1, 7}},
		{"Scale 1e-9 1e-9 1e-9 ConcatTransform [1e9 0 0 0 0 1 0 0 0 0 1e-9 0 0 0 0 "
		 "1]",
			{1, 0, 0, 0, 0, 1e-9, 0, 0, 0, 0, 1e-18, 0}},
		/* x = up cross z: looking along +z, x goes right and y up. */
		{"LookAt 0 0 -5 0 0 0 0 1 0", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5}},
		{"LookAt 0 0 5 0 0 0 0 1 0", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 5}},
		{"LookAt 1 2 3 4 6 3 0 0 7",
			{-0.8, 0.6, 0, -0.4, 0, 0, 1, -3, 0.6, 0.8, 0, -2.2}},
		{"Translate 1 2 3 CoordinateSystem \"a\" Scale 2 2 2 CoordSysTransform \"a\"",
			{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3}},
		{"Translate 1 2 3 CoordSysTransform \"world\"",
			{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
		{"Translate 1 2 3 AttributeBegin Scale 2 2 2 AttributeEnd TransformBegin "
		 "Scale 3 3 3 TransformEnd",
			{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3}},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		struct spec_transform transform = transform_of(known[i].text);

		check_transform(&transform, known[i].rows);
	}
}

static void
inverses_are_exact_where_they_can_be(void **state)
{
	struct spec_transform transform =
		transform_of("Transform [1 2 3 0 4 5 6 0 7 8 10 0 11 12 13 1]");
	static const double inverse[3][3] = {
		{-2 / 3.0, -2 / 3.0, 1}, {-4 / 3.0, 11 / 3.0, -2}, {1, -2, 1}};

	(void)state;
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			assert_near(transform.inverse[i][j], inverse[i][j]);
	for (int i = 0; i < 3; i++)
		assert_near(transform.inverse[i][3],
			-inverse[i][0] * 11 - inverse[i][1] * 12 - inverse[i][2] * 13);
	transform = transform_of("Translate 1 2 3 Scale 2 4 8");
	assert_true(transform.inverse[0][0] == 0.5 && transform.inverse[0][3] == -0.5);
	assert_true(transform.inverse[1][3] == -0.5 && transform.inverse[2][3] == -0.375);
}

/* The camera is where LookAt says, and other statements move the world before it. */
static void
cameras_stand_in_the_world(void **state)
{
	static const double rows[] = {-0.8, 0, 0.6, 1, 0.6, 0, 0.8, 2, 0, 1, 0, 3};
	static const double mirrored[] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 5};
	const double middle[3] = {0, 0, 1};
	double ahead[3];
	struct spec_scene scene =
		parse("LookAt 1 2 3 4 6 3 0 0 1 Camera \"perspective\" WorldBegin "
		      "CoordSysTransform \"camera\" Shape \"sphere\"");

	(void)state;
	check_transform(&scene.camera, rows);
	check_transform(&scene.shape[0].world, rows);
	spec_transform_point(&scene.camera, middle, ahead);
	assert_near(ahead[0], 1.6);
	assert_near(ahead[1], 2.8);
	assert_near(ahead[2], 3);
	spec_scene_free(&scene);
	scene = parse("LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin");
	check_transform(&scene.camera, mirrored);
	spec_scene_free(&scene);
}

static void
faults_of_transforms_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_ERANGE, " Scale 1 0 1", "t.pbrt:1:2: a scale of 0 has no inverse"},
		{SPEC_ERANGE, "Rotate 90 0 0 0", "t.pbrt:1:1: the axis of a rotation"},
		{SPEC_ERANGE, "LookAt 1 2 3 1 2 3 0 1 0", "t.pbrt:1:1: the eye is where"},
		{SPEC_ERANGE, "LookAt 0 0 0 0 0 1 0 0 0",
			"t.pbrt:1:1: the direction upwards"},
		{SPEC_ERANGE, "LookAt 0 0 0 0 0 1 0 0 -2",
			"t.pbrt:1:1: the camera looks along the direction upwards"},
		{SPEC_ERANGE, "Transform [1 2 3 0 4 5 6 0 7 8 9 0 0 0 0 1]",
			"t.pbrt:1:1: the matrix has no inverse"},
		{SPEC_ERANGE, "ConcatTransform [1 0 0 0 0 0 0 0 0 0 1 0 0 0 0 1]",
			"t.pbrt:1:1: the matrix has no inverse"},
		{SPEC_ERANGE, "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0]",
			"t.pbrt:1:1: the matrix has no inverse"},
		{SPEC_EUNSUPPORTED, "Transform [1 0 0 .1 0 1 0 0 0 0 1 0 0 0 0 1]",
			"t.pbrt:1:1: perspective transforms are not supported"},
		{SPEC_ERANGE, "Scale 1e200 1 1\nScale 1e200 1 1",
			"t.pbrt:2:1: the transform is too large or too small"},
		{SPEC_ERANGE, "Scale 1e-200 1 1\nScale 1e-200 1 1",
			"t.pbrt:2:1: the transform is too large or too small"},
		{SPEC_EFORMAT, "CoordSysTransform \"here\"",
			"t.pbrt:1:1: there is no CoordinateSystem \"here\" so far"},
		{SPEC_EFORMAT, "WorldBegin\nAttributeEnd",
			"t.pbrt:2:1: AttributeEnd ends what was not begun"},
		{SPEC_EFORMAT, "WorldBegin AttributeBegin\nTransformBegin AttributeEnd",
			"t.pbrt:1:12: what begins here is never ended"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

/* ---- shapes ---- */

static void
spheres_and_disks_are_whole(void **state)
{
	struct spec_scene scene = parse_world(
		"Shape \"sphere\" Shape \"sphere\" \"float radius\" 2 \"float zmin\" -2 "
		"\"float zmax\" 3 \"float phimax\" 360 ReverseOrientation Shape \"disk\" "
		"Shape \"disk\" \"float radius\" 3 \"float innerradius\" 1 \"float height\" "
		"-4 AttributeBegin ReverseOrientation\n Shape \"sphere\" AttributeEnd Shape "
		"\"disk\"");

	(void)state;
	assert_int_equal(scene.shapes, 6);
	assert_int_equal(scene.shape[0].kind, SPEC_SCENE_SPHERE);
	assert_true(scene.shape[0].radius == 1 && scene.shape[1].radius == 2);
	assert_true(!scene.shape[1].reverse_orientation);
	assert_int_equal(scene.shape[2].kind, SPEC_SCENE_DISK);
	assert_true(scene.shape[2].radius == 1 && scene.shape[2].inner_radius == 0);
	assert_true(scene.shape[2].reverse_orientation && scene.shape[2].height == 0);
	assert_true(scene.shape[3].radius == 3 && scene.shape[3].inner_radius == 1);
	assert_true(scene.shape[3].height == -4);
	assert_true(!scene.shape[4].reverse_orientation);
	assert_true(scene.shape[5].reverse_orientation);
	assert_true(scene.shape[4].place.line == 2 && scene.shape[4].place.column == 2);
	assert_true(scene.shape[0].light == SPEC_SCENE_NONE);
	/* All of the default material. */
	assert_int_equal(scene.materials, 1);
	assert_int_equal(scene.material[0].kind, SPEC_SCENE_DIFFUSE);
	assert_int_equal(scene.material[0].id, 1);
	assert_true(scene.material[0].reflectance.kind == SPEC_SCENE_CONSTANT);
	assert_true(scene.material[0].reflectance.value == 0.5);
	assert_true(scene.shape[0].material == 0 && scene.shape[5].material == 0);
	spec_scene_free(&scene);
}

static void
meshes_have_their_numbers(void **state)
{
	struct spec_scene scene = parse_world(
		"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] Shape "
		"\"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 .5] \"integer "
		"indices\" [0 1 2 2 1 3] \"normal N\" [0 0 1 0 0 1 0 0 1 0 1 0] \"point2 "
		"uv\" [0 0 1 0 0 1 1 .25]");
	const struct spec_scene_shape *mesh = &scene.shape[1];

	(void)state;
	assert_int_equal(scene.shapes, 2);
	assert_true(scene.shape[0].vertices == 3 && scene.shape[0].triangles == 1);
	assert_true(scene.shape[0].index[2] == 2 && !scene.shape[0].normal);
	assert_null(scene.shape[0].uv);
	assert_int_equal(mesh->kind, SPEC_SCENE_MESH);
	assert_true(mesh->vertices == 4 && mesh->triangles == 2);
	assert_true(mesh->point[9] == 1 && mesh->point[11] == 0.5F);
	assert_true(mesh->normal[10] == 1 && mesh->uv[7] == 0.25F);
	assert_true(mesh->index[3] == 2 && mesh->index[5] == 3);
	spec_scene_free(&scene);
}

static void
faults_of_shapes_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EUNSUPPORTED, "WorldBegin Shape \"cylinder\"",
			"t.pbrt:1:12: Shape \"cylinder\" is not supported"},
		{SPEC_EFORMAT, "WorldBegin Shape \"Sphere\"",
			"t.pbrt:1:12: there is no Shape \"Sphere\"; did you mean \"sphere\"?"},
		{SPEC_ERANGE, "WorldBegin Shape \"sphere\"\n\"float radius\" 0",
			"t.pbrt:2:1: 'radius' of Shape \"sphere\" is not positive: 0"},
		{SPEC_EUNSUPPORTED, "WorldBegin Shape \"sphere\" \"float zmin\" 0",
			"t.pbrt:1:27: 'zmin' of Shape \"sphere\" is 0, but parts"},
		{SPEC_EUNSUPPORTED, "WorldBegin Shape \"sphere\" \"float zmax\" 0",
			"t.pbrt:1:27: 'zmax' of Shape \"sphere\" is 0, but parts"},
		{SPEC_EUNSUPPORTED, "WorldBegin Shape \"disk\" \"float phimax\" 180",
			"t.pbrt:1:25: 'phimax' of Shape \"disk\" is 180, but parts"},
		{SPEC_EUNSUPPORTED, "WorldBegin Shape \"sphere\" \"float alpha\" .5",
			"t.pbrt:1:27: 'alpha' of Shape \"sphere\" is not supported"},
		{SPEC_EUNSUPPORTED, "WorldBegin Shape \"sphere\" \"texture radius\" \"a\"",
			"t.pbrt:1:27: 'radius' of Shape \"sphere\" is a texture, and"},
		{SPEC_ERANGE, "WorldBegin Shape \"disk\" \"float innerradius\" 2",
			"t.pbrt:1:25: 'innerradius' of Shape \"disk\" is outside 0..1: 2"},
		{SPEC_ERANGE, "WorldBegin Shape \"disk\" \"float innerradius\" 1",
			"t.pbrt:1:12: Shape \"disk\" has no area"},
		{SPEC_EFORMAT, "WorldBegin Shape \"trianglemesh\"",
			"t.pbrt:1:12: Shape \"trianglemesh\" needs its vertices"},
		{SPEC_EFORMAT, "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1]",
			"t.pbrt:1:33: 'P' of Shape \"trianglemesh\" has 4 numbers"},
		{SPEC_EFORMAT,
			"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0]",
			"t.pbrt:1:12: Shape \"trianglemesh\" needs indices, for it has not 3 "
			"vertices but 2"},
		{SPEC_EFORMAT,
			"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
			"\"integer indices\" [0 1 2 0]",
			"t.pbrt:1:64: 'indices' of Shape \"trianglemesh\" has 4 numbers"},
		{SPEC_ERANGE,
			"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
			"\"integer indices\" [0 1 3]",
			"t.pbrt:1:64: 'indices' of Shape \"trianglemesh\" has a vertex 3, and "
			"the last one is 2"},
		{SPEC_ERANGE,
			"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
			"\"integer indices\" [0 1 -1]",
			"t.pbrt:1:64: 'indices' of Shape \"trianglemesh\" has a vertex -1"},
		{SPEC_EFORMAT,
			"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
			"\"normal N\" [0 0 1]",
			"t.pbrt:1:64: 'N' of Shape \"trianglemesh\" has 3 numbers, but 9"},
		{SPEC_ERANGE,
			"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1e39 0]",
			"t.pbrt:1:33: 'P' of Shape \"trianglemesh\" has a number that is too "
			"large"},
		{SPEC_EUNSUPPORTED,
			"WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
			"\"vector3 S\" [0 0 1]",
			"t.pbrt:1:64: 'S' of Shape \"trianglemesh\" is not supported"},
		{SPEC_EFORMAT, "WorldBegin Shape \"plymesh\"",
			"t.pbrt:1:12: Shape \"plymesh\" needs a \"string filename\""},
		{SPEC_EIO,
			"WorldBegin Shape \"plymesh\" \"string filename\" \"no-such.ply\"",
			"t.pbrt:1:28: there is no file 'no-such.ply'"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

/* ---- materials ---- */

static void
materials_have_defaults(void **state)
{
	struct spec_scene scene = parse_world(
		"Material \"diffuse\" Material \"conductor\" Material \"dielectric\" Material "
		"\"interface\" Material \"\" Material \"none\"");
	const struct spec_scene_material *material = scene.material;

	(void)state;
	assert_int_equal(scene.materials, 6);
	assert_int_equal(material[0].kind, SPEC_SCENE_DIFFUSE);
	assert_true(material[0].reflectance.value == 0.5);
	assert_int_equal(material[1].kind, SPEC_SCENE_CONDUCTOR);
	assert_int_equal(material[1].eta.kind, SPEC_SCENE_CURVE);
	assert_contains(material[1].eta.curve.title, "Copper");
	assert_string_equal(material[1].eta.curve.column[0], "n");
	assert_contains(material[1].k.curve.title, "Copper");
	assert_string_equal(material[1].k.curve.column[0], "k");
	assert_true(material[1].roughness[0] == 0 && material[1].roughness[1] == 0);
	assert_int_equal(material[2].kind, SPEC_SCENE_DIELECTRIC);
	assert_true(material[2].eta.kind == SPEC_SCENE_CONSTANT);
	assert_true(material[2].eta.value == 1.5);
	for (int i = 3; i < 6; i++)
		assert_int_equal(material[i].kind, SPEC_SCENE_INTERFACE);
	for (uint32_t i = 0; i < 6; i++)
		assert_int_equal(material[i].id, i + 1);
	spec_scene_free(&scene);
}

static void
roughness_becomes_alpha(void **state)
{
	struct spec_scene scene = parse_world(
		"Material \"dielectric\" \"float roughness\" .25 "
		"Material \"dielectric\" \"float uroughness\" .25 \"float roughness\" .01 "
		"Material \"conductor\" \"float vroughness\" .25 \"bool remaproughness\" "
		"false");

	(void)state;
	assert_near(scene.material[0].roughness[0], 0.5);
	assert_near(scene.material[0].roughness[1], 0.5);
	assert_near(scene.material[1].roughness[0], 0.5);
	assert_near(scene.material[1].roughness[1], 0.1);
	assert_near(scene.material[2].roughness[0], 0);
	assert_near(scene.material[2].roughness[1], 0.25);
	spec_scene_free(&scene);
}

static void
materials_of_ours_are_checked(void **state)
{
	struct spec_scene scene = parse_world(
		"Material \"thinfilm\" \"string stack\" \"air | 1.33 500nm | air\" \"integer "
		"id\" 9 "
		"Material \"thinfilm\" \"string stack\" \"air | 1.33 * | air\" \"string "
		"thickness\" \"gravity 530nm..730nm -y\" "
		"Material \"diffractive\" \"string preset\" \"dvd\"");
	const struct spec_scene_material *material = scene.material;

	(void)state;
	assert_int_equal(material[0].kind, SPEC_SCENE_THINFILM);
	assert_string_equal(material[0].stack, "air | 1.33 500nm | air");
	assert_null(material[0].thickness);
	assert_int_equal(material[0].id, 9);
	assert_string_equal(material[1].thickness, "gravity 530nm..730nm -y");
	assert_int_equal(material[1].id, 2);
	assert_int_equal(material[2].kind, SPEC_SCENE_DIFFRACTIVE);
	assert_string_equal(material[2].preset, "dvd");
	spec_scene_free(&scene);
}

static void
materials_may_have_names(void **state)
{
	struct spec_scene scene = parse_world(
		"MakeNamedMaterial \"a\" \"string type\" \"dielectric\" \"float eta\" 2 "
		"Material \"diffuse\" Shape \"sphere\" AttributeBegin NamedMaterial \"a\" "
		"Shape \"sphere\" AttributeEnd Shape \"sphere\" NamedMaterial \"a\" Shape "
		"\"disk\"");

	(void)state;
	assert_int_equal(scene.materials, 2);
	assert_int_equal(scene.material[0].kind, SPEC_SCENE_DIELECTRIC);
	assert_true(scene.material[0].eta.value == 2);
	assert_true(scene.shape[0].material == 1 && scene.shape[1].material == 0);
	assert_true(scene.shape[2].material == 1 && scene.shape[3].material == 0);
	spec_scene_free(&scene);
}

static void
faults_of_materials_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EUNSUPPORTED, "WorldBegin Material \"coateddiffuse\"",
			"t.pbrt:1:12: Material \"coateddiffuse\" is not supported"},
		{SPEC_EFORMAT, "WorldBegin Material \"difuse\"",
			"t.pbrt:1:12: there is no Material \"difuse\"; did you mean "
			"\"diffuse\"?"},
		{SPEC_EFORMAT,
			"WorldBegin Material \"diffuse\" \"string type\" \"diffuse\"",
			"t.pbrt:1:31: 'type' of Material \"diffuse\" is MakeNamedMaterial's"},
		{SPEC_EUNSUPPORTED,
			"WorldBegin Material \"diffuse\" \"texture reflectance\" "
			"\"a\"",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is a texture"},
		{SPEC_EUNSUPPORTED,
			"WorldBegin Material \"diffuse\" \"string normalmap\" "
			"\"a\"",
			"t.pbrt:1:31: 'normalmap' of Material \"diffuse\" is not supported"},
		{SPEC_EUNSUPPORTED,
			"WorldBegin Material \"diffuse\" \"float displacement\" 1",
			"t.pbrt:1:31: 'displacement' of Material \"diffuse\" is not supported"},
		{SPEC_EUNSUPPORTED,
			"WorldBegin Material \"conductor\" \"rgb reflectance\" [1 "
			"1 1]",
			"t.pbrt:1:33: 'reflectance' of Material \"conductor\" is not "
			"supported: give eta and k instead"},
		{SPEC_EFORMAT, "WorldBegin Material \"conductor\" \"float eta\" 2",
			"t.pbrt:1:12: Material \"conductor\" has eta but no k"},
		{SPEC_EFORMAT, "WorldBegin Material \"conductor\" \"float k\" 2",
			"t.pbrt:1:12: Material \"conductor\" has k but no eta"},
		{SPEC_ERANGE, "WorldBegin Material \"dielectric\" \"float roughness\" 1.5",
			"t.pbrt:1:34: 'roughness' of Material \"dielectric\" is outside 0..1"},
		{SPEC_ERANGE, "WorldBegin Material \"diffuse\" \"integer id\" 0",
			"t.pbrt:1:31: 'id' of Material \"diffuse\" is outside 1..2147483647"},
		{SPEC_EFORMAT, "WorldBegin Material \"thinfilm\"",
			"t.pbrt:1:12: Material \"thinfilm\" needs a \"string stack\""},
		{SPEC_EUSAGE, "WorldBegin Material \"thinfilm\" \"string stack\" \"air\"",
			"t.pbrt:1:32: "},
		{SPEC_EUSAGE,
			"WorldBegin Material \"thinfilm\" \"string stack\" \"air | 1.33 "
			"* | air\"",
			"t.pbrt:1:32: "},
		{SPEC_EUSAGE,
			"WorldBegin Material \"thinfilm\" \"string stack\" \"air | air\" "
			"\"string thickness\" \"500nm\"",
			"t.pbrt:1:32: "},
		{SPEC_EUSAGE,
			"WorldBegin Material \"thinfilm\" \"string stack\" \"air | 1.3 * "
			"| air\" \"string thickness\" \"thick\"",
			"t.pbrt:1:67: the thickness 'thick'"},
		{SPEC_EFORMAT, "WorldBegin Material \"diffractive\"",
			"t.pbrt:1:12: Material \"diffractive\" needs a \"string preset\""},
		{SPEC_EUSAGE,
			"WorldBegin Material \"diffractive\" \"string preset\" \"lp\"",
			"t.pbrt:1:35: no disc is named 'lp'"},
		{SPEC_EFORMAT, "WorldBegin MakeNamedMaterial \"a\"",
			"t.pbrt:1:12: MakeNamedMaterial \"a\" needs a \"string type\""},
		{SPEC_EFORMAT,
			"WorldBegin MakeNamedMaterial \"a\" \"string type\" [\"b\" \"c\"]",
			"t.pbrt:1:34: 'type' of MakeNamedMaterial \"a\" is not one string"},
		{SPEC_EFORMAT, "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"b\"",
			"t.pbrt:1:12: there is no Material \"b\""},
		{SPEC_EFORMAT,
			"WorldBegin MakeNamedMaterial \"a\" \"string type\" \"\"\n"
			"MakeNamedMaterial \"a\" \"string type\" \"\"",
			"t.pbrt:2:1: there is a material 'a' already"},
		{SPEC_EFORMAT, "WorldBegin NamedMaterial \"a\"",
			"t.pbrt:1:12: no material 'a' has been made so far"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

static void
faults_in_stacks_are_pointed_at(void **state)
{
	static const char text[] =
		"WorldBegin Material \"thinfilm\" \"string stack\" \"air | 1.33 x | air\"";
	struct spec_scene scene;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_scene_parse(&scene, text, strlen(text), "t.pbrt", &error),
		SPEC_EUSAGE);
	assert_string_equal(error.place, "  air | 1.33 x | air\n             ^");
}

/* ---- spectra ---- */

/* The spectrum of a light with the given parameter. */
static struct spec_scene_spectrum
light_of(const char *parameter, struct spec_scene *scene)
{
	char text[512];

	snprintf(text, sizeof text, "LightSource \"infinite\" %s", parameter);
	*scene = parse_world(text);
	return scene->light[0].spectrum;
}

static void
spectra_are_of_four_kinds(void **state)
{
	struct spec_scene scene;
	struct spec_scene_spectrum spectrum = light_of("\"float L\" 2.5", &scene);

	(void)state;
	assert_true(spectrum.kind == SPEC_SCENE_CONSTANT && spectrum.value == 2.5);
	assert_true(spectrum.place.line == 1 && spectrum.place.column == 35);
	spec_scene_free(&scene);
	spectrum = light_of("\"rgb L\" [1 2 0]", &scene);
	assert_true(spectrum.kind == SPEC_SCENE_RGB && spectrum.rgb[0] == 1);
	assert_true(spectrum.rgb[1] == 2 && spectrum.rgb[2] == 0);
	spec_scene_free(&scene);
	spectrum = light_of("\"blackbody L\" 2856", &scene);
	assert_true(spectrum.kind == SPEC_SCENE_BLACKBODY && spectrum.value == 2856);
	spec_scene_free(&scene);
	spectrum = light_of("\"spectrum L\" [400 1 500.5 2 600 0]", &scene);
	assert_int_equal(spectrum.kind, SPEC_SCENE_CURVE);
	assert_int_equal(spectrum.curve.count, 3);
	assert_true(spectrum.curve.wavelength_nm[1] == 500.5);
	assert_true(spectrum.curve.value[1] == 2);
	assert_string_equal(spectrum.curve.title, "L");
	spec_scene_free(&scene);
}

static void
spectra_have_names(void **state)
{
	static const struct {
		const char *name, *title;
	} lights[] = {{"D65", "D65"}, {"stdillum-D65", "D65"}, {"illuminants/F7", "FL7"},
		{"stdillum-F11", "FL11"}, {"daylight:6504K", "6504 K"},
		{"blackbody:3000K", "3000 K"}};
	struct spec_scene scene;

	(void)state;
	for (size_t i = 0; i < COUNT(lights); i++) {
		char text[100];
		struct spec_scene_spectrum spectrum;

		snprintf(text, sizeof text, "\"spectrum L\" \"%s\"", lights[i].name);
		spectrum = light_of(text, &scene);
		assert_contains(spectrum.curve.title, lights[i].title);
		spec_scene_free(&scene);
	}
	scene = parse_world(
		"Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" "
		"\"metal-Au-k\" Material \"conductor\" \"spectrum eta\" \"Ag\" \"spectrum k\" "
		"\"metals/Ag\" Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" "
		"Material \"dielectric\" \"spectrum eta\" \"glass-F11\" Material "
		"\"dielectric\" \"spectrum eta\" \"glass-SF10\" Material \"dielectric\" "
		"\"spectrum eta\" \"glass/F5\" Material \"diffuse\" \"spectrum reflectance\" "
		"\"cornell-red\"");
	assert_contains(scene.material[0].eta.curve.title, "Gold");
	assert_int_equal(scene.material[0].eta.curve.columns, 1);
	assert_true(scene.material[0].eta.curve.value[0] == 1.33);
	assert_true(scene.material[0].k.curve.value[0] == 1.277);
	assert_string_equal(scene.material[0].k.curve.quantity, "refractive index");
	assert_string_equal(scene.material[0].k.curve.medium, "vacuum");
	assert_contains(scene.material[1].k.curve.title, "Silver");
	assert_contains(scene.material[2].eta.curve.title, "BK7");
	assert_contains(scene.material[3].eta.curve.title, "SF11");
	assert_contains(scene.material[4].eta.curve.title, "SF10");
	assert_contains(scene.material[5].eta.curve.title, "F5");
	assert_string_equal(scene.material[6].reflectance.curve.quantity, "reflectance");
	spec_scene_free(&scene);
}

#define LIGHT "WorldBegin LightSource \"infinite\" "
#define GLASS "WorldBegin Material \"dielectric\" "
#define PAINT "WorldBegin Material \"diffuse\" "

static void
faults_of_spectra_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_ERANGE, LIGHT "\"float L\" -1",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light that is "
			"negative: -1"},
		{SPEC_ERANGE, LIGHT "\"rgb L\" [0 0 -1]",
			"t.pbrt:1:35: 'L' of LightSource"},
		{SPEC_EFORMAT, LIGHT "\"rgb L\" [0 0]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" takes 3 values, not 2"},
		{SPEC_EFORMAT, LIGHT "\"float L\" [0 0]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" takes 1 value, not 2"},
		{SPEC_ERANGE, LIGHT "\"blackbody L\" 0",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is a temperature that is "
			"not positive: 0 K"},
		{SPEC_EFORMAT, LIGHT "\"blackbody L\" [5000 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" takes 1 value"},
		{SPEC_EFORMAT, LIGHT "\"spectrum L\" [400 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs pairs"},
		{SPEC_EFORMAT, LIGHT "\"spectrum L\" [400 1 500]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs pairs"},
		{SPEC_EFORMAT, LIGHT "\"spectrum L\" [400 1 400 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" has wavelengths that are "
			"not positive and ascending: 400 nm"},
		{SPEC_EFORMAT, LIGHT "\"spectrum L\" [0 1 400 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" has wavelengths"},
		{SPEC_ERANGE, LIGHT "\"spectrum L\" [400 1 500 -2]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light that is "
			"negative: -2 at 500 nm"},
		{SPEC_EFORMAT, LIGHT "\"spectrum L\" [\"D65\" 1]",
			"t.pbrt:1:55: a value of 'L' should be a string, not '1'"},
		{SPEC_EFORMAT, LIGHT "\"spectrum L\" [400 \"D65\"]",
			"t.pbrt:1:53: a value of 'L' should be a number, not \"D65\""},
		{SPEC_EFORMAT, LIGHT "\"spectrum L\" [\"D65\" \"A\"]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" takes 1 value, not 2"},
		{SPEC_EUSAGE, LIGHT "\"spectrum L\" \"Au\"",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light, which 'Au' is "
			"not"},
		{SPEC_EUSAGE, LIGHT "\"spectrum L\" \"metal-Au-eta\"",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light, which "
			"'metal-Au-eta' is not"},
		{SPEC_EUSAGE, LIGHT "\"spectrum L\" \"no-such\"",
			"t.pbrt:1:35: no spectrum 'no-such'"},
		{SPEC_ERANGE, LIGHT "\"spectrum L\" \"daylight:3000K\"", "t.pbrt:1:35: "},
		{SPEC_EUSAGE, LIGHT "\"spectrum L\" \"daylight:x\"", "t.pbrt:1:35: "},
		{SPEC_EUSAGE, LIGHT "\"spectrum L\" \"blackbody:\"", "t.pbrt:1:35: "},
		{SPEC_EUSAGE, GLASS "\"spectrum eta\" \"daylight:6504K\"",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index, "
			"which 'daylight:6504K' is not"},
		{SPEC_EUSAGE, PAINT "\"spectrum reflectance\" \"blackbody:3000K\"",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is a reflectance, "
			"which 'blackbody:3000K' is not"},
		{SPEC_EUNSUPPORTED, LIGHT "\"spectrum L\" \"stdillum-F1\"",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is 'stdillum-F1', which "
			"is not among our spectra"},
		{SPEC_EUNSUPPORTED, GLASS "\"spectrum eta\" \"glass-LASF9\"",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is 'glass-LASF9', which "
			"is not among our spectra"},
		{SPEC_EUNSUPPORTED, GLASS "\"spectrum eta\" \"glass-F5\"",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is 'glass-F5', which is "
			"not among our spectra: pbrt's table of that name is of SCHOTT SF5"},
		{SPEC_EUNSUPPORTED, GLASS "\"spectrum eta\" \"metal-MgO-eta\"",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is 'metal-MgO-eta'"},
		{SPEC_EUSAGE, GLASS "\"spectrum eta\" \"metal-Au-k\"",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index, "
			"which 'metal-Au-k' is not"},
		{SPEC_EUSAGE, GLASS "\"spectrum eta\" \"D65\"",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index, "
			"which 'D65' is not"},
		{SPEC_ERANGE, GLASS "\"float eta\" 0",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index "
			"that is not positive: 0"},
		{SPEC_ERANGE, GLASS "\"float eta\" 1e7",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index "
			"outside 0..1e+06: 1e+07"},
		{SPEC_EFORMAT, GLASS "\"blackbody eta\" 5000",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index, "
			"which a blackbody is not"},
		{SPEC_ERANGE, PAINT "\"rgb reflectance\" [1 1 1.1]",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is a reflectance "
			"outside 0..1: 1.1"},
		{SPEC_EUSAGE, PAINT "\"spectrum reflectance\" \"D65\"",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is a reflectance, "
			"which 'D65' is not"},
		{SPEC_EFORMAT, PAINT "\"point3 reflectance\" [1 1 1]",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is of type float "
			"or spectrum or rgb or blackbody, not point3"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

/* ---- lights ---- */

static void
lights_stand_in_the_world(void **state)
{
	struct spec_scene scene = parse_world(
		"Translate 1 2 3 Scale 2 2 2 LightSource \"point\" \"float I\" 5 \"point3 "
		"from\" [1 0 0] LightSource \"distant\" \"float L\" 6 \"float scale\" 3 "
		"LightSource \"distant\" \"float L\" 6 \"point3 from\" [0 1 0] \"point3 to\" "
		"[0 0 0] LightSource \"infinite\" \"float L\" 7");
	const struct spec_scene_light *light = scene.light;

	(void)state;
	assert_int_equal(scene.lights, 4);
	assert_int_equal(light[0].kind, SPEC_SCENE_POINT);
	assert_true(light[0].scale == 1 && light[0].spectrum.value == 5);
	assert_true(
		light[0].from[0] == 3 && light[0].from[1] == 2 && light[0].from[2] == 3);
	assert_int_equal(light[1].kind, SPEC_SCENE_DISTANT);
	assert_true(light[1].scale == 3);
	assert_true(light[1].from[0] == 1 && light[1].from[2] == 3);
	assert_true(light[1].to[0] == 1 && light[1].to[1] == 2 && light[1].to[2] == 5);
	assert_true(light[2].from[1] == 4 && light[2].to[1] == 2);
	assert_int_equal(light[3].kind, SPEC_SCENE_INFINITE);
	assert_null(light[3].picture);
	assert_true(light[3].world.m[0][3] == 1 && light[3].world.m[2][2] == 2);
	spec_scene_free(&scene);
}

static void
shapes_carry_area_lights(void **state)
{
	struct spec_scene scene = parse_world(
		"Shape \"sphere\" AttributeBegin AreaLightSource \"diffuse\" \"float L\" 5 "
		"\"bool twosided\" true \"float scale\" 2 Shape \"sphere\" Shape \"sphere\" "
		"AreaLightSource \"\" Shape \"sphere\" AttributeEnd Shape \"sphere\"");

	(void)state;
	assert_int_equal(scene.lights, 1);
	assert_int_equal(scene.light[0].kind, SPEC_SCENE_AREA);
	assert_true(scene.light[0].twosided && scene.light[0].scale == 2);
	assert_true(scene.shape[0].light == SPEC_SCENE_NONE);
	assert_true(scene.shape[1].light == 0 && scene.shape[2].light == 0);
	assert_true(scene.shape[3].light == SPEC_SCENE_NONE);
	assert_true(scene.shape[4].light == SPEC_SCENE_NONE);
	spec_scene_free(&scene);
}

static void
faults_of_lights_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EUNSUPPORTED, "WorldBegin LightSource \"spot\"",
			"t.pbrt:1:12: LightSource \"spot\" is not supported"},
		{SPEC_EFORMAT, "WorldBegin LightSource \"sun\"",
			"t.pbrt:1:12: there is no LightSource \"sun\""},
		{SPEC_EFORMAT, "WorldBegin LightSource \"point\"",
			"t.pbrt:1:12: LightSource \"point\" needs its spectrum, \"spectrum I\""},
		{SPEC_EFORMAT, "WorldBegin AreaLightSource \"diffuse\"",
			"t.pbrt:1:12: AreaLightSource \"diffuse\" needs its spectrum"},
		{SPEC_EUNSUPPORTED, "WorldBegin LightSource \"point\" \"float power\" 5",
			"t.pbrt:1:32: 'power' of LightSource \"point\" is not supported: it is "
			"photometric"},
		{SPEC_EUNSUPPORTED,
			"WorldBegin LightSource \"distant\" \"float illuminance\" 5",
			"t.pbrt:1:34: 'illuminance' of LightSource \"distant\" is not"},
		{SPEC_ERANGE, "WorldBegin LightSource \"point\" \"float scale\" -5",
			"t.pbrt:1:32: 'scale' of LightSource \"point\" is less than 0: -5"},
		{SPEC_EFORMAT,
			"WorldBegin LightSource \"point\" \"float I\" 1 \"point3 "
			"from\" [0 0]",
			"t.pbrt:1:44: 'from' of LightSource \"point\" takes 3 values, not 2"},
		{SPEC_ERANGE,
			"WorldBegin LightSource \"distant\" \"float L\" 1 \"point3 to\" [0 0 "
			"0]",
			"t.pbrt:1:12: LightSource \"distant\" has no direction"},
		{SPEC_EFORMAT, LIGHT "\"float L\" 1 \"string filename\" \"a.exr\"",
			"t.pbrt:1:12: LightSource \"infinite\" has both L and filename"},
		{SPEC_EIO, LIGHT "\"string filename\" \"no-such.exr\"",
			"t.pbrt:1:35: there is no file 'no-such.exr'"},
		{SPEC_EUNSUPPORTED, LIGHT "\"point3 portal\" [0 0 0]",
			"t.pbrt:1:35: 'portal' of LightSource \"infinite\" is not supported"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

/* ---- attributes ---- */

static void
attributes_are_inherited(void **state)
{
	struct spec_scene scene = parse_world(
		"Attribute \"shape\" \"float radius\" 2 \"float height\" 7 "
		"Attribute \"light\" \"float scale\" 3 "
		"Attribute \"material\" \"float roughness\" .25 "
		"Shape \"sphere\" Shape \"disk\" Shape \"sphere\" \"float radius\" 5 "
		"AttributeBegin Attribute \"shape\" \"float radius\" 4 Attribute \"shape\" "
		"\"float radius\" 6 Shape \"sphere\" AttributeEnd Shape \"sphere\" "
		"LightSource \"point\" \"float I\" 1 AreaLightSource \"diffuse\" \"float L\" "
		"1 Material \"diffuse\" Material \"dielectric\"");

	(void)state;
	assert_true(scene.shape[0].radius == 2);
	assert_true(scene.shape[1].radius == 2 && scene.shape[1].height == 7);
	assert_true(scene.shape[2].radius == 5 && scene.shape[3].radius == 6);
	assert_true(scene.shape[4].radius == 2);
	assert_true(scene.light[0].scale == 3 && scene.light[1].scale == 3);
	assert_near(scene.material[2].roughness[0], 0.5);
	spec_scene_free(&scene);
	scene = parse_world("Attribute \"shape\"");
	spec_scene_free(&scene);
}

static void
faults_of_attributes_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EFORMAT, "WorldBegin Attribute \"shap\"",
			"t.pbrt:1:12: there is no Attribute \"shap\"; did you mean "
			"\"shape\"?"},
		{SPEC_EUNSUPPORTED, "WorldBegin Attribute \"medium\"",
			"t.pbrt:1:12: Attribute \"medium\" is not supported"},
		{SPEC_EFORMAT, "WorldBegin Attribute \"shape\" \"float size\" 1",
			"t.pbrt:1:30: no shape has a parameter 'size'"},
		{SPEC_EUNSUPPORTED,
			"WorldBegin\nAttribute \"shape\" \"float alpha\" .5\nShape \"sphere\"",
			"t.pbrt:2:19: 'alpha' of Shape \"sphere\" is not supported"},
		{SPEC_EFORMAT,
			"WorldBegin\nAttribute \"shape\" \"string radius\" \"1\"\nShape "
			"\"sphere\"",
			"t.pbrt:2:19: 'radius' of Shape \"sphere\" is of type float, not "
			"string"},
		{SPEC_EFORMAT,
			"WorldBegin\nAttribute \"material\" \"string type\" "
			"\"diffuse\"\nMaterial "
			"\"diffuse\"",
			"t.pbrt:2:22: 'type' of Material \"diffuse\" is MakeNamedMaterial's"},
	};

	(void)state;
	check_faults(faults, COUNT(faults));
}

static void
nesting_has_its_limit(void **state)
{
	size_t deep = 4096, length = 0;
	char *text = malloc(16 + (deep + 1) * 32);
	struct spec_scene scene;
	struct spec_error error;

	(void)state;
	assert_non_null(text);
	length += (size_t)sprintf(text, "WorldBegin\n");
	for (size_t i = 0; i < deep; i++)
		length += (size_t)sprintf(text + length, "AttributeBegin\n");
	for (size_t i = 0; i < deep; i++)
		length += (size_t)sprintf(text + length, "AttributeEnd\n");
	assert_int_equal(spec_scene_parse(&scene, text, length, "t.pbrt", &error), SPEC_OK);
	spec_scene_free(&scene);
	strcpy(text + 11 + deep * 15, "AttributeBegin");
	assert_int_equal(spec_scene_parse(&scene, text, strlen(text), "t.pbrt", &error),
		SPEC_ERANGE);
	assert_begins(
		error.message, "t.pbrt:4098:1: statements are nested more than 4096 deep");
	free(text);
}

/* ---- files ---- */

static enum spec_status
read_file(const char *name, struct spec_scene *scene, struct spec_error *error)
{
	char path[200];

	snprintf(path, sizeof path, "%s/%s", scratch, name);
	return spec_scene_read(scene, path, error);
}

/* That a file is read, or that its message ends so; files are named without the folder. */
static struct spec_scene
read_scene(const char *name)
{
	struct spec_scene scene;
	struct spec_error error;

	if (read_file(name, &scene, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return scene;
}

static void
check_file(const char *name, enum spec_status status, const char *message)
{
	char wanted[1024], path[200];
	struct spec_scene scene;
	struct spec_error error;

	snprintf(path, sizeof path, "%s/", scratch);
	assert_int_equal(read_file(name, &scene, &error), status);
	wanted[0] = '\0';
	for (const char *at = message; *at; at++)
		snprintf(wanted + strlen(wanted), sizeof wanted - strlen(wanted), "%.*s",
			*at == '@' ? (int)strlen(path) : 1, *at == '@' ? path : at);
	assert_begins(error.message, wanted);
}

static void
files_include_files(void **state)
{
	struct spec_scene scene;

	(void)state;
	save_text("a.pbrt", "Include \"sub/camera.pbrt\" WorldBegin\nInclude "
			    "\"sub/b.pbrt\"\nShape \"disk\" AttributeEnd");
	save_text("sub/camera.pbrt", "Camera \"perspective\" \"float fov\" 30");
	/* c.pbrt stands beside b.pbrt, top.pbrt in the folder of the first file. */
	save_text("sub/b.pbrt",
		"AttributeBegin Translate 1 0 0 Include \"c.pbrt\" Include \"top.pbrt\"");
	save_text("sub/c.pbrt", "Scale 2 2 2 Shape \"sphere\" \"float radius\"");
	save_text("top.pbrt", "5\n Shape \"sphere\"");
	/* A list of parameters may even end in another file than it began in. */
	save_text("sub/b.pbrt",
		"AttributeBegin Translate 1 0 0\nInclude \"c.pbrt\"\n 7 Include "
		"\"top.pbrt\"");
	save_text("top.pbrt", "\n Shape \"sphere\"");
	scene = read_scene("a.pbrt");
	assert_true(scene.fov_deg == 30);
	assert_int_equal(scene.shapes, 3);
	assert_true(scene.shape[0].radius == 7);
	assert_true(scene.shape[2].world.m[0][0] == 2 && scene.shape[2].world.m[0][3] == 1);
	assert_int_equal(scene.files, 5);
	assert_int_equal(scene.shape[1].place.file, 4);
	assert_true(scene.shape[1].place.line == 2 && scene.shape[1].place.column == 2);
	assert_contains(scene.file[3], "/sub/c.pbrt");
	assert_int_equal(scene.shape[2].place.line, 3);
	spec_scene_free(&scene);
}

static void
imports_keep_their_state(void **state)
{
	struct spec_scene scene;

	(void)state;
	save_text("i.pbrt",
		"WorldBegin Translate 1 0 0 Import \"moved.pbrt\" Shape \"disk\"");
	save_text("moved.pbrt", "Translate 1 0 0 Shape \"sphere\" MakeNamedMaterial \"m\" "
				"\"string type\" \"diffuse\"");
	scene = read_scene("i.pbrt");
	assert_true(scene.shape[0].world.m[0][3] == 2);
	assert_true(scene.shape[1].world.m[0][3] == 1);
	spec_scene_free(&scene);
	save_text("moved.pbrt", "\nAttributeBegin");
	check_file(
		"i.pbrt", SPEC_EFORMAT, "@moved.pbrt:2:1: what begins here is never ended");
	save_text("moved.pbrt", "AttributeEnd");
	save_text("i.pbrt", "WorldBegin AttributeBegin Import \"moved.pbrt\" AttributeEnd");
	check_file(
		"i.pbrt", SPEC_EFORMAT, "@moved.pbrt:1:1: AttributeEnd ends what was not");
	/* A list of parameters ends with the imported file. */
	save_text("moved.pbrt", "Shape \"sphere\" \"float radius\"");
	check_file(
		"i.pbrt", SPEC_EFORMAT, "@moved.pbrt:1:30: a value of 'radius' is missing");
	save_text("i.pbrt", "Import \"moved.pbrt\"");
	check_file("i.pbrt", SPEC_EFORMAT, "@i.pbrt:1:1: Import cannot stand before");
}

static void
faults_in_files_have_places(void **state)
{
	(void)state;
	save_text("a.pbrt", "WorldBegin\n Include \"sub/b.pbrt\"");
	save_text("sub/b.pbrt", "\n\n  Shape \"cube\"");
	check_file("a.pbrt", SPEC_EFORMAT, "@sub/b.pbrt:3:3: there is no Shape \"cube\"");
	save_text("sub/b.pbrt", "Include \"nothing.pbrt\"");
	check_file("a.pbrt", SPEC_EIO,
		"@sub/b.pbrt:1:9: there is no file 'nothing.pbrt' in the folder '@sub'");
	save_text("sub/b.pbrt", "Include \"/no/such/file\"");
	check_file("a.pbrt", SPEC_EIO, "@sub/b.pbrt:1:9: there is no file '/no/such/file'");
	save_text("sub/b.pbrt", "Include \".\"");
	check_file(
		"a.pbrt", SPEC_EIO, "@sub/b.pbrt:1:9: there is no file '.' in the folder");
	save_text("sub/b.pbrt", "Include \"-\"");
	check_file("a.pbrt", SPEC_EUSAGE,
		"@sub/b.pbrt:1:9: standard input cannot be included");
	save_text("both.pbrt", "");
	save_text("sub/both.pbrt", "");
	save_text("sub/b.pbrt", "Include \"both.pbrt\"");
	check_file("a.pbrt", SPEC_EUSAGE,
		"@sub/b.pbrt:1:9: the name fits two files, '@sub/both.pbrt' and '@both.pbrt'");
	save_text("sub/b.pbrt", "Include \"b.pbrt\"");
	check_file("a.pbrt", SPEC_ERANGE,
		"@sub/b.pbrt:1:9: files are included in files more than 64 deep");
	save("sub/b.pbrt", "a\0b", 3);
	check_file("a.pbrt", SPEC_EFORMAT,
		"@a.pbrt:2:10: '@sub/b.pbrt' has a zero byte in it");
	save_text("a.pbrt", "Include \"sub\"");
	check_file(
		"a.pbrt", SPEC_EIO, "@a.pbrt:1:9: there is no file 'sub' in the folder '");
	check_file(
		"no-such.pbrt", SPEC_EIO, "unable to open '@no-such.pbrt': No such file");
}

static void
standard_input_is_a_scene(void **state)
{
	char path[200];
	struct spec_scene scene;
	struct spec_error error;
	int input = dup(STDIN_FILENO), file;

	(void)state;
	snprintf(path, sizeof path, "%s/stdin.pbrt", scratch);
	save_text("stdin.pbrt", "WorldBegin Shape \"sphere\"");
	file = open(path, O_RDONLY | O_CLOEXEC);
	assert_true(input >= 0 && file >= 0 && dup2(file, STDIN_FILENO) >= 0);
	assert_int_equal(spec_scene_read(&scene, "-", &error), SPEC_OK);
	assert_string_equal(scene.file[0], "<stdin>");
	assert_int_equal(scene.shapes, 1);
	spec_scene_free(&scene);
	assert_true(dup2(input, STDIN_FILENO) >= 0);
	close(input);
	close(file);
}

static void
scenes_name_spectra_and_pictures(void **state)
{
	struct spec_scene scene;

	(void)state;
	save_text("sub/lamp.spd", "400 1\n500 2\n");
	save_text("sub/picture.exr", "");
	save_text("sub/index.txt", "400 1.5\n500 1.4\n");
	save_text("sub/both.csv", "400 0.5 2\n500 0.25 3\n");
	save_text("a.pbrt",
		"WorldBegin LightSource \"infinite\" \"spectrum L\" \"sub/lamp.spd\" "
		"LightSource \"infinite\" \"string filename\" \"sub/picture.exr\" Material "
		"\"dielectric\" \"spectrum eta\" \"sub/index.txt\" Material \"diffuse\" "
		"\"spectrum reflectance\" \"sub/both.csv\"");
	scene = read_scene("a.pbrt");
	assert_true(scene.light[0].spectrum.curve.value[1] == 2);
	assert_contains(scene.light[1].picture, "/sub/picture.exr");
	assert_true(scene.light[1].spectrum.value == 1);
	assert_true(scene.material[0].eta.curve.value[1] == 1.4);
	assert_int_equal(scene.material[1].reflectance.curve.columns, 1);
	assert_true(scene.material[1].reflectance.curve.value[1] == 0.25);
	spec_scene_free(&scene);
	save_text("a.pbrt", "WorldBegin Material \"dielectric\" \"spectrum eta\" "
			    "\"sub/both.csv\"");
	check_file("a.pbrt", SPEC_EUSAGE,
		"@a.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index, which "
		"'sub/both.csv' is not");
	save_text("sub/lamp.spd", "400 1\n500 x\n");
	save_text("a.pbrt", "WorldBegin\nLightSource \"infinite\" \"spectrum L\" "
			    "\"sub/lamp.spd\"");
	check_file("a.pbrt", SPEC_EFORMAT,
		"@a.pbrt:2:24: @sub/lamp.spd:2: 'x' is not a finite number");
}

/* ---- PLY ---- */

static enum spec_status
read_ply(const void *bytes, size_t size, struct spec_ply *mesh, struct spec_error *error)
{
	FILE *file = fmemopen((void *)bytes, size, "rb");
	enum spec_status status;

	assert_non_null(file);
	status = spec_ply_read(file, "m.ply", mesh, error);
	fclose(file);
	return status;
}

#define FACES "element face 2\nproperty list uchar int vertex_indices\n"
#define VERTICES "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"

static void
ply_may_be_text(void **state)
{
	static const char text[] =
		"ply\r\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement "
		"camera 1\nproperty list uchar float row\nelement vertex 4\nproperty float "
		"z\nproperty uchar red\nproperty double y\nproperty float32 x\nproperty "
		"float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty "
		"float t\n" FACES "property uchar flags\nend_header\n"
		"3 1 2 3\n"
		"1 255 2 3 0 0 1 0 0\n 4 0 5e0 6 0 0 1 1 0\n7 1 8 9 0 0 1 0 1\n10 1 11 12 "
		"0 1 0 .5 .25\n4 0 1 2 3 9\n3 1 2 3 9\n\n";
	struct spec_ply mesh;
	struct spec_error error = {0};

	(void)state;
	if (read_ply(text, strlen(text), &mesh, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	assert_true(mesh.vertices == 4 && mesh.triangles == 3);
	assert_true(mesh.point[0] == 3 && mesh.point[1] == 2 && mesh.point[2] == 1);
	assert_true(mesh.point[9] == 12 && mesh.normal[10] == 1);
	assert_true(mesh.uv[6] == 0.5F && mesh.uv[7] == 0.25F);
	assert_true(mesh.index[0] == 0 && mesh.index[1] == 1 && mesh.index[2] == 2);
	assert_true(mesh.index[3] == 0 && mesh.index[4] == 2 && mesh.index[5] == 3);
	assert_true(mesh.index[6] == 1 && mesh.index[8] == 3);
	spec_ply_free(&mesh);
	spec_ply_free(&mesh);
	spec_ply_free(NULL);
}

/* Appends a number's bytes in the order wanted. */
static size_t
put(unsigned char *bytes, size_t at, const void *number, size_t size, int big)
{
	const unsigned char *from = number;

	for (size_t i = 0; i < size; i++)
		bytes[at + i] = from[big ? size - 1 - i : i]; /* x86 is little-endian */
	return at + size;
}

/* A mesh of four vertices and two faces with numbers of many types. */
static size_t
make_binary(unsigned char *bytes, int big, float last)
{
	static const int32_t corners[] = {0, 1, 2, 3};
	const int16_t one = 1, minus = -2;
	const uint32_t large = 4000000000U;
	const unsigned char four = 4, three = 3;
	size_t at = (size_t)sprintf((char *)bytes,
		"ply\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty short x\nproperty "
		"double y\nproperty uint skipped\nproperty float z\n" FACES "end_header\n",
		big ? "big" : "little");

	for (int i = 0; i < 4; i++) {
		double y = i + 0.5;
		float z = i < 3 ? (float)-i : last;

		at = put(bytes, at, i ? &one : &minus, 2, big);
		at = put(bytes, at, &y, 8, big);
		at = put(bytes, at, &large, 4, big);
		at = put(bytes, at, &z, 4, big);
	}
	at = put(bytes, at, &four, 1, big);
	for (int i = 0; i < 4; i++)
		at = put(bytes, at, &corners[i], 4, big);
	at = put(bytes, at, &three, 1, big);
	for (int i = 1; i < 4; i++)
		at = put(bytes, at, &corners[i], 4, big);
	return at;
}

static void
ply_may_be_binary(void **state)
{
	(void)state;
	for (int big = 0; big < 2; big++) {
		unsigned char bytes[1024];
		size_t size = make_binary(bytes, big, -3);
		struct spec_ply mesh;
		struct spec_error error = {0};

		if (read_ply(bytes, size, &mesh, &error) != SPEC_OK)
			fail_msg("%s", error.message);
		assert_true(mesh.vertices == 4 && mesh.triangles == 3);
		assert_true(mesh.point[0] == -2 && mesh.point[3] == 1);
		assert_true(mesh.point[10] == 3.5F && mesh.point[11] == -3);
		assert_true(mesh.index[5] == 3 && mesh.index[6] == 1);
		assert_null(mesh.normal);
		assert_null(mesh.uv);
		spec_ply_free(&mesh);
		/* Whatever is cut off is missed, and so is what is too much. */
		for (size_t cut = 1; cut < size; cut++) {
			assert_int_equal(
				read_ply(bytes, size - cut, &mesh, &error), SPEC_EFORMAT);
			assert_null(mesh.point);
		}
		assert_int_equal(read_ply(bytes, size + 1, &mesh, &error), SPEC_EFORMAT);
		assert_string_equal(error.message,
			"m.ply: the file goes on behind what its header announces");
		size = make_binary(bytes, big, NAN);
		assert_int_equal(read_ply(bytes, size, &mesh, &error), SPEC_EFORMAT);
		assert_string_equal(
			error.message, "m.ply: vertex 3 has a number that is not finite");
	}
}

#define HEADER "ply\nformat ascii 1.0\n"
#define POINTS "0 0 0 1 0 0 0 1 0 0 0 1\n"

static void
ply_refuses_damage(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EFORMAT, "p", "m.ply:1: the file ends in its header"},
		{SPEC_EFORMAT, "plx\n", "m.ply:1: the file does not begin with 'ply'"},
		{SPEC_EUNSUPPORTED, "\x1f\x8b\x08", "m.ply: it is compressed"},
		{SPEC_EFORMAT, "ply\n", "m.ply:2: the file ends in its header"},
		{SPEC_EFORMAT, "ply\nformat ascii 2.0\n", "m.ply:2: the format is not"},
		{SPEC_EFORMAT, "ply\nformat text 1.0\n", "m.ply:2: the format is not"},
		{SPEC_EFORMAT, HEADER "format ascii 1.0\n",
			"m.ply:3: there are two formats"},
		{SPEC_EFORMAT, HEADER "elements\n", "m.ply:3: 'elements' has no meaning"},
		{SPEC_EFORMAT, HEADER "element vertex\n", "m.ply:3: not an element's name"},
		{SPEC_EFORMAT, HEADER "element vertex -1\n", "m.ply:3: not an element's"},
		{SPEC_EFORMAT, HEADER "element vertex 2147483648\n", "m.ply:3: not an"},
		{SPEC_EFORMAT, HEADER "property float x\n",
			"m.ply:3: a property before any"},
		{SPEC_EFORMAT, HEADER "element vertex 1\nproperty real x\n",
			"m.ply:4: there is no type 'real'"},
		{SPEC_EFORMAT, HEADER "element vertex 1\nproperty float\n",
			"m.ply:4: a property has no name"},
		{SPEC_EFORMAT,
			HEADER "element vertex 1\nproperty float x\nproperty int x\n",
			"m.ply:5: there are two properties like 'x'"},
		{SPEC_EFORMAT,
			HEADER "element vertex 1\nproperty float u\nproperty float s\n",
			"m.ply:5: there are two properties like 's'"},
		{SPEC_EFORMAT,
			HEADER "element face 1\nproperty list float int vertex_index\n",
			"m.ply:4: the count of a list"},
		{SPEC_EFORMAT,
			HEADER "element face 1\nproperty list int float vertex_index\n",
			"m.ply:4: vertex_index are not whole"},
		{SPEC_EFORMAT, HEADER VERTICES "element vertex 1\n",
			"m.ply:7: the element vertex is there twice"},
		{SPEC_EFORMAT, "ply\n" VERTICES FACES "end_header\n",
			"m.ply:8: the header has no format"},
		{SPEC_EFORMAT, HEADER FACES "end_header\n",
			"m.ply:5: there are no vertices"},
		{SPEC_EFORMAT, HEADER VERTICES "end_header\n",
			"m.ply:7: there are no faces"},
		{SPEC_EFORMAT, HEADER VERTICES "property float nx\n" FACES "end_header\n",
			"m.ply:10: not all of nx, ny and nz are there"},
		{SPEC_EFORMAT, HEADER VERTICES "property float v\n" FACES "end_header\n",
			"m.ply:10: not both of u and v are there"},
		{SPEC_EFORMAT,
			HEADER VERTICES FACES
			"element empty 2147483647\nelement row 1\nproperty list char int n\n"
			"end_header\n" POINTS "3 0 1 2\n3 1 2 3\n-1",
			"m.ply:16: a list has -1 values"},
		{SPEC_EFORMAT, HEADER VERTICES FACES "end_header\n0 0",
			"m.ply:10: the file ends where a number should be"},
		{SPEC_EFORMAT, HEADER VERTICES FACES "end_header\n0 0 x\n",
			"m.ply:10: 'x' is not a number"},
		{SPEC_EFORMAT, HEADER VERTICES FACES "end_header\n0 0\n1e39\n",
			"m.ply:11: 1e39 is not of type float"},
		{SPEC_EFORMAT, HEADER VERTICES FACES "end_header\n" POINTS "3 0 1 1.5",
			"m.ply:11: 1.5 is not of type int"},
		{SPEC_EFORMAT, HEADER VERTICES FACES "end_header\n" POINTS "3 0 1 4",
			"m.ply:11: face 0 has a vertex 4, and the last one is 3"},
		{SPEC_EFORMAT, HEADER VERTICES FACES "end_header\n" POINTS "3 0 1 -1",
			"m.ply:11: face 0 has a vertex -1"},
		{SPEC_EUNSUPPORTED,
			HEADER VERTICES FACES "end_header\n" POINTS "3 0 1 2\n5",
			"m.ply:12: face 1 has 5 vertices, and only 3 or 4 are supported"},
		{SPEC_EFORMAT,
			HEADER VERTICES FACES "end_header\n" POINTS "3 0 1 2\n3 1 2 3\n3",
			"m.ply:13: the file goes on behind"},
	};
	struct spec_ply mesh;
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(faults); i++) {
		enum spec_status status =
			read_ply(faults[i].text, strlen(faults[i].text), &mesh, &error);

		if (status != faults[i].status)
			fail_msg("%s: status %d, '%s'", faults[i].text, status,
				error.message);
		assert_begins(error.message, faults[i].message);
		assert_null(mesh.point);
		assert_null(mesh.index);
		assert_int_equal(
			read_ply(faults[i].text, strlen(faults[i].text), &mesh, NULL),
			status);
	}
}

static void
ply_keeps_its_limits(void **state)
{
	char text[8192];
	size_t length = (size_t)sprintf(text, HEADER "comment ");
	struct spec_ply mesh;
	struct spec_error error;

	(void)state;
	memset(text + length, 'x', 5000);
	strcpy(text + length + 5000, "\n");
	assert_int_equal(read_ply(text, strlen(text), &mesh, &error), SPEC_ERANGE);
	assert_string_equal(error.message, "m.ply:3: the line is longer than 4096 bytes");
	length = (size_t)sprintf(text, HEADER);
	for (int i = 0; i < 17; i++)
		length += (size_t)sprintf(text + length, "element e%d 1\n", i);
	assert_int_equal(read_ply(text, strlen(text), &mesh, &error), SPEC_ERANGE);
	assert_string_equal(
		error.message, "m.ply:19: there are more than 16 kinds of elements");
	length = (size_t)sprintf(text, HEADER "element e 1\n");
	for (int i = 0; i < 129; i++)
		length += (size_t)sprintf(text + length, "property float p%d\n", i);
	assert_int_equal(read_ply(text, strlen(text), &mesh, &error), SPEC_ERANGE);
	assert_string_equal(error.message, "m.ply:132: there are more than 128 properties");
}

static void
scenes_name_meshes(void **state)
{
	unsigned char bytes[1024];
	size_t size = make_binary(bytes, 0, -3);
	struct spec_scene scene;

	(void)state;
	save("sub/mesh.ply", bytes, size);
	save_text("a.pbrt", "WorldBegin Scale 2 2 2 Shape \"plymesh\" \"string filename\" "
			    "\"sub/mesh.ply\"");
	scene = read_scene("a.pbrt");
	assert_int_equal(scene.shape[0].kind, SPEC_SCENE_MESH);
	assert_true(scene.shape[0].vertices == 4 && scene.shape[0].triangles == 3);
	assert_true(scene.shape[0].point[10] == 3.5F && scene.shape[0].index[6] == 1);
	assert_true(scene.shape[0].world.m[1][1] == 2);
	spec_scene_free(&scene);
	save("sub/mesh.ply", bytes, size - 1);
	check_file("a.pbrt", SPEC_EFORMAT,
		"@a.pbrt:1:40: @sub/mesh.ply: the file ends before all of its header is "
		"there");
}

/* ---- all of them ---- */

static int
make_scratch(void **state)
{
	(void)state;
	if (scratch_make("scene") != 0)
		return -1;
	make_folder("sub");
	return 0;
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(an_empty_world_has_defaults),
		cmocka_unit_test(words_are_told_apart),
		cmocka_unit_test(faults_of_words_have_places),
		cmocka_unit_test(faults_of_parameters_have_places),
		cmocka_unit_test(names_that_were_meant_are_found),
		cmocka_unit_test(settings_are_kept),
		cmocka_unit_test(screens_have_corners),
		cmocka_unit_test(cameras_may_look_all_around),
		cmocka_unit_test(samples_may_be_rows_and_columns),
		cmocka_unit_test(what_makes_no_difference_is_a_warning),
		cmocka_unit_test(faults_of_settings_have_places),
		cmocka_unit_test(transforms_are_pbrts),
		cmocka_unit_test(inverses_are_exact_where_they_can_be),
		cmocka_unit_test(cameras_stand_in_the_world),
		cmocka_unit_test(faults_of_transforms_have_places),
		cmocka_unit_test(spheres_and_disks_are_whole),
		cmocka_unit_test(meshes_have_their_numbers),
		cmocka_unit_test(faults_of_shapes_have_places),
		cmocka_unit_test(materials_have_defaults),
		cmocka_unit_test(roughness_becomes_alpha),
		cmocka_unit_test(materials_of_ours_are_checked),
		cmocka_unit_test(materials_may_have_names),
		cmocka_unit_test(faults_of_materials_have_places),
		cmocka_unit_test(faults_in_stacks_are_pointed_at),
		cmocka_unit_test(spectra_are_of_four_kinds),
		cmocka_unit_test(spectra_have_names),
		cmocka_unit_test(faults_of_spectra_have_places),
		cmocka_unit_test(lights_stand_in_the_world),
		cmocka_unit_test(shapes_carry_area_lights),
		cmocka_unit_test(faults_of_lights_have_places),
		cmocka_unit_test(attributes_are_inherited),
		cmocka_unit_test(faults_of_attributes_have_places),
		cmocka_unit_test(nesting_has_its_limit),
		cmocka_unit_test(files_include_files),
		cmocka_unit_test(imports_keep_their_state),
		cmocka_unit_test(faults_in_files_have_places),
		cmocka_unit_test(standard_input_is_a_scene),
		cmocka_unit_test(scenes_name_spectra_and_pictures),
		cmocka_unit_test(ply_may_be_text),
		cmocka_unit_test(ply_may_be_binary),
		cmocka_unit_test(ply_refuses_damage),
		cmocka_unit_test(ply_keeps_its_limits),
		cmocka_unit_test(scenes_name_meshes),
	};

	return cmocka_run_group_tests(tests, make_scratch, scratch_remove);
}
