/* The plugin pictures.so; pictures.h is its interface. */
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "image/pictures.hpp"

namespace
{

/* A folder of our own, for formats that only write to files by name. */
class Folder
{
      public:
	Folder() = default;
	Folder(const Folder &) = delete;
	Folder &operator=(const Folder &) = delete;

	~Folder()
	{
		if (path_.empty())
			return;
		(void)unlink(file_.c_str());
		(void)rmdir(path_.c_str());
	}

	/* Makes it; the name of the file in it, or an empty one with errno set. */
	std::string
	make(const std::string &suffix)
	{
		const char *root = getenv("TMPDIR");
		std::string name = root && *root ? root : "/tmp";

		name += "/spectools.XXXXXX";
		file_.reserve(name.size() + suffix.size() + 16);
		if (!mkdtemp(&name[0]))
			return "";
		path_ = name;
		file_ = path_ + "/picture." + suffix;
		return file_;
	}

      private:
	std::string path_, file_;
};

struct Picture {
	std::vector<unsigned char> bytes;
	OIIO::Filesystem::IOVecOutput memory{bytes};
	Folder folder; /* outlives the output, which may hold its file open */
	std::string file;
	OIIO::TypeDesc sample;
	size_t stride = 0;
	int row = 0;
	std::unique_ptr<OIIO::ImageOutput> output;
};

/*
 * What OpenImageIO 2.4's formats turned out to do when they were tried. Its others are
 * no files (null, term), hold no RGB (zfile), are written elsewhere (png, pnm, openexr),
 * fail (iff, ico) or read back wrong when they are small (fits, rla).
 */
struct Format {
	const char *name;
	size_t most;    /* pixels of a side; beyond it gif wraps, and libjpeg calls exit */
	bool to_memory; /* jpeg2000 as j2k ignores its IOProxy, others take none */
};

const size_t any = (size_t)1 << 30;
const Format formats[] = {{"bmp", any, true}, {"dpx", any, false}, {"gif", 65535, true},
	{"hdr", any, true}, {"heif", any, false}, {"jpeg", 65500, true},
	{"jpeg2000", any, false}, {"sgi", 65535, false}, {"targa", 65535, true},
	{"tiff", any, true}, {"webp", 16383, true}};

const Format *
find_format(const OIIO::ImageOutput *output)
{
	for (const Format &format : formats) {
		if (output && strcmp(format.name, output->format_name()) == 0)
			return &format;
	}
	return nullptr;
}

/* Null with the error set where there is no such format, or it is not in the list. */
std::unique_ptr<OIIO::ImageOutput>
create(const std::string &suffix, struct spec_error *error)
{
	auto output = OIIO::ImageOutput::create("picture." + suffix);

	(void)OIIO::geterror(); /* it says no more than this: */
	if (!find_format(output.get())) {
		output.reset();
		fail(error, SPEC_EUNSUPPORTED, "no picture format for '." + suffix + "'");
	}
	return output;
}

OIIO::TypeDesc
type_of(int bits)
{
	return bits == 8    ? OIIO::TypeUInt8
	       : bits == 16 ? OIIO::TypeUInt16
			    : OIIO::TypeFloat;
}

std::string
size_text(size_t width, size_t height)
{
	return std::to_string(width) + " x " + std::to_string(height);
}

enum spec_status
open_output(Picture &picture, const struct spec_pictures_request &request,
	struct spec_error *error)
{
	picture.output = create(request.suffix, error);
	if (!picture.output)
		return SPEC_EUNSUPPORTED;
	const Format &format = *find_format(picture.output.get());
	if (request.width > format.most || request.height > format.most)
		return fail(error, SPEC_ERANGE,
			size_text(request.width, request.height) +
				" pixels are too many for ." + request.suffix + ": " +
				size_text(format.most, format.most));
	picture.sample = type_of(request.bits);
	picture.stride = request.width * request.channels * picture.sample.size();
	OIIO::ImageSpec spec((int)request.width, (int)request.height, (int)request.channels,
		picture.sample);
	if (request.colour)
		spec.attribute("oiio:ColorSpace", request.colour);
	if (request.profile)
		spec.attribute("ICCProfile",
			OIIO::TypeDesc(OIIO::TypeDesc::UINT8, (int)request.profile_bytes),
			request.profile);
	/* Its Exif directory fails, and with it the whole file. Other formats ignore this. */
	spec.attribute("tiff:write_exif", 0);
	std::string name = std::string("picture.") + request.suffix;
	if (format.to_memory && picture.output->supports("ioproxy")) {
		picture.output->set_ioproxy(&picture.memory);
	} else {
		name = picture.file = picture.folder.make(request.suffix);
		if (name.empty())
			return fail(error, SPEC_EIO,
				std::string("unable to create a temporary folder: ") +
					strerror(errno));
	}
	if (!picture.output->open(name, spec))
		return fail(error, SPEC_EUNSUPPORTED, picture.output->geterror());
	/* Formats quietly take the nearest that they can. */
	if (picture.output->spec().format != picture.sample ||
		picture.output->spec().nchannels != (int)request.channels)
		return fail(error, SPEC_EUNSUPPORTED,
			std::string(".") + request.suffix + " cannot hold " +
				std::to_string(request.channels) + " channels of " +
				std::to_string(request.bits) + " bits per sample");
	return SPEC_OK;
}

enum spec_status
read_back(Picture &picture, struct spec_error *error)
{
	FILE *stream = fopen(picture.file.c_str(), "rb");
	size_t got = 1;

	if (!stream)
		return fail(error, SPEC_EIO, "the format wrote nothing");
	std::unique_ptr<FILE, int (*)(FILE *)> closer(stream, fclose);
	while (got > 0) {
		const size_t used = picture.bytes.size(), step = (size_t)1 << 20;

		picture.bytes.resize(used + step);
		got = fread(picture.bytes.data() + used, 1, step, stream);
		picture.bytes.resize(used + got);
	}
	if (ferror(stream))
		return fail(error, SPEC_EIO, "unable to read back a temporary file");
	return SPEC_OK;
}

} // namespace

/* C's linkage for their types, but no names outside: the symbol below is the only one. */
extern "C" {

static enum spec_status
knows(const char *suffix, struct spec_error *error)
{
	return guard(
		error, [&] { return create(suffix, error) ? SPEC_OK : SPEC_EUNSUPPORTED; });
}

static void
close_picture(void *handle)
{
	/* A destructor's exception would end the program anyway; OpenImageIO's throw none. */
	delete static_cast<Picture *>(handle);
}

static enum spec_status
open_picture(void **handle, const struct spec_pictures_request *request,
	struct spec_error *error)
{
	*handle = nullptr;
	return guard(error, [&] {
		auto picture = std::make_unique<Picture>();
		enum spec_status status = open_output(*picture, *request, error);

		if (status == SPEC_OK)
			*handle = picture.release();
		return status;
	});
}

static enum spec_status
write_picture(void *handle, const void *rows, size_t count, struct spec_error *error)
{
	return guard(error, [&] {
		auto &picture = *static_cast<Picture *>(handle);
		auto byte = static_cast<const unsigned char *>(rows);

		/* One by one: some formats have write_scanline only. */
		for (size_t i = 0; i < count; i++, byte += picture.stride) {
			if (!picture.output->write_scanline(
				    picture.row++, 0, picture.sample, byte))
				return fail(error, SPEC_EIO, picture.output->geterror());
		}
		return SPEC_OK;
	});
}

static enum spec_status
finish_picture(
	void *handle, const unsigned char **bytes, size_t *size, struct spec_error *error)
{
	return guard(error, [&] {
		auto &picture = *static_cast<Picture *>(handle);
		enum spec_status status = SPEC_OK;

		*bytes = nullptr;
		*size = 0;

		if (!picture.output->close())
			return fail(error, SPEC_EIO, picture.output->geterror());
		/* Some notice a failure, and close as if there were none. */
		if (picture.output->has_error())
			return fail(error, SPEC_EIO, picture.output->geterror());
		picture.output.reset();
		if (!picture.file.empty())
			status = read_back(picture, error);
		if (status == SPEC_OK && picture.bytes.empty())
			status = fail(error, SPEC_EIO, "the format wrote nothing");
		*bytes = picture.bytes.data();
		*size = picture.bytes.size();
		return status;
	});
}

extern const struct spec_pictures spec_pictures;
const struct spec_pictures spec_pictures = {SPEC_PICTURES_VERSION, knows, open_picture,
	write_picture, finish_picture, close_picture, spec_pictures_open_input,
	spec_pictures_read_input, spec_pictures_close_input};
}
