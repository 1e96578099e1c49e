/* Spectra in parameter lists. */
#ifndef SPEC_SCENE_SPECTRA_H
#define SPEC_SCENE_SPECTRA_H

#include "base/error.h"
#include "scene/parameters.h"
#include "scene/scene.h"

/* What a spectrum is wanted for, and so what its values may be. */
enum spec_scene_use {
	SPEC_SCENE_REFLECTANCE, /* 0..1 */
	SPEC_SCENE_LIGHT,       /* >= 0 */
	SPEC_SCENE_ETA,         /* > 0, <= SPEC_INDEX_LARGEST */
	SPEC_SCENE_K            /* 0..SPEC_INDEX_LARGEST */
};

/*
 * The spectrum that a parameter of any type of SPEC_ANY_SPECTRUM gives:
 *   "float L" 2                        the same at all wavelengths (ours, but for eta)
 *   "rgb L" [1 .5 0]                   linear sRGB, >= 0, of a reflectance <= 1
 *   "blackbody L" 6500                 of light alone, a temperature > 0 [K]
 *   "spectrum L" [400 1 700 2]         wavelengths [nm], ascending, and values; two or more
 *   "spectrum L" "illuminants/D65"     a file, as spec_scene_find_file finds it if its name
 *                                      has a / or ends in .spd, .txt or .csv, else what
 *                                      spec_lookup_curve finds: the first column, for eta
 *                                      and k columns of that name
 *   "spectrum L" "daylight:6504K"      a light by formula, spectrum/illuminant.h, and
 *                "blackbody:3000K"     no other use's
 *   "spectrum eta" "metal-Au-eta"      pbrt's names: metal-*-eta, metal-*-k, glass-* and
 *                                      stdillum-*, where spectra/ has the same
 *   and what represented.h has
 * *given: whether there is such a parameter; else spectrum stays what it was.
 * SPEC_EFORMAT, SPEC_ERANGE, SPEC_EUNSUPPORTED: a name of pbrt's that is not in spectra/;
 * others as spec_lookup_curve and spec_spd_load.
 */
enum spec_status spec_arguments_spectrum(const struct spec_arguments *arguments,
	const char *name, enum spec_scene_use use, struct spec_scene_spectrum *spectrum,
	int *given);

/* As spec_arguments_spectrum with a "spectrum" of that name; place is the statement's. */
enum spec_status spec_arguments_named_spectrum(const struct spec_arguments *arguments,
	const char *name, enum spec_scene_use use, struct spec_scene_spectrum *spectrum);

#endif
