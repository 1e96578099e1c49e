#include "place/placed.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/writer.h"
#include "image/writing.h"

/* A float attribute; *there: the image has it. */
static enum spec_status
take_number(const struct spec_image *image, const char *file, const char *name,
	double *value, int *there, struct spec_error *error)
{
	const struct spec_attribute *attribute = spec_image_attribute(image, name);
	float number;

	*there = attribute != NULL;
	if (!attribute)
		return SPEC_OK;
	if (strcmp(attribute->type, "float") != 0 || attribute->size != sizeof number)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: its attribute %s is of type %s, not float", file, name,
			attribute->type);
	memcpy(&number, attribute->value, sizeof number);
	*value = number;
	return SPEC_OK;
}

static enum spec_status
take_place(const struct spec_image *image, const char *file, struct spec_place *place,
	struct spec_error *error)
{
	int longitude, latitude, altitude;
	enum spec_status status;

	*place = (struct spec_place){0};
	status = take_number(
		image, file, "longitude", &place->longitude_deg, &longitude, error);
	if (status == SPEC_OK)
		status = take_number(
			image, file, "latitude", &place->latitude_deg, &latitude, error);
	if (status == SPEC_OK)
		status = take_number(
			image, file, "altitude", &place->altitude_m, &altitude, error);
	if (status != SPEC_OK)
		return status;
	if (!longitude || !latitude)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: does not say where it was taken: it has no attribute %s", file,
			longitude ? "latitude" : "longitude");
	status = spec_place_check(place, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s", file);
	return status;
}

/* "2003:10:17 12:30:30", as OpenEXR has it, and nothing else. */
static int
scan_date(const char *text, struct spec_reading *reading)
{
	static const char form[] = "dddd:dd:dd dd:dd:dd";

	for (size_t i = 0; i < sizeof form; i++) {
		if (form[i] == 'd' ? text[i] < '0' || text[i] > '9' : text[i] != form[i])
			return 0;
	}
	reading->year = atoi(text);
	reading->month = atoi(text + 5);
	reading->day = atoi(text + 8);
	reading->hour = atoi(text + 11);
	reading->minute = atoi(text + 14);
	reading->second = atoi(text + 17);
	return 1;
}

static enum spec_status
take_date(const struct spec_image *image, const char *file, struct spec_reading *reading,
	struct spec_error *error)
{
	char *text = NULL;
	enum spec_status status = spec_image_text(image, "capDate", &text, error);

	if (status == SPEC_OK && !text)
		status = spec_error_set(error, SPEC_EUSAGE,
			"%s: does not say when it was taken: it has no attribute capDate",
			file);
	else if (status == SPEC_OK && !scan_date(text, reading))
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: its capDate, '%.40s', is not YYYY:MM:DD hh:mm:ss", file, text);
	free(text);
	return status;
}

static enum spec_status
take_instant(const struct spec_image *image, const char *file, struct spec_instant *instant,
	struct spec_error *error)
{
	struct spec_reading reading = {0};
	double offset_s = 0;
	int there;
	enum spec_status status = take_date(image, file, &reading, error);

	if (status == SPEC_OK)
		status = take_number(image, file, "utcOffset", &offset_s, &there, error);
	if (status != SPEC_OK)
		return status;
	if (!there)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: does not say in which zone it was taken: it has no attribute "
			"utcOffset",
			file);
	if (!(fabs(offset_s) <= SPEC_INSTANT_FURTHEST_S))
		return spec_error_set(error, SPEC_ERANGE,
			"%s: its utcOffset is %g s, and none is more than a day", file,
			offset_s);
	reading.offset_s = -(int)lrint(offset_s);
	status = spec_instant_from_reading(&reading, instant, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s: its capDate", file);
	return status;
}

enum spec_status
spec_placed_of_image(const struct spec_image *image, const char *name,
	struct spec_place *place, struct spec_instant *instant, struct spec_error *error)
{
	enum spec_status status = take_place(image, name, place, error);

	return status == SPEC_OK ? take_instant(image, name, instant, error) : status;
}

void
spec_placed_print(FILE *stream, const struct spec_image *image)
{
	struct spec_place place;
	struct spec_instant instant;
	char time[SPEC_INSTANT_WRITTEN], where[SPEC_PLACE_WRITTEN];

	if (spec_placed_of_image(image, "", &place, &instant, NULL) != SPEC_OK)
		return;
	spec_instant_format(&instant, 0, time);
	spec_place_brief(&place, where);
	fprintf(stream, "  %-13s %s at %s", "taken", time, where);
	if (spec_image_attribute(image, "altitude"))
		fprintf(stream, ", %.6g m", place.altitude_m);
	fputc('\n', stream);
}

static enum spec_status
set_number(
	struct spec_image *image, const char *name, double value, struct spec_error *error)
{
	float number = (float)value;

	return spec_image_set_attribute(
		image, name, "float", &number, sizeof number, error);
}

static enum spec_status
set_instant(struct spec_image *image, const struct spec_instant *instant,
	struct spec_error *error)
{
	struct spec_reading reading = spec_instant_reading(instant, 0);
	char date[64];
	enum spec_status status;

	(void)snprintf(date, sizeof date, "%04d:%02d:%02d %02d:%02d:%02.0f", reading.year,
		reading.month, reading.day, reading.hour, reading.minute, reading.second);
	status = spec_image_set_text(image, "capDate", date, error);
	return status == SPEC_OK ? set_number(image, "utcOffset", -reading.offset_s, error)
				 : status;
}

enum spec_status
spec_placed_set(struct spec_image *image, const struct spec_place *place,
	const struct spec_instant *instant, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	if (place)
		status = set_number(image, "longitude", place->longitude_deg, error);
	if (place && status == SPEC_OK)
		status = set_number(image, "latitude", place->latitude_deg, error);
	/* Of a place whose altitude is not known nothing is claimed. */
	if (place && place->altitude_m == 0)
		spec_image_remove_attribute(image, "altitude");
	else if (place && status == SPEC_OK)
		status = set_number(image, "altitude", place->altitude_m, error);
	return instant && status == SPEC_OK ? set_instant(image, instant, error) : status;
}

enum spec_status
spec_placed_take(struct spec_placed *placed, const char *name, const char *value,
	int *known, struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "place") == 0) {
		placed->has_place = 1;
		return spec_place_parse(value, &placed->place, error);
	}
	if (strcmp(name, "time") == 0) {
		placed->has_time = 1;
		return spec_instant_parse(value, &placed->instant, error);
	}
	*known = 0;
	return SPEC_OK;
}

enum spec_status
spec_placed_check(const struct spec_placed *placed, int is_text,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_writing_format *format = &spec_writing_exr;
	enum spec_status status = SPEC_OK;

	if (!placed->has_place && !placed->has_time)
		return SPEC_OK;
	if (!is_text)
		status = spec_writer_choose(
			settings->output, settings->format, &format, error);
	if (status == SPEC_OK && (is_text || format != &spec_writing_exr))
		return spec_error_set(error, SPEC_EUSAGE,
			"only OpenEXR files say where and when they were taken (--place, "
			"--time)");
	return status;
}

enum spec_status
spec_placed_apply(const struct spec_placed *placed, struct spec_image *image,
	struct spec_error *error)
{
	return spec_placed_set(image, placed->has_place ? &placed->place : NULL,
		placed->has_time ? &placed->instant : NULL, error);
}
