/* live_output.h: the thread that writes what is rendered. */
#ifndef RF_CLI_LIVE_OUTPUT_H
#define RF_CLI_LIVE_OUTPUT_H

#include "live/live_state.h"

void *live_output_thread(void *live);

#endif
