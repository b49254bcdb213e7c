/* mixed_pixels.h: gives the mixed pixels along silhouettes to the nearer surface. */
#ifndef RF_DEPTH_MIXED_PIXELS_H
#define RF_DEPTH_MIXED_PIXELS_H

#include <refocus/image.h>

#include "depth/upsample.h"
#include "image/planes.h"
#include "support/pool.h"

/* All planes have the photo's size. */
struct rf_mixed_pixels {
    const struct refocus_image *photo; /* packed */
    struct rf_disparity_q16 map;       /* replaced by the result */
    struct rf_disparity_q16 nearer;    /* memory to work in */
    struct rf_bytes run;               /* memory to work in */
    bool still;                        /* no frame of a video */
};

/*
 * Is to be called on a map whose edges lie on the photo's. Of a run that is cancelled the result is
 * of no use.
 */
void rf_claim_mixed_pixels(const struct rf_mixed_pixels *mixed, struct rf_pool *pool);

#endif
