/*
 * Fuzzes the readers of formats other than OpenEXR: a pair of files as ENVI has them,
 * Radiance's spectral pictures, PNG; and descriptions. Every line is decoded in blocks, and
 * every sample looked at, twice where the input can be read twice: the same must come.
 *
 * The last byte of the input chooses the way. For a pair the first zero byte ends the
 * header, and the data follow.
 */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "image/description.h"
#include "image/reader.h"

#include "walk.h"

#define WAY_PAIR 0
#define WAY_ONE 1 /* file, or pipe with WAY_PIPE */
#define WAY_TEXT 2
#define WAY_KIND 3
#define WAY_PIPE 4
#define WAY_TOLD 8                        /* the user says what the file may not */
#define WAY_BLOCK(way) (1 + ((way) >> 4)) /* lines that are fetched together */

static char folder[] = "/dev/shm/fuzz.XXXXXX";

static void
remove_folder(void)
{
	char path[64];

	snprintf(path, sizeof path, "%s/a.hdr", folder);
	unlink(path);
	snprintf(path, sizeof path, "%s/a.img", folder);
	unlink(path);
	rmdir(folder);
}

int
LLVMFuzzerInitialize(int *argc, char ***argv)
{
	(void)argc;
	(void)argv;
	require(mkdtemp(folder) != NULL, "no folder");
	atexit(remove_folder);
	return 0;
}

static void
save(const char *name, const uint8_t *data, size_t size)
{
	char path[64];
	int fd;

	snprintf(path, sizeof path, "%s/%s", folder, name);
	fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
	require(fd >= 0 && write(fd, data, size) == (ssize_t)size, "a short write");
	close(fd);
}

static void
settle_way(struct spec_settings *settings, int way)
{
	settle(settings);
	if (!(way & WAY_TOLD))
		return;
	settings->read_as = SPEC_ROLE_REFLECTIVE;
	settings->wavelengths = way & 16 ? "400:600:100" : "500";
}

static void
examine(struct spec_reader *reader, int way)
{
	uint64_t sum, again;

	if (!reader)
		return;
	question(spec_reader_image(reader));
	if (walk(reader, NULL, WAY_BLOCK(way), &sum) && !(way & WAY_PIPE)) {
		require(walk(reader, NULL, 3, &again), "it cannot be read again");
		require(sum == again, "it is something else the second time");
	}
	spec_reader_close(reader);
}

static void
read_pair(const uint8_t *data, size_t size, int way)
{
	const uint8_t *end = memchr(data, 0, size);
	size_t header = end ? (size_t)(end - data) : size;
	struct spec_settings settings;
	char path[64];

	if (header < 4 || memcmp(data, "ENVI", 4) != 0)
		return; /* OpenImageIO is not under test */
	settle_way(&settings, way);
	save("a.hdr", data, header);
	save("a.img", end ? end + 1 : data, end ? size - header - 1 : 0);
	snprintf(path, sizeof path, "%s/a.hdr", folder);
	examine(open_path(path, &settings), way & ~WAY_PIPE);
}

/* Only what is read here. */
static void
read_one(const uint8_t *data, size_t size, int way)
{
	int as_pipe = way & WAY_PIPE && size <= PIPE_BYTES, fd;
	struct spec_settings settings;
	char path[64];

	if (size < 10 ||
		(memcmp(data, "\x89PNG\r\n\x1a\n", 8) != 0 &&
			(memcmp(data, "#?RADIANCE", 10) != 0 ||
				!memmem(data, size < 1024 ? size : 1024, "_spectra\n", 9))))
		return;
	settle_way(&settings, way);
	fd = offer(data, size, as_pipe);
	snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
	examine(open_path(path, &settings), as_pipe ? way : way & ~WAY_PIPE);
	close(fd);
}

static void
read_text(const uint8_t *data, size_t size)
{
	struct spec_image image = {.data = {0, 0, 2, 1}, .display = {0, 0, 2, 1}};
	struct spec_description said;
	struct spec_error error = {0};
	char *text = calloc(size + 1, 1);

	require(text != NULL, "no memory");
	memcpy(text, data, size);
	if (spec_description_read(text, &image, &said, &error) == SPEC_OK) {
		require(spec_window_width(&image.data) == 2, "another size");
		spec_description_free(&said);
	} else {
		require(error.message[0], "a failure without a message");
	}
	spec_image_clear(&image);
	free(text);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	int way = size > 0 ? data[size - 1] : 0;

	if (size == 0)
		return 0;
	switch (way & WAY_KIND) {
	case WAY_PAIR:
		read_pair(data, size - 1, way);
		break;
	case WAY_ONE:
		read_one(data, size - 1, way);
		break;
	default:
		read_text(data, size - 1);
	}
	return 0;
}
