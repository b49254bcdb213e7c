/* place.h: puts the edges of a disparity map where the photo has them, in memory and with threads
 * of the caller. */
#ifndef RF_EDGES_PLACE_H
#define RF_EDGES_PLACE_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/depth_edges.h>
#include <refocus/image.h>

#include "edges/edges.h"
#include "image/planes.h"
#include "kernels/kernels.h"
#include "support/executor.h"

struct rf_place_edges {
    const struct rf_kernels *kernels;
    struct rf_pool *pool;
    const struct refocus_image *photo; /* packed: R, G and B */
    const struct refocus_disparity *map;
    struct rf_last_edges *last;  /* the frame before, which this one replaces; NULL: a still */
    void *memory;                /* rf_place_edges_bytes(), aligned to RF_ARENA_ALIGN */
    struct rf_shares shares;     /* rf_upsample_share() bytes each */
    struct rf_disparity_q16 out; /* is of the photo's size, apart from the map and from memory */
};

/* The bytes to work in for a photo of width x height and a map of columns x rows: UINT64_MAX if
 * they are too many. Smaller photos and maps of fewer samples need no more, and no map of any size
 * needs more than one of width + 1 columns and height + 1 rows. */
uint64_t rf_place_edges_bytes(int width, int height, int columns, int rows);

/*
 * refocus_depth_edges(). Says whether it wrote the result to `out`. If not, the map has the photo's
 * size and stays as it is. Once the run of the pool is cancelled it returns soon, and neither
 * result nor report is of use.
 */
bool rf_place_edges(const struct rf_place_edges *place, struct refocus_depth_edges_report *report);

#endif
