/*
 * Headers of ENVI files: lines "key = value" after a first line "ENVI", where a value in
 * braces may have several lines. Source: ENVI's documentation, "ENVI Header Files" (NV5
 * Geospatial, 2023).
 */
#ifndef SPEC_IMAGE_ENVIHEADER_H
#define SPEC_IMAGE_ENVIHEADER_H

#include <stddef.h>
#include <stdio.h>

#include "base/error.h"

enum envi_interleave { ENVI_BSQ, ENVI_BIL, ENVI_BIP };

/* Numbers of ENVI's "data type". Complex ones (6, 9) are not read. */
enum envi_type {
	ENVI_U8 = 1,
	ENVI_I16 = 2,
	ENVI_I32 = 3,
	ENVI_F32 = 4,
	ENVI_F64 = 5,
	ENVI_U16 = 12,
	ENVI_U32 = 13,
	ENVI_I64 = 14,
	ENVI_U64 = 15
};

struct envi_field {
	char *key; /* lower case, single blanks; as it stands where it begins with spec: */
	char *value; /* without the braces, trimmed */
};

struct envi_header {
	struct envi_field *field;
	size_t fields, room;
	/* What the fields say. */
	long long samples, lines, bands;
	long long offset; /* bytes before the data */
	int type;         /* enum envi_type */
	int swapped;      /* the other byte order than this machine's */
	enum envi_interleave interleave;
};

/*
 * Reads a header from its text of so many bytes. name stands for the file in messages,
 * which begin "name:line: ". Errors: SPEC_EFORMAT (also a key that stands there twice),
 * SPEC_EUNSUPPORTED (complex numbers, a compressed file), SPEC_ENOMEM. On an error header
 * is empty.
 */
enum spec_status envi_header_parse(const char *text, size_t size, const char *name,
	struct envi_header *header, struct spec_error *error);

void envi_header_free(struct envi_header *header);

/* The value of that key, in lower case, or null. */
const char *envi_header_find(const struct envi_header *header, const char *key);

/*
 * The numbers of a key's list, one for each band; newly allocated, or null where there is
 * no such key. SPEC_EFORMAT: not numbers, or not as many as bands.
 */
enum spec_status envi_header_numbers(const struct envi_header *header, const char *key,
	const char *name, double **number, struct spec_error *error);

/*
 * Our own texts, under keys "spec:…", may hold what ends a value or is trimmed from it:
 * braces, and blanks at either end, are written as % and two hexadecimal digits, and so is
 * the sign %. A % that nothing of that kind follows stands for itself.
 */
void envi_text_write(FILE *file, const char *text, size_t size);
void envi_text_decode(char *text);

/* Bytes of a sample; 0: no such type is read. */
size_t envi_type_bytes(int type);

#endif
