/*
 * Options that belong together and may be given several times, such as a stack, its
 * thickness and the surfaces it is for. For cmd/ alone.
 */
#ifndef SPEC_CLI_GROUPS_H
#define SPEC_CLI_GROUPS_H

#include <stddef.h>

#include "base/error.h"

#define CLI_GROUP_OPTIONS 4 /* at most, of a group */

struct cli_group {
	/* As the tool numbers them; null: not given. */
	const char *option[CLI_GROUP_OPTIONS];
};

struct cli_groups {
	const char *nouns;       /* what they are, for messages, such as "stacks" */
	struct cli_group *group; /* freed with free() */
	size_t count, room;
};

/*
 * Takes the value of an option of a group: one that the last group has already begins
 * another. Error: SPEC_ENOMEM.
 */
enum spec_status cli_groups_take(
	struct cli_groups *groups, int option, const char *value, struct spec_error *error);

#endif
