/*
 * specfilm's work on images: the films of the light layers are folded into the bands, from
 * the back to the eye:
 *   L = through; for k = K ... 1: L = T_k L + R_k mirror_k; S0 = S0 + L
 */
#ifndef SPEC_IMAGE_FOLD_H
#define SPEC_IMAGE_FOLD_H

#include <stdatomic.h>

#include "base/error.h"
#include "image/image.h"
#include "image/layers.h"
#include "image/mask.h"
#include "image/reader.h"
#include "image/relight.h"
#include "image/settings.h"
#include "optics/coating.h"

struct spec_fold_setup {
	const struct spec_coating *coating; /* at the image's bands */
	const struct spec_mask *mask;       /* which surfaces each coating is on */
	size_t coatings;
	enum spec_polarisation polarisation;
	int keep; /* the layers stay in the image */
	int half; /* bands are stored as HALF */
};

struct spec_fold {
	struct spec_relight relight;
	struct spec_layers layers;
	struct spec_fold_setup setup;
	const char *name;
	atomic_llong bare; /* pixels of surfaces that no coating is for, left out */
};

/*
 * Works out the output's header and what is read. name: the file, for messages, which must
 * live as long as fold. Errors: no film layers, layers that spec_layers_find refuses, a
 * film without cosine (or Ns and I), without id where a mask asks for it, without Q
 * where a thickness does.
 */
enum spec_status spec_fold_plan(struct spec_fold *fold, const struct spec_image *input,
	const struct spec_fold_setup *setup, const char *name, struct spec_error *error);
void spec_fold_free(struct spec_fold *fold);

/*
 * Reads all lines, folds and writes them to the settings' output. *overflows: as
 * spec_image_save's. Error (SPEC_EFORMAT): a cosine that is none, a film seen from within a
 * substrate that absorbs.
 */
enum spec_status spec_fold_run(struct spec_fold *fold, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
