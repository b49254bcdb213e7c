/* pyramid.h: the levels of the push-pull pyramid that inpaints the hidden background. */
#ifndef RF_PYRAMID_H
#define RF_PYRAMID_H

#include <stddef.h>
#include <stdint.h>

enum { RF_LEVELS = 18 }; /* level 0, the picture itself, is not counted */

/* A level of the background pyramid, without padding but with an even stride. */
struct rf_level {
    int width, height;
    ptrdiff_t stride;
    uint16_t *light[3];
    int16_t *blur; /* RF_NO_BLUR: nothing known here */
};

#endif
