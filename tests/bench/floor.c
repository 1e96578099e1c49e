/*
 * The floor of spec2rgb: what OpenEXRCore itself costs. Chunks are read and
 * decompressed on N threads, dealt dynamically, and go as they lie through a plain
 * 3 x channels matrix in float into memory. It knows no names, no limits, no pipes and
 * nothing of the suite's reader; only the codec hook is shared.
 *
 *   bench-floor [-j N] [-rv] FILE...    -v prints the sums of the three planes
 *
 * FILE: scanlines, FLOAT alone. With -r chunks are read and decompressed, and no more: the
 * floor of who looks at every sample of several files, which are read in turns.
 */
#include <libdeflate.h>
#include <openexr.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "image/codec.h"

#define MOST_THREADS 64

/* One clone for every x86-64, one with AVX2; "avx2,fma" would be two. clang 14 lacks it. */
#if defined(__x86_64__) && !defined(__clang__)
#define WIDE __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define WIDE
#endif

struct floor {
	exr_context_t context;
	int y0, height, lines;
	size_t width, channels;
	int deflated, reads_alone;
	float *weight; /* [channels][3] */
	float *result; /* [height][3][width] */
	atomic_int next, failed;
};

/* Four channels at a time, so that the sums are loaded and stored a quarter as often. */
WIDE static void
add_four(float *restrict rgb, const float *restrict sample, const float *weight,
	size_t width)
{
	for (int i = 0; i < 3; i++, rgb += width) {
		const float a = weight[i], b = weight[3 + i], c = weight[6 + i],
			    d = weight[9 + i];

		for (size_t x = 0; x < width; x++)
			rgb[x] += (a * sample[x] + b * sample[width + x]) +
				  (c * sample[2 * width + x] + d * sample[3 * width + x]);
	}
}

WIDE static void
add_one(float *restrict rgb, const float *restrict sample, const float *weight,
	size_t width)
{
	for (int i = 0; i < 3; i++, rgb += width) {
		for (size_t x = 0; x < width; x++)
			rgb[x] += weight[i] * sample[x];
	}
}

static void
add_line(const struct floor *floor, float *rgb, const float *sample)
{
	size_t i = 0;

	for (; i + 4 <= floor->channels; i += 4)
		add_four(rgb, sample + i * floor->width, floor->weight + 3 * i,
			floor->width);
	for (; i < floor->channels; i++)
		add_one(rgb, sample + i * floor->width, floor->weight + 3 * i,
			floor->width);
}

static exr_result_t
inflate(exr_decode_pipeline_t *pipeline)
{
	size_t packed = pipeline->chunk.packed_size, size = pipeline->chunk.unpacked_size;

	return packed == size ? EXR_ERR_SUCCESS
			      : spec_codec_unzip(pipeline->decoding_user_data,
					pipeline->packed_buffer, packed,
					pipeline->unpacked_buffer, size);
}

static exr_result_t
start_pipeline(struct floor *floor, exr_decode_pipeline_t *pipeline,
	const exr_chunk_info_t *info, struct libdeflate_decompressor *inflater)
{
	exr_result_t result = exr_decoding_initialize(floor->context, 0, info, pipeline);

	if (result == EXR_ERR_SUCCESS)
		result = exr_decoding_choose_default_routines(floor->context, 0, pipeline);
	pipeline->unpack_and_convert_fn = NULL;
	if (floor->deflated) {
		pipeline->decompress_fn = inflate;
		pipeline->decoding_user_data = inflater;
	}
	return result;
}

static void
multiply(struct floor *floor, const exr_decode_pipeline_t *pipeline)
{
	const exr_chunk_info_t *info = &pipeline->chunk;
	const float *sample = info->packed_size == info->unpacked_size
				      ? pipeline->packed_buffer
				      : pipeline->unpacked_buffer;
	float *rgb = floor->result + (size_t)(info->start_y - floor->y0) * 3 * floor->width;

	for (int line = 0; line < info->height; line++) {
		add_line(floor, rgb, sample);
		sample += floor->channels * floor->width;
		rgb += 3 * floor->width;
	}
}

static void *
work(void *argument)
{
	struct floor *floor = argument;
	struct libdeflate_decompressor *inflater = libdeflate_alloc_decompressor();
	exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
	exr_result_t result = EXR_ERR_SUCCESS;
	int started = 0;

	while (result == EXR_ERR_SUCCESS) {
		int line = atomic_fetch_add(&floor->next, 1) * floor->lines;
		exr_chunk_info_t info;

		if (line >= floor->height)
			break;
		result = exr_read_scanline_chunk_info(
			floor->context, 0, floor->y0 + line, &info);
		if (result != EXR_ERR_SUCCESS)
			break;
		result = started ? exr_decoding_update(floor->context, 0, &info, &pipeline)
				 : start_pipeline(floor, &pipeline, &info, inflater);
		started = 1;
		if (result == EXR_ERR_SUCCESS)
			result = exr_decoding_run(floor->context, 0, &pipeline);
		if (result == EXR_ERR_SUCCESS && !floor->reads_alone)
			multiply(floor, &pipeline);
	}
	if (result != EXR_ERR_SUCCESS)
		floor->failed = 1;
	if (started)
		exr_decoding_destroy(floor->context, &pipeline);
	libdeflate_free_decompressor(inflater);
	return NULL;
}

static _Noreturn void
die(const char *message)
{
	fprintf(stderr, "bench-floor: %s\n", message);
	exit(2);
}

static void
measure(struct floor *floor)
{
	const exr_attr_chlist_t *list;
	exr_compression_t compression;
	exr_attr_box2i_t window;

	if (exr_get_data_window(floor->context, 0, &window) != EXR_ERR_SUCCESS ||
		exr_get_channels(floor->context, 0, &list) != EXR_ERR_SUCCESS ||
		exr_get_compression(floor->context, 0, &compression) != EXR_ERR_SUCCESS ||
		exr_get_scanlines_per_chunk(floor->context, 0, &floor->lines) !=
			EXR_ERR_SUCCESS)
		die("not an image of scanlines");
	floor->y0 = window.min.y;
	floor->height = window.max.y - window.min.y + 1;
	floor->width = (size_t)window.max.x - (size_t)window.min.x + 1;
	floor->channels = (size_t)list->num_channels;
	floor->deflated =
		compression == EXR_COMPRESSION_ZIP || compression == EXR_COMPRESSION_ZIPS;
	floor->weight = malloc(floor->channels * 3 * sizeof(float));
	floor->result =
		calloc(floor->reads_alone ? 1 : (size_t)floor->height * 3 * floor->width,
			sizeof(float));
	if (!floor->weight || !floor->result)
		die("out of memory");
	for (size_t i = 0; i < floor->channels; i++) {
		if (list->entries[i].pixel_type != EXR_PIXEL_FLOAT)
			die("a channel is not FLOAT");
		for (size_t j = 0; j < 3; j++)
			floor->weight[3 * i + j] = (float)(1 + (i * (j + 1)) % 7) / 16;
	}
}

static void
print_sums(const struct floor *floor)
{
	double sum[3] = {0};

	for (size_t line = 0; line < (size_t)floor->height; line++) {
		for (size_t i = 0; i < 3 * floor->width; i++)
			sum[i / floor->width] +=
				(double)floor->result[line * 3 * floor->width + i];
	}
	printf("%.9g %.9g %.9g\n", sum[0], sum[1], sum[2]);
}

static void
run(struct floor *floor, const char *path, int threads)
{
	exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
	pthread_t thread[MOST_THREADS];
	int started = 1;

	if (exr_start_read(&floor->context, path, &setup) != EXR_ERR_SUCCESS)
		exit(2); /* the library has said why */
	measure(floor);
	for (; started < threads; started++) {
		if (pthread_create(&thread[started], NULL, work, floor) != 0)
			break;
	}
	work(floor);
	for (int i = 1; i < started; i++)
		pthread_join(thread[i], NULL);
	if (floor->failed)
		die("the pixels cannot be read");
}

int
main(int argc, char **argv)
{
	int threads = (int)sysconf(_SC_NPROCESSORS_ONLN), verbose = 0, alone = 0, option;

	while ((option = getopt(argc, argv, "j:rv")) != -1) {
		if (option == 'j')
			threads = atoi(optarg);
		else if (option == 'r')
			alone = 1;
		else if (option == 'v')
			verbose = 1;
		else
			return 2;
	}
	if (optind >= argc || threads < 1 || threads > MOST_THREADS || (alone && verbose))
		die("usage: bench-floor [-j N] [-rv] FILE...");
	for (; optind < argc; optind++) {
		struct floor floor = {.reads_alone = alone};

		run(&floor, argv[optind], threads);
		if (verbose)
			print_sums(&floor);
		exr_finish(&floor.context);
		free(floor.weight);
		free(floor.result);
	}
	return 0;
}
