#include "colour/observer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "spectrum/lookup.h"

/* The widest departure of a table's steps from equality, as a part of a step. */
#define STEP_TOLERANCE 1e-6

/* The most steps of 1 nm that a table of unequal ones becomes. */
#define MOST_STEPS 1e6

/* Two wavelengths closer than this are the same: below any table's resolution. */
#define SAME_NM 1e-6

/* The observer's three functions, times the illuminant's where there is one. */
struct product {
	size_t count;
	double first_nm, step_nm;
	double *value; /* 3 * count, and count more for the illuminant alone */
	double sum[3]; /* of each function over the whole table */
};

const char *
spec_observer_spectrum(const char *name)
{
	static const struct {
		const char *name, *spectrum;
	} observers[] = {{"1931", "cmf/cie1931"}, {"1964", "cmf/cie1964"},
		{"2015-2", "cmf/cie2015-2"}, {"2015-10", "cmf/cie2015-10"}};

	for (size_t i = 0; i < sizeof observers / sizeof *observers; i++)
		if (strcmp(name, observers[i].name) == 0)
			return observers[i].spectrum;
	return name;
}

int
spec_observer_is_xyz(const struct spec_curve *observer)
{
	static const char *const names[][3] = {
		{"x", "y", "z"}, {"X", "Y", "Z"}, {"value1", "value2", "value3"}};

	for (size_t i = 0; observer->columns >= 3 && i < sizeof names / sizeof *names; i++)
		if (strcmp(observer->column[0], names[i][0]) == 0 &&
			strcmp(observer->column[1], names[i][1]) == 0 &&
			strcmp(observer->column[2], names[i][2]) == 0)
			return 1;
	return 0;
}

/* The first row that is not where equal steps have it, or their number. */
static size_t
first_unequal(const struct spec_curve *curve)
{
	const double *w = curve->wavelength_nm;
	double step = (w[curve->count - 1] - w[0]) / (double)(curve->count - 1);
	size_t i = 0;

	while (i < curve->count &&
		fabs(w[i] - (w[0] + (double)i * step)) <= STEP_TOLERANCE * step)
		i++;
	return i;
}

int
spec_observer_is_grey(const struct spec_curve *observer)
{
	return strcmp(observer->column[0], observer->column[1]) == 0 &&
	       strcmp(observer->column[0], observer->column[2]) == 0;
}

/* The texts of a curve, and the names of the columns: those of *from. */
static enum spec_status
name_as(struct spec_curve *curve, const struct spec_curve *from, struct spec_error *error)
{
	enum spec_status status = spec_curve_set_text(&curve->title, from->title, error);

	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->quantity, from->quantity, error);
	for (size_t c = 0; c < curve->columns && status == SPEC_OK; c++)
		status = spec_curve_set_text(
			&curve->column[c], from->column[from->columns == 1 ? 0 : c], error);
	return status;
}

/* Three columns of *from at equal steps: its own, or else of at most 1 nm. */
static enum spec_status
make_regular(
	const struct spec_curve *from, struct spec_curve *curve, struct spec_error *error)
{
	const double *w = from->wavelength_nm, width = w[from->count - 1] - w[0];
	int regular = first_unequal(from) == from->count;
	size_t steps = from->count - 1;
	enum spec_status status;

	if (!regular && width > MOST_STEPS)
		return spec_error_set(error, SPEC_EFORMAT,
			"observer '%s' has unequal steps over %g nm", spec_curve_name(from),
			width);
	if (!regular)
		steps = (size_t)ceil(width);
	status = spec_curve_new(steps + 1, 3, curve, error);
	if (status == SPEC_OK)
		status = name_as(curve, from, error);
	for (size_t i = 0; status == SPEC_OK && i <= steps; i++)
		curve->wavelength_nm[i] =
			regular ? w[i] : w[0] + width * ((double)i / (double)steps);
	for (size_t c = 0; status == SPEC_OK && c < 3; c++)
		status = spec_curve_sample(from, from->columns == 1 ? 0 : c,
			SPEC_EXTRAPOLATE_REFUSE, curve->wavelength_nm, curve->count,
			curve->value + c * curve->count, error);
	return status;
}

static int
is_sensitivity(const struct spec_curve *curve)
{
	return strcmp(curve->quantity, "luminous efficiency") == 0 ||
	       strcmp(curve->quantity, "spectral sensitivity") == 0;
}

enum spec_status
spec_observer_load(const char *name, struct spec_curve *observer, struct spec_error *error)
{
	struct spec_curve curve;
	enum spec_status status =
		spec_lookup_curve(spec_observer_spectrum(name), &curve, error);

	*observer = (struct spec_curve){0};
	if (status != SPEC_OK)
		return status;
	if (curve.count < 2)
		status = spec_error_set(error, SPEC_EFORMAT,
			"'%.200s' has one wavelength alone: no observer", name);
	else if (curve.columns < 3 && !(curve.columns == 1 && is_sensitivity(&curve)))
		status = spec_error_set(error, SPEC_EFORMAT,
			"'%.200s' is no observer: neither three columns, such as x, y and "
			"z, nor one of luminous efficiency or spectral sensitivity",
			name);
	else
		status = make_regular(&curve, observer, error);
	if (status == SPEC_OK && !*observer->title)
		status = spec_curve_set_text(&observer->title, name, error);
	spec_curve_free(&curve);
	if (status != SPEC_OK)
		spec_curve_free(observer);
	return status;
}

static enum spec_status
check_observer(const struct spec_curve *observer, struct spec_error *error)
{
	size_t unequal;

	if (observer->columns < 3 || observer->count < 2)
		return spec_error_set(error, SPEC_EFORMAT,
			"observer '%s' is no table of x, y and z",
			spec_curve_name(observer));
	unequal = first_unequal(observer);
	if (unequal < observer->count)
		return spec_error_set(error, SPEC_EFORMAT,
			"observer '%s' has unequal steps at %g nm",
			spec_curve_name(observer), observer->wavelength_nm[unequal]);
	return SPEC_OK;
}

/* Fills *product; its value is the caller's to free, whatever the status. */
static enum spec_status
multiply(const struct spec_curve *observer, const struct spec_curve *illuminant,
	struct product *product, struct spec_error *error)
{
	size_t n = observer->count, c, j;
	enum spec_status status = SPEC_OK;
	double *light;

	product->value = spec_memory_new(4 * n, sizeof(double), "observer samples", error);
	if (!product->value)
		return SPEC_ENOMEM;
	light = product->value + 3 * n;
	if (illuminant)
		status = spec_curve_sample(illuminant, 0, SPEC_EXTRAPOLATE_ZERO,
			observer->wavelength_nm, n, light, error);
	product->count = n;
	product->first_nm = observer->wavelength_nm[0];
	product->step_nm =
		(observer->wavelength_nm[n - 1] - product->first_nm) / (double)(n - 1);
	for (c = 0; c < 3; c++) {
		product->sum[c] = 0;
		for (j = 0; j < n; j++) {
			product->value[c * n + j] =
				observer->value[c * n + j] * (illuminant ? light[j] : 1);
			product->sum[c] += product->value[c * n + j];
		}
	}
	return status;
}

static enum spec_status
check_product(const struct spec_curve *observer, const struct spec_curve *illuminant,
	const struct product *product, struct spec_error *error)
{
	const double *w = observer->wavelength_nm, *v;

	if (isfinite(product->sum[0]) && isfinite(product->sum[1]) &&
		isfinite(product->sum[2]) && product->sum[1] > 0)
		return SPEC_OK;
	if (!illuminant)
		return spec_error_set(error, SPEC_EFORMAT,
			"observer '%s' has no finite, positive y",
			spec_curve_name(observer));
	v = illuminant->wavelength_nm;
	if (v[illuminant->count - 1] < w[0] || v[0] > w[observer->count - 1])
		return spec_error_set(error, SPEC_ERANGE,
			"illuminant '%s' (%g..%g nm) lies outside the observer's %g..%g nm",
			spec_curve_name(illuminant), v[0], v[illuminant->count - 1], w[0],
			w[observer->count - 1]);
	return spec_error_set(error, SPEC_EFORMAT,
		"illuminant '%s' gives no finite, positive y", spec_curve_name(illuminant));
}

/* On success the caller frees the product's value. */
static enum spec_status
open_product(const struct spec_curve *observer, const struct spec_curve *illuminant,
	struct product *product, struct spec_error *error)
{
	enum spec_status status = check_observer(observer, error);

	if (status != SPEC_OK)
		return status;
	status = multiply(observer, illuminant, product, error);
	if (status == SPEC_OK)
		status = check_product(observer, illuminant, product, error);
	if (status != SPEC_OK)
		free(product->value);
	return status;
}

static enum spec_status
check_ascending(const double *nm, size_t count, const char *what, struct spec_error *error)
{
	size_t i;

	for (i = 0; i < count; i++) {
		if (!isfinite(nm[i]))
			return spec_error_set(
				error, SPEC_ERANGE, "%s %zu is not finite", what, i + 1);
		if (i > 0 && !(nm[i] > nm[i - 1]))
			return spec_error_set(error, SPEC_ERANGE,
				"%ss do not ascend: %g nm follows %g nm", what, nm[i],
				nm[i - 1]);
	}
	return SPEC_OK;
}

static enum spec_status
check_bands(const struct spec_bands *bands, const struct spec_curve *illuminant,
	struct spec_error *error)
{
	if (bands->count == 0)
		return spec_error_set(error, SPEC_EUSAGE, "no bands to integrate");
	if (bands->per_band && illuminant)
		return spec_error_set(error, SPEC_EUSAGE,
			"values per band are light already and take no illuminant");
	if (bands->edges_nm)
		return check_ascending(
			bands->edges_nm, bands->count + 1, "band edge", error);
	if (bands->count == 1 && !bands->per_band)
		return spec_error_set(error, SPEC_ERANGE,
			"one band has no width: its integral is not defined");
	return check_ascending(bands->wavelength_nm, bands->count, "wavelength", error);
}

/* The first sample at or above nm, or the count when there is none. */
static size_t
first_sample(const struct product *product, double nm)
{
	double j = ceil((nm - product->first_nm) / product->step_nm);

	if (!(j > 0))
		return 0;
	return j < (double)product->count ? (size_t)j : product->count;
}

static double
sample_nm(const struct product *product, size_t j)
{
	return product->first_nm + (double)j * product->step_nm;
}

/* One function of the product, linear between its samples, zero outside. */
static double
product_at(const struct product *product, size_t c, double nm)
{
	const double *value = product->value + c * product->count;
	double position = (nm - product->first_nm) / product->step_nm;
	size_t low;

	if (!(position >= 0 && position <= (double)(product->count - 1)))
		return 0;
	low = (size_t)position;
	if (low == product->count - 1)
		return value[low];
	return value[low] + (value[low + 1] - value[low]) * (position - (double)low);
}

/* The integral from a to b [nm] of one function, exact for its straight pieces. */
static double
integral(const struct product *product, size_t c, double a, double b)
{
	double last_nm = sample_nm(product, product->count - 1), from, to, sum = 0;
	size_t j;

	a = a > product->first_nm ? a : product->first_nm;
	b = b < last_nm ? b : last_nm;
	for (from = a, j = first_sample(product, a); from < b; from = to, j++) {
		to = j < product->count && sample_nm(product, j) < b ? sample_nm(product, j)
								     : b;
		if (to > from)
			sum += .5 * (to - from) *
			       (product_at(product, c, from) + product_at(product, c, to));
		else
			to = from;
	}
	return sum;
}

static void
weigh_bins(const struct product *product, const struct spec_bands *bands, double *weight)
{
	double unit = product->step_nm * product->sum[1];
	const double *edge = bands->edges_nm;
	size_t c, i;

	for (c = 0; c < 3; c++)
		for (i = 0; i < bands->count; i++)
			weight[c * bands->count + i] =
				integral(product, c, edge[i], edge[i + 1]) /
				(bands->per_band ? unit * (edge[i + 1] - edge[i]) : unit);
}

static void
weigh_lines(const struct product *product, const struct spec_bands *bands, double *weight)
{
	double unit = product->step_nm * product->sum[1];
	size_t c, i;

	for (c = 0; c < 3; c++)
		for (i = 0; i < bands->count; i++)
			weight[c * bands->count + i] =
				product_at(product, c, bands->wavelength_nm[i]) / unit;
}

/* Each sample of the observer is shared by the two bands around it. */
static void
weigh_points(const struct product *product, const struct spec_bands *bands, double *weight)
{
	const double *w = bands->wavelength_nm;
	size_t n = bands->count, i = 0, c, j;
	double nm, t, value;

	memset(weight, 0, 3 * n * sizeof *weight);
	for (j = first_sample(product, w[0] - SAME_NM); j < product->count; j++) {
		nm = sample_nm(product, j);
		if (nm > w[n - 1] + SAME_NM)
			break;
		while (i + 2 < n && nm >= w[i + 1])
			i++;
		t = (nm - w[i]) / (w[i + 1] - w[i]);
		t = t < 0 ? 0 : t > 1 ? 1 : t;
		for (c = 0; c < 3; c++) {
			value = product->value[c * product->count + j] / product->sum[1];
			weight[c * n + i] += (1 - t) * value;
			weight[c * n + i + 1] += t * value;
		}
	}
}

/* The part of Y between two wavelengths, by the observer's samples. */
static double
covered(const struct product *product, double from_nm, double to_nm)
{
	double sum = 0;
	size_t j;

	for (j = first_sample(product, from_nm - SAME_NM); j < product->count; j++) {
		if (sample_nm(product, j) > to_nm + SAME_NM)
			break;
		sum += product->value[product->count + j];
	}
	return sum / product->sum[1];
}

/* The part of Y outside the image's range. */
static double
left_out(
	const struct product *product, const struct spec_bands *bands, const double *weight)
{
	const double *w = bands->wavelength_nm;
	size_t n = bands->count, i;
	double inside = 0;

	if (!bands->per_band) {
		for (i = 0; i < n; i++)
			inside += weight[n + i];
	} else if (bands->edges_nm) {
		for (i = 0; i < n; i++)
			inside += weight[n + i] *
				  (bands->edges_nm[i + 1] - bands->edges_nm[i]);
	} else if (n == 1) {
		inside = 1;
	} else {
		inside = covered(product, w[0] - .5 * (w[1] - w[0]),
			w[n - 1] + .5 * (w[n - 1] - w[n - 2]));
	}
	return inside < 1 ? 1 - inside : 0;
}

static enum spec_status
check_overlap(const struct product *product, const struct spec_bands *bands,
	struct spec_error *error)
{
	const double *w = bands->edges_nm ? bands->edges_nm : bands->wavelength_nm;
	double first = w[0], last = w[bands->edges_nm ? bands->count : bands->count - 1];
	double end = sample_nm(product, product->count - 1);
	size_t j;

	if (last < product->first_nm || first > end)
		return spec_error_set(error, SPEC_ERANGE,
			"the image's %g..%g nm lie outside the observer's %g..%g nm", first,
			last, product->first_nm, end);
	j = first_sample(product, first - SAME_NM);
	if (!bands->edges_nm && !bands->per_band &&
		(j >= product->count || sample_nm(product, j) > last + SAME_NM))
		return spec_error_set(error, SPEC_ERANGE,
			"the image's %g..%g nm lie between two samples of the observer",
			first, last);
	return SPEC_OK;
}

enum spec_status
spec_observer_weights(const struct spec_curve *observer,
	const struct spec_curve *illuminant, const struct spec_bands *bands, double *weight,
	double *outside, struct spec_error *error)
{
	enum spec_status status = check_bands(bands, illuminant, error);
	struct product product;

	if (status != SPEC_OK)
		return status;
	status = open_product(observer, illuminant, &product, error);
	if (status != SPEC_OK)
		return status;
	status = check_overlap(&product, bands, error);
	if (status == SPEC_OK) {
		if (bands->edges_nm)
			weigh_bins(&product, bands, weight);
		else if (bands->per_band)
			weigh_lines(&product, bands, weight);
		else
			weigh_points(&product, bands, weight);
		*outside = left_out(&product, bands, weight);
	}
	free(product.value);
	return status;
}

enum spec_status
spec_observer_white(const struct spec_curve *observer, const struct spec_curve *illuminant,
	double xyz[3], struct spec_error *error)
{
	struct product product;
	enum spec_status status = open_product(observer, illuminant, &product, error);
	size_t c;

	if (status != SPEC_OK)
		return status;
	for (c = 0; c < 3; c++)
		xyz[c] = product.sum[c] / product.sum[1];
	free(product.value);
	return SPEC_OK;
}
