#include "colour/space.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/number.h"

#define COUNT(list) (sizeof(list) / sizeof *(list))

/* The rounded chromaticity by which the television and display standards mean D65. */
#define VIDEO_D65 .3127, .3290

#define ACES_WHITE .32168, .33767 /* SMPTE ST 2065-1:2012 */

#define P3_PRIMARIES                                                                       \
	{.680, .320}, {.265, .690},                                                        \
	{                                                                                  \
		.150, .060                                                                 \
	}
#define SRGB_PRIMARIES                                                                     \
	{.640, .330}, {.300, .600},                                                        \
	{                                                                                  \
		.150, .060                                                                 \
	}

/* Amounts of X, Y and Z are amounts of these primaries. */
#define XYZ_PRIMARIES {1, 0}, {0, 1}, {0, 0}, {1. / 3, 1. / 3}, &spec_transfer_linear

static const struct spec_space spaces[] = {
	{"srgb", "sRGB", "IEC 61966-2-1:1999; primaries of ITU-R BT.709-6:2015",
		SRGB_PRIMARIES, {VIDEO_D65}, &spec_transfer_srgb, SPEC_COORDINATES_RGB, 1},
	{"p3", "Display P3", "primaries of SMPTE EG 432-1:2010, white D65, sRGB's transfer",
		P3_PRIMARIES, {VIDEO_D65}, &spec_transfer_srgb, SPEC_COORDINATES_RGB, 12},
	{"dci-p3", "DCI-P3", "SMPTE RP 431-2:2011", P3_PRIMARIES, {.314, .351},
		&spec_transfer_dci, SPEC_COORDINATES_RGB, 11},
	{"rec709", "ITU-R BT.709", "ITU-R BT.709-6:2015", SRGB_PRIMARIES, {VIDEO_D65},
		&spec_transfer_rec709, SPEC_COORDINATES_RGB, 1},
	{"rec2020", "ITU-R BT.2020", "ITU-R BT.2020-2:2015", {.708, .292}, {.170, .797},
		{.131, .046}, {VIDEO_D65}, &spec_transfer_rec2020, SPEC_COORDINATES_RGB, 9},
	{"aces", "ACES2065-1", "SMPTE ST 2065-1:2012", {.73470, .26530}, {.00000, 1.00000},
		{.00010, -.07700}, {ACES_WHITE}, &spec_transfer_linear,
		SPEC_COORDINATES_RGB, 0},
	{"acescg", "ACEScg", "Academy S-2014-004, 2016", {.713, .293}, {.165, .830},
		{.128, .044}, {ACES_WHITE}, &spec_transfer_linear, SPEC_COORDINATES_RGB, 0},
	{"adobe", "Adobe RGB (1998)", "Adobe RGB (1998) Color Image Encoding, 2005-05",
		{.6400, .3300}, {.2100, .7100}, {.1500, .0600}, {VIDEO_D65},
		&spec_transfer_adobe, SPEC_COORDINATES_RGB, 0},
	{"xyz", "CIE XYZ", "CIE 015:2018", XYZ_PRIMARIES, SPEC_COORDINATES_XYZ, 10},
	{"lab", "CIE L*a*b*", "CIE 015:2018", XYZ_PRIMARIES, SPEC_COORDINATES_LAB, 0},
	{"xyy", "CIE xyY", "CIE 015:2018", XYZ_PRIMARIES, SPEC_COORDINATES_XYY, 0},
};

/* CIE 15:2004, table T.3: 2 degree observer. E is exact. */
static const struct spec_white whites[] = {
	{"A", {.44758, .40745}, "CIE 15:2004"},
	{"D50", {.34567, .35851}, "CIE 15:2004"},
	{"D55", {.33243, .34744}, "CIE 15:2004"},
	{"D65", {.31272, .32903}, "CIE 15:2004"},
	{"D75", {.29903, .31488}, "CIE 15:2004"},
	{"E", {1. / 3, 1. / 3}, "equal energy, by definition"},
};

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* Lam 1985, as in ICC.1:2010 annex E: XYZ to sharpened cone responses. */
static const double bradford[9] = {
	.8951, .2664, -.1614, -.7502, 1.7135, .0367, .0389, -.0685, 1.0296};

/* Li, Li, Wang, Xu, Luo, Cui, Melgosa, Brill, Pointer 2017: the matrix M16 of CAM16. */
static const double cat16[9] = {.401288, .650173, -.051461, -.250268, 1.204414, .045854,
	-.002079, .048952, .953127};

/* CIE 159:2004: the matrix of CIECAM02. */
static const double cat02[9] = {
	.7328, .4296, -.1624, -.7036, 1.6975, .0061, .0030, .0136, .9834};

/* Hunt, Pointer, Estevez, normalised to D65: Fairchild 2013, equation 9.1 (RLAB's M). */
static const double hunt[9] = {
	.40024, .70760, -.08081, -.22630, 1.16532, .04570, 0, 0, .91822};

/* By the order of enum spec_adaptation. */
static const struct {
	const char *name;
	const double *channels;
} adaptations[] = {{"none", identity}, {"bradford", bradford}, {"cat16", cat16},
	{"vonkries", hunt}, {"cat02", cat02}};

const struct spec_space *
spec_space_at(size_t index)
{
	return index < COUNT(spaces) ? &spaces[index] : NULL;
}

const struct spec_white *
spec_white_at(size_t index)
{
	return index < COUNT(whites) ? &whites[index] : NULL;
}

const struct spec_space *
spec_space_find(const char *name, struct spec_error *error)
{
	size_t i;

	for (i = 0; i < COUNT(spaces); i++)
		if (strcasecmp(spaces[i].name, name) == 0)
			return &spaces[i];
	spec_error_set(error, SPEC_EUSAGE,
		"unknown colour space '%.100s': expected srgb, p3, dci-p3, rec709, rec2020, "
		"aces, acescg, adobe, xyz, lab, xyy or 'xr,yr xg,yg xb,yb xw,yw'",
		name);
	return NULL;
}

const struct spec_white *
spec_white_find(const char *name, struct spec_error *error)
{
	size_t i;

	for (i = 0; i < COUNT(whites); i++)
		if (strcmp(whites[i].name, name) == 0)
			return &whites[i];
	spec_error_set(error, SPEC_EUSAGE,
		"unknown white '%s': expected A, D50, D55, D65, D75 or E", name);
	return NULL;
}

/* "x,y", then blanks; text moves behind them. */
static enum spec_status
take_chromaticity(const char **text, double xy[2], struct spec_error *error)
{
	char number[64];

	for (int i = 0; i < 2; i++) {
		size_t length = strcspn(*text, i == 0 ? "," : " ");

		if (length == 0 || length >= sizeof number)
			return SPEC_EUSAGE;
		memcpy(number, *text, length);
		number[length] = 0;
		if (spec_number_parse(number, -10, 10, "a chromaticity", &xy[i], error) !=
			SPEC_OK)
			return SPEC_EUSAGE;
		*text += length;
		if (i == 0 && *(*text)++ != ',')
			return SPEC_EUSAGE;
	}
	*text += strspn(*text, " ");
	return SPEC_OK;
}

enum spec_status
spec_space_parse(const char *text, struct spec_space *space, struct spec_error *error)
{
	const struct spec_space *known;
	struct spec_space custom = {.name = "custom",
		.title = "a custom RGB space",
		.source = "",
		.transfer = &spec_transfer_srgb};
	double *xy[4] = {custom.red_xy, custom.green_xy, custom.blue_xy, custom.white_xy};
	double m[9];
	enum spec_status status = SPEC_OK;

	if (!strchr(text, ',')) {
		known = spec_space_find(text, error);
		if (!known)
			return SPEC_EUSAGE;
		*space = *known;
		return SPEC_OK;
	}
	for (int i = 0; i < 4 && status == SPEC_OK; i++)
		status = take_chromaticity(&text, xy[i], NULL);
	if (status != SPEC_OK || *text != 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"a colour space is a name or 'xr,yr xg,yg xb,yb xw,yw'");
	if (!(custom.white_xy[1] > 0))
		return spec_error_set(
			error, SPEC_EUSAGE, "the white of a space needs y above 0");
	*space = custom;
	return spec_space_from_xyz(space, m, error) == SPEC_OK ? SPEC_OK : SPEC_EUSAGE;
}

void
spec_white_xyz(const double xy[2], double xyz[3])
{
	xyz[0] = xy[0] / xy[1];
	xyz[1] = 1;
	xyz[2] = (1 - xy[0] - xy[1]) / xy[1];
}

enum spec_status
spec_space_to_xyz(const struct spec_space *space, double m[9], struct spec_error *error)
{
	const double *primary[3] = {space->red_xy, space->green_xy, space->blue_xy};
	double column[9], inverse[9], white[3], amount[3];
	int i, r;

	for (i = 0; i < 3; i++) {
		column[i] = primary[i][0];
		column[3 + i] = primary[i][1];
		column[6 + i] = 1 - primary[i][0] - primary[i][1];
	}
	if (spec_matrix_invert(column, inverse, NULL) != SPEC_OK)
		return spec_error_set(error, SPEC_ERANGE,
			"the primaries of %s lie on one line", space->title);
	spec_white_xyz(space->white_xy, white);
	spec_matrix_apply(inverse, white, amount);
	if (!isfinite(amount[0] + amount[1] + amount[2]))
		return spec_error_set(error, SPEC_ERANGE,
			"the white of %s has no luminance", space->title);
	for (r = 0; r < 3; r++)
		for (i = 0; i < 3; i++)
			m[3 * r + i] = column[3 * r + i] * amount[i];
	return SPEC_OK;
}

enum spec_status
spec_space_from_xyz(const struct spec_space *space, double m[9], struct spec_error *error)
{
	enum spec_status status = spec_space_to_xyz(space, m, error);

	if (status == SPEC_OK && spec_matrix_invert(m, m, NULL) != SPEC_OK)
		status = spec_error_set(error, SPEC_ERANGE,
			"the white of %s lies on a line with two of its primaries",
			space->title);
	return status;
}

enum spec_status
spec_adaptation_find(
	const char *name, enum spec_adaptation *method, struct spec_error *error)
{
	for (size_t i = 0; i < COUNT(adaptations); i++) {
		if (strcmp(adaptations[i].name, name) == 0) {
			*method = (enum spec_adaptation)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"unknown adaptation '%s': expected none, vonkries, bradford, cat02 or cat16",
		name);
}

/* The three responses to a white of Y = 1. */
static enum spec_status
respond(const double channels[9], const double xyz[3], double response[3],
	struct spec_error *error)
{
	double white[3];
	int i;

	for (i = 0; i < 3; i++)
		white[i] = xyz[i] / xyz[1];
	spec_matrix_apply(channels, white, response);
	for (i = 0; i < 3; i++)
		if (!(xyz[1] > 0) || !isfinite(response[i]) || !(response[i] > 0))
			return spec_error_set(error, SPEC_ERANGE,
				"cannot adapt to or from the white XYZ %g %g %g", xyz[0],
				xyz[1], xyz[2]);
	return SPEC_OK;
}

enum spec_status
spec_adaptation_matrix(enum spec_adaptation method, const double from_xyz[3],
	const double to_xyz[3], double m[9], struct spec_error *error)
{
	const double *channels = adaptations[method].channels;
	double from[3], to[3], scaled[9], inverse[9];
	enum spec_status status;
	int c, r;

	memcpy(m, identity, sizeof identity);
	if (method == SPEC_ADAPTATION_NONE)
		return SPEC_OK;
	status = respond(channels, from_xyz, from, error);
	if (status == SPEC_OK)
		status = respond(channels, to_xyz, to, error);
	if (status == SPEC_OK)
		status = spec_matrix_invert(channels, inverse, error);
	if (status != SPEC_OK)
		return status;
	for (r = 0; r < 3; r++)
		for (c = 0; c < 3; c++)
			scaled[3 * r + c] = channels[3 * r + c] * (to[r] / from[r]);
	spec_matrix_multiply(inverse, scaled, m);
	return SPEC_OK;
}

void
spec_matrix_multiply(const double a[9], const double b[9], double out[9])
{
	double product[9];
	int c, r;

	for (r = 0; r < 3; r++)
		for (c = 0; c < 3; c++)
			product[3 * r + c] = a[3 * r] * b[c] + a[3 * r + 1] * b[3 + c] +
					     a[3 * r + 2] * b[6 + c];
	memcpy(out, product, sizeof product);
}

void
spec_matrix_apply(const double m[9], const double in[3], double out[3])
{
	double x = in[0], y = in[1], z = in[2];
	int r;

	for (r = 0; r < 3; r++)
		out[r] = m[3 * r] * x + m[3 * r + 1] * y + m[3 * r + 2] * z;
}

enum spec_status
spec_matrix_invert(const double m[9], double out[9], struct spec_error *error)
{
	double cofactor[9] = {m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8],
		m[1] * m[5] - m[2] * m[4], m[5] * m[6] - m[3] * m[8],
		m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
		m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7],
		m[0] * m[4] - m[1] * m[3]};
	double determinant = m[0] * cofactor[0] + m[1] * cofactor[3] + m[2] * cofactor[6];
	double size = fabs(m[0] * cofactor[0]) + fabs(m[1] * cofactor[3]) +
		      fabs(m[2] * cofactor[6]);
	int i;

	/* A determinant that is all cancellation is the rounding of a zero. */
	if (!isfinite(determinant) || !(fabs(determinant) > 1e-14 * size))
		return spec_error_set(error, SPEC_ERANGE, "a matrix without an inverse");
	for (i = 0; i < 9; i++)
		out[i] = cofactor[i] / determinant;
	return SPEC_OK;
}
