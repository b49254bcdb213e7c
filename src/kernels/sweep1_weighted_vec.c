/* sweep1_weighted_vec.c: the sweep of one plane with weights, two vectors at a time,
 * two rays at once, each followed from behind to the front. */
#include "kernels/kernels.h"
#include "kernels/slab_vec.h"
#include "simd/vec.h"

enum { VECS = 2 };

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct state {
    const struct rf_sweep1_job *job;
    const int32_t (*offset)[RF_RAY_CHUNK], (*pixel)[RF_RAY_CHUNK];
    const uint16_t *const *last, *const *last_weight;
    uint8_t ray[RF_RAY_CHUNK]; /* those that count */
    int rays;
    ptrdiff_t at[VECS], pixel_at[VECS]; /* elements from the first, of light and of weights */
};

/* What one ray of each lane meets. */
struct met {
    vec_u16 light[VECS], weight[VECS];
};

static ALWAYS_INLINE void follow(struct met *met, const struct state *s, int n, const bool chroma)
{
    const struct rf_sorted_rays *rays = s->job->rays;

    for (int j = 0; j < VECS; j++) {
        met->light[j] = vec_u16_load(s->last[n] + s->at[j]);
        met->weight[j] = vec_u16_load(s->last_weight[n] + s->pixel_at[j]);
    }
    for (int t = rays->tests[n] - 1; t >= 0; t--) {
        const struct rf_limits limits = rf_limits_of(rays, t, n);

        for (int j = 0; j < VECS; j++) {
            const ptrdiff_t q = s->offset[t][n] + s->at[j];
            const vec_mask hit =
                rf_in_limits(vec_mask_all(), limits, vec_u16_load(s->job->blur + q));

            met->light[j] = vec_u16_load_where(hit, met->light[j], s->job->light + q);
            met->weight[j] = vec_u16_load_where(hit, met->weight[j],
                                                s->job->weight + s->pixel[t][n] + s->pixel_at[j]);
        }
    }
    for (int j = 0; chroma && j < VECS; j++)
        met->weight[j] = vec_u16_twice(met->weight[j]);
}

/* 32-bit sums hold twice as many products with weights as 16-bit ones hold values;
 * products of two are added signed: 2 * 16380 * 32767 < 2^31. */
static ALWAYS_INLINE void sweep_vectors(uint64_t *sum, uint64_t *weight_sum, const struct state *s,
                                        const bool chroma)
{
    const vec_u16 one = vec_u16_set(1);

    for (int i = 0, end; i < s->rays; i = end) {
        vec_u32 light[VECS], weight[VECS];

        for (int j = 0; j < VECS; j++)
            light[j] = weight[j] = vec_u32_zero();
        end = s->rays - i < 2 * s->job->steps ? s->rays : i + 2 * s->job->steps;
        for (int n = i; n < end; n += 2) {
            struct met a, b;

            follow(&a, s, s->ray[n], chroma);
            for (int j = 0; j < VECS; j++)
                b.light[j] = b.weight[j] = vec_u16_set(0);
            if (n + 1 < end)
                follow(&b, s, s->ray[n + 1], chroma);
            for (int j = 0; j < VECS; j++) {
                light[j] = vec_u32_add_products(light[j], a.light[j], a.weight[j], b.light[j],
                                                b.weight[j]);
                weight[j] = vec_u32_add_products(weight[j], a.weight[j], one, b.weight[j], one);
            }
        }
        for (int j = 0; j < VECS; j++) {
            vec_u32_add_to(sum + j * (int)VEC_U16, light[j]);
            vec_u32_add_to(weight_sum + j * (int)VEC_U16, weight[j]);
        }
    }
}

static void set_rays(struct state *s, const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    const bool chroma = job->chroma;

    s->job = job;
    s->offset = (const int32_t(*)[RF_RAY_CHUNK])(chroma ? rays->chroma_offset : rays->offset);
    s->pixel = (const int32_t(*)[RF_RAY_CHUNK])(chroma ? rays->chroma_weight_offset : rays->offset);
    s->last = (const uint16_t *const *)(chroma ? rays->chroma_last : rays->last);
    s->last_weight =
        (const uint16_t *const *)(chroma ? rays->chroma_last_weight : rays->last_weight);
    s->rays = 0;
    for (int tests = 0; tests < RF_SORTED_TESTS; tests++) {
        const int begin = rays->begin[tests];
        const int end = chroma ? begin + rays->shared[tests] : rays->begin[tests + 1];

        for (int n = begin; n < end; n++)
            s->ray[s->rays++] = (uint8_t)n;
    }
}

static void RF_VEC(rf_sweep1_weighted)(uint64_t *sum, uint64_t *weight,
                                       const struct rf_sweep1_job *job)
{
    const int half = job->rows / 2;
    struct state s;

    set_rays(&s, job);
    for (int i = 0; i < job->rows * RF_TILE; i += VECS * (int)VEC_U16) {
        for (int j = 0; j < VECS; j++) {
            const int lane = i + j * (int)VEC_U16, x = lane % RF_TILE, y = lane / RF_TILE;
            const ptrdiff_t row = y < half ? y * job->apart : job->half + (y - half) * job->apart;

            s.at[j] = row + x;
            s.pixel_at[j] = row * (1 << job->down) + x;
        }
        if (job->chroma)
            sweep_vectors(sum + i, weight + i, &s, true);
        else
            sweep_vectors(sum + i, weight + i, &s, false);
    }
}

void RF_VEC(rf_sweep1_weighted_use)(struct rf_kernels *kernels)
{
    kernels->sweep1_weighted = RF_VEC(rf_sweep1_weighted);
}
