/* load.h: takes a photo and its disparities into the planes of the window. */
#ifndef RF_LOAD_H
#define RF_LOAD_H

#include "renderer/renderer.h"

/* Writes light in the blend r->blend, and alpha. `photo` is of the window's size. `guide`: of a
 * photo of Y, U and V, NULL or its picture in RGB8 is wanted there. */
void rf_load_light(struct refocus_renderer *r, const struct refocus_image *photo,
                   const struct refocus_image *guide);

/* The same pass for rows of a photo of Y, U and V whose codes are there. */
void rf_reload_yuv_rows(struct refocus_renderer *r, int y0, int y1, int worker);

/* Writes disparities, and of a map with few codes slopes in place of its steps: `step` is its
 * rf_code_step(). The map is of the window's size. In strip mode it is larger by what the slopes
 * depend on: it begins at (-left, -above) of the window, up to RF_DEQUANTISE_REACH pixels. */
void rf_load_disparity(struct refocus_renderer *r, const struct refocus_disparity *map, int step,
                       int left, int above);

/* Strip mode: finds the silhouettes of the photo, block by block. */
void rf_find_silhouettes_in_blocks(struct refocus_renderer *r);

#endif
