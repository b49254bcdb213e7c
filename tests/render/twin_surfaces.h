/* twin_surfaces.h: the level surfaces of a twin's noisy map. See src/tiles/surfaces.h. */
#ifndef RENDER_TWIN_SURFACES_H
#define RENDER_TWIN_SURFACES_H

#include "twin_slabs.h"

struct twin_surface {
    int first, end;
    double middle, noise; /* pixels */
    bool own;
};

struct twin_surfaces {
    int count;
    struct twin_surface at[9];
};

/* Bins that are occupied in reach of a tile, and in tiles without noise; the width of a bin, and
 * how wide a slab may be, pixels. */
struct twin_reach {
    const bool *has, *sure;
    double width, widest;
};

/* Whether tile (tx, ty) of so much noise, whose blurs are so far apart, is level; then its mean. */
bool twin_is_level(const struct twin *t, int tx, int ty, double noise, double spread,
                   double *middle);

/* Inserts a surface by its mean. */
void twin_insert_surface(struct twin_surfaces *surfaces, const struct twin_surface *surface);

/* Joins surfaces that are close, and sets their bins. */
void twin_settle_surfaces(struct twin_surfaces *surfaces, const struct twin_reach *reach);

#endif
