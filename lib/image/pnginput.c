#include "image/pnginput.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/space.h"

#define SIGNATURE_BYTES 8
#define BUFFER_BYTES 65536
#define GAMMA_SRGB (1 / 2.2)
#define GAMMA_SHARE .05 /* nearer than this it is meant to be sRGB, libpng too finds */

/* What numbers from 0 to 1 stand for. */
enum transfer {
	TRANSFER_SRGB,
	TRANSFER_VIDEO, /* of ITU-R BT.709 */
	TRANSFER_POWER  /* 1: they are light itself */
};

struct spec_png {
	png_structp png;
	png_infop info;
	struct spec_source *source;
	int64_t offset; /* of the source's bytes that buffer begins with */
	size_t used, filled;
	struct spec_error error;
	jmp_buf escape; /* set by guard alone */

	int width, height, channels;
	size_t bytes; /* of a sample: 1 or 2 */
	unsigned char *row;
	unsigned char *whole; /* an interlaced picture's rows, or null */
	int begun, next;      /* rows are being read; the one that comes next */
	enum transfer transfer;
	double power;
	int has_primaries;
	float primaries[8];
	float *light; /* of each number, or null: not asked for yet */
	unsigned char buffer[BUFFER_BYTES];
};

/* What a step of calls to libpng works on. */
struct task {
	long long memory; /* that an interlaced picture may take */
};

int
spec_png_recognises(const unsigned char *bytes, size_t size)
{
	return size >= SIGNATURE_BYTES && png_sig_cmp(bytes, 0, SIGNATURE_BYTES) == 0;
}

/* ---- libpng ---- */

/* It must not get control back from here. */
static void
fail(png_structp png, png_const_charp message)
{
	struct spec_png *picture = png_get_error_ptr(png);

	if (picture->error.status == SPEC_OK)
		spec_error_set(
			&picture->error, SPEC_EFORMAT, "damaged: libpng: %s", message);
	longjmp(picture->escape, 1);
}

/* The library never prints; what libpng can read in spite of a warning is read. */
static void
warn(png_structp png, png_const_charp message)
{
	(void)png;
	(void)message;
}

static void
fail_short(struct spec_png *picture)
{
	if (picture->begun)
		spec_error_set(&picture->error, SPEC_EFORMAT,
			"ends early, in line %d of 0..%d", picture->next,
			picture->height - 1);
	else
		spec_error_set(&picture->error, SPEC_EFORMAT, "ends early");
}

static void
take_bytes(png_structp png, png_bytep to, size_t size)
{
	struct spec_png *picture = png_get_io_ptr(png);

	while (size > 0) {
		size_t left = picture->filled - picture->used,
		       part = left < size ? left : size;

		memcpy(to, picture->buffer + picture->used, part);
		picture->used += part;
		to += part;
		size -= part;
		if (size == 0)
			return;
		picture->offset += (int64_t)picture->filled;
		picture->used = picture->filled = 0;
		if (spec_source_read(picture->source, picture->buffer, BUFFER_BYTES,
			    picture->offset, &picture->filled,
			    &picture->error) == SPEC_OK &&
			picture->filled == 0)
			fail_short(picture);
		if (picture->error.status != SPEC_OK)
			png_error(png, "read");
	}
}

/*
 * Runs a step of calls to libpng; its errors come back as a status. A step must own
 * nothing, since it may never return.
 */
static enum spec_status
guard(struct spec_png *picture,
	void (*step)(struct spec_png *picture, const struct task *task),
	const struct task *task, struct spec_error *error)
{
	if (setjmp(picture->escape) == 0) {
		step(picture, task);
		return SPEC_OK;
	}
	if (error)
		*error = picture->error;
	return picture->error.status;
}

static _Noreturn void
refuse(struct spec_png *picture, enum spec_status status, const char *what, int number)
{
	spec_error_set(&picture->error, status, what, number);
	longjmp(picture->escape, 1);
}

/* ---- what numbers stand for ---- */

/* Chromaticities by their numbers in ITU-T H.273 (2021), table 2; false: not known. */
static int
find_primaries(struct spec_png *picture, int number)
{
	static const struct {
		int number;
		float xy[8];
	} known[] = {{5, {.64F, .33F, .29F, .60F, .15F, .06F, .3127F, .3290F}},
		{6, {.630F, .340F, .310F, .595F, .155F, .070F, .3127F, .3290F}},
		{7, {.630F, .340F, .310F, .595F, .155F, .070F, .3127F, .3290F}},
		{9, {.708F, .292F, .170F, .797F, .131F, .046F, .3127F, .3290F}},
		{11, {.680F, .320F, .265F, .690F, .150F, .060F, .314F, .351F}},
		{12, {.680F, .320F, .265F, .690F, .150F, .060F, .3127F, .3290F}}};

	for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
		if (known[i].number == number) {
			memcpy(picture->primaries, known[i].xy, sizeof known[i].xy);
			picture->has_primaries = 1;
			return 1;
		}
	}
	return number == 1 || number == 2; /* sRGB's, and not said */
}

/* Transfer functions by their numbers in ITU-T H.273 (2021), table 3; false: not known. */
static int
find_transfer(struct spec_png *picture, int number)
{
	switch (number) {
	case 1:
	case 6:
	case 14:
	case 15:
		picture->transfer = TRANSFER_VIDEO;
		return 1;
	case 4:
	case 5:
	case 8:
		picture->transfer = TRANSFER_POWER;
		picture->power = number == 4 ? 2.2 : number == 5 ? 2.8 : 1;
		return 1;
	default:
		return number == 2 || number == 13;
	}
}

/* The chunk of four numbers that says all; libpng knows it since 1.6.45 only. */
static int
take_cicp(struct spec_png *picture)
{
	png_unknown_chunkp chunk;
	int count = png_get_unknown_chunks(picture->png, picture->info, &chunk);

	for (int i = 0; i < count; i++) {
		if (memcmp(chunk[i].name, "cICP", 4) != 0 || chunk[i].size != 4)
			continue;
		if (!find_primaries(picture, chunk[i].data[0]))
			refuse(picture, SPEC_EUNSUPPORTED,
				"its colour primaries, number %d of its cICP, are not known",
				chunk[i].data[0]);
		if (!find_transfer(picture, chunk[i].data[1]))
			refuse(picture, SPEC_EUNSUPPORTED,
				"its transfer function, number %d of its cICP, is not read",
				chunk[i].data[1]);
		if (chunk[i].data[2] != 0 || chunk[i].data[3] != 1)
			refuse(picture, SPEC_EUNSUPPORTED,
				"its cICP says that it is no RGB of full range", 0);
		return 1;
	}
	return 0;
}

static void
take_chromaticities(struct spec_png *picture)
{
	static const double srgb[8] = {.64, .33, .30, .60, .15, .06, .3127, .3290};
	double xy[8];

	if (!png_get_cHRM(picture->png, picture->info, &xy[6], &xy[7], &xy[0], &xy[1],
		    &xy[2], &xy[3], &xy[4], &xy[5]))
		return;
	for (int i = 0; i < 8; i++) {
		picture->has_primaries |= fabs(xy[i] - srgb[i]) > 1e-3;
		picture->primaries[i] = (float)xy[i];
	}
}

static void
take_colour(struct spec_png *picture)
{
	double gamma;
	int intent;

	picture->transfer = TRANSFER_SRGB;
	if (take_cicp(picture) || png_get_sRGB(picture->png, picture->info, &intent))
		return;
	take_chromaticities(picture);
	if (!png_get_gAMA(picture->png, picture->info, &gamma) || !(gamma > 0) ||
		fabs(gamma / GAMMA_SRGB - 1) < GAMMA_SHARE)
		return;
	picture->transfer = TRANSFER_POWER;
	picture->power = 1 / gamma;
}

static double
to_light(const struct spec_png *picture, double value)
{
	/* ITU-R BT.709-6 (2015), item 1.2, with the exact numbers of BT.2020. */
	const double alpha = 1.09929682680944, beta = .018053968510807;

	switch (picture->transfer) {
	case TRANSFER_VIDEO:
		return value < 4.5 * beta ? value / 4.5
					  : pow((value + alpha - 1) / alpha, 1 / .45);
	case TRANSFER_POWER:
		return picture->power == 1 ? value : pow(value, picture->power);
	default:
		return spec_srgb_decode(value);
	}
}

static enum spec_status
make_table(struct spec_png *picture, struct spec_error *error)
{
	size_t count = picture->bytes == 1 ? 256 : 65536;

	if (picture->light)
		return SPEC_OK;
	picture->light = spec_memory_new(count, sizeof *picture->light, "numbers", error);
	for (size_t i = 0; picture->light && i < count; i++)
		picture->light[i] =
			(float)to_light(picture, (double)i / (double)(count - 1));
	return picture->light ? SPEC_OK : SPEC_ENOMEM;
}

/* ---- the picture ---- */

static void
begin(struct spec_png *picture, const struct task *task)
{
	static const unsigned char cicp[] = "cICP";
	png_structp png;
	int colour;

	(void)task;
	picture->png = png =
		png_create_read_struct(PNG_LIBPNG_VER_STRING, picture, fail, warn);
	if (png)
		picture->info = png_create_info_struct(png);
	if (!picture->info)
		refuse(picture, SPEC_ENOMEM, "out of memory for libpng", 0);
	png_set_read_fn(png, picture, take_bytes);
	png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
	png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, cicp, 1);
	png_read_info(png, picture->info);
	colour = png_get_color_type(png, picture->info);
	picture->width = (int)png_get_image_width(png, picture->info);
	picture->height = (int)png_get_image_height(png, picture->info);
	picture->bytes = png_get_bit_depth(png, picture->info) == 16 ? 2 : 1;
	picture->channels = colour & PNG_COLOR_MASK_COLOR ? 3 : 1;
	if (colour & PNG_COLOR_MASK_ALPHA ||
		png_get_valid(png, picture->info, PNG_INFO_tRNS))
		picture->channels++;
	take_colour(picture);
}

/* Only now that the caller knows the size is memory taken for rows. */
static void
begin_rows(struct spec_png *picture, const struct task *task)
{
	png_structp png = picture->png;
	size_t bytes = (size_t)picture->width * (size_t)picture->channels * picture->bytes;
	int passes;

	png_set_expand(png);
	if (picture->bytes == 2 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__)
		png_set_swap(png);
	passes = png_set_interlace_handling(png);
	png_read_update_info(png, picture->info);
	if (png_get_rowbytes(png, picture->info) != bytes)
		png_error(png, "its rows have another length");
	picture->begun = 1;
	picture->next = 0;
	if (passes == 1) {
		picture->row = spec_memory_new(bytes, 1, "bytes", &picture->error);
	} else if (bytes > (size_t)task->memory / (size_t)picture->height) {
		spec_error_set(&picture->error, SPEC_ERANGE,
			"is interlaced, and needs more than the limit of %lld bytes of "
			"memory (--limit memory=BYTES)",
			task->memory);
	} else {
		picture->whole = spec_memory_new(
			bytes, (size_t)picture->height, "bytes", &picture->error);
	}
	if (picture->error.status != SPEC_OK)
		png_error(png, "memory");
	for (int pass = 0; picture->whole && pass < passes; pass++)
		for (int y = 0; y < picture->height; y++)
			png_read_row(png, picture->whole + (size_t)y * bytes, NULL);
	if (picture->whole)
		png_read_end(png, NULL);
}

static void
read_row(struct spec_png *picture, const struct task *task)
{
	(void)task;
	png_read_row(picture->png, picture->row, NULL);
	if (++picture->next == picture->height)
		png_read_end(picture->png, NULL); /* it, too, must be whole */
}

static void
drop(struct spec_png *picture)
{
	png_destroy_read_struct(&picture->png, &picture->info, NULL);
	free(picture->row);
	free(picture->whole);
	picture->row = picture->whole = NULL;
	picture->begun = 0;
	picture->offset = 0;
	picture->used = picture->filled = 0;
}

enum spec_status
spec_png_open(struct spec_png **result, struct spec_source *source,
	struct spec_png_content *content, struct spec_error *error)
{
	struct spec_png *picture = spec_memory_new(1, sizeof *picture, "pictures", error);
	enum spec_status status;

	*result = NULL;
	if (!picture)
		return SPEC_ENOMEM;
	picture->source = source;
	spec_source_seal(source);
	status = guard(picture, begin, NULL, error);
	if (status != SPEC_OK) {
		spec_png_close(picture);
		return status;
	}
	*content = (struct spec_png_content){.width = picture->width,
		.height = picture->height,
		.channels = picture->channels,
		.has_primaries = picture->has_primaries};
	memcpy(content->primaries, picture->primaries, sizeof content->primaries);
	*result = picture;
	return SPEC_OK;
}

void
spec_png_close(struct spec_png *picture)
{
	if (!picture)
		return;
	drop(picture);
	free(picture->light);
	free(picture);
}

/* ---- rows ---- */

/* The numbers of a row as floats. */
static void
convert_row(const struct spec_png *picture, const unsigned char *row, int linear, float *to)
{
	size_t count = (size_t)picture->width * (size_t)picture->channels;
	const uint16_t *wide = (const uint16_t *)(const void *)row;
	float most = picture->bytes == 1 ? 255 : 65535;

	for (size_t i = 0; i < count; i++) {
		unsigned number = picture->bytes == 1 ? row[i] : wide[i];

		to[i] = linear ? picture->light[number] : (float)number / most;
	}
	if (!linear || picture->channels % 2 == 1)
		return;
	for (size_t last = (size_t)picture->channels - 1; last < count;
		last += (size_t)picture->channels) {
		float alpha =
			(picture->bytes == 1 ? (float)row[last] : (float)wide[last]) / most;

		for (size_t i = last + 1 - (size_t)picture->channels; i < last; i++)
			to[i] *= alpha;
		to[last] = alpha;
	}
}

static const unsigned char *
take_row(struct spec_png *picture, int y, struct spec_error *error)
{
	if (picture->whole)
		return picture->whole + (size_t)y * (size_t)picture->width *
						(size_t)picture->channels * picture->bytes;
	while (picture->next <= y) {
		if (guard(picture, read_row, NULL, error) != SPEC_OK)
			return NULL;
	}
	return picture->row;
}

enum spec_status
spec_png_read(struct spec_png *picture, int first, int end, int linear, long long memory,
	float *rows, struct spec_error *error)
{
	size_t count = (size_t)picture->width * (size_t)picture->channels;
	struct task task = {.memory = memory};
	enum spec_status status = linear ? make_table(picture, error) : SPEC_OK;

	if (status == SPEC_OK && picture->begun && !picture->whole &&
		first < picture->next) {
		drop(picture); /* from the beginning again, which a pipe refuses */
		status = guard(picture, begin, NULL, error);
	}
	if (status == SPEC_OK && !picture->begun)
		status = guard(picture, begin_rows, &task, error);
	for (int y = first; y < end && status == SPEC_OK; y++, rows += count) {
		const unsigned char *row = take_row(picture, y, error);

		if (!row)
			return picture->error.status;
		convert_row(picture, row, linear, rows);
	}
	return status;
}
