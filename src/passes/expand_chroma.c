/* expand_chroma.c: gives each pixel of a photo of Y, U and V the chroma of its sample. */
#include "passes/expand_chroma.h"

#include "image/border.h"

/* Expands a row of n samples. Values of a sample are read before the same place of `blue`, which
 * may be where they lie, is written. */
static void expand(uint16_t *blue, uint16_t *restrict red, const uint16_t *sample, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t b = sample[2 * x], r = sample[2 * x + 1];

        blue[2 * x] = blue[2 * x + 1] = b;
        red[2 * x] = red[2 * x + 1] = r;
    }
}

/* Works from the last row up, as a row of samples lies no lower than its pixels. */
void rf_expand_chroma_rows(const struct rf_viewport *view, const struct rf_chroma_size *size,
                           struct rf_chroma_q12 samples, struct rf_light_q12 out, int y0, int y1)
{
    for (int y = y1 - 1; y >= y0; y--)
        expand(out.channel[1] + y * out.stride, out.channel[2] + y * out.stride,
               samples.at + (y >> size->down) * samples.stride, size->width);
    for (int c = 1; c < 3; c++)
        rf_extend_rows(view, out.channel[c], out.stride, y0, y1);
}
