/* mark_foreground.c: marks the foreground of a row: the pixels that lie below their dilated blur.
 */
#include "kernels/kernels.h"
#include "kernels/lanes.h"

void RF_VEC(rf_mark_foreground)(int16_t *restrict background_blur, const int16_t *restrict blur,
                                const uint16_t *restrict dilated, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t s = (uint16_t)((uint16_t)blur[x] ^ 0x8000);
        const uint16_t foreground = (uint16_t)(dilated[x] > s ? 0xffff : 0);

        background_blur[x] = (int16_t)((foreground & 0x8000) | (~foreground & (uint16_t)blur[x]));
    }
}
