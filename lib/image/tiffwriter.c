/*
 * Writing bands as TIFF files of floats: one of many channels, or a folder of files, each of
 * one band and named by its wavelength, as 550nm.tif. They are written forward alone.
 */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/output.h"
#include "image/description.h"
#include "image/tiffheader.h"
#include "image/writing.h"
#include "spectrum/spd.h"

struct folder_writer {
	struct spec_writer base;
	struct spec_output *file;
	size_t files, opened;
	int made_folder;
};

/* What stands before the samples: of all bands, or of one. */
static enum spec_status
write_header(const struct spec_image *image, struct spec_output *output, int has_band,
	size_t band, struct spec_error *error)
{
	struct spec_text description = {0}, header = {0};
	struct spec_tiff_layout layout = {.width = spec_window_width(&image->data),
		.height = spec_window_height(&image->data),
		.channels = has_band ? 1 : image->bands};
	enum spec_status status = spec_text_open(&description, error);

	if (status == SPEC_OK)
		status = has_band ? spec_description_write_band(
					    image, band, &description, error)
				  : spec_description_write(image, &description, error);
	if (status == SPEC_OK) {
		fputc('\0', description.stream);
		status = spec_text_close(&description, error);
	}
	layout.description = description.bytes;
	layout.description_bytes = description.size;
	if (status == SPEC_OK)
		status = spec_text_open(&header, error);
	if (status == SPEC_OK)
		status = spec_tiff_header(&layout, &header, error);
	if (status == SPEC_OK)
		status = spec_text_close(&header, error);
	if (status == SPEC_OK)
		status = spec_output_write(output, header.bytes, header.size, error);
	spec_text_free(&header);
	spec_text_free(&description);
	return status;
}

/* ---- one file ---- */

static enum spec_status
open_tiff(struct spec_writer *writer, struct spec_error *error)
{
	enum spec_status status = spec_writing_only_bands(writer, "TIFF", error);

	if (status == SPEC_OK && writer->output->terminal)
		status = spec_error_set(error, SPEC_EUSAGE,
			"refusing to write an image to a terminal; use -o FILE or a pipe");
	return status == SPEC_OK ? write_header(writer->image, writer->output, 0, 0, error)
				 : status;
}

static enum spec_status
encode(struct spec_packer *base, int index, unsigned char *raw, struct spec_error *error)
{
	struct spec_sample_packer *packer = (struct spec_sample_packer *)base;

	(void)index;
	(void)error;
	base->chunk = packer->samples; /* of as many bytes */
	spec_writing_by_pixel(base->writer, raw, packer->samples);
	return SPEC_OK;
}

const struct spec_writing_format spec_writing_tiff = {
	.name = "tiff",
	.suffixes = ".tif .tiff",
	.writer_bytes = sizeof(struct spec_writer),
	.packer_bytes = sizeof(struct spec_sample_packer),
	.own_samples = 1,
	.open = open_tiff,
	.open_packer = spec_sample_packer_open,
	.encode = encode,
	.write = spec_writing_append,
	.close_packer = spec_sample_packer_close,
};

/* ---- a folder ---- */

static enum spec_status
name_band(char *name, size_t room, const struct spec_writer *writer, size_t band,
	struct spec_error *error)
{
	char number[SPEC_SPD_NUMBER];

	spec_spd_format_number(writer->image->wavelength_nm[band], number);
	return snprintf(name, room, "%snm.tif", number) < (int)room
		       ? SPEC_OK
		       : spec_error_set(error, SPEC_EUSAGE, "%s: is too long a name",
				 writer->path);
}

static enum spec_status
open_band(struct folder_writer *writer, size_t band, struct spec_error *error)
{
	const struct spec_writer *base = &writer->base;
	char name[64], path[4096];
	enum spec_status status = name_band(name, sizeof name, base, band, error);

	if (status == SPEC_OK &&
		snprintf(path, sizeof path, "%s/%s", base->path, name) >= (int)sizeof path)
		return spec_error_set(
			error, SPEC_EUSAGE, "%s: is too long a name", base->path);
	if (status == SPEC_OK)
		status = spec_output_open(&writer->file[band], path, error);
	if (status != SPEC_OK)
		return status;
	writer->opened++;
	return write_header(base->image, &writer->file[band], 1, band, error);
}

static int
is_band(const struct spec_writer *writer, const char *found)
{
	char name[64];

	for (size_t i = 0; i < writer->image->bands; i++)
		if (name_band(name, sizeof name, writer, i, NULL) == SPEC_OK &&
			strcmp(name, found) == 0)
			return 1;
	return 0;
}

/* A folder may hold an older image of the same bands: others would be read as this one's. */
static enum spec_status
check_folder(const struct spec_writer *writer, struct spec_error *error)
{
	DIR *folder = opendir(writer->path);
	enum spec_status status = SPEC_OK;
	struct dirent *entry;

	if (!folder)
		return spec_error_system(
			error, errno, "unable to write the folder '%s'", writer->path);
	while (status == SPEC_OK && (entry = readdir(folder))) {
		if (*entry->d_name != '.' && !is_band(writer, entry->d_name))
			status = spec_error_set(error, SPEC_EUSAGE,
				"%s: has '%.200s' in it, which is no band of this image",
				writer->path, entry->d_name);
	}
	closedir(folder);
	return status;
}

static enum spec_status
open_folder(struct spec_writer *base, struct spec_error *error)
{
	struct folder_writer *writer = (struct folder_writer *)base;
	enum spec_status status = SPEC_OK;

	if (strcmp(base->path, "-") == 0)
		status = spec_error_set(error, SPEC_EUSAGE,
			"a folder of pictures cannot go to standard output (-o FOLDER)");
	if (status == SPEC_OK)
		status = spec_writing_only_bands(base, "TIFF", error);
	if (status != SPEC_OK)
		return status;
	writer->files = base->image->bands;
	writer->file = spec_memory_new(writer->files, sizeof *writer->file, "files", error);
	if (!writer->file)
		return SPEC_ENOMEM;
	if (mkdir(base->path, 0777) == 0)
		writer->made_folder = 1;
	else if (errno != EEXIST)
		return spec_error_system(
			error, errno, "unable to make the folder '%s'", base->path);
	else
		status = check_folder(base, error);
	for (size_t i = 0; i < writer->files && status == SPEC_OK; i++)
		status = open_band(writer, i, error);
	base->chunk_lines = spec_writing_plane_lines(base);
	return status;
}

static enum spec_status
encode_bands(
	struct spec_packer *base, int index, unsigned char *raw, struct spec_error *error)
{
	struct spec_sample_packer *packer = (struct spec_sample_packer *)base;

	(void)error;
	base->chunk = packer->samples;
	spec_writing_by_band(base->writer, index, raw, packer->samples);
	return SPEC_OK;
}

static enum spec_status
write_bands(struct spec_packer *packer, int index, struct spec_error *error)
{
	struct folder_writer *writer = (struct folder_writer *)packer->writer;
	size_t bytes = spec_window_width(&writer->base.image->data) * sizeof(float) *
		       (size_t)spec_writing_lines(&writer->base, index);
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < writer->files && status == SPEC_OK; i++)
		status = spec_output_write(&writer->file[i],
			(const char *)packer->chunk + i * bytes, bytes, error);
	return status;
}

/* All or none. */
static enum spec_status
commit_folder(struct spec_writer *base, struct spec_error *error)
{
	struct folder_writer *writer = (struct folder_writer *)base;
	struct spec_output **output = spec_memory_new(
		writer->files, sizeof(struct spec_output *), "files", error);
	enum spec_status status;

	if (!output)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < writer->files; i++)
		output[i] = &writer->file[i];
	writer->opened = 0;
	status = spec_output_commit_all(output, writer->files, error);
	free((void *)output);
	writer->made_folder &= status != SPEC_OK;
	return status;
}

static void
close_folder(struct spec_writer *base)
{
	struct folder_writer *writer = (struct folder_writer *)base;

	for (size_t i = 0; i < writer->opened; i++)
		spec_output_abandon(&writer->file[i]);
	free(writer->file);
	if (writer->made_folder)
		(void)rmdir(base->path); /* it is empty where nothing was committed */
}

const struct spec_writing_format spec_writing_folder = {
	.name = "bands",
	.suffixes = "",
	.writer_bytes = sizeof(struct folder_writer),
	.packer_bytes = sizeof(struct spec_sample_packer),
	.makes_files = 1,
	.own_samples = 1,
	.open = open_folder,
	.open_packer = spec_sample_packer_open,
	.encode = encode_bands,
	.write = write_bands,
	.commit = commit_folder,
	.close_packer = spec_sample_packer_close,
	.close = close_folder,
};
