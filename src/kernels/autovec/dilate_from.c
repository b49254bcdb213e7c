/* dilate_from.c: grey dilation of a row of blurs by a cone that comes from the row beside it. */
#include "kernels/kernels.h"
#include "kernels/lanes.h"

void RF_VEC(rf_dilate_from)(uint16_t *restrict row, const uint16_t *restrict before, int unit,
                            int n)
{
    const uint16_t straight = (uint16_t)rf_cone_fall(RF_CONE_STEP, unit);
    const uint16_t diagonal = (uint16_t)rf_cone_fall(RF_CONE_DIAGONAL, unit);

    for (int x = 0; x < n; x++) {
        const uint16_t slant = rf_subs16(rf_most16(before[x - 1], before[x + 1]), diagonal);

        row[x] = rf_most16(row[x], rf_most16(slant, rf_subs16(before[x], straight)));
    }
}
