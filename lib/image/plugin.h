/* Loading plugins: pictures.so, and plots.so. */
#ifndef SPEC_IMAGE_PLUGIN_H
#define SPEC_IMAGE_PLUGIN_H

#include "base/error.h"
#include "image/pictures.h"

struct spec_plugin {
	void *library;
	const struct spec_pictures *table; /* once it is loaded */
};

/*
 * The symbol of the plugin of that file name, which stays loaded. SPEC_EUNSUPPORTED: it was
 * not found or cannot be loaded.
 */
enum spec_status spec_plugin_find(
	const char *file, const char *symbol, const void **table, struct spec_error *error);

/*
 * pictures.so. SPEC_EUNSUPPORTED: it was not found, cannot be loaded,
 * or is of another version.
 */
enum spec_status spec_plugin_load(struct spec_plugin *plugin, struct spec_error *error);

/* Harmless where nothing was loaded. */
void spec_plugin_unload(struct spec_plugin *plugin);

#endif
