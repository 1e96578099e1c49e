/* What is wrong with an image's attributes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/linting.h"

#define OWN_PREFIX "spec:"

/* Those of specexr(5), and their types. */
static const struct {
	const char *name, *type;
} known[] = {{"spectralLayoutVersion", "string"}, {"emissiveUnits", "string"},
	{"polarisationHandedness", "string"}, {"EV", "float"},
	{"lensTransmission", "string"}, {"cameraResponse", "string"},
	{"spec:quantity", "string"}, {"spec:bins", "string"}, {"spec:history", "string"},
	{"spec:camera", "string"}, {"spec:lamps", "string"}, {"worldToCamera", "m44f"},
	{"worldToNDC", "m44f"}, {"chromaticities", "chromaticities"},
	{"longitude", "float"}, {"latitude", "float"}, {"altitude", "float"},
	{"capDate", "string"}, {"utcOffset", "float"}, {"spec:representation", "string"},
	{"spec:wavelengths", "string"}, {"spec:medium", "string"}, {"spec:samples", "int"},
	{"spec:atlas", "string"}, {"spec:atlas-lines", "string"},
	{"spec:integration", "string"}, {"whiteLuminance", "float"}};

static void
check_types(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;

	for (size_t i = 0; i < image->attributes; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];
		const char *wanted = NULL;

		for (size_t j = 0; j < sizeof known / sizeof known[0]; j++) {
			if (strcmp(attribute->name, known[j].name) == 0)
				wanted = known[j].type;
		}
		if (wanted && strcmp(attribute->type, wanted) != 0)
			spec_linting_add(linting, SPEC_LINT_WARNING, attribute->name,
				"is of type %s instead of %s, and so means nothing",
				attribute->type, wanted);
		else if (!wanted &&
			 strncmp(attribute->name, OWN_PREFIX, strlen(OWN_PREFIX)) == 0)
			spec_linting_add(linting, SPEC_LINT_NOTE, attribute->name,
				"is none of the attributes that this version knows");
	}
}

/* A text attribute, or null where there is none; newly allocated. */
static char *
text_of(struct spec_linting *linting, const char *name)
{
	char *text = NULL;

	if (linting->status == SPEC_OK)
		linting->status =
			spec_image_text(linting->image, name, &text, linting->error);
	return text;
}

/* A text that must be there, and be this. */
static void
expect_text(struct spec_linting *linting, const char *name, const char *wanted)
{
	char *text = text_of(linting, name);

	if (!spec_image_attribute(linting->image, name))
		spec_linting_add(linting, SPEC_LINT_WARNING, name,
			"is missing; a writer must write '%s'", wanted);
	else if (text && strcmp(text, wanted) != 0)
		spec_linting_add(linting, SPEC_LINT_WARNING, name, "is '%.200s', not '%s'",
			text, wanted);
	free(text);
}

static void
check_layout(struct spec_linting *linting)
{
	expect_text(linting, "spectralLayoutVersion", "1.0");
	if (linting->role == SPEC_ROLE_EMISSIVE)
		expect_text(linting, "emissiveUnits", "W.m^-2.sr^-1");
	else if (spec_image_attribute(linting->image, "emissiveUnits"))
		spec_linting_add(linting, SPEC_LINT_NOTE, "emissiveUnits",
			"is there, but no band of light");
}

static void
check_handedness(struct spec_linting *linting)
{
	char *text = text_of(linting, "polarisationHandedness");
	int polarised = linting->bands[1] + linting->bands[2] + linting->bands[3] > 0;

	if (text && strcmp(text, "left") != 0 && strcmp(text, "right") != 0)
		spec_linting_add(linting, SPEC_LINT_WARNING, "polarisationHandedness",
			"is '%.200s', neither 'left' nor 'right'", text);
	else if (polarised &&
		 !spec_image_attribute(linting->image, "polarisationHandedness"))
		spec_linting_add(linting, SPEC_LINT_WARNING, "polarisationHandedness",
			"is missing: the sign of S3 is not known");
	free(text);
}

/* A quantity of the other kind is a mistake; an unknown one is allowed. */
static void
check_quantity(struct spec_linting *linting)
{
	static const char *const ratios[] = {
		"reflectance", "transmittance", "absorptance", "reflectance factor"};
	char *text = text_of(linting, "spec:quantity");
	int ratio = 0, light;

	if (!text)
		return;
	for (size_t i = 0; i < sizeof ratios / sizeof ratios[0]; i++)
		ratio |= strcmp(text, ratios[i]) == 0;
	light = strcmp(text, "radiance per nm") == 0 ||
		strcmp(text, "radiance per band") == 0;
	if (linting->role == SPEC_ROLE_EMISSIVE ? ratio : light)
		spec_linting_add(linting, SPEC_LINT_WARNING, "spec:quantity",
			"is '%s', but the bands are named as %s", text,
			linting->role == SPEC_ROLE_EMISSIVE ? "light" : "reflectance");
	else if (!ratio && !light)
		spec_linting_add(linting, SPEC_LINT_NOTE, "spec:quantity",
			"is '%.200s', none of those that this version knows", text);
	free(text);
}

/* The edges in a text: how many, and whether there is nothing else. */
static int
scan_edges(const char *text, double *edges_nm, size_t most, size_t *count)
{
	*count = 0;
	while (*text) {
		double edge_nm;
		size_t length = spec_number_scan(text, '.', &edge_nm);

		if (length == 0 || (text[length] != ' ' && text[length] != '\0'))
			return 0;
		if (*count < most)
			edges_nm[*count] = edge_nm;
		++*count;
		text += length + (text[length] == ' ');
	}
	return 1;
}

static void
check_edges(struct spec_linting *linting, const double *edges_nm, size_t bands)
{
	const struct spec_linting_band *band = linting->band[0];

	for (size_t i = 0; i < bands; i++) {
		if (!(edges_nm[i] < edges_nm[i + 1])) {
			spec_linting_add(linting, SPEC_LINT_ERROR, "spec:bins",
				"the edge %.10g nm does not lie above the one before, %.10g nm",
				edges_nm[i + 1], edges_nm[i]);
			return;
		}
	}
	for (size_t i = 0; i < bands; i++) {
		if (band[i].wavelength_nm >= edges_nm[i] &&
			band[i].wavelength_nm <= edges_nm[i + 1])
			continue;
		spec_linting_add(linting, SPEC_LINT_ERROR, "spec:bins",
			"the bin %.10g..%.10g nm is not around its band, %.10g nm",
			edges_nm[i], edges_nm[i + 1], band[i].wavelength_nm);
		return;
	}
}

static void
check_bins(struct spec_linting *linting)
{
	char *text = text_of(linting, "spec:bins");
	size_t bands = linting->bands[0], count;
	double *edges_nm;

	if (!text)
		return;
	edges_nm = spec_memory_new(bands + 1, sizeof *edges_nm, "edges", linting->error);
	if (!edges_nm)
		linting->status = SPEC_ENOMEM;
	else if (!scan_edges(text, edges_nm, bands + 1, &count))
		spec_linting_add(linting, SPEC_LINT_ERROR, "spec:bins",
			"is not numbers with single spaces between them");
	else if (count != bands + 1)
		spec_linting_add(linting, SPEC_LINT_ERROR, "spec:bins",
			"has %zu edges for %zu bands, instead of %zu", count, bands,
			bands + 1);
	else
		check_edges(linting, edges_nm, bands);
	free(edges_nm);
	free(text);
}

static void
check_history(struct spec_linting *linting)
{
	char *text = text_of(linting, "spec:history");

	if (text && *text && text[strlen(text) - 1] != '\n')
		spec_linting_add(linting, SPEC_LINT_WARNING, "spec:history",
			"does not end with a line feed, as each of its lines must");
	free(text);
}

/*
 * The layout's text of a curve: "450.0nm:0.5;460.0nm:0.6;". Returns 0 where it is not that;
 * *open: the last semicolon is missing.
 */
static int
is_curve(const char *text, int *open)
{
	*open = 0;
	while (*text) {
		double value;
		size_t length = spec_number_scan(text, '.', &value);

		if (length == 0 || *open || strncmp(text + length, "nm:", 3) != 0)
			return 0;
		text += length + 3;
		length = spec_number_scan(text, '.', &value);
		if (length == 0 || (text[length] != ';' && text[length] != '\0'))
			return 0;
		*open = text[length] == '\0';
		text += length + !*open;
	}
	return 1;
}

static void
check_curve(struct spec_linting *linting, const char *name)
{
	char *text = text_of(linting, name);
	int open;

	if (text && !is_curve(text, &open))
		spec_linting_add(linting, SPEC_LINT_WARNING, name,
			"is no curve as the layout writes it (450.0nm:0.5;460.0nm:0.6;)");
	else if (text && open)
		spec_linting_add(
			linting, SPEC_LINT_NOTE, name, "lacks the semicolon at its end");
	free(text);
}

static void
check_curves(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;

	check_curve(linting, "lensTransmission");
	check_curve(linting, "cameraResponse");
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role != SPEC_ROLE_OTHER &&
			spec_image_attribute(image, image->channel[i].name))
			check_curve(linting, image->channel[i].name);
	}
}

/* longitude, latitude, utcOffset: what they may be at most. */
static void
check_place(struct spec_linting *linting, const char *name, float most, const char *unit)
{
	const struct spec_attribute *attribute = spec_image_attribute(linting->image, name);
	float value;

	if (!attribute || strcmp(attribute->type, "float") != 0 ||
		attribute->size != sizeof value)
		return;
	memcpy(&value, attribute->value, sizeof value);
	if (!(fabsf(value) <= most))
		spec_linting_add(linting, SPEC_LINT_WARNING, name, "is %g %s, beyond %g",
			value, unit, most);
}

/* "YYYY:MM:DD hh:mm:ss", with digits that a calendar and a clock can show. */
static int
is_date(const char *text)
{
	int field[6], end = 0;

	if (sscanf(text, "%4d:%2d:%2d %2d:%2d:%2d%n", &field[0], &field[1], &field[2],
		    &field[3], &field[4], &field[5], &end) < 6 ||
		end != 19 || text[end] || strspn(text, "0123456789: ") != 19)
		return 0;
	return field[1] >= 1 && field[1] <= 12 && field[2] >= 1 && field[2] <= 31 &&
	       field[3] <= 23 && field[4] <= 59 && field[5] <= 60;
}

static void
check_date(struct spec_linting *linting)
{
	char *text = text_of(linting, "capDate");

	if (text && !is_date(text))
		spec_linting_add(linting, SPEC_LINT_WARNING, "capDate",
			"is '%.40s', not YYYY:MM:DD hh:mm:ss", text);
	free(text);
}

/* Half of what says where or when; a date alone is a local time, as cameras note it. */
static void
check_pair(struct spec_linting *linting, const char *one, const char *other)
{
	if (spec_image_attribute(linting->image, one) &&
		!spec_image_attribute(linting->image, other))
		spec_linting_add(
			linting, SPEC_LINT_NOTE, one, "means nothing without %s", other);
}

void
spec_linting_attributes(struct spec_linting *linting)
{
	if (linting->status != SPEC_OK)
		return;
	check_types(linting);
	if (linting->role != SPEC_ROLE_OTHER) {
		if (linting->exr)
			check_layout(linting);
		check_quantity(linting);
		check_bins(linting);
		check_handedness(linting);
		check_curves(linting);
	}
	check_history(linting);
	check_place(linting, "longitude", 180, "degrees");
	check_place(linting, "latitude", 90, "degrees");
	check_place(linting, "utcOffset", 86400, "s");
	check_date(linting);
	check_pair(linting, "longitude", "latitude");
	check_pair(linting, "latitude", "longitude");
	check_pair(linting, "utcOffset", "capDate");
}
