/* Values, means and integrals of spectra; see spectrum.h. */
#include <math.h>

#include "base/interval.h"
#include "spectrum/fourier.h"
#include "spectrum/mean.h"
#include "spectrum/planck.h"
#include "spectrum/spectrum.h"

#define END_SLACK 1e-9 /* relative: rounding in a wavelength is no extrapolation */

/* A bin of a black body is divided into pieces in which Gauss's rule is exact to rounding. */
#define PLANCK_PIECE_NM 20.
#define PLANCK_PIECE_FALL 4. /* of x, see planck.h */
#define PLANCK_PIECES 4096

static struct spec_samples
samples_of(const struct spec_spectrum *spectrum)
{
	return (struct spec_samples){spectrum->wavelength_nm, spectrum->value,
		spectrum->count, spectrum->interpolate};
}

static struct spec_series
series_of(const struct spec_spectrum *spectrum)
{
	return (struct spec_series){
		spectrum->low_nm, spectrum->high_nm, spectrum->count, spectrum->value};
}

/* A view of a spectrum's samples as a curve, for functions that only read it. */
static struct spec_curve
curve_of(const struct spec_spectrum *spectrum)
{
	return (struct spec_curve){.title = spectrum->title,
		.count = spectrum->count,
		.wavelength_nm = spectrum->wavelength_nm,
		.columns = 1,
		.value = spectrum->value};
}

static int
is_linear_table(const struct spec_spectrum *spectrum)
{
	return spectrum->wavelength_nm && spectrum->interpolate == SPEC_INTERPOLATE_LINEAR;
}

static enum spec_status
refuse(const struct spec_spectrum *spectrum, double nm, struct spec_error *error)
{
	const char *quote = *spectrum->title ? "'" : "";

	return spec_error_set(error, SPEC_ERANGE,
		"%s%.200s%s covers %.10g..%.10g nm, not %.10g nm", quote,
		*spectrum->title ? spectrum->title : "the spectrum", quote,
		spectrum->low_nm, spectrum->high_nm, nm);
}

static int
is_inside(const struct spec_spectrum *spectrum, double nm)
{
	return nm >= spectrum->low_nm * (1 - END_SLACK) &&
	       nm <= spectrum->high_nm * (1 + END_SLACK);
}

/* The smooth part at a wavelength between its ends, where it has any. */
static double
value_inside(const struct spec_spectrum *spectrum, double nm)
{
	struct spec_samples samples = samples_of(spectrum);
	struct spec_series series = series_of(spectrum);
	double value = spectrum->level;

	if (spectrum->smooth == SPEC_SPECTRUM_BLACKBODY) {
		spec_planck_relative(spectrum->temperature_k, &nm, 1, &value);
		value *= spectrum->level;
	} else if (spectrum->smooth == SPEC_SPECTRUM_RGB) {
		spec_sigmoid_sample(&spectrum->sigmoid, &nm, 1, &value);
	} else if (spectrum->smooth == SPEC_SPECTRUM_FOURIER) {
		value = spec_series_at(&series, nm);
	} else if (spectrum->wavelength_nm) {
		value = spec_samples_at(&samples, nm);
	}
	return value;
}

enum spec_status
spec_spectrum_sample(const struct spec_spectrum *spectrum,
	enum spec_extrapolate extrapolate, const double *wavelength_nm, size_t count,
	double *value, struct spec_error *error)
{
	for (size_t i = 0; i < count; i++) {
		double nm = wavelength_nm[i];
		int inside = is_inside(spectrum, nm);

		if (isnan(nm) || (!inside && extrapolate == SPEC_EXTRAPOLATE_REFUSE))
			return refuse(spectrum, nm, error);
		if (!inside && extrapolate == SPEC_EXTRAPOLATE_ZERO)
			value[i] = 0;
		else
			value[i] = value_inside(spectrum,
				fmin(fmax(nm, spectrum->low_nm), spectrum->high_nm));
	}
	return SPEC_OK;
}

/* Means */

static double
blackbody_mean(const struct spec_spectrum *spectrum, double a_nm, double b_nm)
{
	double x_nm = 1e9 * SPEC_PLANCK_J_S * SPEC_LIGHT_SPEED_M_PER_S /
		      SPEC_BOLTZMANN_J_PER_K / spectrum->temperature_k;
	double wanted = fmax((b_nm - a_nm) / PLANCK_PIECE_NM,
		(x_nm / a_nm - x_nm / b_nm) / PLANCK_PIECE_FALL);
	int pieces = (int)fmin(fmax(ceil(wanted), 1), PLANCK_PIECES);
	double sum = 0, mean, edge_nm[2] = {a_nm, a_nm};

	for (int i = 1; i <= pieces; i++) {
		edge_nm[0] = edge_nm[1];
		edge_nm[1] = i < pieces ? a_nm + (b_nm - a_nm) * i / pieces : b_nm;
		spec_planck_relative_mean(spectrum->temperature_k, edge_nm, 1, &mean);
		sum += mean;
	}
	return spectrum->level * sum / pieces;
}

/* The integral of what has ends, between them. */
static double
integral_inside(const struct spec_spectrum *spectrum, double a_nm, double b_nm)
{
	struct spec_samples samples = samples_of(spectrum);
	struct spec_series series = series_of(spectrum);

	if (!(a_nm < b_nm))
		return 0;
	return spectrum->wavelength_nm
		       ? spec_samples_integral(&samples, a_nm, b_nm)
		       : (b_nm - a_nm) * spec_series_mean(&series, a_nm, b_nm);
}

/* The mean of what has ends, and beyond them is zero or as at the nearer end. */
static double
mean_with_ends(const struct spec_spectrum *spectrum, enum spec_extrapolate extrapolate,
	double a_nm, double b_nm)
{
	double low_nm = spectrum->low_nm, high_nm = spectrum->high_nm;
	double sum = integral_inside(spectrum, fmax(a_nm, low_nm), fmin(b_nm, high_nm));

	/* What is refused has been; what rounding leaves beyond an end counts as that end. */
	if (extrapolate == SPEC_EXTRAPOLATE_ZERO)
		return sum / (b_nm - a_nm);
	if (a_nm < low_nm)
		sum += (fmin(b_nm, low_nm) - a_nm) * value_inside(spectrum, low_nm);
	if (b_nm > high_nm)
		sum += (b_nm - fmax(a_nm, high_nm)) * value_inside(spectrum, high_nm);
	return sum / (b_nm - a_nm);
}

static enum spec_status
check_edges(const struct spec_spectrum *spectrum, enum spec_extrapolate extrapolate,
	const double *edges_nm, size_t bins, struct spec_error *error)
{
	for (size_t i = 0; i <= bins; i++)
		if (!(edges_nm[i] > (i > 0 ? edges_nm[i - 1] : 0)) || isinf(edges_nm[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"the bin edge %.10g nm is not finite, positive and above "
				"the one before",
				edges_nm[i]);
	if (extrapolate != SPEC_EXTRAPOLATE_REFUSE)
		return SPEC_OK;
	if (!is_inside(spectrum, edges_nm[0]))
		return refuse(spectrum, edges_nm[0], error);
	return is_inside(spectrum, edges_nm[bins])
		       ? SPEC_OK
		       : refuse(spectrum, edges_nm[bins], error);
}

enum spec_status
spec_spectrum_mean(const struct spec_spectrum *spectrum, enum spec_extrapolate extrapolate,
	const double *edges_nm, size_t bins, double *value, struct spec_error *error)
{
	struct spec_curve curve = curve_of(spectrum);
	enum spec_status status = check_edges(spectrum, extrapolate, edges_nm, bins, error);

	if (status == SPEC_OK && is_linear_table(spectrum))
		status = spec_curve_mean(
			&curve, 0, extrapolate, edges_nm, bins, value, error);
	else if (status == SPEC_OK && spectrum->smooth == SPEC_SPECTRUM_RGB)
		spec_sigmoid_mean(&spectrum->sigmoid, edges_nm, bins, value);
	else
		for (size_t i = 0; status == SPEC_OK && i < bins; i++) {
			double a_nm = edges_nm[i], b_nm = edges_nm[i + 1];

			if (spectrum->smooth == SPEC_SPECTRUM_CONSTANT)
				value[i] = spectrum->level;
			else if (spectrum->smooth == SPEC_SPECTRUM_BLACKBODY)
				value[i] = blackbody_mean(spectrum, a_nm, b_nm);
			else
				value[i] =
					mean_with_ends(spectrum, extrapolate, a_nm, b_nm);
		}
	for (size_t i = 0; status == SPEC_OK && bins > 0 && i < spectrum->lines; i++) {
		double nm = spectrum->line[i].wavelength_nm;
		size_t bin = spec_interval_find(edges_nm, bins, nm);

		if (nm >= edges_nm[0] && nm <= edges_nm[bins])
			value[bin] += spectrum->line[i].weight /
				      (edges_nm[bin + 1] - edges_nm[bin]);
	}
	return status;
}

enum spec_status
spec_spectrum_integral(const struct spec_spectrum *spectrum,
	enum spec_extrapolate extrapolate, double low_nm, double high_nm, double *integral,
	struct spec_error *error)
{
	double edges_nm[2], mean = 0;
	enum spec_status status;

	edges_nm[0] = low_nm;
	edges_nm[1] = high_nm;
	status = spec_spectrum_mean(spectrum, extrapolate, edges_nm, 1, &mean, error);
	*integral = mean * (high_nm - low_nm);
	return status;
}
