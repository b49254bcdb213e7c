/* live_render.h: pictures are refocused, each with its depth, until it is over. */
#ifndef RF_CLI_LIVE_RENDER_H
#define RF_CLI_LIVE_RENDER_H

#include "live/live_state.h"

void live_render(struct live *live);

/* The depth of a picture, or NULL; counts which it was. */
const struct live_depth_map *live_pair(struct live *live, const struct live_picture *picture);

#endif
