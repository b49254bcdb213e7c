/* foreground.c: finds the greatest blur of the foreground in cells of 4 x 4 pixels. */
#include "kernels/kernels.h"
#include "kernels/autovec/cell_runs.h"

/* The blur of a pixel that is foreground. */
static inline int16_t in_front(int16_t blur, int16_t background_blur)
{
    return (int16_t)((uint16_t)(blur ^ background_blur) <= RF_INPAINTED ? RF_NO_BLUR : blur);
}

static void foreground_run(int16_t *restrict most, const int16_t *restrict blur,
                           const int16_t *restrict background_blur, ptrdiff_t stride, int n)
{
    int16_t high[RF_CELL * RF_CELL_RUN + 4];

    for (int x = 0; x < RF_CELL * n; x++) {
        const int16_t a = in_front(blur[x], background_blur[x]);
        const int16_t b = in_front(blur[x + stride], background_blur[x + stride]);
        const int16_t c = in_front(blur[x + 2 * stride], background_blur[x + 2 * stride]);
        const int16_t d = in_front(blur[x + 3 * stride], background_blur[x + 3 * stride]);

        high[x] = rf_greater(rf_greater(a, b), rf_greater(c, d));
    }
    for (int i = 0; i < n; i++) {
        const int16_t *h = high + RF_CELL * i;

        most[i] = rf_greater(rf_greater(h[0], h[1]), rf_greater(h[2], h[3]));
    }
}

void RF_VEC(rf_foreground)(int16_t *most, const int16_t *blur, const int16_t *background_blur,
                           ptrdiff_t stride, int n)
{
    for (int i = 0; i < n; i += RF_CELL_RUN)
        foreground_run(most + i, blur + RF_CELL * i, background_blur + RF_CELL * i, stride,
                       n - i < RF_CELL_RUN ? n - i : RF_CELL_RUN);
}
