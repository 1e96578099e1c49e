/* sigmoids - fit the table of sigmoids for sRGB: sigmoids FILE [SIDE]; make runs it */
#include <stdio.h>

#include "base/number.h"
#include "base/parallel.h"
#include "colour/sigmoids.h"

int
main(int argc, char **argv)
{
	struct spec_upsampler upsampler = {0};
	struct spec_sigmoids sigmoids = {0};
	struct spec_error error = {0};
	long long side = SPEC_SIGMOIDS_USUAL;
	enum spec_status status = SPEC_OK;

	if (argc < 2 || argc > 3) {
		(void)fprintf(stderr, "usage: sigmoids FILE [SIDE]\n");
		return 2;
	}
	if (argc == 3)
		status = spec_number_parse_whole(argv[2], SPEC_SIGMOIDS_LEAST,
			SPEC_SIGMOIDS_MOST, "the side", &side, &error);
	if (status == SPEC_OK)
		status = spec_upsampler_load(
			spec_space_find("srgb", NULL), &upsampler, &error);
	if (status == SPEC_OK)
		status = spec_sigmoids_solve(&upsampler, (size_t)side,
			spec_parallel_processors(), &sigmoids, &error);
	if (status == SPEC_OK)
		status = spec_sigmoids_save(&sigmoids, argv[1], &error);
	if (status != SPEC_OK)
		(void)fprintf(stderr, "sigmoids: %s\n", error.message);
	spec_sigmoids_free(&sigmoids);
	spec_upsampler_free(&upsampler);
	return status == SPEC_OK ? 0 : 2;
}
