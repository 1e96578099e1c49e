#include "image/tiffheader.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define STRIP_BYTES (1 << 16) /* at least, where the image has as many */
#define MOST_ENTRIES 16
#define ALIGNMENT 16 /* of what the directory points to, and of the samples */

enum type { ASCII = 2, SHORT = 3, LONG = 4, RATIONAL = 5, LONG8 = 16 };

/* A field of the directory: count values of a type, or one value for all of them. */
struct entry {
	uint16_t tag;
	enum type type;
	uint64_t count;
	uint64_t value; /* of all, where list and text are null; a RATIONAL is value / 1 */
	const char *text; /* of ASCII */
	uint64_t step;    /* what each value is more than the one before */
	uint64_t last;    /* the last value, where it is another */
	int has_last;
};

struct directory {
	struct entry entry[MOST_ENTRIES];
	size_t entries;
	int big; /* offsets of 8 bytes */
};

static size_t
type_bytes(enum type type)
{
	return type == ASCII ? 1 : type == SHORT ? 2 : type == LONG ? 4 : 8;
}

static size_t
entry_bytes(const struct entry *entry)
{
	return entry->count * type_bytes(entry->type);
}

/* Tags must come in ascending order. */
static struct entry *
add(struct directory *directory, int tag, enum type type, uint64_t count, uint64_t value)
{
	struct entry *entry = &directory->entry[directory->entries++];

	*entry = (struct entry){
		.tag = (uint16_t)tag, .type = type, .count = count, .value = value};
	return entry;
}

static size_t
align(size_t size)
{
	return (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

static size_t
inline_bytes(const struct directory *directory)
{
	return directory->big ? 8 : 4;
}

/* The header and the directory itself. */
static size_t
front_bytes(const struct directory *directory)
{
	return align(directory->big ? 16 + 8 + directory->entries * 20 + 8
				    : 8 + 2 + directory->entries * 12 + 4);
}

/* All that stands before the samples. */
static size_t
whole_bytes(const struct directory *directory)
{
	size_t size = front_bytes(directory);

	for (size_t i = 0; i < directory->entries; i++) {
		size_t bytes = entry_bytes(&directory->entry[i]);

		if (bytes > inline_bytes(directory))
			size += align(bytes);
	}
	return size;
}

static void
fill(const struct spec_tiff_layout *layout, struct directory *directory)
{
	size_t row = layout->width * layout->channels * sizeof(float),
	       rows = row > 0 && row < STRIP_BYTES ? STRIP_BYTES / row : 1, strips;
	enum type offset = directory->big ? LONG8 : LONG;
	struct entry *entry;

	if (layout->height > 0 && rows > layout->height)
		rows = layout->height;
	strips = (layout->height + rows - 1) / rows;
	add(directory, 256, LONG, 1, layout->width);      /* ImageWidth */
	add(directory, 257, LONG, 1, layout->height);     /* ImageLength */
	add(directory, 258, SHORT, layout->channels, 32); /* BitsPerSample */
	add(directory, 259, SHORT, 1, 1);                 /* Compression: none */
	add(directory, 262, SHORT, 1, 1);                 /* Photometric: 0 is black */
	entry = add(directory, 270, ASCII, layout->description_bytes, 0);
	entry->text = layout->description;              /* ImageDescription */
	entry = add(directory, 273, offset, strips, 0); /* StripOffsets */
	entry->step = rows * row;
	add(directory, 274, SHORT, 1, 1);                /* Orientation: from the top */
	add(directory, 277, SHORT, 1, layout->channels); /* SamplesPerPixel */
	add(directory, 278, LONG, 1, rows);              /* RowsPerStrip */
	entry = add(directory, 279, offset, strips, rows * row); /* StripByteCounts */
	entry->has_last = 1;
	entry->last = (layout->height - (strips - 1) * rows) * row;
	add(directory, 282, RATIONAL, 1, 1); /* XResolution */
	add(directory, 283, RATIONAL, 1, 1); /* YResolution */
	add(directory, 296, SHORT, 1, 1);    /* ResolutionUnit: none */
	if (layout->channels > 1)
		add(directory, 338, SHORT, layout->channels - 1,
			0);                              /* ExtraSamples: data */
	add(directory, 339, SHORT, layout->channels, 3); /* SampleFormat: IEEE */
	directory->entry[6].value = whole_bytes(directory);
}

/* So many of a number's low bytes, in this machine's order. */
static void
put(FILE *stream, uint64_t number, size_t bytes)
{
	uint16_t two = (uint16_t)number;
	uint32_t four = (uint32_t)number;

	(void)fwrite(bytes == 2   ? (const void *)&two
		     : bytes == 4 ? (const void *)&four
				  : (const void *)&number,
		bytes, 1, stream);
}

static void
pad(FILE *stream, size_t bytes)
{
	for (; bytes > 0; bytes--)
		fputc(0, stream);
}

static void
put_values(FILE *stream, const struct entry *entry)
{
	if (entry->type == ASCII) {
		(void)fwrite(entry->text, 1, entry->count, stream);
		return;
	}
	for (uint64_t i = 0; i < entry->count; i++) {
		uint64_t value = entry->has_last && i + 1 == entry->count
					 ? entry->last
					 : entry->value + i * entry->step;

		put(stream, value, entry->type == RATIONAL ? 4 : type_bytes(entry->type));
		if (entry->type == RATIONAL)
			put(stream, 1, 4);
	}
}

static void
put_front(FILE *stream, const struct directory *directory)
{
	size_t word = inline_bytes(directory), at = front_bytes(directory);
	int little = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;

	fputs(little ? "II" : "MM", stream);
	put(stream, directory->big ? 43 : 42, 2);
	if (directory->big) {
		put(stream, 8, 2);
		put(stream, 0, 2);
	}
	put(stream, directory->big ? 16 : 8, word);
	put(stream, directory->entries, directory->big ? 8 : 2);
	for (size_t i = 0; i < directory->entries; i++) {
		const struct entry *entry = &directory->entry[i];
		size_t bytes = entry_bytes(entry);

		put(stream, entry->tag, 2);
		put(stream, entry->type, 2);
		put(stream, entry->count, word);
		if (bytes <= word) {
			put_values(stream, entry);
			pad(stream, word - bytes);
		} else {
			put(stream, at, word);
			at += align(bytes);
		}
	}
	put(stream, 0, word); /* no further directory */
}

enum spec_status
spec_tiff_header(const struct spec_tiff_layout *layout, struct spec_text *text,
	struct spec_error *error)
{
	size_t bytes = layout->width * layout->height * layout->channels * sizeof(float),
	       front;
	struct directory directory = {0};

	fill(layout, &directory);
	if (whole_bytes(&directory) + bytes > UINT32_MAX) {
		directory = (struct directory){.big = 1};
		fill(layout, &directory);
	}
	put_front(text->stream, &directory);
	front = directory.big ? 16 + 8 + directory.entries * 20 + 8
			      : 8 + 2 + directory.entries * 12 + 4;
	pad(text->stream, front_bytes(&directory) - front);
	for (size_t i = 0; i < directory.entries; i++) {
		const struct entry *entry = &directory.entry[i];
		size_t size = entry_bytes(entry);

		if (size > inline_bytes(&directory)) {
			put_values(text->stream, entry);
			pad(text->stream, align(size) - size);
		}
	}
	return ferror(text->stream) ? spec_error_set(error, SPEC_ENOMEM, "out of memory")
				    : SPEC_OK;
}
