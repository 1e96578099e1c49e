#include "cli/options.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/nearest.h"

#define EXIT_TROUBLE 2
#define LONGEST_NAME 32
#define HELP_COLUMN 28
#define HELP_WIDTH 80 /* columns: the narrowest terminal that people have */

static const struct cli_option common_options[] = {
	{'o', "output", "FILE", "write FILE (default: standard output)"},
	{'j', "threads", "N", "use N threads (default: all processors)"},
	{0, "part", "N|NAME", "which part of a file with several"},
	{0, "name-map", "NAME=NM,...", "channels that are bands, though not named so"},
	{0, "wavelengths", "LO:HI:STEP",
		"or W,W,...: of bands whose file does not say them [nm]"},
	{0, "read-as", "radiance|reflectance", "what bands are whose file does not say it"},
	{0, "limit", "NAME=VALUE",
		"raise or lower a limit: pixels channels attributes header memory"},
	{0, "progress", NULL, "show progress even when stderr is no terminal"},
	{'q', "quiet", NULL, "no warnings, no progress"},
	{'h', "help", NULL, "show this text"},
	{'V', "version", NULL, "show the version"},
	{0},
};

static const struct cli_option image_options[] = {
	{0, "compression", "NAME",
		"none rle zips zip piz pxr24 b44 b44a (default: zip, to a pipe none)"},
	{0, "half", NULL, "store bands as 16-bit floats"},
	{0, "no-history", NULL, "do not record this command in the output"},
	{0},
};

static const struct cli_option no_options[] = {{0}};

/* The tables that a program's options stand in, its own first. */
enum { TABLES = 3 };

static const struct cli_option *
table(const struct cli_program *program, int index)
{
	if (index == 0)
		return program->options;
	if (index == 1)
		return program->writes_images ? image_options : no_options;
	return common_options;
}

void
cli_start(struct cli *cli, const struct cli_program *program, int argc, char **argv)
{
	*cli = (struct cli){.program = program, .argument = argv + 1, .count = argc - 1};
	if (argc < 1)
		*cli = (struct cli){.program = program};
}

/* Up to the next blank where a line may end: a default stays whole, and what is quoted. */
static int
word_length(const char *text)
{
	static const char lead[] = "(default: ";
	const char *end = text;
	const char *quote;

	if (strncmp(end, lead, sizeof lead - 1) == 0)
		end += sizeof lead - 1;
	quote = *end == '\'' ? strchr(end + 1, '\'') : NULL;
	if (quote)
		end = quote;
	return (int)(end - text + strcspn(end, " "));
}

/* Lines of a text, indented; the first is by now. */
static void
print_wrapped(const char *text, int indent)
{
	int column = indent;

	for (int length; *text; text += length + strspn(text + length, " ")) {
		length = word_length(text);
		if (column > indent && column + 1 + length > HELP_WIDTH) {
			printf("\n%*s", indent, "");
			column = indent;
		}
		column += printf("%s%.*s", column > indent ? " " : "", length, text);
	}
	printf("\n");
}

static void
print_option(const struct cli_option *option)
{
	char left[80];
	int length;

	length = option->letter ? snprintf(left, sizeof left, "  -%c, ", option->letter)
				: snprintf(left, sizeof left, "      ");
	length += snprintf(left + length, sizeof left - length, "--%s%s%s", option->name,
		option->argument ? " " : "", option->argument ? option->argument : "");
	if (length >= HELP_COLUMN)
		printf("%s\n%*s", left, HELP_COLUMN, "");
	else
		printf("%-*s", HELP_COLUMN, left);
	print_wrapped(option->help, HELP_COLUMN);
}

static _Noreturn void
print_help(const struct cli *cli)
{
	const struct cli_program *program = cli->program;

	printf("usage: %s %s\n", program->name, program->arguments);
	print_wrapped(program->summary, 0);
	printf("\n");
	for (int i = 0; i < TABLES; i++) {
		for (const struct cli_option *option = table(program, i); option->name;
			option++)
			print_option(option);
		if (i == 0)
			printf("\n");
	}
	exit(cli_finish(cli, 0));
}

static _Noreturn void
print_version(const struct cli *cli)
{
	printf("%s (spectools) %s\n", cli->program->name, SPEC_VERSION);
	exit(cli_finish(cli, 0));
}

static void
find_nearest(
	const struct cli_option *option, const char *name, const char **best, size_t *least)
{
	for (; option->name; option++) {
		size_t distance = spec_nearest_distance(name, option->name);

		if (distance < *least) {
			*least = distance;
			*best = option->name;
		}
	}
}

static _Noreturn void
unknown_option(const struct cli *cli, const char *name)
{
	const char *best = NULL;
	size_t least = strlen(name) / 2 + 1;

	for (int i = 0; i < TABLES; i++)
		find_nearest(table(cli->program, i), name, &best, &least);
	if (best)
		cli_usage(cli, "unknown option '--%s'; did you mean '--%s'?", name, best);
	cli_usage(cli, "unknown option '--%s' (try --help)", name);
}

static const struct cli_option *
find_in(const struct cli_option *option, char letter, const char *name, size_t length)
{
	for (; option->name; option++) {
		if (letter ? option->letter == letter
			   : strlen(option->name) == length &&
					memcmp(option->name, name, length) == 0)
			return option;
	}
	return NULL;
}

static const struct cli_option *
find(const struct cli *cli, char letter, const char *name, size_t length)
{
	const struct cli_option *option = NULL;

	for (int i = 0; i < TABLES && !option; i++)
		option = find_in(table(cli->program, i), letter, name, length);
	return option;
}

static void
take_argument(struct cli *cli, const struct cli_option *option, const char *attached)
{
	if (strcmp(option->name, "help") == 0)
		print_help(cli);
	if (strcmp(option->name, "version") == 0)
		print_version(cli);
	cli->name = option->name;
	cli->value = NULL;
	if (!option->argument)
		return;
	if (attached) {
		cli->value = attached;
	} else {
		if (cli->count == 0)
			cli_usage(cli, "option '--%s' needs an argument (%s)", option->name,
				option->argument);
		cli->value = *cli->argument++;
		cli->count--;
	}
}

static void
take_long(struct cli *cli, const char *text)
{
	size_t length = strcspn(text, "=");
	const struct cli_option *option = find(cli, 0, text, length);

	if (!option) {
		char name[LONGEST_NAME + 1];

		snprintf(name, sizeof name, "%.*s",
			(int)(length < LONGEST_NAME ? length : LONGEST_NAME), text);
		unknown_option(cli, name);
	}
	if (text[length] == '=' && !option->argument)
		cli_usage(cli, "option '--%s' takes no argument", option->name);
	take_argument(cli, option, text[length] == '=' ? text + length + 1 : NULL);
}

static void
take_letter(struct cli *cli, const char *text)
{
	const struct cli_option *option = find(cli, *text, NULL, 0);

	if (!option)
		cli_usage(cli, "unknown option '-%c' (try --help)", *text);
	cli->cluster = !option->argument && text[1] ? text + 1 : NULL;
	take_argument(cli, option, option->argument && text[1] ? text + 1 : NULL);
}

int
cli_next(struct cli *cli)
{
	const char *text;

	if (cli->cluster) {
		take_letter(cli, cli->cluster);
		return 1;
	}
	if (cli->count == 0)
		return 0;
	text = *cli->argument++;
	cli->count--;
	if (!cli->operands_only && strcmp(text, "--") == 0) {
		cli->operands_only = 1;
		return cli_next(cli);
	}
	if (cli->operands_only || text[0] != '-' || text[1] == '\0') {
		cli->name = NULL;
		cli->value = text;
	} else if (text[1] == '-') {
		take_long(cli, text + 2);
	} else {
		take_letter(cli, text + 1);
	}
	return 1;
}

void
cli_take_each(struct cli *cli, cli_take *take, void *state)
{
	struct spec_error error = {0};

	while (cli_next(cli))
		cli_check(cli, take(state, cli->name, cli->value, &error), &error);
}

/* What cli_take_all hands on, and what it keeps. */
struct single {
	const char *noun, *operand;
	cli_take *take;
	void *state;
};

static enum spec_status
take_single(void *state, const char *name, const char *value, struct spec_error *error)
{
	struct single *single = state;

	if (name)
		return single->take(single->state, name, value, error);
	if (single->operand)
		return spec_error_set(error, SPEC_EUSAGE, "one %s at a time: '%s' and '%s'",
			single->noun, single->operand, value);
	single->operand = value;
	return SPEC_OK;
}

const char *
cli_take_all(struct cli *cli, const char *noun, cli_take *take, void *state)
{
	struct single single = {noun, NULL, take, state};

	cli_take_each(cli, take_single, &single);
	return single.operand;
}

void
cli_die(const struct cli *cli, const struct spec_error *error)
{
	fprintf(stderr, "%s: %s\n", cli->program->name, error->message);
	if (error->place[0])
		fprintf(stderr, "%s\n", error->place);
	exit(EXIT_TROUBLE);
}

void
cli_usage(const struct cli *cli, const char *format, ...)
{
	struct spec_error error;
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(&error, SPEC_EUSAGE, format, arguments);
	va_end(arguments);
	cli_die(cli, &error);
}

void
cli_warn(const struct cli *cli, const char *format, ...)
{
	va_list arguments;

	fprintf(stderr, "%s: warning: ", cli->program->name);
	va_start(arguments, format);
	vfprintf(stderr, format, arguments);
	va_end(arguments);
	fputc('\n', stderr);
}

void
cli_check(const struct cli *cli, enum spec_status status, const struct spec_error *error)
{
	if (status != SPEC_OK)
		cli_die(cli, error);
}

void
cli_warn_bare(const struct cli *cli, const char *noun, long long bare)
{
	if (bare > 0)
		cli_warn(cli, "no %s is for the id of %lld %s: left out", noun, bare,
			bare == 1 ? "pixel" : "pixels");
}

void
cli_warn_overflows(const struct cli *cli, const char *output, unsigned long long overflows)
{
	if (overflows > 0)
		cli_warn(cli,
			"%s: %llu samples are too large for 16 bits and became infinite",
			output, overflows);
}

int
cli_finish(const struct cli *cli, int status)
{
	/* ferror first: an earlier failed write may have left nothing to flush. */
	int failed = ferror(stdout);

	if (fclose(stdout) != 0 || failed) {
		fprintf(stderr, "%s: unable to write '<stdout>': %s\n", cli->program->name,
			strerror(errno ? errno : EIO));
		return EXIT_TROUBLE;
	}
	return status;
}
