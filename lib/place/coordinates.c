#include "place/coordinates.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "image/plugin.h"
#include "place/places.h"
#include "place/spelling.h"

static enum spec_status
load(const struct spec_places **places, struct spec_error *error)
{
	const void *table = NULL;
	enum spec_status status =
		spec_plugin_find("places.so", SPEC_PLACES_SYMBOL, &table, error);

	*places = table;
	if (status == SPEC_OK && (*places)->version != SPEC_PLACES_VERSION)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"the plugin places.so is of another version of spectools");
	return status;
}

enum spec_status
spec_place_check(const struct spec_place *place, struct spec_error *error)
{
	if (!(fabs(place->latitude_deg) <= 90))
		return spec_error_set(error, SPEC_ERANGE,
			"a latitude is from -90 to 90 degrees, not %g",
			place->latitude_deg);
	if (!(fabs(place->longitude_deg) <= 180))
		return spec_error_set(error, SPEC_ERANGE,
			"a longitude is from -180 to 180 degrees, not %g",
			place->longitude_deg);
	if (!(place->altitude_m >= SPEC_PLACE_LOWEST_M &&
		    place->altitude_m <= SPEC_PLACE_HIGHEST_M))
		return spec_error_set(error, SPEC_ERANGE,
			"an altitude is from %g m to %g m, not %g m", SPEC_PLACE_LOWEST_M,
			SPEC_PLACE_HIGHEST_M, place->altitude_m);
	return SPEC_OK;
}

/* GeographicLib tells some causes on several lines: the first says what is wrong. */
static enum spec_status
refuse(const char *text, struct spec_error *cause, struct spec_error *error)
{
	cause->message[strcspn(cause->message, "\n")] = '\0';
	return spec_error_set(
		error, cause->status, "'%s' is no place: %s", text, cause->message);
}

enum spec_status
spec_place_parse(const char *text, struct spec_place *place, struct spec_error *error)
{
	const struct spec_places *places;
	struct spec_error cause = {0};
	char spelt[SPEC_SPELLING_LONGEST];
	enum spec_status status = load(&places, error);

	if (status != SPEC_OK)
		return status;
	*place = (struct spec_place){0};
	status = spec_spelling_part(text, spelt, &place->altitude_m, error);
	if (status != SPEC_OK)
		return status;
	status = places->parse(spelt, place, &cause);
	if (status == SPEC_EUSAGE && spec_spelling_join(spelt))
		status = places->parse(spelt, place, &cause);
	if (status != SPEC_OK && spec_spelling_is_half(spelt))
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is half a place: a latitude and a longitude make one", text);
	if (status != SPEC_OK)
		return refuse(text, &cause, error);
	status = spec_place_check(place, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "'%s'", text);
	return status;
}

enum spec_status
spec_place_format(const struct spec_place *place, enum spec_place_form form,
	char written[SPEC_PLACE_WRITTEN], struct spec_error *error)
{
	const struct spec_places *places;
	enum spec_status status = load(&places, error);

	if (status == SPEC_OK)
		status = spec_place_check(place, error);
	return status == SPEC_OK
		       ? places->format(place, form, written, SPEC_PLACE_WRITTEN, error)
		       : status;
}

void
spec_place_brief(const struct spec_place *place, char written[SPEC_PLACE_WRITTEN])
{
	(void)snprintf(written, SPEC_PLACE_WRITTEN, "%.7g %c %.7g %c",
		fabs(place->latitude_deg), place->latitude_deg < 0 ? 'S' : 'N',
		fabs(place->longitude_deg), place->longitude_deg < 0 ? 'W' : 'E');
}

enum spec_status
spec_place_to_earth(const struct spec_place *place, double xyz_m[3], double axes[9],
	struct spec_error *error)
{
	const struct spec_places *places;
	enum spec_status status = load(&places, error);

	if (status == SPEC_OK)
		status = spec_place_check(place, error);
	return status == SPEC_OK ? places->to_earth(place, xyz_m, axes, error) : status;
}

enum spec_status
spec_place_from_earth(
	const double xyz_m[3], struct spec_place *place, struct spec_error *error)
{
	const struct spec_places *places;
	enum spec_status status = load(&places, error);

	if (status == SPEC_OK)
		status = places->from_earth(xyz_m, place, error);
	return status == SPEC_OK ? spec_place_check(place, error) : status;
}

enum spec_status
spec_place_to_local(const struct spec_place *origin, const struct spec_place *place,
	double east_north_up_m[3], struct spec_error *error)
{
	const struct spec_places *places;
	enum spec_status status = load(&places, error);

	if (status == SPEC_OK)
		status = spec_place_check(origin, error);
	if (status == SPEC_OK)
		status = spec_place_check(place, error);
	return status == SPEC_OK ? places->to_local(origin, place, east_north_up_m, error)
				 : status;
}

enum spec_status
spec_place_from_local(const struct spec_place *origin, const double east_north_up_m[3],
	struct spec_place *place, struct spec_error *error)
{
	const struct spec_places *places;
	enum spec_status status = load(&places, error);

	if (status == SPEC_OK)
		status = spec_place_check(origin, error);
	if (status == SPEC_OK)
		status = places->from_local(origin, east_north_up_m, place, error);
	return status == SPEC_OK ? spec_place_check(place, error) : status;
}

enum spec_status
spec_place_geodesic(const struct spec_place *from, const struct spec_place *to,
	struct spec_geodesic *way, struct spec_error *error)
{
	const struct spec_places *places;
	enum spec_status status = load(&places, error);

	if (status == SPEC_OK)
		status = spec_place_check(from, error);
	if (status == SPEC_OK)
		status = spec_place_check(to, error);
	return status == SPEC_OK ? places->geodesic(from, to, way, error) : status;
}

enum spec_status
spec_place_onwards(const struct spec_place *from, double bearing_deg, double distance_m,
	struct spec_place *to, struct spec_error *error)
{
	const struct spec_places *places;
	enum spec_status status = load(&places, error);

	if (status == SPEC_OK)
		status = spec_place_check(from, error);
	if (status == SPEC_OK && !(isfinite(bearing_deg) && isfinite(distance_m)))
		return spec_error_set(error, SPEC_ERANGE,
			"a way has a bearing and a distance that are numbers");
	if (status != SPEC_OK)
		return status;
	to->altitude_m = from->altitude_m;
	return places->onwards(from, bearing_deg, distance_m, to, error);
}
