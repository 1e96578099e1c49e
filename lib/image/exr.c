#include "image/exr.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* One per thread: workers read and decode at the same time. */
static _Thread_local struct {
	char message[256];
	struct spec_error noted;
	long long allowed; /* 0: not set, no limit */
	const char *option;
} last;

void
spec_exr_allow(long long size, const char *option)
{
	last.allowed = size;
	last.option = option;
}

void *
spec_exr_allocate(size_t size)
{
	if (last.allowed > 0 && size > (size_t)last.allowed) {
		spec_error_set(&last.noted, SPEC_ERANGE,
			"a piece of %zu bytes is more than the limit of %lld (--limit %s=BYTES)",
			size, last.allowed, last.option);
		return NULL;
	}
	return malloc(size);
}

void
spec_exr_report(exr_const_context_t context, exr_result_t code, const char *message)
{
	(void)context;
	(void)code;
	snprintf(last.message, sizeof last.message, "%s", message ? message : "");
}

void
spec_exr_forget(void)
{
	last.message[0] = '\0';
	last.noted.status = SPEC_OK;
}

void
spec_exr_note(const struct spec_error *error)
{
	last.noted = *error;
}

int
spec_exr_has_note(void)
{
	return last.noted.status != SPEC_OK;
}

enum spec_status
spec_exr_error(exr_result_t result, const char *name, struct spec_error *error)
{
	const char *message =
		last.message[0] ? last.message : exr_get_default_error_message(result);

	if (last.noted.status != SPEC_OK) {
		if (error)
			*error = last.noted;
		return last.noted.status;
	}
	if (result == EXR_ERR_OUT_OF_MEMORY)
		return spec_error_set(error, SPEC_ENOMEM, "%s: out of memory", name);
	return spec_error_set(error, SPEC_EFORMAT, "%s: %s", name, message);
}

/* Types whose bytes in memory are their bytes in the file. */
static const struct {
	exr_attribute_type_t type;
	unsigned char size;
	unsigned char pointer; /* behind a pointer, or in the union itself */
} plain_types[] = {
	{EXR_ATTR_BOX2I, 16, 1},
	{EXR_ATTR_BOX2F, 16, 1},
	{EXR_ATTR_CHROMATICITIES, 32, 1},
	{EXR_ATTR_COMPRESSION, 1, 0},
	{EXR_ATTR_DOUBLE, 8, 0},
	{EXR_ATTR_ENVMAP, 1, 0},
	{EXR_ATTR_FLOAT, 4, 0},
	{EXR_ATTR_INT, 4, 0},
	{EXR_ATTR_KEYCODE, 28, 1},
	{EXR_ATTR_LINEORDER, 1, 0},
	{EXR_ATTR_M33F, 36, 1},
	{EXR_ATTR_M33D, 72, 1},
	{EXR_ATTR_M44F, 64, 1},
	{EXR_ATTR_M44D, 128, 1},
	{EXR_ATTR_RATIONAL, 8, 1},
	{EXR_ATTR_TILEDESC, 9, 1},
	{EXR_ATTR_TIMECODE, 8, 1},
	{EXR_ATTR_V2I, 8, 1},
	{EXR_ATTR_V2F, 8, 1},
	{EXR_ATTR_V2D, 16, 1},
	{EXR_ATTR_V3I, 12, 1},
	{EXR_ATTR_V3F, 12, 1},
	{EXR_ATTR_V3D, 24, 1},
};

/* The bytes of a plain attribute, or null for another type. */
static void *
plain_bytes(exr_attribute_t *attribute, size_t *size)
{
	for (size_t i = 0; i < sizeof plain_types / sizeof plain_types[0]; i++) {
		if (plain_types[i].type != attribute->type)
			continue;
		*size = plain_types[i].size;
		return plain_types[i].pointer ? (void *)attribute->rawptr
					      : (void *)&attribute->uc;
	}
	return NULL;
}

/* Texts, each with its length before it. */
static unsigned char *
pack_texts(const exr_attr_string_vector_t *texts, size_t *size, struct spec_error *error)
{
	unsigned char *bytes, *at;

	*size = 0;
	for (int i = 0; i < texts->n_strings; i++)
		*size += 4 + texts->strings[i].length;
	bytes = at = spec_memory_new(*size, 1, "bytes of an attribute", error);
	for (int i = 0; bytes && i < texts->n_strings; i++) {
		memcpy(at, &texts->strings[i].length, 4);
		memcpy(at + 4, texts->strings[i].str, texts->strings[i].length);
		at += 4 + texts->strings[i].length;
	}
	return bytes;
}

static unsigned char *
pack_preview(const exr_attr_preview_t *preview, size_t *size, struct spec_error *error)
{
	uint32_t shape[2] = {preview->width, preview->height};
	size_t pixels = 4 * (size_t)shape[0] * shape[1];
	unsigned char *bytes = spec_memory_new(sizeof shape + pixels, 1, "bytes", error);

	if (!bytes)
		return NULL;
	memcpy(bytes, shape, sizeof shape);
	memcpy(bytes + sizeof shape, preview->rgba, pixels);
	*size = sizeof shape + pixels;
	return bytes;
}

static enum spec_status
get_attribute(exr_attribute_t *from, struct spec_image *image, const char *name,
	struct spec_error *error)
{
	unsigned char *packed = NULL;
	size_t size = 0;
	const void *bytes = plain_bytes(from, &size);
	enum spec_status status;

	switch (from->type) {
	case EXR_ATTR_STRING:
		bytes = from->string->str;
		size = from->string->length;
		break;
	case EXR_ATTR_FLOAT_VECTOR:
		bytes = from->floatvector->arr;
		size = 4 * (size_t)from->floatvector->length;
		break;
	case EXR_ATTR_OPAQUE:
		bytes = from->opaque->packed_data;
		size = from->opaque->size;
		break;
	case EXR_ATTR_STRING_VECTOR:
		bytes = packed = pack_texts(from->stringvector, &size, error);
		break;
	case EXR_ATTR_PREVIEW:
		bytes = packed = pack_preview(from->preview, &size, error);
		break;
	default:
		break;
	}
	if (!bytes && size > 0)
		return SPEC_ENOMEM;
	if (!bytes && from->type != EXR_ATTR_STRING && from->type != EXR_ATTR_OPAQUE &&
		from->type != EXR_ATTR_FLOAT_VECTOR)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: attribute '%s' of type '%s' cannot be carried along", name,
			from->name, from->type_name);
	status = spec_image_set_attribute(
		image, from->name, from->type_name, bytes, size, error);
	free(packed);
	return status;
}

/* Held by fields of the image, or made anew by the writer. */
static int
is_structural(const char *name)
{
	static const char *const names[] = {"channels", "compression", "dataWindow",
		"displayWindow", "lineOrder", "pixelAspectRatio", "screenWindowCenter",
		"screenWindowWidth", "type", "name", "tiles", "chunkCount", "version",
		"maxSamplesPerPixel"};

	for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
		if (strcmp(name, names[i]) == 0)
			return 1;
	}
	return 0;
}

enum spec_status
spec_exr_get_attributes(exr_const_context_t context, int part, struct spec_image *image,
	const char *name, struct spec_error *error)
{
	int32_t count = 0;
	enum spec_status status = SPEC_OK;
	exr_result_t result = exr_get_attribute_count(context, part, &count);

	for (int32_t i = 0; i < count && result == EXR_ERR_SUCCESS && status == SPEC_OK;
		i++) {
		const exr_attribute_t *attribute;

		result = exr_get_attribute_by_index(
			context, part, EXR_ATTR_LIST_FILE_ORDER, i, &attribute);
		if (result == EXR_ERR_SUCCESS && !is_structural(attribute->name))
			status = get_attribute(
				(exr_attribute_t *)attribute, image, name, error);
	}
	return result == EXR_ERR_SUCCESS ? status : spec_exr_error(result, name, error);
}

static exr_result_t
set_texts(exr_context_t context, int part, const struct spec_attribute *from)
{
	const char **text = calloc(from->size / 4 + 1, sizeof *text);
	exr_result_t result = EXR_ERR_OUT_OF_MEMORY;
	char *copy = malloc(from->size + 1), *to = copy;
	int32_t count = 0, length;

	if (text && copy) {
		for (size_t at = 0; at + 4 <= from->size; at += 4 + (size_t)length) {
			memcpy(&length, from->value + at, 4);
			memcpy(to, from->value + at + 4, length);
			to[length] = '\0';
			text[count++] = to;
			to += length + 1;
		}
		result = exr_attr_set_string_vector(context, part, from->name, count, text);
	}
	free(text);
	free(copy);
	return result;
}

static exr_result_t
set_preview(exr_context_t context, int part, const struct spec_attribute *from)
{
	exr_attr_preview_t preview = {0};
	uint32_t shape[2];

	memcpy(shape, from->value, sizeof shape);
	preview.width = shape[0];
	preview.height = shape[1];
	preview.rgba = from->value + sizeof shape;
	return exr_attr_set_preview(context, part, from->name, &preview);
}

static exr_result_t
set_attribute(exr_context_t context, int part, const struct spec_attribute *from)
{
	exr_attribute_t *to = NULL;
	exr_result_t result;
	size_t size;
	void *bytes;

	if (strcmp(from->type, "string") == 0)
		return exr_attr_set_string(
			context, part, from->name, (const char *)from->value);
	if (strcmp(from->type, "stringvector") == 0)
		return set_texts(context, part, from);
	if (strcmp(from->type, "preview") == 0)
		return set_preview(context, part, from);
	if (strcmp(from->type, "floatvector") == 0)
		return exr_attr_set_float_vector(context, part, from->name,
			(int32_t)(from->size / 4),
			(const float *)(const void *)from->value);
	result = exr_attr_declare_by_type(context, part, from->name, from->type, &to);
	if (result != EXR_ERR_SUCCESS)
		return result;
	bytes = plain_bytes(to, &size);
	if (bytes && size == from->size) {
		memcpy(bytes, from->value, size);
		return EXR_ERR_SUCCESS;
	}
	if (from->size == 0)
		return EXR_ERR_SUCCESS; /* the library would leak an empty copy */
	return exr_attr_set_user(
		context, part, from->name, from->type, (int32_t)from->size, from->value);
}

enum spec_status
spec_exr_set_attributes(exr_context_t context, int part, const struct spec_image *image,
	const char *name, struct spec_error *error)
{
	for (size_t i = 0; i < image->attributes; i++) {
		exr_result_t result = set_attribute(context, part, &image->attribute[i]);

		if (result != EXR_ERR_SUCCESS) {
			enum spec_status status = spec_exr_error(result, name, error);

			spec_error_prefix(
				error, "attribute '%s'", image->attribute[i].name);
			return status;
		}
	}
	return SPEC_OK;
}
