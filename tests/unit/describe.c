/* The values of attributes as text and as JSON, of each type; regular grids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/text.h"
#include "image/value.h"
#include "spectrum/grid.h"

static void
expect_text(const struct spec_text *text, const char *wanted)
{
	if (text->size != strlen(wanted) ||
		(text->size > 0 && memcmp(text->bytes, wanted, text->size) != 0))
		fail_msg("got '%.*s', wanted '%s'", (int)text->size, text->bytes, wanted);
}

static void
expect(const char *type, const void *value, size_t size, const char *print,
	const char *json)
{
	struct spec_attribute attribute = {
		(char *)"a", (char *)type, (unsigned char *)value, size};
	struct spec_text text;
	struct spec_json writer;
	char wanted[512];

	assert_int_equal(spec_text_open(&text, NULL), SPEC_OK);
	spec_value_print(text.stream, &attribute, 12);
	assert_int_equal(spec_text_close(&text, NULL), SPEC_OK);
	expect_text(&text, print);
	spec_text_free(&text);
	assert_int_equal(spec_text_open(&text, NULL), SPEC_OK);
	spec_json_start(&writer, text.stream);
	spec_json_open(&writer, NULL, '{', SPEC_JSON_INLINE);
	spec_value_json(&writer, &attribute);
	spec_json_close(&writer);
	assert_int_equal(spec_text_close(&text, NULL), SPEC_OK);
	snprintf(wanted, sizeof wanted, "{%s}\n", json);
	expect_text(&text, wanted);
	spec_text_free(&text);
}

static void
test_texts(void **state)
{
	(void)state;
	expect("string", "one\ntwo", 7, "one?two", "\"a\": \"one\\ntwo\"");
	expect("string", "", 0, "", "\"a\": \"\"");
	expect("string", "twelve bytes", 12, "twelve bytes", "\"a\": \"twelve bytes\"");
	expect("string", "thirteen byte", 13, "thirteen byt ... (13 bytes)",
		"\"a\": \"thirteen byte\"");
	/* Not cut within a character. */
	expect("string", "eleven byteés", 14, "eleven byte ... (14 bytes)",
		"\"a\": \"eleven byteés\"");
	expect("stringvector", "\3\0\0\0red\0\0\0\0\1\0\0\0\x1b", 16, "red, , ?",
		"\"a\": [\"red\", \"\", \"\\u001b\"]");
	/* A length that the value does not hold. */
	expect("stringvector", "\1\0\0\0r\xff\xff\xff\x7fx", 10, "r", "\"a\": [\"r\"]");
}

static void
test_numbers(void **state)
{
	const float matrix[9] = {1, 2, 3, 4, 5, 6, 7, 8, 0.1F};
	const float many[17] = {1};

	(void)state;
	expect("int", &(int32_t){-5}, 4, "-5", "\"a\": -5");
	expect("float", &(float){15.7456F}, 4, "15.7456", "\"a\": 15.7456");
	expect("double", &(double){0.1}, 8, "0.1", "\"a\": 0.1");
	expect("v2i", &(int32_t[]){1, -2}, 8, "1 -2", "\"a\": [1, -2]");
	expect("v3d", &(double[]){1, 2, 0.5}, 24, "1 2 0.5", "\"a\": [1, 2, 0.5]");
	expect("box2f", &(float[]){0, 1, 2, 3}, 16, "0 1 2 3", "\"a\": [0, 1, 2, 3]");
	expect("rational", &(int32_t[]){24000, 1001}, 8, "24000 1001",
		"\"a\": [24000, 1001]");
	expect("m33f", matrix, 36, "1 2 3; 4 5 6; 7 8 0.1",
		"\"a\": [[1, 2, 3], [4, 5, 6], [7, 8, 0.1]]");
	expect("floatvector", many, 8, "1 0", "\"a\": [1, 0]");
	expect("floatvector", many, 68, "1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 ... (17 numbers)",
		"\"a\": [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]");
	expect("floatvector", "", 0, "", "\"a\": []");
}

static void
test_other_types(void **state)
{
	const float primaries[8] = {
		0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.329F};

	(void)state;
	expect("envmap", "\1", 1, "cube", "\"a\": \"cube\"");
	expect("envmap", "\7", 1, "envmap, 1 bytes",
		"\"a\": {\"type\": \"envmap\", \"bytes\": 1}");
	expect("lineOrder", "\2", 1, "random y", "\"a\": \"random y\"");
	expect("chromaticities", primaries, 32,
		"red 0.64 0.33, green 0.3 0.6, blue 0.15 0.06, white 0.3127 0.329",
		"\"a\": {\"red\": [0.64, 0.33], \"green\": [0.3, 0.6], "
		"\"blue\": [0.15, 0.06], \"white\": [0.3127, 0.329]}");
	expect("preview", "\2\0\0\0\1\0\0\0rgbaRGBA", 16, "2 x 1 pixels",
		"\"a\": {\"width\": 2, \"height\": 1}");
	expect("mine", "123", 3, "mine, 3 bytes",
		"\"a\": {\"type\": \"mine\", \"bytes\": 3}");
	/* A type that is known, of another size. */
	expect("float", "123", 3, "float, 3 bytes",
		"\"a\": {\"type\": \"float\", \"bytes\": 3}");
	expect("chromaticities", "123", 3, "chromaticities, 3 bytes",
		"\"a\": {\"type\": \"chromaticities\", \"bytes\": 3}");
	expect("preview", "123", 3, "preview, 3 bytes",
		"\"a\": {\"type\": \"preview\", \"bytes\": 3}");
}

static void
test_steps(void **state)
{
	const double regular[] = {400, 410, 420, 430}, pair[] = {400, 450};
	/* pbrt-v4's 32 bands of 360..830 nm, as it writes them: 14.6875 nm apart. */
	const double rounded[] = {367.344, 382.031, 396.719, 411.406, 426.094};
	const double off[] = {400, 410.002, 420, 430};
	/* A step of 0.01 nm, and one wavelength 0.0005 nm off it. */
	const double fine[] = {400, 400.01, 400.0205, 400.03};

	(void)state;
	assert_true(spec_grid_step(regular, 4) == 10);
	assert_true(spec_grid_step(pair, 2) == 50);
	assert_true(spec_grid_step(regular, 1) == 0);
	assert_true(spec_grid_step(regular, 0) == 0);
	assert_true(
		spec_grid_step(rounded, 5) > 14.687 && spec_grid_step(rounded, 5) < 14.688);
	assert_true(spec_grid_step(off, 4) == 0);
	assert_true(spec_grid_step(fine, 4) == 0);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_texts),
		cmocka_unit_test(test_numbers),
		cmocka_unit_test(test_other_types),
		cmocka_unit_test(test_steps),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
