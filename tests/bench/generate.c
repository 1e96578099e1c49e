/*
 * A large spectral image on a pipe, made as fast as a pipe can take it: the pages of a few
 * lines made beforehand are lent to the pipe again and again (vmsplice), and nothing is
 * copied on this side.
 *
 *   bench-generate WIDTHxHEIGHT LO:HI:STEP > pipe
 *
 * An OpenEXR image of light, FLOAT, without compression; the grid is in nm. Samples lie
 * between 0.25 and 0.75; 4 different lines take turns.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

#define PIPE_BYTES (1 << 20)
#define MOST_BANDS 10000
#define DIFFERENT 4 /* lines made: together they should not fit into a cache */
#define PAGE 4096

struct header {
	unsigned char *byte;
	size_t used, room;
};

static _Noreturn void
die(const char *message)
{
	fprintf(stderr, "bench-generate: %s\n", message);
	exit(2);
}

static void
put(struct header *header, const void *data, size_t size)
{
	while (header->used + size > header->room) {
		header->room = header->room ? 2 * header->room : 1 << 16;
		header->byte = realloc(header->byte, header->room);
		if (!header->byte)
			die("no memory for a header");
	}
	memcpy(header->byte + header->used, data, size);
	header->used += size;
}

static void
put_number(struct header *header, int32_t number)
{
	put(header, &number, sizeof number);
}

static void
put_text(struct header *header, const char *text)
{
	put(header, text, strlen(text) + 1);
}

static void
put_attribute(struct header *header, const char *name, const char *type, const void *value,
	size_t size)
{
	put_text(header, name);
	put_text(header, type);
	put_number(header, (int32_t)size);
	put(header, value, size);
}

static void
put_string(struct header *header, const char *name, const char *text)
{
	put_attribute(header, name, "string", text, strlen(text));
}

/* OpenEXR's pixel type 2 is FLOAT; then pLinear and its padding; x and y sampling. */
static void
put_channels(struct header *header, double low_nm, double step_nm, size_t bands)
{
	static const int32_t rest[4] = {2, 0, 1, 1};
	struct header list = {0};
	char name[64];

	for (size_t i = 0; i < bands; i++) {
		snprintf(name, sizeof name, "S0.%.6fnm", low_nm + (double)i * step_nm);
		*strchr(name + 3, '.') = ',';
		put_text(&list, name);
		put(&list, rest, sizeof rest);
	}
	put(&list, "", 1);
	put_attribute(header, "channels", "chlist", list.byte, list.used);
	free(list.byte);
}

static void
put_header(struct header *header, int width, int height, double low_nm, double step_nm,
	size_t bands)
{
	const int32_t window[4] = {0, 0, width - 1, height - 1};
	const float one = 1, centre[2] = {0, 0};

	put_number(header, 20000630);
	put_number(header, 2);
	put_channels(header, low_nm, step_nm, bands);
	put_attribute(header, "compression", "compression", "", 1);
	put_attribute(header, "dataWindow", "box2i", window, sizeof window);
	put_attribute(header, "displayWindow", "box2i", window, sizeof window);
	put_attribute(header, "lineOrder", "lineOrder", "", 1);
	put_attribute(header, "pixelAspectRatio", "float", &one, sizeof one);
	put_attribute(header, "screenWindowCenter", "v2f", centre, sizeof centre);
	put_attribute(header, "screenWindowWidth", "float", &one, sizeof one);
	put_string(header, "spectralLayoutVersion", "1.0");
	put_string(header, "emissiveUnits", "W.m^-2.sr^-1");
	put(header, "", 1);
}

static void
put_offsets(struct header *header, int height, size_t line_bytes)
{
	uint64_t offset = header->used + (uint64_t)height * sizeof offset;

	for (int y = 0; y < height; y++, offset += 2 * sizeof(int32_t) + line_bytes)
		put(header, &offset, sizeof offset);
}

static void
write_all(const unsigned char *byte, size_t size)
{
	while (size > 0) {
		ssize_t part = write(STDOUT_FILENO, byte, size);

		if (part < 0 && errno == EINTR)
			continue;
		if (part < 0)
			die(strerror(errno));
		byte += part;
		size -= (size_t)part;
	}
}

/* The bytes must stay as they are until they have been read. */
static void
lend_all(const unsigned char *byte, size_t size)
{
	while (size > 0) {
		struct iovec part = {(void *)byte, size};
		ssize_t lent = vmsplice(STDOUT_FILENO, &part, 1, 0);

		if (lent < 0 && errno == EINTR)
			continue;
		if (lent < 0 && errno == EBADF) { /* it is no pipe */
			write_all(byte, size);
			return;
		}
		if (lent < 0)
			die(strerror(errno));
		byte += lent;
		size -= (size_t)lent;
	}
}

static void
fill(float *sample, size_t count, uint32_t noise)
{
	for (size_t i = 0; i < count; i++) {
		noise = noise * 1664525u + 1013904223u; /* Numerical Recipes' generator */
		sample[i] = .25f + (float)(noise >> 8) * 0x1p-25f;
	}
}

static void
send_lines(int lines, size_t line_bytes)
{
	size_t room = (line_bytes + PAGE - 1) / PAGE * PAGE;
	int32_t(*start)[2] = calloc((size_t)lines, sizeof *start);
	unsigned char *line = aligned_alloc(PAGE, DIFFERENT * room);

	if (!start || !line)
		die("no memory for lines");
	for (uint32_t i = 0; i < DIFFERENT; i++)
		fill((float *)(void *)(line + i * room), line_bytes / sizeof(float), i + 1);
	for (int y = 0; y < lines; y++) {
		start[y][0] = y;
		start[y][1] = (int32_t)line_bytes;
		lend_all((const unsigned char *)start[y], sizeof start[y]);
		lend_all(line + (size_t)y % DIFFERENT * room, line_bytes);
	}
	free(start);
	free(line);
}

int
main(int argc, char **argv)
{
	struct header header = {0};
	int width, height;
	double low_nm, high_nm, step_nm, bands;
	size_t line_bytes;

	if (argc != 3 || sscanf(argv[1], "%dx%d", &width, &height) != 2 ||
		sscanf(argv[2], "%lf:%lf:%lf", &low_nm, &high_nm, &step_nm) != 3)
		die("usage: bench-generate WIDTHxHEIGHT LO:HI:STEP > pipe");
	bands = (high_nm - low_nm) / step_nm + 1.5;
	if (width < 1 || height < 1 || width > 1 << 16 || height > 1 << 16 ||
		!(bands >= 1 && bands < MOST_BANDS) || low_nm < 100)
		die("the size or the grid is out of range");
	line_bytes = (size_t)bands * (size_t)width * sizeof(float);
	if (line_bytes > INT32_MAX)
		die("a line is longer than 2 GiB");
	(void)fcntl(STDOUT_FILENO, F_SETPIPE_SZ, PIPE_BYTES);
	put_header(&header, width, height, low_nm, step_nm, (size_t)bands);
	put_offsets(&header, height, line_bytes);
	write_all(header.byte, header.used);
	send_lines(height, line_bytes);
	free(header.byte);
	return 0;
}
