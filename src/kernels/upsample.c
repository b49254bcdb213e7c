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

/* Weights of the 16 samples for one pixel, in Q14 and smaller. */
static inline void weigh(uint16_t weight[restrict RF_SAMPLES],
                         const struct rf_cell *restrict cell,
                         const uint16_t across[restrict RF_SAMPLES],
                         const uint16_t down[restrict RF_SAMPLES], const uint8_t *const p[3],
                         ptrdiff_t at)
{
    const uint16_t c0 = p[0][at], c1 = p[1][at], c2 = p[2][at];

    for (int i = 0; i < RF_SAMPLES; i++) {
        const uint16_t unlike = least((uint16_t)(apart(cell->colour[0][i], c0) +
                                                 apart(cell->colour[1][i], c1) +
                                                 apart(cell->colour[2][i], c2)),
                                      RF_UNLIKE);
        const uint16_t like = (uint16_t)(65535 - unlike * (65536 / (RF_UNLIKE + 1)));
        const uint16_t near_by = (uint16_t)(((uint32_t)across[i] * down[i]) >> 16);
        const uint16_t trusted = (uint16_t)(((uint32_t)near_by * cell->trust[i]) >> 16);

        weight[i] = (uint16_t)(((uint32_t)trusted * like) >> 16);
    }
}

/* Mean of those in the window that weighs most; windows nearest to the lens come first. */
static inline uint16_t heaviest(const struct rf_cell *restrict cell,
                                const uint16_t weight[restrict RF_SAMPLES])
{
    uint16_t best = 0;
    int window = 0;
    int32_t sum = 0;

    for (int k = 0; k < cell->windows; k++) {
        const uint16_t *restrict in = cell->window[k].in;
        uint16_t total = 0;

        for (int i = 0; i < RF_SAMPLES; i++)
            total = (uint16_t)(total + (weight[i] & in[i]));
        window = total > best ? k : window;
        best = most(total, best);
    }
    if (best == 0)
        return cell->window[0].low;
    for (int i = 0; i < RF_SAMPLES; i++) {
        const int16_t above = cell->window[window].above[i];

        sum += (int16_t)weight[i] * above;
    }
    return (uint16_t)(cell->window[window].low +
                      ((uint32_t)sum + best / 2u) / (uint32_t)best);
}

static void RF_VEC(rf_cluster)(uint16_t *restrict out, const struct rf_cell *cell,
                               const uint16_t (*across)[RF_TAPS], const uint16_t down[RF_TAPS],
                               const uint8_t *const colour[3], int step, int n)
{
    uint16_t by_row[RF_SAMPLES];

    for (int i = 0; i < RF_SAMPLES; i++)
        by_row[i] = down[i / RF_TAPS];
    for (int x = 0; x < n; x++) {
        uint16_t by_column[RF_SAMPLES], weight[RF_SAMPLES];

        for (int i = 0; i < RF_SAMPLES; i++)
            by_column[i] = across[x][i % RF_TAPS];
        weigh(weight, cell, by_column, by_row, colour, (ptrdiff_t)x * step);
        out[x] = heaviest(cell, weight);
    }
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
