/* Which bands come out of a conversion, and of which of the input's each is made. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/converting.h"
#include "spectrum/rebin.h"
#include "spectrum/weights.h"

void
spec_converting_note(struct spec_converting *converting, const char *format, ...)
{
	struct spec_convert_notes *notes = &converting->convert->notes;
	va_list arguments;

	if (notes->count == SPEC_CONVERT_MOST_NOTES)
		return;
	va_start(arguments, format);
	vsnprintf(notes->text[notes->count++], sizeof notes->text[0], format, arguments);
	va_end(arguments);
}

int
spec_converting_to_band(const struct spec_converting *converting)
{
	return converting->setup->per == SPEC_CONVERT_PER_BAND ||
	       (converting->per_band && converting->setup->per != SPEC_CONVERT_PER_NM);
}

static enum spec_status
copy_numbers(const double *from, size_t count, double **to, struct spec_error *error)
{
	*to = spec_memory_new(count, sizeof **to, "wavelengths", error);
	if (!*to)
		return SPEC_ENOMEM;
	memcpy(*to, from, count * sizeof *from);
	return SPEC_OK;
}

static enum spec_status
halfway(const struct spec_converting_bands *bands, double **edges_nm,
	struct spec_error *error)
{
	*edges_nm = spec_memory_new(
		bands->count + 1, sizeof **edges_nm, "edges of bins", error);
	if (!*edges_nm)
		return SPEC_ENOMEM;
	spec_bins_halfway(bands->wavelength_nm, bands->count, *edges_nm);
	return SPEC_OK;
}

/* The input's bands, in air or vacuum as it is asked for. */
static enum spec_status
find_known(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_image *input = converting->convert->input;
	enum spec_medium medium = converting->setup->medium;
	struct spec_converting_bands *known = &converting->known;
	enum spec_status status = copy_numbers(
		input->wavelength_nm, input->bands, &known->wavelength_nm, error);

	known->count = input->bands;
	if (status == SPEC_OK && input->edges_nm)
		status = copy_numbers(
			input->edges_nm, input->bands + 1, &known->edges_nm, error);
	if (status != SPEC_OK || medium == SPEC_MEDIUM_UNKNOWN)
		return status;
	converting->renewed = 1;
	status = spec_air_convert(medium, known->wavelength_nm, known->count, error);
	if (status == SPEC_OK && known->edges_nm)
		status = spec_air_convert(medium, known->edges_nm, known->count + 1, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s", converting->name);
	return status;
}

/* The bands that --band names must be there: nothing is interpolated. */
static enum spec_status
match_bands(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_converting_bands *known = &converting->known;
	struct spec_converting_bands *made = &converting->made;

	for (size_t i = 0; i < made->count; i++) {
		double target = made->wavelength_nm[i];
		int same;
		size_t band = spec_grid_nearest(
			known->wavelength_nm, known->count, target, &same);

		made->wavelength_nm[i] = known->wavelength_nm[band];
		if (!same)
			return spec_error_set(error, SPEC_ERANGE,
				"%s: has no band at %g nm; the nearest is at %g nm (--grid interpolates)",
				converting->name, target, known->wavelength_nm[band]);
	}
	return SPEC_OK;
}

/* Bins stay bins only where the bands stay as they are, without gaps between them. */
static enum spec_status
keep_bins(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_converting_bands *known = &converting->known;
	struct spec_converting_bands *made = &converting->made;
	size_t first = 0;

	for (size_t i = 0; known->edges_nm && i < made->count; i++) {
		int same;
		size_t band = spec_grid_nearest(
			known->wavelength_nm, known->count, made->wavelength_nm[i], &same);

		if (i == 0)
			first = band;
		if (!same || band != first + i)
			return SPEC_OK;
	}
	if (!known->edges_nm)
		return SPEC_OK;
	return copy_numbers(
		known->edges_nm + first, made->count + 1, &made->edges_nm, error);
}

static enum spec_status
find_made(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	const struct spec_grid own = {
		converting->known.wavelength_nm, converting->known.count};
	const struct spec_grid *grid = setup->grid ? setup->grid : setup->bands;
	struct spec_converting_bands *made = &converting->made;
	enum spec_status status;

	converting->renewed |= grid != NULL;
	grid = grid ? grid : &own;
	made->count = grid->count;
	status =
		copy_numbers(grid->wavelength_nm, grid->count, &made->wavelength_nm, error);
	if (status == SPEC_OK && setup->bands && !setup->grid)
		status = match_bands(converting, error);
	if (status != SPEC_OK)
		return status;
	if (setup->rebin && setup->edges_nm)
		return copy_numbers(
			setup->edges_nm, made->count + 1, &made->edges_nm, error);
	status = setup->rebin ? SPEC_OK : keep_bins(converting, error);
	/* An integral over a band needs to say over what. */
	if (status == SPEC_OK && !made->edges_nm &&
		(setup->rebin || setup->per == SPEC_CONVERT_PER_BAND))
		status = halfway(made, &made->edges_nm, error);
	return status;
}

static enum spec_status
add_sum(struct spec_converting *converting, size_t band, double weight,
	struct spec_error *error)
{
	void *bands = converting->band, *weights = converting->weight;
	enum spec_status status = spec_memory_grow(&bands, &converting->band_room,
		converting->terms + 1, sizeof *converting->band, "weights", error);

	converting->band = bands;
	if (status == SPEC_OK)
		status = spec_memory_grow(&weights, &converting->weight_room,
			converting->terms + 1, sizeof *converting->weight, "weights",
			error);
	converting->weight = weights;
	if (status != SPEC_OK)
		return status;
	converting->band[converting->terms] = band;
	converting->weight[converting->terms++] = weight;
	return SPEC_OK;
}

static enum spec_status
refuse_outside(const struct spec_converting *converting, double wavelength_nm,
	struct spec_error *error)
{
	const struct spec_converting_bands *known = &converting->known;

	return spec_error_set(error, SPEC_ERANGE,
		"%s: %g nm is outside its bands, %g..%g nm (--extrapolate zero|constant)",
		converting->name, wavelength_nm, known->wavelength_nm[0],
		known->wavelength_nm[known->count - 1]);
}

/* One band of the output: the input's band, or those that it lies between. */
static enum spec_status
interpolate_band(struct spec_converting *converting, size_t made, struct spec_error *error)
{
	const struct spec_converting_bands *known = &converting->known;
	enum spec_extrapolate extrapolate = converting->setup->extrapolate;
	double wavelength_nm = converting->made.wavelength_nm[made];
	int same, outside = wavelength_nm < known->wavelength_nm[0] ||
			    wavelength_nm > known->wavelength_nm[known->count - 1];
	size_t nearest =
		spec_grid_nearest(known->wavelength_nm, known->count, wavelength_nm, &same);
	struct spec_weights weights;
	enum spec_status status = SPEC_OK;

	if (same)
		return add_sum(converting, nearest, 1, error);
	if (outside && extrapolate == SPEC_EXTRAPOLATE_REFUSE)
		return refuse_outside(converting, wavelength_nm, error);
	if (outside && extrapolate == SPEC_EXTRAPOLATE_ZERO)
		return SPEC_OK; /* no term: zero times a NaN would be one */
	weights = spec_weights_at(converting->setup->interpolation, known->wavelength_nm,
		known->count, wavelength_nm);
	for (size_t i = 0; i < weights.count && status == SPEC_OK; i++)
		status = add_sum(converting, weights.first + i, weights.weight[i], error);
	return status;
}

/* What a bin of the output gets of a density: the mean over it. */
static enum spec_status
rebin_band(struct spec_converting *converting, const double *known_nm, size_t made,
	struct spec_error *error)
{
	const double *bin_nm = converting->made.edges_nm + made;
	enum spec_extrapolate extrapolate = converting->setup->extrapolate;
	size_t bins = converting->known.count;
	double width_nm = bin_nm[1] - bin_nm[0];
	struct spec_overlap overlap =
		spec_bins_overlap(known_nm, bins, bin_nm[0], bin_nm[1]);
	int constant = extrapolate == SPEC_EXTRAPOLATE_CONSTANT;
	enum spec_status status = SPEC_OK;

	if (overlap.count == 0 && extrapolate == SPEC_EXTRAPOLATE_REFUSE)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the bin %g..%g nm is outside its bins, %g..%g nm (--extrapolate "
			"zero|constant)",
			converting->name, bin_nm[0], bin_nm[1], known_nm[0],
			known_nm[bins]);
	if (constant && overlap.below_nm > 0)
		status = add_sum(converting, 0, overlap.below_nm / width_nm, error);
	for (size_t i = overlap.first;
		i < overlap.first + overlap.count && status == SPEC_OK; i++)
		status = add_sum(converting, i,
			spec_bins_shared(known_nm, i, bin_nm[0], bin_nm[1]) / width_nm,
			error);
	if (status == SPEC_OK && constant && overlap.above_nm > 0)
		status = add_sum(converting, bins - 1, overlap.above_nm / width_nm, error);
	return status;
}

static void
note_outside(struct spec_converting *converting, const double *edges_nm)
{
	const struct spec_convert_setup *setup = converting->setup;
	const struct spec_converting_bands *known = &converting->known,
					   *made = &converting->made;
	const double *from_nm = setup->rebin ? edges_nm : known->wavelength_nm;
	const double *to_nm = setup->rebin ? made->edges_nm : made->wavelength_nm;
	size_t last = setup->rebin ? 0 : 1; /* an edge more than bands */
	char text[160];

	spec_bins_describe_outside(text, sizeof text, from_nm[0],
		from_nm[known->count - last], to_nm[0], to_nm[made->count - last]);
	if (setup->grid && *text && converting->terms > 0)
		spec_converting_note(converting, "%s: has nothing at %s: taken %s",
			converting->name, text,
			setup->extrapolate == SPEC_EXTRAPOLATE_CONSTANT ? "as at its end"
									: "for 0");
}

/* From or to integrals over bands: the widths of the bins come in. */
static enum spec_status
weigh_widths(struct spec_converting *converting, const double *known_nm,
	struct spec_error *error)
{
	const struct spec_converting_bands *made = &converting->made;
	int to_band = spec_converting_to_band(converting);
	double *made_nm = NULL;
	enum spec_status status = SPEC_OK;

	if (!converting->per_band && !to_band)
		return SPEC_OK;
	if (!made->edges_nm)
		status = halfway(made, &made_nm, error);
	for (size_t i = 0; i < made->count && status == SPEC_OK; i++) {
		const double *edges_nm = made_nm ? made_nm : made->edges_nm;
		double width_nm = to_band ? edges_nm[i + 1] - edges_nm[i] : 1;

		for (size_t t = converting->first[i]; t < converting->first[i + 1]; t++) {
			size_t band = converting->band[t];

			converting->weight[t] *= width_nm;
			if (converting->per_band)
				converting->weight[t] /=
					known_nm[band + 1] - known_nm[band];
		}
	}
	free(made_nm);
	return status;
}

static enum spec_status
find_sums(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	struct spec_converting_bands *known = &converting->known, *made = &converting->made;
	int widths = setup->per != SPEC_CONVERT_AS_IT_IS &&
		     converting->per_band != spec_converting_to_band(converting);
	double *assumed_nm = NULL, *known_nm = known->edges_nm;
	enum spec_status status = SPEC_OK;

	converting->first =
		spec_memory_new(made->count + 1, sizeof *converting->first, "bands", error);
	if (!converting->first)
		return SPEC_ENOMEM;
	if (!known_nm && (setup->rebin || widths)) {
		status = halfway(known, &assumed_nm, error);
		known_nm = assumed_nm;
		spec_converting_note(converting,
			"%s: has no spec:bins: its bands are taken to meet half-way",
			converting->name);
	}
	for (size_t i = 0; i < made->count && status == SPEC_OK; i++) {
		status = setup->rebin ? rebin_band(converting, known_nm, i, error)
				      : interpolate_band(converting, i, error);
		converting->first[i + 1] = converting->terms;
	}
	if (status == SPEC_OK)
		note_outside(converting, known_nm);
	/* Where both are per band and nothing is rebinned, bands stay as they are. */
	if (status == SPEC_OK && (setup->rebin || widths))
		status = weigh_widths(converting, known_nm, error);
	free(assumed_nm);
	return status;
}

enum spec_status
spec_converting_bands(struct spec_converting *converting, struct spec_error *error)
{
	enum spec_status status = find_known(converting, error);

	if (status == SPEC_OK && converting->setup->grid && !converting->setup->rebin) {
		status = spec_weights_check(converting->setup->interpolation,
			converting->known.wavelength_nm, converting->known.count, error);
		if (status != SPEC_OK)
			spec_error_prefix(error, "%s", converting->name);
	}
	if (status == SPEC_OK)
		status = find_made(converting, error);
	if (status == SPEC_OK)
		status = spec_converting_drop_dark(converting, error);
	return status == SPEC_OK ? find_sums(converting, error) : status;
}
