/* load.h: loads a photo and its disparities into the planes of the window. */
#ifndef RF_LOAD_H
#define RF_LOAD_H

#include "renderer/renderer.h"

/* Writes light in the blend r->blend, and alpha. `photo` has the size of the window. `guide` may be
 * NULL; else a photo of Y, U and V is written there in RGB8. */
void rf_load_light(struct refocus_renderer *r, const struct refocus_image *photo,
                   const struct refocus_image *guide);

/* Repeats this for rows of a photo of Y, U and V whose codes are there, in another blend. */
void rf_reload_yuv_rows(struct refocus_renderer *r, int y0, int y1, int worker);

/* Writes disparities, and for a map with few codes slopes in place of its steps: `step` is its
 * rf_code_step(). The map has the size of the window. In strip mode it is larger by the pixels that
 * the slopes depend on: it begins at (-left, -above) of the window, up to RF_DEQUANTISE_REACH
 * pixels. */
void rf_load_disparity(struct refocus_renderer *r, const struct refocus_disparity *map, int step,
                       int left, int above);

/* Strip mode: finds the silhouettes of the photo, block by block. */
void rf_find_silhouettes_in_blocks(struct refocus_renderer *r);

#endif
