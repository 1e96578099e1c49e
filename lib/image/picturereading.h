/* Inside picturereader.c and picturedescribe.c alone: the reader of pictures. */
#ifndef SPEC_IMAGE_PICTUREREADING_H
#define SPEC_IMAGE_PICTUREREADING_H

#include "image/plugin.h"
#include "image/pnginput.h"
#include "image/reading.h"

/* One file of the picture. */
struct picture_input {
	char *path;
	struct spec_png *png;
	struct spec_source source; /* of a PNG picture that is one of several */
	void *handle;              /* the plugin's */
	struct spec_pictures_content content;
	struct spec_png_content png_content;
	double wavelength_nm; /* that it says, or its name; or 0 */
	int has_bin;
	double bin_nm[2];
};

struct picture_reader {
	struct spec_reader base;
	struct spec_plugin plugin;
	struct picture_input *input;
	size_t inputs, input_room;
	/* Of each channel of the image: which input's, and which of its channels. */
	size_t *from_input, *from_channel;
	int colours; /* light as eyes see it: to be made linear where it is not */
};

/*
 * The image without its samples, of inputs that are open, and where each channel comes from:
 * bands of a folder's pictures, one each (which are sorted by wavelength), or of one file's
 * channels, or colours. SPEC_EFORMAT: what a file says of itself does not fit it;
 * SPEC_EUSAGE: nobody says what the bands are; SPEC_ENOMEM.
 */
enum spec_status picture_describe(struct picture_reader *reader,
	const struct spec_settings *settings, struct spec_error *error);

#endif
