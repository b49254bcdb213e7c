/* live_steady.h: depth that does not flicker. */
#ifndef RF_CLI_LIVE_STEADY_H
#define RF_CLI_LIVE_STEADY_H

#include <refocus/refocus.h>
#include "live/live_depth.h"
#include "live/live_times.h"

struct live_steady {
    struct refocus_temporal *filter; /* NULL: off, or no map has come */
    struct live_depth_map map;       /* the filtered one, and the number of what it was made of */
    struct live_times times;
};

/* Put the filtered map in place of a map, filtering it when it has not been yet. Returns what
 * refocus_temporal_create() and refocus_temporal_run() return. */
int live_steady_run(struct live_steady *steady, double strength, const struct live_depth_map **map,
                    const struct refocus_image *photo);
/* End a live_steady_run() that is under way early, with REFOCUS_ERR_CANCELLED; from any thread. */
void live_steady_cancel(struct live_steady *steady);
void live_steady_end(struct live_steady *steady);

#endif
