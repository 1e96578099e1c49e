/*
 * A tool's command line: options, help text and suggestions come from one table,
 * so they cannot drift apart. For cmd/ alone.
 */
#ifndef SPEC_CLI_OPTIONS_H
#define SPEC_CLI_OPTIONS_H

#include "base/error.h"

struct cli_option {
	char letter;          /* 0: none */
	const char *name;     /* without the dashes */
	const char *argument; /* how the help names it; null: takes none */
	const char *help;     /* a line, which is wrapped; what is in '' stays together */
};

struct cli_program {
	const char *name;
	const char *arguments; /* of the synopsis, such as "[OPTION]... [FILE]" */
	const char *summary;   /* of any length, wrapped */
	const struct cli_option *options; /* ends with a null name; all tools' follow */
	int writes_images; /* has the options of what writes spectral images */
};

struct cli {
	const struct cli_program *program;
	char **argument; /* what remains */
	int count;
	const char *cluster; /* the rest of "-qo" */
	int operands_only;
	const char *name;  /* the option found, or null for an operand */
	const char *value; /* its argument, or the operand; null: none */
};

void cli_start(struct cli *cli, const struct cli_program *program, int argc, char **argv);

/*
 * The next option or operand: sets name and value; 0 at the end. Answers --help
 * and --version itself and exits; a bad option ends the program with status 2.
 */
int cli_next(struct cli *cli);

/* Takes an option, or an operand where name is null; fails as the library does. */
typedef enum spec_status cli_take(
	void *state, const char *name, const char *value, struct spec_error *error);

/* Takes all options and operands, in order; the first that fails ends the program. */
void cli_take_each(struct cli *cli, cli_take *take, void *state);

/*
 * As cli_take_each, of a tool that works on one thing: take gets each option. Returns the
 * operand, or null; a second one ends the program. noun: what it is, for that message, such
 * as "image".
 */
const char *cli_take_all(struct cli *cli, const char *noun, cli_take *take, void *state);

/* Ends the program: one line on stderr, "name: message", exit status 2. */
_Noreturn void cli_die(const struct cli *cli, const struct spec_error *error);
_Noreturn void cli_usage(const struct cli *cli, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

/* One line on stderr, "name: warning: message". */
void cli_warn(const struct cli *cli, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

/* Ends the program with the error's line when status is not SPEC_OK. */
void cli_check(
	const struct cli *cli, enum spec_status status, const struct spec_error *error);

/* The warning of pixels that were left out, if any: no such thing is for their id. */
void cli_warn_bare(const struct cli *cli, const char *noun, long long bare);

/* The warning of what --half made infinite in output, if anything. */
void cli_warn_overflows(
	const struct cli *cli, const char *output, unsigned long long overflows);

/* Closes stdout, checked, and returns the status to exit with: failed output is a failed run. */
int cli_finish(const struct cli *cli, int status);

#endif
