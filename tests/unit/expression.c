/* Expressions: what they are worth, and where the caret stands under what is none. */
#include <stdio.h>
#include <stdlib.h>

#include "compare/expression.h"
#include "compare/program.h"
#include "spectrum/planck.h"

#include "check.h"

/* Wider than two runs of the program, and of no multiple of its lanes. */
enum { IMAGES = 3, BANDS = 4, WIDTH = 523, HEIGHT = 9, ROW = 5, BAND = 2 };

static const double wavelengths[BANDS] = {400, 500, 600, 700};

/* Each image has four bands, then the channels A, id (whole numbers) and N.X. */
static struct spec_image image[IMAGES];
static float sample[IMAGES][BANDS + 3][WIDTH];

static size_t given = IMAGES; /* that an expression may name */

static double
value_of(size_t number, size_t channel, size_t x)
{
	double value = 0.25 * (double)(channel + 1) + 0.001 * (double)x - (double)number;

	return channel < BANDS + 1 ? value : value - 3;
}

static int
make_images(void **state)
{
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < IMAGES; i++) {
		image[i].data = image[i].display =
			(struct spec_window){0, 0, WIDTH, HEIGHT};
		if (spec_image_add_bands(&image[i], SPEC_ROLE_EMISSIVE, 1, wavelengths,
			    BANDS, SPEC_SAMPLE_FLOAT, &error) != SPEC_OK ||
			spec_image_add_channel(&image[i], "A", SPEC_SAMPLE_FLOAT, &error) !=
				SPEC_OK ||
			spec_image_add_channel(&image[i], "id", SPEC_SAMPLE_UINT, &error) !=
				SPEC_OK ||
			spec_image_add_channel(&image[i], "N.X \"\\", SPEC_SAMPLE_FLOAT,
				&error) != SPEC_OK ||
			spec_image_index(&image[i], "an image", &error) != SPEC_OK)
			return -1;
	}
	return 0;
}

static int
clear_images(void **state)
{
	(void)state;
	for (size_t i = 0; i < IMAGES; i++)
		spec_image_clear(&image[i]);
	return 0;
}

/* The samples of a channel, by its place in the image; their order there is that of names. */
static const float *
row_of(size_t number, size_t channel)
{
	const struct spec_channel *it = &image[number].channel[channel];
	float *row = sample[number][channel];

	for (size_t x = 0; x < WIDTH; x++) {
		uint32_t whole = (uint32_t)x + 100;

		if (it->sample == SPEC_SAMPLE_UINT)
			memcpy(&row[x], &whole, sizeof whole);
		else if (strcmp(it->name, "A") == 0)
			row[x] = (float)value_of(number, BANDS, x);
		else if (it->role == SPEC_ROLE_OTHER)
			row[x] = (float)value_of(number, BANDS + 1, x);
		else
			row[x] = (float)value_of(
				number, (size_t)((it->wavelength_nm - 400) / 100), x);
	}
	return row;
}

static enum spec_status
make_program(struct spec_program *program, const char *text, struct spec_error *error)
{
	static const char *const names[IMAGES] = {"one.exr", "two.exr", "three.exr"};
	const struct spec_image *images[IMAGES];
	size_t channel[IMAGES];
	struct spec_program_place place = {.image = images,
		.name = names,
		.channel = channel,
		.wavelength_nm = wavelengths[BAND],
		.bands = BANDS,
		.width = WIDTH,
		.height = HEIGHT};
	struct spec_expression expression;
	enum spec_status status = spec_expression_parse(text, given, &expression, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < IMAGES; i++) {
		images[i] = &image[i];
		channel[i] = spec_program_band(&image[i], BAND, 0);
	}
	status = spec_program_make(program, &expression, &place, error);
	spec_expression_free(&expression);
	return status;
}

/* The whole row of values that an expression has. */
static void
run(const char *text, float *to)
{
	struct spec_error error = {0};
	struct spec_program program;
	const float *row[IMAGES * (BANDS + 3)];
	void *scratch;

	if (make_program(&program, text, &error) != SPEC_OK)
		fail_msg("%s: %s\n%s", text, error.message, error.place);
	assert_true(program.rows <= COUNT(row));
	for (size_t i = 0; i < program.rows; i++) {
		row[i] = row_of(program.row[i].image, program.row[i].channel);
		assert_int_equal(program.row[i].whole,
			image[program.row[i].image]
					.channel[program.row[i].channel]
					.sample == SPEC_SAMPLE_UINT);
	}
	scratch = aligned_alloc(64, spec_program_scratch(&program));
	assert_non_null(scratch);
	spec_program_run(&program, row, WIDTH, ROW, scratch, to);
	free(scratch);
	spec_program_free(&program);
}

/* sin and the like are good to 4 units of double precision: one of float. */
static void
compare(const char *text, size_t x, float got, double wanted)
{
	if (!(got == (float)wanted || fabs(got - wanted) <= 6e-8 * fabs(wanted) ||
		    (isnan(got) && isnan(wanted))))
		fail_msg("%s at %zu: got %.9g, wanted %.9g", text, x, got, wanted);
}

/* The expression has that value in all pixels, where a, b, c are the images' in the band. */
#define IS(text, value)                                                                    \
	do {                                                                               \
		static float got[WIDTH];                                                   \
		run(text, got);                                                            \
		for (size_t at = 0; at < WIDTH; at++) {                                    \
			double a = (float)value_of(0, BAND, at);                           \
			double b = (float)value_of(1, BAND, at);                           \
			double c = (float)value_of(2, BAND, at), x = (double)at;           \
                                                                                           \
			(void)a, (void)b, (void)c, (void)x;                                \
			compare(text, at, got[at], value);                                 \
		}                                                                          \
	} while (0)

static void
test_operators(void **state)
{
	(void)state;
	IS("a", a);
	IS("a + b", a + b);
	IS("a-b", a - b);
	IS("a * b", a * b);
	IS("a / b", a / b);
	IS("a - b - c", a - b - c);
	IS("a / b / c", a / b / c);
	IS("a + b * c", a + b * c);
	IS("(a + b) * c", (a + b) * c);
	IS("-a", -a);
	IS("+a", a);
	IS("--a", a);
	IS("a - -b", a + b);
	IS("2 ^ 3 ^ 2", 512);
	IS("-2 ^ 2", -4);
	IS("2 ^ -1", 0.5);
	IS("a ^ 2", a * a);
	IS("b ^ 3", b * b * b);
	IS("a * b ^ 2", a * b * b);
	IS("a ^ 2.5", pow(a, 2.5));
	IS("!a", 0);
	IS("!(a - a)", 1);
	IS(" 1e-3\t*\n.5 ", 5e-4);
	IS("a*a + a*a - a", 2 * a * a - a);
}

static void
test_comparisons(void **state)
{
	(void)state;
	IS("a < 1", a < 1);
	IS("a <= x / 1000 + 0.75", (float)a <= x / 1000 + 0.75);
	IS("a > 1", a > 1);
	IS("a >= 1", a >= 1);
	IS("a == a", 1);
	IS("a != a", 0);
	IS("a > 0.8 && b < 0.1", a > 0.8 && b < 0.1);
	IS("a < 0.8 || b > 0.1", a < 0.8 || b > 0.1);
	IS("a < 0.8 || a > 0.9 && a < 1", a < 0.8 || (a > 0.9 && a < 1));
	IS("a > 1 ? b : c", a > 1 ? b : c);
	IS("a > 1 ? b : a > 0.9 ? c : 7", a > 1 ? b : a > 0.9 ? c : 7);
	IS("if(a - a, b, c)", c);
	IS("a > 1 ? a < 1.1 ? 1 : 2 : 3", a > 1 ? (a < 1.1 ? 1 : 2) : 3);
	/* What is decided for the whole band leaves the other branch alone. */
	IS("nm < 500 ? a(900) : b", b);
	IS("nm > 500 ? b + 0*(nm < 500 ? a(900) : 1) : a(900)", b);
}

static void
test_functions(void **state)
{
	double planck, nm = wavelengths[BAND];

	(void)state;
	spec_planck_radiance(5000, &nm, 1, &planck);
	IS("abs(b)", fabs(b));
	IS("sqrt(a)", sqrt(a));
	IS("exp(b)", exp(b));
	IS("log(a)", log(a));
	IS("sin(a)", sin(a));
	IS("cos(a)", cos(a));
	IS("sin(1e6 * a)", sin(1e6 * a));
	IS("floor(b * 10)", floor(b * 10));
	IS("ceil(b * 10)", ceil(b * 10));
	IS("min(a, 1)", fmin(a, 1));
	IS("max(a, 1)", fmax(a, 1));
	IS("min(a, 1, b, 0)", fmin(fmin(a, 1), fmin(b, 0)));
	IS("max(c, b, a)", fmax(fmax(a, b), c));
	IS("pow(a, b)", pow(a, b));
	IS("step(1, a)", a < 1 ? 0 : 1);
	IS("step(a, 1)", 1 < a ? 0 : 1);
	IS("clamp(a, 0.8, 1)", fmin(fmax(a, 0.8), 1));
	IS("mix(a, b, 0.25)", 0.75 * a + 0.25 * b);
	IS("mix(a, b, c)", (1 - c) * a + c * b);
	IS("planck(5000)", planck);
	IS("planck(5000 + 0 * a)", planck);
	IS("planck(0)", 0);
	IS("pi", acos(-1));
}

static void
test_not_a_number(void **state)
{
	static const char *const spoilt[] = {"-n", "!n", "n + a", "a - n", "n * 0", "n / n",
		"n ^ 0", "1 ^ n", "n ^ 2", "abs(n)", "sqrt(n)", "exp(n)", "log(n)",
		"sin(n)", "cos(n)", "floor(n)", "ceil(n)", "min(n, a)", "min(a, n)",
		"max(n, a)", "max(a, n)", "pow(n, 0)", "step(n, a)", "step(a, n)",
		"clamp(n, 0, 1)", "clamp(a, n, 9)", "clamp(a, 0, n)", "mix(n, a, 0.5)",
		"mix(a, n, 0.5)", "mix(a, b, n)", "n ? a : b", "n && a", "0 && n", "n || 1",
		"planck(n)", "planck(-1)", "planck(1 / 0)", "sqrt(-a)", "log(-a)", "0 / 0"};
	char text[64];

	(void)state;
	for (size_t i = 0; i < COUNT(spoilt); i++) {
		snprintf(text, sizeof text, "n = log(-a); %s", spoilt[i]);
		IS(text, NAN);
		/* And where it is known beforehand. */
		snprintf(text, sizeof text, "n = log(-1); %s", spoilt[i]);
		IS(text, NAN);
	}
	IS("isnan(log(-a))", 1);
	IS("isnan(a)", 0);
	IS("n = log(-a); isnan(n) ? 0 : n", 0);
	IS("n = log(-a); (n < 1) + (n > 1) + (n <= 1) + (n >= 1) + (n == n)", 0);
	IS("n = log(-a); n != n", 1);
	/* What is mixed in by nothing is not there. */
	IS("mix(a, log(-a), 0)", a);
	IS("mix(log(-a), a, 1)", a);
	IS("n = log(-a); mix(a, n, a - a)", a);
	IS("1 / (a - a)", INFINITY);
	IS("-1 / 0", -INFINITY);
	IS("log(0)", -INFINITY);
	IS("1e300 * a", INFINITY); /* as a float */
}

static void
test_names(void **state)
{
	(void)state;
	IS("image1 + image3", a + c);
	IS("x", x);
	IS("y", ROW);
	IS("x + y * width", x + ROW * WIDTH);
	IS("height", HEIGHT);
	IS("bands", BANDS);
	IS("nm", wavelengths[BAND]);
	IS("stokes", 0);
	IS("a.A", (float)value_of(0, BANDS, (size_t)x));
	IS("b.(\"A\")", (float)value_of(1, BANDS, (size_t)x));
	IS("b.(\"N.X \\\"\\\\\")", (float)value_of(1, BANDS + 1, (size_t)x));
	IS("a.id", x + 100);
	IS("a.id == 103 ? 1 : 0", x == 3);
	IS("a.(\"S0.400,000000nm\")", (float)value_of(0, 0, (size_t)x));
	IS("d = a - b; d * d", (a - b) * (a - b));
	IS("r = a; r = r + b; r = r * c; r;", (a + b) * c);
	IS("w = nm / 2; w + w", wavelengths[BAND]);
	IS("u = a; v = b; v - u", b - a);
	IS("image9 = a; image9", a); /* it is not there: a name like another */
}

static void
test_wavelengths(void **state)
{
	double part = (530 - 500) / 100.0;

	(void)state;
	IS("a(400)", (float)value_of(0, 0, (size_t)x));
	IS("b(700nm)", (float)value_of(1, 3, (size_t)x));
	IS("b(0.7um)", (float)value_of(1, 3, (size_t)x));
	IS("a(nm)", a);
	IS("a(nm + 100) - a(nm - 100)", (float)value_of(0, 3, (size_t)x) -
						(double)(float)value_of(0, 1, (size_t)x));
	IS("a(530)", (1 - part) * (float)value_of(0, 1, (size_t)x) +
			     part * (float)value_of(0, 2, (size_t)x));
	IS("a(min(nm * 2, 700))", (float)value_of(0, 3, (size_t)x));
	IS("a(nm > 500 ? 400 : nm)", (float)value_of(0, 0, (size_t)x));
	IS("a(500.0009)", (float)value_of(0, 1, (size_t)x));
}

/* The expression is refused: its message has that part, its caret stands at that byte. */
static void
refused(const char *text, const char *part, size_t at)
{
	struct spec_error error = {0};
	struct spec_program program;
	char want[256];

	if (make_program(&program, text, &error) == SPEC_OK)
		fail_msg("'%s' is taken", text);
	if (!strstr(error.message, part))
		fail_msg("%s: '%s' is not in '%s'", text, part, error.message);
	snprintf(want, sizeof want, "  %s\n  %*s^", text, (int)at, "");
	if (strlen(text) < 40 && strcmp(error.place, want) != 0)
		fail_msg("got\n%s\nwanted\n%s", error.place, want);
}

static void
test_errors(void **state)
{
	(void)state;
	refused("", "expected a value, but the expression ends", 0);
	refused("a +", "expected a value, but the expression ends", 3);
	refused("a b", "expected an operator or the end, not 'b'", 2);
	refused("a + * b", "expected a value, not '*'", 4);
	refused("(a + b", "a '(' without a ')'", 0);
	refused("a + b)", "not ')'", 5);
	refused("a ? b", "expected ':'", 5);
	refused("a < b < c", "do not follow one another", 6);
	refused("d", "no image 'd': 3 are given", 0);
	refused("1 + image4", "no image 'image4'", 4);
	refused("z + 1", "'z' is not known", 0);
	refused("sqr(a)", "did you mean 'sqrt'?", 0);
	refused("a + widht", "did you mean 'width'?", 4);
	refused("sqrt a", "'(' after the function", 5);
	refused("sqrt(a, b)", "expected ')', not ','", 6);
	refused("clamp(a, 1)", "another operand", 10);
	refused("min(a)", "another operand", 5);
	refused("a.B", "one.exr has no channel 'B'", 0);
	refused("1 + b.(\"\xc3\xa4\")", "two.exr has no channel", 4);
	refused("a.", "the name of a channel, but", 2);
	refused("a.(\"A", "a '\"' without another", 3);
	refused("a.(A)", "the name of a channel", 2);
	refused("1 + a(390)", "390 nm is outside the bands of one.exr, 400..700 nm", 4);
	refused("a(nm + 101)", "outside the bands", 0);
	refused("a(0 / 0)", "outside the bands", 0);
	refused("a(b)", "the same in all pixels", 0);
	refused("a(x)", "the same in all pixels", 0);
	refused("a(500cm)", "expected an operator, not 'cm'", 5);
	refused("3a", "expected an operator, not 'a'", 1);
	refused("1..2", "expected an operator or the end", 2);
	refused("1e999", "expected a number", 0);
	refused("a = 1; a", "'a' is an image", 0);
	refused("x = 1; x", "'x' has a meaning already", 0);
	refused("sin = 1; sin", "'sin' has a meaning already", 0);
	refused("t = 1", "expected an operator or ';', but", 5);
	refused("t = 1;", "expected a value, but", 6);
	refused("\xc3\xa4 + 1", "not '\xc3\xa4'", 0);
	refused("a & b", "not '&'", 2);
	refused("a; b", "not 'b'", 3);
}

/* Depth and size have ends, and up to them all is well. */
static void
test_limits(void **state)
{
	enum { MOST = SPEC_EXPRESSION_MOST_NODES };
	static char text[16 * MOST];

	(void)state;
	memset(text, '(', SPEC_EXPRESSION_DEEPEST - 1);
	strcpy(text + SPEC_EXPRESSION_DEEPEST - 1, "b");
	memset(text + SPEC_EXPRESSION_DEEPEST, ')', SPEC_EXPRESSION_DEEPEST - 1);
	text[2 * SPEC_EXPRESSION_DEEPEST - 1] = '\0';
	IS(text, b);
	memset(text, '(', sizeof text - 1);
	refused(text, "more than 100 parts lie in each other", 0);
	memset(text, '-', sizeof text - 1);
	refused(text, "lie in each other", 0);
	for (size_t i = 0; i < MOST; i++)
		memcpy(text + 4 * i, "a?a:", 5);
	refused(text, "lie in each other", 0);
	strcpy(text, "b*0");
	for (size_t i = 0; i < (MOST - 3) / 2; i++)
		strcat(text, "+x*1"); /* two calls and a number: too many */
	refused(text, "more than 4096 parts", 0);
	strcpy(text, "b");
	for (size_t i = 0; i < MOST - 2; i++)
		strcat(text, "-a");
	IS(text, b - (MOST - 2) * a);
}

/* Of one image alone a band has a short name. */
static void
test_bands(void **state)
{
	double part = (530.5 - 500) / 100;

	(void)state;
	given = 1;
	IS("b400", (float)value_of(0, 0, (size_t)x));
	IS("(b700-b500)/(b700+b500)",
		((float)value_of(0, 3, (size_t)x) -
			(double)(float)value_of(0, 1, (size_t)x)) /
			((float)value_of(0, 3, (size_t)x) +
				(double)(float)value_of(0, 1, (size_t)x)));
	IS("b530.5 ", (1 - part) * (float)value_of(0, 1, (size_t)x) +
			      part * (float)value_of(0, 2, (size_t)x));
	IS("b7 = 3; b7 * b7", 9);
	refused("b400 + b900", "900 nm is outside the bands of one.exr, 400..700 nm", 7);
	refused("b + 1", "there is no image 'b': 1 is given", 0);
	refused("1 + b4x", "'b4x' is not known", 4);
	refused("b400 b500", "expected an operator or the end", 5);
	given = IMAGES;
	refused("a + b400", "'b400' is not known", 4);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_operators),
		cmocka_unit_test(test_comparisons),
		cmocka_unit_test(test_functions),
		cmocka_unit_test(test_not_a_number),
		cmocka_unit_test(test_names),
		cmocka_unit_test(test_wavelengths),
		cmocka_unit_test(test_errors),
		cmocka_unit_test(test_limits),
		cmocka_unit_test(test_bands),
	};

	return cmocka_run_group_tests(tests, make_images, clear_images);
}
