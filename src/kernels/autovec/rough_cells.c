/* rough_cells.c: the depth upsampler: finds the cells of a coarse map with a depth edge among their
 * samples. */
#include "kernels/kernels.h"
#include "kernels/lanes.h"

unsigned RF_VEC(rf_rough_cells)(uint8_t rough[RF_CELLS], const uint16_t *const row[RF_TAPS],
                                const uint8_t *const trust[RF_TAPS], int step, int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];
    uint16_t across[RF_CELLS + RF_TAPS], down[RF_CELLS + RF_TAPS];
    uint16_t across_inner[RF_CELLS + RF_TAPS], down_inner[RF_CELLS + RF_TAPS];
    uint8_t any = 0;

    for (int x = 0; x < n + RF_TAPS - 1; x++) {
        down_inner[x] = rf_apart16(b[x], c[x]);
        down[x] =
            rf_most16(rf_most16(rf_apart16(a[x], b[x]), down_inner[x]), rf_apart16(c[x], d[x]));
    }
    for (int x = 0; x < n + RF_TAPS - 2; x++) {
        across_inner[x] = rf_most16(rf_apart16(b[x], b[x + 1]), rf_apart16(c[x], c[x + 1]));
        across[x] = rf_most16(rf_most16(rf_apart16(a[x], a[x + 1]), across_inner[x]),
                              rf_apart16(d[x], d[x + 1]));
    }
    if (trust[0])
        for (int x = 0; x < n + RF_TAPS - 1; x++) {
            const uint8_t inner = trust[1][x] & trust[2][x];

            down_inner[x] = inner != 255 ? 65535 : down_inner[x];
            down[x] = (inner & trust[0][x] & trust[3][x]) != 255 ? 65535 : down[x];
        }
    for (int x = 0; x < n; x++) {
        const uint16_t right =
            rf_most16(rf_most16(across_inner[x], across[x + 1]), across_inner[x + 2]);
        const uint16_t below = rf_most16(rf_most16(down_inner[x], down[x + 1]),
                                         rf_most16(down[x + 2], down_inner[x + 3]));

        const uint16_t right_all = rf_most16(rf_most16(across[x], across[x + 1]), across[x + 2]);
        const uint16_t below_all =
            rf_most16(rf_most16(down[x], down[x + 1]), rf_most16(down[x + 2], down[x + 3]));
        const uint8_t is_rough = rf_most16(right, below) > step;

        rough[x] = is_rough                                 ? RF_ROUGH
                   : rf_most16(right_all, below_all) > step ? RF_ROUGH_CORNER
                                                            : 0;
        any |= rough[x];
    }
    return any;
}
