/* align_step.c: one step of the alignment of two frames of a focus stack, as align.c says. */
#include "focus_stack/align.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { BORDER = 2 };

static void add_pixel(struct rf_align_sums *sums, const struct rf_align_level *l, int x, int y,
                      int clamp)
{
    const ptrdiff_t i = (ptrdiff_t)y * l->width + x, w = l->width;
    const uint16_t *r = l->reference + i;
    const int16_t *f = l->warped + i;
    int32_t row[RF_ALIGN_UNKNOWNS], residual;

    if (f[0] < 0 || f[-1] < 0 || f[1] < 0 || f[-w] < 0 || f[w] < 0)
        return;
    /* Four times the gradient, and twice the place. */
    const int gx = f[1] - f[-1] + r[1] - r[-1], gy = f[w] - f[-w] + r[w] - r[-w];
    const int px = 2 * x - (l->width - 1), py = 2 * y - (l->height - 1);

    residual = r[0] - f[0];
    row[0] = (gx * px + gy * py) / 8;
    row[1] = (gy * px - gx * py) / 8;
    row[2] = gx;
    row[3] = gy;
    row[4] = r[0];
    row[5] = 64;
    sums->residual += abs(residual);
    sums->pixels++;
    if (l->unknowns == RF_ALIGN_UNKNOWNS) {
        const int64_t sides = (int64_t)l->width * l->width + (int64_t)l->height * l->height;
        const int64_t away = (int64_t)px * px + (int64_t)py * py;

        if (abs(residual) > clamp)
            return;
        row[6] = (int)(r[0] * away / sides); /* at most r[0] */
    }
    residual = residual < -clamp ? -clamp : residual > clamp ? clamp : residual;
    for (int a = 0; a < l->unknowns; a++) {
        for (int b = 0; b <= a; b++)
            sums->left[a][b] += (int64_t)row[a] * row[b];
        sums->right[a] += (int64_t)row[a] * residual;
    }
}

void rf_align_add_up(struct rf_align_sums *sums, const struct rf_align_level *l, int clamp)
{
    memset(sums, 0, sizeof *sums);
    for (int y = BORDER; y < l->height - BORDER; y++)
        for (int x = BORDER; x < l->width - BORDER; x++)
            add_pixel(sums, l, x, y, clamp);
}

/* Gauss's elimination with the diagonal as pivots: the matrix is symmetric and positive. */
bool rf_align_solve(const struct rf_align_sums *sums, int n, double out[RF_ALIGN_UNKNOWNS])
{
    double m[RF_ALIGN_UNKNOWNS][RF_ALIGN_UNKNOWNS + 1];

    for (int a = 0; a < n; a++) {
        for (int b = 0; b < n; b++)
            m[a][b] = (double)(b <= a ? sums->left[a][b] : sums->left[b][a]);
        m[a][n] = (double)sums->right[a];
    }
    for (int a = 0; a < n; a++) {
        /* Less than 1e-9 of what it was: the picture does not say. */
        if (!(m[a][a] > 1e-9 * (double)sums->left[a][a]))
            return false;
        for (int b = a + 1; b < n; b++) {
            const double factor = m[b][a] / m[a][a];

            for (int c = a; c <= n; c++)
                m[b][c] = m[b][c] - factor * m[a][c];
        }
    }
    for (int a = n - 1; a >= 0; a--) {
        double value = m[a][n];

        for (int c = a + 1; c < n; c++)
            value = value - m[a][c] * out[c];
        out[a] = value / m[a][a];
    }
    return true;
}
