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
