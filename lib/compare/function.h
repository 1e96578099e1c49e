/*
 * The operators and functions of expressions, each on a run of pixels. NaN in any operand
 * gives NaN, but in a comparison, which it makes false ("!=" true), and in isnan. A truth is
 * 1 or 0, and what is not 0 is true. Division and logarithms are IEEE's: 1/0 is infinite.
 */
#ifndef SPEC_COMPARE_FUNCTION_H
#define SPEC_COMPARE_FUNCTION_H

#include <stddef.h>

#define SPEC_FUNCTION_LANES 8    /* runs are whole multiples of so many pixels */
#define SPEC_FUNCTION_OPERANDS 3 /* at most */

struct spec_function {
	const char *name; /* in the table's last row null */
	int operands;
	int repeats;     /* of two operands, and takes more: f(f(a, b), c) */
	int is_operator; /* stands between its operands, or before its only one */
	/*
	 * to[i] = f(a[i], b[i], c[i]) for i below count, a multiple of SPEC_FUNCTION_LANES:
	 * then a value does not depend on its place in the run. to overlaps no operand;
	 * operands that the function does not have are not read.
	 */
	void (*run)(double *to, const double *a, const double *b, const double *c,
		size_t count);
};

/*
 *   - !                    of one
 *   + - * / ^  < <= > >= == !=  && ||
 *   abs sqrt exp log sin cos floor ceil isnan
 *   min max pow
 *   step(edge, x)          x < edge ? 0 : 1
 *   clamp(x, low, high)    min(max(x, low), high)
 *   mix(a, b, t)           (1 - t) a + t b; where t is 0 it is a and where t is 1 it is b,
 *                          whatever the other one is
 *   if(c, a, b)            a where c is not 0, else b
 *   planck(nm, T)          Planck's law [W m^-2 sr^-1 nm^-1] at nm [nm] and T [K]; of a T
 *                          below 0 it is NaN. In expressions planck(T) means planck(nm, T).
 */
extern const struct spec_function spec_functions[];

/* The operator of so many operands, or the function, of that name; or null. */
const struct spec_function *spec_function_operator(const char *name, int operands);
const struct spec_function *spec_function_named(const char *name);

#endif
