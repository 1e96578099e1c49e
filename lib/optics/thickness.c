#include "optics/thickness.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "base/vector.h"
#include "optics/recipe.h"

#define GRAVITY "gravity"

/* The word of length bytes at text + at, as a length. */
static enum spec_status
take_length(const char *text, size_t at, size_t length, double *length_nm,
	struct spec_error *error)
{
	char word[64];
	enum spec_status status;

	if (length >= sizeof word) {
		(void)spec_error_set(
			error, SPEC_EUSAGE, "the thickness is longer than any number");
		spec_error_point(error, text, at);
		return SPEC_EUSAGE;
	}
	memcpy(word, text + at, length);
	word[length] = '\0';
	status = spec_number_parse_thickness(word, "the thickness", length_nm, error);
	if (status == SPEC_OK && *length_nm > SPEC_RECIPE_THICKEST_NM)
		status = spec_error_set(error, SPEC_ERANGE,
			"the thickness '%s' is more than %g m", word,
			SPEC_RECIPE_THICKEST_NM * 1e-9);
	if (status != SPEC_OK)
		spec_error_point(error, text, at);
	return status;
}

static enum spec_status
refuse(const char *text, size_t at, struct spec_error *error)
{
	(void)spec_error_set(error, SPEC_EUSAGE,
		"the thickness '%s' is neither a length nor 'gravity TOP..BOTTOM [AXIS]'",
		text);
	spec_error_point(error, text, at);
	return SPEC_EUSAGE;
}

static int
parse_axis(const char *text, struct spec_thickness *thickness)
{
	thickness->downwards = text[0] == '-';
	text += thickness->downwards;
	thickness->up = text[0] - 'x';
	return text[0] >= 'x' && text[0] <= 'z' && text[1] == '\0';
}

static enum spec_status
parse_gravity(const char *text, struct spec_thickness *thickness, struct spec_error *error)
{
	size_t at = strlen(GRAVITY), first, second, length;
	const char *between;
	enum spec_status status;

	at += strspn(text + at, " ");
	first = at;
	between = strstr(text + first, "..");
	if (!between)
		return refuse(text, first, error);
	second = (size_t)(between - text) + 2;
	status = take_length(
		text, first, (size_t)(between - text) - first, &thickness->top_nm, error);
	length = strcspn(text + second, " ");
	if (status == SPEC_OK)
		status = take_length(text, second, length, &thickness->bottom_nm, error);
	if (status == SPEC_OK && (thickness->top_nm == 0 || thickness->bottom_nm == 0)) {
		status = spec_error_set(error, SPEC_ERANGE,
			"gravity leaves no film of 0 nm: the course is exponential");
		spec_error_point(error, text, thickness->top_nm == 0 ? first : second);
	}
	if (status != SPEC_OK)
		return status;
	at = second + length;
	at += strspn(text + at, " ");
	if (text[at] != '\0' && !parse_axis(text + at, thickness))
		return refuse(text, at, error);
	return SPEC_OK;
}

enum spec_status
spec_thickness_parse(
	const char *text, struct spec_thickness *thickness, struct spec_error *error)
{
	enum spec_status status;
	double number;

	*thickness = (struct spec_thickness){.up = 2};
	if (strncmp(text, GRAVITY " ", strlen(GRAVITY " ")) == 0) {
		thickness->kind = SPEC_THICKNESS_GRAVITY;
		return parse_gravity(text, thickness, error);
	}
	if (spec_number_scan(text, '.', &number) == 0)
		return refuse(text, 0, error);
	status = take_length(text, 0, strlen(text), &thickness->top_nm, error);
	thickness->bottom_nm = thickness->top_nm;
	return status;
}

SPEC_VECTORISED static void
hang(const float *restrict height, size_t count, double at_zero, double logarithm,
	double *restrict thickness_nm)
{
	for (size_t i = 0; i < count; i++)
		thickness_nm[i] = at_zero * spec_vector_exp(logarithm * height[i]);
}

void
spec_thickness_row(const struct spec_thickness *thickness, const float *height,
	size_t count, double *thickness_nm)
{
	double top = thickness->top_nm, bottom = thickness->bottom_nm;
	/* The quotient of any two lengths need not be a number. */
	double rise = log(top) - log(bottom);

	if (thickness->kind == SPEC_THICKNESS_GRAVITY && !thickness->downwards)
		hang(height, count, bottom, rise, thickness_nm);
	else if (thickness->kind == SPEC_THICKNESS_GRAVITY)
		hang(height, count, top, -rise, thickness_nm);
	for (size_t i = 0; i < count && thickness->kind == SPEC_THICKNESS_CONSTANT; i++)
		thickness_nm[i] = top;
}
