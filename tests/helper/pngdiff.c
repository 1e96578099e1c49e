/* pngdiff A.png B.png: prints the largest difference of two pictures' 8-bit codes. */
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned char *
load(const char *path, png_image *image)
{
	unsigned char *pixels;

	memset(image, 0, sizeof *image);
	image->version = PNG_IMAGE_VERSION;
	if (!png_image_begin_read_from_file(image, path)) {
		fprintf(stderr, "pngdiff: %s: %s\n", path, image->message);
		exit(2);
	}
	image->format = PNG_FORMAT_RGB;
	pixels = malloc(PNG_IMAGE_SIZE(*image));
	if (!pixels || !png_image_finish_read(image, NULL, pixels, 0, NULL)) {
		fprintf(stderr, "pngdiff: %s: %s\n", path, image->message);
		exit(2);
	}
	return pixels;
}

int
main(int argc, char **argv)
{
	png_image a, b;
	unsigned char *one, *two;
	int most = 0;

	if (argc != 3)
		return 2;
	one = load(argv[1], &a);
	two = load(argv[2], &b);
	if (a.width != b.width || a.height != b.height) {
		puts("sizes differ");
		return 1;
	}
	for (size_t i = 0; i < PNG_IMAGE_SIZE(a); i++) {
		int difference = abs(one[i] - two[i]);

		most = difference > most ? difference : most;
	}
	printf("%d\n", most);
	free(one);
	free(two);
	return 0;
}
