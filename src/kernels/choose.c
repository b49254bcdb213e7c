/* choose.c: which surface each pixel of a cell belongs to.
 *
 * Compiled once as plain C and once for each instruction set.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

enum { ALIKE_TO = 8 }; /* where the table ends */

#if defined(RF_VECTORS)

enum {
    HALVES = 2, /* vectors of 16 bits for one of 8 */
    SAMPLES = RF_AROUND * RF_AROUND,
};

/* Samples that may be like one of the pixels: those that are near the box around their
 * colours. */
static inline uint64_t near_samples(const uint8_t *const sample[3], const vec_u8 colour[3])
{
    const vec_u8 reach = vec_u8_set(ALIKE_TO);
    vec_u8 low[3], high[3];
    uint64_t bits = 0;

    for (int c = 0; c < 3; c++) {
        low[c] = vec_u8_set(vec_u8_least(colour[c]));
        high[c] = vec_u8_set(vec_u8_most(colour[c]));
    }
    for (int i = 0; i < SAMPLES; i += VEC_U8) {
        vec_u8 off = vec_u8_set(0);

        for (int c = 0; c < 3; c++) {
            const vec_u8 v = vec_u8_load(sample[c] + i);

            off = vec_u8_adds(off, vec_u8_subs(v, high[c]));
            off = vec_u8_adds(off, vec_u8_subs(low[c], v));
        }
        bits |= vec_u8_bits_at_most(off, reach) << i;
    }
    return bits;
}

/* How alike the pixels and samples are, added up. */
static inline void look(uint16_t alike[VEC_U8], const vec_u8 colour[3],
                        const uint8_t *const sample[3], uint64_t samples)
{
    const vec_u8 table = vec_u8_table(rf_likeness);
    vec_u16 sum[HALVES] = {vec_u16_set(0), vec_u16_set(0)};

    for (; samples; samples &= samples - 1) {
        const size_t i = (size_t)__builtin_ctzll(samples);
        const vec_u8 d0 = vec_u8_apart(colour[0], vec_u8_set(sample[0][i]));
        const vec_u8 d1 = vec_u8_apart(colour[1], vec_u8_set(sample[1][i]));
        const vec_u8 d2 = vec_u8_apart(colour[2], vec_u8_set(sample[2][i]));

        vec_u8_add_wide(sum, vec_u8_lookup_or_0(table, vec_u8_adds(vec_u8_adds(d0, d1), d2)));
    }
    vec_u8_store_wide(alike, sum);
}

static inline void add_taps(vec_u16 prior[HALVES], const struct rf_cell *cell, unsigned taps,
                            const struct rf_lie *lie, int x)
{
    vec_u16 sum[HALVES] = {vec_u16_set(0), vec_u16_set(0)};

    for (; taps; taps &= taps - 1) {
        const int t = __builtin_ctz(taps);

        for (int h = 0; h < HALVES; h++) {
            vec_u16 near_by = vec_u16_load(lie->near_by[t] + x + h * VEC_U16);

            if (!cell->sure)
                near_by = vec_u16_mul_high(near_by, vec_u16_set(cell->trust[t]));
            sum[h] = vec_u16_add(sum[h], near_by);
        }
    }
    for (int h = 0; h < HALVES; h++)
        prior[h] = sum[h];
}

/* What is expected of each surface. Where the taps are sure, the surface with the most
 * of them is given what the others leave. */
static inline void expect(vec_u16 prior[RF_TAP_COUNT][HALVES], const struct rf_cell *cell,
                          const struct rf_lie *lie, int x)
{
    const int rest = cell->sure ? cell->greatest : RF_TAP_COUNT;
    vec_u16 left[HALVES];

    for (int h = 0; h < HALVES; h++)
        left[h] = vec_u16_load(lie->all + x + h * VEC_U16);
    for (int k = 0; k < cell->surfaces; k++) {
        if (k == rest)
            continue;
        add_taps(prior[k], cell, cell->surface[k].taps, lie, x);
        for (int h = 0; h < HALVES; h++)
            left[h] = vec_u16_sub(left[h], prior[k][h]);
    }
    for (int h = 0; h < HALVES && rest < RF_TAP_COUNT; h++)
        prior[rest][h] = left[h];
}

static inline vec_u16 height_of(const struct rf_surface *surface, const struct rf_lie *lie, int x)
{
    vec_u16 d = vec_u16_set((uint16_t)surface->mean);

    d = vec_u16_add(d,
                    vec_s16_scale(vec_u16_set((uint16_t)surface->right), vec_u16_load(lie->x + x)));
    d = vec_u16_add(d,
                    vec_s16_scale(vec_u16_set((uint16_t)surface->below), vec_u16_load(lie->y + x)));
    d = vec_u16_min(vec_s16_max(d, vec_u16_set(0)), vec_u16_set(surface->range));
    return vec_u16_add(d, vec_u16_set(surface->low));
}

/* Scores of VEC_U8 pixels: the best and its disparity, and the second. */
struct found {
    vec_u16 best[HALVES], second[HALVES], disparity[HALVES];
};

static inline void weigh(struct found *found, const struct rf_surface *s, const struct rf_lie *lie,
                         int x, const vec_u16 prior[HALVES], const uint16_t alike[VEC_U8])
{
    const vec_u16 grow = vec_u16_set(s->grow), scale = vec_u16_set(s->scale);
    const vec_u16 unlike = vec_u16_set(RF_UNLIKE), four = vec_u16_set(4);

    for (int h = 0; h < HALVES; h++) {
        const vec_u16 sum = vec_u16_load(alike + h * VEC_U16);
        const vec_u16 mean = vec_u16_mul_high(vec_u16_mul(sum, grow), scale);
        const vec_u16 score =
            vec_u16_mul_high(vec_u16_add(vec_u16_mul(mean, four), unlike), prior[h]);
        const vec_u16 best = found->best[h];

        found->disparity[h] = vec_u16_select(vec_u16_at_most(score, best), found->disparity[h],
                                             height_of(s, lie, x + h * VEC_U16));
        found->second[h] = vec_u16_max(found->second[h], vec_u16_min(best, score));
        found->best[h] = vec_u16_max(best, score);
    }
}

static void RF_VEC(rf_surface)(uint16_t out[RF_BATCH], uint8_t sure[RF_BATCH],
                               const struct rf_cell *cell, const struct rf_window *window,
                               const struct rf_lie *lie,
                               uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], int n)
{
    for (int x = 0; x < n; x += VEC_U8) {
        const vec_u8 own[3] = {vec_u8_load(colour[0] + x), vec_u8_load(colour[1] + x),
                               vec_u8_load(colour[2] + x)};
        const uint64_t near_by = near_samples(window->colour, own);
        vec_u16 prior[RF_TAP_COUNT][HALVES];
        struct found found;
        vec_u16 is_sure[HALVES];

        for (int h = 0; h < HALVES; h++) {
            found.best[h] = found.second[h] = vec_u16_set(0);
            found.disparity[h] = vec_u16_set(cell->surface[0].low);
        }
        expect(prior, cell, lie, x);
        for (int k = 0; k < cell->surfaces; k++) {
            uint16_t alike[VEC_U8];

            look(alike, own, window->colour, cell->surface[k].samples & near_by);
            weigh(&found, &cell->surface[k], lie, x, prior[k], alike);
        }
        for (int h = 0; h < HALVES; h++) {
            const vec_u16 quarter = vec_u16_half(vec_u16_half(found.best[h]));
            const vec_u16 close = vec_u16_at_most(quarter, found.second[h]);

            vec_u16_store(out + x + h * VEC_U16, found.disparity[h]);
            is_sure[h] = vec_u16_xor(close, vec_u16_set(65535));
        }
        vec_u8_store(sure + x, vec_u8_of_masks(is_sure[0], is_sure[1]));
    }
}

#else

/* Whole vectors of pixels, so that the compiler knows how many. */
enum { LANES = 32 };

static inline uint8_t least(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

static inline uint8_t most(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

static inline uint8_t apart(uint8_t a, uint8_t b)
{
    return (uint8_t)(most(a, b) - least(a, b));
}

/* The box around the colours of pixels. */
struct box {
    uint8_t low[3], high[3];
};

static struct box box_of(uint8_t *const colour[3])
{
    struct box box;

    for (int c = 0; c < 3; c++) {
        uint8_t low = 255, high = 0;

        for (int x = 0; x < LANES; x++) {
            low = least(low, colour[c][x]);
            high = most(high, colour[c][x]);
        }
        box.low[c] = low;
        box.high[c] = high;
    }
    return box;
}

static int off_box(const struct box *box, int c, uint8_t v)
{
    return v - least(v, box->high[c]) + most(v, box->low[c]) - v;
}

static void look(uint16_t alike[LANES], uint8_t *const colour[3], const struct box *box,
                 const struct rf_window *window, uint64_t samples)
{
    const uint8_t *restrict p0 = colour[0], *restrict p1 = colour[1];
    const uint8_t *restrict p2 = colour[2];
    uint16_t sum[LANES] = {0};

    for (; samples; samples &= samples - 1) {
        const int k = __builtin_ctzll(samples);
        const uint8_t c0 = window->colour[0][k], c1 = window->colour[1][k];
        const uint8_t c2 = window->colour[2][k];

        if (off_box(box, 0, c0) + off_box(box, 1, c1) + off_box(box, 2, c2) > ALIKE_TO)
            continue;
        /* The table, in numbers: (124 - 11 d)^4 / 2^20. */
        for (int x = 0; x < LANES; x++) {
            const uint8_t d = (uint8_t)(apart(p0[x], c0) + apart(p1[x], c1) + apart(p2[x], c2));
            const uint8_t like = (uint8_t)(124 - 11 * least(d, 11));
            const uint16_t square = (uint16_t)(like * like);
            const uint16_t fourth = (uint16_t)((uint32_t)square * square >> 16);

            sum[x] = (uint16_t)(sum[x] + (fourth >> 4));
        }
    }
    memcpy(alike, sum, sizeof sum);
}

static void add_taps(uint16_t prior[LANES], const struct rf_cell *cell,
                     const struct rf_surface *surface, const struct rf_lie *lie, int from)
{
    for (int x = 0; x < LANES; x++)
        prior[x] = 0;
    for (unsigned taps = surface->taps; taps; taps &= taps - 1) {
        const int t = __builtin_ctz(taps);
        const uint16_t *restrict near_by = lie->near_by[t] + from;
        const uint16_t trust = cell->trust[t];

        if (cell->sure)
            for (int x = 0; x < LANES; x++)
                prior[x] = (uint16_t)(prior[x] + near_by[x]);
        else
            for (int x = 0; x < LANES; x++)
                prior[x] = (uint16_t)(prior[x] + ((uint32_t)near_by[x] * trust >> 16));
    }
}

/* What is expected of each surface. Where the taps are sure, the surface with the most
 * of them is given what the others leave. */
static void expect(uint16_t prior[RF_TAP_COUNT][LANES], const struct rf_cell *cell,
                   const struct rf_lie *lie, int from)
{
    const int rest = cell->sure ? cell->greatest : RF_TAP_COUNT;
    uint16_t left[LANES];

    memcpy(left, lie->all + from, sizeof left);
    for (int k = 0; k < cell->surfaces; k++) {
        if (k == rest)
            continue;
        add_taps(prior[k], cell, &cell->surface[k], lie, from);
        for (int x = 0; x < LANES; x++)
            left[x] = (uint16_t)(left[x] - prior[k][x]);
    }
    if (rest < RF_TAP_COUNT)
        memcpy(prior[rest], left, sizeof left);
}

static void height_of(uint16_t height[LANES], const struct rf_surface *surface,
                      const struct rf_lie *lie, int from)
{
    const int mean = surface->mean, right = surface->right, below = surface->below;
    const int low = surface->low, range = surface->range;
    const int16_t *restrict at_x = lie->x + from, *restrict at_y = lie->y + from;

    for (int x = 0; x < LANES; x++) {
        const int d =
            mean + ((right * at_x[x] + (1 << 14)) >> 15) + ((below * at_y[x] + (1 << 14)) >> 15);

        height[x] = (uint16_t)(low + (d < 0 ? 0 : d > range ? range : d));
    }
}

static void choose(uint16_t *restrict out, uint8_t *restrict sure, const struct rf_cell *cell,
                   const struct rf_window *window, const struct rf_lie *lie,
                   uint8_t *const colour[3], int from)
{
    const struct box box = box_of(colour);
    uint16_t best[LANES] = {0}, second[LANES] = {0}, prior[RF_TAP_COUNT][LANES];

    expect(prior, cell, lie, from);
    for (int x = 0; x < LANES; x++)
        out[x] = cell->surface[0].low;
    for (int k = 0; k < cell->surfaces; k++) {
        const struct rf_surface *s = &cell->surface[k];
        const uint16_t grow = s->grow, scale = s->scale;
        uint16_t alike[LANES], height[LANES];

        look(alike, colour, &box, window, s->samples);
        height_of(height, s, lie, from);
        for (int x = 0; x < LANES; x++) {
            const uint16_t mean = (uint16_t)((uint32_t)(uint16_t)(alike[x] * grow) * scale >> 16);
            const uint16_t evidence = (uint16_t)(4 * mean + RF_UNLIKE);
            const uint16_t score = (uint16_t)((uint32_t)prior[k][x] * evidence >> 16);
            const uint16_t less = score < best[x] ? score : best[x];

            out[x] = score > best[x] ? height[x] : out[x];
            second[x] = second[x] > less ? second[x] : less;
            best[x] = score > best[x] ? score : best[x];
        }
    }
    for (int x = 0; x < LANES; x++)
        sure[x] = best[x] / 4 > second[x] ? 255 : 0;
}

static void RF_VEC(rf_surface)(uint16_t out[RF_BATCH], uint8_t sure[RF_BATCH],
                               const struct rf_cell *cell, const struct rf_window *window,
                               const struct rf_lie *lie,
                               uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], int n)
{
    for (int x = 0; x < n; x += LANES) {
        uint8_t *const own[3] = {colour[0] + x, colour[1] + x, colour[2] + x};

        choose(out + x, sure + x, cell, window, lie, own, x);
    }
}

#endif

void RF_VEC(rf_choose_use)(struct rf_kernels *kernels)
{
    kernels->surface = RF_VEC(rf_surface);
}
