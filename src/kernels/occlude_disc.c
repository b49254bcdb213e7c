/* occlude_disc.c: finds which part of a highlight's disc nearer surfaces occlude. */
#include "kernels/kernels.h"
#include "support/compare.h"

static int go(const struct rf_disc_way *way, int v)
{
    return (v * (1 << way->shift) * way->times + (1 << (22 - way->unit))) >> (23 - way->unit);
}

void rf_occlude_disc_c(uint16_t *visible, const int16_t *blur, ptrdiff_t stride,
                       const struct rf_slab *slab, const struct rf_disc_job *job,
                       const struct rf_disc_way *way)
{
    const uint16_t low = rf_range_from(slab), to = rf_range_to(slab, slab);
    const int pixel = 64 >> job->unit;

    for (int i = 2 * RF_TILE * job->first; i < 2 * RF_TILE * job->end; i++) {
        const int y = i / RF_TILE / 2, x = i % RF_TILE, side = i / RF_TILE % 2 ? 1 : -1;
        const int like = y - (y - job->first) % way->rows;
        const int first = rf_larger(pixel * x + job->left[like], job->from);
        const int last = rf_smaller(pixel * x + job->right[like], job->to);
        const bool right = way->mirrored ? side < 0 : side > 0;
        const int aside =
            right ? (16 - way->aside) * (last - first) / 16 : -(way->aside * (last - first) / 16);
        const int whole = job->from + job->to - 2 * pixel * x;
        const int away =
            first < last ? first + last - 2 * pixel * x + aside
                         : rf_larger(rf_smaller(whole, 2 * job->right[like]), 2 * job->left[like]);
        const int down = go(way, pixel * way->middle - 2 * pixel * like + pixel / 2 * side);

        const int16_t hit = blur[(like + down) * stride + x + go(way, away)];

        visible[(side > 0 ? RF_TILE * RF_TILE : 0) + y * RF_TILE + x] =
            rf_in_range(low, to, hit) ? 0 : 0xffff;
    }
}
