/* Files that unit tests make in a scratch folder of the program's own, and read again. */
#ifndef TESTS_UNIT_FILES_H
#define TESTS_UNIT_FILES_H

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "check.h"

/* The folder, once scratch_make was called. */
static char scratch[64];

/* name: the program's. Returns 0, as a cmocka fixture does. */
static inline int
scratch_make(const char *name)
{
	snprintf(scratch, sizeof scratch, "/tmp/spectools-%s-XXXXXX", name);
	return mkdtemp(scratch) ? 0 : -1;
}

/* A cmocka fixture: removes the folder and all that is in it. */
static inline int
scratch_remove(void **state)
{
	char command[80];

	(void)state;
	snprintf(command, sizeof command, "rm -rf '%s'", scratch);
	return system(command);
}

/* Makes a folder in it. */
static inline void
make_folder(const char *name)
{
	char path[256];

	snprintf(path, sizeof path, "%s/%s", scratch, name);
	assert_int_equal(mkdir(path, 0777), 0);
}

/* Makes a file in it. */
static inline void
save(const char *name, const void *bytes, size_t size)
{
	char path[256];
	FILE *file;

	snprintf(path, sizeof path, "%s/%s", scratch, name);
	file = fopen(path, "wb");
	assert_non_null(file);
	assert_int_equal(fwrite(bytes, 1, size, file), size);
	assert_int_equal(fclose(file), 0);
}

static inline void
save_text(const char *name, const char *text)
{
	save(name, text, strlen(text));
}

/*
 * Spectra are looked for in the repository's spectra/, where that is here, and behind it in
 * the folder. Returns 0, as a cmocka fixture does.
 */
static inline int
scratch_search(void)
{
	char path[4096], folder[3800];
	int here = access("spectra/glass", R_OK) == 0;

	if (!getcwd(folder, sizeof folder))
		return -1;
	snprintf(path, sizeof path, "%s%s%s", here ? folder : "", here ? "/spectra:" : "",
		scratch);
	return setenv("SPECTRA_PATH", path, 1);
}

/* The bytes of a file; freed with free(). */
static inline unsigned char *
file_bytes(const char *path, size_t *size)
{
	FILE *stream = fopen(path, "rb");
	unsigned char *bytes;
	struct stat status;

	assert_non_null(stream);
	assert_int_equal(fstat(fileno(stream), &status), 0);
	*size = (size_t)status.st_size;
	bytes = malloc(*size + 1);
	assert_non_null(bytes);
	assert_int_equal(fread(bytes, 1, *size, stream), *size);
	fclose(stream);
	return bytes;
}

#endif
