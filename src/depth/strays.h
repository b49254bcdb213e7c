/* strays.h: finds single samples of a map of distances that are far nearer than all others. */
#ifndef RF_DEPTH_STRAYS_H
#define RF_DEPTH_STRAYS_H

#include <stdint.h>
#include <refocus/depth.h>

struct rf_ranks {
    const struct refocus_depth_map *map;
    const uint32_t *count; /* samples of each value; NULL: they are read from the map */
    uint64_t known;        /* samples that hold a value */
    double far;            /* the least rank of them */
};

/*
 * Counts strays, and takes *near, the greatest rank of all, to the greatest one of the rest.
 *
 * Strays are fewer than a thousandth of the known samples, each of them would leave less than half
 * of the range to all of the rest, and no nine of them lie in a square: a sensor's mistakes lie by
 * themselves, and things have an extent. They are looked for above the middle of the range, then
 * above that of what lies below it, and so on. With ranks of 0.8 to 2.4 and single ones of 36 and
 * 333, 333 lies above 167 and the next one is 36, which lies above 18.4 and the next one is 2.4;
 * too many lie above 1.6.
 *
 * Each look reads all samples, or the counts, once; there are 32 looks at the most.
 */
uint64_t rf_find_strays(const struct rf_ranks *ranks, double *near);

#endif
