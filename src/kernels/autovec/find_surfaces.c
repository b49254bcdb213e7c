/* find_surfaces.c: the depth upsampler: finds the surfaces among the samples around a cell, and a
 * plane through each. */
#include "kernels/kernels.h"
#include "kernels/autovec/groups.h"

#include <assert.h>
#include <string.h>

enum {
    TAPS = RF_TAP_COUNT,
    SAMPLES = RF_AROUND * RF_AROUND,
    FIRST = 2 * RF_AROUND + 2, /* tap */
    TRUSTED = 128,
    MANY = 40,          /* samples of a surface */
    EVEN = 65535 / 256, /* with less between its low and high a surface has no slopes */
    STEEPEST = 16383,   /* a sample */
    FIRM = 8,           /* weight of "it is flat" in the slopes, of 64 of all taps */
};

/* Bits of every other of 8 x 8 samples, those of a checkerboard. */
#define CHECKERED UINT64_C(0xaa55aa55aa55aa55)

/* Bits of those of 64 bytes whose highest bit is set. */
static uint64_t high_bits(const uint8_t *byte)
{
    uint64_t all = 0;

    for (int i = 0; i < RF_AROUND; i++) {
        uint64_t bits = 0;

        for (int k = 0; k < 8; k++)
            bits |= (uint64_t)(byte[8 * i + k] >> 7) << (8 * k);
        all |= (bits * UINT64_C(0x0102040810204080) >> 56) << (8 * i);
    }
    return all;
}

static int count(uint64_t bits)
{
    bits -= bits >> 1 & UINT64_C(0x5555555555555555);
    bits = (bits & UINT64_C(0x3333333333333333)) + (bits >> 2 & UINT64_C(0x3333333333333333));
    bits = (bits + (bits >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    return (int)(bits * UINT64_C(0x0101010101010101) >> 56);
}

/* The samples that show what a surface looks like; of many, every other one is enough.
 * How many. */
static int find_samples(struct rf_surface *s, const uint16_t disparity[SAMPLES], uint64_t trusted)
{
    const int under = s->low > RF_GAP / 2 ? s->low - RF_GAP / 2 : 0;
    const int high = s->low + s->range;
    const int over = high < 65535 - RF_GAP / 2 ? high + RF_GAP / 2 : 65535;
    uint64_t members = rf_within64(disparity, (uint16_t)under, (uint16_t)(over - under));

    members &= trusted;
    /* No branch: nobody could foretell it. */
    const uint64_t few = (uint64_t)(count(members) - MANY - 1) >> 63;

    s->samples = members & (CHECKERED | -few);
    return count(s->samples);
}

/* Two numbers for n samples: 64 / (6 n grow) in Q32, and `grow`, which brings n to 64 to 127. */
/* clang-format off */
#define GROW(n, grow) {65536 * 64 / ((n) * (grow)) * (65536 / 6 + 1), grow}
/* clang-format on */
#define GROW4(n, grow)  GROW(n, grow), GROW(n + 1, grow), GROW(n + 2, grow), GROW(n + 3, grow)
#define GROW16(n, grow) GROW4(n, grow), GROW4(n + 4, grow), GROW4(n + 8, grow), GROW4(n + 12, grow)
static const struct {
    uint32_t share;
    uint16_t grow;
} growth[SAMPLES + 1] = {
    {0, 0},       GROW(1, 64),   GROW(2, 32),   GROW(3, 32),   GROW4(4, 16), GROW4(8, 8),
    GROW4(12, 8), GROW16(16, 4), GROW16(32, 2), GROW16(48, 2), GROW(64, 1),
};

/* With equal evidence the nearer surface is up to a fifth better: what is thin is in
 * front. */
static void set_scale(struct rf_surface *s, int n)
{
    const uint64_t scale = (uint64_t)growth[n].share * (5 * 65535u + s->low) >> 32;

    s->grow = growth[n].grow;
    s->scale = (uint16_t)(scale > 65535 ? 65535 : scale);
}

static int slope(int along, int spread, int weight)
{
    const int d = along / (spread + FIRM * weight / 64 + 1);

    return d < -STEEPEST ? -STEEPEST : d > STEEPEST ? STEEPEST : d;
}

/* Twice how far a tap is from the middle, and how much it counts there. */
static const int16_t one[TAPS] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
static const int16_t across[TAPS] = {-3, -3, -3, -3, -1, -1, -1, -1, 1, 1, 1, 1, 3, 3, 3, 3};
static const int16_t down[TAPS] = {-3, -1, 1, 3, -3, -1, 1, 3, -3, -1, 1, 3, -3, -1, 1, 3};
static const int16_t middle[TAPS] = {256, 768,  768,  256, 768, 2304, 2304, 768,
                                     768, 2304, 2304, 768, 256, 768,  768,  256};

/* middle[] times across[] and down[]. */
static const int16_t middle_across[TAPS] = {-768, -2304, -2304, -768, -768, -2304, -2304, -768,
                                            768,  2304,  2304,  768,  768,  2304,  2304,  768};
static const int16_t middle_down[TAPS] = {-768,  -768,  768,  768,  -2304, -2304, 2304, 2304,
                                          -2304, -2304, 2304, 2304, -768,  -768,  768,  768};

/* Sums over the taps of a surface: weights q, and with e heights above its low, at most
 * RF_WIDEST. Weights add up to 64 * 256 at the most: all fit 32 bits. */
static_assert((int64_t)64 * 256 * RF_WIDEST * 3 <= INT32_MAX, "of heights, times 3 at the most");
struct sums {
    uint32_t part;           /* where q is 256 m: 2^31 / m, of which n / m is found; else 0 */
    int q, qx, qy, qxx, qyy; /* x = across, y = down */
    int qe, qxe, qye;
};

/* The heights of a surface's taps, 0 of the others, and which those are. */
static inline void take_taps(int16_t e[TAPS], uint16_t own[TAPS], const struct rf_surface *s,
                             const uint16_t tap[TAPS])
{
    for (int i = 0; i < TAPS; i++) {
        const uint16_t above = (uint16_t)(tap[i] - s->low);

        own[i] = above <= s->range ? 65535 : 0;
        e[i] = (int16_t)(above & own[i]);
    }
}

/* Sums for each set of rows of a column: bits 0 to 7 hold the sum of (1, 3, 3, 1), bits 8 to 15
 * that of these times (-3, -1, 1, 3) plus 8, bits 16 to 23 that of these times the squares. */
#define COLUMN(a, b, c, d)                                                                         \
    (((a) + 3 * (b) + 3 * (c) + (d)) + ((8 - 3 * (a)-3 * (b) + 3 * (c) + 3 * (d)) << 8) +          \
     ((9 * (a) + 3 * (b) + 3 * (c) + 9 * (d)) << 16))
static const uint32_t column[16] = {
    COLUMN(0, 0, 0, 0), COLUMN(1, 0, 0, 0), COLUMN(0, 1, 0, 0), COLUMN(1, 1, 0, 0),
    COLUMN(0, 0, 1, 0), COLUMN(1, 0, 1, 0), COLUMN(0, 1, 1, 0), COLUMN(1, 1, 1, 0),
    COLUMN(0, 0, 0, 1), COLUMN(1, 0, 0, 1), COLUMN(0, 1, 0, 1), COLUMN(1, 1, 0, 1),
    COLUMN(0, 0, 1, 1), COLUMN(1, 0, 1, 1), COLUMN(0, 1, 1, 1), COLUMN(1, 1, 1, 1)};

/* Just more than 2^31 / m: times n it is 2^31 n / m, and less than 2^31 / m more where
 * n m < 2^31. */
#define PART(m)  ((1u << 31) / (m) + 1)
#define PART4(m) PART(m), PART((m) + 1), PART((m) + 2), PART((m) + 3)
static const uint32_t part[SAMPLES + 1] = {0,         PART4(1),  PART4(5),  PART4(9),  PART4(13),
                                           PART4(17), PART4(21), PART4(25), PART4(29), PART4(33),
                                           PART4(37), PART4(41), PART4(45), PART4(49), PART4(53),
                                           PART4(57), PART4(61)};

/* n / q; for q = 256 m that is n / 256 / m. */
static inline int over(uint32_t n, const struct sums *sum)
{
    return (int)(sum->part ? (uint64_t)(n >> 8) * sum->part >> 31 : n / (uint32_t)sum->q);
}

static inline uint32_t magnitude(int v)
{
    return (uint32_t)(v < 0 ? -v : v);
}

/* Where each tap counts what it does in the middle: what needs no heights by columns.
 */
static struct sums sums_of(const struct rf_surface *s, const int16_t e[TAPS])
{
    const uint32_t a = column[s->taps & 15], b = column[s->taps >> 4 & 15];
    const uint32_t c = column[s->taps >> 8 & 15], d = column[s->taps >> 12];
    const uint32_t all = a + 3 * (b + c) + d;
    const int p = a & 255, q = b & 255, r = c & 255, t = d & 255;

    return (struct sums){.part = part[all & 255],
                         .q = 256 * (int)(all & 255),
                         .qx = 256 * 3 * (r + t - p - q),
                         .qy = 256 * ((int)(all >> 8 & 255) - 64),
                         .qxx = 256 * (9 * (p + t) + 3 * (q + r)),
                         .qyy = 256 * (int)(all >> 16),
                         .qe = rf_dot16(middle, e),
                         .qxe = rf_dot16(middle_across, e),
                         .qye = rf_dot16(middle_down, e)};
}

static struct sums sums_by(const int16_t weight[TAPS], const uint16_t own[TAPS],
                           const int16_t e[TAPS])
{
    int16_t q[TAPS], qx[TAPS], qy[TAPS];

    for (int i = 0; i < TAPS; i++) {
        q[i] = (int16_t)(weight[i] & own[i]);
        qx[i] = (int16_t)(q[i] * across[i]);
        qy[i] = (int16_t)(q[i] * down[i]);
    }
    return (struct sums){.q = rf_dot16(q, one),
                         .qx = rf_dot16(qx, one),
                         .qy = rf_dot16(qy, one),
                         .qxx = rf_dot16(qx, across),
                         .qyy = rf_dot16(qy, down),
                         .qe = rf_dot16(q, e),
                         .qxe = rf_dot16(qx, e),
                         .qye = rf_dot16(qy, e)};
}

/* A plane by least squares over the taps, those in the middle counting most; weight ==
 * NULL: all are sure. */
static void fit(struct rf_surface *s, const uint16_t tap[TAPS], const int16_t *weight)
{
    int16_t e[TAPS];
    uint16_t own[TAPS];

    take_taps(e, own, s, tap);
    const struct sums sum = weight ? sums_by(weight, own, e) : sums_of(s, e);
    const int w = sum.q, x = sum.qx, y = sum.qy;
    int mean = over((uint32_t)sum.qe, &sum);

    s->mean = (int16_t)mean;
    s->right = s->below = 0;
    if (s->range < EVEN)
        return;
    const uint32_t u = magnitude(x), v = magnitude(y);
    const int gx = slope(2 * (sum.qxe - x * mean), sum.qxx - over(u * u, &sum), 4 * w);
    const int gy = slope(2 * (sum.qye - y * mean), sum.qyy - over(v * v, &sum), 4 * w);
    const int off = gx * x + gy * y, back = over(magnitude(off) / 2, &sum);

    mean += off < 0 ? back : -back;
    s->mean = (int16_t)(mean < -STEEPEST ? -STEEPEST : mean > STEEPEST ? STEEPEST : mean);
    s->right = (int16_t)gx;
    s->below = (int16_t)gy;
}

/* Trust of the taps, their weights in a plane, and of all samples whether they are
 * trusted. */
static uint64_t take_trust(struct rf_cell *cell, int16_t spare[TAPS], const int16_t **weight,
                           const struct rf_window *window)
{
    uint64_t trusted;
    uint8_t trust[TAPS];
    bool any = false, sure = true;

    cell->sure = true;
    *weight = NULL;
    if (!window->trust)
        return ~UINT64_C(0);
    trusted = high_bits(window->trust);
    for (int i = 0; i < TAPS; i++) {
        trust[i] = window->trust[FIRST + i / RF_TAPS * RF_AROUND + i % RF_TAPS];
        any |= trust[i] >= TRUSTED;
        sure &= trust[i] == 255;
    }
    if (sure || !any)
        return trusted;
    cell->sure = false;
    for (int i = 0; i < TAPS; i++) {
        cell->trust[i] = (uint16_t)(trust[i] < 1 ? 16 : trust[i] * 257);
        spare[i] = (int16_t)((middle[i] >> 8) * (trust[i] + 1));
    }
    *weight = spare;
    return trusted;
}

void RF_VEC(rf_find_surfaces)(struct rf_cell *cell, const struct rf_window *window,
                              const struct rf_parts *parts, int at)
{
    int16_t spare[TAPS];
    uint16_t tap[TAPS];
    const int16_t *weight;
    const uint64_t trusted = take_trust(cell, spare, &weight, window);
    unsigned starts = parts->starts[at];
    int most_taps = 0, greatest = 0, n = 0;

    for (int i = 0; i < RF_TAPS; i++)
        memcpy(tap + i * RF_TAPS, window->disparity + FIRST + i * RF_AROUND, RF_TAPS * sizeof *tap);
    while (starts) {
        struct rf_surface *s = &cell->surface[n];
        const int first = __builtin_ctz(starts);

        starts &= starts - 1;
        const int end = starts ? __builtin_ctz(starts) : TAPS;

        greatest = end - first > most_taps ? n : greatest;
        most_taps = end - first > most_taps ? end - first : most_taps;
        s->low = parts->sorted[first][at];
        s->range = (uint16_t)(parts->sorted[end - 1][at] - s->low);
        s->taps = (uint16_t)rf_within16(tap, s->low, s->range);
        set_scale(s, find_samples(s, window->disparity, trusted));
        fit(s, tap, weight);
        n++;
    }
    cell->surfaces = n;
    cell->greatest = greatest;
}
