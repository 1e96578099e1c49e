/* PNG by libpng (https://www.w3.org/TR/2003/REC-PNG-20031110/). */
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/profile.h"
#include "image/encoder.h"

/*
 * 1920 x 1080 x 8 bit: level 1 with SUB takes 0.08 s, the library's defaults (level 6,
 * filter chosen row by row) 0.71 s.
 */
#define LEVEL 1
#define FILTER PNG_FILTER_SUB
#define GAMMA_SRGB 45455      /* of the file, times 100000: what PNG says of sRGB */
#define CHUNK_BYTES (1 << 20) /* of IDAT: three writes each */

struct state {
	png_structp png;
	png_infop info;
	struct spec_picture *picture;
	unsigned char *profile; /* or null */
	size_t profile_bytes;
	struct spec_error error;
	jmp_buf escape; /* set by guard alone */
};

struct rows {
	const unsigned char *first;
	size_t count;
};

/* libpng must not get control back from here. */
static void
fail(png_structp png, png_const_charp message)
{
	struct state *state = png_get_error_ptr(png);

	if (state->error.status == SPEC_OK)
		spec_error_set(&state->error, SPEC_EFORMAT,
			"unable to write '%s': libpng: %s", state->picture->output->path,
			message);
	longjmp(state->escape, 1);
}

/* The library never prints, and a warning while writing asks nothing of the user. */
static void
warn(png_structp png, png_const_charp message)
{
	(void)png;
	(void)message;
}

static void
write_bytes(png_structp png, png_bytep bytes, size_t size)
{
	struct state *state = png_get_io_ptr(png);

	if (spec_output_write(state->picture->output, bytes, size, &state->error) !=
		SPEC_OK)
		png_error(png, "write");
}

static void
flush(png_structp png)
{
	(void)png;
}

/*
 * Runs a step of calls to libpng; its errors come back as a status. A step must own
 * nothing, since it may never return.
 */
static enum spec_status
guard(struct state *state, void (*step)(struct state *state, const struct rows *rows),
	const struct rows *rows, struct spec_error *error)
{
	if (setjmp(state->escape) == 0) {
		step(state, rows);
		return SPEC_OK;
	}
	if (error)
		*error = state->error;
	return state->error.status;
}

static int
is_inside(const double xy[2])
{
	return xy[0] >= 0 && xy[1] >= 0 && xy[0] + xy[1] <= 1;
}

#define LEAST_SHARE .001 /* of a primary in white's luminance that cHRM can tell */

/* libpng refuses primaries outside x, y, 1 - x - y >= 0, and white outside of them. */
static int
fits_chromaticities(const struct spec_space *space)
{
	double m[9];

	return is_inside(space->red_xy) && is_inside(space->green_xy) &&
	       is_inside(space->blue_xy) && is_inside(space->white_xy) &&
	       spec_space_to_xyz(space, m, NULL) == SPEC_OK && m[3] > LEAST_SHARE &&
	       m[4] > LEAST_SHARE && m[5] > LEAST_SHARE;
}

/* Times 100000; 0 where the function is not near a power. */
static png_fixed_point
gamma_of(const struct spec_transfer *transfer)
{
	if (!transfer)
		return PNG_FP_1;
	if (transfer == &spec_transfer_srgb)
		return GAMMA_SRGB;
	if (transfer->offset != 0)
		return 0;
	return (png_fixed_point)(PNG_FP_1 * transfer->power + .5);
}

static int
is_srgb(const struct spec_space *space)
{
	return strcmp(space->name, "srgb") == 0 && space->transfer == &spec_transfer_srgb;
}

/*
 * The sRGB chunk says all; other spaces are told by a profile, and for readers without
 * profiles by gAMA and cHRM, as far as they can be.
 */
static void
say_space(struct state *state)
{
	const struct spec_space *space = state->picture->space;
	png_fixed_point gamma;

	if (!space)
		return;
	if (is_srgb(space)) {
		png_set_sRGB_gAMA_and_cHRM(
			state->png, state->info, PNG_sRGB_INTENT_RELATIVE);
		return;
	}
	gamma = gamma_of(space->transfer);
	if (gamma > 0)
		png_set_gAMA_fixed(state->png, state->info, gamma);
	/* Not of ACES2065-1 and ACEScg, whose primaries are no colours. */
	if (fits_chromaticities(space))
		png_set_cHRM(state->png, state->info, space->white_xy[0],
			space->white_xy[1], space->red_xy[0], space->red_xy[1],
			space->green_xy[0], space->green_xy[1], space->blue_xy[0],
			space->blue_xy[1]);
	if (state->profile)
		png_set_iCCP(state->png, state->info, space->title,
			PNG_COMPRESSION_TYPE_BASE, state->profile,
			(png_uint_32)state->profile_bytes);
}

/*
 * By hand, since libpng 1.6 writes no such chunk before 1.6.45: primaries, transfer, no
 * matrix, full range (PNG, third edition, 2025, 11.3.2.6). It comes before PLTE and IDAT.
 */
static void
write_code_points(struct state *state)
{
	const struct spec_space *space = state->picture->space;
	const struct spec_transfer *transfer;
	png_byte code[4] = {0, 0, 0, 1};

	if (!space || is_srgb(space))
		return;
	transfer = space->transfer ? space->transfer : &spec_transfer_linear;
	code[0] = (png_byte)space->cicp;
	code[1] = (png_byte)transfer->cicp;
	if (code[0] && code[1])
		png_write_chunk(state->png, (png_const_bytep) "cICP", code, sizeof code);
}

static void
begin(struct state *state, const struct rows *rows)
{
	const struct spec_picture *picture = state->picture;
	int wide = picture->kind.sample == SPEC_PICTURE_U16;

	(void)rows;
	state->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, state, fail, warn);
	if (state->png)
		state->info = png_create_info_struct(state->png);
	if (!state->info) {
		spec_error_set(&state->error, SPEC_ENOMEM, "out of memory for libpng");
		longjmp(state->escape, 1);
	}
	png_set_write_fn(state->png, state, write_bytes, flush);
	png_set_user_limits(state->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
	png_set_compression_level(state->png, LEVEL);
	png_set_compression_buffer_size(state->png, CHUNK_BYTES);
	png_set_filter(state->png, PNG_FILTER_TYPE_BASE, FILTER);
	png_set_IHDR(state->png, state->info, (png_uint_32)picture->width,
		(png_uint_32)picture->height, wide ? 16 : 8, PNG_COLOR_TYPE_RGB,
		PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	say_space(state);
	png_write_info_before_PLTE(state->png, state->info);
	write_code_points(state);
	png_write_info(state->png, state->info);
	if (wide && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__)
		png_set_swap(state->png);
}

static void
put_rows(struct state *state, const struct rows *rows)
{
	const struct spec_picture *picture = state->picture;
	size_t stride =
		picture->width * 3 * spec_picture_sample_bytes(picture->kind.sample);

	for (size_t i = 0; i < rows->count; i++)
		png_write_row(state->png, rows->first + i * stride);
}

static void
end(struct state *state, const struct rows *rows)
{
	(void)rows;
	png_write_end(state->png, NULL);
}

static enum spec_status
open_png(struct spec_picture *picture, struct spec_error *error)
{
	struct state *state = spec_memory_new(1, sizeof *state, "pictures", error);
	enum spec_status status = SPEC_OK;

	if (!state)
		return SPEC_ENOMEM;
	state->picture = picture;
	picture->state = state;
	if (picture->space && !is_srgb(picture->space))
		status = spec_profile_make(picture->space, picture->space->transfer,
			&state->profile, &state->profile_bytes, error);
	return status == SPEC_OK ? guard(state, begin, NULL, error) : status;
}

static enum spec_status
write_png(struct spec_picture *picture, const void *rows, size_t count,
	struct spec_error *error)
{
	return guard(picture->state, put_rows, &(struct rows){rows, count}, error);
}

static enum spec_status
finish_png(struct spec_picture *picture, struct spec_error *error)
{
	return guard(picture->state, end, NULL, error);
}

static void
close_png(struct spec_picture *picture)
{
	struct state *state = picture->state;

	if (!state)
		return;
	png_destroy_write_struct(&state->png, &state->info);
	free(state->profile);
	free(state);
}

const struct spec_picture_encoder spec_picture_encoder_png = {
	open_png, write_png, finish_png, close_png};
