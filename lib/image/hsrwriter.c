/* Writing Radiance's spectral pictures; hsrreader.c says what they are. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/text.h"
#include "image/hsr.h"
#include "image/writing.h"

#define LEAST_BANDS 4 /* three bands are another format, with runs of pixels */

/* Where Radiance divides red from green and green from blue, if the range holds both. */
#define RED_FROM_NM 588
#define BLUE_TO_NM 480

struct hsr_packer {
	struct spec_packer base;
	unsigned char *pixels;
};

static enum spec_status
fail(const struct spec_writer *writer, const char *what, struct spec_error *error)
{
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"%s: a picture of Radiance's holds %s", writer->path, what);
}

/* The width of the bands, which must all have it; 0: they have not. */
static double
find_step(const struct spec_image *image)
{
	double first = image->wavelength_nm[0],
	       last = image->wavelength_nm[image->bands - 1];
	double step = (last - first) / (double)(image->bands - 1);

	for (size_t i = 0; i < image->bands; i++) {
		double middle = first + step * (double)i;

		if (fabs(image->wavelength_nm[i] - middle) > 1e-3 * step)
			return 0;
		if (image->edges_nm &&
			(fabs(image->edges_nm[i] - (middle - step / 2)) > 1e-3 * step ||
				fabs(image->edges_nm[i + 1] - (middle + step / 2)) >
					1e-3 * step))
			return 0;
	}
	return step;
}

static enum spec_status
check_image(const struct spec_writer *writer, double *step_nm, struct spec_error *error)
{
	const struct spec_image *image = writer->image;
	char *quantity;
	int density;

	if (image->bands < LEAST_BANDS || image->role != SPEC_ROLE_EMISSIVE)
		return fail(writer, "radiance in four bands or more", error);
	if (spec_writing_only_bands(writer, "a picture of Radiance's", error) != SPEC_OK)
		return SPEC_EUNSUPPORTED;
	*step_nm = find_step(image);
	if (*step_nm == 0)
		return fail(writer, "bands of one width, side by side (--grid)", error);
	quantity = spec_image_quantity(image, error);
	if (!quantity)
		return SPEC_ENOMEM;
	density = strstr(quantity, "per band") == NULL;
	free(quantity);
	return density ? SPEC_OK : fail(writer, "radiance per nm, not per band", error);
}

/* A line of text that comes from an attribute; what the header says itself is left out. */
static void
write_line(FILE *file, const char *line, size_t length)
{
	static const char *const own[] = {
		"#?", "FORMAT=", "NCOMP=", "WAVELENGTH_SPLITS=", "EXPOSURE=", "PIXASPECT="};

	for (size_t i = 0; i < sizeof own / sizeof *own; i++)
		if (strncmp(line, own[i], strlen(own[i])) == 0)
			return;
	if (length > 0) /* an empty line would end the header */
		fprintf(file, "%.*s\n", (int)length, line);
}

/*
 * Lines that came from such a picture, in which an exposure was divided out, and our
 * history, which is commands as Radiance's own tools add them.
 */
static enum spec_status
write_kept(FILE *file, const struct spec_image *image, struct spec_error *error)
{
	static const char *const names[] = {"radiance:header", "spec:history"};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < 2 && status == SPEC_OK; i++) {
		char *text;

		status = spec_image_text(image, names[i], &text, error);
		for (const char *line = text; line && *line;) {
			size_t length = strcspn(line, "\n");

			write_line(file, line, length);
			line += length + (line[length] == '\n');
		}
		free(text);
	}
	return status;
}

static enum spec_status
write_header(FILE *file, const struct spec_image *image, double step_nm,
	struct spec_error *error)
{
	double longest_nm = image->wavelength_nm[image->bands - 1] + step_nm / 2,
	       shortest_nm = image->wavelength_nm[0] - step_nm / 2,
	       third_nm = (longest_nm - shortest_nm) / 3;
	int usual = shortest_nm < BLUE_TO_NM && longest_nm > RED_FROM_NM;
	enum spec_status status;

	fputs("#?RADIANCE\n", file);
	status = write_kept(file, image, error);
	if (image->pixel_aspect_ratio != 1)
		fprintf(file, "PIXASPECT=%.9g\n", 1 / (double)image->pixel_aspect_ratio);
	fprintf(file, "NCOMP=%zu\nWAVELENGTH_SPLITS= %.9g %.9g %.9g %.9g\n", image->bands,
		longest_nm, usual ? RED_FROM_NM : longest_nm - third_nm,
		usual ? BLUE_TO_NM : shortest_nm + third_nm, shortest_nm);
	fprintf(file, "FORMAT=Radiance_spectra\n\n-Y %zu +X %zu\n",
		spec_window_height(&image->data), spec_window_width(&image->data));
	return status;
}

static enum spec_status
open_writer(struct spec_writer *writer, struct spec_error *error)
{
	struct spec_text text = {0};
	double step_nm = 0;
	enum spec_status status = check_image(writer, &step_nm, error);

	if (status == SPEC_OK && writer->output->terminal)
		status = spec_error_set(error, SPEC_EUSAGE,
			"refusing to write an image to a terminal; use -o FILE or a pipe");
	if (status == SPEC_OK)
		status = spec_text_open(&text, error);
	if (status == SPEC_OK)
		status = write_header(text.stream, writer->image, step_nm, error);
	if (status == SPEC_OK)
		status = spec_text_close(&text, error);
	if (status == SPEC_OK)
		status = spec_output_write(writer->output, text.bytes, text.size, error);
	spec_text_free(&text);
	return status;
}

static enum spec_status
open_packer(struct spec_packer *base, struct spec_error *error)
{
	struct hsr_packer *packer = (struct hsr_packer *)base;
	const struct spec_image *image = base->writer->image;

	packer->pixels = spec_memory_new(
		spec_window_width(&image->data), image->bands + 1, "bytes", error);
	return packer->pixels ? SPEC_OK : SPEC_ENOMEM;
}

static void
close_packer(struct spec_packer *packer)
{
	free(((struct hsr_packer *)packer)->pixels);
}

/* One pixel, from the longest wavelength on. Returns 0 where a value is none that it holds. */
static int
encode_pixel(const struct spec_packer *packer, size_t x, unsigned char *pixel)
{
	const struct spec_image *image = packer->writer->image;
	size_t bands = image->bands;
	double most = 0, factor;
	int exponent;

	for (size_t band = 0; band < bands; band++) {
		double value = packer->plane[image->band_channel[band]][x] * HSR_RANGE_NM;

		if (!(value >= 0) || !(value < 0x1p127))
			return 0;
		most = value > most ? value : most;
	}
	memset(pixel, 0, bands + 1);
	frexp(most, &exponent);
	if (exponent + HSR_EXPONENT_EXCESS < 1)
		return 1;
	factor = ldexp(1, 8 - exponent);
	pixel[bands] = (unsigned char)(exponent + HSR_EXPONENT_EXCESS);
	for (size_t band = 0; band < bands; band++)
		pixel[bands - 1 - band] =
			(unsigned char)(packer->plane[image->band_channel[band]][x] *
					HSR_RANGE_NM * factor);
	return 1;
}

static enum spec_status
encode(struct spec_packer *base, int index, unsigned char *raw, struct spec_error *error)
{
	struct hsr_packer *packer = (struct hsr_packer *)base;
	const struct spec_writer *writer = base->writer;
	size_t width = spec_window_width(&writer->image->data),
	       bytes = writer->image->bands + 1;

	(void)raw;
	for (size_t x = 0; x < width; x++) {
		if (!encode_pixel(base, x, packer->pixels + x * bytes))
			return spec_error_set(error, SPEC_ERANGE,
				"%s: pixel %zu,%d is negative, too large or no number, which "
				"a picture of Radiance's cannot hold (--clamp)",
				writer->path, x, index);
	}
	base->chunk = packer->pixels;
	base->chunk_bytes = width * bytes;
	return SPEC_OK;
}

const struct spec_writing_format spec_writing_hsr = {
	.name = "hsr",
	.suffixes = ".hsr",
	.own_samples = 1,
	.writer_bytes = sizeof(struct spec_writer),
	.packer_bytes = sizeof(struct hsr_packer),
	.open = open_writer,
	.open_packer = open_packer,
	.encode = encode,
	.write = spec_writing_append,
	.close_packer = close_packer,
};
