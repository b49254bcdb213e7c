#include "kernels/kernels.h"

static bool is_known(int16_t blur)
{
    return blur != RF_NO_BLUR;
}

static void push_pixel(uint16_t *const out[3], int16_t *out_blur, const uint16_t *const upper[3],
                       const uint16_t *const lower[3], const int16_t *blur0, const int16_t *blur1,
                       int x)
{
    unsigned sum[3] = {0, 0, 0}, count = 0;
    int16_t farthest = RF_NO_BLUR;

    for (int i = 0; i < 4; i++) {
        const int at = 2 * x + i % 2;
        const int16_t blur = (i < 2 ? blur0 : blur1)[at];

        if (!is_known(blur))
            continue;
        count++;
        farthest = blur > farthest ? blur : farthest;
        for (int c = 0; c < 3; c++)
            sum[c] += (i < 2 ? upper : lower)[c][at];
    }
    for (int c = 0; c < 3; c++)
        out[c][x] = (uint16_t)(count ? (sum[c] + count / 2) / count : 0);
    out_blur[x] = farthest;
}

void rf_push_c(uint16_t *const out[3], int16_t *out_blur, const uint16_t *const upper[3],
               const uint16_t *const lower[3], const int16_t *blur0, const int16_t *blur1, int n)
{
    for (int x = 0; x < n; x++)
        push_pixel(out, out_blur, upper, lower, blur0, blur1, x);
}

static uint16_t quarters(unsigned three, unsigned one)
{
    return (uint16_t)((3 * three + one + 2) >> 2);
}

void rf_pull_c(uint16_t *out, const int16_t *out_blur, const uint16_t *near_row,
               const uint16_t *far_row, uint16_t *mixed, int pairs)
{
    mixed++; /* mixed[-1] and mixed[pairs] repeat the ends */
    for (int x = 0; x < pairs; x++)
        mixed[x] = quarters(near_row[x], far_row[x]);
    mixed[-1] = mixed[0];
    mixed[pairs] = mixed[pairs - 1];
    for (int i = 0; i < 2 * pairs; i++)
        if (!is_known(out_blur[i]))
            out[i] = quarters(mixed[i / 2], mixed[i / 2 + (i % 2 ? 1 : -1)]);
}

void rf_pull_blur_c(int16_t *out, const int16_t *near_row, int pairs)
{
    for (int i = 0; i < 2 * pairs; i++)
        if (!is_known(out[i]))
            out[i] = near_row[i / 2];
}
