#include "cli/groups.h"

#include "base/memory.h"

enum spec_status
cli_groups_take(
	struct cli_groups *groups, int option, const char *value, struct spec_error *error)
{
	void *list = groups->group;
	enum spec_status status;

	if (groups->count > 0 && !groups->group[groups->count - 1].option[option]) {
		groups->group[groups->count - 1].option[option] = value;
		return SPEC_OK;
	}
	status = spec_memory_grow(&list, &groups->room, groups->count + 1,
		sizeof *groups->group, groups->nouns, error);
	groups->group = list;
	if (status == SPEC_OK)
		groups->group[groups->count++].option[option] = value;
	return status;
}
