/* live_range.h: a range of distances that follows the scene. */
#ifndef RF_CLI_LIVE_RANGE_H
#define RF_CLI_LIVE_RANGE_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/depth.h>

/* The distances that disparity 1 and 0 stand for, in 1/m: 1 is near, 0 is far. Both 0: not
 * known. */
struct live_range {
    double near, far;
};

static inline bool live_range_is_known(const struct live_range *range)
{
    return range->near > range->far;
}

struct live_range_end {
    bool moves;
    double unused_s; /* for so long it could have been nearer to the other */
};

struct live_ranger {
    struct live_range range;
    bool near_given, far_given; /* by the command line: that end does not move */
    struct live_range past[3];  /* ranges that the last maps showed */
    uint64_t maps;
    struct live_range_end near_end, far_end;
    int64_t last_ns;
    uint32_t *counts; /* a histogram of codes, allocated with the first map */
};

/* Metres that are given; 0: those that are seen. */
void live_range_begin(struct live_ranger *ranger, double near_m, double far_m);
void live_range_end(struct live_ranger *ranger);
/* The nearest and the farthest surface of a map of packed 16-bit distances, where 0 is unknown;
 * false: it shows none, or there is no memory. */
bool live_range_measure(struct live_ranger *ranger, const struct refocus_depth_map *map,
                        struct live_range *seen);
/* Move ranger->range for a map of that time which shows this. The first map sets it. */
void live_range_follow(struct live_ranger *ranger, const struct live_range *seen, int64_t now_ns);

#endif
