#include "optics/index.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/number.h"
#include "spectrum/lookup.h"

#define BLANKS " \t\r\n"

/* What is wrong with the pair, or null. */
static const char *
find_fault(double n, double k)
{
	if (!(n >= 0 && n <= SPEC_INDEX_LARGEST))
		return "n lies outside 0..1000000";
	if (k < 0)
		return "k is negative, but in n + ik a medium absorbs with k above 0";
	if (!(k <= SPEC_INDEX_LARGEST))
		return "k lies outside 0..1000000";
	return n + k > 0 ? NULL : "n and k are both 0";
}

static int
begins_as_number(const char *word)
{
	word += *word == '+' || *word == '-';
	word += *word == '.';
	return isdigit((unsigned char)*word);
}

/* fault: the byte of word where it stops being an index. */
static enum spec_status
parse_constant(
	const char *word, struct spec_index *index, size_t *fault, struct spec_error *error)
{
	size_t real = spec_number_scan(word, '.', &index->n), imaginary = 0;
	const char *problem;

	*fault = real;
	index->k = 0;
	if (real > 0 && (word[real] == '+' || word[real] == '-')) {
		imaginary = spec_number_scan(word + real, '.', &index->k);
		*fault = real + (imaginary ? imaginary : 1);
		if (imaginary > 0 && word[*fault] == 'i')
			++*fault;
		else
			imaginary = 0;
	}
	if (real == 0 || word[*fault] || (word[real] && !imaginary))
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is not an index n or n+ki, such as 1.33 or 1.5+0.01i",
			word);
	problem = find_fault(index->n, index->k);
	if (!problem)
		return SPEC_OK;
	*fault = problem[0] == 'k' ? real : 0;
	return spec_error_set(error, SPEC_EUSAGE, "'%.200s' is not a refractive index: %s",
		word, problem);
}

static enum spec_status
find_kind(const char *word, size_t length, enum spec_dispersion_kind *kind,
	struct spec_error *error)
{
	const char *name;
	char names[128] = "";
	int end = 0;

	*kind = SPEC_DISPERSION_SELLMEIER;
	for (; (name = spec_dispersion_name(*kind)); ++*kind) {
		if (strlen(name) == length && memcmp(word, name, length) == 0)
			return SPEC_OK;
		end += snprintf(names + end, sizeof names - (size_t)end, "%s%s",
			end ? ", " : "", name);
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"no dispersion formula is called '%.*s'; there are %s",
		(int)(length < 200 ? length : 200), word, names);
}

/* Reads "name(number,number,…)", with blanks around numbers. open: where the ( stands. */
static enum spec_status
parse_formula(const char *word, size_t open, struct spec_index *index, size_t *fault,
	struct spec_error *error)
{
	struct spec_dispersion *dispersion = &index->dispersion;
	enum spec_status status = find_kind(word, open, &dispersion->kind, error);
	size_t at = open, length;
	double value;

	*fault = 0;
	while (status == SPEC_OK && word[at] != ')') {
		at += 1 +
		      strspn(word + at + 1, BLANKS); /* over the ( or the comma before */
		length = spec_number_scan(word + at, '.', &value);
		*fault = at;
		if (length == 0)
			return spec_error_set(error, SPEC_EUSAGE,
				"coefficient %zu of %s is not a number",
				dispersion->count + 1,
				spec_dispersion_name(dispersion->kind));
		if (dispersion->count == SPEC_DISPERSION_MOST)
			return spec_error_set(error, SPEC_EUSAGE,
				"%s takes at most %d coefficients",
				spec_dispersion_name(dispersion->kind),
				SPEC_DISPERSION_MOST);
		dispersion->coefficient[dispersion->count++] = value;
		at += length;
		at += strspn(word + at, BLANKS);
		*fault = at;
		if (word[at] != ',' && word[at] != ')')
			return spec_error_set(error, SPEC_EUSAGE,
				"expected ',' or ')' after coefficient %zu of %s",
				dispersion->count, spec_dispersion_name(dispersion->kind));
	}
	if (status == SPEC_OK && word[at + 1]) {
		*fault = at + 1;
		return spec_error_set(error, SPEC_EUSAGE,
			"nothing may follow the ')' of %s",
			spec_dispersion_name(dispersion->kind));
	}
	return status == SPEC_OK ? spec_dispersion_check(dispersion, error) : status;
}

/* Whether the curve that index holds is a refractive index. name: of the curve. */
static enum spec_status
check_curve(struct spec_index *index, const char *name, struct spec_error *error)
{
	const struct spec_curve *curve = &index->curve;
	const double *n, *k;

	index->n_column = spec_curve_find_column(curve, "n");
	index->k_column = spec_curve_find_column(curve, "k");
	if (curve->quantity[0] && strcmp(curve->quantity, "refractive index") != 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is a %.200s, not a refractive index", name,
			curve->quantity);
	if (index->n_column == curve->columns)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is not a refractive index: it has no column n", name);
	n = curve->value + index->n_column * curve->count;
	k = curve->value + index->k_column * curve->count;
	for (size_t i = 0; i < curve->count; i++) {
		const char *problem =
			find_fault(n[i], index->k_column < curve->columns ? k[i] : 0);

		if (problem)
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' at %.10g nm: %s", name, curve->wavelength_nm[i],
				problem);
	}
	return SPEC_OK;
}

static enum spec_status
parse_word(
	const char *word, struct spec_index *index, size_t *fault, struct spec_error *error)
{
	size_t open = strcspn(word, "(");
	enum spec_status status;

	*fault = 0;
	index->kind = SPEC_INDEX_CONSTANT;
	index->n = 1;
	if (strcasecmp(word, "air") == 0 || strcasecmp(word, "vacuum") == 0)
		return SPEC_OK;
	if (begins_as_number(word) && word[strspn(word, "0123456789.,+-eEij")] == '\0')
		return parse_constant(word, index, fault, error);
	if (word[open]) {
		index->kind = SPEC_INDEX_DISPERSION;
		return parse_formula(word, open, index, fault, error);
	}
	index->kind = SPEC_INDEX_CURVE;
	status = spec_lookup_curve(word, &index->curve, error);
	return status == SPEC_OK ? check_curve(index, word, error) : status;
}

enum spec_status
spec_index_parse_part(const char *text, size_t at, size_t length, struct spec_index *index,
	struct spec_error *error)
{
	char *word = spec_memory_text(text + at, length, error);
	enum spec_status status = SPEC_ENOMEM;
	size_t fault = 0;

	*index = (struct spec_index){0};
	if (word)
		status = parse_word(word, index, &fault, error);
	free(word);
	if (status == SPEC_OK)
		return SPEC_OK;
	if (status != SPEC_ENOMEM)
		spec_error_point(error, text, at + fault);
	spec_index_free(index);
	return status;
}

enum spec_status
spec_index_parse(const char *text, struct spec_index *index, struct spec_error *error)
{
	return spec_index_parse_part(text, 0, strlen(text), index, error);
}

static enum spec_status
sample_curve(const struct spec_index *index, const double *wavelength_nm, size_t count,
	enum spec_extrapolate extrapolate, double *n, double *k, struct spec_error *error)
{
	enum spec_status status;

	if (extrapolate == SPEC_EXTRAPOLATE_ZERO)
		extrapolate = SPEC_EXTRAPOLATE_REFUSE;
	status = spec_curve_sample(&index->curve, index->n_column, extrapolate,
		wavelength_nm, count, n, error);
	if (status == SPEC_OK && index->k_column < index->curve.columns)
		status = spec_curve_sample(&index->curve, index->k_column, extrapolate,
			wavelength_nm, count, k, error);
	return status;
}

static enum spec_status
sample_dispersion(const struct spec_index *index, const double *wavelength_nm, size_t count,
	double *n, struct spec_error *error)
{
	enum spec_status status =
		spec_dispersion_sample(&index->dispersion, wavelength_nm, count, n, error);

	for (size_t i = 0; status == SPEC_OK && i < count; i++) {
		const char *problem = find_fault(n[i], 0);

		if (problem)
			status = spec_error_set(error, SPEC_ERANGE, "%s at %.10g nm: %s",
				spec_dispersion_name(index->dispersion.kind),
				wavelength_nm[i], problem);
	}
	return status;
}

enum spec_status
spec_index_sample(const struct spec_index *index, const double *wavelength_nm, size_t count,
	enum spec_extrapolate extrapolate, double *n, double *k, struct spec_error *error)
{
	for (size_t i = 0; i < count; i++) {
		n[i] = index->n;
		k[i] = index->kind == SPEC_INDEX_CONSTANT ? index->k : 0;
	}
	if (index->kind == SPEC_INDEX_DISPERSION)
		return sample_dispersion(index, wavelength_nm, count, n, error);
	if (index->kind == SPEC_INDEX_CURVE)
		return sample_curve(index, wavelength_nm, count, extrapolate, n, k, error);
	return SPEC_OK;
}

void
spec_index_free(struct spec_index *index)
{
	if (!index)
		return;
	spec_curve_free(&index->curve);
	*index = (struct spec_index){0};
}
