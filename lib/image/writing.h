/* Inside writer.c and packer.c alone: what writers and packers hold. */
#ifndef SPEC_IMAGE_WRITING_H
#define SPEC_IMAGE_WRITING_H

#include <libdeflate.h>
#include <openexr.h>
#include <pthread.h>

#include "base/parallel.h"
#include "image/writer.h"

/* A chunk that is being put together. */
struct spec_slot {
	int index; /* of the chunk, or -1: free */
	int missing;
	unsigned char *raw;
};

struct spec_writer {
	exr_context_t context;
	const struct spec_image *image;
	struct spec_output *output;
	struct spec_output scratch; /* where compressed chunks wait for a pipe */
	int streaming, scratched, compression;
	int chunk_lines;
	size_t line_bytes;
	size_t *offset;
	int direct; /* planes can lie in the chunk itself */
	/* The stream's chunk table, predicted: it comes before the chunks. */
	uint64_t *table;
	uint64_t table_at;
	size_t chunks;
	pthread_mutex_t lock; /* guards slot */
	struct spec_slot *slot;
	size_t slots, slot_room;
	unsigned long long overflows; /* of the packers that are closed */
	struct spec_turnstile turnstile;
};

struct spec_packer {
	struct spec_writer *writer;
	exr_encode_pipeline_t pipeline;
	int started;
	struct libdeflate_compressor *compressor;
	const void *
		chunk; /* encoded: in the pipeline or, where that is no smaller, the slot */
	size_t chunk_bytes;
	unsigned long long overflows; /* samples that HALF could not hold */
	float **plane;
	float *row; /* where planes do not lie in the chunk */
};

/* Lines of a chunk: the last may have fewer. */
int spec_writing_lines(const struct spec_writer *writer, int index);

#endif
