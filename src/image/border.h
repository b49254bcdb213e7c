/* border.h: fills the border of padded planes with their outermost pixels. */
#ifndef RF_BORDER_H
#define RF_BORDER_H

#include "image/chroma.h"
#include "image/viewport.h"

/* Repeats the first and the last pixel of rows y0 <= y < y1 of a padded plane of 16-bit elements
 * over view->border, and with row 0 and the last row the rows beyond. Reads and writes these rows
 * alone, so that bands may run at once. */
void rf_extend_rows(const struct rf_viewport *view, void *plane, ptrdiff_t stride, int y0, int y1);

/* Does the same with rows c0 <= y < c1 of a plane of chroma, of its light or its blur. */
void rf_extend_chroma(const struct rf_viewport *view, const struct rf_chroma_size *size,
                      void *plane, ptrdiff_t stride, int c0, int c1);

#endif
