#ifndef RF_RAYS_H
#define RF_RAYS_H

#include "renderer/renderer.h"

/* Fill r->set for an aperture and a number of rays, with denser sets for highlights; K
 * matters for REFOCUS_RAYS_FULL. */
void rf_make_rays(struct refocus_renderer *r, const struct refocus_aperture *aperture, int rays,
                  bool denser, float max_blur_radius);

/* Rays of chroma, whose samples lie two pixels apart, for so many of luma: all of a few. */
static inline int rf_chroma_rays(int rays)
{
    return rays < 48 ? rays : rays / 2;
}

#endif
