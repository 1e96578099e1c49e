#include "tool.h"

#include "place/sunlight.h"
#include "spectrum/lookup.h"

void
tool_start(struct cli *cli, const struct cli_program *program, int argc, char **argv)
{
	spec_lookup_set_maker(&spec_sunlight_maker);
	cli_start(cli, program, argc, argv);
}

void
tool_begin(struct cli_progress *progress, struct spec_settings *settings, int argc,
	char **argv)
{
	cli_progress_start(progress, "lines", settings->progress, settings->quiet);
	settings->argc = argc;
	settings->argv = argv;
	settings->show = cli_progress_show;
	settings->show_state = progress;
}
