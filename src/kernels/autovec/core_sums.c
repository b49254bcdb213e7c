/* core_sums.c: the mean disparity of what is alike in a window. */
#include "kernels/kernels.h"

struct rf_core_sums RF_VEC(rf_core_sums)(const struct rf_core_window *w)
{
    const uint16_t least = w->least, most = w->most;
    struct rf_core_sums sums = {0, 0, 0};
    const int n = w->columns;

    for (int y = 0; y < w->rows; y++) {
        const uint16_t *restrict core = w->core + (ptrdiff_t)y * w->step * w->stride;
        const uint8_t *restrict nearness = w->nearness + y * w->nearness_stride;
        uint32_t value = 0, weight = 0, count = 0;

        for (int x = 0; x < n; x++) {
            const uint16_t d = core[x];
            const uint16_t alike = (uint16_t)(d >= least && d <= most ? 0xffff : 0);
            const uint16_t near_by = nearness[x] & alike;

            value += (uint32_t)near_by * d;
            weight += near_by;
            count += alike & 1;
        }
        sums.value += value;
        sums.weight += weight;
        sums.count += count;
    }
    return sums;
}
