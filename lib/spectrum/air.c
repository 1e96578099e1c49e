#include "spectrum/air.h"

/* Ciddor 1996, after eq 1 [um^-2]. */
#define K0 238.0185
#define K1 5792105.0
#define K2 57.362
#define K3 167917.0

const char *
spec_medium_name(enum spec_medium medium)
{
	static const char *const names[] = {"", "air", "vacuum"};

	return names[medium];
}

double
spec_air_index(double vacuum_nm)
{
	double square = 1e6 / (vacuum_nm * vacuum_nm);

	return 1 + 1e-8 * (K1 / (K0 - square) + K3 / (K2 - square));
}

enum spec_status
spec_air_convert(
	enum spec_medium to, double *wavelength_nm, size_t count, struct spec_error *error)
{
	for (size_t i = 0; i < count; i++) {
		double from_nm = wavelength_nm[i], vacuum_nm = from_nm;

		/* Each step leaves a few 1e-6 of the error: three are more than enough. */
		for (int step = 0; step < 5 && to == SPEC_MEDIUM_VACUUM; step++)
			vacuum_nm = from_nm * spec_air_index(vacuum_nm);
		if (!(vacuum_nm >= SPEC_AIR_SHORTEST_NM &&
			    vacuum_nm <= SPEC_AIR_LONGEST_NM))
			return spec_error_set(error, SPEC_ERANGE,
				"the index of air is known for %g..%g nm, not at %.10g nm",
				SPEC_AIR_SHORTEST_NM, SPEC_AIR_LONGEST_NM, from_nm);
		wavelength_nm[i] = to == SPEC_MEDIUM_VACUUM
					   ? vacuum_nm
					   : from_nm / spec_air_index(from_nm);
	}
	return SPEC_OK;
}
