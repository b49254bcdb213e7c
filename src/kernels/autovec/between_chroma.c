/* between_chroma.c: interpolates the rows of chroma between those that were computed, by cubics. */
#include "kernels/kernels.h"
#include "kernels/autovec/cubic.h"

/* The cubic through rows 0 2 5 7 at the others, shares in Q14; see light.c. */
void RF_VEC(rf_between_chroma)(uint16_t *restrict mean, const uint16_t *restrict computed)
{
    enum { ROWS = 8 };
    static const int8_t before[ROWS] = {0, 0, 1, 1, 1, 2, 2, 2};
    static const int16_t share[ROWS][4] = {{16384, 0, 0, 0},
                                           {5617, 13108, -3277, 936},
                                           {0, 16384, 0, 0},
                                           {-1872, 13107, 6553, -1404},
                                           {-1404, 6553, 13107, -1872},
                                           {0, 0, 16384, 0},
                                           {936, -3277, 13108, 5617},
                                           {0, 0, 0, 16384}};

    for (int y = 0; y < ROWS; y++)
        rf_cubic_row(mean + y * RF_TILE, computed, computed + before[y] * RF_TILE, share[y]);
}
