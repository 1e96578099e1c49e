#include "image/plugin.h"

#include <dlfcn.h>
#include <string.h>
#include <unistd.h>

/* As the build tree and an installation have it: seen from the folder of the program. */
#define FOLDER "../lib/spectools/"
#define PICTURES "pictures.so"
#define LONGEST_NAME 32 /* of a plugin's file, its zero included */

static enum spec_status
find_plugin(char *path, size_t room, const char *file, struct spec_error *error)
{
	ssize_t length = readlink("/proc/self/exe", path, room);
	char *slash;

	if (length > 0 && (size_t)length < room) {
		path[length] = '\0';
		slash = strrchr(path, '/');
		if (slash &&
			(size_t)(slash + 1 - path) + strlen(FOLDER) + strlen(file) < room) {
			strcpy(slash + 1, FOLDER);
			strcat(slash + 1, file);
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"the plugin %s was not found: /proc/self/exe cannot be used", file);
}

enum spec_status
spec_plugin_find(
	const char *file, const char *symbol, const void **table, struct spec_error *error)
{
	char path[4096 + sizeof FOLDER + LONGEST_NAME];
	enum spec_status status = find_plugin(path, sizeof path, file, error);
	void *library;

	if (status != SPEC_OK)
		return status;
	library = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
	*table = library ? dlsym(library, symbol) : NULL;
	if (!*table)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"this needs the plugin %s, which cannot be loaded: %s", file,
			dlerror());
	(void)dlclose(library);
	return SPEC_OK;
}

enum spec_status
spec_plugin_load(struct spec_plugin *plugin, struct spec_error *error)
{
	char path[4096 + sizeof FOLDER + LONGEST_NAME];
	enum spec_status status = find_plugin(path, sizeof path, PICTURES, error);

	if (status != SPEC_OK)
		return status;
	/* OpenImageIO starts threads: once loaded, it must stay. */
	plugin->library = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
	if (!plugin->library)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"this format needs the picture plugin, which cannot be loaded: %s",
			dlerror());
	plugin->table = dlsym(plugin->library, SPEC_PICTURES_SYMBOL);
	if (!plugin->table || plugin->table->version != SPEC_PICTURES_VERSION)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"the picture plugin '%s' is of another version of spectools", path);
	return SPEC_OK;
}

void
spec_plugin_unload(struct spec_plugin *plugin)
{
	if (plugin->library)
		(void)dlclose(plugin->library);
}
