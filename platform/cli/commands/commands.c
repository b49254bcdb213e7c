/* commands.c: the list of subcommands. */
#include <string.h>
#include "commands/commands.h"

const struct command *const commands[] = {&render_command, &depth_command, &sheet_command,
                                          &pull_command,   &info_command,  &compare_command,
                                          &bench_command,  &live_command,  &view_command,
                                          &serve_command,  &stack_command, NULL};

const struct command *commands_find(const char *name)
{
    for (int i = 0; commands[i]; i++)
        if (strcmp(commands[i]->name, name) == 0)
            return commands[i];
    return NULL;
}
