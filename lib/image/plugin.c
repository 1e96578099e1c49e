#include "image/plugin.h"

#include <dlfcn.h>
#include <string.h>
#include <unistd.h>

/* As the build tree and an installation have it: seen from the folder of the program. */
#define PLUGIN "../lib/spectools/pictures.so"

static enum spec_status
find_plugin(char *path, size_t room, struct spec_error *error)
{
	ssize_t length = readlink("/proc/self/exe", path, room);
	char *slash;

	if (length > 0 && (size_t)length < room) {
		path[length] = '\0';
		slash = strrchr(path, '/');
		if (slash && (size_t)(slash + 1 - path) + sizeof PLUGIN <= room) {
			strcpy(slash + 1, PLUGIN);
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"the picture plugin was not found: /proc/self/exe cannot be used");
}

enum spec_status
spec_plugin_load(struct spec_plugin *plugin, struct spec_error *error)
{
	char path[4096 + sizeof PLUGIN];
	enum spec_status status = find_plugin(path, sizeof path, error);

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
