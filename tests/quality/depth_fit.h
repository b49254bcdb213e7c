/* depth_fit.h: how well the edges and surfaces of a map of disparities fit the exact ones. */
#ifndef QUALITY_DEPTH_FIT_H
#define QUALITY_DEPTH_FIT_H

#include <stdint.h>

#include "scene.h"

struct depth_fit {
    double hit, stray;     /* shares: true edges found within 1 px, found ones that are true */
    double smooth, beside; /* mean |error| more than 4 px from an edge, and up to there */
};

/* @known is 0 where the scene's disparity is not known: no edge lies there, and no error is
 * counted there nor within 4 px; NULL = all of it is known. Returns 0, or -1 without memory. */
int depth_fit(const struct quality_scene *scene, const uint8_t *known, const uint16_t *d,
              struct depth_fit *fit);

#endif
