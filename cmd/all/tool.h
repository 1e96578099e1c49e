/* What the mains of all tools have in common, beside what cli/ knows of options. */
#ifndef SPEC_CMD_ALL_TOOL_H
#define SPEC_CMD_ALL_TOOL_H

#include "cli/options.h"
#include "cli/progress.h"
#include "image/settings.h"

/* As cli_start. From here on every option and scene takes the light of places by its names. */
void tool_start(struct cli *cli, const struct cli_program *program, int argc, char **argv);

/*
 * The work on images begins: progress, which must stay where it is, shows the lines that are
 * done, as the settings have it, and an image's history will name the command.
 */
void tool_begin(struct cli_progress *progress, struct spec_settings *settings, int argc,
	char **argv);

#endif
