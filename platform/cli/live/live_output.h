/* live_output.h: the thread that writes what is rendered. */
#ifndef RF_CLI_LIVE_OUTPUT_H
#define RF_CLI_LIVE_OUTPUT_H

#include "live/live_state.h"

void *live_output_thread(void *live);
/* Whether it goes into y4m or raw, where a write may wait for whoever reads: then a signal may cut
 * it short. */
bool live_output_is_stream(const struct live *live);

#endif
