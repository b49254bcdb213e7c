/* surface_sums.c: how much of a window one surface covers, and what the rest of it is. */
#include "kernels/kernels.h"

enum { LANES = RF_VOTE_COLUMNS };

struct lanes {
    uint32_t own[LANES], all[LANES], other[LANES];
};

static inline void add_row(struct lanes *sums, const struct rf_surface_window *w, int x, int y)
{
    const uint16_t *restrict label = w->label + y * w->stride + x;
    const uint16_t *restrict weight = w->weight + y * w->weight_stride + x;
    const uint16_t surface = w->surface, most = w->most;

    for (int i = 0; i < LANES; i++) {
        const uint16_t d = label[i], off = (uint16_t)(d > surface ? d - surface : surface - d);
        const uint16_t is_own = (uint16_t)(off < most ? 0xffff : 0);

        sums->own[i] += weight[i] & is_own;
        sums->all[i] += weight[i];
        sums->other[i] += (uint32_t)(uint16_t)(weight[i] & (uint16_t)~is_own) * d;
    }
}

struct rf_surface_sums RF_VEC(rf_surface_sums)(const struct rf_surface_window *w)
{
    struct rf_surface_sums all = {0, 0, 0};

    for (int x = 0; x < w->columns; x += LANES) {
        struct lanes sums = {{0}, {0}, {0}};

        for (int y = 0; y < w->rows; y++)
            add_row(&sums, w, x, y);
        for (int i = 0; i < LANES; i++) {
            all.own += sums.own[i];
            all.all += sums.all[i];
            all.other += sums.other[i];
        }
    }
    return all;
}
