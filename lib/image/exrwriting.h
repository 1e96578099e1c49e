/* Inside exrwriter.c and exrpacker.c alone: OpenEXR's writers and packers. */
#ifndef SPEC_IMAGE_EXRWRITING_H
#define SPEC_IMAGE_EXRWRITING_H

#include <libdeflate.h>
#include <openexr.h>

#include "base/output.h"
#include "image/writing.h"

struct exr_writer {
	struct spec_writer base;
	exr_context_t context;
	struct spec_output scratch; /* where compressed chunks wait for a pipe */
	int streaming, scratched;
	/* The stream's chunk table, predicted: it comes before the chunks. */
	uint64_t *table;
	uint64_t table_at;
};

struct exr_packer {
	struct spec_packer base;
	exr_encode_pipeline_t pipeline;
	int started;
	struct libdeflate_compressor *compressor;
};

static inline struct exr_writer *
exr_writer_of(const struct exr_packer *packer)
{
	return (struct exr_writer *)packer->base.writer;
}

/* The functions of spec_writing_exr that exrpacker.c holds. */
enum spec_status exr_open_packer(struct spec_packer *packer, struct spec_error *error);
enum spec_status exr_encode(struct spec_packer *packer, int index, unsigned char *raw,
	struct spec_error *error);
enum spec_status exr_write(struct spec_packer *packer, int index, struct spec_error *error);
void exr_close_packer(struct spec_packer *packer);

#endif
