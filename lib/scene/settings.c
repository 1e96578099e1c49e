/* The statements before WorldBegin, of what renders the world. */
#include <ctype.h>
#include <float.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/nearest.h"
#include "base/number.h"
#include "scene/outdoors.h"
#include "scene/parsing.h"

/* Replaces a text of the scene's by a copy of another; null: by none. */
static enum spec_status
set_text(char **field, const char *text, struct spec_error *error)
{
	char *copy = text ? spec_memory_text(text, strlen(text), error) : NULL;

	if (text && !copy)
		return SPEC_ENOMEM;
	free(*field);
	*field = copy;
	return SPEC_OK;
}

static enum spec_status
whole(const struct spec_arguments *arguments, const char *name, int minimum, int *value)
{
	long long number = *value;
	enum spec_status status =
		spec_arguments_whole(arguments, name, minimum, INT_MAX, &number);

	*value = (int)number;
	return status;
}

/* ---- the camera ---- */

static const struct spec_expected perspective[] = {SPEC_TAKES("fov", SPEC_FLOAT),
	SPEC_TAKES("screenwindow", SPEC_FLOAT), SPEC_TAKES("frameaspectratio", SPEC_FLOAT),
	SPEC_TAKES("lensradius", SPEC_FLOAT), SPEC_TAKES("focaldistance", SPEC_FLOAT),
	SPEC_TAKES("place", SPEC_STRING), SPEC_TAKES("toward", SPEC_STRING),
	SPEC_TAKES("elevation", SPEC_FLOAT), SPEC_WARNS("shutteropen", NULL),
	SPEC_WARNS("shutterclose", NULL), {0}};

static const struct spec_expected spherical[] = {SPEC_TAKES("mapping", SPEC_STRING),
	SPEC_WARNS("shutteropen", NULL), SPEC_WARNS("shutterclose", NULL), {0}};

static const struct spec_parsing_sort cameras[] = {{"perspective", perspective, 0},
	{"spherical", spherical, 1}, {"orthographic", NULL, 0}, {"realistic", NULL, 0},
	{0}};

static enum spec_status
set_screen(struct spec_parser *parser, const struct spec_arguments *arguments)
{
	struct spec_scene *scene = parser->scene;
	const struct spec_parameter *window =
		spec_arguments_find(arguments, "screenwindow");
	double aspect = 0, *screen = scene->screen;
	enum spec_status status =
		spec_arguments_positive(arguments, "frameaspectratio", &aspect);

	scene->has_screen = aspect > 0 || window;
	if (aspect > 0) {
		screen[1] = aspect > 1 ? aspect : 1;
		screen[3] = aspect > 1 ? 1 : 1 / aspect;
		screen[0] = -screen[1];
		screen[2] = -screen[3];
	}
	if (status == SPEC_OK)
		status = spec_arguments_numbers(arguments, "screenwindow", 4, screen);
	if (status == SPEC_OK && window &&
		!(screen[0] < screen[1] && screen[2] < screen[3]))
		status = spec_arguments_fail(arguments, window, SPEC_ERANGE,
			"is not x0 x1 y0 y1 with x0 < x1 and y0 < y1");
	return status;
}

/* pbrt's other mapping, its default, is the equal-area octahedron. */
static enum spec_status
set_all_around(struct spec_parser *parser, const struct spec_arguments *arguments)
{
	const struct spec_parameter *mapping = spec_arguments_find(arguments, "mapping");
	const char *text = NULL;
	enum spec_status status = spec_arguments_check(arguments, spherical);

	if (status == SPEC_OK)
		status = spec_arguments_text(arguments, "mapping", &text);
	parser->scene->all_around = 1;
	if (status == SPEC_OK && (!text || strcmp(text, "equirectangular") != 0))
		return spec_arguments_fail(arguments, mapping, SPEC_EUNSUPPORTED,
			"must be \"string mapping\" \"equirectangular\" here");
	return status;
}

enum spec_status
spec_parser_camera(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments = spec_parser_arguments(parser, statement, -1);
	struct spec_scene *scene = parser->scene;
	const struct spec_parsing_sort *sort =
		spec_parser_sort(parser, statement, cameras, NULL);
	struct spec_transform view = parser->state.transform;
	struct spec_parsing_name *system;
	enum spec_status status = SPEC_OK;

	if (!sort)
		return parser->error->status;
	scene->has_place = 0;
	if (!sort->number)
		status = spec_arguments_check(&arguments, perspective);
	if (status == SPEC_OK && !sort->number)
		status = spec_outdoors_face(&arguments, &view);
	if (status != SPEC_OK)
		return status;
	scene->camera = spec_transform_inverse(&view);
	system = spec_parser_add(&parser->systems, "camera", parser->error);
	if (!system)
		return SPEC_ENOMEM;
	system->transform = scene->camera;
	scene->fov_deg = 90;
	scene->lens_radius = 0;
	scene->focal_distance = 1e6;
	scene->all_around = 0;
	if (sort->number)
		return set_all_around(parser, &arguments);
	status = spec_arguments_positive(&arguments, "fov", &scene->fov_deg);
	if (status == SPEC_OK && !(scene->fov_deg < 180))
		status = spec_arguments_fail(&arguments,
			spec_arguments_find(&arguments, "fov"), SPEC_ERANGE,
			"is not less than 180 degrees: %g", scene->fov_deg);
	if (status == SPEC_OK)
		status = spec_arguments_number(
			&arguments, "lensradius", 0, DBL_MAX, &scene->lens_radius);
	if (status == SPEC_OK)
		status = spec_arguments_positive(
			&arguments, "focaldistance", &scene->focal_distance);
	return status == SPEC_OK ? set_screen(parser, &arguments) : status;
}

/* ---- the film ---- */

static const char own_colours[] =
	"the image has spectra, and spec2rgb makes colours of them";
static const char own_crop[] = "the renderer's option --crop crops";
static const char own_grid[] = "the renderer's option --grid sets the bands";

static const struct spec_expected film[] = {SPEC_TAKES("xresolution", SPEC_INTEGER),
	SPEC_TAKES("yresolution", SPEC_INTEGER), SPEC_TAKES("filename", SPEC_STRING),
	SPEC_REFUSES("cropwindow", own_crop), SPEC_REFUSES("pixelbounds", own_crop),
	SPEC_WARNS("sensor", own_colours), SPEC_WARNS("iso", own_colours),
	SPEC_WARNS("whitebalance", own_colours),
	SPEC_WARNS("maxcomponentvalue", own_colours), SPEC_WARNS("savefp16", own_colours),
	SPEC_IGNORES("diagonal"), SPEC_WARNS("nbuckets", own_grid),
	SPEC_WARNS("lambdamin", own_grid), SPEC_WARNS("lambdamax", own_grid),
	SPEC_WARNS("coordinatesystem", NULL), {0}};

static const struct spec_parsing_sort films[] = {
	{"rgb", film, 0}, {"spectral", film, 0}, {"gbuffer", film, 0}, {0}};

enum spec_status
spec_parser_film(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments = spec_parser_arguments(parser, statement, -1);
	struct spec_scene *scene = parser->scene;
	const char *file = NULL;
	enum spec_status status;

	if (!spec_parser_sort(parser, statement, films, NULL))
		return parser->error->status;
	scene->width = SPEC_PARSING_WIDTH;
	scene->height = SPEC_PARSING_HEIGHT;
	status = spec_arguments_check(&arguments, film);
	if (status == SPEC_OK)
		status = whole(&arguments, "xresolution", 1, &scene->width);
	if (status == SPEC_OK)
		status = whole(&arguments, "yresolution", 1, &scene->height);
	if (status == SPEC_OK)
		status = spec_arguments_text(&arguments, "filename", &file);
	if (status == SPEC_OK)
		status = set_text(&scene->output, file, parser->error);
	return status;
}

/* ---- samples ---- */

static const struct spec_expected sampler[] = {SPEC_TAKES("pixelsamples", SPEC_INTEGER),
	SPEC_TAKES("seed", SPEC_INTEGER), SPEC_TAKES("xsamples", SPEC_INTEGER),
	SPEC_TAKES("ysamples", SPEC_INTEGER), SPEC_IGNORES("randomization"),
	SPEC_IGNORES("jitter"), {0}};

enum spec_status
spec_parser_sampler(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments = spec_parser_arguments(parser, statement, -1);
	struct spec_scene *scene = parser->scene;
	int x = 4, y = 4; /* pbrt's defaults */
	enum spec_status status = spec_arguments_check(&arguments, sampler);

	scene->samples = 0;
	if (status == SPEC_OK)
		status = whole(&arguments, "xsamples", 1, &x);
	if (status == SPEC_OK)
		status = whole(&arguments, "ysamples", 1, &y);
	if (status == SPEC_OK && (spec_arguments_find(&arguments, "xsamples") ||
					 spec_arguments_find(&arguments, "ysamples"))) {
		if (x > INT_MAX / y)
			return spec_arguments_fail(&arguments, NULL, SPEC_ERANGE,
				"has more than %d samples of a pixel", INT_MAX);
		scene->samples = x * y;
	}
	if (status == SPEC_OK)
		status = whole(&arguments, "pixelsamples", 1, &scene->samples);
	if (status == SPEC_OK)
		status = spec_arguments_whole(
			&arguments, "seed", INT_MIN, INT_MAX, &scene->seed);
	parser->has_seed |= spec_arguments_find(&arguments, "seed") != NULL;
	return status;
}

static const struct spec_expected integrator[] = {SPEC_TAKES("maxdepth", SPEC_INTEGER),
	SPEC_TAKES("regularize", SPEC_BOOL), SPEC_IGNORES("lightsampler"),
	SPEC_IGNORES("samplelights"), SPEC_IGNORES("samplebsdf"), {0}};

static const struct spec_parsing_sort integrators[] = {{"path", integrator, 0},
	{"volpath", integrator, 0}, {"simplepath", integrator, 0},
	{"simplevolpath", integrator, 0}, {"bdpt", NULL, 0}, {"mlt", NULL, 0},
	{"sppm", NULL, 0}, {"lightpath", NULL, 0}, {"randomwalk", NULL, 0},
	{"ambientocclusion", NULL, 0}, {"function", NULL, 0}, {0}};

enum spec_status
spec_parser_integrator(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments = spec_parser_arguments(parser, statement, -1);
	struct spec_scene *scene = parser->scene;
	int regularize = 0;
	enum spec_status status;

	if (!spec_parser_sort(parser, statement, integrators, NULL))
		return parser->error->status;
	scene->max_depth = -1;
	status = spec_arguments_check(&arguments, integrator);
	if (status == SPEC_OK)
		status = whole(&arguments, "maxdepth", 0, &scene->max_depth);
	if (status == SPEC_OK)
		status = spec_arguments_flag(&arguments, "regularize", &regularize);
	if (status == SPEC_OK && regularize)
		status = spec_arguments_fail(&arguments,
			spec_arguments_find(&arguments, "regularize"), SPEC_EUNSUPPORTED,
			"is not supported: surfaces would be rougher than they are");
	if (status == SPEC_OK && strcmp(statement->name, "path") != 0)
		status = spec_scene_warn(scene, &statement->place, parser->error,
			"%s is done as Integrator \"path\"", arguments.statement);
	return status == SPEC_OK ? set_text(&scene->integrator, "path", parser->error)
				 : status;
}

static const struct spec_expected filter[] = {SPEC_TAKES("xradius", SPEC_FLOAT),
	SPEC_TAKES("yradius", SPEC_FLOAT), SPEC_TAKES("sigma", SPEC_FLOAT),
	SPEC_TAKES("B", SPEC_FLOAT), SPEC_TAKES("C", SPEC_FLOAT),
	SPEC_TAKES("tau", SPEC_FLOAT), {0}};

static const struct spec_parsing_sort filters[] = {{"box", filter, 0},
	{"gaussian", filter, 0}, {"mitchell", filter, 0}, {"sinc", filter, 0},
	{"triangle", filter, 0}, {0}};

enum spec_status
spec_parser_filter(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments = spec_parser_arguments(parser, statement, -1);
	double x = 0.5, y = 0.5;
	enum spec_status status;

	if (!spec_parser_sort(parser, statement, filters, NULL))
		return parser->error->status;
	status = spec_arguments_check(&arguments, filter);
	if (status == SPEC_OK)
		status = spec_arguments_positive(&arguments, "xradius", &x);
	if (status == SPEC_OK)
		status = spec_arguments_positive(&arguments, "yradius", &y);
	if (status != SPEC_OK ||
		(strcmp(statement->name, "box") == 0 && x == 0.5 && y == 0.5))
		return status;
	return spec_scene_warn(parser->scene, &statement->place, parser->error,
		"%s is done as PixelFilter \"box\": a pixel is the mean of its samples",
		arguments.statement);
}

/* ---- options ---- */

enum option_kind {
	OPTION_SEED,
	OPTION_IGNORED, /* without it the picture is the same */
	OPTION_MATTERS  /* true is not supported */
};

static const struct option {
	const char *name;
	enum option_kind kind;
} options[] = {{"seed", OPTION_SEED}, {"disablepixeljitter", OPTION_MATTERS},
	{"forcediffuse", OPTION_MATTERS}, {"disabletexturefiltering", OPTION_IGNORED},
	{"disablewavelengthjitter", OPTION_IGNORED},
	{"displacementedgescale", OPTION_IGNORED}, {"msereferenceimage", OPTION_IGNORED},
	{"msereferenceout", OPTION_IGNORED}, {"rendercoordsys", OPTION_IGNORED},
	{"pixelstats", OPTION_IGNORED}, {"wavefront", OPTION_IGNORED}, {0}};

/* pbrt takes upper and lower case as equal, and does without _ and -. */
static const struct option *
find_option(const char *name)
{
	for (const struct option *option = options; option->name; option++) {
		const char *at = name, *wanted = option->name;

		while (*at && (*at == '_' || *at == '-' ||
				      tolower((unsigned char)*at) == *wanted)) {
			wanted += *at != '_' && *at != '-';
			at++;
		}
		if (*at == '\0' && *wanted == '\0')
			return option;
	}
	return NULL;
}

static enum spec_status
set_seed(struct spec_parser *parser, const struct spec_token *token)
{
	double value = 0.5;
	enum spec_status status = spec_tokens_read_number(&parser->tokens, token, &value);

	if (status != SPEC_OK)
		return status;
	if (value < INT_MIN || value > INT_MAX || value != (double)(long long)value)
		return spec_scene_fail(parser->scene, &token->place, parser->error,
			SPEC_ERANGE, "the seed is not a whole number in %d..%d", INT_MIN,
			INT_MAX);
	if (!parser->has_seed)
		parser->scene->seed = (long long)value;
	return SPEC_OK;
}

enum spec_status
spec_parser_option(struct spec_parser *parser, struct spec_statement *statement)
{
	const struct option *option = find_option(statement->name);
	const char *nearest = spec_nearest_name(statement->name, options, sizeof *options);
	struct spec_token value;
	enum spec_status status = spec_tokens_next(&parser->tokens, &value);

	if (status != SPEC_OK)
		return status;
	if (value.kind != SPEC_TOKEN_WORD && value.kind != SPEC_TOKEN_STRING)
		return spec_scene_fail(parser->scene, &value.place, parser->error,
			SPEC_EFORMAT, "a value of Option \"%.60s\" is missing here",
			statement->name);
	if (!option)
		return spec_parser_fail(parser, statement, SPEC_EFORMAT,
			"there is no Option \"%.60s\"%s%s%s", statement->name,
			nearest ? "; did you mean \"" : "", nearest ? nearest : "",
			nearest ? "\"?" : "");
	if (option->kind == OPTION_SEED)
		return set_seed(parser, &value);
	if (spec_token_is_word(&value, "false"))
		return SPEC_OK;
	if (option->kind == OPTION_MATTERS)
		return spec_parser_fail(parser, statement,
			spec_token_is_word(&value, "true") ? SPEC_EUNSUPPORTED
							   : SPEC_EFORMAT,
			spec_token_is_word(&value, "true")
				? "Option \"%.60s\" is not supported"
				: "Option \"%.60s\" is neither true nor false",
			statement->name);
	return spec_scene_warn(parser->scene, &statement->place, parser->error,
		"Option \"%.60s\" is not used", statement->name);
}

enum spec_status
spec_parser_colour_space(struct spec_parser *parser, struct spec_statement *statement)
{
	static const struct spec_expected nothing[] = {{0}};
	static const struct spec_parsing_sort spaces[] = {{"srgb", nothing, 0},
		{"dci-p3", NULL, 0}, {"rec2020", NULL, 0}, {"aces2065-1", NULL, 0}, {0}};

	return spec_parser_sort(parser, statement, spaces, NULL) ? SPEC_OK
								 : parser->error->status;
}
