/* live_colour.h: the thread that takes pictures from the camera. */
#ifndef RF_CLI_LIVE_COLOUR_H
#define RF_CLI_LIVE_COLOUR_H

#include "live/live_state.h"

void *live_colour_thread(void *live);

#endif
