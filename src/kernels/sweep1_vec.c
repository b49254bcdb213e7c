/* sweep1_vec.c: the sweep of one plane, a few rows of both halves of a tile at a time,
 * sums in registers.
 *
 * A ray is followed from behind to the front: each slab overwrites what lies behind it
 * where it is hit, so that one addition a ray is left.
 */
#include "kernels/kernels.h"
#include "kernels/slab_vec.h"
#include "simd/vec.h"

enum {
    EACH = (int)RF_TILE / (int)VEC_U16, /* vectors of a row */
    MOST_ROWS = 4 / EACH,               /* of a half, together, */
    WEIGHTED_ROWS = 2 / EACH,           /* with weights */
    MOST_VECS = 2 * MOST_ROWS * EACH,
    FEW = 4, /* tests are too many for loops of their own */
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

/* Rows of a plane, elements apart. */
struct layout {
    ptrdiff_t apart, half;
    ptrdiff_t first; /* of those that are at work */
};

struct state {
    const struct rf_sweep1_job *job;
    struct layout light, weight;
    int end[RF_SORTED_TESTS]; /* of the rays of so many tests that count */
    const int32_t (*offset)[RF_RAY_CHUNK], (*pixel)[RF_RAY_CHUNK];
    const uint16_t *const *last, *const *last_weight;
};

/* Sums of light and of weights. */
struct sums {
    vec_u16 light[MOST_VECS], weight[MOST_VECS];
};

/* Vector j from `first` on, of `rows` rows of each half. */
static ALWAYS_INLINE const uint16_t *vector_at(const uint16_t *first, const struct layout *layout,
                                               int j, const int rows)
{
    const uint16_t *at = j < rows * EACH ? first : first + layout->half;

    return at + j / EACH % rows * layout->apart + j % EACH * (int)VEC_U16;
}

/* What ray n of `tests` tests sees, added. */
static ALWAYS_INLINE void sweep_ray(struct sums *sums, const struct state *s, int n,
                                    const int tests, const int rows, const bool weighted)
{
    const struct rf_sorted_rays *rays = s->job->rays;
    const uint16_t *const blur = (const uint16_t *)s->job->blur + s->light.first;
    const uint16_t *const light = s->job->light + s->light.first;
    const uint16_t *const weight = weighted ? s->job->weight + s->weight.first : NULL;
    const int vecs = 2 * rows * EACH;
    vec_u16 value[MOST_VECS], times[MOST_VECS];

    for (int j = 0; j < vecs; j++)
        value[j] = vec_u16_load(vector_at(s->last[n] + s->light.first, &s->light, j, rows));
    for (int j = 0; weighted && j < vecs; j++)
        times[j] =
            vec_u16_load(vector_at(s->last_weight[n] + s->weight.first, &s->weight, j, rows));
    for (int t = tests - 1; t >= 0; t--) {
        const struct rf_limits limits = rf_limits_of(rays, t, n);
        const ptrdiff_t q = s->offset[t][n], p = weighted ? s->pixel[t][n] : 0;

        for (int j = 0; j < vecs; j++) {
            const vec_u16 seen = vec_u16_load(vector_at(blur + q, &s->light, j, rows));
            const vec_mask hit = rf_in_limits(vec_mask_all(), limits, seen);

            value[j] = vec_u16_load_where(hit, value[j], vector_at(light + q, &s->light, j, rows));
            if (weighted)
                times[j] =
                    vec_u16_load_where(hit, times[j], vector_at(weight + p, &s->weight, j, rows));
        }
    }
    for (int j = 0; j < vecs; j++) {
        sums->light[j] = vec_u16_add(sums->light[j], value[j]);
        if (weighted)
            sums->weight[j] = vec_u16_add(sums->weight[j], times[j]);
    }
}

static ALWAYS_INLINE void sweep_some(struct sums *sums, const struct state *s, int first, int end,
                                     const int tests, const int rows, const bool weighted)
{
    for (int n = first; n < end; n++)
        sweep_ray(sums, s, n, tests < FEW ? tests : s->job->rays->tests[n], rows, weighted);
}

/* Adds sums to those of 32 bits, whose second half begins at `half`, and clears them.
 */
static ALWAYS_INLINE void flush(uint32_t *first, uint32_t *second, vec_u16 sum[MOST_VECS],
                                const int rows)
{
    for (int j = 0; j < rows * EACH; j++) {
        vec_u16_add_to(first + j * (int)VEC_U16, sum[j]);
        vec_u16_add_to(second + j * (int)VEC_U16, sum[rows * EACH + j]);
        sum[j] = sum[rows * EACH + j] = vec_u16_set(0);
    }
}

/* Where sums of a plane go; of the second half's rows `half` elements on. */
struct target {
    uint32_t *light, *weight;
    ptrdiff_t half;
};

static ALWAYS_INLINE void flush_all(const struct target *to, struct sums *sums,
                                    const struct state *s, const int rows, const bool weighted)
{
    flush(to->light, to->light + to->half, sums->light, rows);
    if (!weighted)
        return;
    for (int j = 0; s->job->chroma && j < 2 * rows * EACH; j++)
        sums->weight[j] = vec_u16_twice(sums->weight[j]);
    flush(to->weight, to->weight + to->half, sums->weight, rows);
}

/* All rays, at `rows` rows of each half. */
static ALWAYS_INLINE void sweep_rows(const struct target *to, const struct state *s, const int rows,
                                     const bool weighted)
{
    struct sums sums;
    int left = s->job->steps;

    for (int j = 0; j < 2 * rows * EACH; j++)
        sums.light[j] = vec_u16_set(0);
    for (int j = 0; weighted && j < 2 * rows * EACH; j++)
        sums.weight[j] = vec_u16_set(0);
    for (int tests = 0; tests < RF_SORTED_TESTS; tests++) {
        for (int n = s->job->rays->begin[tests], end; n < s->end[tests]; n = end) {
            end = s->end[tests] < n + left ? s->end[tests] : n + left;
            switch (tests) {
            case 0:
                sweep_some(&sums, s, n, end, 0, rows, weighted);
                break;
            case 1:
                sweep_some(&sums, s, n, end, 1, rows, weighted);
                break;
            case 2:
                sweep_some(&sums, s, n, end, 2, rows, weighted);
                break;
            case 3:
                sweep_some(&sums, s, n, end, 3, rows, weighted);
                break;
            default:
                sweep_some(&sums, s, n, end, FEW, rows, weighted);
            }
            left -= end - n;
            if (left == 0) {
                flush_all(to, &sums, s, rows, weighted);
                left = s->job->steps;
            }
        }
    }
    if (left < s->job->steps)
        flush_all(to, &sums, s, rows, weighted);
}

static ALWAYS_INLINE void sweep_from(uint32_t *sum, uint32_t *weight_sum, struct state *s, int row,
                                     const int rows, const bool weighted)
{
    const struct target to = {sum + row * RF_TILE, weighted ? weight_sum + row * RF_TILE : NULL,
                              s->job->rows / 2 * RF_TILE};

    s->light.first = row * s->light.apart;
    s->weight.first = row * s->weight.apart;
    sweep_rows(&to, s, rows, weighted);
}

static ALWAYS_INLINE void sweep_plain(uint32_t *sum, struct state *s)
{
    const int half = s->job->rows / 2;
    int row = 0;

    for (; row + MOST_ROWS <= half; row += MOST_ROWS)
        sweep_from(sum, NULL, s, row, MOST_ROWS, false);
#if defined(RF_VEC_AVX2) || defined(RF_VEC_AVX512)
    if (row + 3 <= half) {
        sweep_from(sum, NULL, s, row, 3, false);
        return;
    }
    for (; row + 2 <= half; row += 2)
        sweep_from(sum, NULL, s, row, 2, false);
#endif
    for (; row < half; row++)
        sweep_from(sum, NULL, s, row, 1, false);
}

static ALWAYS_INLINE void sweep_with_weights(uint32_t *sum, uint32_t *weight_sum, struct state *s)
{
    const int half = s->job->rows / 2;
    int row = 0;

    for (; row + WEIGHTED_ROWS <= half; row += WEIGHTED_ROWS)
        sweep_from(sum, weight_sum, s, row, WEIGHTED_ROWS, true);
    for (; row < half; row++)
        sweep_from(sum, weight_sum, s, row, 1, true);
}

static void RF_VEC(rf_sweep1)(uint32_t *sum, uint32_t *weight_sum, const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    const int down = job->down;
    const bool chroma = job->chroma;
    struct state s = {
        .job = job,
        .light = {job->apart, job->half, 0},
        .weight = {job->apart * (1 << down), job->half * (1 << down), 0},
        .offset = (const int32_t(*)[RF_RAY_CHUNK])(chroma ? rays->chroma_offset : rays->offset),
        .pixel =
            (const int32_t(*)[RF_RAY_CHUNK])(chroma ? rays->chroma_weight_offset : rays->offset),
        .last = (const uint16_t *const *)(chroma ? rays->chroma_last : rays->last),
        .last_weight =
            (const uint16_t *const *)(chroma ? rays->chroma_last_weight : rays->last_weight),
    };

    for (int tests = 0; tests < RF_SORTED_TESTS; tests++)
        s.end[tests] = chroma ? rays->begin[tests] + rays->shared[tests] : rays->begin[tests + 1];
    if (weight_sum)
        sweep_with_weights(sum, weight_sum, &s);
    else
        sweep_plain(sum, &s);
}

void RF_VEC(rf_sweep1_use)(struct rf_kernels *kernels)
{
    kernels->sweep1 = RF_VEC(rf_sweep1);
}
