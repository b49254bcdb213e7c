/* upsample.c: the loops of the depth upsampler, written for the compiler's vectoriser.
 *
 * Compiled once as plain C and once for each instruction set, like rows.c.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

static inline uint16_t least(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

static inline uint16_t most(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static inline uint16_t apart(uint16_t a, uint16_t b)
{
    return (uint16_t)(most(a, b) - least(a, b));
}

static void RF_VEC(rf_blend4)(uint16_t *restrict out, const uint16_t *const row[4],
                              const uint16_t weight[4], int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];
    const uint32_t wa = weight[0], wb = weight[1], wc = weight[2], wd = weight[3];

    for (int x = 0; x < n; x++)
        out[x] = (uint16_t)((a[x] * wa + b[x] * wb + c[x] * wc + d[x] * wd + (1 << 15)) >> 16);
}

static void RF_VEC(rf_steps4)(uint16_t *restrict across, uint16_t *restrict down,
                              const uint16_t *const row[4], int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];

    for (int x = 0; x < n; x++) {
        across[x] = most(most(apart(a[x], a[x + 1]), apart(b[x], b[x + 1])),
                         most(apart(c[x], c[x + 1]), apart(d[x], d[x + 1])));
        down[x] = most(most(apart(a[x], b[x]), apart(b[x], c[x])), apart(c[x], d[x]));
    }
}

/* How alike n pixels and the samples of a surface are. */
static void add_alike(uint16_t alike[RF_BATCH], const struct rf_cell *cell,
                      const struct rf_surface *surface, const struct rf_batch *batch, int n)
{
#if defined(RF_VECTORS)
    const vec_u8 table = vec_u8_table(rf_likeness), most_like = vec_u8_set(31);

    for (int x = 0; x < n; x += VEC_U8) {
        const vec_u8 c0 = vec_u8_load(batch->colour[0] + x);
        const vec_u8 c1 = vec_u8_load(batch->colour[1] + x);
        const vec_u8 c2 = vec_u8_load(batch->colour[2] + x);
        vec_u16 sum[2] = {vec_u16_set(0), vec_u16_set(0)};

        for (int k = 0; k < surface->samples; k++) {
            const int i = surface->sample[k];
            const vec_u8 d0 = vec_u8_absdiff(c0, vec_u8_set(cell->colour[0][i]));
            const vec_u8 d1 = vec_u8_absdiff(c1, vec_u8_set(cell->colour[1][i]));
            const vec_u8 d2 = vec_u8_absdiff(c2, vec_u8_set(cell->colour[2][i]));
            const vec_u8 like = vec_u8_subs(most_like, vec_u8_adds(vec_u8_adds(d0, d1), d2));

            vec_u8_add_wide(sum, vec_u8_lookup(table, vec_u8_half(like)));
        }
        vec_u8_store_wide(alike + x, sum);
    }
#else
    for (int x = 0; x < n; x++)
        alike[x] = 0;
    for (int k = 0; k < surface->samples; k++) {
        const int i = surface->sample[k];
        const uint8_t s0 = cell->colour[0][i], s1 = cell->colour[1][i];
        const uint8_t s2 = cell->colour[2][i];

        for (int x = 0; x < n; x++) {
            const uint16_t unlike = (uint16_t)(apart(batch->colour[0][x], s0) +
                                               apart(batch->colour[1][x], s1) +
                                               apart(batch->colour[2][x], s2));
            const uint16_t like = (uint16_t)((31 - least(unlike, 31)) / 2 * 2 + 1);
            const uint16_t square = (uint16_t)(like * like << 2);

            alike[x] = (uint16_t)(alike[x] + (((uint32_t)square * square) >> 16));
        }
    }
#endif
}

/* Nearness times likeness. */
static void weigh(uint16_t *restrict score, const uint16_t *restrict alike,
                  const struct rf_surface *surface, const struct rf_batch *batch, int n)
{
#if defined(RF_VECTORS)
    const vec_u16 grow = vec_u16_set(surface->grow), scale = vec_u16_set(surface->scale);
    const vec_u16 unlike = vec_u16_set(RF_UNLIKE), four = vec_u16_set(4);

    for (int x = 0; x < n; x += VEC_U16) {
        vec_u16 prior = vec_u16_set(0), mean;

        for (int k = 0; k < surface->taps; k++) {
            const int tap = surface->tap[k];
            const vec_u16 near_by = vec_u16_mul_high(vec_u16_load(batch->across[tap % RF_TAPS] + x),
                                                     vec_u16_load(batch->down[tap / RF_TAPS] + x));

            prior = vec_u16_add(prior, vec_u16_mul_high(near_by, vec_u16_set(surface->trust[k])));
        }
        mean = vec_u16_mul_high(vec_u16_mul(vec_u16_load(alike + x), grow), scale);
        mean = vec_u16_add(vec_u16_mul(mean, four), unlike);
        vec_u16_store(score + x, vec_u16_mul_high(prior, mean));
    }
#else
    for (int x = 0; x < n; x++)
        score[x] = 0;
    for (int k = 0; k < surface->taps; k++) {
        const uint16_t *across = batch->across[surface->tap[k] % RF_TAPS];
        const uint16_t *down = batch->down[surface->tap[k] / RF_TAPS];
        const uint16_t trust = surface->trust[k];

        for (int x = 0; x < n; x++) {
            const uint16_t near_by = (uint16_t)(((uint32_t)across[x] * down[x]) >> 16);

            score[x] = (uint16_t)(score[x] + (((uint32_t)near_by * trust) >> 16));
        }
    }
    for (int x = 0; x < n; x++) {
        const uint16_t grown = (uint16_t)(alike[x] * surface->grow);
        const uint16_t mean = (uint16_t)(((uint32_t)grown * surface->scale) >> 16);
        const uint16_t evidence = (uint16_t)(4 * mean + RF_UNLIKE);

        score[x] = (uint16_t)(((uint32_t)score[x] * evidence) >> 16);
    }
#endif
}

static void choose(uint16_t *restrict out, uint16_t *restrict best, uint16_t *restrict second,
                   const uint16_t *restrict score, const struct rf_surface *surface,
                   const struct rf_batch *batch, int n)
{
    const int32_t mean = surface->mean, right = surface->right, below = surface->below;
    const int32_t low = surface->low, high = surface->high;
    const int16_t *restrict at_x = batch->x, *restrict at_y = batch->y;

    for (int x = 0; x < n; x++) {
        const int32_t on = mean + ((right * at_x[x] + below * at_y[x]) >> 15);
        const int32_t d = on < low ? low : on > high ? high : on;

        out[x] = score[x] > best[x] ? (uint16_t)d : out[x];
        second[x] = most(second[x], least(best[x], score[x]));
        best[x] = most(best[x], score[x]);
    }
}

static void RF_VEC(rf_surface)(uint16_t out[RF_BATCH], uint8_t sure[RF_BATCH],
                               const struct rf_cell *cell, const struct rf_batch *batch, int n)
{
    uint16_t alike[RF_BATCH], score[RF_BATCH], best[RF_BATCH] = {0}, second[RF_BATCH] = {0};
    const int whole = (n + 31) & ~31;

    for (int x = 0; x < whole; x++)
        out[x] = cell->surface[0].low;
    for (int k = 0; k < cell->surfaces; k++) {
        add_alike(alike, cell, &cell->surface[k], batch, whole);
        weigh(score, alike, &cell->surface[k], batch, whole);
        choose(out, best, second, score, &cell->surface[k], batch, whole);
    }
    for (int x = 0; x < whole; x++)
        sure[x] = best[x] / 4 > second[x] ? 255 : 0;
}

static inline void order(uint16_t *restrict a, uint16_t *restrict b)
{
    const uint16_t low = least(*a, *b), high = most(*a, *b);

    *a = low;
    *b = high;
}

/* Columns sorted, the median is that of: the greatest low, the middle of the middles, the
 * least high. */
static void RF_VEC(rf_median3)(uint16_t *restrict out, const uint16_t *restrict before,
                               const uint16_t *restrict row, const uint16_t *restrict after,
                               const uint8_t *restrict sure, int n)
{
    for (int x = 0; x < n; x++) {
        uint16_t l[3], m[3], h[3];

        for (int i = 0; i < 3; i++) {
            l[i] = before[x + i - 1];
            m[i] = row[x + i - 1];
            h[i] = after[x + i - 1];
            order(&l[i], &m[i]);
            order(&m[i], &h[i]);
            order(&l[i], &m[i]);
        }
        l[0] = most(most(l[0], l[1]), l[2]);
        h[0] = least(least(h[0], h[1]), h[2]);
        order(&m[0], &m[1]);
        order(&m[1], &m[2]);
        order(&m[0], &m[1]);
        order(&l[0], &m[1]);
        order(&m[1], &h[0]);
        order(&l[0], &m[1]);
        out[x] = sure[x] ? row[x] : m[1];
    }
}

void RF_VEC(rf_upsample_use)(struct rf_kernels *kernels)
{
    kernels->blend4 = RF_VEC(rf_blend4);
    kernels->steps4 = RF_VEC(rf_steps4);
    kernels->surface = RF_VEC(rf_surface);
    kernels->median3 = RF_VEC(rf_median3);
}
