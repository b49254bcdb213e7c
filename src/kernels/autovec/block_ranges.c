/* block_ranges.c: the least and the greatest disparity of each block of a row of blocks. */
#include "kernels/kernels.h"

static RF_ALWAYS_INLINE struct rf_edge_range range_of(const uint16_t *restrict plane,
                                                      ptrdiff_t stride, int columns, int rows)
{
    struct rf_edge_range range = {65535, 0};
    uint16_t least[RF_EDGE_BLOCK], most[RF_EDGE_BLOCK];

    for (int x = 0; x < columns; x++)
        least[x] = most[x] = plane[x];
    for (int y = 1; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            const uint16_t d = plane[y * stride + x];

            least[x] = d < least[x] ? d : least[x];
            most[x] = d > most[x] ? d : most[x];
        }
    for (int x = 0; x < columns; x++) {
        range.least = least[x] < range.least ? least[x] : range.least;
        range.most = most[x] > range.most ? most[x] : range.most;
    }
    return range;
}

void RF_VEC(rf_block_ranges)(struct rf_edge_range *restrict range, const uint16_t *plane,
                             ptrdiff_t stride, int width, int rows)
{
    int x = 0;

    for (; x + RF_EDGE_BLOCK <= width && rows == RF_EDGE_BLOCK; x += RF_EDGE_BLOCK)
        *range++ = range_of(plane + x, stride, RF_EDGE_BLOCK, RF_EDGE_BLOCK);
    for (; x < width; x += RF_EDGE_BLOCK)
        *range++ = range_of(plane + x, stride,
                            width - x < RF_EDGE_BLOCK ? width - x : RF_EDGE_BLOCK, rows);
}
