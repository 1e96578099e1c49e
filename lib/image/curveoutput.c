#include "image/curveoutput.h"

#include <string.h>

#include "base/number.h"
#include "image/atlas.h"
#include "spectrum/spd.h"

#define MOST_PIXELS (1 << 16) /* the side of a patch, a gap, or a strip's height */

/* ---- options ---- */

void
spec_curve_output_init(struct spec_curve_output *output)
{
	*output = (struct spec_curve_output){.patches = {.patch = 1}};
}

enum spec_status
spec_curve_output_take(struct spec_curve_output *output, const char *name,
	const char *value, int *known, struct spec_error *error)
{
	struct spec_patches_setup *patches = &output->patches;

	*known = 1;
	if (strcmp(name, "patches") == 0)
		return spec_number_parse_size(value, SPEC_CURVE_OUTPUT_MOST, "the chart",
			&patches->columns, &patches->rows, error);
	if (strcmp(name, "patch") == 0)
		return spec_number_parse_int(value, 1, MOST_PIXELS, "the side of a patch",
			&patches->patch, error);
	if (strcmp(name, "gap") == 0)
		return spec_number_parse_int(
			value, 0, MOST_PIXELS, "the gap", &patches->gap, error);
	if (strcmp(name, "strip") == 0)
		return spec_number_parse_int(
			value, 1, MOST_PIXELS, "the height", &output->strip, error);
	if (strcmp(name, "scaling") == 0)
		return spec_strip_parse(value, &output->scaling, error);
	if (strcmp(name, "atlas") == 0)
		output->atlas = 1;
	else
		*known = 0;
	return SPEC_OK;
}

const char *
spec_curve_output_option(const struct spec_curve_output *output)
{
	if (output->patches.columns > 0)
		return "--patches";
	if (output->atlas)
		return "--atlas";
	return output->strip > 0 || output->scaling != SPEC_STRIP_AS_IT_IS ? "--strip"
									   : NULL;
}

enum spec_status
spec_curve_output_check(const struct spec_curve_output *output, enum spec_kind kind,
	size_t curves, struct spec_error *error)
{
	const struct spec_patches_setup *patches = &output->patches;
	int text = spec_kind_is_text(kind);
	const char *wrong = NULL;

	if (output->strip == 0 && output->scaling != SPEC_STRIP_AS_IT_IS)
		wrong = "--scaling is for --strip";
	else if (output->strip > 0 && (kind != SPEC_KIND_UNTOLD || patches->columns > 0 ||
					      output->atlas || curves > 1))
		wrong = "--strip makes a picture of one curve, by the suffix of -o";
	else if (output->atlas && (patches->columns > 0 || text))
		wrong = "--atlas makes an image, and one without patches";
	else if (text && (patches->columns > 0 || patches->patch > 1 || patches->gap > 0))
		wrong = "--patches, --patch and --gap make an image, and the output is text "
			"(-o FILE.exr)";
	else if (text && curves > 1)
		wrong = "one curve at a time, or an image of them (--patches, or -o "
			"FILE.exr)";
	if (wrong)
		return spec_error_set(error, SPEC_EUSAGE, "%s", wrong);
	return curves > SPEC_CURVE_OUTPUT_MOST
		       ? spec_error_set(error, SPEC_ERANGE, "more than %d curves",
				 SPEC_CURVE_OUTPUT_MOST)
		       : SPEC_OK;
}

/* ---- files ---- */

enum spec_status
spec_curve_output_text(enum spec_kind kind, const struct spec_curve *curve,
	const char *path, struct spec_error *error)
{
	return kind == SPEC_KIND_CSV ? spec_spd_save_csv(path, curve, error)
				     : spec_spd_save(path, curve, error);
}

static enum spec_status
copy_attributes(
	const struct spec_image *from, struct spec_image *to, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; from && i < from->attributes && status == SPEC_OK; i++) {
		const struct spec_attribute *attribute = &from->attribute[i];

		status = spec_image_set_attribute(to, attribute->name, attribute->type,
			attribute->value, attribute->size, error);
	}
	return status;
}

/* The patches' layout, where none was asked for: one row; on the first curve's own grid. */
static enum spec_status
write_chart(const struct spec_curve_output *output, const struct spec_curve *curve,
	size_t curves, const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_patches_setup patches = output->patches;
	struct spec_grid own = {curve[0].wavelength_nm, curve[0].count};
	struct spec_image image;
	enum spec_status status;

	if (!patches.grid)
		patches.grid = &own;
	if (patches.columns == 0) {
		patches.columns = (int)spec_patches_count(curve, curves);
		patches.rows = 1;
	}
	status = spec_patches_image(&image, curve, curves, &patches, error);
	if (status == SPEC_OK)
		status = copy_attributes(output->attributes, &image, error);
	if (status == SPEC_OK)
		status = spec_settings_record(settings, &image, error);
	if (status == SPEC_OK)
		status = spec_patches_write(
			&image, curve, curves, &patches, settings, overflows, error);
	spec_image_clear(&image);
	return status;
}

enum spec_status
spec_curve_output_save(const struct spec_curve_output *output, enum spec_kind kind,
	const struct spec_curve *curve, const char *const *name, size_t curves,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	if (output->strip > 0)
		return spec_strip_save(
			settings->output, curve, output->scaling, output->strip, error);
	if (output->atlas)
		return spec_atlas_write(curve, name, curves, output->patches.grid,
			output->patches.extrapolate, settings, error);
	if (spec_kind_is_text(kind))
		return spec_curve_output_text(kind, curve, settings->output, error);
	return write_chart(output, curve, curves, settings, overflows, error);
}
