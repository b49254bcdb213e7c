/* layout.h: sizes of the memory of a renderer, and its layout in one block. */
#ifndef RF_LAYOUT_H
#define RF_LAYOUT_H

#include "renderer/renderer.h"

/* Strip mode: the rows above and below a window that may be read, though their content is not
 * valid; no fewer than RF_DEQUANTISE_REACH. */
enum { RF_SPARE_ROWS = 8 };

/* Strip mode: the most pixels on a side of a window and its border, which ends where the margin
 * would. */
static inline int rf_block_side(const struct rf_in_place *in_place)
{
    return in_place->block + 2 * in_place->margin;
}

/* The bytes of a renderer; UINT64_MAX if they are too many to address. */
uint64_t rf_layout_size(const struct refocus_renderer_params *params);

/* Makes a renderer in a block of that size, with its pointers set and all else 0. */
struct refocus_renderer *rf_layout_place(const struct refocus_renderer_params *params, void *block);

#endif
