/* Sums that keep what each addition rounds away (Neumaier 1974). */
#ifndef SPEC_COMPARE_SUM_H
#define SPEC_COMPARE_SUM_H

#include <math.h>

struct spec_measure_sum {
	double sum, lost;
};

static inline void
spec_measure_sum_add(struct spec_measure_sum *sum, double value)
{
	double total = sum->sum + value;

	if (fabs(sum->sum) >= fabs(value))
		sum->lost += (sum->sum - total) + value;
	else
		sum->lost += (value - total) + sum->sum;
	sum->sum = total;
}

static inline void
spec_measure_sum_join(struct spec_measure_sum *total, const struct spec_measure_sum *other)
{
	spec_measure_sum_add(total, other->sum);
	total->lost += other->lost;
}

/* What is lost beside an infinite sum is NaN and means nothing. */
static inline double
spec_measure_sum_value(const struct spec_measure_sum *sum)
{
	return isfinite(sum->sum) ? sum->sum + sum->lost : sum->sum;
}

#endif
