/* rims.h: the rim of something bright belongs to it.
 *
 * The pixels at the edge of an object are mixtures of it and of what is behind it.
 * Where the object is bright enough to be clipped, they are nearly as bright as it is,
 * but half of them have the depth of what is behind: blurred, they would draw a halo
 * around the sharp object. For a pixel p beside a clipped one N that is nearer, with F
 * the mean light of the pixels of p's depth two away,
 *
 *     alpha = (p - F) . (N - F) / |N - F|^2
 *
 * tells how much of N it holds. Above 0.6, p is rendered at the depth of N, of several
 * the nearest.
 */
#ifndef RF_RIMS_H
#define RF_RIMS_H

#include <stdint.h>

struct refocus_renderer;
struct rf_rect;
struct rf_focus_plan;
struct rf_bin_scale;

struct rf_rim {
    uint16_t x, y;
    uint16_t disparity; /* of the bright pixel beside it */
};

/* Most rims of a picture; further ones, row by row, stay as they are. */
static inline uint64_t rf_rim_capacity(int width, int height)
{
    return (uint64_t)width * height / 64 + 64;
}

/* Add to the rims of the photo in use those of the bright pixels in a part of the
 * window, in linear light. Pixels three away from the part are looked at. */
void rf_find_rims(struct refocus_renderer *r, struct rf_rect part);

/* Put those in the window into r->front.blur and r->bins. */
void rf_patch_rims(struct refocus_renderer *r, const struct rf_focus_plan *plan,
                   struct rf_bin_scale scale);

#endif
