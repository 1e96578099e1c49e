#include "image/kind.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/source.h"
#include "image/reader.h"
#include "image/writer.h"

#define UTF_8_MARK 0xef /* its first byte */

static int
has_suffix(const char *path, const char *suffix)
{
	size_t length = strlen(path), tail = strlen(suffix);

	return length > tail && strcasecmp(path + length - tail, suffix) == 0;
}

int
spec_kind_is_text_name(const char *path)
{
	return has_suffix(path, ".spd") || has_suffix(path, ".txt") ||
	       has_suffix(path, ".csv");
}

static int
has_image_suffix(const char *path)
{
	const char *point = strrchr(path, '.');

	return point && point > path && !strchr(point, '/') &&
	       spec_writer_knows_suffix(point);
}

int
spec_kind_is_curve(const char *path)
{
	unsigned char byte;

	if (spec_kind_is_text_name(path))
		return 1;
	if (spec_reader_recognises(path) || has_image_suffix(path))
		return 0;
	if (strcmp(path, "-") == 0 || strncmp(path, "/dev/fd/", 8) == 0)
		return spec_source_peek(path, &byte, 1) == 1 &&
		       (isprint(byte) || isspace(byte) || byte == UTF_8_MARK);
	return access(path, F_OK) != 0 && path[0] != '/' && path[0] != '.';
}
