/* peaking.c: the sharp edges of a picture are marked. */
#include "views/peaking.h"

#include <stdlib.h>
#include <string.h>

int peaking_luma(const uint8_t *rgb)
{
    return (2 * rgb[0] + 5 * rgb[1] + rgb[2]) / 8;
}

void peaking_draw(const struct refocus_image *photo, const uint16_t *blur,
                  const struct refocus_image *out)
{
    enum { EDGE = 20, HALF_PIXEL = 128 };
    static const uint8_t mark[3] = {32, 255, 64};

    for (int y = 0; y < photo->height; y++) {
        const uint8_t *row = photo->plane[0] + y * photo->stride[0];
        const uint8_t *below = y + 1 < photo->height ? row + photo->stride[0] : row;
        uint8_t *to = out->plane[0] + y * out->stride[0];

        for (int x = 0; x < photo->width; x++, blur++) {
            const int here = peaking_luma(row + 3 * x);
            const int right = x + 1 < photo->width ? peaking_luma(row + 3 * x + 3) : here;
            const int down = peaking_luma(below + 3 * x);

            if (*blur < HALF_PIXEL && (abs(right - here) > EDGE || abs(down - here) > EDGE))
                memcpy(to + 3 * x, mark, 3);
            else
                memset(to + 3 * x, here, 3);
        }
    }
}
