#ifndef RF_PARAMS_H
#define RF_PARAMS_H

#include "renderer/renderer.h"

/* Whether all fields are in the ranges that refocus/render.h gives them, and the method one
 * that the renderer has memory for. */
bool rf_good_params(const struct refocus_renderer *r, const struct refocus_render_params *p);

#endif
