#include "colour/profile.h"

#include <lcms2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define VERSION 4.3
#define LONGEST_NAME 64
#define DATE_OFFSET 24 /* in the header: ICC.1:2010, table 17 */

/* 2026-01-01 00:00:00 in place of the clock's: equal pictures are equal files. */
static const unsigned char date[12] = {2026 >> 8, 2026 & 255, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0};

/* From encoded to linear: ICC.1:2010, table 65. */
static cmsToneCurve *
build_curve(const struct spec_transfer *transfer)
{
	double power[1] = {1 / transfer->power};
	double parts[5] = {1 / transfer->power, 1 / transfer->scale,
		transfer->offset / transfer->scale, 1 / transfer->slope,
		transfer->cut_encoded};

	if (transfer->offset == 0)
		return cmsBuildParametricToneCurve(NULL, 1, power);
	return cmsBuildParametricToneCurve(NULL, 4, parts);
}

static int
write_text(cmsHPROFILE profile, cmsTagSignature tag, const char *text)
{
	cmsMLU *list = cmsMLUalloc(NULL, 1);
	int written = list && cmsMLUsetASCII(list, "en", "US", text) &&
		      cmsWriteTag(profile, tag, list);

	if (list)
		cmsMLUfree(list);
	return written;
}

/* "Display P3", or "Display P3, linear" where its own function is another. */
static void
name_profile(const struct spec_space *space, const struct spec_transfer *transfer,
	char *name, size_t room)
{
	const struct spec_space *known = spec_space_find(space->name, NULL);
	const struct spec_transfer *own = known ? known->transfer : &spec_transfer_srgb;

	snprintf(name, room, "%s%s%s", space->title, transfer == own ? "" : ", ",
		transfer == own ? "" : transfer->name);
}

static cmsHPROFILE
build(const struct spec_space *space, const struct spec_transfer *transfer)
{
	const cmsCIExyY white = {space->white_xy[0], space->white_xy[1], 1};
	const cmsCIExyYTRIPLE primaries = {{space->red_xy[0], space->red_xy[1], 1},
		{space->green_xy[0], space->green_xy[1], 1},
		{space->blue_xy[0], space->blue_xy[1], 1}};
	cmsToneCurve *curve = build_curve(transfer);
	cmsHPROFILE profile;
	char name[LONGEST_NAME];

	if (!curve)
		return NULL;
	name_profile(space, transfer, name, sizeof name);
	profile = cmsCreateRGBProfile(
		&white, &primaries, (cmsToneCurve *[]){curve, curve, curve});
	cmsFreeToneCurve(curve);
	if (!profile)
		return NULL;
	cmsSetProfileVersion(profile, VERSION);
	if (write_text(profile, cmsSigProfileDescriptionTag, name) &&
		write_text(profile, cmsSigCopyrightTag, "No copyright, use freely"))
		return profile;
	cmsCloseProfile(profile);
	return NULL;
}

enum spec_status
spec_profile_make(const struct spec_space *space, const struct spec_transfer *transfer,
	unsigned char **bytes, size_t *size, struct spec_error *error)
{
	cmsHPROFILE profile = build(space, transfer ? transfer : &spec_transfer_linear);
	cmsUInt32Number length = 0;
	int saved = profile && cmsSaveProfileToMem(profile, NULL, &length);

	*bytes = NULL;
	*size = length;
	if (saved)
		*bytes = spec_memory_new(length, 1, "profiles", error);
	if (*bytes)
		saved = cmsSaveProfileToMem(profile, *bytes, &length);
	if (profile)
		cmsCloseProfile(profile);
	if (!saved) {
		free(*bytes);
		*bytes = NULL;
		return spec_error_set(error, SPEC_ERANGE,
			"unable to make an ICC profile of %s", space->title);
	}
	if (!*bytes)
		return SPEC_ENOMEM;
	memcpy(*bytes + DATE_OFFSET, date, sizeof date);
	return SPEC_OK;
}
