#include "image/kind.h"

#include <ctype.h>
#include <string.h>
#include <unistd.h>

#include "base/path.h"
#include "base/source.h"
#include "image/reader.h"
#include "image/writer.h"

#define UTF_8_MARK 0xef /* its first byte */

int
spec_kind_is_text_name(const char *path)
{
	return spec_path_has_suffix(path, ".spd") || spec_path_has_suffix(path, ".txt") ||
	       spec_path_has_suffix(path, ".csv");
}

int
spec_kind_is_curve(const char *path)
{
	unsigned char byte;

	if (spec_kind_is_text_name(path))
		return 1;
	if (spec_reader_recognises(path) ||
		spec_writer_knows_suffix(spec_path_suffix(path)))
		return 0;
	if (strcmp(path, "-") == 0 || strncmp(path, "/dev/fd/", 8) == 0)
		return spec_source_peek(path, &byte, 1) == 1 &&
		       (isprint(byte) || isspace(byte) || byte == UTF_8_MARK);
	return access(path, F_OK) != 0 && path[0] != '/' && path[0] != '.';
}

enum spec_status
spec_kind_of_format(const char *format, enum spec_kind *kind, struct spec_error *error)
{
	const struct spec_writing_format *found;

	*kind = strcmp(format, "csv") == 0   ? SPEC_KIND_CSV
		: strcmp(format, "spd") == 0 ? SPEC_KIND_SPD
					     : SPEC_KIND_IMAGE;
	return *kind == SPEC_KIND_IMAGE ? spec_writer_choose("-", format, &found, error)
					: SPEC_OK;
}

enum spec_status
spec_kind_of_output(const char *path, enum spec_kind *kind, struct spec_error *error)
{
	const char *suffix = spec_path_suffix(path);
	const struct spec_writing_format *found;

	*kind = SPEC_KIND_UNTOLD;
	if (strcmp(path, "-") == 0 || !*suffix)
		return SPEC_OK;
	if (strncmp(path, "/dev/", 5) == 0 && !spec_kind_is_text_name(path) &&
		!spec_writer_knows_suffix(suffix))
		return SPEC_OK; /* a device's name is not a file's */
	*kind = spec_path_has_suffix(path, ".csv") ? SPEC_KIND_CSV
		: spec_kind_is_text_name(path)     ? SPEC_KIND_SPD
						   : SPEC_KIND_IMAGE;
	return *kind == SPEC_KIND_IMAGE ? spec_writer_choose(path, NULL, &found, error)
					: SPEC_OK;
}
