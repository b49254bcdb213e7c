/* products.c: sums the products of the elements of two rectangles. */
#include "kernels/kernels.h"

int64_t RF_VEC(rf_products)(const int16_t *a, const int16_t *b, ptrdiff_t stride, int n, int rows)
{
    int64_t sum = 0;

    for (int y = 0; y < rows; y++, a += stride, b += stride) {
        int32_t row = 0;

        for (int x = 0; x < n; x++)
            row += a[x] * b[x];
        sum += row;
    }
    return sum;
}
