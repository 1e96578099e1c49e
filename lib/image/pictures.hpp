/* What the C++ files of the plugin share. */
#ifndef SPEC_IMAGE_PICTURES_HPP
#define SPEC_IMAGE_PICTURES_HPP

#include <cstdio>
#include <exception>
#include <new>
#include <string>

extern "C" {
#include "image/pictures.h"

/* pictureinput.cpp's functions of the plugin's table. */
__attribute__((visibility("hidden"))) enum spec_status spec_pictures_open_input(
	void **input, const char *path, struct spec_pictures_content *content,
	struct spec_error *error);
__attribute__((visibility("hidden"))) enum spec_status spec_pictures_read_input(
	void *input, int first, int end, float *rows, struct spec_error *error);
__attribute__((visibility("hidden"))) void spec_pictures_close_input(void *input);
}

inline enum spec_status
fail(struct spec_error *error, enum spec_status status, const std::string &message)
{
	/* OpenImageIO gathers several, a line each; the first is the cause. */
	const std::string line = message.substr(0, message.find('\n'));

	error->status = status;
	snprintf(error->message, sizeof error->message, "%s",
		line.empty() ? "unknown error of OpenImageIO" : line.c_str());
	return status;
}

/* Runs f; whatever it throws comes back as a status. */
template <typename F>
inline enum spec_status
guard(struct spec_error *error, F f)
{
	try {
		return f();
	} catch (const std::bad_alloc &) {
		/* No std::string here: it might throw again. */
		error->status = SPEC_ENOMEM;
		snprintf(error->message, sizeof error->message, "out of memory");
	} catch (const std::exception &exception) {
		error->status = SPEC_EIO;
		snprintf(error->message, sizeof error->message, "%s", exception.what());
	} catch (...) {
		error->status = SPEC_EIO;
		snprintf(error->message, sizeof error->message, "unknown exception");
	}
	return error->status;
}

#endif
