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
    MOST_ROWS = 4 / EACH,               /* of a half, together */
    MOST_VECS = 2 * MOST_ROWS * EACH,
    FEW = 4, /* tests are too many for loops of their own */
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct state {
    const struct rf_sweep1_job *job;
    ptrdiff_t first;          /* element that the rows begin at */
    int end[RF_SORTED_TESTS]; /* of the rays of so many tests that count */
    const int32_t (*offset)[RF_RAY_CHUNK];
    const uint16_t *const *last;
};

/* Vector j from `first` on, of `rows` rows of each half. */
static ALWAYS_INLINE const uint16_t *
vector_at(const uint16_t *first, const struct state *s, int j, const int rows)
{
    const uint16_t *at = j < rows * EACH ? first : first + s->job->half;

    return at + j / EACH % rows * s->job->apart + j % EACH * (int)VEC_U16;
}

/* What ray n of `tests` tests sees, added. */
static ALWAYS_INLINE void sweep_ray(vec_u16 sum[MOST_VECS], const struct state *s,
                                    int n, const int tests, const int rows)
{
    const struct rf_sorted_rays *rays = s->job->rays;
    const uint16_t *const blur = (const uint16_t *)s->job->blur + s->first;
    const uint16_t *const light = s->job->light + s->first;
    const int vecs = 2 * rows * EACH;
    vec_u16 value[MOST_VECS];

    for (int j = 0; j < vecs; j++)
        value[j] = vec_u16_load(vector_at(s->last[n] + s->first, s, j, rows));
    for (int t = tests - 1; t >= 0; t--) {
        const struct rf_limits limits = rf_limits_of(rays, t, n);
        const ptrdiff_t q = s->offset[t][n];

        for (int j = 0; j < vecs; j++) {
            const vec_u16 seen = vec_u16_load(vector_at(blur + q, s, j, rows));

            value[j] = vec_u16_load_where(rf_in_limits(vec_mask_all(), limits, seen),
                                          value[j], vector_at(light + q, s, j, rows));
        }
    }
    for (int j = 0; j < vecs; j++)
        sum[j] = vec_u16_add(sum[j], value[j]);
}

static ALWAYS_INLINE void sweep_some(vec_u16 sum[MOST_VECS], const struct state *s,
                                     int first, int end, const int tests,
                                     const int rows)
{
    for (int n = first; n < end; n++)
        sweep_ray(sum, s, n, tests < FEW ? tests : s->job->rays->tests[n], rows);
}

/* Adds sums to those of 32 bits, whose second half begins at `half`, and clears them.
 */
static ALWAYS_INLINE void flush(uint32_t *first, uint32_t *second,
                                vec_u16 sum[MOST_VECS], const int rows)
{
    for (int j = 0; j < rows * EACH; j++) {
        vec_u16_add_to(first + j * (int)VEC_U16, sum[j]);
        vec_u16_add_to(second + j * (int)VEC_U16, sum[rows * EACH + j]);
        sum[j] = sum[rows * EACH + j] = vec_u16_set(0);
    }
}

/* All rays, at `rows` rows of each half, from row `row` of the first on. */
static ALWAYS_INLINE void sweep_rows(uint32_t *to, struct state *s, int row,
                                     const int rows)
{
    uint32_t *const first = to + row * RF_TILE;
    uint32_t *const second = first + s->job->rows / 2 * RF_TILE;
    vec_u16 sum[MOST_VECS];
    int left = s->job->steps;

    s->first = row * s->job->apart;
    for (int j = 0; j < 2 * rows * EACH; j++)
        sum[j] = vec_u16_set(0);
    for (int tests = 0; tests < RF_SORTED_TESTS; tests++) {
        for (int n = s->job->rays->begin[tests], end; n < s->end[tests]; n = end) {
            end = s->end[tests] < n + left ? s->end[tests] : n + left;
            switch (tests) {
            case 0:
                sweep_some(sum, s, n, end, 0, rows);
                break;
            case 1:
                sweep_some(sum, s, n, end, 1, rows);
                break;
            case 2:
                sweep_some(sum, s, n, end, 2, rows);
                break;
            case 3:
                sweep_some(sum, s, n, end, 3, rows);
                break;
            default:
                sweep_some(sum, s, n, end, FEW, rows);
            }
            left -= end - n;
            if (left == 0) {
                flush(first, second, sum, rows);
                left = s->job->steps;
            }
        }
    }
    if (left < s->job->steps)
        flush(first, second, sum, rows);
}

static void RF_VEC(rf_sweep1)(uint32_t *sum, const struct rf_sweep1_job *job)
{
    const int half = job->rows / 2;
    const struct rf_sorted_rays *rays = job->rays;
    struct state s;
    int row = 0;

    s.job = job;
    s.offset = (const int32_t(*)[RF_RAY_CHUNK])(job->chroma ? rays->chroma_offset
                                                            : rays->offset);
    s.last = (const uint16_t *const *)(job->chroma ? rays->chroma_last : rays->last);
    for (int tests = 0; tests < RF_SORTED_TESTS; tests++)
        s.end[tests] = job->chroma ? rays->begin[tests] + rays->shared[tests]
                                   : rays->begin[tests + 1];
    for (; row + MOST_ROWS <= half; row += MOST_ROWS)
        sweep_rows(sum, &s, row, MOST_ROWS);
#if defined(RF_VEC_AVX2) || defined(RF_VEC_AVX512)
    if (row + 3 <= half) {
        sweep_rows(sum, &s, row, 3);
        return;
    }
    for (; row + 2 <= half; row += 2)
        sweep_rows(sum, &s, row, 2);
#endif
    for (; row < half; row++)
        sweep_rows(sum, &s, row, 1);
}

void RF_VEC(rf_sweep1_use)(struct rf_kernels *kernels)
{
    kernels->sweep1 = RF_VEC(rf_sweep1);
}
