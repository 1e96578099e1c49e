/* Putting lines into chunks, encoding and writing them in order. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/codec.h"
#include "image/exr.h"
#include "image/half.h"
#include "image/writing.h"

#define DEFLATE_LEVEL 4 /* libdeflate; measured: 6 takes half as long again for 1 % */

enum spec_status
spec_packer_open(
	struct spec_packer **result, struct spec_writer *writer, struct spec_error *error)
{
	struct spec_packer *packer = spec_memory_new(1, sizeof *packer, "packers", error);
	size_t channels = writer->image->channels;
	size_t width = spec_window_width(&writer->image->data);

	*result = packer;
	if (!packer)
		return SPEC_ENOMEM;
	packer->writer = writer;
	packer->plane = spec_memory_new(channels, sizeof *packer->plane, "channels", error);
	packer->compressor = libdeflate_alloc_compressor(DEFLATE_LEVEL);
	if (!writer->direct)
		packer->row = spec_memory_aligned(
			width * channels, sizeof(float), "samples", error);
	if (!packer->plane || !packer->compressor || (!writer->direct && !packer->row)) {
		spec_packer_close(packer);
		*result = NULL;
		return spec_error_set(error, SPEC_ENOMEM, "out of memory for a packer");
	}
	for (size_t i = 0; i < channels && packer->row; i++)
		packer->plane[i] = packer->row + i * width;
	return SPEC_OK;
}

void
spec_packer_close(struct spec_packer *packer)
{
	if (!packer)
		return;
	if (packer->started) {
		packer->pipeline.packed_buffer = NULL; /* a slot's */
		packer->pipeline.packed_alloc_size = 0;
		exr_encoding_destroy(packer->writer->context, &packer->pipeline);
	}
	if (packer->compressor)
		libdeflate_free_compressor(packer->compressor);
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

/* The lines lie packed already; the pipeline only wants to be told so. */
static exr_result_t
pack_nothing(exr_encode_pipeline_t *pipeline)
{
	pipeline->packed_bytes = pipeline->packed_alloc_size;
	return EXR_ERR_SUCCESS;
}

static exr_result_t
start_pipeline(struct spec_packer *packer, const exr_chunk_info_t *info)
{
	exr_const_context_t context = packer->writer->context;
	exr_encode_pipeline_t *pipeline = &packer->pipeline;
	int compression = packer->writer->compression;
	exr_result_t result;

	if (packer->started) {
		result = exr_encoding_update(context, 0, info, pipeline);
	} else {
		result = exr_encoding_initialize(context, 0, info, pipeline);
		if (result != EXR_ERR_SUCCESS)
			return result;
		packer->started = 1;
		result = exr_encoding_choose_default_routines(context, 0, pipeline);
		pipeline->convert_and_pack_fn = pack_nothing;
		pipeline->yield_until_ready_fn = NULL;
		pipeline->write_fn = NULL;
		if (compression == EXR_COMPRESSION_ZIP ||
			compression == EXR_COMPRESSION_ZIPS) {
			pipeline->compress_fn = spec_codec_deflate;
			pipeline->encoding_user_data = packer->compressor;
		}
	}
	for (int i = 0; i < pipeline->channel_count; i++) {
		exr_coding_channel_info_t *channel = &pipeline->channels[i];

		channel->user_data_type = channel->data_type;
		channel->user_bytes_per_element = channel->bytes_per_element;
		channel->encode_from_ptr =
			(const uint8_t *)""; /* not read: it must not be null */
	}
	return result;
}

/* Encodes a chunk: packer->chunk is what is to be written. */
static exr_result_t
encode(struct spec_packer *packer, int index, unsigned char *raw)
{
	struct spec_writer *writer = packer->writer;
	exr_encode_pipeline_t *pipeline = &packer->pipeline;
	int y = writer->image->data.y0 + index * writer->chunk_lines;
	size_t size = writer->line_bytes * spec_writing_lines(writer, index);
	exr_chunk_info_t info;
	exr_result_t result;

	packer->chunk = raw;
	packer->chunk_bytes = size;
	if (writer->compression == EXR_COMPRESSION_NONE)
		return EXR_ERR_SUCCESS;
	result = exr_write_scanline_chunk_info(writer->context, 0, y, &info);
	if (result == EXR_ERR_SUCCESS)
		result = start_pipeline(packer, &info);
	if (result != EXR_ERR_SUCCESS)
		return result;
	if (info.unpacked_size != size)
		return EXR_ERR_INVALID_ARGUMENT; /* the library would free raw to make room */
	pipeline->packed_buffer = raw;
	pipeline->packed_alloc_size = size;
	result = exr_encoding_run(writer->context, 0, pipeline);
	pipeline->packed_buffer = NULL;
	pipeline->packed_alloc_size = 0;
	/* What does not shrink is stored: readers tell it by its size. */
	if (pipeline->compressed_bytes < size) {
		packer->chunk = pipeline->compressed_buffer;
		packer->chunk_bytes = pipeline->compressed_bytes;
	}
	return result;
}

static enum spec_status
write_chunk(struct spec_packer *packer, int index, struct spec_error *error)
{
	struct spec_writer *writer = packer->writer;
	int y = writer->image->data.y0 + index * writer->chunk_lines;
	exr_result_t result;

	if (!spec_turnstile_enter(&writer->turnstile, index))
		return spec_turnstile_status(&writer->turnstile, error);
	spec_exr_forget();
	result = exr_write_scanline_chunk(
		writer->context, 0, y, packer->chunk, packer->chunk_bytes);
	if (result != EXR_ERR_SUCCESS || spec_exr_has_note()) {
		struct spec_error own;
		enum spec_status status =
			spec_exr_error(result, writer->output->path, &own);

		spec_turnstile_stop(&writer->turnstile, &own);
		if (error)
			*error = own;
		return status;
	}
	spec_turnstile_leave(&writer->turnstile);
	return SPEC_OK;
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
	enum spec_status status;
	exr_result_t result;
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
	spec_exr_forget();
	result = encode(packer, index, raw);
	status = result == EXR_ERR_SUCCESS
			 ? write_chunk(packer, index, error)
			 : spec_exr_error(result, writer->output->path, error);
	pthread_mutex_lock(&writer->lock);
	find_slot(writer, index, NULL)->index = -1;
	pthread_mutex_unlock(&writer->lock);
	return status;
}
