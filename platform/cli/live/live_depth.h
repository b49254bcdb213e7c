/* live_depth.h: depth maps on their way, and which of them goes with which frame. */
#ifndef RF_CLI_LIVE_DEPTH_H
#define RF_CLI_LIVE_DEPTH_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include "live/live_range.h"

enum { LIVE_DEPTHS = 16, LIVE_HABITS = 3 };

struct live_depth_map {
    uint16_t *disparity; /* packed */
    size_t capacity;
    int width, height;
    struct live_range range;
    int64_t timestamp_ns;
    uint64_t number; /* 0: empty */
};

struct live_depths {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    struct live_depth_map map[LIVE_DEPTHS];
    uint64_t count; /* maps so far */
    /* These are of the last maps: when the newest was taken, how long after the one before, and how
     * long after that it was here, by the clock on the wall; by count % LIVE_HABITS. */
    int64_t newest_ns, period_ns[LIVE_HABITS], lag_ns[LIVE_HABITS];
    int pinned;        /* the one that is being used, or -1 */
    int64_t needed_ns; /* maps from before this moment are needed no more */
    bool made;         /* the lock and the condition are there */
    bool every, ended;
    bool failed; /* the maps that would have come are missing */
    bool still;  /* the newest map is for all times */
};

/* False: there is no lock to be had; live_depths_free() is right even so. */
bool live_depths_init(struct live_depths *depths, bool every);
void live_depths_free(struct live_depths *depths);
/* No more maps will come. After a failure, when every frame counts, those that would have waited
 * for the next map have none. */
void live_depths_end(struct live_depths *depths, bool failed);
bool live_depths_have_failed(struct live_depths *depths);
/* A map to fill that no one uses; NULL when it is over or there is no memory. */
struct live_depth_map *live_depths_fill(struct live_depths *depths, int width, int height);
void live_depths_put(struct live_depths *depths, struct live_depth_map *map, int64_t timestamp_ns,
                     bool still);
/*
 * When the map of a moment will be here, as the last maps came, by the clock on the wall, which
 * shows now_ns: INT64_MAX when none will be within half a frame of it, INT64_MIN before the first
 * of them. The caller has the lock.
 */
int64_t live_depths_due(const struct live_depths *depths, int64_t timestamp_ns, int64_t half_ns,
                        int64_t now_ns);
/*
 * The map within half a frame of a moment. When there is none, *paired is false, and it is the
 * newest map, or, when every frame counts, the one nearest in time, which does not depend on how
 * far depth is ahead; NULL when there is no map at all. It may be used until the next call. A map
 * that is due by the deadline, of the clock on the wall, is waited for until then, or when every
 * frame counts as long as it takes.
 */
const struct live_depth_map *live_depths_pair(struct live_depths *depths, int64_t timestamp_ns,
                                              int64_t half_ns, int64_t deadline_ns, bool *paired);
/* Memory for a map of that size, which the map then owns; false: there is none. */
bool live_depth_reserve(struct live_depth_map *map, int width, int height);
/* Put a map of a wider range in place of a map, in memory that `wide` owns. */
int live_depth_widen(struct live_depth_map *wide, const struct live_depth_map **map,
                     const struct live_range *range);

#endif
