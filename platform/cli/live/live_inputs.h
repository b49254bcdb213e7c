/* live_inputs.h: the inputs of refocus live are not written over. */
#ifndef RF_CLI_LIVE_INPUTS_H
#define RF_CLI_LIVE_INPUTS_H

#include "live/live_settings.h"

/* An exit code; it prints why it is not EXIT_DONE. */
int live_check_inputs(const struct live_settings *settings);

#endif
