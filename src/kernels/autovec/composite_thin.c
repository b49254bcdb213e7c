/* composite_thin.c: composites the cells of thin structures over the means of a tile. */
#include "kernels/kernels.h"

/* A row of cells at the middles of pixels, those of a channel together. */
static void across_cells(int32_t out[4][RF_TILE], int32_t cell[RF_COVERAGE_CELLS][4])
{
    for (int x = 0; x < RF_TILE; x++) {
        const int at = 2 * x + 5, i = at >> 3, part = at & 7; /* eighths of a cell */

        for (int c = 0; c < 4; c++)
            out[c][x] =
                (cell[i][c] * (8 - part) + cell[i + 1][c] * part) >> (RF_COVERAGE_SHIFT + 3 - 8);
    }
}

/* All channels between two rows of cells. */
static void down_cells(int32_t *restrict out, const int32_t *restrict above,
                       const int32_t *restrict below, int part)
{
    for (int k = 0; k < 4 * RF_TILE; k++)
        out[k] = (above[k] * (8 - part) + below[k] * part) >> 8;
}

static void lay_row(uint16_t *restrict out, const int32_t *restrict light,
                    const int32_t *restrict cover)
{
    for (int x = 0; x < RF_TILE; x++) {
        const int32_t some = cover[x] < 0 ? 0 : cover[x];
        const uint32_t part = (uint32_t)(some > 32768 ? 32768 : some);
        const int32_t v = out[x] + (light[x] >> 1) - (int32_t)((out[x] * part + 16384) >> 15);

        out[x] = (uint16_t)(v < 0 ? 0 : v > 65535 ? 65535 : v);
    }
}

void RF_VEC(rf_composite_thin)(uint16_t *const mean[3],
                               int32_t cell[RF_COVERAGE_CELLS][RF_COVERAGE_CELLS][4])
{
    int32_t row[RF_COVERAGE_CELLS][4][RF_TILE];

    for (int i = 0; i < RF_COVERAGE_CELLS; i++)
        across_cells(row[i], cell[i]);
    for (int y = 0; y < RF_TILE; y++) {
        const int at = 2 * y + 5, i = at >> 3, part = at & 7;
        int32_t layer[4 * RF_TILE]; /* Q15 */

        down_cells(layer, row[i][0], row[i + 1][0], part);
        for (int c = 0; c < 3; c++)
            lay_row(mean[c] + y * RF_TILE, layer + c * RF_TILE, layer + 3 * RF_TILE);
    }
}
