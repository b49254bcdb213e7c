/* windows.c: which blurs lie around each place, and whether the background shows the deepest of
 * them; written for the compiler's vectoriser, compiled like rows.c. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum { RUN = 64 }; /* cells at a time */

/* Columns first; then the least of four beside each other, of which every fourth counts. */
static void cells_run(int16_t *restrict least, int16_t *restrict most, const int16_t *restrict blur,
                      ptrdiff_t stride, int n)
{
    int16_t low[RF_CELL * RUN + 4], high[RF_CELL * RUN + 4];
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

static void RF_VEC(rf_cells)(int16_t *least, int16_t *most, const int16_t *blur, ptrdiff_t stride,
                             int n)
{
    for (int i = 0; i < n; i += RUN)
        cells_run(least + i, most + i, blur + RF_CELL * i, stride, n - i < RUN ? n - i : RUN);
}

static void repeat_ends(int16_t *row, int n, int left, int right)
{
    for (int x = 1; x <= left; x++)
        row[-x] = row[0];
    for (int x = 0; x < right; x++)
        row[n + x] = row[n - 1];
}

/* The least, and the greatest, of RF_WINDOW_X beside each other from x on. */
static inline int16_t least_from(const int16_t *low, int x)
{
    return rf_lesser(rf_lesser(rf_lesser(low[x], low[x + 1]), rf_lesser(low[x + 2], low[x + 3])),
                     low[x + 4]);
}

static inline int16_t greatest_from(const int16_t *high, int x)
{
    return rf_greater(
        rf_greater(rf_greater(high[x], high[x + 1]), rf_greater(high[x + 2], high[x + 3])),
        high[x + 4]);
}

static void RF_VEC(rf_windows)(uint32_t *restrict range, const int16_t *const least[RF_WINDOW_Y],
                               const int16_t *const most[RF_WINDOW_Y], int16_t *restrict scratch,
                               int n, int border)
{
    const int windows = n + 2 * border, beyond = border + RF_WINDOW_X - 1;
    int16_t *restrict low = scratch, *restrict high = scratch + n + border + beyond;
    const int16_t *restrict l0 = least[0], *restrict l1 = least[1], *restrict l2 = least[2];
    const int16_t *restrict m0 = most[0], *restrict m1 = most[1], *restrict m2 = most[2];

    for (int x = 0; x < n; x++) {
        low[border + x] = rf_lesser(rf_lesser(l0[x], l1[x]), l2[x]);
        high[border + x] = rf_greater(rf_greater(m0[x], m1[x]), m2[x]);
    }
    repeat_ends(low + border, n, border, beyond);
    repeat_ends(high + border, n, border, beyond);
    for (int x = 0; x < windows; x++) {
        const int16_t l = least_from(low, x);
        const int16_t h = (int16_t)((greatest_from(high, x) + 1) & ~1);

        range[x] = (uint16_t)l | (uint32_t)(uint16_t)h << 16;
    }
}

/* The blur of a pixel that is foreground. */
static inline int16_t in_front(int16_t blur, int16_t behind)
{
    return (int16_t)(blur == behind ? RF_NO_BLUR : blur);
}

static void foreground_run(int16_t *restrict most, const int16_t *restrict blur,
                           const int16_t *restrict behind, ptrdiff_t stride, int n)
{
    int16_t high[RF_CELL * RUN + 4];

    for (int x = 0; x < RF_CELL * n; x++) {
        const int16_t a = in_front(blur[x], behind[x]);
        const int16_t b = in_front(blur[x + stride], behind[x + stride]);
        const int16_t c = in_front(blur[x + 2 * stride], behind[x + 2 * stride]);
        const int16_t d = in_front(blur[x + 3 * stride], behind[x + 3 * stride]);

        high[x] = rf_greater(rf_greater(a, b), rf_greater(c, d));
    }
    for (int i = 0; i < n; i++) {
        const int16_t *h = high + RF_CELL * i;

        most[i] = rf_greater(rf_greater(h[0], h[1]), rf_greater(h[2], h[3]));
    }
}

static void RF_VEC(rf_foreground)(int16_t *most, const int16_t *blur, const int16_t *behind,
                                  ptrdiff_t stride, int n)
{
    for (int i = 0; i < n; i += RUN)
        foreground_run(most + i, blur + RF_CELL * i, behind + RF_CELL * i, stride,
                       n - i < RUN ? n - i : RUN);
}

static void RF_VEC(rf_bare)(uint32_t *restrict range, const int16_t *const foreground[RF_WINDOW_Y],
                            int16_t *restrict scratch, int n, int border)
{
    const int16_t *restrict f0 = foreground[0], *restrict f1 = foreground[1];
    const int16_t *restrict f2 = foreground[2];

    for (int x = 0; x < n; x++)
        scratch[border + x] = rf_greater(rf_greater(f0[x], f1[x]), f2[x]);
    repeat_ends(scratch + border, n, border, border + RF_WINDOW_X - 1);
    for (int x = 0; x < n + 2 * border; x++) {
        const int most = (int32_t)range[x] >> 16 & ~1;
        const int bare = greatest_from(scratch, x) < most - rf_bare_depth(most);

        range[x] = (range[x] & ~(uint32_t)RF_BARE) | (uint32_t)bare << 16;
    }
}

void RF_VEC(rf_windows_use)(struct rf_kernels *kernels)
{
    kernels->cells = RF_VEC(rf_cells);
    kernels->windows = RF_VEC(rf_windows);
    kernels->foreground = RF_VEC(rf_foreground);
    kernels->bare = RF_VEC(rf_bare);
}
