/* Several files that are committed together: all new, or all as they were. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/output.h"

#include "files.h"

#define FILES 3

static int
set_up(void **state)
{
	(void)state;
	return scratch_make("output");
}

static void
open_all(struct spec_output output[FILES], struct spec_output *list[FILES])
{
	for (int i = 0; i < FILES; i++) {
		char path[256];

		snprintf(path, sizeof path, "%s/%d", scratch, i);
		assert_int_equal(spec_output_open(&output[i], path, NULL), SPEC_OK);
		assert_int_equal(spec_output_write(&output[i], "new", 3, NULL), SPEC_OK);
		list[i] = &output[i];
	}
}

static void
holds(const char *name, const char *wanted)
{
	char path[256];
	unsigned char *bytes;
	size_t size;

	snprintf(path, sizeof path, "%s/%s", scratch, name);
	bytes = file_bytes(path, &size);
	assert_int_equal(size, strlen(wanted));
	assert_memory_equal(bytes, wanted, size);
	free(bytes);
}

static int
count_files(void)
{
	DIR *folder = opendir(scratch);
	int count = 0;

	for (struct dirent *entry; (entry = readdir(folder));)
		count += entry->d_name[0] != '.';
	closedir(folder);
	return count;
}

static void
all_are_replaced(void **state)
{
	struct spec_output output[FILES], *list[FILES];

	(void)state;
	save_text("1", "old");
	open_all(output, list);
	assert_int_equal(spec_output_commit_all(list, FILES, NULL), SPEC_OK);
	assert_int_equal(count_files(), FILES);
	for (int i = 0; i < FILES; i++)
		holds((const char *[]){"0", "1", "2"}[i], "new");
}

/* The last cannot take its name, which a folder has by now: what was there is there again. */
static void
none_is_replaced(void **state)
{
	struct spec_output output[FILES], *list[FILES];
	struct spec_error error = {0};
	char path[256];

	(void)state;
	snprintf(path, sizeof path, "%s/0", scratch);
	assert_int_equal(unlink(path), 0);
	save_text("1", "old");
	snprintf(path, sizeof path, "%s/2", scratch);
	assert_int_equal(unlink(path), 0);
	open_all(output, list);
	make_folder("2");
	assert_int_equal(spec_output_commit_all(list, FILES, &error), SPEC_EIO);
	assert_contains(error.message, "2'");
	assert_int_equal(count_files(), 2);
	holds("1", "old");
	for (int i = 0; i < FILES; i++)
		spec_output_abandon(&output[i]); /* harmless by now */
	assert_int_equal(rmdir(path), 0);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(all_are_replaced),
		cmocka_unit_test(none_is_replaced),
	};

	return cmocka_run_group_tests(tests, set_up, scratch_remove);
}
