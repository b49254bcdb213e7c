/* cells.c: finds the least and the greatest blur of cells of 4 x 4 pixels. */
#include "kernels/kernels.h"
#include "kernels/autovec/cell_runs.h"

/* Columns first; then the least of four beside each other, of which every fourth counts. */
static void cells_run(int16_t *restrict least, int16_t *restrict most, const int16_t *restrict blur,
                      ptrdiff_t stride, int n)
{
    int16_t low[RF_CELL * RF_CELL_RUN + 4], high[RF_CELL * RF_CELL_RUN + 4];
    const int16_t *restrict a = blur, *restrict b = a + stride, *restrict c = b + stride,
                            *restrict d = c + stride;

    for (int x = 0; x < RF_CELL * n; x++) {
        low[x] = rf_lesser(rf_lesser(a[x], b[x]), rf_lesser(c[x], d[x]));
        high[x] = rf_greater(rf_greater(a[x], b[x]), rf_greater(c[x], d[x]));
    }
    for (int i = 0; i < n; i++) {
        const int16_t *l = low + RF_CELL * i, *h = high + RF_CELL * i;

        least[i] = rf_lesser(rf_lesser(l[0], l[1]), rf_lesser(l[2], l[3]));
        most[i] = rf_greater(rf_greater(h[0], h[1]), rf_greater(h[2], h[3]));
    }
}

void RF_VEC(rf_cells)(int16_t *least, int16_t *most, const int16_t *blur, ptrdiff_t stride, int n)
{
    for (int i = 0; i < n; i += RF_CELL_RUN)
        cells_run(least + i, most + i, blur + RF_CELL * i, stride,
                  n - i < RF_CELL_RUN ? n - i : RF_CELL_RUN);
}
