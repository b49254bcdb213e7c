/* yuv.h: converts between codes of Y, U, V and the values that are averaged.
 *
 * g is the curve of the blend, R', G', B' the colour of a pixel as usual, each clipped to black
 * and white. Samples of chroma are shared by 2 x 2 or 2 x 1 pixels: with Y' the luma of the
 * mean light g(Y) of these pixels,
 *
 *     B' = Y' + 2 (1 - Kb) U,  R' = Y' + 2 (1 - Kr) V,  G' = (Y' - Kr R' - Kb B') / Kg
 *     E  = Kr g(R') + Kg g(G') + Kb g(B') - g(Y')
 *
 * E is the light that a colour has more than the grey of its luma. Averaged are
 *
 *     luma     L   = g(Y) + E           of each pixel: its luminance
 *     chroma   D_b = g(B') - g(Y') - E  of each sample: what blue and red differ from it
 *              D_r = g(R') - g(Y') - E
 *
 * and of their means, with L' the mean of those of the pixels that share a sample,
 *
 *     B' = g^-1(L' + D_b),  R' = g^-1(L' + D_r),  G' = g^-1(L' - (Kr D_r + Kb D_b) / Kg)
 *     Y' = Kr R' + Kg G' + Kb B',  E = L' - g(Y')
 *     Y = g^-1(L - E),  U = (B' - Y') / 2 (1 - Kb),  V = (R' - Y') / 2 (1 - Kr)
 *
 * So light mixes as light, grey stays grey exactly, and of a picture in which neighbours are
 * alike the result is that of R, G, B. Without E, saturated colours mix too dark. A mean that
 * equals what the pixel itself was given is written as the code that it came from.
 */
#ifndef RF_YUV_H
#define RF_YUV_H

#include <stdint.h>

#include "colour/transfer.h"

enum {
    RF_TONES = 4 * 255 + 1, /* Y', R', G', B' in quarters of a full-range code */
    RF_CHROMA_ZERO = 4096,  /* D = 0 is stored so */
    RF_CHROMA_MAX = RF_CHROMA_ZERO + RF_LIGHT_MAX,
    RF_SHARE = 1 << 14, /* one, in Kr, Kg and Kb */
};

struct rf_yuv_curve {
    int16_t luma[256]; /* tone of a code of Y */
    uint16_t light_of_luma[256];
    int32_t tones_per_code[2];            /* B' - Y' for U, R' - Y' for V, Q12 */
    int32_t green_per_code[2];            /* how much they subtract from G', Q12 */
    uint16_t light[RF_TONES];             /* Q12 */
    int16_t tone[(RF_MEAN_MAX >> 1) + 1]; /* tone of a Q13 mean */
    uint8_t to_code[RF_MEAN_MAX + 1];     /* Y of a Q14 mean */
    int32_t codes_per_tone[2];            /* U and V, Q16 */
    int32_t kr, kg, kb;                   /* in 1 / RF_SHARE; they add up to 1 */
    int32_t red, blue;                    /* Kr / Kg, Kb / Kg */
};

/* matrix: enum refocus_matrix; range: enum refocus_range; blend: enum refocus_blend. */
void rf_yuv_curve_init(struct rf_yuv_curve *curve, uint32_t matrix, uint32_t range, uint32_t blend);

/* Means in Q14, clipped to black and white. */
static inline int rf_clip_mean(int mean)
{
    return mean < 0 ? 0 : mean > RF_MEAN_MAX ? RF_MEAN_MAX : mean;
}

static inline int rf_clip_tone(int tone)
{
    return tone < 0 ? 0 : tone > RF_TONES - 1 ? RF_TONES - 1 : tone;
}

/* B' - Y' of a code of U (i = 0), R' - Y' of one of V (1); Y' - G'. In tones. */
static inline int rf_more(const struct rf_yuv_curve *curve, int i, int code)
{
    return ((code - 128) * curve->tones_per_code[i] + 2048) >> 12;
}

static inline int rf_less_green(const struct rf_yuv_curve *curve, int u, int v)
{
    return ((u - 128) * curve->green_per_code[0] + (v - 128) * curve->green_per_code[1] + 2048) >>
           12;
}

/* The averaged values of a sample of chroma. */
struct rf_chroma {
    uint16_t blue, red; /* D + RF_CHROMA_ZERO, Q12 */
    int16_t excess;     /* E */
};

/* Makes them from the mean light of its pixels, Q12, and its codes. */
static inline struct rf_chroma rf_chroma_of(const struct rf_yuv_curve *curve, int light, int u,
                                            int v)
{
    const int tone = curve->tone[2 * light], own = curve->light[tone];
    const int blue = curve->light[rf_clip_tone(tone + rf_more(curve, 0, u))];
    const int red = curve->light[rf_clip_tone(tone + rf_more(curve, 1, v))];
    const int green = curve->light[rf_clip_tone(tone - rf_less_green(curve, u, v))];
    const int all =
        (curve->kr * red + curve->kg * green + curve->kb * blue + RF_SHARE / 2) / RF_SHARE;

    return (struct rf_chroma){(uint16_t)(RF_CHROMA_ZERO + blue - all),
                              (uint16_t)(RF_CHROMA_ZERO + red - all), (int16_t)(all - own)};
}

/* The luminance L of a pixel. */
static inline uint16_t rf_luminance(int light, int excess)
{
    const int sum = light + excess;

    return (uint16_t)(sum < 0 ? 0 : sum > RF_LIGHT_MAX ? RF_LIGHT_MAX : sum);
}

/* The codes that means of a sample of chroma come to. */
struct rf_chroma_code {
    uint8_t u, v;
    int excess; /* E, Q14 */
};

/* Makes them from L' and from the means of D_b and D_r as they are stored, all Q14. */
static inline struct rf_chroma_code rf_chroma_code(const struct rf_yuv_curve *curve, int light,
                                                   int blue, int red)
{
    const int db = blue - 4 * RF_CHROMA_ZERO, dr = red - 4 * RF_CHROMA_ZERO;
    const int dg = -(curve->red * dr + curve->blue * db) / RF_SHARE;
    const int b = curve->tone[rf_clip_mean(light + db) >> 1];
    const int r = curve->tone[rf_clip_mean(light + dr) >> 1];
    const int g = curve->tone[rf_clip_mean(light + dg) >> 1];
    const int y = (curve->kr * r + curve->kg * g + curve->kb * b + RF_SHARE / 2) / RF_SHARE;
    const int u = 128 + (((b - y) * curve->codes_per_tone[0] + (1 << 15)) >> 16);
    const int v = 128 + (((r - y) * curve->codes_per_tone[1] + (1 << 15)) >> 16);

    return (struct rf_chroma_code){(uint8_t)(u < 0     ? 0
                                             : u > 255 ? 255
                                                       : u),
                                   (uint8_t)(v < 0     ? 0
                                             : v > 255 ? 255
                                                       : v),
                                   light - 4 * curve->light[y]};
}

#endif
