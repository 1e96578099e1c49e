#include "image/names.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

#define LIGHT_NM_PER_S 299792458e9 /* c, exact, SI 2019 */
#define ISET_FIRST_NM 400.0        /* ISET3d: C01 is 400 nm, C31 is 700 nm */
#define ISET_STEP_NM 10.0
#define ISET_BANDS 31

/* Takes a prefix of the SI from *text; 1 where there is none. "m" alone is a metre. */
static double
take_prefix(const char **text)
{
	static const struct {
		const char *prefix;
		double factor;
	} prefixes[] = {{"da", 1e1}, {"Y", 1e24}, {"Z", 1e21}, {"E", 1e18}, {"P", 1e15},
		{"T", 1e12}, {"G", 1e9}, {"M", 1e6}, {"k", 1e3}, {"h", 1e2}, {"d", 1e-1},
		{"c", 1e-2}, {"m", 1e-3}, {"u", 1e-6}, {"n", 1e-9}, {"p", 1e-12}};

	for (size_t i = 0; i < sizeof prefixes / sizeof prefixes[0]; i++) {
		size_t length = strlen(prefixes[i].prefix);
		const char *rest = *text + length;

		if (strncmp(*text, prefixes[i].prefix, length) == 0 &&
			(*rest == 'm' || strncmp(rest, "Hz", 2) == 0)) {
			*text = rest;
			return prefixes[i].factor;
		}
	}
	return 1;
}

/*
 * Takes "550,000000nm" or "545THz" from *text; the number may be missing, or too large
 * or long to be read, which gives 0. Returns 0 where the text is not of that form.
 */
static int
take_wavelength(const char **text, double *wavelength_nm)
{
	double value = 0, factor;
	const char *rest = *text + spec_number_length(*text, ',');

	if (**text == '+' || **text == '-')
		return 0;
	if (spec_number_scan(*text, ',', &value) == 0)
		value = 0; /* none, or one that no double holds */
	factor = take_prefix(&rest);
	if (strncmp(rest, "Hz", 2) == 0) {
		*wavelength_nm = value > 0 ? LIGHT_NM_PER_S / (value * factor) : 0;
		rest += 2;
	} else if (*rest == 'm') {
		/* 1e9 * 1e-9 is not 1: the usual unit must stay exact. */
		*wavelength_nm = factor == 1e-9 ? value : value * factor * 1e9;
		rest += 1;
	} else {
		return 0;
	}
	*text = rest;
	return 1;
}

static int
in_range(double wavelength_nm)
{
	return wavelength_nm >= SPEC_NAMES_SHORTEST_NM &&
	       wavelength_nm <= SPEC_NAMES_LONGEST_NM;
}

/* The layout: S0.<wavelength> … S3., T.<wavelength>, T.<in>.<out>. */
static enum spec_status
read_layout(struct spec_channel *channel, struct spec_error *error)
{
	const char *text = channel->name;
	double first, second = 0;
	int emissive = text[0] == 'S' && text[1] >= '0' && text[1] <= '3' && text[2] == '.';
	int two = 0;

	if (!emissive && strncmp(text, "T.", 2) != 0)
		return SPEC_OK;
	text += emissive ? 3 : 2;
	if (!take_wavelength(&text, &first))
		return SPEC_OK;
	if (!emissive && *text == '.') {
		text++;
		if (!take_wavelength(&text, &second))
			return SPEC_OK;
		two = 1;
	}
	if (*text != '\0')
		return SPEC_OK;
	if (!in_range(first) || (two && !in_range(second)))
		return spec_error_set(error, SPEC_EFORMAT,
			"channel '%s' has no wavelength between %g and %g nm",
			channel->name, SPEC_NAMES_SHORTEST_NM, SPEC_NAMES_LONGEST_NM);
	channel->naming = SPEC_NAMING_LAYOUT;
	channel->role = emissive                 ? SPEC_ROLE_EMISSIVE
			: two && second != first ? SPEC_ROLE_BISPECTRAL
						 : SPEC_ROLE_REFLECTIVE;
	channel->stokes = emissive ? channel->name[1] - '0' : 0;
	channel->wavelength_nm = first;
	channel->reradiated_nm = two ? second : first;
	return SPEC_OK;
}

/* Mitsuba 0.6 and older ART: "%.2f-%.2fnm", a band's edges. */
static int
read_edges(struct spec_channel *channel)
{
	const char *text = channel->name;
	double low, high;
	size_t length;

	if (!isdigit((unsigned char)*text))
		return 0;
	text += spec_number_scan(text, '.', &low);
	if (*text++ != '-')
		return 0;
	length = spec_number_scan(text, '.', &high);
	if (length == 0 || strcmp(text + length, "nm") != 0 || !in_range(low) ||
		!in_range(high) || high <= low)
		return 0;
	channel->naming = SPEC_NAMING_MITSUBA;
	channel->role = SPEC_ROLE_EMISSIVE;
	channel->low_nm = low;
	channel->high_nm = high;
	channel->wavelength_nm = (low + high) / 2;
	return 1;
}

static int
read_iset(struct spec_channel *channel)
{
	static const char prefix[] = "Radiance.C";
	const char *text = channel->name + sizeof prefix - 1;
	int number;

	if (strncmp(channel->name, prefix, sizeof prefix - 1) != 0 ||
		!isdigit((unsigned char)text[0]) || !isdigit((unsigned char)text[1]) ||
		text[2])
		return 0;
	number = (text[0] - '0') * 10 + text[1] - '0';
	if (number < 1 || number > ISET_BANDS)
		return 0;
	channel->naming = SPEC_NAMING_ISET3D;
	channel->role = SPEC_ROLE_EMISSIVE;
	channel->wavelength_nm = ISET_FIRST_NM + ISET_STEP_NM * (number - 1);
	return 1;
}

static int
read_kaist(struct spec_channel *channel)
{
	double wavelength_nm;
	size_t length;

	if (channel->name[0] != 'w' || !isdigit((unsigned char)channel->name[1]))
		return 0;
	length = spec_number_scan(channel->name + 1, '.', &wavelength_nm);
	if (strcmp(channel->name + 1 + length, "nm") != 0 || !in_range(wavelength_nm))
		return 0;
	channel->naming = SPEC_NAMING_KAIST;
	channel->role = SPEC_ROLE_REFLECTIVE;
	channel->wavelength_nm = wavelength_nm;
	return 1;
}

enum spec_status
spec_names_read(struct spec_channel *channel, struct spec_error *error)
{
	enum spec_status status;

	channel->role = SPEC_ROLE_OTHER;
	channel->naming = SPEC_NAMING_NONE;
	status = read_layout(channel, error);
	if (status != SPEC_OK || channel->role != SPEC_ROLE_OTHER)
		return status;
	if (!read_edges(channel) && !read_iset(channel))
		read_kaist(channel);
	return SPEC_OK;
}

static void
write_wavelength(char *text, size_t size, double wavelength_nm)
{
	char *point;

	snprintf(text, size, "%.6fnm", wavelength_nm);
	point = strchr(text, '.');
	if (point)
		*point = ',';
}

void
spec_names_write(char *text, size_t size, enum spec_role role, int stokes,
	double wavelength_nm, double reradiated_nm)
{
	char first[32], second[32];

	write_wavelength(first, sizeof first, wavelength_nm);
	write_wavelength(second, sizeof second, reradiated_nm);
	if (role == SPEC_ROLE_EMISSIVE)
		snprintf(text, size, "S%d.%s", stokes, first);
	else if (role == SPEC_ROLE_BISPECTRAL)
		snprintf(text, size, "T.%s.%s", first, second);
	else
		snprintf(text, size, "T.%s", first);
}
