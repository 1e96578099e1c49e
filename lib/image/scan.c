#include "image/scan.h"

#include <string.h>

#define VERSION_BYTE 5     /* the second of the version word: its flags */
#define SEVERAL_PARTS 0x10 /* among those */
#define FIRST_ATTRIBUTE 8  /* after magic number and version */
#define ENTRY_BYTES 16     /* of a channel, after its name: type, linear, sampling */
#define LONGEST_NAME 255

struct scan {
	struct spec_source *source;
	int64_t offset; /* of the byte that comes next */
	int64_t loaded; /* where buffer begins */
	size_t size;
	unsigned char buffer[4096];
	enum spec_status status;
	struct spec_error *error;
};

/* The next byte, or -1 at the end or after an error. */
static int
next(struct scan *scan)
{
	if (scan->offset < scan->loaded ||
		scan->offset >= scan->loaded + (int64_t)scan->size) {
		scan->loaded = scan->offset;
		scan->size = 0;
		if (scan->status == SPEC_OK)
			scan->status = spec_source_read(scan->source, scan->buffer,
				sizeof scan->buffer, scan->offset, &scan->size,
				scan->error);
		if (scan->status != SPEC_OK || scan->size == 0)
			return -1;
	}
	return scan->buffer[scan->offset++ - scan->loaded];
}

/* The length of the text that comes next, kept in text as far as it fits; -1: there is none. */
static int
take_text(struct scan *scan, char *text)
{
	int length = 0, byte;

	while ((byte = next(scan)) > 0) {
		if (length == LONGEST_NAME)
			return -1;
		text[length++] = (char)byte;
	}
	text[length] = '\0';
	return byte < 0 ? -1 : length;
}

static long long
count_entries(struct scan *scan)
{
	char name[LONGEST_NAME + 1];
	long long count = 0;

	while (take_text(scan, name) > 0) {
		scan->offset += ENTRY_BYTES;
		count++;
	}
	return count;
}

/* One attribute; 0 at the end of the part's header or where it cannot be read. */
static int
take_attribute(struct scan *scan, const struct spec_limits *limits)
{
	char name[LONGEST_NAME + 1], type[LONGEST_NAME + 1];
	long long size = 0, count;
	int64_t end;

	if (take_text(scan, name) <= 0 || take_text(scan, type) <= 0)
		return 0;
	for (int i = 0; i < 4; i++) {
		int byte = next(scan);

		if (byte < 0)
			return 0;
		size |= (long long)byte << (8 * i);
	}
	end = scan->offset + size;
	if (size > INT32_MAX)
		return 0;
	count = strcmp(name, "channels") == 0 ? count_entries(scan) : 0;
	if (count > limits->channels) {
		scan->status = spec_error_set(scan->error, SPEC_ERANGE,
			"%s: %lld channels are more than the limit of %lld (--limit channels=N)",
			scan->source->name, count, limits->channels);
		return 0;
	}
	scan->offset = end;
	return scan->status == SPEC_OK;
}

/* The attributes of one part. */
static void
take_part(struct scan *scan, const struct spec_limits *limits)
{
	long long count = 0;

	while (take_attribute(scan, limits)) {
		if (++count <= limits->attributes)
			continue;
		scan->status = spec_error_set(scan->error, SPEC_ERANGE,
			"%s: more attributes than the limit of %lld (--limit attributes=N)",
			scan->source->name, limits->attributes);
		return;
	}
}

enum spec_status
spec_scan_header(struct spec_source *source, const struct spec_limits *limits,
	struct spec_error *error)
{
	struct scan scan = {.source = source, .offset = VERSION_BYTE, .error = error};
	int flags = next(&scan);
	int64_t before;

	scan.offset = FIRST_ATTRIBUTE;
	/* Parts follow one another; an empty one ends them. */
	do {
		before = scan.offset;
		take_part(&scan, limits);
	} while (scan.status == SPEC_OK && flags >= 0 && (flags & SEVERAL_PARTS) != 0 &&
		 scan.offset > before + 1);
	return scan.status;
}
