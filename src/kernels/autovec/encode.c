/* encode.c: converts codes of Y, U and V to luma and chroma that can be averaged. */
#include "kernels/kernels.h"
#include "kernels/autovec/yuv_pairs.h"

#include <string.h>

enum { RUN = 128 }; /* samples that are worked on together */

/* Copies of a whole run are of a fixed size, which takes no call. */
static RF_ALWAYS_INLINE void copy_run(void *restrict to, const void *restrict from, int run,
                                      const int bytes)
{
    if (run == RUN)
        memcpy(to, from, (size_t)bytes * RUN);
    else
        memcpy(to, from, (size_t)bytes * (size_t)run);
}

/* Light of the pixels of a run of samples. */
static RF_ALWAYS_INLINE void row_light(uint16_t *restrict light, const uint8_t *restrict luma,
                                       const uint16_t *restrict light_of_luma, int run)
{
    uint8_t codes[2 * RUN] = {0};
    int32_t at[2 * RUN];

    copy_run(codes, luma, run, 2);
    for (int i = 0; i < 2 * RUN; i++)
        at[i] = codes[i];
    look_up(at, (const int16_t *)light_of_luma, 2 * RUN);
    for (int i = 0; i < 2 * RUN; i++)
        light[i] = (uint16_t)at[i];
}

/* rf_chroma_of() of RUN samples; of the excess, pairs of the same. */
static void encode_chroma(uint32_t *restrict chroma, uint32_t *restrict excess,
                          const int32_t *restrict mean, const uint16_t *restrict uv,
                          const struct rf_yuv_curve *restrict curve)
{
    const int32_t kr = curve->kr, kg = curve->kg, kb = curve->kb;
    const int32_t per_u = curve->tones_per_code[0], per_v = curve->tones_per_code[1];
    const int32_t green_u = curve->green_per_code[0], green_v = curve->green_per_code[1];
    const int16_t *const light = (const int16_t *)curve->light;
    int32_t r[RUN], g[RUN], b[RUN], own[RUN];

    for (int i = 0; i < RUN; i++)
        own[i] = 2 * mean[i];
    look_up(own, curve->tone, RUN);
    for (int i = 0; i < RUN; i++) {
        const int32_t u = (uv[i] >> FIRST8 & 255) - 128, v = (uv[i] >> SECOND8 & 255) - 128;

        b[i] = rf_clip_tone(own[i] + ((u * per_u + 2048) >> 12));
        r[i] = rf_clip_tone(own[i] + ((v * per_v + 2048) >> 12));
        g[i] = rf_clip_tone(own[i] - ((u * green_u + v * green_v + 2048) >> 12));
    }
    look_up(b, light, RUN);
    look_up(r, light, RUN);
    look_up(g, light, RUN);
    look_up(own, light, RUN);
    for (int i = 0; i < RUN; i++) {
        const int32_t all = (kr * r[i] + kg * g[i] + kb * b[i] + RF_SHARE / 2) >> 14;

        chroma[i] = pair_of(RF_CHROMA_ZERO + b[i] - all, RF_CHROMA_ZERO + r[i] - all);
        excess[i] = pair_of(all - own[i], all - own[i]);
    }
}

/* rf_luminance(). */
static void add_excess(uint16_t *restrict out, const uint16_t *restrict light,
                       const uint32_t *restrict pairs, int n)
{
    int16_t excess[2 * RUN];

    memcpy(excess, pairs, sizeof excess);
    for (int i = 0; i < 2 * n; i++) {
        const int16_t v = (int16_t)(light[i] + (uint16_t)excess[i]);
        const int16_t above = v > 0 ? v : 0;

        out[i] = (uint16_t)(above < RF_LIGHT_MAX ? above : RF_LIGHT_MAX);
    }
}

void RF_VEC(rf_encode)(uint16_t *const out[2], uint16_t *chroma, const uint8_t *const luma[2],
                       const uint8_t *uv, const struct rf_yuv_curve *curve, int n)
{
    const bool two = out[1] != out[0];
    uint16_t light[2][2 * RUN] = {{0}}, uv_pair[RUN] = {0};
    uint32_t chroma_pair[RUN], excess[RUN], pair[2][RUN];
    int32_t mean[RUN];

    for (int next = 0; next < n; next += RUN) {
        /* the last samples of a long row with some before them, twice */
        const int at = next + RUN <= n || n < RUN ? next : n - RUN;
        const int run = n < RUN ? n : RUN;

        row_light(light[0], luma[0] + 2 * at, curve->light_of_luma, run);
        if (two)
            row_light(light[1], luma[1] + 2 * at, curve->light_of_luma, run);
        copy_run(uv_pair, uv + 2 * at, run, 2);
        memcpy(pair[0], light[0], sizeof pair[0]);
        memcpy(pair[1], light[two], sizeof pair[1]);
        for (int i = 0; i < RUN; i++)
            mean[i] = (sum_of(pair[0][i]) + sum_of(pair[1][i]) + 2) >> 2;
        encode_chroma(chroma_pair, excess, mean, uv_pair, curve);
        copy_run(chroma + 2 * at, chroma_pair, run, 4);
        add_excess(out[0] + 2 * at, light[0], excess, run);
        if (two)
            add_excess(out[1] + 2 * at, light[1], excess, run);
    }
}
