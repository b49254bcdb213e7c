/* thin_far.c: find_thin: computes F, the light of the background, for a batch of mixtures. */
#include "kernels/autovec/thin_parts.h"

#include <string.h>

static bool any_of(const uint16_t mask[BATCH])
{
    uint16_t any = 0;

    for (int x = 0; x < BATCH; x++)
        any |= mask[x];
    return any != 0;
}

static inline uint16_t is_there(uint16_t weight)
{
    return (uint16_t) - (weight != 0);
}

/* 0xffff: of one surface. */
static inline uint16_t same_surface(uint16_t a, uint16_t b)
{
    return (uint16_t)(rf_most16(a, b) - rf_least16(a, b)) <= 2 * JUMP ? 0xffff : 0;
}

static void add_same(uint16_t *restrict sum, const uint16_t *restrict weight,
                     const uint16_t *restrict a, const uint16_t *restrict b)
{
    for (int x = 0; x < BATCH; x++)
        sum[x] = (uint16_t)(sum[x] + (weight[x] & same_surface(a[x], b[x])));
}

/* Disparities that have weight, and of whose surface the sum is. */
static void prefer(uint16_t *restrict best, uint16_t *restrict best_sum,
                   const uint16_t *restrict disparity, const uint16_t *restrict weight,
                   const uint16_t *restrict sum)
{
    for (int x = 0; x < BATCH; x++) {
        const uint16_t own = sum[x] & is_there(weight[x]);
        const uint16_t more = own > best_sum[x] ? 0xffff : 0;
        const uint16_t equal = own == best_sum[x] ? 0xffff : 0;
        const uint16_t farther = disparity[x] < best[x] ? 0xffff : 0;
        const uint16_t better = more | (equal & farther);

        best_sum[x] = rf_most16(best_sum[x], own);
        best[x] = (uint16_t)((disparity[x] & better) | (best[x] & ~better));
    }
}

/* The disparity whose surface counts most, the farther of two equals. */
static void find_surface(struct rf_thin_mixture *m, const struct rf_thin_batch *b)
{
    uint16_t several[BATCH], best_sum[BATCH] = {0};

    for (int x = 0; x < BATCH; x++) {
        uint16_t least = 65535, most = 0;

        for (int i = 0; i < WAYS; i++) {
            const uint16_t there = is_there(b->weight[i][x]);

            least = rf_least16(least, (uint16_t)(b->disparity[i][x] | ~there));
            most = rf_most16(most, b->disparity[i][x] & there);
        }
        m->far[x] = least; /* where it is but one */
        several[x] = (uint16_t)(most > least ? ~same_surface(most, least) : 0);
    }
    if (!any_of(several))
        return;
    for (int i = 0; i < WAYS; i++) {
        uint16_t sum[BATCH] = {0};

        for (int k = 0; k < WAYS; k++)
            add_same(sum, b->weight[k], b->disparity[k], b->disparity[i]);
        prefer(m->far, best_sum, b->disparity[i], b->weight[i], sum);
    }
}

static void add_product(uint32_t *restrict sum, const uint16_t *restrict weight,
                        const uint16_t *restrict light)
{
    for (int x = 0; x < BATCH; x++)
        sum[x] += (uint32_t)weight[x] * light[x];
}

static void add_square(int32_t *restrict sum, const uint16_t *restrict weight,
                       const uint16_t *restrict light, const int32_t *restrict from)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t away = (light[x] - from[x]) & -(weight[x] != 0);

        sum[x] += away * away;
    }
}

/* Weights of one surface, and how many there are. */
static void keep_surface(struct rf_thin_batch *restrict b, const uint16_t *restrict far,
                         uint16_t *restrict weights, uint16_t *restrict count)
{
    for (int i = 0; i < WAYS; i++) {
        uint16_t *restrict weight = b->weight[i];
        const uint16_t *restrict disparity = b->disparity[i];

        for (int x = 0; x < BATCH; x++) {
            const uint16_t w = weight[x] & same_surface(disparity[x], far[x]);

            weight[x] = w;
            weights[x] = (uint16_t)(weights[x] + w);
            count[x] = (uint16_t)(count[x] - is_there(w));
        }
    }
}

static void mean_by_weight(int32_t *restrict mean, const uint32_t *restrict sum,
                           const uint16_t *restrict weights)
{
    for (int x = 0; x < BATCH; x++) {
        const uint32_t by = weights[x] ? weights[x] : 1, all = sum[x] + by / 2;

        mean[x] = quotient((float)(int32_t)all, all, by);
    }
}

/* contrast >= 2 (squares / count) + FAINT, or 8 times in place of 2 if it is not thin */
static void compare(int32_t *restrict mixed, const int32_t *restrict contrast,
                    const int32_t *restrict squares, const uint16_t *restrict count,
                    const uint16_t *restrict thin)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t half = (contrast[x] - FAINT) >> 1, most = thin[x] ? half : half >> 2;

        mixed[x] = squares[x] < (most + 1) * count[x] ? contrast[x] >= FAINT : 0;
    }
}

void RF_VEC(rf_thin_far)(struct rf_thin_mixture *m, struct rf_thin_batch *b)
{
    uint16_t weights[BATCH] = {0}, count[BATCH] = {0}, one[BATCH];
    int32_t squares[BATCH] = {0};

    find_surface(m, b);
    memset(one, 255, sizeof one);
    memset(m->contrast, 0, sizeof m->contrast);
    keep_surface(b, m->far, weights, count);
    for (int c = 0; c < 3; c++) {
        uint32_t sum[BATCH] = {0};

        for (int i = 0; i < WAYS; i++)
            add_product(sum, b->weight[i], b->hit[c][i]);
        mean_by_weight(m->far_light[c], sum, weights);
        for (int i = 0; i < WAYS; i++)
            add_square(squares, b->weight[i], b->hit[c][i], m->far_light[c]);
        add_square(m->contrast, one, b->light[c], m->far_light[c]);
    }
    compare(m->mixed, m->contrast, squares, count, b->thin);
}
