/* guide.c: converts codes of Y, U and V to R, G and B, for those who compare colours. */
#include "kernels/kernels.h"
#include "kernels/autovec/yuv_pairs.h"

#include <string.h>

enum { RUN = 64 }; /* samples of chroma that are worked on together */

/* Tones of the pixels of a run. */
static RF_ALWAYS_INLINE void tones_of(int16_t *restrict tone, const uint8_t *restrict luma,
                                      const int16_t *restrict tone_of_luma)
{
    int32_t at[2 * RUN];

    for (int i = 0; i < 2 * RUN; i++)
        at[i] = luma[i];
    look_up(at, tone_of_luma, 2 * RUN);
    for (int i = 0; i < 2 * RUN; i++)
        tone[i] = (int16_t)at[i];
}

/* R', G' and B' less Y', which both pixels of a sample share. */
static void chroma_of(int16_t more[3][2 * RUN], const uint16_t *restrict uv,
                      const struct rf_yuv_curve *restrict curve)
{
    const int32_t per_u = curve->tones_per_code[0], per_v = curve->tones_per_code[1];
    const int32_t green_u = curve->green_per_code[0], green_v = curve->green_per_code[1];
    uint32_t red[RUN], green[RUN], blue[RUN];

    for (int i = 0; i < RUN; i++) {
        const int32_t u = (uv[i] >> FIRST8 & 255) - 128, v = (uv[i] >> SECOND8 & 255) - 128;
        const int32_t r = (v * per_v + 2048) >> 12, b = (u * per_u + 2048) >> 12;
        const int32_t g = -((u * green_u + v * green_v + 2048) >> 12);

        red[i] = pair_of(r, r);
        green[i] = pair_of(g, g);
        blue[i] = pair_of(b, b);
    }
    memcpy(more[0], red, sizeof red);
    memcpy(more[1], green, sizeof green);
    memcpy(more[2], blue, sizeof blue);
}

static RF_ALWAYS_INLINE void codes_of(uint8_t *restrict code, const int16_t *restrict tone,
                                      const int16_t *restrict more)
{
    for (int i = 0; i < 2 * RUN; i++) {
        const int16_t sum = (int16_t)(tone[i] + more[i]);
        const int16_t above = sum > 0 ? sum : 0;

        code[i] = (uint8_t)((uint16_t)((above < RF_TONES - 1 ? above : RF_TONES - 1) + 2) >> 2);
    }
}

static RF_ALWAYS_INLINE void interleave(uint8_t *restrict rgb, const uint8_t *restrict r,
                                        const uint8_t *restrict g, const uint8_t *restrict b, int n)
{
    for (int i = 0; i < n; i++) {
        rgb[3 * i] = r[i];
        rgb[3 * i + 1] = g[i];
        rgb[3 * i + 2] = b[i];
    }
}

void RF_VEC(rf_guide)(uint8_t *rgb, const uint8_t *luma, const uint8_t *uv,
                      const struct rf_yuv_curve *curve, int n)
{
    uint8_t codes[2 * RUN] = {0}, code[3][2 * RUN];
    int16_t tone[2 * RUN], more[3][2 * RUN];
    uint16_t pair[RUN] = {0};

    for (int x = 0; x < n; x += 2 * RUN) {
        const int run = n - x < 2 * RUN ? n - x : 2 * RUN;

        if (run == 2 * RUN) {
            memcpy(codes, luma + x, sizeof codes);
            memcpy(pair, uv + x, sizeof pair);
        } else {
            memcpy(codes, luma + x, (size_t)run);
            memcpy(pair, uv + x, (size_t)run + run % 2);
        }
        tones_of(tone, codes, curve->luma);
        chroma_of(more, pair, curve);
        for (int c = 0; c < 3; c++)
            codes_of(code[c], tone, more[c]);
        interleave(rgb + 3 * (ptrdiff_t)x, code[0], code[1], code[2], run);
    }
}
