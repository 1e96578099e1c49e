#include "base/number.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_NUMBER 64 /* characters; no sensible number is longer */

static size_t
digits(const char *text)
{
	size_t count = 0;

	while (isdigit((unsigned char)text[count]))
		count++;
	return count;
}

size_t
spec_number_length(const char *text, char mark)
{
	size_t length = 0, mantissa, exponent;

	if (text[length] == '+' || text[length] == '-')
		length++;
	mantissa = digits(text + length);
	length += mantissa;
	if (text[length] == mark) {
		size_t fraction = digits(text + length + 1);

		if (mantissa + fraction == 0)
			return 0;
		mantissa += fraction;
		length += 1 + fraction;
	}
	if (mantissa == 0)
		return 0;
	if (text[length] == 'e' || text[length] == 'E') {
		size_t sign = text[length + 1] == '+' || text[length + 1] == '-';

		exponent = digits(text + length + 1 + sign);
		if (exponent > 0)
			length += 1 + sign + exponent;
	}
	return length;
}

size_t
spec_number_scan(const char *text, char mark, double *value)
{
	char copy[LONGEST_NUMBER];
	size_t length = spec_number_length(text, mark);
	char *comma;

	if (length == 0 || length >= sizeof copy)
		return 0;
	memcpy(copy, text, length);
	copy[length] = '\0';
	comma = strchr(copy, mark);
	if (comma)
		*comma = '.'; /* no program here calls setlocale: strtod takes a point */
	*value = strtod(copy, NULL);
	return isfinite(*value) ? length : 0;
}

enum spec_status
spec_number_parse(const char *text, double minimum, double maximum, const char *what,
	double *value, struct spec_error *error)
{
	double parsed;
	size_t length = spec_number_scan(text, '.', &parsed);

	if (length == 0 || text[length] != '\0')
		return spec_error_set(
			error, SPEC_EUSAGE, "%s is not a number: '%s'", what, text);
	if (parsed < minimum || parsed > maximum)
		return spec_error_set(error, SPEC_ERANGE, "%s is outside %g..%g: '%s'",
			what, minimum, maximum, text);
	*value = parsed;
	return SPEC_OK;
}

enum spec_status
spec_number_parse_whole(const char *text, long long minimum, long long maximum,
	const char *what, long long *value, struct spec_error *error)
{
	size_t sign = *text == '-' || *text == '+';
	size_t length = sign + digits(text + sign);
	long long parsed;

	if (length == sign || text[length] != '\0')
		return spec_error_set(
			error, SPEC_EUSAGE, "%s is not a whole number: '%s'", what, text);
	errno = 0;
	parsed = strtoll(text, NULL, 10);
	if (errno == ERANGE || parsed < minimum || parsed > maximum)
		return spec_error_set(error, SPEC_ERANGE, "%s is outside %lld..%lld: '%s'",
			what, minimum, maximum, text);
	*value = parsed;
	return SPEC_OK;
}

enum spec_status
spec_number_parse_int(const char *text, int minimum, int maximum, const char *what,
	int *value, struct spec_error *error)
{
	long long number = 0;
	enum spec_status status =
		spec_number_parse_whole(text, minimum, maximum, what, &number, error);

	if (status == SPEC_OK)
		*value = (int)number;
	return status;
}

enum spec_status
spec_number_parse_bytes(
	const char *text, const char *what, long long *value, struct spec_error *error)
{
	static const char suffixes[] = "kMGT";
	size_t length = digits(text);
	const char *suffix = strchr(suffixes, text[length]);
	int shift = text[length] && suffix ? 10 * (int)(suffix - suffixes + 1) : 0;
	long long count;

	errno = 0;
	count = strtoll(text, NULL, 10);
	if (length == 0 || !suffix || (text[length] && text[length + 1]))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s is not a number with an optional k, M, G or T: '%s'", what,
			text);
	if (errno == ERANGE || count == 0 || count > (LLONG_MAX >> shift))
		return spec_error_set(
			error, SPEC_ERANGE, "%s is out of range: '%s'", what, text);
	*value = count << shift;
	return SPEC_OK;
}

struct unit {
	const char *suffix;
	double factor;
};

/* A number with one of so many suffixes, times its factor; 0: it has none of them. */
static int
scan_quantity(const char *text, const struct unit *unit, size_t units, double *value)
{
	double number;
	size_t length = spec_number_scan(text, '.', &number);

	for (size_t i = 0; length > 0 && i < units; i++) {
		if (strcmp(text + length, unit[i].suffix) == 0) {
			*value = number * unit[i].factor;
			return 1;
		}
	}
	return 0;
}

static int
scan_length(const char *text, double *length_nm)
{
	static const struct unit units[] = {
		{"", 1}, {"nm", 1}, {"um", 1e3}, {"mm", 1e6}, {"cm", 1e7}, {"m", 1e9}};

	return scan_quantity(text, units, sizeof units / sizeof units[0], length_nm);
}

enum spec_status
spec_number_parse_length(
	const char *text, const char *what, double *length_nm, struct spec_error *error)
{
	double value;
	enum spec_status status = spec_number_parse_thickness(text, what, &value, error);

	if (status == SPEC_OK && value == 0)
		status = spec_error_set(error, SPEC_ERANGE,
			"%s is not positive and finite: '%s'", what, text);
	if (status == SPEC_OK)
		*length_nm = value;
	return status;
}

enum spec_status
spec_number_parse_thickness(
	const char *text, const char *what, double *length_nm, struct spec_error *error)
{
	double value;

	if (!scan_length(text, &value))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s is not a length in nm, um, mm, cm or m: '%s'", what, text);
	if (!(value >= 0) || !isfinite(value))
		return spec_error_set(error, SPEC_ERANGE,
			"%s is not positive and finite: '%s'", what, text);
	*length_nm = value;
	return SPEC_OK;
}

enum spec_status
spec_number_parse_angle(const char *text, double minimum_deg, double maximum_deg,
	const char *what, double *angle_deg, struct spec_error *error)
{
	static const struct unit units[] = {
		{"", 1}, {"deg", 1}, {"rad", 57.295779513082320877}};
	double value;

	if (!scan_quantity(text, units, sizeof units / sizeof units[0], &value))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s is not an angle in deg or rad: '%s'", what, text);
	if (!(value >= minimum_deg && value <= maximum_deg))
		return spec_error_set(error, SPEC_ERANGE, "%s is outside %g..%g deg: '%s'",
			what, minimum_deg, maximum_deg, text);
	*angle_deg = value;
	return SPEC_OK;
}

enum spec_status
spec_number_parse_size(const char *text, long long most, const char *what, int *width,
	int *height, struct spec_error *error)
{
	size_t length = strcspn(text, "x");
	char first[32];
	long long value[2] = {0};
	enum spec_status status;

	if (text[length] != 'x' || length >= sizeof first)
		return spec_error_set(
			error, SPEC_EUSAGE, "%s is not WxH: '%s'", what, text);
	memcpy(first, text, length);
	first[length] = '\0';
	status = spec_number_parse_whole(first, 1, most, what, &value[0], error);
	if (status == SPEC_OK)
		status = spec_number_parse_whole(
			text + length + 1, 1, most, what, &value[1], error);
	if (status != SPEC_OK)
		return status;
	*width = (int)value[0];
	*height = (int)value[1];
	return SPEC_OK;
}

enum spec_status
spec_number_parse_range(
	const char *text, double *low, double *high, struct spec_error *error)
{
	const char *dots = strstr(text, "..");
	char first[64];
	enum spec_status status;

	if (!dots || (size_t)(dots - text) >= sizeof first)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is not a range A..B, such as 0..1", text);
	memcpy(first, text, (size_t)(dots - text));
	first[dots - text] = '\0';
	status = spec_number_parse(first, -1e30, 1e30, "the lower bound", low, error);
	if (status == SPEC_OK)
		status = spec_number_parse(
			dots + 2, -1e30, 1e30, "the upper bound", high, error);
	if (status == SPEC_OK && *low > *high)
		status = spec_error_set(error, SPEC_EUSAGE,
			"the range '%.200s' is reversed, it takes A..B with A <= B", text);
	return status;
}
