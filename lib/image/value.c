#include "image/value.h"

#include <stdint.h>
#include <string.h>

enum scalar { WHOLE, FLOAT, DOUBLE };

/* Types that are numbers, in the order in which they stand in the file. */
struct numeric {
	const char *type;
	enum scalar scalar;
	int rows, columns; /* rows 0: a number by itself */
};

static const struct numeric numerics[] = {
	{"int", WHOLE, 0, 1},
	{"float", FLOAT, 0, 1},
	{"double", DOUBLE, 0, 1},
	{"box2i", WHOLE, 1, 4},
	{"box2f", FLOAT, 1, 4},
	{"v2i", WHOLE, 1, 2},
	{"v2f", FLOAT, 1, 2},
	{"v2d", DOUBLE, 1, 2},
	{"v3i", WHOLE, 1, 3},
	{"v3f", FLOAT, 1, 3},
	{"v3d", DOUBLE, 1, 3},
	{"m33f", FLOAT, 3, 3},
	{"m33d", DOUBLE, 3, 3},
	{"m44f", FLOAT, 4, 4},
	{"m44d", DOUBLE, 4, 4},
	{"rational", WHOLE, 1, 2},
	{"timecode", WHOLE, 1, 2},
	{"keycode", WHOLE, 1, 7},
};

static size_t
scalar_bytes(enum scalar scalar)
{
	return scalar == DOUBLE ? 8 : 4;
}

/* Whether an attribute is numbers, and of the size that its type has. */
static int
is_numeric(const struct spec_attribute *attribute, struct numeric *found)
{
	for (size_t i = 0; i < sizeof numerics / sizeof numerics[0]; i++) {
		int rows = numerics[i].rows > 0 ? numerics[i].rows : 1;

		if (strcmp(attribute->type, numerics[i].type) != 0)
			continue;
		*found = numerics[i];
		return attribute->size == (size_t)rows * (size_t)numerics[i].columns *
						  scalar_bytes(numerics[i].scalar);
	}
	*found = (struct numeric){
		"floatvector", FLOAT, 1, (int)(attribute->size / sizeof(float))};
	return strcmp(attribute->type, "floatvector") == 0;
}

static int32_t
whole_at(const unsigned char *bytes)
{
	int32_t value;

	memcpy(&value, bytes, sizeof value);
	return value;
}

static float
float_at(const unsigned char *bytes)
{
	float value;

	memcpy(&value, bytes, sizeof value);
	return value;
}

static double
double_at(const unsigned char *bytes)
{
	double value;

	memcpy(&value, bytes, sizeof value);
	return value;
}

/* The name that a byte stands for, or null. */
static const char *
name_of_byte(const struct spec_attribute *attribute)
{
	static const struct {
		const char *type, *names[3];
	} types[] = {{"envmap", {"latlong", "cube"}},
		{"lineOrder", {"increasing y", "decreasing y", "random y"}}};

	for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
		if (strcmp(attribute->type, types[i].type) == 0 && attribute->size == 1 &&
			attribute->value[0] < 3)
			return types[i].names[attribute->value[0]];
	}
	return NULL;
}

void
spec_value_print_text(FILE *stream, const char *text, size_t size)
{
	for (size_t i = 0; i < size; i++) {
		unsigned char byte = (unsigned char)text[i];

		fputc(byte < ' ' || byte == 127 ? '?' : byte, stream);
	}
}

/* A text cut off where it gets long, but not within a character. */
static void
print_cut(FILE *stream, const unsigned char *text, size_t size, size_t most)
{
	size_t shown = size;

	if (size > most) {
		shown = most;
		while (shown > 0 && (text[shown] & 0xc0) == 0x80)
			shown--;
	}
	spec_value_print_text(stream, (const char *)text, shown);
	if (shown < size)
		fprintf(stream, " ... (%zu bytes)", size);
}

static void
print_number(FILE *stream, enum scalar scalar, const unsigned char *bytes)
{
	if (scalar == WHOLE)
		fprintf(stream, "%d", whole_at(bytes));
	else if (scalar == FLOAT)
		fprintf(stream, "%.6g", float_at(bytes));
	else
		fprintf(stream, "%.10g", double_at(bytes));
}

static void
print_numbers(FILE *stream, const struct numeric *type, const unsigned char *bytes)
{
	int rows = type->rows > 0 ? type->rows : 1;
	enum { MOST_SHOWN = 16 };

	for (int i = 0; i < rows * type->columns; i++) {
		if (i == MOST_SHOWN) {
			fprintf(stream, " ... (%d numbers)", rows * type->columns);
			break;
		}
		if (i > 0)
			fputs(i % type->columns == 0 ? "; " : " ", stream);
		print_number(stream, type->scalar, bytes + i * scalar_bytes(type->scalar));
	}
}

/* The next text of a vector, which its length stands before; 0 at the end. */
static int
next_text(
	const struct spec_attribute *attribute, size_t *at, const char **text, size_t *size)
{
	int32_t length;

	if (attribute->size - *at < 4)
		return 0;
	length = whole_at(attribute->value + *at);
	*at += 4;
	if (length < 0 || (size_t)length > attribute->size - *at)
		return 0;
	*text = (const char *)attribute->value + *at;
	*size = (size_t)length;
	*at += (size_t)length;
	return 1;
}

static void
print_texts(FILE *stream, const struct spec_attribute *attribute, size_t most)
{
	const char *text;
	size_t at = 0, size, printed = 0;

	for (int i = 0; next_text(attribute, &at, &text, &size); i++) {
		if (printed > most) {
			fputs(", ...", stream);
			break;
		}
		fputs(i > 0 ? ", " : "", stream);
		print_cut(stream, (const unsigned char *)text, size, most);
		printed += size;
	}
}

void
spec_value_print(FILE *stream, const struct spec_attribute *attribute, size_t most)
{
	const unsigned char *bytes = attribute->value;
	struct numeric type;

	if (strcmp(attribute->type, "string") == 0)
		print_cut(stream, bytes, attribute->size, most);
	else if (strcmp(attribute->type, "stringvector") == 0)
		print_texts(stream, attribute, most);
	else if (is_numeric(attribute, &type))
		print_numbers(stream, &type, bytes);
	else if (name_of_byte(attribute))
		fputs(name_of_byte(attribute), stream);
	else if (strcmp(attribute->type, "chromaticities") == 0 && attribute->size == 32)
		fprintf(stream,
			"red %.6g %.6g, green %.6g %.6g, blue %.6g %.6g, white %.6g %.6g",
			float_at(bytes), float_at(bytes + 4), float_at(bytes + 8),
			float_at(bytes + 12), float_at(bytes + 16), float_at(bytes + 20),
			float_at(bytes + 24), float_at(bytes + 28));
	else if (strcmp(attribute->type, "preview") == 0 && attribute->size >= 8)
		fprintf(stream, "%u x %u pixels", (unsigned)whole_at(bytes),
			(unsigned)whole_at(bytes + 4));
	else {
		spec_value_print_text(stream, attribute->type, strlen(attribute->type));
		fprintf(stream, ", %zu bytes", attribute->size);
	}
}

static void
json_number(struct spec_json *json, const char *key, enum scalar scalar,
	const unsigned char *bytes)
{
	if (scalar == WHOLE)
		spec_json_whole(json, key, whole_at(bytes));
	else if (scalar == FLOAT)
		spec_json_float(json, key, float_at(bytes));
	else
		spec_json_number(json, key, double_at(bytes));
}

static void
json_row(struct spec_json *json, const char *key, enum scalar scalar, int count,
	const unsigned char *bytes)
{
	spec_json_open(json, key, '[', SPEC_JSON_INLINE);
	for (int i = 0; i < count; i++)
		json_number(json, NULL, scalar, bytes + i * scalar_bytes(scalar));
	spec_json_close(json);
}

static void
json_numbers(struct spec_json *json, const char *key, const struct numeric *type,
	const unsigned char *bytes)
{
	size_t row = (size_t)type->columns * scalar_bytes(type->scalar);

	if (type->rows == 0) {
		json_number(json, key, type->scalar, bytes);
	} else if (type->rows == 1) {
		json_row(json, key, type->scalar, type->columns, bytes);
	} else {
		spec_json_open(json, key, '[', SPEC_JSON_INLINE);
		for (int i = 0; i < type->rows; i++)
			json_row(json, NULL, type->scalar, type->columns, bytes + i * row);
		spec_json_close(json);
	}
}

static void
json_texts(struct spec_json *json, const struct spec_attribute *attribute)
{
	const char *text;
	size_t at = 0, size;

	spec_json_open(json, attribute->name, '[', SPEC_JSON_INLINE);
	while (next_text(attribute, &at, &text, &size))
		spec_json_bytes(json, NULL, text, size);
	spec_json_close(json);
}

static void
json_object(struct spec_json *json, const struct spec_attribute *attribute)
{
	static const char *const colours[] = {"red", "green", "blue", "white"};
	const unsigned char *bytes = attribute->value;

	spec_json_open(json, attribute->name, '{', SPEC_JSON_INLINE);
	if (strcmp(attribute->type, "chromaticities") == 0 && attribute->size == 32) {
		for (int i = 0; i < 4; i++)
			json_row(json, colours[i], FLOAT, 2, bytes + i * 8);
	} else if (strcmp(attribute->type, "preview") == 0 && attribute->size >= 8) {
		spec_json_whole(json, "width", (uint32_t)whole_at(bytes));
		spec_json_whole(json, "height", (uint32_t)whole_at(bytes + 4));
	} else {
		spec_json_text(json, "type", attribute->type);
		spec_json_whole(json, "bytes", (long long)attribute->size);
	}
	spec_json_close(json);
}

void
spec_value_json(struct spec_json *json, const struct spec_attribute *attribute)
{
	struct numeric type;

	if (strcmp(attribute->type, "string") == 0)
		spec_json_bytes(json, attribute->name, (const char *)attribute->value,
			attribute->size);
	else if (strcmp(attribute->type, "stringvector") == 0)
		json_texts(json, attribute);
	else if (is_numeric(attribute, &type))
		json_numbers(json, attribute->name, &type, attribute->value);
	else if (name_of_byte(attribute))
		spec_json_text(json, attribute->name, name_of_byte(attribute));
	else
		json_object(json, attribute);
}
