/* yuv_codes.c: codes of Y, U, V to luma and chroma and back, written as the loops of rows.c.
 *
 * What is a look-up stands in loops of its own, so that the rest can be done by vectors. The two
 * values of a sample of chroma, or those of two pixels, are taken as one of twice the width.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

#define ALWAYS_INLINE inline __attribute__((always_inline))

enum { PAIRS = RF_TILE / 2, SAMPLES = RF_TILE * PAIRS };

/* The first and the second in memory of a pair. */
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
enum { FIRST16 = 16, SECOND16 = 0, FIRST8 = 8, SECOND8 = 0 };
#else
enum { FIRST16 = 0, SECOND16 = 16, FIRST8 = 0, SECOND8 = 8 };
#endif

static inline int32_t first(uint32_t pair)
{
    return (int32_t)(pair >> FIRST16 & 0xffff);
}

static inline int32_t second(uint32_t pair)
{
    return (int32_t)(pair >> SECOND16 & 0xffff);
}

static inline uint32_t pair_of(int32_t a, int32_t b)
{
    return (uint32_t)(a & 0xffff) << FIRST16 | (uint32_t)(b & 0xffff) << SECOND16;
}

static inline int32_t sum_of(uint32_t pair)
{
    return (int32_t)((pair & 0xffff) + (pair >> 16));
}

/* Look-ups: what the compiler makes of them when it takes several together is slower. */
#if defined(__clang__)
#define UNROLLED _Pragma("unroll 8")
#else
#define UNROLLED _Pragma("GCC unroll 8")
#endif

/* n look-ups in place. */
static ALWAYS_INLINE void look_up(int32_t *restrict v, const int16_t *restrict table, int n)
{
    UNROLLED
    for (int i = 0; i < n; i++)
        v[i] = table[v[i]];
}

static inline uint16_t white_at_most(uint16_t mean)
{
    return mean < RF_MEAN_MAX ? mean : RF_MEAN_MAX;
}

/* L' of each sample; means are at most RF_MEAN_MAX, so two of them fit 16 bits. */
static ALWAYS_INLINE void mean_light(int32_t *restrict light, const uint16_t *restrict luma,
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
static ALWAYS_INLINE void decode_chroma(uint16_t *restrict uv, uint32_t *restrict excess,
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
static ALWAYS_INLINE void decode_luma(uint8_t *restrict y, const uint16_t *restrict luma,
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

/* Where rows of a tile are not `within` of 4 times what they were: not 0. Modulo 2^16, as both are
 * 65520 at most: 16 short of what could be taken for near. */
static ALWAYS_INLINE void differences(uint16_t *restrict differs, const uint16_t *restrict mean,
                                      const uint16_t *own, ptrdiff_t stride, uint16_t within,
                                      int rows)
{
    const uint16_t most = (uint16_t)(2 * within);

    for (int i = 0; i < rows * RF_TILE; i += RF_TILE, own += stride)
        for (int x = 0; x < RF_TILE; x++) {
            const uint16_t above = (uint16_t)(mean[i + x] - (uint16_t)(4 * own[x]) + within);

            differs[i + x] = (uint16_t)(above > most ? above - most : 0);
        }
}

static ALWAYS_INLINE void choose(uint8_t *restrict to, const uint16_t *restrict differs,
                                 const uint8_t *restrict code, int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t keep = (uint8_t)(differs[i] == 0 ? 0xff : 0);

        to[i] = (uint8_t)((to[i] & keep) | (code[i] & ~keep));
    }
}

/* All bits of a pair, if any. */
static ALWAYS_INLINE void widen(uint32_t *pair, int n)
{
    for (int i = 0; i < n; i++)
        pair[i] = pair[i] ? 0xffffffff : 0;
}

/* Codes in place of those that are not to be kept. */
static ALWAYS_INLINE void put_codes(struct rf_decode_job *job, const uint8_t *y, const uint8_t *uv,
                                    const int down)
{
    const int rows = RF_TILE >> down, n = rows * RF_TILE;
    uint16_t luma[RF_TILE * RF_TILE], chroma[RF_TILE * RF_TILE];
    uint32_t of_pixels[SAMPLES], of_samples[SAMPLES], wide[SAMPLES], any[SAMPLES];

    differences(luma, job->luma, job->own_luma, job->stride, job->within[0], RF_TILE);
    differences(chroma, job->chroma, job->own_chroma, job->stride, job->within[1], rows);
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

static ALWAYS_INLINE void decode(struct rf_decode_job *job, const int down)
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

static void RF_VEC(rf_decode)(struct rf_decode_job *job)
{
    if (job->down)
        decode(job, 1);
    else
        decode(job, 0);
}

enum { RUN = 128 }; /* samples that are worked on together */

/* Copies of a whole run are of a fixed size, which takes no call. */
static ALWAYS_INLINE void copy_run(void *restrict to, const void *restrict from, int run,
                                   const int bytes)
{
    if (run == RUN)
        memcpy(to, from, (size_t)bytes * RUN);
    else
        memcpy(to, from, (size_t)bytes * (size_t)run);
}

/* Light of the pixels of a run of samples. */
static ALWAYS_INLINE void row_light(uint16_t *restrict light, const uint8_t *restrict luma,
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

static void RF_VEC(rf_encode)(uint16_t *const out[2], uint16_t *chroma,
                              const uint8_t *const luma[2], const uint8_t *uv,
                              const struct rf_yuv_curve *curve, int n)
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

void RF_VEC(rf_yuv_codes_use)(struct rf_kernels *kernels)
{
    kernels->encode = RF_VEC(rf_encode);
    kernels->decode = RF_VEC(rf_decode);
}
