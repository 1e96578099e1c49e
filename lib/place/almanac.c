#include "place/almanac.h"

#include <string.h>

#include "base/number.h"
#include "image/reader.h"
#include "place/placed.h"

static enum spec_status
take_air(struct spec_almanac_request *request, const char *value, struct spec_error *error)
{
	char pressure[64];
	const char *comma = strchr(value, ',');
	enum spec_status status;

	if (!comma || (size_t)(comma - value) >= sizeof pressure)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is not PRESSURE,TEMPERATURE in hPa and degrees Celsius",
			value);
	memcpy(pressure, value, (size_t)(comma - value));
	pressure[comma - value] = '\0';
	request->has_air = 1;
	status = spec_number_parse(pressure, 0, 2000, "the air's pressure in hPa",
		&request->air.pressure_hpa, error);
	return status == SPEC_OK ? spec_number_parse(comma + 1, -150, 150,
					   "the air's temperature in degrees Celsius",
					   &request->air.temperature_c, error)
				 : status;
}

enum spec_status
spec_almanac_take(struct spec_almanac_request *request, const char *name, const char *value,
	int *known, struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "sun") == 0) {
		request->asked = 1;
		request->own = strcmp(value, "own") == 0;
		return request->own ? SPEC_OK
				    : spec_place_parse(value, &request->place, error);
	}
	if (strcmp(name, "time") == 0) {
		request->has_time = 1;
		return spec_instant_parse(value, &request->instant, error);
	}
	if (strcmp(name, "toward") == 0) {
		request->has_target = 1;
		return spec_place_parse(value, &request->target, error);
	}
	if (strcmp(name, "air") == 0)
		return take_air(request, value, error);
	*known = 0;
	return SPEC_OK;
}

enum spec_status
spec_almanac_settle(const struct spec_almanac_request *request, size_t operands,
	struct spec_error *error)
{
	if (!request->asked &&
		(request->has_time || request->has_target || request->has_air))
		return spec_error_set(
			error, SPEC_EUSAGE, "--time, --toward and --air are for --sun");
	if (!request->asked)
		return SPEC_OK;
	if (request->own && request->has_time)
		return spec_error_set(error, SPEC_EUSAGE,
			"--sun own takes the time from the file, too: no --time");
	if (!request->own && !request->has_time)
		return spec_error_set(error, SPEC_EUSAGE,
			"--sun needs a --time, such as 2003-10-17T12:30:30-07:00");
	if (!request->own && operands > 0)
		return spec_error_set(
			error, SPEC_EUSAGE, "--sun PLACE tells of no file; --sun own does");
	return SPEC_OK;
}

static enum spec_status
find_own(struct spec_almanac *almanac, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_reader *reader = NULL;
	enum spec_status status = spec_reader_open(&reader, path, settings, error);

	if (status == SPEC_OK)
		status = spec_placed_of_image(spec_reader_image(reader),
			spec_reader_name(reader), &almanac->place, &almanac->instant,
			error);
	if (status == SPEC_OK)
		status = spec_reader_drain(reader, error);
	spec_reader_close(reader);
	return status;
}

static enum spec_status
find_target(struct spec_almanac *almanac, const struct spec_almanac_request *request,
	struct spec_error *error)
{
	enum spec_status status;

	almanac->has_target = request->has_target;
	almanac->target = request->target;
	if (!request->has_target)
		return SPEC_OK;
	status = spec_place_geodesic(
		&almanac->place, &request->target, &almanac->way, error);
	return status == SPEC_OK ? spec_place_to_local(&almanac->place, &request->target,
					   almanac->east_north_up_m, error)
				 : status;
}

enum spec_status
spec_almanac_find(struct spec_almanac *almanac, const struct spec_almanac_request *request,
	const char *path, const struct spec_settings *settings, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*almanac =
		(struct spec_almanac){.place = request->place, .instant = request->instant};
	if (request->own)
		status = find_own(almanac, path, settings, error);
	if (status != SPEC_OK)
		return status;
	almanac->air = request->has_air ? request->air
					: spec_air_standard(almanac->place.altitude_m);
	status = spec_solar_position(
		&almanac->place, &almanac->instant, &almanac->air, &almanac->solar, error);
	if (status == SPEC_OK)
		status = spec_solar_day(
			&almanac->place, &almanac->instant, &almanac->day, error);
	if (status == SPEC_OK)
		status = spec_place_to_earth(&almanac->place, almanac->xyz_m, NULL, error);
	for (int i = 0; i < SPEC_PLACE_FORMS && status == SPEC_OK; i++)
		status = spec_place_format(&almanac->place, (enum spec_place_form)i,
			almanac->written[i], error);
	return status == SPEC_OK ? find_target(almanac, request, error) : status;
}
