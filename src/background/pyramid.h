/* pyramid.h: the levels of the push-pull pyramid that inpaints the hidden background. */
#ifndef RF_PYRAMID_H
#define RF_PYRAMID_H

#include "image/planes.h"

enum { RF_LEVELS = 18 }; /* levels of the largest picture, without level 0 */

/* A level, its blur RF_NO_BLUR where nothing is known. Levels from 1 on have an even stride and no
 * padding, but a column more if their width is odd. */
struct rf_level {
    int width, height;
    struct rf_light_q12 light;
    struct rf_blur_q8 blur;
};

enum { RF_NEVER_APART = INT16_MAX };

/* Level 0 is the background of the window itself; a pixel of the next one is 2 x 2 pixels. */
struct rf_pyramid {
    int16_t apart; /* blurs that differ by more are two layers, and light of the nearer one does not
                      count: by rf_layers_apart(), or RF_NEVER_APART */
    int levels;    /* the last one, of one pixel; 0: the picture has one pixel */
    struct rf_level level[RF_LEVELS + 1];
};

/* Sets sizes and strides for a picture of this size, and neither the memory of any level nor the
 * strides of level 0. */
void rf_pyramid_shape(struct rf_pyramid *pyramid, int width, int height);

#endif
