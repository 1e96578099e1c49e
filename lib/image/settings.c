#include "image/settings.h"

#include <openexr.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "base/parallel.h"
#include "image/given.h"

void
spec_settings_init(struct spec_settings *settings)
{
	*settings = (struct spec_settings){
		.limits = {.pixels = 1LL << 30,
			.channels = 32767,
			.attributes = 16384,
			.header = 64LL << 20,
			.memory = 4LL << 30},
		.output = "-",
		.compression = -1,
		.threads = spec_parallel_processors(),
		.read_as = SPEC_ROLE_OTHER,
		.history = 1,
	};
}

static enum spec_status
take_limit(struct spec_limits *limits, const char *text, struct spec_error *error)
{
	const struct {
		const char *name;
		long long *value;
	} known[] = {{"pixels", &limits->pixels}, {"channels", &limits->channels},
		{"attributes", &limits->attributes}, {"header", &limits->header},
		{"memory", &limits->memory}};
	size_t length = strcspn(text, "=");

	for (size_t i = 0; text[length] && i < sizeof known / sizeof known[0]; i++) {
		if (strlen(known[i].name) == length &&
			memcmp(known[i].name, text, length) == 0)
			return spec_number_parse_bytes(
				text + length + 1, "the limit", known[i].value, error);
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"'%s' is not pixels=N, channels=N, attributes=N, header=BYTES or memory=BYTES",
		text);
}

static const struct {
	const char *name;
	int number;
} compressions[] = {{"none", EXR_COMPRESSION_NONE}, {"rle", EXR_COMPRESSION_RLE},
	{"zips", EXR_COMPRESSION_ZIPS}, {"zip", EXR_COMPRESSION_ZIP},
	{"piz", EXR_COMPRESSION_PIZ}, {"pxr24", EXR_COMPRESSION_PXR24},
	{"b44", EXR_COMPRESSION_B44}, {"b44a", EXR_COMPRESSION_B44A}};

enum { COMPRESSIONS = sizeof compressions / sizeof compressions[0] };

enum spec_status
spec_settings_record(const struct spec_settings *settings, struct spec_image *image,
	struct spec_error *error)
{
	return settings->history ? spec_image_add_history(
					   image, settings->argc, settings->argv, error)
				 : SPEC_OK;
}

enum spec_status
spec_settings_compression(const char *name, int *compression, struct spec_error *error)
{
	for (size_t i = 0; i < COMPRESSIONS; i++) {
		if (strcmp(name, compressions[i].name) == 0) {
			*compression = compressions[i].number;
			return SPEC_OK;
		}
	}
	if (strcmp(name, "dwaa") == 0 || strcmp(name, "dwab") == 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s compression is not in this version of OpenEXRCore", name);
	return spec_error_set(error, SPEC_EUSAGE,
		"unknown compression '%s' (none rle zips zip piz pxr24 b44 b44a)", name);
}

const char *
spec_settings_compression_name(int compression)
{
	for (size_t i = 0; i < COMPRESSIONS; i++) {
		if (compressions[i].number == compression)
			return compressions[i].name;
	}
	return NULL;
}

enum spec_status
spec_settings_take(struct spec_settings *settings, const char *name, const char *value,
	int *known, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*known = 1;
	if (strcmp(name, "output") == 0) {
		settings->output = value;
	} else if (strcmp(name, "threads") == 0) {
		status = spec_number_parse_int(
			value, 1, 256, "the number of threads", &settings->threads, error);
	} else if (strcmp(name, "part") == 0) {
		settings->part = value;
	} else if (strcmp(name, "name-map") == 0) {
		settings->name_map = value;
	} else if (strcmp(name, "wavelengths") == 0) {
		settings->wavelengths = value;
	} else if (strcmp(name, "read-as") == 0) {
		status = spec_given_role(value, &settings->read_as, error);
	} else if (strcmp(name, "compression") == 0) {
		status = spec_settings_compression(value, &settings->compression, error);
	} else if (strcmp(name, "half") == 0) {
		settings->half = 1;
	} else if (strcmp(name, "limit") == 0) {
		status = take_limit(&settings->limits, value, error);
	} else if (strcmp(name, "no-history") == 0) {
		settings->history = 0;
	} else if (strcmp(name, "progress") == 0) {
		settings->progress = 1;
	} else if (strcmp(name, "quiet") == 0) {
		settings->quiet = 1;
	} else {
		*known = 0;
	}
	return status;
}

enum spec_status
spec_settings_crop(const char *text, struct spec_window *crop, struct spec_error *error)
{
	int *corner[] = {&crop->x0, &crop->y0, &crop->x1, &crop->y1};
	char part[32];

	for (size_t i = 0; i < 4; i++) {
		size_t length = strcspn(text, ",");
		enum spec_status status;

		snprintf(part, sizeof part, "%.*s",
			(int)(length < sizeof part ? length : sizeof part - 1), text);
		if ((text[length] == ',') != (i < 3))
			return spec_error_set(
				error, SPEC_EUSAGE, "the crop is not X0,Y0,X1,Y1");
		status = spec_number_parse_int(
			part, 0, 1 << 30, "the crop", corner[i], error);
		if (status != SPEC_OK)
			return status;
		text += length + (i < 3);
	}
	return SPEC_OK;
}
