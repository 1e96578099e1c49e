#include "place/spelling.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "place/coordinates.h"

#define MOST_PIECES 16

static int
is_space(char c)
{
	return isspace((unsigned char)c) || c == ',';
}

static int
is_letter(const char *piece, const char *letters)
{
	return piece[0] && !piece[1] && strchr(letters, piece[0]);
}

static int
ends_in(const char *piece, const char *end)
{
	size_t length = strlen(piece), size = strlen(end);

	return length > size && strcmp(piece + length - size, end) == 0;
}

/* Cuts it up in place; 0: there are more than MOST_PIECES. */
static size_t
cut(char *text, char *piece[MOST_PIECES])
{
	size_t pieces = 0;

	for (char *at = text; *at;) {
		if (is_space(*at)) {
			*at++ = '\0';
			continue;
		}
		if (pieces == MOST_PIECES)
			return 0;
		piece[pieces++] = at;
		while (*at && !is_space(*at))
			at++;
	}
	return pieces;
}

/* How many of the last pieces are an altitude: "1830m", "1.8km", "1830 m". */
static size_t
altitude_pieces(char *const piece[], size_t pieces, char number[SPEC_SPELLING_LONGEST],
	double *unit_m)
{
	const char *last = pieces > 1 ? piece[pieces - 1] : "";
	size_t length = strlen(last);

	if (length == 0 || last[length - 1] != 'm')
		return 0;
	*unit_m = length > 1 && last[length - 2] == 'k' ? 1000 : 1;
	length -= *unit_m > 1 ? 2 : 1;
	if (length == 0 && pieces > 2) {
		strcpy(number, piece[pieces - 2]);
		return 2;
	}
	memcpy(number, last, length);
	number[length] = '\0';
	return 1;
}

enum spec_status
spec_spelling_part(const char *text, char spelt[SPEC_SPELLING_LONGEST], double *altitude_m,
	struct spec_error *error)
{
	char copy[SPEC_SPELLING_LONGEST], number[SPEC_SPELLING_LONGEST];
	char *piece[MOST_PIECES];
	double unit_m = 1;
	size_t pieces, behind, length = 0;

	if (strlen(text) >= sizeof copy)
		return spec_error_set(error, SPEC_EUSAGE,
			"a place has fewer than %zu bytes", sizeof copy);
	strcpy(copy, text);
	pieces = cut(copy, piece);
	if (pieces == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is no place: write it as in 39.742 -105.179, 39d44'33\"N "
			"105d10'43\"W or 13SDD8469999397",
			text);
	behind = altitude_pieces(piece, pieces, number, &unit_m);
	if (behind > 0) {
		enum spec_status status = spec_number_parse(number,
			SPEC_PLACE_LOWEST_M / unit_m, SPEC_PLACE_HIGHEST_M / unit_m,
			unit_m > 1 ? "the altitude in km" : "the altitude in m", altitude_m,
			error);

		if (status != SPEC_OK)
			return status;
		*altitude_m *= unit_m;
	}
	for (size_t i = 0; i < pieces - behind; i++)
		length +=
			(size_t)sprintf(spelt + length, "%s%s", i > 0 ? " " : "", piece[i]);
	return SPEC_OK;
}

static int
is_seconds(const char *piece)
{
	const char *mark = piece + strspn(piece, "0123456789.");

	return strchr("\"'", *mark) || strncmp(mark, "\u2033", 3) == 0 ||
	       strncmp(mark, "\u201d", 3) == 0;
}

/* Degrees, then minutes; minutes, then seconds: whether the piece goes on in the next one. */
static int
goes_on(const char *piece, const char *next)
{
	if (!isdigit((unsigned char)next[0]))
		return 0;
	if (ends_in(piece, "d") || ends_in(piece, "D") || ends_in(piece, "\u00b0") ||
		ends_in(piece, "\u00ba"))
		return 1;
	return (ends_in(piece, "'") || ends_in(piece, "\u2032") ||
		       ends_in(piece, "\u2019")) &&
	       is_seconds(next);
}

int
spec_spelling_join(char spelt[SPEC_SPELLING_LONGEST])
{
	char copy[SPEC_SPELLING_LONGEST];
	char *piece[MOST_PIECES];
	size_t pieces, length = 0;
	int before, joined = 0;

	strcpy(copy, spelt);
	pieces = cut(copy, piece);
	before = pieces > 0 && is_letter(piece[0], "NSEWnsew");
	for (size_t i = 0; i < pieces; i++) {
		const char *last = i > 0 ? piece[i - 1] : "";
		int joins =
			i > 0 && (goes_on(last, piece[i]) ||
					 is_letter(before ? last : piece[i], "NSEWnsew"));

		joined |= joins;
		length += (size_t)sprintf(
			spelt + length, "%s%s", i > 0 && !joins ? " " : "", piece[i]);
	}
	return joined;
}

int
spec_spelling_is_half(const char *spelt)
{
	return spelt[strspn(spelt, "0123456789.+-:d'\"NSEWnsew")] == '\0';
}
