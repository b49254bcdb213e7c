/* surfaces.c: coarse samples sorted into surfaces.
 *
 * Compiled once as plain C and once for each instruction set, like rows.c.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <stdbool.h>
#include <string.h>

enum {
    TAPS = RF_TAPS * RF_TAPS,
    GAP = 65535 / 44,  /* largest one between neighbouring disparities of a surface */
    WIDEST = 65535 / 8,
    TRUSTED = 128,
    MANY = 40,         /* samples of a surface */
    EVEN = 65535 / 256, /* slopes of a surface with less between its low and high are left out */
    STEEPEST = 16383,  /* a sample */
    FIRM = 8,          /* weight of "it is flat" in the slopes, of 64 of all taps */
};

/* Bits of every other of 8 x 8 samples, those of a checkerboard. */
#define CHECKERED UINT64_C(0xaa55aa55aa55aa55)

/* The tap at (i % 4, i / 4) among 8 x 8 samples. */
static int sample_of(int tap)
{
    return (tap / RF_TAPS + 2) * RF_AROUND + tap % RF_TAPS + 2;
}

/* Disparities with their tap in the lowest 4 bits, ascending. */
static void sort(int32_t sorted[TAPS], const uint16_t disparity[RF_SAMPLES])
{
    int32_t key[TAPS], rank[TAPS] = {0};

    for (int i = 0; i < TAPS; i++)
        key[i] = disparity[sample_of(i)] << 4 | i;
    for (int j = 0; j < TAPS; j++) /* counts what is less: no branch to be guessed wrong */
        for (int i = 0; i < TAPS; i++)
            rank[i] += key[j] < key[i];
    for (int i = 0; i < TAPS; i++)
        sorted[rank[i]] = key[i];
}

static void part(struct rf_cell *cell, const int32_t sorted[TAPS])
{
    struct rf_surface *surface = cell->surface;
    int last = 0;

    cell->surfaces = 0;
    for (int i = 0; i < TAPS; i++) {
        const int d = sorted[i] >> 4;

        if (i == 0 || d - last > GAP || d - surface->low > WIDEST) {
            surface = &cell->surface[cell->surfaces++];
            surface->low = (uint16_t)d;
            surface->taps = 0;
        }
        surface->high = (uint16_t)d;
        surface->tap[surface->taps++] = (uint8_t)(sorted[i] & 15);
        last = d;
    }
}

/* Bit k of eight bytes of 0 or 1. */
static uint64_t bits_of(const uint8_t byte[8])
{
    uint64_t bits = 0;

    for (int k = 0; k < 8; k++)
        bits |= (uint64_t)byte[k] << (8 * k);
    return bits * UINT64_C(0x0102040810204080) >> 56;
}

/* The samples that show what a surface looks like; of many, every other one is enough. */
static void list_samples(struct rf_surface *s, const uint16_t *restrict disparity,
                         const uint8_t *restrict trust)
{
    const int under = s->low > GAP / 2 ? s->low - GAP / 2 : 0;
    const int over = s->high < 65535 - GAP / 2 ? s->high + GAP / 2 : 65535;
    const uint16_t low = (uint16_t)under, width = (uint16_t)(over - under);
    uint8_t own[RF_SAMPLES];
    uint64_t members = 0;
    int n = 0;

    for (int i = 0; i < RF_SAMPLES; i++)
        own[i] = (uint16_t)(disparity[i] - low) <= width;
    if (trust)
        for (int i = 0; i < RF_SAMPLES; i++)
            own[i] &= trust[i] >> 7; /* TRUSTED */
    for (int j = 0; j < RF_AROUND; j++)
        members |= bits_of(own + j * RF_AROUND) << (RF_AROUND * j);
    if (__builtin_popcountll(members) > MANY)
        members &= CHECKERED;
    for (; members; members &= members - 1)
        s->sample[n++] = (uint8_t)__builtin_ctzll(members);
    s->samples = n;
}

/* 64 / (n grow), and of equal evidence the nearer surface is up to a fifth better: what is thin
 * is in front. */
static void set_scale(struct rf_surface *s)
{
    int n = s->samples;
    uint64_t scale;

    s->grow = 1;
    s->scale = 0;
    if (n == 0)
        return;
    for (; n < 64; n *= 2)
        s->grow = (uint16_t)(2 * s->grow);
    scale = (uint64_t)(65536 * 64 / n) * (5 * 65535u + s->low) * (65536 / 6 + 1) >> 32;
    s->scale = (uint16_t)(scale > 65535 ? 65535 : scale);
}

static int slope(int along, int spread, int weight)
{
    const int d = along / (spread + FIRM * weight / 64 + 1);

    return d < -STEEPEST ? -STEEPEST : d > STEEPEST ? STEEPEST : d;
}

/* A plane by least squares over the taps, those in the middle counting most. Weights add up to
 * 64 * 255 at the most, heights are at most WIDEST: all sums fit 32 bits. */
static void fit(struct rf_surface *s, const uint16_t disparity[RF_SAMPLES])
{
    static const int weight[RF_TAPS] = {1, 3, 3, 1};
    int w = 0, x = 0, y = 0, d = 0, xx = 0, yy = 0, xd = 0, yd = 0;

    for (int k = 0; k < s->taps; k++) {
        const int tap = s->tap[k], u = tap % RF_TAPS, v = tap / RF_TAPS;
        const int q = weight[u] * weight[v] * ((s->trust[k] >> 8) + 1);
        const int tx = 2 * u - 3, ty = 2 * v - 3; /* half samples from the middle */
        const int e = disparity[sample_of(tap)] - s->low;

        w += q;
        x += q * tx;
        y += q * ty;
        d += q * e;
        xx += q * tx * tx;
        yy += q * ty * ty;
        xd += q * tx * e;
        yd += q * ty * e;
    }
    const int mean = d / w;

    s->mean = s->low + mean;
    s->right = s->below = 0;
    if (s->high - s->low < EVEN)
        return;
    const int gx = slope(2 * (xd - x * mean), xx - (int)((int64_t)x * x / w), 4 * w);
    const int gy = slope(2 * (yd - y * mean), yy - (int)((int64_t)y * y / w), 4 * w);
    s->mean -= (int)(((int64_t)gx * x + (int64_t)gy * y) / (2 * w));
    s->right = (int16_t)gx;
    s->below = (int16_t)gy;
}

static void RF_VEC(rf_find_surfaces)(struct rf_cell *cell,
                                     const uint16_t disparity[RF_SAMPLES],
                                     const uint8_t *trust)
{
    int32_t sorted[TAPS];
    bool any = !trust;

    sort(sorted, disparity);
    part(cell, sorted);
    for (int i = 0; i < TAPS && !any; i++)
        any = trust[sample_of(i)] >= TRUSTED;
    for (int k = 0; k < cell->surfaces; k++) {
        struct rf_surface *s = &cell->surface[k];

        for (int i = 0; i < s->taps; i++) {
            const int sure = trust && any ? trust[sample_of(s->tap[i])] : 255;

            s->trust[i] = (uint16_t)(sure < 1 ? 16 : sure * 257);
        }
        list_samples(s, disparity, trust);
        set_scale(s);
        fit(s, disparity);
    }
}

void RF_VEC(rf_surfaces_use)(struct rf_kernels *kernels)
{
    kernels->find_surfaces = RF_VEC(rf_find_surfaces);
}
