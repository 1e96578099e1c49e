/* Writing an almanac. */
#include <math.h>
#include <string.h>

#include "image/value.h"
#include "place/almanac.h"

#define LABEL "  %-13s "
#define REFRACTION "Saemundsson 1986"

static struct spec_instant
in_utc(const struct spec_instant *instant)
{
	struct spec_instant utc = *instant;

	utc.offset_s = 0;
	return utc;
}

static double
julian_date(const struct spec_instant *instant)
{
	return instant->utc1 + instant->utc2;
}

static void
print_place(FILE *stream, const struct spec_almanac *almanac)
{
	const double *xyz_m = almanac->xyz_m;

	fprintf(stream, LABEL "%s, %.10g m\n", "place",
		almanac->written[SPEC_PLACE_DEGREES], almanac->place.altitude_m);
	fprintf(stream, LABEL "%s\n", "", almanac->written[SPEC_PLACE_DMS]);
	fprintf(stream, LABEL "%s\n", "UTM", almanac->written[SPEC_PLACE_UTM]);
	fprintf(stream, LABEL "%s\n", "MGRS", almanac->written[SPEC_PLACE_MGRS]);
	fprintf(stream, LABEL "%.1f %.1f %.1f m\n", "ECEF", xyz_m[0], xyz_m[1], xyz_m[2]);
}

static void
print_time(FILE *stream, const struct spec_instant *instant)
{
	static const char *const notes[] = {[SPEC_LEAP_KNOWN] = "",
		[SPEC_LEAP_BEFORE] = ": there was no UTC yet, and it is taken as UT",
		[SPEC_LEAP_AFTER] = ": too old to know of this year's"};
	struct spec_instant utc = in_utc(instant);
	char written[SPEC_INSTANT_WRITTEN];
	int year, month;

	spec_instant_format(instant, 0, written);
	fprintf(stream, LABEL "%s, day %d of the year\n", "time", written,
		spec_instant_day_of_year(instant));
	spec_instant_format(&utc, 0, written);
	fprintf(stream, LABEL "%s, Julian date %.6f\n", "UTC", written,
		julian_date(instant));
	spec_instant_last_leap(&year, &month);
	fprintf(stream,
		LABEL "%g s by ERFA's table, whose last step is that of %d-%02d%s\n",
		"TAI - UTC", spec_instant_tai_utc(instant), year, month,
		notes[instant->leap]);
}

static void
print_sun(FILE *stream, const struct spec_almanac *almanac)
{
	const struct spec_solar *solar = &almanac->solar;
	/* In tenths of a second: 59.96 s are a minute, not "60.0 s". */
	long equation = lround(fabs(solar->equation_of_time_min) * 600);

	fprintf(stream,
		LABEL "azimuth %.5f, zenith %.5f, elevation %.5f deg, without air\n", "sun",
		solar->azimuth_deg, solar->zenith_deg, 90 - solar->zenith_deg);
	fprintf(stream, LABEL "zenith %.5f, elevation %.5f deg (%s; %.1f hPa, %.1f C)\n",
		"refracted", solar->zenith_refracted_deg, 90 - solar->zenith_refracted_deg,
		REFRACTION, almanac->air.pressure_hpa, almanac->air.temperature_c);
	if (isnan(solar->air_mass))
		fprintf(stream, LABEL "none: the sun is below the horizon\n", "air mass");
	else
		fprintf(stream,
			LABEL "%.4f, with the pressure %.4f (Kasten & Young 1989)\n",
			"air mass", solar->air_mass, solar->air_mass_absolute);
	fprintf(stream, LABEL "azimuth %.5f, elevation %.5f deg\n", "antisolar",
		solar->antisolar_azimuth_deg, solar->antisolar_elevation_deg);
	fprintf(stream, LABEL "%.8f au, radius of the disc %.5f deg\n", "distance",
		solar->distance_au, solar->radius_deg);
	fprintf(stream, LABEL "%.5f, hour angle %.5f deg\n", "declination",
		solar->declination_deg, solar->hour_angle_deg);
	fprintf(stream, LABEL "%c%ld min %04.1f s, apparent less mean solar time\n",
		"equation", solar->equation_of_time_min < 0 ? '-' : '+', equation / 600,
		(double)(equation % 600) / 10);
}

static const char *
day_kind(enum spec_day_kind kind)
{
	return kind == SPEC_DAY_POLAR_DAY     ? "polar day"
	       : kind == SPEC_DAY_POLAR_NIGHT ? "polar night"
					      : "ordinary";
}

static void
print_edge(FILE *stream, const char *label, int there, const struct spec_instant *instant,
	const struct spec_solar_day *day)
{
	char written[SPEC_INSTANT_WRITTEN];

	fprintf(stream, LABEL, label);
	if (there) {
		spec_instant_format(instant, 0, written);
		fprintf(stream, "%s\n", written);
	} else {
		fprintf(stream, "none%s%s\n", day->kind == SPEC_DAY_ORDINARY ? "" : ": ",
			day->kind == SPEC_DAY_ORDINARY ? "" : day_kind(day->kind));
	}
}

static void
print_day(FILE *stream, const struct spec_solar_day *day)
{
	char written[SPEC_INSTANT_WRITTEN];

	print_edge(stream, "sunrise", day->rises, &day->sunrise, day);
	spec_instant_format(&day->noon, 0, written);
	fprintf(stream, LABEL "%s, elevation %.3f deg\n", "noon", written,
		90 - day->noon_zenith_deg);
	print_edge(stream, "sunset", day->sets, &day->sunset, day);
}

static void
print_target(FILE *stream, const struct spec_almanac *almanac)
{
	const double *there_m = almanac->east_north_up_m;

	fprintf(stream, LABEL "%.6f %.6f: bearing %.5f deg, %.3f m, arriving at %.5f deg\n",
		"toward", almanac->target.latitude_deg, almanac->target.longitude_deg,
		almanac->way.bearing_deg, almanac->way.distance_m,
		almanac->way.arrival_deg);
	fprintf(stream, LABEL "east %.3f, north %.3f, up %.3f m\n", "", there_m[0],
		there_m[1], there_m[2]);
}

void
spec_almanac_print(FILE *stream, const char *name, const struct spec_almanac *almanac)
{
	if (name)
		spec_value_print_text(stream, name, strlen(name));
	else
		fputs("sun", stream);
	fputc('\n', stream);
	print_place(stream, almanac);
	print_time(stream, &almanac->instant);
	print_sun(stream, almanac);
	print_day(stream, &almanac->day);
	if (almanac->has_target)
		print_target(stream, almanac);
}

static void
put_place(struct spec_json *json, const struct spec_almanac *almanac)
{
	spec_json_open(json, "place", '{', SPEC_JSON_LINES);
	spec_json_number(json, "latitude_deg", almanac->place.latitude_deg);
	spec_json_number(json, "longitude_deg", almanac->place.longitude_deg);
	spec_json_number(json, "altitude_m", almanac->place.altitude_m);
	spec_json_text(json, "dms", almanac->written[SPEC_PLACE_DMS]);
	spec_json_text(json, "utm", almanac->written[SPEC_PLACE_UTM]);
	spec_json_text(json, "mgrs", almanac->written[SPEC_PLACE_MGRS]);
	spec_json_numbers(json, "ecef_m", almanac->xyz_m, 3);
	spec_json_close(json);
}

/* Null where there is none. */
static void
put_instant(struct spec_json *json, const char *key, int there,
	const struct spec_instant *instant, int decimals)
{
	char written[SPEC_INSTANT_WRITTEN];

	if (there)
		spec_instant_format(instant, decimals, written);
	spec_json_text(json, key, there ? written : NULL);
}

static void
put_time(struct spec_json *json, const struct spec_instant *instant)
{
	static const char *const known[] = {[SPEC_LEAP_KNOWN] = "known",
		[SPEC_LEAP_BEFORE] = "before UTC",
		[SPEC_LEAP_AFTER] = "beyond the table"};
	struct spec_instant utc = in_utc(instant);

	put_instant(json, "time", 1, instant, 3);
	put_instant(json, "utc", 1, &utc, 3);
	spec_json_number(json, "julian_date", julian_date(instant));
	spec_json_whole(json, "day_of_year", spec_instant_day_of_year(instant));
	spec_json_number(json, "tai_utc_s", spec_instant_tai_utc(instant));
	spec_json_text(json, "leap_seconds", known[instant->leap]);
}

static void
put_sun(struct spec_json *json, const struct spec_almanac *almanac)
{
	const struct spec_solar *solar = &almanac->solar;

	spec_json_number(json, "azimuth_deg", solar->azimuth_deg);
	spec_json_number(json, "zenith_deg", solar->zenith_deg);
	spec_json_number(json, "zenith_refracted_deg", solar->zenith_refracted_deg);
	spec_json_number(json, "elevation_deg", 90 - solar->zenith_deg);
	spec_json_number(json, "elevation_refracted_deg", 90 - solar->zenith_refracted_deg);
	spec_json_text(json, "refraction", REFRACTION);
	spec_json_number(json, "pressure_hpa", almanac->air.pressure_hpa);
	spec_json_number(json, "temperature_c", almanac->air.temperature_c);
	spec_json_number(json, "airmass", solar->air_mass);
	spec_json_number(json, "airmass_absolute", solar->air_mass_absolute);
	spec_json_open(json, "antisolar", '{', SPEC_JSON_INLINE);
	spec_json_number(json, "azimuth_deg", solar->antisolar_azimuth_deg);
	spec_json_number(json, "elevation_deg", solar->antisolar_elevation_deg);
	spec_json_close(json);
	spec_json_number(json, "distance_au", solar->distance_au);
	spec_json_number(json, "radius_deg", solar->radius_deg);
	spec_json_number(json, "declination_deg", solar->declination_deg);
	spec_json_number(json, "hour_angle_deg", solar->hour_angle_deg);
	spec_json_number(json, "equation_of_time_min", solar->equation_of_time_min);
	spec_json_numbers(json, "east_north_up", solar->east_north_up, 3);
}

static void
put_target(struct spec_json *json, const struct spec_almanac *almanac)
{
	spec_json_open(json, "toward", '{', SPEC_JSON_LINES);
	spec_json_number(json, "latitude_deg", almanac->target.latitude_deg);
	spec_json_number(json, "longitude_deg", almanac->target.longitude_deg);
	spec_json_number(json, "altitude_m", almanac->target.altitude_m);
	spec_json_number(json, "bearing_deg", almanac->way.bearing_deg);
	spec_json_number(json, "distance_m", almanac->way.distance_m);
	spec_json_number(json, "arrival_deg", almanac->way.arrival_deg);
	spec_json_numbers(json, "east_north_up_m", almanac->east_north_up_m, 3);
	spec_json_close(json);
}

void
spec_almanac_json(
	struct spec_json *json, const char *name, const struct spec_almanac *almanac)
{
	const struct spec_solar_day *day = &almanac->day;

	spec_json_open(json, NULL, '{', SPEC_JSON_LINES);
	if (name)
		spec_json_text(json, "file", name);
	put_place(json, almanac);
	put_time(json, &almanac->instant);
	put_sun(json, almanac);
	spec_json_text(json, "day", day_kind(day->kind));
	put_instant(json, "sunrise", day->rises, &day->sunrise, 0);
	put_instant(json, "noon", 1, &day->noon, 0);
	put_instant(json, "sunset", day->sets, &day->sunset, 0);
	spec_json_number(json, "noon_elevation_deg", 90 - day->noon_zenith_deg);
	if (almanac->has_target)
		put_target(json, almanac);
	spec_json_close(json);
}
