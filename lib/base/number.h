/*
 * Strict parsing of numbers and quantities. The whole text must be the number:
 * trailing junk, an empty text, NaN, infinity and a value outside its range are
 * errors, whose message says what was expected. The locale plays no part.
 */
#ifndef SPEC_BASE_NUMBER_H
#define SPEC_BASE_NUMBER_H

#include <stddef.h>

#include "base/error.h"

/* A finite decimal number in [minimum, maximum]. what: a noun for the message. */
enum spec_status spec_number_parse(const char *text, double minimum, double maximum,
	const char *what, double *value, struct spec_error *error);

/* A whole number in [minimum, maximum]. */
enum spec_status spec_number_parse_whole(const char *text, long long minimum,
	long long maximum, const char *what, long long *value, struct spec_error *error);

/* The same of an int; on an error *value stays as it is. */
enum spec_status spec_number_parse_int(const char *text, int minimum, int maximum,
	const char *what, int *value, struct spec_error *error);

/* A count of bytes with an optional suffix k, M, G or T (powers of 1024). */
enum spec_status spec_number_parse_bytes(
	const char *text, const char *what, long long *value, struct spec_error *error);

/*
 * A length in nm: a number with an optional unit nm, um, mm, cm or m; a bare
 * number is nm. Valid: positive and finite.
 */
enum spec_status spec_number_parse_length(
	const char *text, const char *what, double *length_nm, struct spec_error *error);

/* As spec_number_parse_length, and 0 is valid too. */
enum spec_status spec_number_parse_thickness(
	const char *text, const char *what, double *length_nm, struct spec_error *error);

/*
 * An angle in degrees in [minimum_deg, maximum_deg]: a number with an optional unit deg or
 * rad; a bare number is degrees.
 */
enum spec_status spec_number_parse_angle(const char *text, double minimum_deg,
	double maximum_deg, const char *what, double *angle_deg, struct spec_error *error);

/* "WxH": two whole numbers from 1 to most, which is at most 2^31 - 1. */
enum spec_status spec_number_parse_size(const char *text, long long most, const char *what,
	int *width, int *height, struct spec_error *error);

/* "A..B": two numbers from -1e30 to 1e30, A no larger than B. */
enum spec_status spec_number_parse_range(
	const char *text, double *low, double *high, struct spec_error *error);

/*
 * How many bytes at the start of a text are written as a number, whether or not a double holds
 * it: [+-]digits[mark digits][e[+-]digits]; 0: none.
 */
size_t spec_number_length(const char *text, char mark);

/*
 * The number at the start of a text that need not end there, as the formats
 * write them; mark is the decimal mark, '.' or ','. Returns how many bytes it
 * takes, or 0 if there is none or it is not finite.
 */
size_t spec_number_scan(const char *text, char mark, double *value);

#endif
