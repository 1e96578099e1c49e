/*
 * Writing bands as pictures of floats through OpenImageIO: a TIFF file of many channels, or
 * a folder of TIFF files, each of one band and named by its wavelength, as 550nm.tif.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/output.h"
#include "image/description.h"
#include "image/plugin.h"
#include "image/writing.h"
#include "spectrum/spd.h"

/* One TIFF file. */
struct file {
	struct spec_output output; /* of a folder's files */
	int opened;
	void *picture;
};

struct tiff_writer {
	struct spec_writer base;
	struct spec_plugin plugin;
	struct file *file;
	size_t files;
	int scratch_fd; /* what a pipe gets at the end, or -1 */
	int made_folder;
};

struct tiff_packer {
	struct spec_packer base;
	float *line; /* [bands][width], or interleaved */
};

static enum spec_status
report(struct spec_error *error, const struct spec_error *cause, const char *path)
{
	return spec_error_set(
		error, cause->status, "unable to write '%s': %s", path, cause->message);
}

/* Opens a TIFF on a descriptor, by its name in /proc: the file itself may have none. */
static enum spec_status
open_file(struct tiff_writer *writer, struct file *file, int fd, size_t channels,
	const char *description, struct spec_error *error)
{
	const struct spec_window *data = &writer->base.image->data;
	struct spec_error cause = {0};
	char path[64];
	struct spec_pictures_request request = {.suffix = "tif",
		.width = spec_window_width(data),
		.height = spec_window_height(data),
		.channels = channels,
		.bits = 32,
		.colour = "Linear",
		.description = description,
		.path = path};

	snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
	return writer->plugin.table->open(&file->picture, &request, &cause) == SPEC_OK
		       ? SPEC_OK
		       : report(error, &cause, writer->base.path);
}

/* ---- one file ---- */

static enum spec_status
prepare(struct tiff_writer *writer, size_t files, struct spec_text *description,
	struct spec_error *error)
{
	enum spec_status status = spec_writing_only_bands(&writer->base, "TIFF", error);

	writer->scratch_fd = -1;
	if (status != SPEC_OK)
		return status;
	writer->file = spec_memory_new(files, sizeof *writer->file, "files", error);
	if (!writer->file)
		return SPEC_ENOMEM;
	writer->files = files;
	status = spec_plugin_load(&writer->plugin, error);
	if (status == SPEC_OK)
		status = spec_text_open(description, error);
	if (status != SPEC_OK)
		return status;
	status = spec_description_write(writer->base.image, description, error);
	fputc('\0', description->stream);
	return status == SPEC_OK ? spec_text_close(description, error) : status;
}

static enum spec_status
open_tiff(struct spec_writer *base, struct spec_error *error)
{
	struct tiff_writer *writer = (struct tiff_writer *)base;
	struct spec_text description = {0};
	enum spec_status status = prepare(writer, 1, &description, error);

	if (status == SPEC_OK && base->output->terminal)
		status = spec_error_set(error, SPEC_EUSAGE,
			"refusing to write an image to a terminal; use -o FILE or a pipe");
	if (status == SPEC_OK && !base->output->seekable)
		status = spec_output_scratch(&writer->scratch_fd, error);
	if (status == SPEC_OK)
		status = open_file(writer, &writer->file[0],
			writer->scratch_fd >= 0 ? writer->scratch_fd : base->output->fd,
			base->image->bands, description.bytes, error);
	spec_text_free(&description);
	return status;
}

static enum spec_status
open_packer(struct spec_packer *base, struct spec_error *error)
{
	struct tiff_packer *packer = (struct tiff_packer *)base;
	const struct spec_image *image = base->writer->image;

	packer->line = spec_memory_aligned(spec_window_width(&image->data) * image->bands,
		sizeof(float), "samples", error);
	return packer->line ? SPEC_OK : SPEC_ENOMEM;
}

static void
close_packer(struct spec_packer *packer)
{
	free(((struct tiff_packer *)packer)->line);
}

/* Band by band for a folder, pixel by pixel for one file. */
static enum spec_status
encode(struct spec_packer *base, int index, unsigned char *raw, struct spec_error *error)
{
	struct tiff_packer *packer = (struct tiff_packer *)base;
	const struct tiff_writer *writer = (const struct tiff_writer *)base->writer;
	const struct spec_image *image = base->writer->image;
	size_t width = spec_window_width(&image->data), bands = image->bands;

	(void)index;
	(void)raw;
	(void)error;
	for (size_t band = 0; band < bands; band++) {
		const float *from = base->plane[image->band_channel[band]];

		if (writer->base.format->makes_files)
			memcpy(packer->line + band * width, from, width * sizeof *from);
		else
			for (size_t x = 0; x < width; x++)
				packer->line[x * bands + band] = from[x];
	}
	base->chunk = packer->line;
	return SPEC_OK;
}

static enum spec_status
write_line(struct spec_packer *packer, int index, struct spec_error *error)
{
	struct tiff_writer *writer = (struct tiff_writer *)packer->writer;
	size_t width = spec_window_width(&writer->base.image->data);
	const float *line = packer->chunk;

	(void)index;
	for (size_t i = 0; i < writer->files; i++) {
		struct spec_error cause = {0};

		if (writer->plugin.table->write(writer->file[i].picture, line + i * width,
			    1, &cause) != SPEC_OK)
			return report(error, &cause, writer->base.path);
	}
	return SPEC_OK;
}

static enum spec_status
finish(struct spec_writer *base, struct spec_error *error)
{
	struct tiff_writer *writer = (struct tiff_writer *)base;

	for (size_t i = 0; i < writer->files; i++) {
		struct spec_error cause = {0};
		const unsigned char *bytes;
		size_t size;

		if (writer->plugin.table->finish(
			    writer->file[i].picture, &bytes, &size, &cause) != SPEC_OK)
			return report(error, &cause, base->path);
	}
	return writer->scratch_fd >= 0
		       ? spec_output_append(base->output, writer->scratch_fd, error)
		       : SPEC_OK;
}

static void
close_writer(struct spec_writer *base)
{
	struct tiff_writer *writer = (struct tiff_writer *)base;

	for (size_t i = 0; i < writer->files; i++) {
		if (writer->file[i].picture)
			writer->plugin.table->close(writer->file[i].picture);
		if (writer->file[i].opened)
			spec_output_abandon(&writer->file[i].output);
	}
	free(writer->file);
	if (writer->scratch_fd >= 0)
		close(writer->scratch_fd);
	if (writer->made_folder)
		(void)rmdir(base->path); /* it is empty where nothing was committed */
	spec_plugin_unload(&writer->plugin);
}

const struct spec_writing_format spec_writing_tiff = {
	.name = "tiff",
	.suffixes = ".tif .tiff",
	.writer_bytes = sizeof(struct tiff_writer),
	.packer_bytes = sizeof(struct tiff_packer),
	.open = open_tiff,
	.open_packer = open_packer,
	.encode = encode,
	.write = write_line,
	.finish = finish,
	.close_packer = close_packer,
	.close = close_writer,
};

/* ---- a folder ---- */

static enum spec_status
open_band(struct tiff_writer *writer, size_t band, const char *description,
	struct spec_error *error)
{
	struct file *file = &writer->file[band];
	char number[SPEC_SPD_NUMBER], path[4096];
	enum spec_status status;

	spec_spd_format_number(writer->base.image->wavelength_nm[band], number);
	if (snprintf(path, sizeof path, "%s/%snm.tif", writer->base.path, number) >=
		(int)sizeof path)
		return spec_error_set(
			error, SPEC_EUSAGE, "%s: is too long a name", writer->base.path);
	status = spec_output_open(&file->output, path, error);
	file->opened = status == SPEC_OK;
	return status == SPEC_OK
		       ? open_file(writer, file, file->output.fd, 1, description, error)
		       : status;
}

static enum spec_status
open_folder(struct spec_writer *base, struct spec_error *error)
{
	struct tiff_writer *writer = (struct tiff_writer *)base;
	struct spec_text description = {0};
	enum spec_status status = prepare(writer, base->image->bands, &description, error);

	if (status == SPEC_OK && strcmp(base->path, "-") == 0)
		status = spec_error_set(error, SPEC_EUSAGE,
			"a folder of pictures cannot go to standard output (-o FOLDER)");
	if (status == SPEC_OK && mkdir(base->path, 0777) == 0)
		writer->made_folder = 1;
	else if (status == SPEC_OK && errno != EEXIST)
		status = spec_error_system(
			error, errno, "unable to make the folder '%s'", base->path);
	for (size_t i = 0; i < writer->files && status == SPEC_OK; i++)
		status = open_band(writer, i, description.bytes, error);
	spec_text_free(&description);
	return status;
}

static enum spec_status
commit_folder(struct spec_writer *base, struct spec_error *error)
{
	struct tiff_writer *writer = (struct tiff_writer *)base;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < writer->files && status == SPEC_OK; i++) {
		writer->plugin.table->close(writer->file[i].picture);
		writer->file[i].picture = NULL;
		writer->file[i].opened = 0;
		status = spec_output_commit(&writer->file[i].output, error);
	}
	writer->made_folder &= status != SPEC_OK;
	return status;
}

const struct spec_writing_format spec_writing_folder = {
	.name = "bands",
	.suffixes = "",
	.writer_bytes = sizeof(struct tiff_writer),
	.packer_bytes = sizeof(struct tiff_packer),
	.makes_files = 1,
	.open = open_folder,
	.open_packer = open_packer,
	.encode = encode,
	.write = write_line,
	.finish = finish,
	.commit = commit_folder,
	.close_packer = close_packer,
	.close = close_writer,
};
