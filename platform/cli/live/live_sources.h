/* live_sources.h: what refocus live begins with, and the cameras and depth that it takes. */
#ifndef RF_CLI_LIVE_SOURCES_H
#define RF_CLI_LIVE_SOURCES_H

#include "live/live_state.h"

/* Begin with no thread and no camera, in memory of zeros. What is given stays the caller's. An exit
 * code; unless that is EXIT_DONE it prints why, and there is nothing to clear. */
int live_begin(struct live *live, const struct live_settings *settings, struct engine *engine);
void live_clear(struct live *live);

/* Open the cameras, the network or the map of depth; an exit code, and prints why. */
int live_sources_open(struct live *live);
void live_sources_close(struct live *live);

#endif
