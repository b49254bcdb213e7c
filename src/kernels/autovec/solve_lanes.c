/* solve_lanes.c: solves small systems of linear equations, one in each lane of a vector. */
#include "kernels/kernels.h"

enum { LANES = RF_SOLVE_LANES };

/* The row i of a lower triangle. */
#define ROW(matrix, i) ((matrix) + (i) * ((i) + 1) / 2)

/* sum -= the products of n elements of two rows. */
static RF_ALWAYS_INLINE void subtract_products(float *restrict sum,
                                               const float (*restrict a)[LANES],
                                               const float (*restrict b)[LANES], int n)
{
    float left[LANES];

    for (int l = 0; l < LANES; l++)
        left[l] = sum[l];
    for (int k = 0; k < n; k++)
        for (int l = 0; l < LANES; l++)
            left[l] -= a[k][l] * b[k][l];
    for (int l = 0; l < LANES; l++)
        sum[l] = left[l];
}

/* The row i of L D becomes that of L, and its pivot, D, the inverse of that. */
static RF_ALWAYS_INLINE void finish_row(float (*restrict row)[LANES], float (*matrix)[LANES], int i)
{
    float pivot[LANES], least[LANES];

    for (int l = 0; l < LANES; l++) {
        pivot[l] = row[i][l];
        least[l] = row[i][l] * (1.0f / RF_SOLVE_PIVOT);
    }
    for (int k = 0; k < i; k++) {
        const float *inverse = ROW(matrix, k)[k];

        for (int l = 0; l < LANES; l++) {
            const float quotient = row[k][l] * inverse[l];

            pivot[l] -= row[k][l] * quotient;
            row[k][l] = quotient;
        }
    }
    for (int l = 0; l < LANES; l++)
        row[i][l] = 1.0f / (pivot[l] > least[l] ? pivot[l] : least[l]);
}

void RF_VEC(rf_solve_lanes)(float (*matrix)[RF_SOLVE_LANES], float (*x)[RF_SOLVE_LANES], int n)
{
    for (int i = 0; i < n; i++) {
        for (int j = 1; j < i; j++)
            subtract_products(ROW(matrix, i)[j], (const float(*)[LANES])ROW(matrix, i),
                              (const float(*)[LANES])ROW(matrix, j), j);
        finish_row(ROW(matrix, i), matrix, i);
    }
    for (int i = 1; i < n; i++)
        subtract_products(x[i], (const float(*)[LANES])ROW(matrix, i), (const float(*)[LANES])x, i);
    for (int i = 0; i < n; i++)
        for (int l = 0; l < LANES; l++)
            x[i][l] *= ROW(matrix, i)[i][l];
    for (int i = n - 1; i > 0; i--)
        for (int k = 0; k < i; k++)
            for (int l = 0; l < LANES; l++)
                x[k][l] -= ROW(matrix, i)[k][l] * x[i][l];
}
