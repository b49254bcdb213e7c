/* live_commands.h: commands from standard input and from a socket, in a thread of its own. */
#ifndef RF_CLI_LIVE_COMMANDS_H
#define RF_CLI_LIVE_COMMANDS_H

#include "live/live_state.h"

/* Make the socket of the settings, where there is one; an exit code, and prints why. */
int live_commands_open(struct live *live);
/* Close and remove it. */
void live_commands_close(struct live *live);
void *live_command_thread(void *live);

#endif
