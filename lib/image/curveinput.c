#include "image/curveinput.h"

#include <string.h>

#include "colour/space.h"
#include "image/atlas.h"
#include "image/colourcurve.h"
#include "image/reader.h"

/* ---- options ---- */

void
spec_curve_input_init(struct spec_curve_input *input)
{
	*input = (struct spec_curve_input){.paper = {1, 1, 1}};
}

/* A colour, encoded as sRGB has it. */
static enum spec_status
take_code(double code[3], const char *text, struct spec_error *error)
{
	enum spec_status status =
		spec_colour_curve_is_name(text)
			? spec_colour_curve_parse(text, code, error)
			: spec_error_set(error, SPEC_EUSAGE,
				  "'%.100s' is no colour ('#ff0000', 'hsv:0,1,1')", text);

	for (int i = 0; i < 3 && status == SPEC_OK; i++)
		code[i] = spec_srgb_encode(code[i] > 1 ? 1 : code[i]);
	return status;
}

enum spec_status
spec_curve_input_take(struct spec_curve_input *input, const char *name, const char *value,
	int *known, struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "from-rgb") == 0) {
		input->from_rgb = 1;
		return spec_upsampling_find_model(value, &input->colours.model, error);
	}
	if (strcmp(name, "as") == 0) {
		input->has_use = 1;
		return spec_upsampling_find_use(value, &input->colours.use, error);
	}
	if (strcmp(name, "from-plot") == 0) {
		input->from_plot = 1;
		return spec_trace_parse(value, &input->axes, error);
	}
	if (strcmp(name, "ink") == 0) {
		input->has_ink = 1;
		return take_code(input->ink, value, error);
	}
	if (strcmp(name, "paper") == 0)
		return take_code(input->paper, value, error);
	if (strcmp(name, "row") == 0)
		input->row = value;
	else
		*known = 0;
	return SPEC_OK;
}

enum spec_status
spec_curve_input_settle(struct spec_curve_input *input, struct spec_error *error)
{
	const char *wrong = NULL;

	if (input->has_use && !input->from_rgb)
		wrong = "--as goes with --from-rgb";
	else if (input->from_plot && !input->has_ink)
		wrong = "--from-plot needs the curve's colour (--ink '#ff0000')";
	else if (input->has_ink && !input->from_plot)
		wrong = "--ink goes with --from-plot";
	else if (input->from_plot + input->from_rgb + (input->row != NULL) > 1)
		wrong = "--from-rgb, --from-plot and --row exclude each other";
	if (wrong)
		return spec_error_set(error, SPEC_EUSAGE, "%s", wrong);
	if (!input->has_use && input->colours.model == SPEC_UPSAMPLING_SUN)
		input->colours.use = SPEC_UPSAMPLING_LIGHT;
	return SPEC_OK;
}

int
spec_curve_input_is_image(const struct spec_curve_input *input)
{
	return input->from_plot || input->row;
}

/* ---- curves ---- */

static enum spec_status
load_colour(const struct spec_curve_input *input, const char *name,
	struct spec_curve *curve, struct spec_error *error)
{
	double rgb[3];
	enum spec_status status;

	if (!spec_colour_curve_is_name(name))
		return spec_error_set(error, SPEC_EUSAGE,
			"--from-rgb is for images and colours ('#ff8000', 'rgb:1,0.5,0', "
			"'hsv:30,1,1'), not for the curve '%.200s'",
			name);
	status = spec_colour_curve_parse(name, rgb, error);
	return status == SPEC_OK ? spec_colour_curve(rgb, &input->colours, curve, error)
				 : status;
}

static enum spec_status
load_from_image(const struct spec_curve_input *input, const char *name,
	const struct spec_settings *settings, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_reader *reader;
	enum spec_status status = spec_reader_open(&reader, name, settings, error);

	if (status != SPEC_OK)
		return status;
	status = input->row ? spec_atlas_curve(reader, input->row, curve, error)
			    : spec_trace_curve(reader, &input->axes, input->ink,
				      input->paper, curve, error);
	spec_reader_close(reader);
	return status;
}

enum spec_status
spec_curve_input_load(const struct spec_curve_input *input, const char *name,
	const struct spec_reshape *reshape, const struct spec_settings *settings,
	struct spec_curve *curve, struct spec_reshape_notes *notes,
	struct spec_error *error)
{
	enum spec_status status;

	if (!input->from_rgb && !spec_curve_input_is_image(input))
		return spec_reshape_curve(name, reshape, curve, notes, error);
	status = input->from_rgb ? load_colour(input, name, curve, error)
				 : load_from_image(input, name, settings, curve, error);
	return status == SPEC_OK ? spec_reshape_loaded(name, reshape, curve, notes, error)
				 : status;
}
