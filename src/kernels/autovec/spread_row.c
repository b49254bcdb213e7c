/* spread_row.c: grey dilation of a row of blurs by a cone, to both sides. */
#include "kernels/kernels.h"
#include "kernels/lanes.h"

#include <string.h>

static void spread(uint16_t *restrict out, const uint16_t *restrict in, int step, uint16_t fall,
                   int n)
{
    for (int x = 0; x < n; x++)
        out[x] = rf_most16(in[x], rf_subs16(rf_most16(in[x - step], in[x + step]), fall));
}

uint16_t *RF_VEC(rf_spread_row)(uint16_t *row, uint16_t *spare, int reach, int unit, int n)
{
    for (int step = 1, sum = 0; sum < reach; sum += step, step *= 2) {
        uint16_t *const last = row;

        memset(row - step, 0, (size_t)step * 2);
        memset(row + n, 0, (size_t)step * 2);
        spread(spare, row, step, (uint16_t)(step * rf_cone_fall(RF_CONE_STEP, unit)), n);
        row = spare;
        spare = last;
    }
    return row;
}
