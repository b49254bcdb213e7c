/* planes.h: the passes that turn a photo and a lens setting into planes.
 *
 * Each works on rows y0 <= y < y1 and may run for several bands of rows at once.
 */
#ifndef RF_PASSES_PLANES_H
#define RF_PASSES_PLANES_H

#include "focus/focus.h"
#include "image/border.h"
#include "renderer/renderer.h"

/* Photo rows to light planes and alpha. */
void rf_convert_rows(struct refocus_renderer *r, const struct refocus_image *photo, int y0, int y1);

/* Change light planes from one blend to another. */
void rf_reblend_rows(struct refocus_renderer *r, uint32_t from, uint32_t to, int y0, int y1);

/* Rows y0 to y1 - 1 of a map, as Q16, to a plane. */
void rf_disparity_rows(uint16_t *disparity, ptrdiff_t stride, const struct refocus_disparity *map,
                       int y0, int y1);

/* Signed blur, eq. 4 or what the plan makes of it, and its border. */
void rf_signed_blur_rows(struct refocus_renderer *r, const struct rf_focus_plan *plan, int y0,
                         int y1);

/*
 * Step 0, 1 or 2 of the pre-filter for a row of tiles, whose bins are known: where |s|
 * is above above[step] (Q7.8), from three rows, then from three columns, 2^step pixels
 * apart, a third of the way to those pixels that are within an eighth of its blur (one
 * pixel to two) of the middle one; the light as it is elsewhere. Borders are extended. Step 2
 * writes what step 1 read, and leaves out what did not change.
 *
 * Rays of a set of N meet the picture |s| sqrt(pi / N) pixels apart. Step 0 closes gaps
 * from 1.5 pixels on; the next close those twice and four times as wide.
 *
 * If it fades, a step comes in over rf_prefilter_over() more of |s|, so that nothing jumps while
 * the focus moves.
 */
void rf_prefilter_rows(struct refocus_renderer *r, uint16_t *const out[3], uint16_t *const in[3],
                       const int above[RF_PREFILTER_STEPS], bool fades, int step, int ty);

static inline int rf_prefilter_over(int above, bool fades)
{
    return fades && above >= 8 ? above / 4 : 1;
}

/* What a step does with a tile. */
enum rf_task { RF_SKIP, RF_COPY, RF_FILTER };
enum rf_task rf_prefilter_task(const struct refocus_renderer *r, const int above[], int step,
                               int tx, int ty);

/* Weights of eq. 5 of the pixels that rays meet, borders too: of smooth into r->weight.at, of the
 * background over its blur. */
void rf_weigh_rows(struct refocus_renderer *r, int ty);

/* The same as kernels.h, weigh, has it: their light is times the weight then. Notes the
 * brightest of each tile. */
void rf_premultiply_rows(struct refocus_renderer *r, uint16_t *scratch, int ty);

#endif
