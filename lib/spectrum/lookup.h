/*
 * Spectra by name. A root is a folder with the group folders cmf, illuminants, glass,
 * metals, reflectance, media, sky and upsampling, each with .spd files and perhaps one level
 * of folders of them. The roots are the folders of the environment's SPECTRA_PATH (colons
 * between them), then ../share/spectools/spectra beside the folder of the running program.
 * The full name of such a file is "illuminants/D65", its short name "D65".
 */
#ifndef SPEC_SPECTRUM_LOOKUP_H
#define SPEC_SPECTRUM_LOOKUP_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/curve.h"

/*
 * Reads the curve that name stands for:
 * 0. an illuminant by formula, "daylight:6504K" or "blackbody:3000K", illuminant.h, or what
 *    the program's maker makes;
 * 1. the file at the path name, if name contains '/' or ends in .spd, .txt or .csv and
 *    something that is no folder is there;
 * 2. the file of that full name, or whose full name ends in '/' and name, in the first
 *    root that has one;
 * 3. the same with upper and lower case taken as equal;
 * 4. the lamp "FL4" or "FL3.1" for "F4" or "F3.1", as they were called.
 * SPEC_EUSAGE: no such spectrum (the message says where it was looked for, and the nearest
 * name if there is one), or two in one root (it names both), or a formula that is none.
 * SPEC_ERANGE: a temperature beyond the formula's range. Other statuses as spec_spd_load.
 * On an error curve is empty.
 */
enum spec_status spec_lookup_curve(
	const char *name, struct spec_curve *curve, struct spec_error *error);

/* Whether a name may be a path: it contains '/', or ends in .spd, .txt or .csv. */
int spec_lookup_is_path(const char *name);

/*
 * What makes spectra of names that rooms below this one know, such as those of places.
 * knows: whether a name is one of them. make: its curve, as spec_lookup_curve.
 */
struct spec_lookup_maker {
	int (*knows)(const char *name);
	enum spec_status (*make)(
		const char *name, struct spec_curve *curve, struct spec_error *error);
};

/* Sets the program's maker, which stays where it is; before any threads. Null: none. */
void spec_lookup_set_maker(const struct spec_lookup_maker *maker);

/* Whether a name is computed: by formula, or by the program's maker. */
int spec_lookup_is_computed(const char *name);

/*
 * The path of the file that it reads, to be freed; null on an error. What is computed has no
 * file: there is no spectrum of that name then.
 */
enum spec_status spec_lookup_path(const char *name, char **path, struct spec_error *error);

/*
 * As spec_lookup_curve; SPEC_EUSAGE also where the curve is no light, such as an index. Here
 * "F5" is the lamp, not the glass. A light without a title gets the name for it.
 */
enum spec_status spec_lookup_light(
	const char *name, struct spec_curve *curve, struct spec_error *error);

/* As spec_lookup_curve; SPEC_EUSAGE also where it is neither light nor a ratio. */
enum spec_status spec_lookup_factor(
	const char *name, struct spec_curve *curve, struct spec_error *error);

/*
 * The full names of all spectra in all roots, sorted by byte, each once. To be freed with
 * spec_lookup_free_list. SPEC_EIO: a folder is there but cannot be read. SPEC_ENOMEM. On
 * an error the list is null and empty.
 */
enum spec_status spec_lookup_list(char ***names, size_t *count, struct spec_error *error);

/* Frees a list of count names; null is allowed. */
void spec_lookup_free_list(char **names, size_t count);

#endif
