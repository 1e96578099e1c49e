#include "image/picture.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/path.h"
#include "image/encoder.h"

#define COUNT(list) (sizeof(list) / sizeof *(list))
#define MOST_SIDE ((size_t)1 << 30)

/* What a suffix stands for: the samples by bits, the usual ones first. */
struct format {
	const char *suffix;
	enum spec_picture_format format;
	int bits[4]; /* ends with 0 */
	int floats;  /* the fewest bits that are floats */
};

static const struct format formats[] = {
	{"png", SPEC_PICTURE_PNG, {8, 16, 0}, 32},
	{"ppm", SPEC_PICTURE_PPM, {8, 16, 0}, 32},
	{"pnm", SPEC_PICTURE_PPM, {8, 16, 0}, 32},
	{"exr", SPEC_PICTURE_EXR, {32, 16, 0}, 16},
	{"tif", SPEC_PICTURE_PLUGIN, {8, 16, 32, 0}, 32},
	{"tiff", SPEC_PICTURE_PLUGIN, {8, 16, 32, 0}, 32},
	{"hdr", SPEC_PICTURE_PLUGIN, {32, 0}, 32},
	{"rgbe", SPEC_PICTURE_PLUGIN, {32, 0}, 32},
};

/* Other suffixes that OpenImageIO takes for TIFF and JPEG. */
static const char *const with_profile[] = {
	"tif", "tiff", "tx", "jpg", "jpeg", "jpe", "jif", "jfif", "jfi"};

static const struct format other = {"", SPEC_PICTURE_PLUGIN, {8, 0}, 32};

static const struct format *
find_format(const char *suffix)
{
	for (size_t i = 0; i < COUNT(formats); i++) {
		if (strcmp(formats[i].suffix, suffix) == 0)
			return &formats[i];
	}
	return &other;
}

/* The format's name, or else the last suffix of path, in lower case. */
static enum spec_status
take_suffix(const char *path, const char *format, char *suffix, size_t room,
	struct spec_error *error)
{
	const char *dot = format ? format : spec_path_suffix(path),
		   *name = format || !*dot ? dot : dot + 1;
	size_t length = (size_t)snprintf(suffix, room, "%s", name);

	if (length == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"unable to write '%s': no suffix that names a picture format, such "
			"as .png",
			path);
	if (length >= room)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"unable to write '%s': no picture format for '.%s'", path, name);
	for (; *suffix; suffix++)
		*suffix = (char)tolower((unsigned char)*suffix);
	return SPEC_OK;
}

static enum spec_status
settle_bits(const struct format *format, const char *path, int bits,
	struct spec_picture_kind *kind, struct spec_error *error)
{
	int held = bits == 0;

	if (bits != 0 && bits != 8 && bits != 16 && bits != 32)
		return spec_error_set(error, SPEC_EUSAGE,
			"bits per sample must be 8, 16 or 32, not %d", bits);
	for (size_t i = 0; format->bits[i]; i++)
		held |= format->bits[i] == bits;
	if (!held)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"unable to write '%s': .%s cannot hold %d bits per sample", path,
			kind->suffix, bits);
	if (bits == 0)
		bits = format->bits[0];
	kind->format = format->format;
	kind->half = bits == 16 && format->floats == 16;
	kind->sample = bits >= format->floats ? SPEC_PICTURE_FLOAT
		       : bits == 16           ? SPEC_PICTURE_U16
					      : SPEC_PICTURE_U8;
	return SPEC_OK;
}

enum spec_status
spec_picture_choose(const char *path, const char *format, int bits,
	struct spec_picture_kind *kind, struct spec_error *error)
{
	enum spec_status status;

	*kind = (struct spec_picture_kind){0};
	if (strcmp(path, "-") == 0) {
		path = "<stdout>";
		format = format ? format : "png";
	}
	status = take_suffix(path, format, kind->suffix, sizeof kind->suffix, error);
	if (status == SPEC_OK && find_format(kind->suffix) == &other)
		status = spec_plugin_knows(kind->suffix, path, error);
	if (status == SPEC_OK)
		status = settle_bits(find_format(kind->suffix), path, bits, kind, error);
	/* Asked last for the formats of the list, since the answer costs 0.2 s. */
	if (status == SPEC_OK && kind->format == SPEC_PICTURE_PLUGIN &&
		find_format(kind->suffix) != &other)
		status = spec_plugin_knows(kind->suffix, path, error);
	return status;
}

size_t
spec_picture_sample_bytes(enum spec_picture_sample sample)
{
	return sample == SPEC_PICTURE_U8 ? 1 : sample == SPEC_PICTURE_U16 ? 2 : 4;
}

static int
is_at(const double xy[2], const double other_xy[2])
{
	return xy[0] == other_xy[0] && xy[1] == other_xy[1];
}

/* What readers take for granted: of whole numbers sRGB, of floats its primaries. */
static int
is_usual(const struct spec_picture_kind *kind, const struct spec_space *space)
{
	const struct spec_space *usual = spec_space_find("srgb", NULL);

	return is_at(space->red_xy, usual->red_xy) &&
	       is_at(space->green_xy, usual->green_xy) &&
	       is_at(space->blue_xy, usual->blue_xy) &&
	       is_at(space->white_xy, usual->white_xy) &&
	       (kind->sample == SPEC_PICTURE_FLOAT || space->transfer == usual->transfer);
}

int
spec_picture_tells_space(
	const struct spec_picture_kind *kind, const struct spec_space *space)
{
	if (kind->format == SPEC_PICTURE_PNG || kind->format == SPEC_PICTURE_EXR)
		return 1;
	for (size_t i = 0; i < COUNT(with_profile); i++)
		if (strcmp(kind->suffix, with_profile[i]) == 0)
			return 1;
	return is_usual(kind, space);
}

static const struct spec_picture_encoder *
find_encoder(enum spec_picture_format format)
{
	switch (format) {
	case SPEC_PICTURE_PNG:
		return &spec_picture_encoder_png;
	case SPEC_PICTURE_PPM:
		return &spec_picture_encoder_ppm;
	case SPEC_PICTURE_EXR:
		return &spec_picture_encoder_exr;
	case SPEC_PICTURE_PLUGIN:
		break;
	}
	return &spec_picture_encoder_plugin;
}

static enum spec_status
check_size(const struct spec_output *output, size_t width, size_t height,
	struct spec_error *error)
{
	if (width == 0 || height == 0)
		return spec_error_set(error, SPEC_ERANGE,
			"unable to write '%s': the picture has no pixels", output->path);
	if (width > MOST_SIDE || height > MOST_SIDE ||
		width > SPEC_PICTURE_MOST_PIXELS / height)
		return spec_error_set(error, SPEC_ERANGE,
			"unable to write '%s': %zu x %zu pixels are more than %zu",
			output->path, width, height, SPEC_PICTURE_MOST_PIXELS);
	return SPEC_OK;
}

enum spec_status
spec_picture_open(struct spec_picture **result, const struct spec_picture_kind *kind,
	struct spec_output *output, size_t width, size_t height,
	const struct spec_space *space, struct spec_error *error)
{
	struct spec_picture *picture;
	enum spec_status status = check_size(output, width, height, error);

	*result = NULL;
	if (status != SPEC_OK)
		return status;
	if (space && space->coordinates != SPEC_COORDINATES_RGB &&
		kind->format != SPEC_PICTURE_EXR)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"unable to write '%s': only OpenEXR (.exr) holds %s", output->path,
			space->title);
	if (output->terminal)
		return spec_error_set(error, SPEC_EUSAGE,
			"refusing to write a picture to a terminal; use -o FILE or a pipe");
	picture = spec_memory_new(1, sizeof *picture, "pictures", error);
	if (!picture)
		return SPEC_ENOMEM;
	picture->encoder = find_encoder(kind->format);
	picture->kind = *kind;
	picture->output = output;
	picture->space = space;
	picture->width = width;
	picture->height = height;
	status = picture->encoder->open(picture, error);
	if (status != SPEC_OK) {
		spec_picture_close(picture);
		return status;
	}
	*result = picture;
	return SPEC_OK;
}

/* Keeps the first failure, and hands it to the caller. */
static enum spec_status
hand_over(struct spec_picture *picture, enum spec_status status, struct spec_error *error)
{
	if (status != SPEC_OK) {
		picture->failure.status = status;
		if (error)
			*error = picture->failure;
	}
	return status;
}

enum spec_status
spec_picture_write(struct spec_picture *picture, const void *rows, size_t count,
	struct spec_error *error)
{
	struct spec_error *failure = &picture->failure;
	enum spec_status status = failure->status;

	if (status == SPEC_OK && count > picture->height - picture->done)
		status = spec_error_set(failure, SPEC_EUSAGE,
			"unable to write '%s': more than %zu rows", picture->output->path,
			picture->height);
	if (status == SPEC_OK && count > 0)
		status = picture->encoder->write(picture, rows, count, failure);
	if (status == SPEC_OK)
		picture->done += count;
	return hand_over(picture, status, error);
}

enum spec_status
spec_picture_finish(struct spec_picture *picture, struct spec_error *error)
{
	struct spec_error *failure = &picture->failure;
	enum spec_status status = failure->status;

	if (status == SPEC_OK && picture->done != picture->height)
		status = spec_error_set(failure, SPEC_EUSAGE,
			"unable to write '%s': %zu of %zu rows were given",
			picture->output->path, picture->done, picture->height);
	if (status == SPEC_OK)
		status = picture->encoder->finish(picture, failure);
	return hand_over(picture, status, error);
}

unsigned long long
spec_picture_overflows(const struct spec_picture *picture)
{
	return picture->overflows;
}

void
spec_picture_close(struct spec_picture *picture)
{
	if (!picture)
		return;
	picture->encoder->close(picture);
	free(picture);
}

enum spec_status
spec_picture_file_open(struct spec_picture_file *file, const char *path,
	const struct spec_picture_kind *kind, size_t width, size_t height,
	const struct spec_space *space, struct spec_error *error)
{
	enum spec_status status = spec_output_open(&file->output, path, error);

	if (status != SPEC_OK)
		return status;
	status = spec_picture_open(
		&file->picture, kind, &file->output, width, height, space, error);
	return status == SPEC_OK ? SPEC_OK : spec_picture_file_end(file, status, error);
}

enum spec_status
spec_picture_file_end(
	struct spec_picture_file *file, enum spec_status status, struct spec_error *error)
{
	spec_picture_close(file->picture);
	if (status == SPEC_OK)
		return spec_output_commit(&file->output, error);
	spec_output_abandon(&file->output);
	return status;
}
