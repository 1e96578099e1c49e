/*
 * Writing ENVI files: raw floats, and a text header beside them. The suffix of the output
 * says the interleave: .bsq, .bil or .bip; NAME.hdr makes NAME.img, and that, as any other
 * name, is BIL.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/text.h"
#include "image/enviheader.h"
#include "image/writing.h"
#include "spectrum/spd.h"

struct envi_writer {
	struct spec_writer base;
	struct spec_output data, header;
	int data_open, header_open;
	char *data_path, *header_path;
	enum envi_interleave interleave;
};

struct envi_packer {
	struct spec_packer base;
	float *line; /* the bands of a line in the file's order, or null: they lie so */
};

/* ---- names ---- */

static int
ends_in(const char *path, const char *suffix)
{
	size_t length = strlen(path), tail = strlen(suffix);

	return length > tail && strcasecmp(path + length - tail, suffix) == 0;
}

/* path without its last cut bytes, and suffix behind. */
static char *
make_path(const char *path, size_t cut, const char *suffix, struct spec_error *error)
{
	size_t length = strlen(path) - cut, tail = strlen(suffix);
	char *made = spec_memory_new(length + tail + 1, 1, "bytes", error);

	if (made) {
		memcpy(made, path, length);
		memcpy(made + length, suffix, tail);
	}
	return made;
}

static enum spec_status
name_files(struct envi_writer *writer, struct spec_error *error)
{
	const char *path = writer->base.path;
	size_t suffix = ends_in(path, ".img") || ends_in(path, ".bsq") ||
					ends_in(path, ".bil") || ends_in(path, ".bip") ||
					ends_in(path, ".hdr")
				? 4
				: 0;

	if (strcmp(path, "-") == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"an ENVI image is two files, and cannot go to standard output (-o "
			"FILE.hdr)");
	writer->interleave = ends_in(path, ".bsq")   ? ENVI_BSQ
			     : ends_in(path, ".bip") ? ENVI_BIP
						     : ENVI_BIL;
	writer->header_path = make_path(path, suffix, ".hdr", error);
	writer->data_path = ends_in(path, ".hdr") ? make_path(path, 4, ".img", error)
						  : make_path(path, 0, "", error);
	return writer->header_path && writer->data_path ? SPEC_OK : SPEC_ENOMEM;
}

/* ---- what the header says ---- */

static void
write_list(FILE *file, const char *key, const double *number, size_t count)
{
	char text[SPEC_SPD_NUMBER];

	fprintf(file, "%s = {", key);
	for (size_t i = 0; i < count; i++) {
		spec_spd_format_number(number[i], text);
		fprintf(file, "%s%s", i > 0 ? (i % 8 ? ", " : ",\n ") : "", text);
	}
	fputs("}\n", file);
}

/* Texts of ours and those that came from an ENVI file; a brace would end the value. */
static void
write_attributes(FILE *file, const struct spec_image *image)
{
	for (size_t i = 0; i < image->attributes; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];
		int ours = strncmp(attribute->name, "spec:", 5) == 0,
		    theirs = strncmp(attribute->name, "envi:", 5) == 0;

		if ((!ours && !theirs) || strcmp(attribute->type, "string") != 0 ||
			memchr(attribute->value, '}', attribute->size) ||
			strchr(attribute->name, '='))
			continue;
		fprintf(file, "%s = {%.*s}\n", attribute->name + (theirs ? 5 : 0),
			(int)attribute->size, (const char *)attribute->value);
	}
}

static void
write_header(FILE *file, const struct envi_writer *writer, const char *quantity)
{
	static const char *const names[] = {"bsq", "bil", "bip"};
	const struct spec_image *image = writer->base.image;

	fprintf(file, "ENVI\nsamples = %zu\nlines = %zu\nbands = %zu\n",
		spec_window_width(&image->data), spec_window_height(&image->data),
		image->bands);
	fprintf(file,
		"header offset = 0\nfile type = ENVI Standard\ndata type = %d\n"
		"interleave = %s\nbyte order = %d\n",
		ENVI_F32, names[writer->interleave],
		__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
	fprintf(file, "x start = %d\ny start = %d\n", image->data.x0 + 1,
		image->data.y0 + 1);
	fprintf(file, "data units = {%s}\nwavelength units = Nanometers\n", quantity);
	write_list(file, "wavelength", image->wavelength_nm, image->bands);
	write_attributes(file, image);
}

static enum spec_status
save_header(struct envi_writer *writer, struct spec_error *error)
{
	struct spec_text text = {0};
	char *quantity = spec_image_quantity(writer->base.image, error);
	enum spec_status status = quantity ? spec_text_open(&text, error) : SPEC_ENOMEM;

	if (status == SPEC_OK) {
		write_header(text.stream, writer, quantity);
		status = spec_text_close(&text, error);
	}
	if (status == SPEC_OK)
		status = spec_output_write(&writer->header, text.bytes, text.size, error);
	spec_text_free(&text);
	free(quantity);
	return status;
}

/* ---- the writer ---- */

static enum spec_status
open_writer(struct spec_writer *base, struct spec_error *error)
{
	struct envi_writer *writer = (struct envi_writer *)base;
	enum spec_status status = spec_writing_only_bands(base, "ENVI", error);

	if (status == SPEC_OK)
		status = name_files(writer, error);
	if (status == SPEC_OK)
		status = spec_output_open(&writer->header, writer->header_path, error);
	writer->header_open = status == SPEC_OK;
	if (status == SPEC_OK)
		status = spec_output_open(&writer->data, writer->data_path, error);
	writer->data_open = status == SPEC_OK;
	if (status == SPEC_OK && writer->interleave == ENVI_BSQ && !writer->data.seekable)
		status = spec_error_set(error, SPEC_EUSAGE,
			"%s: bands one after the other need a regular file (.bil, .bip)",
			writer->data_path);
	return status == SPEC_OK ? save_header(writer, error) : status;
}

static enum spec_status
open_packer(struct spec_packer *base, struct spec_error *error)
{
	struct envi_packer *packer = (struct envi_packer *)base;
	const struct spec_image *image = base->writer->image;

	packer->line = spec_memory_aligned(spec_window_width(&image->data) * image->bands,
		sizeof(float), "samples", error);
	return packer->line ? SPEC_OK : SPEC_ENOMEM;
}

static void
close_packer(struct spec_packer *packer)
{
	free(((struct envi_packer *)packer)->line);
}

/* The bands by wavelength: channels lie in the order of their names. */
static enum spec_status
encode(struct spec_packer *base, int index, unsigned char *raw, struct spec_error *error)
{
	struct envi_packer *packer = (struct envi_packer *)base;
	const struct envi_writer *writer = (const struct envi_writer *)base->writer;
	const struct spec_image *image = base->writer->image;
	size_t width = spec_window_width(&image->data), bands = image->bands;

	(void)index;
	(void)raw;
	(void)error;
	for (size_t band = 0; band < bands; band++) {
		const float *from = base->plane[image->band_channel[band]];

		if (writer->interleave != ENVI_BIP)
			memcpy(packer->line + band * width, from, width * sizeof *from);
		for (size_t x = 0; writer->interleave == ENVI_BIP && x < width; x++)
			packer->line[x * bands + band] = from[x];
	}
	base->chunk = packer->line;
	base->chunk_bytes = width * bands * sizeof(float);
	return SPEC_OK;
}

static enum spec_status
write_line(struct spec_packer *packer, int index, struct spec_error *error)
{
	struct envi_writer *writer = (struct envi_writer *)packer->writer;
	const struct spec_image *image = writer->base.image;
	size_t bytes = spec_window_width(&image->data) * sizeof(float);
	enum spec_status status = SPEC_OK;

	if (writer->interleave != ENVI_BSQ)
		return spec_output_write(
			&writer->data, packer->chunk, packer->chunk_bytes, error);
	for (size_t band = 0; band < image->bands && status == SPEC_OK; band++)
		status = spec_output_write_at(&writer->data,
			(const char *)packer->chunk + band * bytes, bytes,
			(int64_t)((band * spec_window_height(&image->data) +
					  (size_t)index) *
				  bytes),
			error);
	return status;
}

/* The data first: a header without them would be worse. */
static enum spec_status
commit(struct spec_writer *base, struct spec_error *error)
{
	struct envi_writer *writer = (struct envi_writer *)base;
	enum spec_status status = spec_output_commit(&writer->data, error);

	writer->data_open = 0;
	if (status != SPEC_OK)
		return status;
	writer->header_open = 0;
	return spec_output_commit(&writer->header, error);
}

static void
close_writer(struct spec_writer *base)
{
	struct envi_writer *writer = (struct envi_writer *)base;

	if (writer->data_open)
		spec_output_abandon(&writer->data);
	if (writer->header_open)
		spec_output_abandon(&writer->header);
	free(writer->data_path);
	free(writer->header_path);
}

const struct spec_writing_format spec_writing_envi = {
	.name = "envi",
	.suffixes = ".hdr .img .bsq .bil .bip",
	.writer_bytes = sizeof(struct envi_writer),
	.packer_bytes = sizeof(struct envi_packer),
	.makes_files = 1,
	.open = open_writer,
	.open_packer = open_packer,
	.encode = encode,
	.write = write_line,
	.commit = commit,
	.close_packer = close_packer,
	.close = close_writer,
};
