/* Putting lines into chunks, to be encoded and written in order. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/half.h"
#include "image/writing.h"

enum spec_status
spec_packer_open(
	struct spec_packer **result, struct spec_writer *writer, struct spec_error *error)
{
	const struct spec_writing_format *format = writer->format;
	struct spec_packer *packer =
		spec_memory_new(1, format->packer_bytes, "packers", error);
	size_t channels = writer->image->channels;
	size_t width = spec_window_width(&writer->image->data);
	enum spec_status status = SPEC_OK;

	*result = NULL;
	if (!packer)
		return SPEC_ENOMEM;
	packer->writer = writer;
	packer->plane = spec_memory_new(channels, sizeof *packer->plane, "channels", error);
	if (!writer->direct)
		packer->row = spec_memory_aligned(
			width * channels, sizeof(float), "samples", error);
	if (!packer->plane || (!writer->direct && !packer->row))
		status = SPEC_ENOMEM;
	if (status == SPEC_OK && format->open_packer)
		status = format->open_packer(packer, error);
	if (status != SPEC_OK) {
		spec_packer_close(packer);
		return status;
	}
	for (size_t i = 0; i < channels && packer->row; i++)
		packer->plane[i] = packer->row + i * width;
	*result = packer;
	return SPEC_OK;
}

void
spec_packer_close(struct spec_packer *packer)
{
	if (!packer)
		return;
	if (packer->writer->format->close_packer)
		packer->writer->format->close_packer(packer);
	pthread_mutex_lock(&packer->writer->lock);
	packer->writer->overflows += packer->overflows;
	pthread_mutex_unlock(&packer->writer->lock);
	free(packer->plane);
	free(packer->row);
	free(packer);
}

/* The slot of a chunk, made where there is none yet; only with the lock held. */
static struct spec_slot *
find_slot(struct spec_writer *writer, int index, struct spec_error *error)
{
	struct spec_slot *unused = NULL;
	void *list = writer->slot;

	for (size_t i = 0; i < writer->slots; i++) {
		if (writer->slot[i].index == index)
			return &writer->slot[i];
		if (writer->slot[i].index < 0)
			unused = &writer->slot[i];
	}
	if (!unused) {
		if (spec_memory_grow(&list, &writer->slot_room, writer->slots + 1,
			    sizeof *writer->slot, "chunks", error) != SPEC_OK)
			return NULL;
		writer->slot = list;
		unused = &writer->slot[writer->slots];
		unused->index = -1;
		unused->raw = spec_memory_aligned(
			writer->line_bytes, writer->chunk_lines, "bytes of pixels", error);
		if (!unused->raw)
			return NULL;
		writer->slots++;
	}
	unused->index = index;
	unused->missing = spec_writing_lines(writer, index);
	return unused;
}

/* Where line y lies in its chunk, or null with the error set. */
static unsigned char *
find_line(struct spec_writer *writer, int y, struct spec_error *error)
{
	int line = y - writer->image->data.y0;
	struct spec_slot *slot;
	unsigned char *raw = NULL;

	pthread_mutex_lock(&writer->lock);
	slot = find_slot(writer, line / writer->chunk_lines, error);
	if (slot)
		raw = slot->raw;
	pthread_mutex_unlock(&writer->lock);
	return raw ? raw + line % writer->chunk_lines * writer->line_bytes : NULL;
}

enum spec_status
spec_packer_begin(
	struct spec_packer *packer, int y, float *const **plane, struct spec_error *error)
{
	struct spec_writer *writer = packer->writer;
	unsigned char *raw;

	*plane = packer->plane;
	if (!writer->direct)
		return SPEC_OK;
	raw = find_line(writer, y, error);
	if (!raw)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < writer->image->channels; i++)
		packer->plane[i] = (float *)(void *)(raw + writer->offset[i]);
	return SPEC_OK;
}

static enum spec_status
write_chunk(struct spec_packer *packer, int index, struct spec_error *error)
{
	struct spec_writer *writer = packer->writer;
	struct spec_error own = {0};
	enum spec_status status;

	if (!spec_turnstile_enter(&writer->turnstile, index))
		return spec_turnstile_status(&writer->turnstile, error);
	status = writer->format->write(packer, index, &own);
	if (status == SPEC_OK) {
		spec_turnstile_leave(&writer->turnstile);
		return SPEC_OK;
	}
	spec_turnstile_stop(&writer->turnstile, &own);
	if (error)
		*error = own;
	return status;
}

static void
store_line(struct spec_packer *packer, unsigned char *raw)
{
	const struct spec_writer *writer = packer->writer;
	size_t width = spec_window_width(&writer->image->data);

	for (size_t i = 0; i < writer->image->channels; i++) {
		if (writer->image->channel[i].sample == SPEC_SAMPLE_HALF) {
			spec_half_from_float(
				raw + writer->offset[i], packer->plane[i], width);
			packer->overflows += spec_half_overflows(packer->plane[i], width);
		} else {
			memcpy(raw + writer->offset[i], packer->plane[i],
				width * sizeof(float));
		}
	}
}

enum spec_status
spec_packer_end(struct spec_packer *packer, int y, struct spec_error *error)
{
	struct spec_writer *writer = packer->writer;
	int index = (y - writer->image->data.y0) / writer->chunk_lines;
	unsigned char *raw = writer->direct ? NULL : find_line(writer, y, error);
	enum spec_status status = SPEC_OK;
	struct spec_slot *slot;
	int missing;

	if (raw)
		store_line(packer, raw);
	else if (!writer->direct)
		return SPEC_ENOMEM;
	pthread_mutex_lock(&writer->lock);
	slot = find_slot(writer, index, error);
	missing = --slot->missing; /* it exists: its line was begun */
	raw = slot->raw;
	pthread_mutex_unlock(&writer->lock);
	if (missing > 0)
		return SPEC_OK;
	packer->chunk = raw;
	packer->chunk_bytes = writer->line_bytes * spec_writing_lines(writer, index);
	if (writer->format->encode)
		status = writer->format->encode(packer, index, raw, error);
	if (status == SPEC_OK)
		status = write_chunk(packer, index, error);
	pthread_mutex_lock(&writer->lock);
	find_slot(writer, index, NULL)->index = -1;
	pthread_mutex_unlock(&writer->lock);
	return status;
}

enum spec_status
spec_sample_packer_open(struct spec_packer *base, struct spec_error *error)
{
	struct spec_sample_packer *packer = (struct spec_sample_packer *)base;
	const struct spec_image *image = base->writer->image;

	packer->samples =
		spec_memory_aligned(spec_window_width(&image->data) * image->bands *
					    (size_t)base->writer->chunk_lines,
			sizeof(float), "samples", error);
	return packer->samples ? SPEC_OK : SPEC_ENOMEM;
}

void
spec_sample_packer_close(struct spec_packer *packer)
{
	free(((struct spec_sample_packer *)packer)->samples);
}
