/* guide.h: turns a photo of Y, U and V into R, G and B that guide where edges of its
 * depth are placed: exact enough to tell one surface from another, not to be shown. */
#ifndef RF_GUIDE_H
#define RF_GUIDE_H

#include <stdint.h>

#include "colour/yuv.h"

/* A row of pixels: codes of Y lie y_step apart, and those of U and of V, each for two pixels,
 * chroma_step. */
struct rf_yuv_row {
    const uint8_t *y, *u, *v;
    int y_step, chroma_step;
};

static inline uint8_t rf_code_of_tone(int tone)
{
    return (uint8_t)((rf_clip_tone(tone) + 2) / 4);
}

/* Writes `width` pixels in RGB8. */
static inline void rf_guide_row(const struct rf_yuv_curve *curve, uint8_t *out,
                                const struct rf_yuv_row *row, int width)
{
    for (int x = 0; x < width; x++, out += 3) {
        const int tone = curve->luma[row->y[x * row->y_step]];
        const int u = row->u[x / 2 * row->chroma_step], v = row->v[x / 2 * row->chroma_step];

        out[0] = rf_code_of_tone(tone + rf_more(curve, 1, v));
        out[1] = rf_code_of_tone(tone - rf_less_green(curve, u, v));
        out[2] = rf_code_of_tone(tone + rf_more(curve, 0, u));
    }
}

#endif
