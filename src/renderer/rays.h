#ifndef RF_RAYS_H
#define RF_RAYS_H

#include "renderer/renderer.h"

/* Fill r->set for an aperture and a number of rays, with denser sets for highlights; K
 * matters for REFOCUS_RAYS_FULL. */
void rf_make_rays(struct refocus_renderer *r, const struct refocus_aperture *aperture,
                  int rays, bool denser, float max_blur_radius);

#endif
