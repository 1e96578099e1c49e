#include "scene/ply.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"

#define CHUNK 65536       /* bytes read at once */
#define LONGEST_NUMBER 64 /* characters */
#define BLANKS " \t"

enum format { ASCII, LITTLE_ENDIAN_BINARY, BIG_ENDIAN_BINARY };

struct type {
	const char *name, *other;
	size_t bytes;
	int whole;
	double least, most;
};

static const struct type types[] = {{"char", "int8", 1, 1, -128, 127},
	{"uchar", "uint8", 1, 1, 0, 255}, {"short", "int16", 2, 1, -32768, 32767},
	{"ushort", "uint16", 2, 1, 0, 65535},
	{"int", "int32", 4, 1, -2147483648.0, 2147483647},
	{"uint", "uint32", 4, 1, 0, 4294967295.0},
	{"float", "float32", 4, 0, -FLT_MAX, FLT_MAX},
	{"double", "float64", 8, 0, -DBL_MAX, DBL_MAX}};

/* What a value is of a vertex; POINT..POINT + 2 are x, y and z, and so on. */
enum slot { POINT = 0, NORMAL = 3, UV = 6, SLOTS = 8, CORNERS, OTHER };

static const struct {
	const char *name;
	enum slot slot;
} slots[] = {{"x", POINT}, {"y", POINT + 1}, {"z", POINT + 2}, {"nx", NORMAL},
	{"ny", NORMAL + 1}, {"nz", NORMAL + 2}, {"u", UV}, {"v", UV + 1}, {"s", UV},
	{"t", UV + 1}, {"texture_u", UV}, {"texture_v", UV + 1}, {"texture_s", UV},
	{"texture_t", UV + 1}};

struct property {
	const struct type *type, *count; /* count: of a list, else null */
	enum slot slot;
};

enum kind { VERTEX, FACE, ANOTHER };

struct element {
	enum kind kind;
	char name[32]; /* its beginning, for messages */
	size_t count;
	size_t first, properties; /* in the reader's list */
};

struct reader {
	FILE *file;
	const char *name;
	struct spec_error *error;
	struct spec_ply *mesh;
	size_t line;           /* counts from 1; 0 in binary data */
	unsigned char *buffer; /* [CHUNK] */
	size_t at, got;
	enum format format;
	int has_format;
	struct element element[SPEC_PLY_MOST_ELEMENTS];
	size_t elements;
	struct property property[SPEC_PLY_MOST_PROPERTIES];
	size_t properties;
	size_t points, normals, uvs, indices; /* room in the mesh */
};

static enum spec_status fail(const struct reader *reader, enum spec_status status,
	const char *format, ...) __attribute__((format(printf, 3, 4)));

static enum spec_status
fail(const struct reader *reader, enum spec_status status, const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(reader->error, status, format, arguments);
	va_end(arguments);
	if (reader->line == 0)
		spec_error_prefix(reader->error, "%s", reader->name);
	else
		spec_error_prefix(reader->error, "%s:%zu", reader->name, reader->line);
	return status;
}

/* ---- bytes ---- */

/* The next byte, which is left there, or -1 at the end. */
static enum spec_status
peek(struct reader *reader, int *byte)
{
	*byte = -1;
	if (reader->at == reader->got) {
		reader->at = 0;
		reader->got = fread(reader->buffer, 1, CHUNK, reader->file);
		if (reader->got == 0 && ferror(reader->file))
			return spec_error_system(
				reader->error, errno, "unable to read '%s'", reader->name);
	}
	if (reader->at < reader->got)
		*byte = reader->buffer[reader->at];
	return SPEC_OK;
}

/* ---- the header ---- */

/* A line of the header, without its line break. */
static enum spec_status
read_line(struct reader *reader, char *line)
{
	size_t length = 0;
	enum spec_status status;
	int byte;

	reader->line++;
	for (;;) {
		status = peek(reader, &byte);
		if (status != SPEC_OK)
			return status;
		if (byte < 0)
			return fail(reader, SPEC_EFORMAT, "the file ends in its header");
		reader->at++;
		if (byte == '\n')
			break;
		if (byte == '\0')
			return fail(
				reader, SPEC_EFORMAT, "there is a zero byte in the header");
		if (length == SPEC_PLY_LONGEST_LINE)
			return fail(reader, SPEC_ERANGE, "the line is longer than %d bytes",
				SPEC_PLY_LONGEST_LINE);
		line[length++] = (char)byte;
	}
	if (length > 0 && line[length - 1] == '\r')
		length--;
	line[length] = '\0';
	return SPEC_OK;
}

/* The next word of a line, which is cut behind it, and the rest at *line; "": none. */
static char *
take_word(char **line)
{
	char *word = *line + strspn(*line, BLANKS);
	size_t length = strcspn(word, BLANKS);

	*line = word + length;
	if (**line != '\0')
		*(*line)++ = '\0';
	return word;
}

static const struct type *
find_type(const char *name)
{
	for (size_t i = 0; i < sizeof types / sizeof *types; i++)
		if (strcmp(types[i].name, name) == 0 || strcmp(types[i].other, name) == 0)
			return &types[i];
	return NULL;
}

static enum spec_status
read_format(struct reader *reader, char *line)
{
	static const char *const names[] = {
		"ascii", "binary_little_endian", "binary_big_endian"};
	const char *name = take_word(&line), *version = take_word(&line);

	if (reader->has_format)
		return fail(reader, SPEC_EFORMAT, "there are two formats");
	for (int i = 0; i < 3; i++) {
		if (strcmp(name, names[i]) != 0)
			continue;
		reader->format = (enum format)i;
		reader->has_format = 1;
	}
	if (!reader->has_format || strcmp(version, "1.0") != 0)
		return fail(reader, SPEC_EFORMAT,
			"the format is not ascii, binary_little_endian or "
			"binary_big_endian 1.0");
	return SPEC_OK;
}

static enum spec_status
read_element(struct reader *reader, char *line)
{
	const char *name = take_word(&line), *number = take_word(&line);
	struct element *element = &reader->element[reader->elements];
	long long count;

	if (reader->elements == SPEC_PLY_MOST_ELEMENTS)
		return fail(reader, SPEC_ERANGE, "there are more than %d kinds of elements",
			SPEC_PLY_MOST_ELEMENTS);
	if (*name == '\0' || spec_number_parse_whole(number, 0, SPEC_PLY_MOST,
				     "their count", &count, NULL) != SPEC_OK)
		return fail(reader, SPEC_EFORMAT,
			"not an element's name and a count up to %d", SPEC_PLY_MOST);
	*element = (struct element){
		.kind = ANOTHER, .count = (size_t)count, .first = reader->properties};
	snprintf(element->name, sizeof element->name, "%s", name);
	if (strcmp(name, "vertex") == 0)
		element->kind = VERTEX;
	else if (strcmp(name, "face") == 0)
		element->kind = FACE;
	for (size_t i = 0; element->kind != ANOTHER && i < reader->elements; i++)
		if (reader->element[i].kind == element->kind)
			return fail(reader, SPEC_EFORMAT, "the element %s is there twice",
				name);
	reader->elements++;
	return SPEC_OK;
}

/* What a property of the element that the header is about is for. */
static enum slot
find_slot(const struct element *element, const char *name, int list)
{
	if (element->kind == FACE && list &&
		(strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
		return CORNERS;
	for (size_t i = 0; element->kind == VERTEX && i < sizeof slots / sizeof *slots; i++)
		if (!list && strcmp(slots[i].name, name) == 0)
			return slots[i].slot;
	return OTHER;
}

static enum spec_status
read_property(struct reader *reader, char *line)
{
	struct property property = {0};
	struct element *element;
	char *name = take_word(&line);
	int list = strcmp(name, "list") == 0;

	if (reader->elements == 0)
		return fail(reader, SPEC_EFORMAT, "a property before any element");
	if (reader->properties == SPEC_PLY_MOST_PROPERTIES)
		return fail(reader, SPEC_ERANGE, "there are more than %d properties",
			SPEC_PLY_MOST_PROPERTIES);
	element = &reader->element[reader->elements - 1];
	if (list) {
		property.count = find_type(take_word(&line));
		if (!property.count || !property.count->whole)
			return fail(reader, SPEC_EFORMAT,
				"the count of a list is not of a type of whole numbers");
		name = take_word(&line);
	}
	property.type = find_type(name);
	if (!property.type)
		return fail(reader, SPEC_EFORMAT, "there is no type '%.40s'", name);
	name = take_word(&line);
	if (*name == '\0')
		return fail(reader, SPEC_EFORMAT, "a property has no name");
	property.slot = find_slot(element, name, list);
	if (property.slot == CORNERS && !property.type->whole)
		return fail(reader, SPEC_EFORMAT, "%s are not whole numbers", name);
	for (size_t i = 0; property.slot != OTHER && i < element->properties; i++)
		if (reader->property[element->first + i].slot == property.slot)
			return fail(reader, SPEC_EFORMAT,
				"there are two properties like '%.40s'", name);
	reader->property[reader->properties++] = property;
	element->properties++;
	return SPEC_OK;
}

/* The element of a kind, or null. */
static const struct element *
find_element(const struct reader *reader, enum kind kind)
{
	for (size_t i = 0; i < reader->elements; i++)
		if (reader->element[i].kind == kind)
			return &reader->element[i];
	return NULL;
}

static int
has_slot(const struct reader *reader, const struct element *element, int slot)
{
	for (size_t i = 0; i < element->properties; i++)
		if (reader->property[element->first + i].slot == (enum slot)slot)
			return 1;
	return 0;
}

/* Whether an element has all properties of a vector: 1, or 0: none, or -1: some of them. */
static int
has_vector(const struct reader *reader, const struct element *element, int slot, int size)
{
	int count = 0;

	for (int i = 0; i < size; i++)
		count += has_slot(reader, element, slot + i);
	return count == size ? 1 : count == 0 ? 0 : -1;
}

static enum spec_status
check_header(struct reader *reader)
{
	const struct element *vertex = find_element(reader, VERTEX);
	const struct element *face = find_element(reader, FACE);

	if (!reader->has_format)
		return fail(reader, SPEC_EFORMAT, "the header has no format");
	if (!vertex || vertex->count == 0 || has_vector(reader, vertex, POINT, 3) != 1)
		return fail(reader, SPEC_EFORMAT, "there are no vertices with x, y and z");
	if (!face || face->count == 0 || !has_slot(reader, face, CORNERS))
		return fail(reader, SPEC_EFORMAT, "there are no faces with vertex_indices");
	if (has_vector(reader, vertex, NORMAL, 3) < 0)
		return fail(reader, SPEC_EFORMAT, "not all of nx, ny and nz are there");
	if (has_vector(reader, vertex, UV, 2) < 0)
		return fail(reader, SPEC_EFORMAT, "not both of u and v are there");
	return SPEC_OK;
}

static enum spec_status
read_header(struct reader *reader)
{
	char text[SPEC_PLY_LONGEST_LINE + 1];
	int byte;
	enum spec_status status = peek(reader, &byte);

	if (status == SPEC_OK && reader->got >= 2 && byte == 0x1f &&
		reader->buffer[1] == 0x8b)
		return fail(reader, SPEC_EUNSUPPORTED, "it is compressed: unpack it first");
	if (status == SPEC_OK)
		status = read_line(reader, text);
	if (status == SPEC_OK && strcmp(text, "ply") != 0)
		return fail(reader, SPEC_EFORMAT, "the file does not begin with 'ply'");
	while (status == SPEC_OK) {
		char *line = text;
		const char *word;

		status = read_line(reader, text);
		if (status != SPEC_OK)
			break;
		word = take_word(&line);
		if (strcmp(word, "end_header") == 0)
			return check_header(reader);
		if (strcmp(word, "format") == 0)
			status = read_format(reader, line);
		else if (strcmp(word, "element") == 0)
			status = read_element(reader, line);
		else if (strcmp(word, "property") == 0)
			status = read_property(reader, line);
		else if (strcmp(word, "comment") != 0 && strcmp(word, "obj_info") != 0)
			status = fail(reader, SPEC_EFORMAT,
				"'%.40s' has no meaning in a header", word);
	}
	return status;
}

/* ---- values ---- */

static int
is_blank(int byte)
{
	return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

/* Steps over blanks and line breaks; *byte: what comes then, -1 at the end. */
static enum spec_status
skip_blanks(struct reader *reader, int *byte)
{
	enum spec_status status;

	while ((status = peek(reader, byte)) == SPEC_OK && is_blank(*byte)) {
		reader->line += *byte == '\n';
		reader->at++;
	}
	return status;
}

static enum spec_status
read_ascii(struct reader *reader, const struct type *type, double *value)
{
	char word[LONGEST_NUMBER + 1];
	size_t length = 0;
	int byte;
	enum spec_status status = skip_blanks(reader, &byte);

	while (status == SPEC_OK && byte >= 0 && !is_blank(byte) &&
		length < LONGEST_NUMBER) {
		word[length++] = (char)byte;
		reader->at++;
		status = peek(reader, &byte);
	}
	word[length] = '\0';
	if (status != SPEC_OK)
		return status;
	if (length == 0)
		return fail(reader, SPEC_EFORMAT, "the file ends where a number should be");
	if (spec_number_scan(word, '.', value) != length)
		return fail(reader, SPEC_EFORMAT, "'%.40s' is not a number", word);
	if (*value < type->least || *value > type->most ||
		(type->whole && *value != floor(*value)))
		return fail(reader, SPEC_EFORMAT, "%s is not of type %s", word, type->name);
	return SPEC_OK;
}

/* The bits of a number, whose bytes lie in the order of the file. */
static double
decode(const struct type *type, uint64_t bits)
{
	uint32_t small = (uint32_t)bits;
	float single;
	double value;

	if (type->whole) {
		uint64_t sign = (uint64_t)1 << (8 * type->bytes - 1);

		if (type->least < 0 && (bits & sign))
			return (double)bits - 2 * (double)sign;
		return (double)bits;
	}
	if (type->bytes == sizeof single) {
		memcpy(&single, &small, sizeof single);
		return single;
	}
	memcpy(&value, &bits, sizeof value);
	return value;
}

static enum spec_status
read_binary(struct reader *reader, const struct type *type, double *value)
{
	uint64_t bits = 0;

	for (size_t i = 0; i < type->bytes; i++) {
		int byte;
		enum spec_status status = peek(reader, &byte);

		if (status != SPEC_OK)
			return status;
		if (byte < 0)
			return fail(reader, SPEC_EFORMAT,
				"the file ends before all of its header is there");
		reader->at++;
		if (reader->format == BIG_ENDIAN_BINARY)
			bits = bits << 8 | (unsigned)byte;
		else
			bits |= (uint64_t)(unsigned)byte << 8 * i;
	}
	*value = decode(type, bits);
	return SPEC_OK;
}

static enum spec_status
read_value(struct reader *reader, const struct type *type, double *value)
{
	return reader->format == ASCII ? read_ascii(reader, type, value)
				       : read_binary(reader, type, value);
}

/* ---- elements ---- */

static enum spec_status
grow(struct reader *reader, float **list, size_t *room, size_t count)
{
	void *grown = *list;
	enum spec_status status = spec_memory_grow(
		&grown, room, count, sizeof **list, "numbers of a mesh", reader->error);

	*list = grown;
	return status;
}

/* Takes in a vertex, by slots. */
static enum spec_status
add_vertex(struct reader *reader, const struct element *element, const double *value)
{
	struct spec_ply *mesh = reader->mesh;
	size_t at = mesh->vertices;
	enum spec_status status = grow(reader, &mesh->point, &reader->points, 3 * (at + 1));
	int normals = has_slot(reader, element, NORMAL),
	    uvs = has_slot(reader, element, UV);

	if (status == SPEC_OK && normals)
		status = grow(reader, &mesh->normal, &reader->normals, 3 * (at + 1));
	if (status == SPEC_OK && uvs)
		status = grow(reader, &mesh->uv, &reader->uvs, 2 * (at + 1));
	if (status != SPEC_OK)
		return status;
	for (int i = 0; i < SLOTS; i++)
		if (!(fabs(value[i]) <= FLT_MAX))
			return fail(reader, SPEC_EFORMAT,
				"vertex %zu has a number that is not finite", at);
	for (int i = 0; i < 3; i++) {
		mesh->point[3 * at + i] = (float)value[POINT + i];
		if (normals)
			mesh->normal[3 * at + i] = (float)value[NORMAL + i];
	}
	for (int i = 0; i < 2 && uvs; i++)
		mesh->uv[2 * at + i] = (float)value[UV + i];
	mesh->vertices++;
	return SPEC_OK;
}

/* Takes in the list of a face's vertices. */
static enum spec_status
read_corners(
	struct reader *reader, const struct property *property, double count, size_t face)
{
	const struct element *vertex = find_element(reader, VERTEX);
	struct spec_ply *mesh = reader->mesh;
	void *grown = mesh->index;
	uint32_t corner[4] = {0};
	enum spec_status status;

	if (count != 3 && count != 4)
		return fail(reader, SPEC_EUNSUPPORTED,
			"face %zu has %.0f vertices, and only 3 or 4 are supported", face,
			count);
	for (int i = 0; i < (int)count; i++) {
		double value;

		status = read_value(reader, property->type, &value);
		if (status != SPEC_OK)
			return status;
		if (!(value >= 0 && value < (double)vertex->count))
			return fail(reader, SPEC_EFORMAT,
				"face %zu has a vertex %.0f, and the last one is %zu", face,
				value, vertex->count - 1);
		corner[i] = (uint32_t)value;
	}
	status = spec_memory_grow(&grown, &reader->indices, 3 * (mesh->triangles + 2),
		sizeof *mesh->index, "corners of a mesh", reader->error);
	mesh->index = grown;
	for (int i = 0; i < (int)count - 2 && status == SPEC_OK; i++) {
		uint32_t *triangle = mesh->index + 3 * mesh->triangles++;

		triangle[0] = corner[0];
		triangle[1] = corner[i + 1];
		triangle[2] = corner[i + 2];
	}
	return status;
}

/* Reads a property of an element, number one of them from 0. */
static enum spec_status
read_property_value(struct reader *reader, const struct property *property, size_t number,
	double *value)
{
	double count = 1, ignored;
	enum spec_status status = SPEC_OK;

	if (property->count) {
		status = read_value(reader, property->count, &count);
		if (status == SPEC_OK && count < 0)
			status =
				fail(reader, SPEC_EFORMAT, "a list has %.0f values", count);
		if (status == SPEC_OK && property->slot == CORNERS)
			return read_corners(reader, property, count, number);
	}
	for (double i = 0; i < count && status == SPEC_OK; i++)
		status = read_value(reader, property->type,
			property->slot < SLOTS ? &value[property->slot] : &ignored);
	return status;
}

static enum spec_status
read_elements(struct reader *reader, const struct element *element)
{
	enum spec_status status = SPEC_OK;

	/* Nothing is stored for them, so there could be any number. */
	if (element->properties == 0)
		return SPEC_OK;
	for (size_t i = 0; i < element->count && status == SPEC_OK; i++) {
		double value[SLOTS] = {0};

		for (size_t j = 0; j < element->properties && status == SPEC_OK; j++)
			status = read_property_value(
				reader, &reader->property[element->first + j], i, value);
		if (status == SPEC_OK && element->kind == VERTEX)
			status = add_vertex(reader, element, value);
	}
	return status;
}

static enum spec_status
read_end(struct reader *reader)
{
	int byte;
	enum spec_status status =
		reader->format == ASCII ? skip_blanks(reader, &byte) : peek(reader, &byte);

	if (status == SPEC_OK && byte >= 0)
		status = fail(reader, SPEC_EFORMAT,
			"the file goes on behind what its header announces");
	return status;
}

enum spec_status
spec_ply_read(FILE *file, const char *name, struct spec_ply *mesh, struct spec_error *error)
{
	struct reader *reader = spec_memory_new(1, sizeof *reader, "readers", error);
	unsigned char *buffer = spec_memory_new(CHUNK, 1, "bytes", error);
	enum spec_status status = SPEC_ENOMEM;

	*mesh = (struct spec_ply){0};
	if (reader && buffer) {
		*reader = (struct reader){.file = file,
			.name = name,
			.error = error,
			.mesh = mesh,
			.buffer = buffer};
		status = read_header(reader);
		if (status == SPEC_OK)
			reader->line = reader->format == ASCII ? reader->line + 1 : 0;
		for (size_t i = 0; status == SPEC_OK && i < reader->elements; i++)
			status = read_elements(reader, &reader->element[i]);
		if (status == SPEC_OK)
			status = read_end(reader);
	}
	if (status != SPEC_OK)
		spec_ply_free(mesh);
	free(buffer);
	free(reader);
	return status;
}

enum spec_status
spec_ply_load(const char *path, struct spec_ply *mesh, struct spec_error *error)
{
	FILE *file = fopen(path, "rbe");
	enum spec_status status;

	*mesh = (struct spec_ply){0};
	if (!file)
		return spec_error_system(error, errno, "unable to open '%s'", path);
	status = spec_ply_read(file, path, mesh, error);
	fclose(file); /* opened for reading: nothing can be lost here */
	return status;
}

void
spec_ply_free(struct spec_ply *mesh)
{
	if (!mesh)
		return;
	free(mesh->point);
	free(mesh->normal);
	free(mesh->uv);
	free(mesh->index);
	*mesh = (struct spec_ply){0};
}
