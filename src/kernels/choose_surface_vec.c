/* choose_surface_vec.c: the depth upsampler: chooses the surface that each pixel of a cell belongs
 * to, a vector of pixels at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum { ALIKE_TO = 8 }; /* where the table ends */

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
                            const struct rf_placement *placement, int x)
{
    vec_u16 sum[HALVES] = {vec_u16_set(0), vec_u16_set(0)};

    for (; taps; taps &= taps - 1) {
        const int t = __builtin_ctz(taps);

        for (int h = 0; h < HALVES; h++) {
            vec_u16 near_by = vec_u16_load(placement->near_by[t] + x + h * VEC_U16);

            if (!cell->sure)
                near_by = vec_u16_mul_high(near_by, vec_u16_set(cell->trust[t]));
            sum[h] = vec_u16_add(sum[h], near_by);
        }
    }
    for (int h = 0; h < HALVES; h++)
        prior[h] = sum[h];
}

/* The prior of each surface. Where the taps are sure, the surface with the most
 * of them is given what the others leave. */
static inline void expect(vec_u16 prior[RF_TAP_COUNT][HALVES], const struct rf_cell *cell,
                          const struct rf_placement *placement, int x)
{
    const int rest = cell->sure ? cell->greatest : RF_TAP_COUNT;
    vec_u16 left[HALVES];

    for (int h = 0; h < HALVES; h++)
        left[h] = vec_u16_load(placement->all + x + h * VEC_U16);
    for (int k = 0; k < cell->surfaces; k++) {
        if (k == rest)
            continue;
        add_taps(prior[k], cell, cell->surface[k].taps, placement, x);
        for (int h = 0; h < HALVES; h++)
            left[h] = vec_u16_sub(left[h], prior[k][h]);
    }
    for (int h = 0; h < HALVES && rest < RF_TAP_COUNT; h++)
        prior[rest][h] = left[h];
}

static inline vec_u16 height_of(const struct rf_surface *surface,
                                const struct rf_placement *placement, int x)
{
    vec_u16 d = vec_u16_set((uint16_t)surface->mean);

    d = vec_u16_add(
        d, vec_s16_scale(vec_u16_set((uint16_t)surface->right), vec_u16_load(placement->x + x)));
    d = vec_u16_add(
        d, vec_s16_scale(vec_u16_set((uint16_t)surface->below), vec_u16_load(placement->y + x)));
    d = vec_u16_min(vec_s16_max(d, vec_u16_set(0)), vec_u16_set(surface->range));
    return vec_u16_add(d, vec_u16_set(surface->low));
}

/* Scores of VEC_U8 pixels: the best and its disparity, and the second. */
struct found {
    vec_u16 best[HALVES], second[HALVES], disparity[HALVES];
};

static inline void weigh(struct found *found, const struct rf_surface *s,
                         const struct rf_placement *placement, int x, const vec_u16 prior[HALVES],
                         const uint16_t alike[VEC_U8])
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
                                             height_of(s, placement, x + h * VEC_U16));
        found->second[h] = vec_u16_max(found->second[h], vec_u16_min(best, score));
        found->best[h] = vec_u16_max(best, score);
    }
}

void RF_VEC(rf_choose_surface)(uint16_t out[RF_BATCH], uint8_t sure[RF_BATCH],
                               const struct rf_cell *cell, const struct rf_window *window,
                               const struct rf_placement *placement,
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
        expect(prior, cell, placement, x);
        for (int k = 0; k < cell->surfaces; k++) {
            uint16_t alike[VEC_U8];

            look(alike, own, window->colour, cell->surface[k].samples & near_by);
            weigh(&found, &cell->surface[k], placement, x, prior[k], alike);
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
