#include "colour/colourmap.h"

#include <math.h>
#include <string.h>

#include "colour/transfer.h"

#define STEPS 51

/* Of OKLab's circle: within sRGB at every hue. */
#define HUE_LIGHTNESS .75
#define HUE_CHROMA .12
#define HUE_FIRST_DEG 20 /* red */

static const double viridis[STEPS + 1][3] = {
	{.267004, .004874, .329415},
	{.273809, .031497, .358853},
	{.278791, .062145, .386592},
	{.281924, .089666, .412415},
	{.283197, .115680, .436115},
	{.282623, .140926, .457517},
	{.280255, .165693, .476498},
	{.276194, .190074, .493001},
	{.270595, .214069, .507052},
	{.263663, .237631, .518762},
	{.255645, .260703, .528312},
	{.246811, .283237, .535941},
	{.237441, .305202, .541921},
	{.227802, .326594, .546532},
	{.218130, .347432, .550038},
	{.208623, .367752, .552675},
	{.199430, .387607, .554642},
	{.190631, .407061, .556089},
	{.182256, .426184, .557120},
	{.174274, .445044, .557792},
	{.166617, .463708, .558119},
	{.159194, .482237, .558073},
	{.151918, .500685, .557587},
	{.144759, .519093, .556572},
	{.137770, .537492, .554906},
	{.131172, .555899, .552459},
	{.125394, .574318, .549086},
	{.121148, .592739, .544641},
	{.119423, .611141, .538982},
	{.121380, .629492, .531973},
	{.128087, .647749, .523491},
	{.140210, .665859, .513427},
	{.157851, .683765, .501686},
	{.180653, .701402, .488189},
	{.208030, .718701, .472873},
	{.239374, .735588, .455688},
	{.274149, .751988, .436601},
	{.311925, .767822, .415586},
	{.352360, .783011, .392636},
	{.395174, .797475, .367757},
	{.440137, .811138, .340967},
	{.487026, .823929, .312321},
	{.535621, .835785, .281908},
	{.585678, .846661, .249897},
	{.636902, .856542, .216620},
	{.688944, .865448, .182725},
	{.741388, .873449, .149561},
	{.793760, .880678, .120005},
	{.845561, .887322, .099702},
	{.896320, .893616, .096335},
	{.945636, .899815, .112838},
	{.993248, .906157, .143936},
};

void
spec_colourmap_viridis(double share, unsigned char rgb[3])
{
	double at = fmin(fmax(share, 0), 1) * STEPS; /* of NaN 0 */
	int step = at < STEPS ? (int)at : STEPS - 1;

	for (int c = 0; c < 3; c++) {
		double low = viridis[step][c], high = viridis[step + 1][c];

		rgb[c] = (unsigned char)lround(255 * (low + (at - step) * (high - low)));
	}
}

/* One component of light, 0 to 1, as a code. */
static unsigned char
code_of(double linear)
{
	return (unsigned char)lround(255 * spec_srgb_encode(fmin(fmax(linear, 0), 1)));
}

/* The inverse of CIELAB's f (CIE 15:2018). */
static double
lab_inverse(double f)
{
	return f > 6. / 29 ? f * f * f : 3 * (6. / 29) * (6. / 29) * (f - 4. / 29);
}

void
spec_colourmap_grey(double share, unsigned char rgb[3])
{
	double lightness = 100 * fmin(fmax(share, 0), 1);

	memset(rgb, code_of(lab_inverse((lightness + 16) / 116)), 3);
}

/*
 * Moreland's polar form of CIELAB: distance from black, angle from the grey axis, hue [rad].
 * The ends are (59, 76, 192) and (180, 4, 38) in it.
 */
struct polar {
	double m, s, h;
};

static const struct polar cool = {79.9887, 1.08043, -1.09843},
			  warm = {80.0875, 1.08044, .50245};

#define WHITE_M 88. /* the least that his neutral middle has */

static void
polar_to_rgb(const struct polar *at, unsigned char rgb[3])
{
	/* sRGB's white and matrix as IEC 61966-2-1:1999 prints them */
	static const double white[3] = {.9505, 1, 1.0890};
	double a = at->m * sin(at->s) * cos(at->h), b = at->m * sin(at->s) * sin(at->h);
	double f = (at->m * cos(at->s) + 16) / 116;
	double x = white[0] * lab_inverse(f + a / 500), y = white[1] * lab_inverse(f);
	double z = white[2] * lab_inverse(f - b / 200);

	rgb[0] = code_of(3.2406 * x - 1.5372 * y - .4986 * z);
	rgb[1] = code_of(-.9689 * x + 1.8758 * y + .0415 * z);
	rgb[2] = code_of(.0557 * x - .2040 * y + 1.0570 * z);
}

void
spec_colourmap_cool_warm(double share, unsigned char rgb[3])
{
	double at = fmin(fmax(share, 0), 1);
	const struct polar *end = at < .5 ? &cool : &warm;
	double part = fabs(2 * at - 1); /* 0 in the middle, 1 at the end */
	/* A grey has no hue: it takes the one from which the end is reached straight. */
	double turn =
		end->s * sqrt(WHITE_M * WHITE_M - end->m * end->m) / (end->m * sin(end->s));
	double hue = end->h > -M_PI / 3 ? end->h + turn : end->h - turn;
	struct polar here = {WHITE_M + part * (end->m - WHITE_M), part * end->s,
		hue + part * (end->h - hue)};

	polar_to_rgb(&here, rgb);
}

void
spec_colourmap_hue(double share, unsigned char rgb[3])
{
	double angle = 2 * M_PI * fmin(fmax(share, 0), 1) + HUE_FIRST_DEG * M_PI / 180;
	double a = HUE_CHROMA * cos(angle), b = HUE_CHROMA * sin(angle);
	/* Ottosson's matrices: from OKLab to the roots of the cones' responses, to sRGB. */
	double l = HUE_LIGHTNESS + .3963377774 * a + .2158037573 * b;
	double m = HUE_LIGHTNESS - .1055613458 * a - .0638541728 * b;
	double s = HUE_LIGHTNESS - .0894841775 * a - 1.2914855480 * b;

	l = l * l * l;
	m = m * m * m;
	s = s * s * s;
	rgb[0] = code_of(4.0767416621 * l - 3.3077115913 * m + .2309699292 * s);
	rgb[1] = code_of(-1.2684380046 * l + 2.6097574011 * m - .3413193965 * s);
	rgb[2] = code_of(-.0041960863 * l - .7034186147 * m + 1.7076147010 * s);
}

static const struct spec_colourmap maps[] = {
	{"viridis", spec_colourmap_viridis},
	{"grey", spec_colourmap_grey},
	{"cool-warm", spec_colourmap_cool_warm},
	{"hue", spec_colourmap_hue},
};

const struct spec_colourmap *
spec_colourmap_find(const char *name, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
		if (strcmp(maps[i].name, name) == 0)
			return &maps[i];
	}
	spec_error_set(error, SPEC_EUSAGE,
		"unknown colour map '%s': expected viridis, grey, cool-warm or hue", name);
	return NULL;
}

void
spec_colourmap_paint(const struct spec_colourmap *map, double value, double low,
	double high, unsigned char rgb[3])
{
	static const unsigned char infinite[] = {255, 0, 255};

	if (isnan(value))
		memset(rgb, 128, 3);
	else if (isinf(value))
		memcpy(rgb, infinite, 3);
	else
		map->colour((value - low) / (high - low), rgb);
}
