/*
 * Writing ENVI files: raw floats, and a text header beside them. The suffix of the output
 * says the interleave: .bsq, .bil or .bip; NAME.hdr makes NAME.img, and that, as any other
 * name, is BIL.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/path.h"
#include "base/text.h"
#include "image/description.h"
#include "image/enviheader.h"
#include "image/samples.h"
#include "image/writing.h"
#include "spectrum/spd.h"

struct envi_writer {
	struct spec_writer base;
	struct spec_output data, header;
	int data_open, header_open;
	char *data_path, *header_path;
	enum envi_interleave interleave;
};

/* ---- names ---- */

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
	int header = spec_path_has_suffix(path, ".hdr");
	int bsq = spec_path_has_suffix(path, ".bsq"),
	    bip = spec_path_has_suffix(path, ".bip");
	int data = bsq || bip || spec_path_has_suffix(path, ".bil") ||
		   spec_path_has_suffix(path, ".img");

	if (strcmp(path, "-") == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"an ENVI image is two files, and cannot go to standard output (-o "
			"FILE.hdr)");
	writer->interleave = bsq ? ENVI_BSQ : bip ? ENVI_BIP : ENVI_BIL;
	writer->header_path = make_path(path, header || data ? 4 : 0, ".hdr", error);
	writer->data_path =
		header ? make_path(path, 4, ".img", error) : make_path(path, 0, "", error);
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

/* Texts of ours, and those that came from an ENVI file, where a brace would end the value. */
static void
write_attributes(FILE *file, const struct spec_image *image)
{
	for (size_t i = 0; i < image->attributes; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];
		const char *name = attribute->name, *value = (const char *)attribute->value;

		if (strcmp(attribute->type, "string") != 0 || strpbrk(name, "=\n{};") ||
			strcmp(name, "spec:quantity") == 0 ||
			strcmp(name, "envi:data units") == 0)
			continue;
		if (strncmp(name, "spec:", 5) == 0) {
			fprintf(file, "%s = {", name);
			envi_text_write(file, value, attribute->size);
			fputs("}\n", file);
		} else if (strncmp(name, "envi:", 5) == 0 &&
			   !memchr(value, '}', attribute->size)) {
			fprintf(file, "%s = {%.*s}\n", name + 5, (int)attribute->size,
				value);
		}
	}
}

/* Where the image lies, as far as it is not where one that says nothing does. */
static void
write_place(FILE *file, const struct spec_image *image)
{
	const struct spec_window *data = &image->data, *display = &image->display;
	char text[SPEC_DESCRIPTION_WINDOW], number[SPEC_SPD_NUMBER];

	fprintf(file, "x start = %d\ny start = %d\n", data->x0 + 1, data->y0 + 1);
	spec_description_window(text, display);
	if (memcmp(data, display, sizeof *data) != 0)
		fprintf(file, "spec:display window = {%s}\n", text);
	spec_spd_format_number(image->pixel_aspect_ratio, number);
	if (image->pixel_aspect_ratio != 1)
		fprintf(file, "spec:pixel aspect = %s\n", number);
}

static void
write_header(FILE *file, const struct envi_writer *writer, const char *quantity,
	long long samples)
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
	write_place(file, image);
	fputs("data units = {", file);
	envi_text_write(file, quantity, strlen(quantity));
	fputs("}\nspec:quantity = {", file);
	envi_text_write(file, quantity, strlen(quantity));
	fputs("}\nwavelength units = Nanometers\n", file);
	write_list(file, "wavelength", image->wavelength_nm, image->bands);
	if (samples > 0)
		fprintf(file, "spec:samples = %lld\n", samples);
	write_attributes(file, image);
}

static enum spec_status
save_header(struct envi_writer *writer, struct spec_error *error)
{
	struct spec_text text = {0};
	char *quantity = spec_image_quantity(writer->base.image, error);
	long long samples = 0;
	enum spec_status status = quantity ? spec_samples_get(writer->base.image, &samples,
						     writer->base.path, error)
					   : SPEC_ENOMEM;

	if (status == SPEC_OK)
		status = spec_text_open(&text, error);
	if (status == SPEC_OK) {
		write_header(text.stream, writer, quantity, samples);
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
	if (status == SPEC_OK && writer->interleave == ENVI_BSQ)
		base->chunk_lines = spec_writing_plane_lines(base);
	return status == SPEC_OK ? save_header(writer, error) : status;
}

static enum spec_status
encode(struct spec_packer *base, int index, unsigned char *raw, struct spec_error *error)
{
	struct spec_sample_packer *packer = (struct spec_sample_packer *)base;
	const struct envi_writer *writer = (const struct envi_writer *)base->writer;

	(void)error;
	base->chunk = packer->samples; /* of as many bytes */
	if (writer->interleave == ENVI_BIP)
		spec_writing_by_pixel(base->writer, raw, packer->samples);
	else
		spec_writing_by_band(base->writer, index, raw, packer->samples);
	return SPEC_OK;
}

static enum spec_status
write_chunk(struct spec_packer *packer, int index, struct spec_error *error)
{
	struct envi_writer *writer = (struct envi_writer *)packer->writer;
	const struct spec_image *image = writer->base.image;
	size_t width = spec_window_width(&image->data) * sizeof(float),
	       height = spec_window_height(&image->data),
	       first = (size_t)index * (size_t)writer->base.chunk_lines,
	       lines = (size_t)spec_writing_lines(&writer->base, index);
	enum spec_status status = SPEC_OK;

	if (writer->interleave != ENVI_BSQ)
		return spec_output_write(
			&writer->data, packer->chunk, packer->chunk_bytes, error);
	for (size_t band = 0; band < image->bands && status == SPEC_OK; band++)
		status = spec_output_write_at(&writer->data,
			(const char *)packer->chunk + band * lines * width, lines * width,
			(int64_t)((band * height + first) * width), error);
	return status;
}

/* Both or none: a header without its data would be worse than nothing. */
static enum spec_status
commit(struct spec_writer *base, struct spec_error *error)
{
	struct envi_writer *writer = (struct envi_writer *)base;
	struct spec_output *both[] = {&writer->data, &writer->header};

	writer->data_open = writer->header_open = 0;
	return spec_output_commit_all(both, 2, error);
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
	.packer_bytes = sizeof(struct spec_sample_packer),
	.makes_files = 1,
	.own_samples = 1,
	.open = open_writer,
	.open_packer = spec_sample_packer_open,
	.encode = encode,
	.write = write_chunk,
	.commit = commit,
	.close_packer = spec_sample_packer_close,
	.close = close_writer,
};
