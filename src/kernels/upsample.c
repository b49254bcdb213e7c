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

/* Weights of one sample for all pixels, in Q16. */
static void weigh(uint16_t *restrict weight, const struct rf_cell *cell, int i,
                  const struct rf_batch *batch, int n)
{
    const uint16_t *restrict c0 = batch->colour[0], *restrict c1 = batch->colour[1];
    const uint16_t *restrict c2 = batch->colour[2];
    const uint16_t *restrict across = batch->across[i % RF_TAPS];
    const uint16_t *restrict down = batch->down[i / RF_TAPS];
    const uint16_t s0 = cell->colour[0][i], s1 = cell->colour[1][i], s2 = cell->colour[2][i];
    const uint16_t trust = cell->trust[i];

    for (int x = 0; x < n; x++) {
        const uint16_t unlike = least((uint16_t)(apart(c0[x], s0) + apart(c1[x], s1) +
                                                 apart(c2[x], s2)), RF_UNLIKE);
        /* 1/255 at least: what is unlike everything goes by nearness */
        const uint16_t like = (uint16_t)(65535 - unlike * (65280 / RF_UNLIKE));
        const uint16_t alike = most((uint16_t)(((uint32_t)like * like) >> 16), 64);
        const uint16_t near_by = (uint16_t)(((uint32_t)across[x] * down[x]) >> 16);
        const uint16_t trusted = (uint16_t)(((uint32_t)near_by * trust) >> 16);

        weight[x] = (uint16_t)(((uint32_t)trusted * alike) >> 16);
    }
}

static void add(uint16_t *restrict total, uint32_t *restrict sum,
                const uint16_t *restrict weight, uint16_t above, int n)
{
    for (int x = 0; x < n; x++) {
        total[x] = (uint16_t)(total[x] + weight[x]);
        sum[x] += (uint32_t)weight[x] * above;
    }
}

static void choose(uint16_t *restrict best, uint32_t *restrict best_sum,
                   uint16_t *restrict best_low, const uint16_t *restrict total,
                   const uint32_t *restrict sum, uint16_t low, int n)
{
    for (int x = 0; x < n; x++) {
        best_sum[x] = total[x] > best[x] ? sum[x] : best_sum[x];
        best_low[x] = total[x] > best[x] ? low : best_low[x];
        best[x] = most(total[x], best[x]);
    }
}

static void RF_VEC(rf_cluster)(uint16_t out[RF_BATCH + RF_BATCH_SPARE],
                               const struct rf_cell *cell, const struct rf_batch *batch, int n)
{
    uint16_t weight[RF_SAMPLES][RF_BATCH], total[RF_BATCH], best[RF_BATCH];
    uint32_t sum[RF_BATCH], best_sum[RF_BATCH];
    const int whole = (n + 15) & ~15;

    for (int i = 0; i < RF_SAMPLES; i++)
        weigh(weight[i], cell, i, batch, whole);
    for (int x = 0; x < whole; x++) {
        best[x] = 0;
        best_sum[x] = 0;
        out[x] = cell->low[0];
    }
    for (int k = 0; k < cell->windows; k++) {
        const uint16_t low = cell->low[k], high = cell->high[k];

        for (int x = 0; x < whole; x++) {
            total[x] = 0;
            sum[x] = 0;
        }
        for (int i = 0; i < RF_SAMPLES; i++)
            if (low <= cell->disparity[i] && cell->disparity[i] <= high)
                add(total, sum, weight[i], (uint16_t)(cell->disparity[i] - low), whole);
        choose(best, best_sum, out, total, sum, low, whole);
    }
    for (int x = 0; x < n; x++)
        if (best_sum[x])
            out[x] = (uint16_t)(out[x] + (best_sum[x] + best[x] / 2u) / best[x]);
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
                               int n)
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
        out[x] = m[1];
    }
}

void RF_VEC(rf_upsample_use)(struct rf_kernels *kernels)
{
    kernels->blend4 = RF_VEC(rf_blend4);
    kernels->steps4 = RF_VEC(rf_steps4);
    kernels->cluster = RF_VEC(rf_cluster);
    kernels->median3 = RF_VEC(rf_median3);
}
