/*
 * upsampling - the rate of the row kernels from RGB to bands, beside a plain copy of as
 * many planes: bench-upsampling [ROUNDS]; pixel*band/s, the best round
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "image/upsampling.h"

#define WIDTH 1920
#define BANDS 81
#define ROWS 40 /* of a round */

static float colour[3][WIDTH], plane[BANDS][WIDTH], other[BANDS][WIDTH];
static float *band[BANDS];

static void
die(const char *message)
{
	(void)fprintf(stderr, "bench-upsampling: %s\n", message);
	exit(2);
}

static double
now_s(void)
{
	struct timespec time;

	if (clock_gettime(CLOCK_MONOTONIC, &time) != 0)
		die("there is no clock");
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* A smooth picture with some grain, as pictures are. */
static void
make_colours(void)
{
	unsigned state = 1;

	for (size_t x = 0; x < WIDTH; x++) {
		for (size_t c = 0; c < 3; c++) {
			float ramp = (float)((x * (c + 1)) % WIDTH) / WIDTH;

			state = state * 1664525u + 1013904223u;
			colour[c][x] = .9F * ramp + .1F * (float)(state >> 8) / (1 << 24);
		}
	}
}

static void
copy_row(const void *nothing)
{
	(void)nothing;
	for (size_t i = 0; i < BANDS; i++)
		memcpy(plane[i], other[i], sizeof plane[i]);
}

static void
upsample_row(const void *upsampling)
{
	if (spec_upsampling_row(upsampling, colour[0], colour[1], colour[2], WIDTH, band) !=
		0)
		die("a colour was clamped");
}

static void
contest(const char *name, void (*row)(const void *), const void *state, int rounds)
{
	double least_s = HUGE_VAL;

	for (int round = 0; round < rounds; round++) {
		double start_s = now_s(), taken_s;

		for (int i = 0; i < ROWS; i++)
			row(state);
		taken_s = now_s() - start_s;
		least_s = taken_s < least_s ? taken_s : least_s;
	}
	printf("%s %.3g pixel*band/s\n", name, (double)WIDTH * BANDS * ROWS / least_s);
}

int
main(int argc, char **argv)
{
	static const char *const model[] = {"smits", "sun", "sigmoid", "basis"};
	double edge_nm[BANDS + 1], nm[BANDS];
	int rounds = argc > 1 ? atoi(argv[1]) : 5;

	if (argc > 2 || rounds < 1)
		die("usage: bench-upsampling [ROUNDS]");
	for (size_t i = 0; i <= BANDS; i++)
		edge_nm[i] = 377.5 + 5 * (double)i;
	for (size_t i = 0; i < BANDS; i++) {
		nm[i] = 380 + 5 * (double)i;
		band[i] = plane[i];
	}
	make_colours();
	contest("copy", copy_row, NULL, rounds);
	for (int k = 0; k < 8; k++) {
		struct spec_upsampling_setup setup = {.count = BANDS};
		struct spec_upsampling upsampling;
		struct spec_error error;
		char name[64];

		(void)spec_upsampling_find_model(model[k / 2], &setup.model, NULL);
		setup.use = setup.model == SPEC_UPSAMPLING_SUN ? SPEC_UPSAMPLING_LIGHT
							       : SPEC_UPSAMPLING_ALBEDO;
		setup.wavelength_nm = k % 2 ? NULL : nm;
		setup.edges_nm = k % 2 ? edge_nm : NULL;
		if (spec_upsampling_plan(&upsampling, &setup, &error) != SPEC_OK)
			die(error.message);
		(void)snprintf(name, sizeof name, "%s-%s", model[k / 2],
			k % 2 ? "means" : "points");
		contest(name, upsample_row, &upsampling, rounds);
		spec_upsampling_free(&upsampling);
	}
	return 0;
}
