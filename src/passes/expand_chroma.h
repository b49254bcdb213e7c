/* expand_chroma.h: gives each pixel of a photo of Y, U and V the chroma of its sample.
 *
 * The search follows each ray once and adds up three planes at the pixel that it hits: red, green
 * and blue, or luminance, D_b and D_r (image/chroma.h), for which each pixel needs its own. */
#ifndef RF_EXPAND_CHROMA_H
#define RF_EXPAND_CHROMA_H

#include "image/chroma.h"
#include "image/planes.h"
#include "image/viewport.h"

/* Writes D_b to channel 1 and D_r to channel 2 of `out`, borders too, of rows y0 to y1 - 1. The
 * samples may lie in channel 1 itself, where all rows have to be written by one call. */
void rf_expand_chroma_rows(const struct rf_viewport *view, const struct rf_chroma_size *size,
                           struct rf_chroma_q12 samples, struct rf_light_q12 out, int y0, int y1);

#endif
