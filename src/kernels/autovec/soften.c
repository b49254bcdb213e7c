/* soften.c: softens the means of a tile: moves each towards its neighbours. */
#include "kernels/kernels.h"

#include <string.h>

/* A value moved towards the average of two. */
static inline uint16_t moved(uint16_t own, uint16_t a, uint16_t b, uint32_t share)
{
    const uint16_t average = (uint16_t)((a + b + 1) >> 1);
    const uint16_t up = (uint16_t)(average > own ? average - own : 0);
    const uint16_t down = (uint16_t)(own > average ? own - average : 0);
    const uint16_t more = (uint16_t)((uint16_t)(up * share >> 16) >> 1);
    const uint16_t less = (uint16_t)((uint16_t)(down * share >> 16) >> 1);

    return (uint16_t)(own + more - less);
}

/* A row moved towards the averages of what lies `apart` elements before and after. */
static inline void soften_row(uint16_t *restrict out, const uint16_t *restrict own, ptrdiff_t apart,
                              uint16_t share)
{
    const uint16_t *before = own - apart, *after = own + apart;

    for (int x = 0; x < RF_TILE; x++)
        out[x] = moved(own[x], before[x], after[x], share);
}

void RF_VEC(rf_soften)(uint16_t *mean, int rows, int each, bool down, uint16_t share)
{
    uint16_t padded[RF_TILE * (RF_TILE + 2)], across[RF_TILE * RF_TILE];
    uint16_t *const own = padded + RF_TILE;
    const int n = rows * RF_TILE;

    memcpy(own, mean, (size_t)n * sizeof *mean);
    memset(padded, 0, RF_TILE * sizeof *padded); /* beyond both ends: is not used */
    memset(own + n, 0, RF_TILE * sizeof *own);
    for (int y = 0; y < n; y += RF_TILE) {
        soften_row(across + y, own + y, each, share);
        for (int i = 0; i < each; i++) {
            across[y + i] = own[y + i];
            across[y + RF_TILE - 1 - i] = own[y + RF_TILE - 1 - i];
        }
    }
    memcpy(mean, across, (size_t)n * sizeof *mean);
    for (int y = RF_TILE; down && y < n - RF_TILE; y += RF_TILE)
        soften_row(mean + y, across + y, RF_TILE, share);
}
