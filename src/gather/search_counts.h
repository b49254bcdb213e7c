/* search_counts.h: the search of many rays and one test, which counts what pixels see before it
 * adds light up. */
#ifndef RF_SEARCH_COUNTS_H
#define RF_SEARCH_COUNTS_H

#include "gather/search_chunk.h"

#include <stdalign.h>

enum { RF_COUNTED_SIDE = RF_TILE + 2 * RF_COUNT_REACH }; /* rows that a tile may see */

/* The share of a worker. */
struct rf_counting {
    alignas(64) uint16_t count[RF_COUNTS][RF_TILE]; /* `settled` between rows of a strip, 0 between
                                                       strips */
    uint16_t settled[RF_COUNTS];                    /* times of rays that are settled for a strip */
    uint8_t touched[RF_COUNTS], settled_touched[RF_COUNTS];
    uint16_t number[RF_COUNTS];
    int reach; /* offsets, and those of first guesses, are that at the most */
    struct rf_search_chunk chunk;
    uint32_t sum[RF_COUNTED_PLANES][RF_TILE];
    alignas(64) struct rf_counted_rays rays;
    int16_t blur[RF_COUNTED_SIDE * RF_COUNT_ROW];
    uint16_t plane[RF_COUNTED_PLANES][RF_COUNTED_SIDE * RF_COUNT_ROW];
};

/* Whether rays of a set are counted in a tile; prepares for that. */
bool rf_count_begin(struct rf_counting *counting, const struct rf_frame *f, int tx, int ty,
                    const struct rf_ray_set *set);

/* Adds up what they see. The result is without meaning after a cancelled run. */
void rf_count_rays(struct rf_counting *counting, const struct rf_frame *f, int tx, int ty,
                   const struct rf_ray_set *set, struct rf_sums *sums);

#endif
