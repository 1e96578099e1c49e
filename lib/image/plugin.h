/* Loading the plugin pictures.so. */
#ifndef SPEC_IMAGE_PLUGIN_H
#define SPEC_IMAGE_PLUGIN_H

#include "base/error.h"
#include "image/pictures.h"

struct spec_plugin {
	void *library;
	const struct spec_pictures *table; /* once it is loaded */
};

/* SPEC_EUNSUPPORTED: it was not found, cannot be loaded, or is of another version. */
enum spec_status spec_plugin_load(struct spec_plugin *plugin, struct spec_error *error);

/* Harmless where nothing was loaded. */
void spec_plugin_unload(struct spec_plugin *plugin);

#endif
