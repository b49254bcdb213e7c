/* weigh_planes_vec.h: the template of weigh, which multiplies light by the weights of eq. 5, some
 * tiles' rows at a time. */
#ifndef RF_KERNELS_WEIGH_PLANES_VEC_H
#define RF_KERNELS_WEIGH_PLANES_VEC_H

#include "colour/transfer.h"
#include "kernels/kernels.h"
#include "simd/vec.h"

/* Weights come out of a table, one by one. Those of so many tiles' rows are looked up before any is
 * used, as a vector of values that were just stored one by one would wait for them. */
enum { RF_WEIGH_TILES = 16, RF_WEIGH_RUN = RF_WEIGH_TILES * (int)RF_TILE };

/* The brightest light of each pixel of a run, white at most, and then its weight; that of the
 * background is set only where the background differs from what is seen. */
struct rf_weigh_run {
    uint16_t near[RF_WEIGH_RUN], far[RF_WEIGH_RUN];
    bool same[RF_WEIGH_TILES];
};

static inline void rf_look_up_tile(uint16_t *restrict v, const uint16_t *restrict light_weight)
{
#pragma GCC unroll 16
    for (int x = 0; x < RF_TILE; x++)
        v[x] = light_weight[v[x]];
}

static inline void rf_look_up_weights(struct rf_weigh_run *run, const uint16_t *light_weight,
                                      int tiles)
{
    for (int i = 0; i < tiles; i++) {
        rf_look_up_tile(run->near + i * RF_TILE, light_weight);
        if (!run->same[i])
            rf_look_up_tile(run->far + i * RF_TILE, light_weight);
    }
}

/* A weight in Q15 to Q12, and that in Q15 again. */
static inline vec_u16 rf_eighth(vec_u16 weight)
{
    return vec_u16_half(vec_u16_half(vec_u16_half(weight)));
}

static inline vec_u16 rf_whole_eighths(vec_u16 weight)
{
    return vec_u16_without(weight, vec_u16_set(7));
}

enum { RF_WEIGH_EACH = (int)RF_TILE / (int)VEC_U16 };

/* The brightest channels of a tile's row, white at most. Returns whether any exceeds 16383. */
static RF_ALWAYS_INLINE bool rf_weigh_look(uint16_t *most, uint16_t *const *light, int x,
                                           const int planes)
{
    vec_u16 large = vec_u16_set(0);

    for (int j = 0; j < RF_WEIGH_EACH; j++, x += (int)VEC_U16) {
        vec_u16 all = vec_u16_load(light[0] + x);

        for (int c = 1; c < planes; c++)
            all = vec_u16_max(all, vec_u16_load(light[c] + x));
        vec_u16_store(most + j * (int)VEC_U16, vec_u16_min(all, vec_u16_set(RF_LIGHT_MAX)));
        large = vec_u16_or(large, vec_u16_and(all, vec_u16_set(49152)));
    }
    return planes > 1 && vec_u16_any(large);
}

static RF_ALWAYS_INLINE bool rf_weigh_same(const struct rf_weigh_job *job, int x, const int planes)
{
    vec_u16 differ = vec_u16_set(0);

    for (int c = 0; c < planes; c++)
        for (int i = x; i < x + RF_TILE; i += (int)VEC_U16)
            differ = vec_u16_or(
                differ, vec_u16_xor(vec_u16_load(job->near[c] + i), vec_u16_load(job->far[c] + i)));
    return !vec_u16_any(differ);
}

/* Light of a tile's row by weights in Q15, which become those of the plane. Returns the greater of
 * `brightest` and that light. */
static RF_ALWAYS_INLINE vec_u16 rf_weigh_multiply(uint16_t *const *light, uint16_t *weight,
                                                  const uint16_t *fine, int x, vec_u16 brightest,
                                                  const bool large, const int planes)
{
    for (int end = x + RF_TILE; x < end; x += (int)VEC_U16, fine += VEC_U16) {
        const vec_u16 w = vec_u16_load(fine), eight = rf_whole_eighths(w);

        vec_u16_store(weight + x, rf_eighth(w));
        for (int c = 0; c < planes; c++) {
            const vec_u16 v = vec_u16_load(light[c] + x);
            const vec_u16 once = vec_s16_scale(v, eight);
            vec_u16 product = vec_s16_scale(vec_u16_add(v, v), eight);

            if (large)
                product = vec_u16_select(vec_u16_at_most(v, vec_u16_set(16383)), product,
                                         vec_u16_add(once, once));
            vec_u16_store(light[c] + x, product);
            brightest = vec_u16_max(brightest, product);
        }
    }
    return brightest;
}

static RF_ALWAYS_INLINE void rf_weigh_copy(const struct rf_weigh_job *job, int x, const int planes)
{
    for (int i = x; i < x + RF_TILE; i += (int)VEC_U16) {
        vec_u16_store(job->far_weight + i, vec_u16_load(job->near_weight + i));
        for (int c = 0; c < planes; c++)
            vec_u16_store(job->far[c] + i, vec_u16_load(job->near[c] + i));
    }
}

/* Whole tiles. Where the background is what is seen, so is its light times weight. */
static RF_ALWAYS_INLINE void rf_weigh_tiles(const struct rf_weigh_job *job, int first, int tiles,
                                            const int planes)
{
    struct rf_weigh_run run;
    bool large = false; /* highlights beyond four times white */

    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        run.same[i] = rf_weigh_same(job, x, planes);
        large |= rf_weigh_look(run.near + i * RF_TILE, job->near, x, planes);
        if (!run.same[i])
            large |= rf_weigh_look(run.far + i * RF_TILE, job->far, x, planes);
    }
    rf_look_up_weights(&run, job->light_weight, tiles);
    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        const uint16_t *near = run.near + i * RF_TILE, *far = run.far + i * RF_TILE;
        uint16_t *most = &job->brightest[x / RF_TILE], here;
        vec_u16 brightest = vec_u16_set(0);

        brightest =
            large
                ? rf_weigh_multiply(job->near, job->near_weight, near, x, brightest, true, planes)
                : rf_weigh_multiply(job->near, job->near_weight, near, x, brightest, false, planes);
        if (run.same[i])
            rf_weigh_copy(job, x, planes);
        else if (large)
            brightest =
                rf_weigh_multiply(job->far, job->far_weight, far, x, brightest, true, planes);
        else
            brightest =
                rf_weigh_multiply(job->far, job->far_weight, far, x, brightest, false, planes);
        here = vec_u16_greatest(brightest);
        *most = here > *most ? here : *most;
    }
}

/* n / RF_TILE whole tiles. */
static RF_ALWAYS_INLINE void rf_weigh_planes_vec(const struct rf_weigh_job *job, int n,
                                                 const int planes)
{
    const int whole = n / RF_TILE;

    for (int i = 0; i < whole; i += RF_WEIGH_TILES)
        rf_weigh_tiles(job, i * RF_TILE, whole - i < RF_WEIGH_TILES ? whole - i : RF_WEIGH_TILES,
                       planes);
}

#endif
