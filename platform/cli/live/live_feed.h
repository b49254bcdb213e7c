/* live_feed.h: the frames of cameras, each with its depth, for somebody else than the renderer of
 * refocus live. */
#ifndef RF_CLI_LIVE_FEED_H
#define RF_CLI_LIVE_FEED_H

#include "live/live_state.h"

struct live_feed;

/* A frame, which is the feed's until the next one is taken. */
struct live_frame {
    struct refocus_image photo; /* RGB8 */
    const struct live_depth_map *depth;
};

/* Open the sources of settings that are checked, and stay; an exit code, and reports why. A feed
 * ends with its process, as each process of the page has one session and its cameras. */
int live_feed_open(struct live_feed **feed, const struct live_settings *settings);
/* Wait so long for a frame that is newer than the last one. An exit code, which is not EXIT_DONE
 * once the sources have failed, and why is reported; *came: whether there is one. */
int live_feed_next(struct live_feed *feed, int wait_ms, struct live_frame *frame, bool *came);

#endif
