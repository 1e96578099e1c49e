/* JSON as it is written: what RFC 8259 and Unicode say, byte by byte. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/json.h"
#include "base/text.h"

static struct spec_text text;
static struct spec_json json;

static int
set_up(void **state)
{
	(void)state;
	assert_int_equal(spec_text_open(&text, NULL), SPEC_OK);
	spec_json_start(&json, text.stream);
	return 0;
}

static int
tear_down(void **state)
{
	(void)state;
	spec_text_free(&text);
	return 0;
}

static void
expect(const char *wanted)
{
	assert_int_equal(spec_text_close(&text, NULL), SPEC_OK);
	if (text.size != strlen(wanted) || memcmp(text.bytes, wanted, text.size) != 0)
		fail_msg("got '%.*s', wanted '%s'", (int)text.size, text.bytes, wanted);
}

static void
test_shapes(void **state)
{
	(void)state;
	spec_json_open(&json, NULL, '{', SPEC_JSON_LINES);
	spec_json_whole(&json, "a", -7);
	spec_json_open(&json, "b", '[', SPEC_JSON_LINES);
	spec_json_open(&json, NULL, '{', SPEC_JSON_INLINE);
	spec_json_null(&json, "c");
	spec_json_open(&json, "d", '[', SPEC_JSON_LINES); /* inline, as all inside one */
	spec_json_whole(&json, NULL, 1);
	spec_json_whole(&json, NULL, 2);
	spec_json_close(&json);
	spec_json_close(&json);
	spec_json_text(&json, NULL, NULL);
	spec_json_close(&json);
	spec_json_open(&json, "empty", '{', SPEC_JSON_LINES);
	spec_json_close(&json);
	spec_json_numbers(&json, "numbers", (const double[]){0.5, NAN, 3}, 3);
	spec_json_close(&json);
	expect("{\n"
	       "  \"a\": -7,\n"
	       "  \"b\": [\n"
	       "    {\"c\": null, \"d\": [1, 2]},\n"
	       "    null\n"
	       "  ],\n"
	       "  \"empty\": {},\n"
	       "  \"numbers\": [0.5, null, 3]\n"
	       "}\n");
}

static void
test_texts_are_escaped(void **state)
{
	(void)state;
	spec_json_text(&json, NULL, "a\"b\\c/\n\t\r\x01\x1f\x7f é€😀");
	expect("\"a\\\"b\\\\c/\\n\\t\\u000d\\u0001\\u001f\\u007f é€😀\"");
}

static void
test_zero_bytes(void **state)
{
	(void)state;
	spec_json_bytes(&json, NULL, "a\0b", 3);
	expect("\"a\\u0000b\"");
}

/* Each byte that is in no character becomes one mark; Unicode 15.0, table 3-7. */
static void
test_what_is_no_utf8(void **state)
{
	static const struct {
		const char *bytes;
		size_t marks;
	} cases[] = {
		{"\x80", 1},
		{"\xbf", 1},
		{"\xc0\xaf", 2},
		{"\xc1\x80", 2},
		{"\xc2", 1},
		{"\xe2\x82", 2},
		{"\xe0\x9f\xbf", 3}, /* overlong */
		{"\xed\xa0\x80", 3}, /* a surrogate */
		{"\xf0\x8f\xbf\xbf", 4},
		{"\xf4\x90\x80\x80", 4}, /* beyond U+10FFFF */
		{"\xf5\x80\x80\x80", 4},
		{"\xff", 1},
		{"\xc3\x28", 1}, /* and "(" */
		{"\xed\x9f\xbf", 0},
		{"\xee\x80\x80", 0},
		{"\xe0\xa0\x80", 0},
		{"\xf0\x90\x80\x80", 0},
		{"\xf4\x8f\xbf\xbf", 0},
		{"\xc2\x80", 0},
	};
	char wanted[1024] = "[";

	(void)state;
	spec_json_open(&json, NULL, '[', SPEC_JSON_INLINE);
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		spec_json_text(&json, NULL, cases[i].bytes);
		strcat(wanted, i > 0 ? ", \"" : "\"");
		for (size_t j = 0; j < cases[i].marks; j++)
			strcat(wanted, "\\ufffd");
		if (cases[i].marks == 0)
			strcat(wanted, cases[i].bytes);
		if (strcmp(cases[i].bytes, "\xc3\x28") == 0)
			strcat(wanted, "(");
		strcat(wanted, "\"");
	}
	spec_json_close(&json);
	strcat(wanted, "]\n");
	expect(wanted);
}

static void
test_numbers_read_back(void **state)
{
	static const double values[] = {0, -0.0, 0.1, 1.0 / 3, 5e-324,
		1.7976931348623157e308, 123456789012345680.0, 550.5, 299792458, 4.35};

	(void)state;
	for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
		spec_json_number(&json, NULL, values[i]);
		fputc(' ', text.stream);
	}
	expect("0 -0 0.1 0.3333333333333333 4.94065645841247e-324 "
	       "1.7976931348623157e+308 1.2345678901234568e+17 550.5 299792458 4.35 ");
}

static void
test_floats_read_back(void **state)
{
	static const float values[] = {
		15.7456F, 0.1F, 1.0F / 3, 16777217.0F, 3.4028235e38F};

	(void)state;
	for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
		spec_json_float(&json, NULL, values[i]);
		fputc(' ', text.stream);
	}
	expect("15.7456 0.1 0.33333334 16777216 3.4028235e+38 ");
}

static void
test_what_is_not_finite_is_null(void **state)
{
	(void)state;
	spec_json_open(&json, NULL, '[', SPEC_JSON_INLINE);
	spec_json_number(&json, NULL, NAN);
	spec_json_number(&json, NULL, INFINITY);
	spec_json_float(&json, NULL, -INFINITY);
	spec_json_float(&json, NULL, NAN);
	spec_json_close(&json);
	expect("[null, null, null, null]\n");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(test_shapes, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_texts_are_escaped, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_zero_bytes, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_what_is_no_utf8, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_numbers_read_back, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_floats_read_back, set_up, tear_down),
		cmocka_unit_test_setup_teardown(
			test_what_is_not_finite_is_null, set_up, tear_down),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
