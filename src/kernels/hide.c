#include "kernels/kernels.h"
#include "support/compare.h"

/* Of (1 << shift) v times, 2^-23, rounded. */
static int go(struct rf_disc_way way, int v)
{
    return (v * (1 << way.shift) * way.times + (1 << 22)) >> 23;
}

void rf_hide_c(uint16_t *visible, const int16_t *blur, ptrdiff_t stride,
               const struct rf_slab *slab, const struct rf_disc_job *job, int middle,
               struct rf_disc_way way)
{
    const uint16_t low = rf_range_from(slab), to = rf_range_to(slab, slab);

    for (int y = job->first; y < job->end; y++) {
        const int16_t *row = blur + (y + go(way, 128 * (middle - y))) * stride;

        for (int x = 0; x < RF_TILE; x++) {
            const int first = rf_larger(64 * x + job->left[y], job->from);
            const int last = rf_smaller(64 * x + job->right[y], job->to);
            const int at = x + (first < last ? go(way, first + last - 128 * x) : 0);

            if (rf_in_range(low, to, row[at]))
                visible[y * RF_TILE + x] = 0;
        }
    }
}
