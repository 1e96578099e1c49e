#include "colour/difference.h"

#include <math.h>

#include "colour/differing.h"

static double
lab_root(double ratio)
{
	return ratio > LAB_EPSILON ? cbrt(ratio) : (LAB_KAPPA * ratio + 16) / 116;
}

void
spec_lab_from_xyz(const double xyz[3], const double white[3], double lab[3])
{
	double x = lab_root(xyz[0] / white[0]);
	double y = lab_root(xyz[1] / white[1]);
	double z = lab_root(xyz[2] / white[2]);

	lab[0] = 116 * y - 16;
	lab[1] = 500 * (x - y);
	lab[2] = 200 * (y - z);
}

double
spec_difference_ab76(const double lab1[3], const double lab2[3])
{
	double l = lab1[0] - lab2[0], a = lab1[1] - lab2[1], b = lab1[2] - lab2[2];

	return sqrt(l * l + a * a + b * b);
}

double
spec_difference_cie94(const double lab1[3], const double lab2[3])
{
	double c1 = hypot(lab1[1], lab1[2]), c2 = hypot(lab2[1], lab2[2]);
	double l = lab1[0] - lab2[0], a = lab1[1] - lab2[1], b = lab1[2] - lab2[2];
	double c = (c1 - c2) / (1 + .045 * c1);
	/* dH*^2 = da*^2 + db*^2 - dC*^2, which rounding takes below 0. */
	double h = sqrt(fmax(a * a + b * b - (c1 - c2) * (c1 - c2), 0)) / (1 + .015 * c1);

	return sqrt(l * l + c * c + h * h);
}

/* Hue angle [rad] in [0, 2 pi), 0 for grey. */
static double
hue_angle(double b, double a)
{
	double h = atan2(b, a);

	if (a == 0 && b == 0)
		return 0;
	return h < 0 ? h + 360 * DEGREE : h;
}

/* The hue difference h2 - h1 [rad] the short way round; 0 beside a grey. */
static double
hue_step(double h1, double h2, int grey)
{
	double h = h2 - h1;

	if (grey)
		return 0;
	if (h > 180 * DEGREE)
		return h - 360 * DEGREE;
	return h < -180 * DEGREE ? h + 360 * DEGREE : h;
}

/* The mean hue [rad] on the short arc; beside a grey the sum, as Sharma et al. say. */
static double
hue_mean(double h1, double h2, int grey)
{
	double sum = h1 + h2;

	if (grey)
		return sum;
	if (fabs(h1 - h2) <= 180 * DEGREE)
		return sum / 2;
	return sum < 360 * DEGREE ? (sum + 360 * DEGREE) / 2 : (sum - 360 * DEGREE) / 2;
}

/*
 * The last step of CIEDE2000: the differences in lightness, chroma and hue, each over
 * its weight, and the rotation term of the blue region.
 * Given: l, c, h  mean lightness, mean chroma, mean hue [rad]
 */
static double
weighted_difference(double l, double c, double h, double dl, double dc, double dh)
{
	double t = 1 - .17 * cos(h - 30 * DEGREE) + .24 * cos(2 * h) +
		   .32 * cos(3 * h + 6 * DEGREE) - .20 * cos(4 * h - 63 * DEGREE);
	double from_blue = (h / DEGREE - 275) / 25;
	double angle = 30 * DEGREE * exp(-from_blue * from_blue);
	double c7 = seventh_power(c);
	double rotation = -sin(2 * angle) * 2 * sqrt(c7 / (c7 + CHROMA7));
	double l2 = (l - 50) * (l - 50);
	double nl = dl / (1 + .015 * l2 / sqrt(20 + l2));
	double nc = dc / (1 + .045 * c);
	double nh = dh / (1 + .015 * c * t);
	double square = nl * nl + nc * nc + nh * nh + rotation * nc * nh;

	/* Rounding may leave a tiny negative square; a NaN must stay one. */
	return square < 0 ? 0 : sqrt(square);
}

double
spec_difference_ciede2000(const double lab1[3], const double lab2[3])
{
	double c7 = seventh_power(.5 * (hypot(lab1[1], lab1[2]) + hypot(lab2[1], lab2[2])));
	double g = 1 + .5 * (1 - sqrt(c7 / (c7 + CHROMA7)));
	double a1 = g * lab1[1], b1 = lab1[2], a2 = g * lab2[1], b2 = lab2[2];
	double c1 = hypot(a1, b1), c2 = hypot(a2, b2);
	double h1 = hue_angle(b1, a1), h2 = hue_angle(b2, a2);
	int grey = c1 == 0 || c2 == 0;
	double dh = 2 * sqrt(c1 * c2) * sin(.5 * hue_step(h1, h2, grey));

	return weighted_difference(.5 * (lab1[0] + lab2[0]), .5 * (c1 + c2),
		hue_mean(h1, h2, grey), lab2[0] - lab1[0], c2 - c1, dh);
}
