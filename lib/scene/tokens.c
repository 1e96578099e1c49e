#include "scene/tokens.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/source.h"
#include "scene/paths.h"

#define CHUNK (1 << 20) /* bytes read at once */
#define SHOWN 60        /* bytes of a word in a message */
#define BLANKS " \t\r\n"

struct spec_tokens_file {
	char *text; /* with a zero at its end */
	size_t size, at;
	struct spec_scene_place place; /* of the byte at at */
	int imported;
};

static enum spec_status
fail_full(struct spec_tokens *tokens, const char *name)
{
	return spec_error_set(tokens->error, SPEC_ERANGE,
		"'%.300s' is longer than %d bytes", name, SPEC_TOKENS_LARGEST_FILE);
}

/* What is no text is found early, before a device has been read without an end. */
static enum spec_status
check_text(struct spec_tokens *tokens, const char *name, const char *text, size_t from,
	size_t to)
{
	if (from == 0 && to >= 2 && memcmp(text, "\x1f\x8b", 2) == 0)
		return spec_error_set(tokens->error, SPEC_EUNSUPPORTED,
			"'%.300s' is compressed: unpack it first", name);
	if (memchr(text + from, '\0', to - from))
		return spec_error_set(tokens->error, SPEC_EFORMAT,
			"'%.300s' has a zero byte in it, so it is no text", name);
	return SPEC_OK;
}

/* Reads a whole source into a text with a zero at its end. */
static enum spec_status
load_source(
	struct spec_tokens *tokens, struct spec_source *source, char **text, size_t *size)
{
	void *bytes = NULL;
	size_t room = 0, got = 1;
	enum spec_status status = SPEC_OK;

	*size = 0;
	spec_source_seal(source);
	while (status == SPEC_OK && got > 0) {
		status = spec_memory_grow(&bytes, &room, *size + CHUNK + 1, 1,
			"bytes of a scene", tokens->error);
		if (status == SPEC_OK)
			status = spec_source_read(source, (char *)bytes + *size, CHUNK,
				(int64_t)*size, &got, tokens->error);
		if (status == SPEC_OK && got > SPEC_TOKENS_LARGEST_FILE - *size)
			status = fail_full(tokens, source->name);
		if (status == SPEC_OK)
			status =
				check_text(tokens, source->name, bytes, *size, *size + got);
		*size += got;
	}
	if (status == SPEC_OK)
		((char *)bytes)[*size] = '\0';
	*text = bytes;
	return status;
}

/* Enters a name in the scene's list of files. */
static enum spec_status
add_name(struct spec_tokens *tokens, const char *name)
{
	struct spec_scene *scene = tokens->scene;
	void *list = scene->file;
	enum spec_status status;
	char *copy;

	if (scene->files == SPEC_TOKENS_MOST_FILES)
		return spec_error_set(tokens->error, SPEC_ERANGE,
			"more than %d files are included", SPEC_TOKENS_MOST_FILES);
	status = spec_memory_grow(&list, &scene->file_room, scene->files + 1,
		sizeof *scene->file, "files", tokens->error);
	scene->file = list;
	if (status != SPEC_OK)
		return status;
	copy = spec_memory_text(name, strlen(name), tokens->error);
	if (!copy)
		return SPEC_ENOMEM;
	scene->file[scene->files++] = copy;
	return SPEC_OK;
}

/* Reading goes on in a text, which is freed later, or now if there is an error. */
static enum spec_status
push(struct spec_tokens *tokens, char *text, size_t size, const char *name, int imported)
{
	static const char mark[] = "\xef\xbb\xbf"; /* UTF-8's byte order mark */
	void *list = tokens->open;
	enum spec_status status = spec_memory_grow(&list, &tokens->room, tokens->count + 1,
		sizeof *tokens->open, "files", tokens->error);

	tokens->open = list;
	if (status == SPEC_OK)
		status = add_name(tokens, name);
	if (status != SPEC_OK) {
		free(text);
		return status;
	}
	tokens->open[tokens->count++] = (struct spec_tokens_file){.text = text,
		.size = size,
		.at = strncmp(text, mark, 3) == 0 ? 3 : 0,
		.place = {tokens->scene->files - 1, 1, 1},
		.imported = imported};
	return SPEC_OK;
}

static enum spec_status
push_file(struct spec_tokens *tokens, const char *path, int imported)
{
	struct spec_source source;
	enum spec_status status = spec_source_open(&source, path, 1, tokens->error);
	char *text = NULL;
	size_t size = 0;

	if (status != SPEC_OK)
		return status;
	status = load_source(tokens, &source, &text, &size);
	if (status == SPEC_OK)
		status = push(tokens, text, size, source.name, imported);
	else
		free(text);
	spec_source_close(&source);
	return status;
}

enum spec_status
spec_tokens_open(struct spec_tokens *tokens, struct spec_scene *scene, const char *path,
	struct spec_error *error)
{
	*tokens = (struct spec_tokens){.scene = scene, .error = error};
	return push_file(tokens, path, 0);
}

enum spec_status
spec_tokens_open_text(struct spec_tokens *tokens, struct spec_scene *scene,
	const char *text, size_t size, const char *name, struct spec_error *error)
{
	enum spec_status status;
	char *copy;

	*tokens = (struct spec_tokens){.scene = scene, .error = error};
	if (size > SPEC_TOKENS_LARGEST_FILE)
		return fail_full(tokens, name);
	status = check_text(tokens, name, text, 0, size);
	if (status != SPEC_OK)
		return status;
	copy = spec_memory_text(text, size, error);
	return copy ? push(tokens, copy, size, name, 0) : SPEC_ENOMEM;
}

void
spec_tokens_close(struct spec_tokens *tokens)
{
	for (size_t i = 0; i < tokens->count; i++)
		free(tokens->open[i].text);
	free(tokens->open);
	*tokens = (struct spec_tokens){0};
}

enum spec_status
spec_tokens_include(struct spec_tokens *tokens, const struct spec_token *name, int imported)
{
	struct spec_scene_place place = name->place;
	char *path = NULL;
	enum spec_status status;

	if (tokens->count == SPEC_TOKENS_DEEPEST)
		return spec_scene_fail(tokens->scene, &place, tokens->error, SPEC_ERANGE,
			"files are included in files more than %d deep (does one include "
			"itself?)",
			SPEC_TOKENS_DEEPEST);
	if (strcmp(name->text, "-") == 0)
		return spec_scene_fail(tokens->scene, &place, tokens->error, SPEC_EUSAGE,
			"standard input cannot be included");
	status = spec_scene_need_file(
		tokens->scene, &place, name->text, &path, tokens->error);
	if (status != SPEC_OK)
		return status;
	status = push_file(tokens, path, imported);
	if (status != SPEC_OK)
		spec_scene_prefix(tokens->scene, &place, tokens->error);
	free(path);
	return status;
}

/* Steps over one byte. Those within a UTF-8 character do not count. */
static void
step(struct spec_tokens_file *file)
{
	unsigned char byte = (unsigned char)file->text[file->at++];

	if (byte == '\n') {
		file->place.line++;
		file->place.column = 1;
	} else if ((file->text[file->at] & 0xc0) != 0x80) {
		file->place.column++;
	}
}

static void
skip_blanks(struct spec_tokens_file *file)
{
	for (;;) {
		char byte = file->text[file->at];

		if (byte == '#')
			while (file->at < file->size &&
				!strchr("\r\n", file->text[file->at]))
				step(file);
		else if (byte != '\0' && strchr(BLANKS, byte))
			step(file);
		else
			return;
	}
}

static enum spec_status
fail_string(
	struct spec_tokens *tokens, const struct spec_scene_place *place, const char *what)
{
	return spec_scene_fail(tokens->scene, place, tokens->error, SPEC_EFORMAT,
		"the string that begins here %s", what);
}

/* The character that an escape stands for, or zero. */
static char
unescape(char letter)
{
	static const char letters[] = "bfnrt\\'\"", meant[] = "\b\f\n\r\t\\'\"";
	const char *found = letter ? strchr(letters, letter) : NULL;

	return found ? meant[found - letters] : '\0';
}

/* A string's escapes are written out where it stands, and a zero takes its last quote. */
static enum spec_status
read_string(
	struct spec_tokens *tokens, struct spec_tokens_file *file, struct spec_token *token)
{
	char *to = file->text + file->at + 1;

	token->kind = SPEC_TOKEN_STRING;
	token->text = to;
	for (step(file); file->text[file->at] != '"'; step(file)) {
		char byte = file->text[file->at];

		if (file->at == file->size || byte == '\n')
			return fail_string(tokens, &token->place, "has no end in its line");
		if (byte == '\\') {
			step(file);
			byte = unescape(file->text[file->at]);
			if (byte == '\0')
				return fail_string(tokens, &token->place,
					"has a \\ with none of b f n r t \\ ' \" behind it");
		}
		*to++ = byte;
	}
	step(file);
	*to = '\0';
	token->length = (size_t)(to - token->text);
	return SPEC_OK;
}

/* The file that is being read, where its next token is, or null with the token set. */
static struct spec_tokens_file *
find_token(struct spec_tokens *tokens, struct spec_token *token)
{
	for (;;) {
		struct spec_tokens_file *file = &tokens->open[tokens->count - 1];

		skip_blanks(file);
		*token = (struct spec_token){.text = "", .place = file->place};
		if (file->at < file->size)
			return file;
		token->kind = tokens->count == 1 ? SPEC_TOKEN_END : SPEC_TOKEN_RETURN;
		if (tokens->count == 1)
			return NULL;
		free(file->text);
		tokens->count--;
		if (file->imported)
			return NULL;
	}
}

enum spec_status
spec_tokens_next(struct spec_tokens *tokens, struct spec_token *token)
{
	struct spec_tokens_file *file;

	if (tokens->has_again) {
		*token = tokens->again;
		tokens->has_again = 0;
		return SPEC_OK;
	}
	file = find_token(tokens, token);
	if (!file)
		return SPEC_OK;
	token->text = file->text + file->at;
	if (*token->text == '"')
		return read_string(tokens, file, token);
	if (*token->text == '[' || *token->text == ']') {
		token->kind = *token->text == '[' ? SPEC_TOKEN_OPEN : SPEC_TOKEN_CLOSE;
		token->length = 1;
	} else {
		token->kind = SPEC_TOKEN_WORD;
		token->length = strcspn(token->text, BLANKS "\"[]");
	}
	for (size_t i = 0; i < token->length; i++)
		step(file);
	return SPEC_OK;
}

void
spec_tokens_unget(struct spec_tokens *tokens, const struct spec_token *token)
{
	tokens->again = *token;
	tokens->has_again = 1;
}

/* There should have been something else. */
static enum spec_status
fail_token(struct spec_tokens *tokens, const struct spec_token *token, const char *what)
{
	int ended = token->kind == SPEC_TOKEN_END || token->kind == SPEC_TOKEN_RETURN;
	const char *quote = token->kind == SPEC_TOKEN_STRING ? "\"" : "'";

	if (ended)
		return spec_scene_fail(tokens->scene, &token->place, tokens->error,
			SPEC_EFORMAT, "the file ends where %s should be", what);
	return spec_scene_fail(tokens->scene, &token->place, tokens->error, SPEC_EFORMAT,
		"%s%.*s%s stands where %s should be", quote,
		token->length < SHOWN ? (int)token->length : SHOWN, token->text, quote,
		what);
}

int
spec_token_is_word(const struct spec_token *token, const char *word)
{
	return token->kind == SPEC_TOKEN_WORD && token->length == strlen(word) &&
	       strncmp(token->text, word, token->length) == 0;
}

enum spec_status
spec_tokens_want(struct spec_tokens *tokens, enum spec_token_kind kind, const char *what,
	struct spec_token *token)
{
	enum spec_status status = spec_tokens_next(tokens, token);

	if (status == SPEC_OK && token->kind != kind)
		status = fail_token(tokens, token, what);
	return status;
}

enum spec_status
spec_tokens_read_number(
	struct spec_tokens *tokens, const struct spec_token *token, double *number)
{
	if (token->kind != SPEC_TOKEN_WORD || token->length == 0 ||
		spec_number_scan(token->text, '.', number) != token->length)
		return fail_token(tokens, token, "a number");
	return SPEC_OK;
}

enum spec_status
spec_tokens_number(struct spec_tokens *tokens, double *number)
{
	struct spec_token token;
	enum spec_status status = spec_tokens_next(tokens, &token);

	return status == SPEC_OK ? spec_tokens_read_number(tokens, &token, number) : status;
}
