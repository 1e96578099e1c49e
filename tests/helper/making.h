/*
 * What synthesize and layers share: images whose lines are made by several threads, in a
 * way of their own - what they make is there to test the library's.
 */
#ifndef TESTS_HELPER_MAKING_H
#define TESTS_HELPER_MAKING_H

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/settings.h"
#include "image/writer.h"
#include "spectrum/grid.h"

/* An image, and who fills its lines. */
struct making {
	const struct spec_image *image;
	const struct spec_settings *settings;
	/*
	 * Fills line y, counted from the data window's first: row has one for each of the
	 * image's channels. room: room_bytes of the thread's own.
	 */
	void (*fill)(const void *state, int y, void *room, float *const *row);
	const void *state;
	size_t room_bytes;
	/* of making_write alone */
	struct spec_writer *writer;
	atomic_int next_chunk;
};

static inline enum spec_status
making_line(const struct making *making, struct spec_packer *packer, int y, void *room,
	struct spec_error *error)
{
	int line = making->image->data.y0 + y;
	float *const *row;
	enum spec_status status = spec_packer_begin(packer, line, &row, error);

	if (status != SPEC_OK)
		return status;
	making->fill(making->state, y, room, row);
	return spec_packer_end(packer, line, error);
}

static inline enum spec_status
making_lines(struct making *making, struct spec_packer *packer, void *room,
	struct spec_error *error)
{
	int height = (int)spec_window_height(&making->image->data);
	int lines = spec_writer_chunk_lines(making->writer);
	enum spec_status status = SPEC_OK;

	while (status == SPEC_OK) {
		int first = atomic_fetch_add(&making->next_chunk, 1) * lines;

		if (first >= height)
			break;
		for (int y = first; y < first + lines && y < height && status == SPEC_OK;
			y++)
			status = making_line(making, packer, y, room, error);
	}
	return status;
}

static inline void
making_work(void *argument, int worker)
{
	struct making *making = argument;
	struct spec_packer *packer = NULL;
	struct spec_error error = {0};
	void *room = NULL;
	enum spec_status status = spec_packer_open(&packer, making->writer, &error);

	(void)worker;
	if (status == SPEC_OK) {
		room = spec_memory_new(
			making->room_bytes, 1, "bytes to make a line in", &error);
		status = room ? SPEC_OK : SPEC_ENOMEM;
	}
	if (status == SPEC_OK)
		status = making_lines(making, packer, room, &error);
	if (status != SPEC_OK)
		spec_writer_stop(making->writer, &error);
	spec_packer_close(packer);
	free(room);
}

/* Makes and writes all lines, to the settings' output; after an error nothing is left. */
static inline enum spec_status
making_write(struct making *making, struct spec_error *error)
{
	const struct spec_settings *settings = making->settings;
	struct spec_output output;
	enum spec_status status = spec_output_open(&output, settings->output, error);

	if (status != SPEC_OK)
		return status;
	status = spec_writer_open(
		&making->writer, making->image, &output, settings->compression, error);
	if (status == SPEC_OK)
		status = spec_parallel_run(settings->threads, making_work, making, error);
	if (status == SPEC_OK)
		status = spec_writer_finish(making->writer, error);
	spec_writer_close(making->writer);
	if (status == SPEC_OK)
		return spec_output_commit(&output, error);
	spec_output_abandon(&output);
	return status;
}

/* spec:bins: half-way between the wavelengths, and as far beyond the first and the last. */
static inline enum spec_status
making_set_bins(
	struct spec_image *image, const struct spec_grid *grid, struct spec_error *error)
{
	const double *wavelength_nm = grid->wavelength_nm;
	size_t count = grid->count;
	double *edges_nm = spec_memory_new(count + 1, sizeof *edges_nm, "edges", error);
	enum spec_status status;

	if (!edges_nm)
		return SPEC_ENOMEM;
	for (size_t i = 1; i < count; i++)
		edges_nm[i] = (wavelength_nm[i - 1] + wavelength_nm[i]) / 2;
	edges_nm[0] = wavelength_nm[0] - (count > 1 ? edges_nm[1] - wavelength_nm[0] : 0.5);
	edges_nm[count] = 2 * wavelength_nm[count - 1] -
			  (count > 1 ? edges_nm[count - 1] : edges_nm[0]);
	status = spec_image_set_bins(image, edges_nm, count, error);
	free(edges_nm);
	return status;
}

/* The first output of Vigna's generator for a state; see synthesize.c. */
static inline uint64_t
making_splitmix(uint64_t state)
{
	uint64_t z = state + 0x9e3779b97f4a7c15U;

	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
	z = (z ^ z >> 27) * 0x94d049bb133111ebU;
	return z ^ z >> 31;
}

#endif
