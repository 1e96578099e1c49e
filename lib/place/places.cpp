/* The plugin places.so; places.h is its interface. */
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <GeographicLib/GeoCoords.hpp>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/Math.hpp>

extern "C" {
#include "place/places.h"
}

namespace
{

using GeographicLib::Geocentric;
using GeographicLib::GeoCoords;
using GeographicLib::Geodesic;
using GeographicLib::LocalCartesian;
using GeographicLib::Math;

/* No std::string here: it might throw again. */
enum spec_status
fail(struct spec_error *error, enum spec_status status, const char *cause)
{
	if (error) {
		error->status = status;
		snprintf(error->message, sizeof error->message, "%s", cause);
	}
	return status;
}

/* Runs f; whatever it throws comes back as a status. */
template <typename F>
enum spec_status
guard(struct spec_error *error, F f)
{
	try {
		f();
		return SPEC_OK;
	} catch (const std::bad_alloc &) {
		return fail(error, SPEC_ENOMEM, "out of memory");
	} catch (const std::exception &exception) {
		return fail(error, SPEC_EUSAGE, exception.what());
	} catch (...) {
		return fail(error, SPEC_EUSAGE, "unknown exception");
	}
}

struct angles {
	double latitude_deg, longitude_deg;

	/* Bit by bit, since a place may be read as NaN, which is refused elsewhere. */
	bool
	operator!=(const angles &other) const
	{
		return memcmp(this, &other, sizeof other) != 0;
	}
};

/*
 * What f returns. Where memory fails, streams swallow the exception, and GeographicLib goes
 * on with what they hold: a number that is 0, a text that has lost its end. So only what
 * comes out twice is believed.
 */
template <typename F>
auto
twice(F f) -> decltype(f())
{
	const auto once = f();

	if (once != f())
		throw std::bad_alloc();
	return once;
}

std::string
spelt(const struct spec_place &place, enum spec_place_form form)
{
	const GeoCoords at(place.latitude_deg, place.longitude_deg);

	switch (form) {
	case SPEC_PLACE_DMS:
		return at.DMSRepresentation(1);
	case SPEC_PLACE_UTM:
		return at.UTMUPSRepresentation(0);
	case SPEC_PLACE_MGRS:
		return at.MGRSRepresentation(0);
	default:
		return at.GeoRepresentation(1);
	}
}

double
from_north(double azimuth_deg)
{
	return azimuth_deg < 0 ? azimuth_deg + 360 : azimuth_deg;
}

} // namespace

extern "C" {
static enum spec_status
parse(const char *text, struct spec_place *place, struct spec_error *error)
{
	return guard(error, [&] {
		const auto read = twice([&] {
			const GeoCoords at{std::string(text)};

			return angles{at.Latitude(), at.Longitude()};
		});

		place->latitude_deg = read.latitude_deg;
		place->longitude_deg = Math::AngNormalize(read.longitude_deg);
	});
}

static enum spec_status
format(const struct spec_place *place, enum spec_place_form form, char *written,
	size_t room, struct spec_error *error)
{
	return guard(error, [&] {
		const std::string text = twice([&] { return spelt(*place, form); });

		snprintf(written, room, "%s", text.c_str());
	});
}

static enum spec_status
to_earth(const struct spec_place *place, double xyz_m[3], double axes[9],
	struct spec_error *error)
{
	return guard(error, [&] {
		std::vector<double> m(9);

		Geocentric::WGS84().Forward(place->latitude_deg, place->longitude_deg,
			place->altitude_m, xyz_m[0], xyz_m[1], xyz_m[2], m);
		for (size_t i = 0; i < m.size() && axes; i++)
			axes[i] = m[i];
	});
}

static enum spec_status
from_earth(const double xyz_m[3], struct spec_place *place, struct spec_error *error)
{
	return guard(error, [&] {
		Geocentric::WGS84().Reverse(xyz_m[0], xyz_m[1], xyz_m[2],
			place->latitude_deg, place->longitude_deg, place->altitude_m);
	});
}

static LocalCartesian
around(const struct spec_place *origin)
{
	return LocalCartesian(
		origin->latitude_deg, origin->longitude_deg, origin->altitude_m);
}

static enum spec_status
to_local(const struct spec_place *origin, const struct spec_place *place,
	double east_north_up_m[3], struct spec_error *error)
{
	return guard(error, [&] {
		around(origin).Forward(place->latitude_deg, place->longitude_deg,
			place->altitude_m, east_north_up_m[0], east_north_up_m[1],
			east_north_up_m[2]);
	});
}

static enum spec_status
from_local(const struct spec_place *origin, const double east_north_up_m[3],
	struct spec_place *place, struct spec_error *error)
{
	return guard(error, [&] {
		around(origin).Reverse(east_north_up_m[0], east_north_up_m[1],
			east_north_up_m[2], place->latitude_deg, place->longitude_deg,
			place->altitude_m);
	});
}

static enum spec_status
geodesic(const struct spec_place *from, const struct spec_place *to,
	struct spec_geodesic *way, struct spec_error *error)
{
	return guard(error, [&] {
		Geodesic::WGS84().Inverse(from->latitude_deg, from->longitude_deg,
			to->latitude_deg, to->longitude_deg, way->distance_m,
			way->bearing_deg, way->arrival_deg);
		way->bearing_deg = from_north(way->bearing_deg);
		way->arrival_deg = from_north(way->arrival_deg);
	});
}

static enum spec_status
onwards(const struct spec_place *from, double bearing_deg, double distance_m,
	struct spec_place *to, struct spec_error *error)
{
	return guard(error, [&] {
		Geodesic::WGS84().Direct(from->latitude_deg, from->longitude_deg,
			bearing_deg, distance_m, to->latitude_deg, to->longitude_deg);
	});
}

extern const struct spec_places spec_places;
const struct spec_places spec_places = {SPEC_PLACES_VERSION, parse, format, to_earth,
	from_earth, to_local, from_local, geodesic, onwards};
}
