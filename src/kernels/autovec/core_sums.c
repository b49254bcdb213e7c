/* core_sums.c: the mean disparity of what is alike in a window. */
#include "kernels/kernels.h"

enum { LANES = RF_VOTE_COLUMNS };

struct lanes {
    uint16_t weight[LANES], count[LANES];
    uint32_t value[LANES];
};

static inline void add_row(struct lanes *sums, const struct rf_core_window *w, int x, int y)
{
    const uint16_t *restrict core = w->core + (ptrdiff_t)y * w->step * w->stride + x;
    const uint8_t *restrict nearness = w->nearness + y * w->nearness_stride + x;
    const uint16_t least = w->least, most = w->most;

    for (int i = 0; i < LANES; i++) {
        const uint16_t d = core[i];
        const uint16_t alike = (uint16_t)(d >= least && d <= most ? 0xffff : 0);
        const uint16_t near_by = nearness[i] & alike;

        sums->value[i] += (uint32_t)near_by * d;
        sums->weight[i] = (uint16_t)(sums->weight[i] + near_by);
        sums->count[i] = (uint16_t)(sums->count[i] + (near_by > 0));
    }
}

struct rf_core_sums RF_VEC(rf_core_sums)(const struct rf_core_window *w)
{
    struct rf_core_sums all = {0, 0, 0};

    for (int x = 0; x < w->columns; x += LANES) {
        struct lanes sums = {{0}, {0}, {0}};

        for (int y = 0; y < w->rows; y++)
            add_row(&sums, w, x, y);
        for (int i = 0; i < LANES; i++) {
            all.value += sums.value[i];
            all.weight += sums.weight[i];
            all.count += sums.count[i];
        }
    }
    return all;
}
