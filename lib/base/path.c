#include "base/path.h"

#include <string.h>
#include <strings.h>

const char *
spec_path_name(const char *path)
{
	const char *slash = strrchr(path, '/');

	return slash ? slash + 1 : path;
}

const char *
spec_path_suffix(const char *path)
{
	const char *name = spec_path_name(path), *dot = strrchr(name, '.');

	return dot && dot > name ? dot : name + strlen(name);
}

int
spec_path_has_suffix(const char *path, const char *suffix)
{
	return strcasecmp(spec_path_suffix(path), suffix) == 0;
}
