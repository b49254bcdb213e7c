/* live_sources.h: the cameras and depth that refocus live takes. */
#ifndef RF_CLI_LIVE_SOURCES_H
#define RF_CLI_LIVE_SOURCES_H

#include "live/live_state.h"

/* Open the cameras, the network or the map of depth; an exit code, and prints why. */
int live_sources_open(struct live *live);
void live_sources_close(struct live *live);

#endif
