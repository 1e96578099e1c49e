#include "compare/function.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "spectrum/planck.h"

/* One loop for each function; what is no operand is not looked at. */
#define FUNCTION(name, value)                                                              \
	SPEC_VECTORISED static void name(double *restrict to, const double *a,             \
		const double *b, const double *c, size_t count)                            \
	{                                                                                  \
		(void)a;                                                                   \
		(void)b;                                                                   \
		(void)c;                                                                   \
		for (size_t i = 0; i < count / SPEC_FUNCTION_LANES * SPEC_FUNCTION_LANES;  \
			i++)                                                               \
			to[i] = (value);                                                   \
	}

#define IS_NAN(x) ((x) != (x))
#define TRUTH(x) ((x) ? 1.0 : 0.0)

FUNCTION(negate, -a[i])
FUNCTION(invert, IS_NAN(a[i]) ? a[i] : TRUTH(a[i] == 0))
FUNCTION(add, a[i] + b[i])
FUNCTION(subtract, a[i] - b[i])
FUNCTION(multiply, a[i] * b[i])
FUNCTION(divide, a[i] / b[i])
FUNCTION(less, TRUTH(a[i] < b[i]))
FUNCTION(at_most, TRUTH(a[i] <= b[i]))
FUNCTION(more, TRUTH(a[i] > b[i]))
FUNCTION(at_least, TRUTH(a[i] >= b[i]))
FUNCTION(equal, TRUTH(a[i] == b[i]))
FUNCTION(unequal, TRUTH(a[i] != b[i]))
FUNCTION(both, IS_NAN(a[i]) || IS_NAN(b[i]) ? NAN : TRUTH((a[i] != 0) & (b[i] != 0)))
FUNCTION(either, IS_NAN(a[i]) || IS_NAN(b[i]) ? NAN : TRUTH((a[i] != 0) | (b[i] != 0)))

FUNCTION(absolute, fabs(a[i]))
FUNCTION(square_root, sqrt(a[i]))
FUNCTION(exponential, spec_vector_exp(a[i]))
FUNCTION(logarithm, spec_vector_log(a[i]))
FUNCTION(sine, spec_vector_sin(a[i]))
FUNCTION(cosine, spec_vector_cos(a[i]))
FUNCTION(round_down, floor(a[i]))
FUNCTION(round_up, ceil(a[i]))
FUNCTION(is_nan, TRUTH(IS_NAN(a[i])))

/* fmin and fmax would drop a NaN. */
#define LEAST(x, y) ((x) < (y) || IS_NAN(x) ? (x) : (y))
#define MOST(x, y) ((x) > (y) || IS_NAN(x) ? (x) : (y))

FUNCTION(minimum, LEAST(a[i], b[i]))
FUNCTION(maximum, MOST(a[i], b[i]))
/* pow would make 1 of NaN to the power 0, and of 1 to that of NaN. */
FUNCTION(power, spec_vector_pow(a[i], b[i]) + 0 * (a[i] != a[i]          ? a[i]
							  : b[i] != b[i] ? b[i]
									 : 0))
FUNCTION(step, IS_NAN(a[i]) || IS_NAN(b[i]) ? NAN : TRUTH(!(b[i] < a[i])))
FUNCTION(clamp, IS_NAN(b[i]) || IS_NAN(c[i]) ? NAN : LEAST(MOST(a[i], b[i]), c[i]))
FUNCTION(mix, c[i] == 0 ? a[i] : c[i] == 1 ? b[i] : (1 - c[i]) * a[i] + c[i] * b[i])
FUNCTION(choose, IS_NAN(a[i]) ? a[i] : a[i] != 0 ? b[i] : c[i])

static void
planck(double *restrict to, const double *a, const double *b, const double *c, size_t count)
{
	(void)c;
	for (size_t i = 0; i < count; i++) {
		to[i] = NAN;
		if (b[i] >= 0 && isfinite(b[i]))
			spec_planck_radiance(b[i], &a[i], 1, &to[i]);
	}
}

const struct spec_function spec_functions[] = {
	{"-", 1, 0, 1, negate},
	{"!", 1, 0, 1, invert},
	{"+", 2, 0, 1, add},
	{"-", 2, 0, 1, subtract},
	{"*", 2, 0, 1, multiply},
	{"/", 2, 0, 1, divide},
	{"^", 2, 0, 1, power},
	{"<", 2, 0, 1, less},
	{"<=", 2, 0, 1, at_most},
	{">", 2, 0, 1, more},
	{">=", 2, 0, 1, at_least},
	{"==", 2, 0, 1, equal},
	{"!=", 2, 0, 1, unequal},
	{"&&", 2, 0, 1, both},
	{"||", 2, 0, 1, either},
	{"abs", 1, 0, 0, absolute},
	{"sqrt", 1, 0, 0, square_root},
	{"exp", 1, 0, 0, exponential},
	{"log", 1, 0, 0, logarithm},
	{"sin", 1, 0, 0, sine},
	{"cos", 1, 0, 0, cosine},
	{"floor", 1, 0, 0, round_down},
	{"ceil", 1, 0, 0, round_up},
	{"isnan", 1, 0, 0, is_nan},
	{"min", 2, 1, 0, minimum},
	{"max", 2, 1, 0, maximum},
	{"pow", 2, 0, 0, power},
	{"step", 2, 0, 0, step},
	{"clamp", 3, 0, 0, clamp},
	{"mix", 3, 0, 0, mix},
	{"if", 3, 0, 0, choose},
	{"planck", 2, 0, 0, planck},
	{0},
};

const struct spec_function *
spec_function_operator(const char *name, int operands)
{
	for (const struct spec_function *row = spec_functions; row->name; row++) {
		if (row->is_operator && row->operands == operands &&
			strcmp(row->name, name) == 0)
			return row;
	}
	return NULL;
}

const struct spec_function *
spec_function_named(const char *name)
{
	for (const struct spec_function *row = spec_functions; row->name; row++) {
		if (!row->is_operator && strcmp(row->name, name) == 0)
			return row;
	}
	return NULL;
}
