/* What stands before the samples of TIFF files, small and large, as OpenImageIO reads it. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/tiffheader.h"

#include "readback.h"

static int
set_up(void **state)
{
	(void)state;
	return scratch_make("tiff");
}

/* A sparse file of zeros but for one sample, and that read as the user would. */
static void
holds(size_t width, size_t height, size_t channels, const char *wavelengths, size_t x,
	size_t y, size_t channel)
{
	static const char note[] = "a note";
	struct spec_tiff_layout layout = {width, height, channels, note, sizeof note};
	struct spec_settings settings;
	struct spec_text header = {0};
	struct spec_error error = {0};
	struct spec_decoder *decoder;
	struct spec_reader *reader;
	float value = 2.5F;
	char path[256];
	int file;

	assert_int_equal(spec_text_open(&header, NULL), SPEC_OK);
	assert_int_equal(spec_tiff_header(&layout, &header, NULL), SPEC_OK);
	assert_int_equal(spec_text_close(&header, NULL), SPEC_OK);
	snprintf(path, sizeof path, "%s/a.tif", scratch);
	file = open(path, O_CREAT | O_TRUNC | O_WRONLY, 0600);
	assert_int_equal(write(file, header.bytes, header.size), header.size);
	assert_int_equal(
		ftruncate(file, (off_t)(header.size + width * height * channels * 4)), 0);
	assert_int_equal(
		pwrite(file, &value, sizeof value,
			(off_t)(header.size + ((y * width + x) * channels + channel) * 4)),
		sizeof value);
	assert_int_equal(close(file), 0);
	spec_text_free(&header);

	spec_settings_init(&settings);
	settings.wavelengths = wavelengths;
	settings.read_as = SPEC_ROLE_EMISSIVE;
	if (spec_reader_open(&reader, path, &settings, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	assert_int_equal(spec_window_width(&spec_reader_image(reader)->data), width);
	assert_int_equal(spec_window_height(&spec_reader_image(reader)->data), height);
	assert_int_equal(spec_reader_image(reader)->bands, channels);
	assert_int_equal(
		spec_image_attribute(spec_reader_image(reader), "ImageDescription")->size,
		strlen(note));
	assert_int_equal(spec_decoder_open(&decoder, reader, NULL, &error), SPEC_OK);
	if (spec_decoder_read(decoder, (int)y, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	for (size_t c = 0; c < channels; c++) {
		const float *row = spec_decoder_row(
			decoder, (int)y, spec_reader_image(reader)->band_channel[c]);

		for (size_t i = 0; i < width; i++)
			near(row[i], c == channel && i == x ? value : 0, 0, "a sample");
	}
	spec_decoder_close(decoder);
	spec_reader_close(reader);
	assert_int_equal(unlink(path), 0);
}

static void
small_ones(void **state)
{
	(void)state;
	holds(1, 1, 1, "500", 0, 0, 0);
	holds(3, 2, 2, "500,600", 2, 1, 0);
	holds(5, 7, 3, "500,600,700", 4, 6, 2);
	holds(5, 7, 4, "500,600,700,800", 1, 3, 3);
	holds(100, 1000, 31, "400:700:10", 99, 999,
		30); /* several strips, the last shorter */
	holds(70000, 2, 5, "400:800:100", 69999, 1, 4); /* each longer than others are */
	holds(1, 70000, 1, "400", 0, 69999, 0);
}

/* Of 4 GiB, which is more than offsets of 4 bytes reach. */
static void
large_ones(void **state)
{
	(void)state;
	holds(32768, 32768, 1, "500", 32767, 32767, 0);
	holds(1024, 8192, 128, "400:527:1", 7, 8191, 127);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(small_ones),
		cmocka_unit_test(large_ones),
	};

	return cmocka_run_group_tests(tests, set_up, scratch_remove);
}
