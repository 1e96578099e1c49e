/*
 * The words of scene files, with the places where they stand: columns count characters, from
 * 1. A file that a file includes is read in between.
 */
#ifndef SPEC_SCENE_TOKENS_H
#define SPEC_SCENE_TOKENS_H

#include <stddef.h>

#include "base/error.h"
#include "scene/scene.h"

#define SPEC_TOKENS_DEEPEST 64              /* files in files */
#define SPEC_TOKENS_MOST_FILES 65536        /* that are read for one scene */
#define SPEC_TOKENS_LARGEST_FILE 2147483647 /* bytes, so that every place is two ints */

enum spec_token_kind {
	SPEC_TOKEN_WORD,   /* a statement, a number, true or false */
	SPEC_TOKEN_STRING, /* without its quotes, escapes written out */
	SPEC_TOKEN_OPEN,   /* [ */
	SPEC_TOKEN_CLOSE,  /* ] */
	SPEC_TOKEN_RETURN, /* a file that was imported has ended */
	SPEC_TOKEN_END     /* the first file has */
};

struct spec_token {
	enum spec_token_kind kind;
	/*
	 * Until the next token is read. Of a string a zero follows; of a word never a
	 * character that it could go on with.
	 */
	const char *text;
	size_t length;
	struct spec_scene_place place;
};

/* Whether it is this word, such as "true". */
int spec_token_is_word(const struct spec_token *token, const char *word);

struct spec_tokens {
	struct spec_scene *scene; /* takes the names of the files */
	struct spec_error *error; /* of whoever reads; may be null */
	struct spec_tokens_file *open;
	size_t count, room;      /* of the open ones */
	struct spec_token again; /* was given back */
	int has_again;
};

/*
 * Begins with the file at path, "-" is standard input, or with size bytes of text, for which
 * name stands. scene: empty. Errors are left in error, here and in the functions below:
 * SPEC_EIO, SPEC_EFORMAT, SPEC_ERANGE (a limit above), SPEC_EUNSUPPORTED (a compressed
 * file), SPEC_ENOMEM. Whether or not one occurs, spec_tokens_close ends.
 */
enum spec_status spec_tokens_open(struct spec_tokens *tokens, struct spec_scene *scene,
	const char *path, struct spec_error *error);
enum spec_status spec_tokens_open_text(struct spec_tokens *tokens, struct spec_scene *scene,
	const char *text, size_t size, const char *name, struct spec_error *error);
void spec_tokens_close(struct spec_tokens *tokens);

/* The next token. SPEC_EFORMAT: a string does not end, or has an escape that is none. */
enum spec_status spec_tokens_next(struct spec_tokens *tokens, struct spec_token *token);

/* The token that was read last is the next one again. */
void spec_tokens_unget(struct spec_tokens *tokens, const struct spec_token *token);

/*
 * The next token, of the kind wanted; what: the noun of what it is, for the message of
 * SPEC_EFORMAT.
 */
enum spec_status spec_tokens_want(struct spec_tokens *tokens, enum spec_token_kind kind,
	const char *what, struct spec_token *token);

/* The next token is a finite number. */
enum spec_status spec_tokens_number(struct spec_tokens *tokens, double *number);

/* A word that must be a finite number. */
enum spec_status spec_tokens_read_number(
	struct spec_tokens *tokens, const struct spec_token *token, double *number);

/*
 * Goes on with the file that a string names, as spec_scene_find_file finds it. imported:
 * there will be a SPEC_TOKEN_RETURN at its end.
 */
enum spec_status spec_tokens_include(
	struct spec_tokens *tokens, const struct spec_token *name, int imported);

#endif
