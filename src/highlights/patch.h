/* patch.h: changes the circle of confusion of single pixels after their tiles are classified. */
#ifndef RF_HIGHLIGHTS_PATCH_H
#define RF_HIGHLIGHTS_PATCH_H

#include "highlights/highlights.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

/* Sets a pixel's blur, in its plane and in the bins and the cell that it is in. */
static inline void rf_set_blur(const struct rf_blur_patch *patch, int x, int y, int16_t blur)
{
    patch->blur.at[y * patch->blur.stride + x] = blur;
    rf_add_bin(patch->view, patch->bins, patch->scale, x, y, blur);
    rf_add_to_cell(patch->cells, x, y, blur);
}

#endif
