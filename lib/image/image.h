/*
 * What an image is, apart from its pixels: windows, channels, attributes, and
 * the bands that the channels form. specexr(5) says what the names mean.
 */
#ifndef SPEC_IMAGE_IMAGE_H
#define SPEC_IMAGE_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

/* Pixels x0..x1-1, y0..y1-1: half-open. */
struct spec_window {
	int x0, y0, x1, y1;
};

enum spec_sample { /* as OpenEXR numbers them */
	SPEC_SAMPLE_UINT,
	SPEC_SAMPLE_HALF,
	SPEC_SAMPLE_FLOAT
};

enum spec_role {
	SPEC_ROLE_OTHER,      /* not spectral: passes through */
	SPEC_ROLE_EMISSIVE,   /* S0..S3: radiance, Stokes component */
	SPEC_ROLE_REFLECTIVE, /* T: reflectance or transmittance */
	SPEC_ROLE_BISPECTRAL  /* T.in.out, off the diagonal */
};

enum spec_naming { /* of a band, by the program that wrote it */
	SPEC_NAMING_NONE,
	SPEC_NAMING_LAYOUT, /* and pbrt-v4, colour-science */
	SPEC_NAMING_MITSUBA,
	SPEC_NAMING_ISET3D,
	SPEC_NAMING_KAIST,
	SPEC_NAMING_OCEAN, /* by an attribute, NAME.wavelength */
	SPEC_NAMING_GIVEN  /* by the user: given.h */
};

struct spec_channel {
	char *name;
	enum spec_sample sample;
	int linear; /* OpenEXR's pLinear: a hint to B44 */
	enum spec_role role;
	enum spec_naming naming;
	int stokes;             /* 0..3 */
	double wavelength_nm;   /* incident, where the channel is bispectral */
	double reradiated_nm;   /* bispectral only */
	double low_nm, high_nm; /* edges, where the name tells them; else 0, 0 */
};

/* An attribute as it stands in the file: its bytes after name, type and size. */
struct spec_attribute {
	char *name, *type;
	unsigned char *value;
	size_t size;
};

struct spec_image {
	struct spec_window data, display;
	float pixel_aspect_ratio;
	float screen_window_x, screen_window_y, screen_window_width;
	int compression; /* as OpenEXR numbers them; where the image came from a file */
	char *part;      /* the part's name, or null */

	size_t channels;
	struct spec_channel *channel; /* in the order of their names, as strcmp has it */
	size_t attributes;
	struct spec_attribute *attribute; /* all but those that the fields above hold */
	size_t channel_room, attribute_room;

	/* Filled by spec_image_index. */
	enum spec_role role; /* EMISSIVE, REFLECTIVE, or OTHER: no bands */
	size_t bands;
	double *wavelength_nm; /* ascending */
	double *edges_nm;      /* bands + 1, or null: point samples */
	int stokes;            /* components per band: 1, or 4 */
	size_t *band_channel;  /* [stokes * bands] */
	size_t bispectral;     /* channels off the diagonal */
};

void spec_image_clear(struct spec_image *image);

/* Everything but the index; call spec_image_index on the copy. */
enum spec_status spec_image_copy(
	struct spec_image *copy, const struct spec_image *image, struct spec_error *error);

static inline size_t
spec_window_width(const struct spec_window *window)
{
	return (size_t)((long long)window->x1 - window->x0);
}

static inline size_t
spec_window_height(const struct spec_window *window)
{
	return (size_t)((long long)window->y1 - window->y0);
}

/* Appends a channel; what its name says (role, wavelengths) is filled in. */
enum spec_status spec_image_add_channel(struct spec_image *image, const char *name,
	enum spec_sample sample, struct spec_error *error);

/* Removes the channels of which goes says so; the image must be indexed again. */
void spec_image_remove_channels(
	struct spec_image *image, int (*goes)(const struct spec_channel *channel));

/* Removes every channel of a band, diagonal or not. */
void spec_image_remove_bands(struct spec_image *image);

/*
 * Removes the channels R, G, B: a preview of other values than those in the bands would
 * mislead. The image must be indexed again.
 */
void spec_image_remove_preview(struct spec_image *image);

/*
 * Adds the channels of bands in the layout's names.
 * role: EMISSIVE (with stokes components 1 or 4) or REFLECTIVE.
 */
enum spec_status spec_image_add_bands(struct spec_image *image, enum spec_role role,
	int stokes, const double *wavelength_nm, size_t count, enum spec_sample sample,
	struct spec_error *error);

/*
 * Sorts the channels and finds the bands among them. Errors (SPEC_EFORMAT): two
 * channels of one name or of one band, emissive and reflective bands at once,
 * Stokes components on different grids, a spec:bins that does not fit the bands.
 * An image without bands is no error here. name: the file, for messages.
 */
enum spec_status spec_image_index(
	struct spec_image *image, const char *name, struct spec_error *error);

/* Forgets the bands: as before spec_image_index. */
void spec_image_clear_index(struct spec_image *image);

/*
 * The band nearest to a wavelength, of an indexed image with bands; *same: it is that
 * band, which it is within 0.001 nm (names of three and of six decimals agree) but no
 * farther than a quarter of the way to the next band.
 */
size_t spec_image_nearest_band(
	const struct spec_image *image, double wavelength_nm, int *same);

/* The index of the channel of that name in an indexed image, or image->channels. */
size_t spec_image_find_channel(const struct spec_image *image, const char *name);

/*
 * Renames the bands to the layout's names, six decimals, and indexes again; attributes that
 * said a band's wavelength go.
 */
enum spec_status spec_image_rename_bands(
	struct spec_image *image, const char *name, struct spec_error *error);

/* The attribute of that name, or null. */
const struct spec_attribute *spec_image_attribute(
	const struct spec_image *image, const char *name);

/* Sets or replaces an attribute of any type by its bytes. */
enum spec_status spec_image_set_attribute(struct spec_image *image, const char *name,
	const char *type, const void *value, size_t size, struct spec_error *error);

enum spec_status spec_image_set_text(struct spec_image *image, const char *name,
	const char *text, struct spec_error *error);

void spec_image_remove_attribute(struct spec_image *image, const char *name);

/*
 * A string attribute's text, newly allocated, or null where there is none. Error:
 * SPEC_ENOMEM alone.
 */
enum spec_status spec_image_text(const struct spec_image *image, const char *name,
	char **text, struct spec_error *error);

/*
 * What a sample means: the text of spec:quantity, or, without it, the default of
 * the role: "radiance per nm", "reflectance", or "" without bands. Newly allocated.
 */
char *spec_image_quantity(const struct spec_image *image, struct spec_error *error);

/* Sets spec:bins to the edges (bands + 1), or removes it where edges_nm is null. */
enum spec_status spec_image_set_bins(struct spec_image *image, const double *edges_nm,
	size_t bands, struct spec_error *error);

/* Adds a line to spec:history: the tool, its version and its arguments, quoted for sh. */
enum spec_status spec_image_add_history(
	struct spec_image *image, int argc, char **argv, struct spec_error *error);

#endif
