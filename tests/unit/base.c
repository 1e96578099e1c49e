/* Numbers, memory, messages, input, output and threads. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <sched.h>
#include <stdatomic.h>
#include <dirent.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/interval.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/output.h"
#include "base/parallel.h"
#include "base/path.h"
#include "base/source.h"

#include "check.h"

/* Paths */

static void
test_path(void **state)
{
	static const struct {
		const char *path, *name, *suffix;
	} parts[] = {{"a.exr", "a.exr", ".exr"}, {"a/b.c/d.tar.gz", "d.tar.gz", ".gz"},
		{"a.b/c", "c", ""}, {"a/.hidden", ".hidden", ""}, {".a.b", ".a.b", ".b"},
		{"a.b/", "", ""}, {"a.", "a.", "."}, {"", "", ""}, {"-", "-", ""}};

	(void)state;
	for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
		assert_string_equal(spec_path_name(parts[i].path), parts[i].name);
		assert_string_equal(spec_path_suffix(parts[i].path), parts[i].suffix);
	}
	assert_true(spec_path_has_suffix("a/B.Spd", ".spd"));
	assert_false(spec_path_has_suffix("a.spd/b", ".spd"));
	assert_false(spec_path_has_suffix("a/.spd", ".spd"));
	assert_false(spec_path_has_suffix("aspd", ".spd"));
}

/* Messages */

static void
test_error_line_breaks(void **state)
{
	struct spec_error error = {0};

	(void)state;
	assert_int_equal(
		spec_error_set(&error, SPEC_EFORMAT, "file '%s': %d", "a\nb\r\t\177", 7),
		SPEC_EFORMAT);
	assert_int_equal(error.status, SPEC_EFORMAT);
	assert_string_equal(error.message, "file 'a?b?"
					   "?"
					   "?': 7");
	/* Bytes above 127 are somebody's letters. */
	spec_error_set(&error, SPEC_EIO, "k\303\244se");
	assert_string_equal(error.message, "k\303\244se");
}

static void
test_error_system(void **state)
{
	struct spec_error error = {0};

	(void)state;
	assert_int_equal(
		spec_error_system(&error, ENOENT, "unable to open '%s'", "x"), SPEC_EIO);
	assert_string_equal(error.message, "unable to open 'x': No such file or directory");
	assert_int_equal(spec_error_system(&error, ENOMEM, "unable"), SPEC_ENOMEM);
	assert_int_equal(error.status, SPEC_ENOMEM);
	assert_int_equal(spec_error_system(NULL, EIO, "nobody listens"), SPEC_EIO);
	assert_int_equal(spec_error_set(NULL, SPEC_ERANGE, "nobody listens"), SPEC_ERANGE);
}

static void
test_error_prefix(void **state)
{
	struct spec_error error = {0};

	(void)state;
	spec_error_set(&error, SPEC_ERANGE, "too long");
	spec_error_prefix(&error, "%s:%d", "a\nb.spd", 3);
	assert_int_equal(error.status, SPEC_ERANGE);
	spec_error_prefix(NULL, "nobody asked");
	assert_string_equal(error.message, "a?b.spd:3: too long");
}

/* Too long a message is cut, never more than its room; a prefix pushes the end out. */
static void
test_error_long(void **state)
{
	struct {
		struct spec_error error;
		char guard[8];
	} room = {.guard = "guarded"};
	char longer[3000];

	(void)state;
	memset(longer, 'x', sizeof longer);
	longer[sizeof longer - 1] = '\0';
	spec_error_set(&room.error, SPEC_EIO, "%s", longer);
	assert_int_equal(strlen(room.error.message), sizeof room.error.message - 1);
	spec_error_system(&room.error, EIO, "%s", longer);
	assert_int_equal(strlen(room.error.message), sizeof room.error.message - 1);
	spec_error_prefix(&room.error, "prefix");
	assert_int_equal(strncmp(room.error.message, "prefix: xxx", 11), 0);
	assert_int_equal(strlen(room.error.message), sizeof room.error.message - 1);
	spec_error_prefix(&room.error, "%s", longer);
	assert_string_equal(room.guard, "guarded");
}

/* Numbers */

static const char *const junk[] = {"", " ", "x", "1x", " 1", "1 ", "1,5", "0x10", "nan",
	"NaN", "inf", "-inf", "infinity", "1e", "1e+", "e5", ".", "+", "-", "--1", "+-1",
	"1.2.3", "1e5e5", "1\n", "1e999", "-1e999",
	"1111111111111111111111111111111111111111111111111111111111111111111111111111"};

static void
test_number_junk(void **state)
{
	struct spec_error error = {0};
	double value = 42;

	(void)state;
	for (size_t i = 0; i < COUNT(junk); i++) {
		assert_int_equal(spec_number_parse(junk[i], -INFINITY, INFINITY,
					 "the number", &value, &error),
			SPEC_EUSAGE);
		assert_true(value == 42);
		assert_non_null(strstr(error.message, "the number is not a number"));
	}
}

static void
test_number_values(void **state)
{
	static const struct {
		const char *text;
		double value;
	} good[] = {{"0", 0}, {"-0.5", -0.5}, {"+3", 3}, {".5", 0.5}, {"5.", 5},
		{"1e3", 1000}, {"1E-3", 1e-3}, {"2.5e+2", 250}, {"1e-400", 0}, {"0.1", 0.1},
		{"1.7976931348623157e308", 1.7976931348623157e308}};
	struct spec_error error = {0};
	double value;

	(void)state;
	for (size_t i = 0; i < COUNT(good); i++) {
		assert_int_equal(spec_number_parse(good[i].text, -1e308 * 1.8, 1e308 * 1.8,
					 "x", &value, &error),
			SPEC_OK);
		assert_true(value == good[i].value);
	}
}

static void
test_number_range(void **state)
{
	struct spec_error error = {0};
	double value = 42;

	(void)state;
	assert_int_equal(spec_number_parse("1", 1, 2, "x", &value, &error), SPEC_OK);
	assert_int_equal(spec_number_parse("2", 1, 2, "x", &value, &error), SPEC_OK);
	value = 42;
	assert_int_equal(
		spec_number_parse("0.999", 1, 2, "the x", &value, &error), SPEC_ERANGE);
	assert_int_equal(
		spec_number_parse("2.001", 1, 2, "the x", &value, &error), SPEC_ERANGE);
	assert_string_equal(error.message, "the x is outside 1..2: '2.001'");
	assert_true(value == 42);
	assert_int_equal(spec_number_parse("3", 1, 2, "x", &value, NULL), SPEC_ERANGE);
}

static void
test_number_whole(void **state)
{
	static const char *const bad[] = {
		"", "-", "+", "1.0", "1e3", "0x1", " 1", "1 ", "x"};
	struct spec_error error = {0};
	long long value = 42;

	(void)state;
	for (size_t i = 0; i < COUNT(bad); i++)
		assert_int_equal(spec_number_parse_whole(
					 bad[i], LLONG_MIN, LLONG_MAX, "n", &value, &error),
			SPEC_EUSAGE);
	assert_int_equal(spec_number_parse_whole("9223372036854775808", LLONG_MIN,
				 LLONG_MAX, "n", &value, &error),
		SPEC_ERANGE);
	assert_int_equal(
		spec_number_parse_whole("0", 1, 9, "n", &value, &error), SPEC_ERANGE);
	assert_int_equal(
		spec_number_parse_whole("10", 1, 9, "n", &value, &error), SPEC_ERANGE);
	assert_int_equal(value, 42);
	assert_int_equal(spec_number_parse_whole("-9223372036854775808", LLONG_MIN,
				 LLONG_MAX, "n", &value, &error),
		SPEC_OK);
	assert_true(value == LLONG_MIN);
	assert_int_equal(
		spec_number_parse_whole("+007", 1, 9, "n", &value, &error), SPEC_OK);
	assert_int_equal(value, 7);
}

static void
test_number_bytes(void **state)
{
	static const struct {
		const char *text;
		long long value;
	} good[] = {{"1", 1}, {"1023", 1023}, {"1k", 1024}, {"3M", 3LL << 20},
		{"2G", 2LL << 30}, {"1T", 1LL << 40}, {"8388607T", 8388607LL << 40},
		{"9223372036854775807", LLONG_MAX}};
	static const char *const bad[] = {
		"", "k", "1K", "1kB", "1kk", "-1", "+1", "1.5k", " 1", "1 k", "0x1"};
	static const char *const beyond[] = {"0", "0k", "8388608T", "9007199254740992k",
		"9223372036854775808", "99999999999999999999"};
	struct spec_error error = {0};
	long long value;

	(void)state;
	for (size_t i = 0; i < COUNT(good); i++) {
		assert_int_equal(
			spec_number_parse_bytes(good[i].text, "the limit", &value, &error),
			SPEC_OK);
		assert_true(value == good[i].value);
	}
	value = 42;
	for (size_t i = 0; i < COUNT(bad); i++)
		assert_int_equal(
			spec_number_parse_bytes(bad[i], "the limit", &value, &error),
			SPEC_EUSAGE);
	for (size_t i = 0; i < COUNT(beyond); i++)
		assert_int_equal(
			spec_number_parse_bytes(beyond[i], "the limit", &value, &error),
			SPEC_ERANGE);
	assert_int_equal(value, 42);
}

static void
test_number_length(void **state)
{
	static const struct {
		const char *text;
		double nm;
	} good[] = {{"500", 500}, {"500nm", 500}, {"1.5um", 1500}, {"2mm", 2e6},
		{"3cm", 3e7}, {"2m", 2e9}, {"1e-3um", 1}};
	static const char *const bad[] = {"", "nm", "500 nm", "500NM", "500nmx", "500km",
		"5e", "500u", "nan", "inf", "1e999m"};
	static const char *const beyond[] = {"0", "-1", "-500nm", "0um", "-0"};
	struct spec_error error = {0};
	double nm;

	(void)state;
	for (size_t i = 0; i < COUNT(good); i++) {
		assert_int_equal(
			spec_number_parse_length(good[i].text, "the film", &nm, &error),
			SPEC_OK);
		/* One rounding of the number, one of the product. */
		assert_true(fabs(nm - good[i].nm) <= 2 * 0x1p-53 * good[i].nm);
	}
	nm = 42;
	for (size_t i = 0; i < COUNT(bad); i++)
		assert_int_equal(spec_number_parse_length(bad[i], "the film", &nm, &error),
			SPEC_EUSAGE);
	for (size_t i = 0; i < COUNT(beyond); i++)
		assert_int_equal(
			spec_number_parse_length(beyond[i], "the film", &nm, &error),
			SPEC_ERANGE);
	assert_true(nm == 42);
}

/* "Valid: positive and finite": also what the unit makes of the number. */
static void
test_number_length_overflow(void **state)
{
	double nm = 42;

	(void)state;
	assert_int_equal(
		spec_number_parse_length("1e305m", "the film", &nm, NULL), SPEC_ERANGE);
	assert_true(nm == 42);
}

static void
test_number_scan(void **state)
{
	double value;

	(void)state;
	assert_int_equal(spec_number_scan("550,25nm", ',', &value), 6);
	assert_true(value == 550.25);
	assert_int_equal(spec_number_scan("550,25nm", '.', &value), 3);
	assert_int_equal(spec_number_scan("550.25nm", ',', &value), 3);
	assert_int_equal(spec_number_scan("5e3m", '.', &value), 3);
	assert_true(value == 5000);
	assert_int_equal(
		spec_number_scan("5em", '.', &value), 1); /* no exponent: the rest */
	assert_int_equal(spec_number_scan("1e999", '.', &value), 0);
	assert_int_equal(spec_number_scan("nm", '.', &value), 0);
	assert_int_equal(spec_number_scan(",", ',', &value), 0);
	/* Up to 63 characters. */
	for (int length = 63; length <= 64; length++) {
		char many[80];

		snprintf(many, sizeof many, "%0*d", length, 7);
		assert_int_equal(spec_number_scan(many, '.', &value), length < 64 ? 63 : 0);
	}
	assert_int_equal(spec_number_scan(",5", ',', &value), 2);
	assert_true(value == 0.5);
}

/* Memory */

static void
test_memory_overflow(void **state)
{
	struct spec_error error = {0};
	size_t room = 3;
	void *list = malloc(3), *old = list;

	(void)state;
	assert_null(spec_memory_new(SIZE_MAX / 2, 3, "channels", &error));
	assert_int_equal(error.status, SPEC_ENOMEM);
	assert_non_null(strstr(error.message, "channels"));
	assert_null(spec_memory_new(SIZE_MAX, 1, "channels", &error));
	assert_null(spec_memory_new((size_t)1 << 32, (size_t)1 << 32, "channels", NULL));
	error.status = SPEC_OK;
	assert_null(spec_memory_aligned(SIZE_MAX / 4 + 1, 4, "samples", &error));
	assert_int_equal(error.status, SPEC_ENOMEM);
	assert_null(spec_memory_aligned(PTRDIFF_MAX, 1, "samples", NULL));
	/* On failure the list is as it was. */
	assert_int_equal(spec_memory_grow(&list, &room, SIZE_MAX / 16, 32, "lines", &error),
		SPEC_ENOMEM);
	assert_ptr_equal(list, old);
	assert_int_equal(room, 3);
	free(list);
}

static void
test_memory_new(void **state)
{
	unsigned char *bytes = spec_memory_new(1000, 3, "bytes", NULL);

	(void)state;
	assert_non_null(bytes);
	for (size_t i = 0; i < 3000; i++)
		assert_int_equal(bytes[i], 0);
	free(bytes);
	bytes = spec_memory_new(0, 8, "bytes", NULL);
	assert_non_null(bytes);
	free(bytes);
	for (size_t count = 0; count < 200; count += 37) {
		bytes = spec_memory_aligned(count, 1, "bytes", NULL);
		assert_non_null(bytes);
		assert_int_equal((uintptr_t)bytes % 64, 0);
		memset(bytes, 1, count);
		free(bytes);
	}
}

static void
test_memory_grow(void **state)
{
	size_t room = 0;
	void *list = NULL;
	int *number;

	(void)state;
	for (size_t count = 1; count < 2000; count++) {
		size_t before = room;

		assert_int_equal(spec_memory_grow(&list, &room, count, sizeof *number,
					 "numbers", NULL),
			SPEC_OK);
		assert_true(room >= count);
		number = list;
		for (size_t i = before; i < room; i++)
			assert_int_equal(number[i], 0);
		number[count - 1] = (int)count;
	}
	for (size_t i = 0; i < 1999; i++)
		assert_int_equal(number[i], (int)i + 1);
	free(list);
}

static void
test_memory_text(void **state)
{
	char *text = spec_memory_text("abcdef", 3, NULL);

	(void)state;
	assert_string_equal(text, "abc");
	free(text);
}

/* Ascending lists */

static void
test_intervals(void **state)
{
	static const double edge[] = {1, 2, 3, 5, 8, 13};
	static const struct {
		double value;
		size_t found, count; /* of 5 intervals, and of 6 edges */
	} cases[] = {{-HUGE_VAL, 0, 0}, {.5, 0, 0}, {1, 0, 1}, {1.5, 0, 1}, {2, 1, 2},
		{2.5, 1, 2}, {3, 2, 3}, {5, 3, 4}, {7.9, 3, 4}, {8, 4, 5}, {12, 4, 5},
		{13, 4, 6}, {20, 4, 6}, {HUGE_VAL, 4, 6}, {NAN, 0, 0}};

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		double value = cases[i].value;

		assert_int_equal(spec_interval_find(edge, 5, value), cases[i].found);
		assert_int_equal(spec_interval_count(edge, 6, value), cases[i].count);
		assert_int_equal(spec_interval_find(edge, 1, value), 0);
		assert_int_equal(spec_interval_find(edge, 0, value), 0);
		assert_int_equal(spec_interval_count(edge, 1, value), value >= 1);
		assert_int_equal(spec_interval_count(edge, 0, value), 0);
	}
}

/* Output. Each test runs in an empty folder, which must hold only what it says at the end. */

struct fixture {
	char folder[64];
	char path[128];
	struct spec_error error;
};

static int
set_up(void **state)
{
	struct fixture *fixture = calloc(1, sizeof *fixture);

	assert_non_null(fixture);
	strcpy(fixture->folder, "/tmp/base.XXXXXX");
	assert_non_null(mkdtemp(fixture->folder));
	snprintf(fixture->path, sizeof fixture->path, "%s/result", fixture->folder);
	*state = fixture;
	return 0;
}

static int
tear_down(void **state)
{
	struct fixture *fixture = *state;

	unlink(fixture->path);
	assert_int_equal(rmdir(fixture->folder), 0); /* nothing else was left in it */
	free(fixture);
	return 0;
}

static void
put_file(const char *path, const char *text)
{
	FILE *stream = fopen(path, "w");

	assert_non_null(stream);
	assert_true(fputs(text, stream) >= 0);
	assert_int_equal(fclose(stream), 0);
}

static void
assert_file(const char *path, const char *text)
{
	char bytes[256] = "";
	FILE *stream = fopen(path, "r");

	assert_non_null(stream);
	bytes[fread(bytes, 1, sizeof bytes - 1, stream)] = '\0';
	fclose(stream);
	assert_string_equal(bytes, text);
}

static int
entries_of(const char *folder)
{
	DIR *stream = opendir(folder);
	int count = -2; /* . and .. */

	assert_non_null(stream);
	while (readdir(stream))
		count++;
	closedir(stream);
	return count;
}

static mode_t
mode_of(const char *path)
{
	struct stat status;

	assert_int_equal(stat(path, &status), 0);
	return status.st_mode & 0777;
}

static void
open_output(struct fixture *fixture, struct spec_output *output)
{
	if (spec_output_open(output, fixture->path, &fixture->error) != SPEC_OK)
		fail_msg("%s", fixture->error.message);
	assert_int_equal(output->seekable, 1);
	assert_int_equal(output->terminal, 0);
}

static void
test_output_commit(void **state)
{
	struct fixture *fixture = *state;
	struct spec_output output;
	struct stat before, after;
	mode_t mask = umask(027);
	int fd;

	open_output(fixture, &output);
	assert_int_equal(spec_output_write(&output, "new ", 4, NULL), SPEC_OK);
	assert_int_equal(output.position, 4);
	assert_int_equal(access(fixture->path, F_OK), -1); /* not before it is whole */
	assert_int_equal(spec_output_write_at(&output, "there", 5, 4, NULL), SPEC_OK);
	assert_int_equal(spec_output_commit(&output, &fixture->error), SPEC_OK);
	assert_file(fixture->path, "new there");
	assert_int_equal(mode_of(fixture->path), 0640); /* as the mask has it */
	assert_int_equal(entries_of(fixture->folder), 1);
	spec_output_abandon(&output); /* harmless */
	assert_file(fixture->path, "new there");
	umask(mask);

	/* Who has the old file open keeps it; its permissions pass on. */
	assert_int_equal(chmod(fixture->path, 0604), 0);
	fd = open(fixture->path, O_RDONLY);
	assert_int_equal(fstat(fd, &before), 0);
	open_output(fixture, &output);
	assert_int_equal(spec_output_write(&output, "newer", 5, NULL), SPEC_OK);
	assert_file(fixture->path, "new there");
	assert_int_equal(spec_output_commit(&output, &fixture->error), SPEC_OK);
	assert_file(fixture->path, "newer");
	assert_int_equal(mode_of(fixture->path), 0604);
	assert_int_equal(stat(fixture->path, &after), 0);
	assert_true(before.st_ino != after.st_ino);
	assert_int_equal(fstat(fd, &before), 0);
	assert_int_equal(before.st_size, 9);
	close(fd);
	assert_int_equal(entries_of(fixture->folder), 1);
}

static void
test_output_abandon(void **state)
{
	struct fixture *fixture = *state;
	struct spec_output output;

	open_output(fixture, &output);
	assert_int_equal(spec_output_write(&output, "half", 4, NULL), SPEC_OK);
	spec_output_abandon(&output);
	assert_int_equal(entries_of(fixture->folder), 0);
	put_file(fixture->path, "old");
	open_output(fixture, &output);
	assert_int_equal(spec_output_write(&output, "half", 4, NULL), SPEC_OK);
	spec_output_abandon(&output);
	spec_output_abandon(&output);
	assert_file(fixture->path, "old");
	assert_int_equal(entries_of(fixture->folder), 1);
}

/* A killed process leaves nothing: the file has no name yet (where there is O_TMPFILE). */
static void
test_output_killed(void **state)
{
	struct fixture *fixture = *state;
	int probe = open(fixture->folder, O_TMPFILE | O_WRONLY, 0600), status;
	pid_t child;

	if (probe < 0)
		skip();
	close(probe);
	put_file(fixture->path, "old");
	child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		struct spec_output output;

		if (spec_output_open(&output, fixture->path, NULL) != SPEC_OK ||
			spec_output_write(&output, "half", 4, NULL) != SPEC_OK)
			_exit(1);
		raise(SIGKILL);
	}
	assert_int_equal(waitpid(child, &status, 0), child);
	assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
	assert_file(fixture->path, "old");
	assert_int_equal(entries_of(fixture->folder), 1);
}

/* What a symbolic link points to is replaced; the link stays. */
static void
test_output_symlink(void **state)
{
	struct fixture *fixture = *state;
	struct spec_output output;
	struct stat status;
	char real[160];

	snprintf(real, sizeof real, "%s/real", fixture->folder);
	put_file(real, "old");
	assert_int_equal(symlink("real", fixture->path), 0);
	open_output(fixture, &output);
	assert_int_equal(spec_output_write(&output, "new", 3, NULL), SPEC_OK);
	assert_int_equal(spec_output_commit(&output, &fixture->error), SPEC_OK);
	assert_file(real, "new");
	assert_int_equal(lstat(fixture->path, &status), 0);
	assert_true(S_ISLNK(status.st_mode));
	assert_int_equal(entries_of(fixture->folder), 2);
	unlink(real);
	/* A link to nothing yet makes what it points to. */
	open_output(fixture, &output);
	assert_int_equal(spec_output_write(&output, "new", 3, NULL), SPEC_OK);
	assert_int_equal(access(real, F_OK), -1);
	assert_int_equal(spec_output_commit(&output, &fixture->error), SPEC_OK);
	assert_file(real, "new");
	assert_int_equal(lstat(fixture->path, &status), 0);
	assert_true(S_ISLNK(status.st_mode));
	assert_int_equal(entries_of(fixture->folder), 2);
	unlink(real);
	/* A link to itself leads nowhere. */
	unlink(fixture->path);
	assert_int_equal(symlink("result", fixture->path), 0);
	assert_int_equal(
		spec_output_open(&output, fixture->path, &fixture->error), SPEC_EIO);
	assert_int_equal(entries_of(fixture->folder), 1);
}

static void
test_output_refused(void **state)
{
	struct fixture *fixture = *state;
	struct spec_output output;
	char path[160];

	assert_int_equal(
		spec_output_open(&output, fixture->folder, &fixture->error), SPEC_EIO);
	assert_non_null(strstr(fixture->error.message, "is a directory"));
	assert_int_equal(spec_output_open(&output, "", &fixture->error), SPEC_EIO);
	assert_string_equal(
		fixture->error.message, "unable to write '': No such file or directory");
	snprintf(path, sizeof path, "%s/no/such", fixture->folder);
	assert_int_equal(spec_output_open(&output, path, &fixture->error), SPEC_EIO);
	assert_non_null(strstr(fixture->error.message, "No such file"));
	put_file(fixture->path, "old");
	snprintf(path, sizeof path, "%s/under", fixture->path);
	assert_int_equal(spec_output_open(&output, path, &fixture->error), SPEC_EIO);
	if (geteuid() != 0) { /* root may write anything */
		chmod(fixture->path, 0400);
		assert_int_equal(spec_output_open(&output, fixture->path, &fixture->error),
			SPEC_EIO);
	}
	assert_file(fixture->path, "old");
}

/* The folder goes away before the commit: an error, and nothing is left open or behind. */
static void
test_output_lost_folder(void **state)
{
	struct fixture *fixture = *state;
	struct spec_output output;
	char folder[80];

	snprintf(folder, sizeof folder, "%s/sub", fixture->folder);
	snprintf(fixture->path, sizeof fixture->path, "%s/result", folder);
	assert_int_equal(mkdir(folder, 0700), 0);
	open_output(fixture, &output);
	assert_int_equal(spec_output_write(&output, "x", 1, NULL), SPEC_OK);
	assert_int_equal(rmdir(folder), 0);
	assert_int_equal(spec_output_commit(&output, &fixture->error), SPEC_EIO);
	assert_int_equal(output.fd, -1);
}

static void
test_output_full(void **state)
{
	struct fixture *fixture = *state;
	struct spec_output output;

	if (access("/dev/full", W_OK) != 0)
		skip();
	assert_int_equal(spec_output_open(&output, "/dev/full", &fixture->error), SPEC_OK);
	assert_int_equal(output.seekable, 0);
	assert_int_equal(spec_output_write(&output, "x", 1, &fixture->error), SPEC_EIO);
	assert_string_equal(fixture->error.message,
		"unable to write '/dev/full': No space left on device");
	spec_output_abandon(&output);
	assert_int_equal(access("/dev/full", F_OK), 0);
}

/* A FIFO is written in place. */
static void
test_output_fifo(void **state)
{
	struct fixture *fixture = *state;
	struct spec_output output;
	char bytes[8] = "";
	int fd;

	assert_int_equal(mkfifo(fixture->path, 0600), 0);
	fd = open(fixture->path, O_RDONLY | O_NONBLOCK);
	assert_true(fd >= 0);
	assert_int_equal(
		spec_output_open(&output, fixture->path, &fixture->error), SPEC_OK);
	assert_int_equal(output.seekable, 0);
	assert_int_equal(spec_output_write(&output, "through", 7, NULL), SPEC_OK);
	assert_int_equal(spec_output_commit(&output, &fixture->error), SPEC_OK);
	assert_int_equal(read(fd, bytes, sizeof bytes), 7);
	assert_string_equal(bytes, "through");
	close(fd);
	assert_int_equal(entries_of(fixture->folder), 1);
}

/* Runs work in a process whose standard output is fd; returns its exit status. */
static int
with_stdout(int fd, int (*work)(void))
{
	pid_t child;
	int status;

	fflush(NULL);
	child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		if (dup2(fd, STDOUT_FILENO) < 0)
			_exit(99);
		_exit(work());
	}
	assert_int_equal(waitpid(child, &status, 0), child);
	assert_true(WIFEXITED(status));
	return WEXITSTATUS(status);
}

/* Bits: 1 opened, 2 seekable, 4 written, 8 committed. */
static int
write_standard(void)
{
	struct spec_output output;
	int seekable;

	if (spec_output_open(&output, "-", NULL) != SPEC_OK)
		return 0;
	seekable = output.seekable ? 2 : 0;
	if (spec_output_write(&output, "text", 4, NULL) != SPEC_OK) {
		spec_output_abandon(&output);
		return 1 | seekable;
	}
	return 5 | seekable | (spec_output_commit(&output, NULL) == SPEC_OK ? 8 : 0);
}

static int
abandon_standard(void)
{
	struct spec_output output;

	if (spec_output_open(&output, "-", NULL) != SPEC_OK ||
		strcmp(output.path, "<stdout>") != 0 ||
		spec_output_write(&output, "text", 4, NULL) != SPEC_OK)
		return 0;
	spec_output_abandon(&output);
	return 1;
}

static void
test_output_standard(void **state)
{
	struct fixture *fixture = *state;
	int fd = open(fixture->path, O_RDWR | O_CREAT | O_TRUNC, 0600), ends[2];

	assert_true(fd >= 0);
	/* At its beginning a file is a file; half of it is taken back. */
	assert_int_equal(with_stdout(fd, abandon_standard), 1);
	assert_file(fixture->path, "");
	assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
	assert_int_equal(with_stdout(fd, write_standard), 15);
	assert_file(fixture->path, "text");
	/* Behind what is there already it is a stream, which stays. */
	assert_int_equal(lseek(fd, 0, SEEK_END), 4);
	assert_int_equal(with_stdout(fd, write_standard), 13);
	assert_file(fixture->path, "texttext");
	assert_int_equal(with_stdout(fd, abandon_standard), 1);
	assert_file(fixture->path, "texttexttext");
	close(fd);
	/* So it is in append mode. */
	fd = open(fixture->path, O_WRONLY | O_APPEND);
	assert_int_equal(with_stdout(fd, write_standard), 13);
	close(fd);
	assert_file(fixture->path, "texttexttexttext");
	assert_int_equal(pipe(ends), 0);
	assert_int_equal(with_stdout(ends[1], write_standard), 13);
	close(ends[0]);
	close(ends[1]);
	if (access("/dev/full", W_OK) == 0) {
		fd = open("/dev/full", O_WRONLY);
		assert_int_equal(with_stdout(fd, write_standard), 1);
		close(fd);
	}
}

static int
write_closed(void)
{
	close(STDOUT_FILENO);
	return write_standard();
}

static void
test_output_closed(void **state)
{
	(void)state;
	assert_int_equal(with_stdout(STDERR_FILENO, write_closed), 0);
}

static void
test_output_scratch(void **state)
{
	struct fixture *fixture = *state;
	char bytes[4] = "";
	int fd;

	setenv("TMPDIR", fixture->folder, 1);
	assert_int_equal(spec_output_scratch(&fd, &fixture->error), SPEC_OK);
	assert_true(fd >= 0);
	assert_int_equal(write(fd, "abc", 3), 3);
	assert_int_equal(pread(fd, bytes, 3, 0), 3);
	assert_string_equal(bytes, "abc");
	assert_int_equal(entries_of(fixture->folder), 0); /* nameless */
	close(fd);
	setenv("TMPDIR", "/no/such/folder", 1);
	assert_int_equal(spec_output_scratch(&fd, &fixture->error), SPEC_EIO);
	assert_int_equal(fixture->error.status, SPEC_EIO);
	assert_non_null(strstr(fixture->error.message, "/no/such/folder"));
	unsetenv("TMPDIR");
}

/* Input */

#define STREAM_BYTES                                                                       \
	300000 /* more than a pipe holds unasked, so that it is read in parts */

static unsigned char
byte_at(size_t at)
{
	return (unsigned char)(at * 2654435761u >> 13);
}

static pid_t
start_stream(char path[32], int *end)
{
	int ends[2];
	pid_t child;

	assert_int_equal(pipe(ends), 0);
	child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		unsigned char bytes[1000];

		close(ends[0]);
		for (size_t at = 0; at < STREAM_BYTES; at += sizeof bytes) {
			for (size_t i = 0; i < sizeof bytes; i++)
				bytes[i] = byte_at(at + i);
			if (write(ends[1], bytes, sizeof bytes) < 0)
				break;
		}
		_exit(0);
	}
	close(ends[1]);
	*end = ends[0];
	snprintf(path, 32, "/dev/fd/%d", ends[0]);
	return child;
}

static void
end_stream(pid_t child, int end)
{
	close(end);
	assert_int_equal(waitpid(child, NULL, 0), child);
}

/* Reads size bytes at offset and checks that they are, or as many as there are. */
static void
assert_read(struct spec_source *source, size_t size, int64_t offset, size_t expected)
{
	unsigned char *bytes = malloc(size + 1);
	struct spec_error error = {0};
	size_t got;

	assert_non_null(bytes);
	if (spec_source_read(source, bytes, size, offset, &got, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	assert_int_equal(got, expected);
	for (size_t i = 0; i < got; i++)
		assert_int_equal(bytes[i], byte_at((size_t)offset + i));
	free(bytes);
}

static enum spec_status
try_read(struct spec_source *source, size_t size, int64_t offset, struct spec_error *error)
{
	unsigned char *bytes = malloc(size + 1);
	enum spec_status status;
	size_t got;

	assert_non_null(bytes);
	status = spec_source_read(source, bytes, size, offset, &got, error);
	free(bytes);
	return status;
}

static void
test_source_pipe(void **state)
{
	struct spec_error error = {0};
	struct spec_source source;
	char path[32];
	int end;
	pid_t child = start_stream(path, &end);

	(void)state;
	assert_int_equal(spec_source_open(&source, path, 10000, &error), SPEC_OK);
	assert_int_equal(source.seekable, 0);
	assert_int_equal(source.size, -1);
	/* Until it is sealed the head can be read again and again. */
	assert_read(&source, 8, 0, 8);
	assert_read(&source, 4096, 8, 4096);
	assert_read(&source, 100, 3, 100);
	assert_read(&source, 100, 9000, 100);
	assert_read(&source, 10000, 0, 10000);
	assert_int_equal(try_read(&source, 1, 10000, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "limit of 10000 bytes"));
	assert_non_null(strstr(error.message, "--limit header"));
	spec_source_seal(&source);
	/* The head is still there, and joins what follows; then there is no way back. */
	assert_read(&source, 9000, 500, 9000);
	assert_read(&source, 5000, 8000, 5000);
	assert_read(&source, 100000, 50000, 100000); /* skips */
	assert_int_equal(try_read(&source, 10, 149995, &error), SPEC_EFORMAT);
	assert_read(&source, 10, 150000, 10);
	assert_read(&source, 100000, STREAM_BYTES - 10, 10); /* the end is no error */
	assert_read(&source, 1, STREAM_BYTES, 0);
	assert_read(&source, 1, STREAM_BYTES + 1000, 0);
	spec_source_close(&source);
	end_stream(child, end);
}

static void
test_source_spool(void **state)
{
	struct fixture *fixture = *state;
	struct spec_error error = {0};
	struct spec_source source;
	char path[32];
	int end;
	pid_t child = start_stream(path, &end);

	setenv("TMPDIR", fixture->folder, 1);
	assert_int_equal(spec_source_open(&source, path, 10000, &error), SPEC_OK);
	assert_read(&source, 5000, 1000, 5000);
	assert_int_equal(spec_source_spool(&source, &error), SPEC_OK);
	spec_source_seal(&source);
	assert_int_equal(source.seekable, 1);
	assert_int_equal(source.size, STREAM_BYTES);
	assert_read(&source, 1000, STREAM_BYTES - 500, 500);
	assert_read(&source, 20000, 0, 20000);
	assert_read(&source, 20000, 100000, 20000);
	spec_source_close(&source);
	end_stream(child, end);
	assert_int_equal(entries_of(fixture->folder), 0);
	/* No room for it: an error, and the source can be closed. */
	child = start_stream(path, &end);
	setenv("TMPDIR", "/no/such/folder", 1);
	assert_int_equal(spec_source_open(&source, path, 10000, &error), SPEC_OK);
	assert_int_equal(spec_source_spool(&source, &error), SPEC_EIO);
	spec_source_close(&source);
	end_stream(child, end);
	unsetenv("TMPDIR");
}

static void
test_source_file(void **state)
{
	struct fixture *fixture = *state;
	struct spec_error error = {0};
	struct spec_source source;
	FILE *stream = fopen(fixture->path, "wb");

	assert_non_null(stream);
	for (size_t i = 0; i < 20000; i++)
		fputc(byte_at(i), stream);
	assert_int_equal(fclose(stream), 0);
	assert_int_equal(spec_source_open(&source, fixture->path, 10000, &error), SPEC_OK);
	assert_int_equal(source.seekable, 1);
	assert_int_equal(source.size, 20000);
	assert_read(&source, 5000, 5000, 5000);
	assert_read(&source, 5001, 5000, 5000); /* who looks ahead is not refused */
	assert_int_equal(try_read(&source, 1, 10000, &error), SPEC_ERANGE);
	spec_source_seal(&source);
	assert_read(&source, 20000, 10000, 10000);
	assert_read(&source, 100, 0, 100);
	assert_read(&source, 100, 30000, 0);
	assert_int_equal(try_read(&source, 1, -1, &error), SPEC_EFORMAT);
	assert_int_equal(try_read(&source, 1, INT64_MAX, &error), SPEC_EFORMAT);
	spec_source_close(&source);
	spec_source_close(&source); /* harmless */
	assert_int_equal(spec_source_open(&source, fixture->folder, 10, &error), SPEC_EIO);
	assert_non_null(strstr(error.message, "is a directory"));
	assert_int_equal(spec_source_open(&source, "/no/such", 10, &error), SPEC_EIO);
	assert_non_null(strstr(error.message, "'/no/such'"));
}

/* Standard input that stands in the middle of a file begins there. */
static int
first_byte(const char *path)
{
	unsigned char byte;

	return spec_source_peek(path, &byte, 1) == 1 ? byte : -1;
}

static void
test_source_offset(void **state)
{
	struct fixture *fixture = *state;
	int before = dup(STDIN_FILENO), fd;
	struct spec_error error = {0};
	struct spec_source source;
	unsigned char bytes[8];
	size_t got;

	put_file(fixture->path, "0123456789");
	fd = open(fixture->path, O_RDONLY);
	assert_int_equal(lseek(fd, 4, SEEK_SET), 4);
	assert_int_equal(dup2(fd, STDIN_FILENO), STDIN_FILENO);
	close(fd);
	assert_int_equal(first_byte("-"), '4');
	assert_int_equal(spec_source_open(&source, "-", 100, &error), SPEC_OK);
	assert_string_equal(source.name, "<stdin>");
	assert_int_equal(source.size, 6);
	assert_int_equal(spec_source_read(&source, bytes, 3, 1, &got, &error), SPEC_OK);
	assert_int_equal(got, 3);
	assert_memory_equal(bytes, "567", 3);
	spec_source_close(&source);
	assert_int_equal(dup2(before, STDIN_FILENO), STDIN_FILENO);
	close(before);
}

static void
test_source_peek(void **state)
{
	struct fixture *fixture = *state;
	char path[32], bytes[8], byte;
	int ends[2];

	assert_int_equal(first_byte(fixture->path), -1); /* nothing there */
	put_file(fixture->path, "");
	assert_int_equal(first_byte(fixture->path), -1);
	put_file(fixture->path, "vw");
	assert_int_equal(first_byte(fixture->path), 'v');
	assert_int_equal(first_byte(fixture->folder), -1);
	/* What is peeked at in a pipe is still there. */
	assert_int_equal(pipe(ends), 0);
	assert_int_equal(write(ends[1], "xy", 2), 2);
	snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
	assert_int_equal(spec_source_peek(path, bytes, sizeof bytes), 2);
	assert_memory_equal(bytes, "xy", 2);
	assert_int_equal(first_byte(path), 'x');
	assert_int_equal(read(ends[0], &byte, 1), 1);
	assert_int_equal(byte, 'x');
	assert_int_equal(first_byte(path), 'y');
	close(ends[1]);
	assert_int_equal(read(ends[0], &byte, 1), 1);
	assert_int_equal(first_byte(path), -1); /* at its end */
	close(ends[0]);
	/* A named FIFO is left alone: opening it would take its writer's wait away. */
	unlink(fixture->path);
	assert_int_equal(mkfifo(fixture->path, 0600), 0);
	assert_int_equal(first_byte(fixture->path), -1);
}

/* Threads */

#define THREADS 16
#define TICKETS 2000

struct queue {
	struct spec_turnstile turnstile;
	atomic_llong next_ticket;
	long long passed[TICKETS];
	long long count;       /* guarded by the turnstile */
	atomic_int inside;     /* how many are in it */
	atomic_int most;       /* more than 1: two at once */
	long long stop_at;     /* the ticket that stops all, or -1 */
	atomic_int turned_off; /* workers that were sent away */
};

static void
pass(void *argument, int worker)
{
	struct queue *queue = argument;
	long long ticket;

	while ((ticket = atomic_fetch_add(&queue->next_ticket, 1)) < TICKETS) {
		if (ticket % 7 == worker % 7)
			sched_yield(); /* some disorder */
		if (!spec_turnstile_enter(&queue->turnstile, ticket)) {
			queue->turned_off++;
			return;
		}
		if (++queue->inside > 1)
			queue->most = 2;
		if (ticket == queue->stop_at) {
			struct spec_error error;

			spec_error_set(&error, SPEC_EIO, "stopped at %lld", ticket);
			queue->inside--;
			spec_turnstile_stop(&queue->turnstile, &error);
			return;
		}
		queue->passed[queue->count++] = ticket;
		queue->inside--;
		spec_turnstile_leave(&queue->turnstile);
	}
}

static void
test_turnstile_order(void **state)
{
	static struct queue queue;
	struct spec_error error;

	(void)state;
	queue.stop_at = -1;
	spec_turnstile_init(&queue.turnstile);
	assert_int_equal(spec_parallel_run(THREADS, pass, &queue, &error), SPEC_OK);
	assert_int_equal(spec_turnstile_status(&queue.turnstile, &error), SPEC_OK);
	spec_turnstile_destroy(&queue.turnstile);
	assert_int_equal(queue.count, TICKETS);
	assert_int_equal(queue.most, 0);
	for (long long i = 0; i < TICKETS; i++)
		assert_int_equal(queue.passed[i], i);
}

static void
test_turnstile_stop(void **state)
{
	static struct queue queue;
	struct spec_error error, later;

	(void)state;
	queue.stop_at = 700;
	spec_turnstile_init(&queue.turnstile);
	/* It returns: nobody waits for ever. */
	assert_int_equal(spec_parallel_run(THREADS, pass, &queue, &error), SPEC_OK);
	assert_int_equal(queue.count, 700);
	for (long long i = 0; i < 700; i++)
		assert_int_equal(queue.passed[i], i);
	assert_int_equal(queue.turned_off, THREADS - 1);
	/* The first error is kept. */
	spec_error_set(&later, SPEC_ENOMEM, "later");
	spec_turnstile_stop(&queue.turnstile, &later);
	assert_int_equal(spec_turnstile_status(&queue.turnstile, &error), SPEC_EIO);
	assert_string_equal(error.message, "stopped at 700");
	assert_int_equal(spec_turnstile_status(&queue.turnstile, NULL), SPEC_EIO);
	assert_int_equal(spec_turnstile_enter(&queue.turnstile, 700), 0);
	spec_turnstile_destroy(&queue.turnstile);
}

static void
mark(void *argument, int worker)
{
	atomic_int *marks = argument;

	marks[worker]++;
}

static void
test_parallel(void **state)
{
	atomic_int marks[THREADS] = {0};

	(void)state;
	assert_true(spec_parallel_processors() >= 1);
	assert_int_equal(spec_parallel_run(THREADS, mark, marks, NULL), SPEC_OK);
	for (int i = 0; i < THREADS; i++)
		assert_int_equal(marks[i], 1);
	assert_int_equal(spec_parallel_run(1, mark, marks, NULL), SPEC_OK);
	assert_int_equal(marks[0], 2);
	assert_int_equal(marks[1], 1);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_path),
		cmocka_unit_test(test_intervals),
		cmocka_unit_test(test_error_line_breaks),
		cmocka_unit_test(test_error_system),
		cmocka_unit_test(test_error_prefix),
		cmocka_unit_test(test_error_long),
		cmocka_unit_test(test_number_junk),
		cmocka_unit_test(test_number_values),
		cmocka_unit_test(test_number_range),
		cmocka_unit_test(test_number_whole),
		cmocka_unit_test(test_number_bytes),
		cmocka_unit_test(test_number_length),
		cmocka_unit_test(test_number_length_overflow),
		cmocka_unit_test(test_number_scan),
		cmocka_unit_test(test_memory_overflow),
		cmocka_unit_test(test_memory_new),
		cmocka_unit_test(test_memory_grow),
		cmocka_unit_test(test_memory_text),
		cmocka_unit_test_setup_teardown(test_output_commit, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_abandon, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_killed, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_symlink, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_refused, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_lost_folder, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_full, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_fifo, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_standard, set_up, tear_down),
		cmocka_unit_test(test_output_closed),
		cmocka_unit_test_setup_teardown(test_output_scratch, set_up, tear_down),
		cmocka_unit_test(test_source_pipe),
		cmocka_unit_test_setup_teardown(test_source_spool, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_source_file, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_source_offset, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_source_peek, set_up, tear_down),
		cmocka_unit_test(test_turnstile_order),
		cmocka_unit_test(test_turnstile_stop),
		cmocka_unit_test(test_parallel),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
