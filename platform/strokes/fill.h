/* fill.h: the disparities that a layer is filled with. */
#ifndef RF_STROKES_FILL_H
#define RF_STROKES_FILL_H

#include <stdint.h>
#include <refocus/platform/strokes.h>

/* Fill the pixels of a row from one column to before another. */
void rf_fill_span(const struct refocus_fill *fill, uint16_t *row, int32_t y, int32_t from,
                  int32_t to);

#endif
