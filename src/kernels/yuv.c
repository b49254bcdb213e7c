/* yuv.c: loops over rows of luma and of chroma, written as those of rows.c. */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

static inline uint16_t size(int16_t s)
{
    return (uint16_t)(s < 0 ? -s : s);
}

static inline int16_t sharper(int16_t a, int16_t b)
{
    return size(a) <= size(b) ? a : b;
}

static void RF_VEC(rf_sharpest4)(int16_t *restrict out, const int16_t *restrict upper,
                                 const int16_t *restrict lower, int n)
{
    for (int x = 0; x < n; x++) {
        const int16_t s = sharper(sharper(upper[2 * x], upper[2 * x + 1]),
                                  sharper(lower[2 * x], lower[2 * x + 1]));

        out[2 * x] = s;
        out[2 * x + 1] = s;
    }
}

static inline uint16_t known(int16_t blur)
{
    return (uint16_t)(blur != RF_NO_BLUR ? 0xffff : 0);
}

static inline int16_t farther(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

static void RF_VEC(rf_push1)(uint16_t *restrict out, int16_t *restrict out_blur,
                             const uint16_t *restrict upper, const uint16_t *restrict lower,
                             const int16_t *restrict blur0, const int16_t *restrict blur1,
                             int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t k0 = known(blur0[2 * x]), k1 = known(blur0[2 * x + 1]);
        const uint16_t k2 = known(blur1[2 * x]), k3 = known(blur1[2 * x + 1]);
        const uint16_t count = (uint16_t)-(uint16_t)(k0 + k1 + k2 + k3);
        const uint16_t sum = (uint16_t)((upper[2 * x] & k0) + (upper[2 * x + 1] & k1) +
                                        (lower[2 * x] & k2) + (lower[2 * x + 1] & k3));
        const uint16_t half = (uint16_t)((uint16_t)(sum + 1) >> 1);
        /* x / 3 as in arithmetic.md */
        const uint16_t third =
            (uint16_t)((uint16_t)(((uint32_t)(uint16_t)(sum + 1) * 43691) >> 16) >> 1);
        const uint16_t quarter = (uint16_t)((uint16_t)(sum + 2) >> 2);

        out[x] = count == 4 ? quarter : count == 3 ? third : count == 2 ? half : sum;
        out_blur[x] = farther(farther(blur0[2 * x], blur0[2 * x + 1]),
                              farther(blur1[2 * x], blur1[2 * x + 1]));
    }
}

static void RF_VEC(rf_split2)(uint16_t *restrict first, uint16_t *restrict second,
                              const uint16_t *upper, const uint16_t *lower, int n)
{
    for (int x = 0; x < n; x++) {
        first[x] = (uint16_t)((upper[2 * x] + lower[2 * x] + 1) >> 1);
        second[x] = (uint16_t)((upper[2 * x + 1] + lower[2 * x + 1] + 1) >> 1);
    }
}

static void RF_VEC(rf_join2)(uint16_t *restrict out, const uint16_t *restrict first,
                             const uint16_t *restrict second, int n)
{
    for (int x = 0; x < n; x++) {
        out[2 * x] = first[x];
        out[2 * x + 1] = second[x];
    }
}

/* floor((u s + 2^(22 + shift)) / 2^(23 + shift)), by the high half of the product. */
static inline int16_t rounded(int16_t u, int16_t blur, int shift)
{
    return (int16_t)((int16_t)((int16_t)(u * blur >> 16) + (64 << shift)) >> (7 + shift));
}

static void RF_VEC(rf_aim_chroma)(int32_t *restrict offset, int32_t *restrict cell,
                                  const int16_t *restrict u, const int16_t *restrict v,
                                  int blur, int down, int32_t stride, int32_t cell_stride,
                                  int n)
{
    int16_t x[RF_RAY_CHUNK], y[RF_RAY_CHUNK];
    const int16_t s = (int16_t)blur;
    const int to_cell = 2 - down;

    for (int i = 0; i < n; i++) {
        x[i] = rounded(u[i], s, 1);
        y[i] = rounded(v[i], s, down);
    }
    for (int i = 0; i < n; i++) {
        offset[i] = 2 * x[i] + y[i] * stride;
        cell[i] = (x[i] >> 1) + (y[i] >> to_cell) * cell_stride;
    }
}

enum { SAMPLES = RF_TILE * RF_TILE / 2 };

static inline uint16_t white_at_most(uint16_t mean)
{
    return mean < RF_MEAN_MAX ? mean : RF_MEAN_MAX;
}

/* L' of each sample. */
static void mean_light(int16_t *restrict light, const uint16_t *restrict luma, int down)
{
    for (int y = 0; y < RF_TILE; y += 1 << down) {
        const uint16_t *restrict a = luma + y * RF_TILE, *restrict b = a + down * RF_TILE;

        for (int x = 0; x < RF_TILE / 2; x++)
            light[x] = (int16_t)((a[2 * x] + a[2 * x + 1] + b[2 * x] + b[2 * x + 1] + 2) >> 2);
        light += RF_TILE / 2;
    }
}

static inline int16_t clipped(int mean)
{
    return (int16_t)(rf_clip_mean(mean) >> 1);
}

/* rf_chroma_code() of n samples; what is a look-up stands by itself, so that the rest can be
 * done by vectors. */
static void decode_chroma(uint8_t *restrict uv, int16_t *restrict excess,
                          const int16_t *restrict light, const uint16_t *restrict chroma,
                          const struct rf_yuv_curve *restrict curve, int n)
{
    const int32_t red = curve->red, blue = curve->blue;
    const int32_t kr = curve->kr, kg = curve->kg, kb = curve->kb;
    const int32_t per_u = curve->codes_per_tone[0], per_v = curve->codes_per_tone[1];
    int16_t r[SAMPLES], g[SAMPLES], b[SAMPLES], y[SAMPLES];

    for (int i = 0; i < n; i++) {
        const int db = chroma[2 * i] - 4 * RF_CHROMA_ZERO;
        const int dr = chroma[2 * i + 1] - 4 * RF_CHROMA_ZERO;

        b[i] = clipped(light[i] + db);
        r[i] = clipped(light[i] + dr);
        g[i] = clipped(light[i] - (red * dr + blue * db) / RF_SHARE);
    }
    for (int i = 0; i < n; i++) {
        b[i] = curve->tone[b[i]];
        r[i] = curve->tone[r[i]];
        g[i] = curve->tone[g[i]];
    }
    for (int i = 0; i < n; i++) {
        const int own = (kr * r[i] + kg * g[i] + kb * b[i] + RF_SHARE / 2) / RF_SHARE;
        const int u = 128 + (((b[i] - own) * per_u + (1 << 15)) >> 16);
        const int v = 128 + (((r[i] - own) * per_v + (1 << 15)) >> 16);

        y[i] = (int16_t)own;
        uv[2 * i] = (uint8_t)(u < 0 ? 0 : u > 255 ? 255 : u);
        uv[2 * i + 1] = (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v);
    }
    for (int i = 0; i < n; i++)
        excess[i] = (int16_t)(light[i] - 4 * curve->light[y[i]]);
}

static void decode_luma(uint8_t *restrict y, const uint16_t *restrict luma,
                        const int16_t *restrict excess, const uint8_t *restrict to_code,
                        int down)
{
    int16_t at[RF_TILE * RF_TILE];

    for (int i = 0; i < RF_TILE; i++) {
        const int16_t *restrict e = excess + (i >> down) * (RF_TILE / 2);
        const uint16_t *restrict in = luma + i * RF_TILE;
        int16_t *restrict out = at + i * RF_TILE;

        for (int x = 0; x < RF_TILE / 2; x++) {
            out[2 * x] = (int16_t)rf_clip_mean(in[2 * x] - e[x]);
            out[2 * x + 1] = (int16_t)rf_clip_mean(in[2 * x + 1] - e[x]);
        }
    }
    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        y[i] = to_code[at[i]];
}

/* What rows of a tile differ by from 4 times what they were, and pairs of that. */
static void differences(uint32_t *restrict pairs, uint16_t *restrict each,
                        const uint16_t *restrict mean, const uint16_t *own, ptrdiff_t stride,
                        int rows)
{
    uint16_t was[RF_TILE * RF_TILE];

    for (int y = 0; y < rows; y++)
        memcpy(was + y * RF_TILE, own + y * stride, RF_TILE * sizeof was[0]);
    for (int i = 0; i < rows * RF_TILE; i++)
        each[i] = (uint16_t)(mean[i] ^ (uint16_t)(4 * was[i]));
    memcpy(pairs, each, (size_t)rows * RF_TILE * sizeof each[0]);
}

static void choose(uint8_t *restrict to, const uint16_t *restrict differs,
                   const uint8_t *restrict code, int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t keep = (uint8_t)(differs[i] == 0 ? 0xff : 0);

        to[i] = (uint8_t)((to[i] & keep) | (code[i] & ~keep));
    }
}

/* Codes in place of those that are not to be kept. */
static void put_codes(struct rf_decode_job *job, const uint8_t *y, const uint8_t *uv)
{
    enum { PAIRS = RF_TILE / 2 };
    const int rows = RF_TILE >> job->down, n = rows * RF_TILE;
    uint32_t luma[SAMPLES], chroma[SAMPLES], any[SAMPLES];
    uint16_t each[RF_TILE * RF_TILE], wide[RF_TILE * RF_TILE];

    differences(chroma, each, job->chroma, job->own_chroma, job->stride, rows);
    differences(luma, each, job->luma, job->own_luma, job->stride, RF_TILE);
    for (int i = 0; i < n / 2; i++)
        chroma[i] = chroma[i] ? 0xffffffff : 0;
    for (int c = 0; c < rows; c++) {
        const uint32_t *upper = luma + (c << job->down) * PAIRS;
        const uint32_t *lower = upper + job->down * PAIRS;

        for (int x = 0; x < PAIRS; x++) {
            const uint32_t differs = upper[x] | lower[x] | chroma[c * PAIRS + x];

            any[c * PAIRS + x] = differs ? 0xffffffff : 0;
        }
    }
    /* a pair of columns is as wide as a sample's two values */
    for (int i = 0; i < RF_TILE; i++)
        memcpy(wide + i * RF_TILE, chroma + (i >> job->down) * PAIRS,
               RF_TILE * sizeof wide[0]);
    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        each[i] |= wide[i];
    choose(job->y, each, y, RF_TILE * RF_TILE);
    memcpy(wide, any, (size_t)n * sizeof wide[0]);
    choose(job->uv, wide, uv, n);
}

static void RF_VEC(rf_decode)(struct rf_decode_job *job)
{
    const int samples = SAMPLES >> job->down;
    int16_t light[SAMPLES], excess[SAMPLES];
    uint8_t y[RF_TILE * RF_TILE], uv[RF_TILE * RF_TILE];
    uint16_t luma[RF_TILE * RF_TILE];

    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        luma[i] = white_at_most(job->luma[i]);
    mean_light(light, luma, job->down);
    decode_chroma(uv, excess, light, job->chroma, job->curve, samples);
    decode_luma(y, luma, excess, job->curve->to_code, job->down);
    put_codes(job, y, uv);
}

enum { RUN = 64 }; /* samples that are worked on together */

/* Light of the pixels of n samples, and their means. */
static void sample_light(uint16_t luma[2][2 * RUN], int16_t *restrict mean,
                         const uint8_t *restrict upper, const uint8_t *restrict lower,
                         const uint16_t *restrict light_of_luma, int n)
{
    const uint16_t *restrict a = luma[0], *restrict b = luma[1];

    for (int i = 0; i < 2 * n; i++) {
        luma[0][i] = light_of_luma[upper[i]];
        luma[1][i] = light_of_luma[lower[i]];
    }
    for (int i = 0; i < n; i++)
        mean[i] = (int16_t)((a[2 * i] + a[2 * i + 1] + b[2 * i] + b[2 * i + 1] + 2) >> 2);
}

/* rf_chroma_of() of n samples. */
static void encode_chroma(uint16_t *restrict chroma, int16_t *restrict excess,
                          const int16_t *restrict mean, const uint8_t *restrict uv,
                          const struct rf_yuv_curve *restrict curve, int n)
{
    const int kr = curve->kr, kg = curve->kg, kb = curve->kb;
    const int per_u = curve->tones_per_code[0], per_v = curve->tones_per_code[1];
    const int green_u = curve->green_per_code[0], green_v = curve->green_per_code[1];
    int16_t r[RUN], g[RUN], b[RUN], own[RUN];

    for (int i = 0; i < n; i++)
        own[i] = curve->tone[2 * mean[i]];
    for (int i = 0; i < n; i++) {
        const int u = uv[2 * i] - 128, v = uv[2 * i + 1] - 128;

        b[i] = (int16_t)rf_clip_tone(own[i] + ((u * per_u + 2048) >> 12));
        r[i] = (int16_t)rf_clip_tone(own[i] + ((v * per_v + 2048) >> 12));
        g[i] = (int16_t)rf_clip_tone(own[i] - ((u * green_u + v * green_v + 2048) >> 12));
    }
    for (int i = 0; i < n; i++) {
        b[i] = (int16_t)curve->light[b[i]];
        r[i] = (int16_t)curve->light[r[i]];
        g[i] = (int16_t)curve->light[g[i]];
        own[i] = (int16_t)curve->light[own[i]];
    }
    for (int i = 0; i < n; i++) {
        const int all = (kr * r[i] + kg * g[i] + kb * b[i] + RF_SHARE / 2) / RF_SHARE;

        chroma[2 * i] = (uint16_t)(RF_CHROMA_ZERO + b[i] - all);
        chroma[2 * i + 1] = (uint16_t)(RF_CHROMA_ZERO + r[i] - all);
        excess[i] = (int16_t)(all - own[i]);
    }
}

static void add_excess(uint16_t *restrict out, const uint16_t *restrict luma,
                       const int16_t *restrict excess, int n)
{
    for (int i = 0; i < n; i++) {
        out[2 * i] = rf_luminance(luma[2 * i], excess[i]);
        out[2 * i + 1] = rf_luminance(luma[2 * i + 1], excess[i]);
    }
}

static void RF_VEC(rf_encode)(uint16_t *const out[2], uint16_t *chroma,
                              const uint8_t *const luma[2], const uint8_t *uv,
                              const struct rf_yuv_curve *curve, int n)
{
    for (int at = 0; at < n; at += RUN) {
        const int run = n - at < RUN ? n - at : RUN;
        uint16_t light[2][2 * RUN];
        int16_t mean[RUN], excess[RUN];

        sample_light(light, mean, luma[0] + 2 * at, luma[1] + 2 * at, curve->light_of_luma,
                     run);
        encode_chroma(chroma + 2 * at, excess, mean, uv + 2 * at, curve, run);
        add_excess(out[0] + 2 * at, light[0], excess, run);
        if (out[1] != out[0])
            add_excess(out[1] + 2 * at, light[1], excess, run);
    }
}

void RF_VEC(rf_yuv_use)(struct rf_kernels *kernels)
{
    kernels->aim_chroma = RF_VEC(rf_aim_chroma);
    kernels->encode = RF_VEC(rf_encode);
    kernels->decode = RF_VEC(rf_decode);
    kernels->sharpest4 = RF_VEC(rf_sharpest4);
    kernels->push1 = RF_VEC(rf_push1);
    kernels->split2 = RF_VEC(rf_split2);
    kernels->join2 = RF_VEC(rf_join2);
}
