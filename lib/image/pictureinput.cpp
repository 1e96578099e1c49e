/* The plugin's readers; pictures.h is its interface. */
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>

#include "image/pictures.hpp"

namespace
{

struct Input {
	std::unique_ptr<OIIO::ImageInput> file;
	std::string format, description;
	int channels = 0, y = 0;
};

enum spec_status
open_file(Input &input, const char *path, struct spec_pictures_content *content,
	struct spec_error *error)
{
	input.file = OIIO::ImageInput::open(path);
	if (!input.file)
		return fail(error, SPEC_EFORMAT, OIIO::geterror());
	const OIIO::ImageSpec &spec = input.file->spec();
	if (spec.deep || spec.depth > 1)
		return fail(error, SPEC_EUNSUPPORTED, "is deep, or a volume");
	input.format = input.file->format_name();
	input.description = spec.get_string_attribute("ImageDescription");
	input.channels = spec.nchannels;
	input.y = spec.y;
	content->format = input.format.c_str();
	content->description = input.description.c_str();
	content->width = spec.width;
	content->height = spec.height;
	content->channels = spec.nchannels;
	content->integers = !spec.format.is_floating_point();
	/*
	 * Where a file of whole numbers says nothing, OpenImageIO too takes it for sRGB. It
	 * calls PPM Rec709, as the format's page does; what writes PPM writes sRGB.
	 */
	const std::string colour = spec.get_string_attribute("oiio:ColorSpace");
	content->encoded = colour == "sRGB" ||
			   (content->integers && (colour.empty() || colour == "Rec709"));
	return SPEC_OK;
}

} // namespace

enum spec_status
spec_pictures_open_input(void **handle, const char *path,
	struct spec_pictures_content *content, struct spec_error *error)
{
	*handle = nullptr;
	return guard(error, [&] {
		auto input = std::make_unique<Input>();
		enum spec_status status = open_file(*input, path, content, error);

		if (status == SPEC_OK)
			*handle = input.release();
		return status;
	});
}

enum spec_status
spec_pictures_read_input(
	void *handle, int first, int end, float *rows, struct spec_error *error)
{
	return guard(error, [&] {
		auto &input = *static_cast<Input *>(handle);

		if (!input.file->read_scanlines(0, 0, input.y + first, input.y + end, 0, 0,
			    input.channels, OIIO::TypeFloat, rows))
			return fail(error, SPEC_EFORMAT, input.file->geterror());
		return SPEC_OK;
	});
}

void
spec_pictures_close_input(void *handle)
{
	delete static_cast<Input *>(handle);
}
