#ifndef RF_LAYOUT_H
#define RF_LAYOUT_H

#include "renderer/renderer.h"

int rf_padding_for(float max_blur_radius);
ptrdiff_t rf_pitch_for(int width, int pad);

/* Strip mode: rows above and below a window that may be read, though nothing is in
 * them; and the most pixels on a side of a window and its border, which ends where the
 * margin would. */
enum { RF_SPARE_ROWS = 8 }; /* as many as RF_DEQUANTISE_REACH at least */
static inline int rf_block_side(const struct rf_in_place *in_place)
{
    return in_place->block + 2 * in_place->margin;
}

/* Bytes of a renderer; UINT64_MAX: too many to address. */
uint64_t rf_layout_size(const struct refocus_renderer_params *params);

/* A renderer in a block of that size, its pointers set and all else 0. */
struct refocus_renderer *rf_layout_place(const struct refocus_renderer_params *params, void *block);

#endif
