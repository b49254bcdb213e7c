/* coc.h: computes the circle of confusion of each pixel from its disparity.
 *
 *     s = K (df - d)                      Yang et al. 2016, eq. 4, with a sign
 *
 * or what a plan of tilts, bands and fields makes of it (focus/focus.h).
 */
#ifndef RF_COC_H
#define RF_COC_H

#include "focus/focus.h"
#include "image/chroma.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"

/* Writes the blur of rows y0 to y1 - 1, and its border. */
void rf_coc_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                 const struct rf_focus_plan *plan, struct rf_disparity_q16 disparity,
                 struct rf_blur_q8 blur, int y0, int y1);

/* Writes the blur of the samples of chroma of these rows, y0 even, and its border: that of the
 * sharpest pixel of each sample, so that no colour of what is in focus is smeared. */
void rf_coc_chroma_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                        const struct rf_chroma_size *size, struct rf_blur_q8 blur,
                        struct rf_blur_q8 chroma_blur, int y0, int y1);

#endif
