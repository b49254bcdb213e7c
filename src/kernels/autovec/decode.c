/* decode.c: converts the means of a tile of luma and chroma to codes of Y, U and V. */
#include "kernels/kernels.h"
#include "kernels/autovec/yuv_pairs.h"

#include <string.h>

enum { PAIRS = RF_TILE / 2, SAMPLES = RF_TILE * PAIRS };

static inline int32_t first(uint32_t pair)
{
    return (int32_t)(pair >> FIRST16 & 0xffff);
}

static inline int32_t second(uint32_t pair)
{
    return (int32_t)(pair >> SECOND16 & 0xffff);
}

static inline uint16_t white_at_most(uint16_t mean)
{
    return mean < RF_MEAN_MAX ? mean : RF_MEAN_MAX;
}

/* L' of each sample; means are at most RF_MEAN_MAX, so two of them fit 16 bits. */
static RF_ALWAYS_INLINE void mean_light(int32_t *restrict light, const uint16_t *restrict luma,
                                        int down)
{
    for (int y = 0; y < RF_TILE; y += 1 << down) {
        const uint16_t *a = luma + y * RF_TILE, *b = a + down * RF_TILE;
        uint16_t both[RF_TILE];
        uint32_t pair[PAIRS];

        for (int x = 0; x < RF_TILE; x++)
            both[x] = (uint16_t)(a[x] + b[x]);
        memcpy(pair, both, sizeof pair);
        for (int x = 0; x < PAIRS; x++)
            light[x] = (sum_of(pair[x]) + 2) >> 2;
        light += PAIRS;
    }
}

/* rf_chroma_code() of n samples, a multiple of 4; of the excess, pairs of the same. */
static RF_ALWAYS_INLINE void decode_chroma(uint16_t *restrict uv, uint32_t *restrict excess,
                                           const int32_t *restrict light,
                                           const uint32_t *restrict chroma,
                                           const struct rf_yuv_curve *restrict curve, int n)
{
    const int32_t red = curve->red, blue = curve->blue;
    const int32_t kr = curve->kr, kg = curve->kg, kb = curve->kb;
    const int32_t per_u = curve->codes_per_tone[0], per_v = curve->codes_per_tone[1];
    int32_t r[SAMPLES], g[SAMPLES], b[SAMPLES], own[SAMPLES];

    for (int i = 0; i < n; i++) {
        const int32_t db = first(chroma[i]) - 4 * RF_CHROMA_ZERO;
        const int32_t dr = second(chroma[i]) - 4 * RF_CHROMA_ZERO;

        b[i] = rf_clip_mean(light[i] + db) >> 1;
        r[i] = rf_clip_mean(light[i] + dr) >> 1;
        g[i] = rf_clip_mean(light[i] - (red * dr + blue * db) / RF_SHARE) >> 1;
    }
    look_up(b, curve->tone, n);
    look_up(r, curve->tone, n);
    look_up(g, curve->tone, n);
    for (int i = 0; i < n; i++) {
        const int32_t y = (kr * r[i] + kg * g[i] + kb * b[i] + RF_SHARE / 2) >> 14;
        const int32_t u = 128 + (((b[i] - y) * per_u + (1 << 15)) >> 16);
        const int32_t v = 128 + (((r[i] - y) * per_v + (1 << 15)) >> 16);

        own[i] = y;
        uv[i] = (uint16_t)((u < 0     ? 0
                            : u > 255 ? 255
                                      : u)
                               << FIRST8 |
                           (v < 0     ? 0
                            : v > 255 ? 255
                                      : v)
                               << SECOND8);
    }
    look_up(own, (const int16_t *)curve->light, n);
    for (int i = 0; i < n; i++) {
        const int32_t e = light[i] - 4 * own[i];

        excess[i] = pair_of(e, e);
    }
}

/* L - E lies within -RF_MEAN_MAX .. 2 RF_MEAN_MAX. */
static RF_ALWAYS_INLINE void decode_luma(uint8_t *restrict y, const uint16_t *restrict luma,
                                         const uint32_t *restrict excess,
                                         const uint8_t *restrict to_code, int down)
{
    uint16_t at[RF_TILE * RF_TILE];

    for (int i = 0; i < RF_TILE; i++) {
        const uint16_t *restrict in = luma + i * RF_TILE;
        uint16_t *restrict out = at + i * RF_TILE;
        int16_t e[RF_TILE];

        memcpy(e, excess + (i >> down) * PAIRS, sizeof e);
        for (int x = 0; x < RF_TILE; x++) {
            const int16_t v = (int16_t)(in[x] - (uint16_t)e[x]);
            const int16_t above = v > 0 ? v : 0;

            out[x] = (uint16_t)(above < RF_MEAN_MAX ? above : RF_MEAN_MAX);
        }
    }
    UNROLLED
    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        y[i] = to_code[at[i]];
}

/* Where rows of a tile are not 4 times what they were: not 0. */
static RF_ALWAYS_INLINE void differences(uint16_t *restrict differs, const uint16_t *restrict mean,
                                         const uint16_t *own, ptrdiff_t stride, int rows)
{
    for (int i = 0; i < rows * RF_TILE; i += RF_TILE, own += stride)
        for (int x = 0; x < RF_TILE; x++)
            differs[i + x] = (uint16_t)(mean[i + x] - (uint16_t)(4 * own[x]));
}

static RF_ALWAYS_INLINE void choose(uint8_t *restrict to, const uint16_t *restrict differs,
                                    const uint8_t *restrict code, int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t keep = (uint8_t)(differs[i] == 0 ? 0xff : 0);

        to[i] = (uint8_t)((to[i] & keep) | (code[i] & ~keep));
    }
}

/* All bits of a pair, if any. */
static RF_ALWAYS_INLINE void widen(uint32_t *pair, int n)
{
    for (int i = 0; i < n; i++)
        pair[i] = pair[i] ? 0xffffffff : 0;
}

/* Codes in place of those that are not to be kept. */
static RF_ALWAYS_INLINE void put_codes(struct rf_decode_job *job, const uint8_t *y,
                                       const uint8_t *uv, const int down)
{
    const int rows = RF_TILE >> down, n = rows * RF_TILE;
    uint16_t luma[RF_TILE * RF_TILE], chroma[RF_TILE * RF_TILE];
    uint32_t of_pixels[SAMPLES], of_samples[SAMPLES], wide[SAMPLES], any[SAMPLES];

    differences(luma, job->luma, job->own_luma, job->stride, RF_TILE);
    differences(chroma, job->chroma, job->own_chroma, job->stride, rows);
    memcpy(of_pixels, luma, sizeof luma);
    memcpy(of_samples, chroma, (size_t)n * sizeof chroma[0]);
    widen(of_samples, n / 2);
    for (int i = 0; i < RF_TILE; i++) /* a pair of columns is as wide as two values */
        memcpy(wide + i * PAIRS, of_samples + (i >> down) * PAIRS, PAIRS * sizeof wide[0]);
    for (int i = 0; i < SAMPLES; i++)
        of_pixels[i] |= wide[i];
    for (int c = 0; c < rows; c++) {
        const uint32_t *restrict upper = of_pixels + (c << down) * PAIRS;
        const uint32_t *restrict lower = upper + down * PAIRS;
        uint32_t *restrict out = any + c * PAIRS;

        for (int x = 0; x < PAIRS; x++)
            out[x] = upper[x] | lower[x];
    }
    widen(any, n / 2);
    memcpy(luma, of_pixels, sizeof luma);
    memcpy(chroma, any, (size_t)n * sizeof chroma[0]);
    choose(job->y, luma, y, RF_TILE * RF_TILE);
    choose(job->uv, chroma, uv, n);
}

static RF_ALWAYS_INLINE void decode(struct rf_decode_job *job, const int down)
{
    const int samples = SAMPLES >> down;
    uint8_t y[RF_TILE * RF_TILE], uv[RF_TILE * RF_TILE];
    uint16_t luma[RF_TILE * RF_TILE], uv_pair[SAMPLES];
    uint32_t excess[SAMPLES], chroma[SAMPLES];
    int32_t light[SAMPLES];

    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        luma[i] = white_at_most(job->luma[i]);
    memcpy(chroma, job->chroma, (size_t)samples * sizeof chroma[0]);
    mean_light(light, luma, down);
    decode_chroma(uv_pair, excess, light, chroma, job->curve, samples);
    memcpy(uv, uv_pair, (size_t)samples * sizeof uv_pair[0]);
    decode_luma(y, luma, excess, job->curve->to_code, down);
    put_codes(job, y, uv, down);
}

void RF_VEC(rf_decode)(struct rf_decode_job *job)
{
    if (job->down)
        decode(job, 1);
    else
        decode(job, 0);
}
