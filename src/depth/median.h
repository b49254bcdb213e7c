/* median.h: the median of 3 x 3 disparities. */
#ifndef RF_MEDIAN_H
#define RF_MEDIAN_H

#include <stddef.h>
#include <stdint.h>

static inline void rf_sort_two(uint16_t *a, uint16_t *b)
{
    const uint16_t least = *a < *b ? *a : *b;

    *b = *a < *b ? *b : *a;
    *a = least;
}

/* The middle one of nine around `middle`: the greatest of the least, the middle of the middle and
 * the least of the greatest of three columns in order. */
static inline uint16_t rf_median_of_nine(const uint16_t *middle, ptrdiff_t stride)
{
    uint16_t v[3][3];

    for (int x = 0; x < 3; x++) {
        for (int y = 0; y < 3; y++)
            v[y][x] = middle[(y - 1) * stride + x - 1];
        rf_sort_two(&v[0][x], &v[1][x]);
        rf_sort_two(&v[1][x], &v[2][x]);
        rf_sort_two(&v[0][x], &v[1][x]);
    }
    for (int y = 0; y < 3; y++) {
        rf_sort_two(&v[y][0], &v[y][1]);
        rf_sort_two(&v[y][1], &v[y][2]);
        rf_sort_two(&v[y][0], &v[y][1]);
    }
    rf_sort_two(&v[0][2], &v[1][1]);
    rf_sort_two(&v[1][1], &v[2][0]);
    rf_sort_two(&v[0][2], &v[1][1]);
    return v[1][1];
}

#endif
