/* part_taps.c: the depth upsampler: sorts the samples around each cell, and splits them into
 * surfaces. */
#include "kernels/kernels.h"
#include "kernels/lanes.h"
#include "kernels/sort_network.h"

#include <string.h>

enum { TAPS = RF_TAP_COUNT };

/* Cells side by side: a tap of them all lies in a row. */
static inline void order(uint16_t *restrict low, uint16_t *restrict high)
{
    for (int i = 0; i < RF_CELLS; i++) {
        const uint16_t a = low[i], b = high[i];

        low[i] = rf_least16(a, b);
        high[i] = rf_most16(a, b);
    }
}

static void sort(uint16_t sorted[TAPS][RF_CELLS])
{
    for (int i = 0; i < RF_EXCHANGES16; i++)
        order(sorted[rf_exchange16[i][0]], sorted[rf_exchange16[i][1]]);
}

void rf_part_taps_c(struct rf_parts *parts, const uint16_t *const row[RF_TAPS], int n)
{
    uint16_t low[RF_CELLS], starts[RF_CELLS];

    for (int t = 0; t < TAPS; t++) {
        memset(parts->sorted[t], 0, sizeof parts->sorted[t]);
        memcpy(parts->sorted[t], row[t / RF_TAPS] + t % RF_TAPS, (size_t)n * sizeof(uint16_t));
    }
    sort(parts->sorted);
    for (int i = 0; i < RF_CELLS; i++) {
        low[i] = parts->sorted[0][i];
        starts[i] = 1;
    }
    for (int t = 1; t < TAPS; t++) {
        const uint16_t *restrict last = parts->sorted[t - 1];
        const uint16_t *restrict d = parts->sorted[t];

        for (int i = 0; i < RF_CELLS; i++) {
            const uint16_t far_off =
                (uint16_t)((d[i] - last[i] > RF_GAP) | (d[i] - low[i] > RF_WIDEST));

            starts[i] = (uint16_t)(starts[i] | far_off << t);
            low[i] = far_off ? d[i] : low[i];
        }
    }
    memcpy(parts->starts, starts, sizeof starts);
}
