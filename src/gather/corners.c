/* corners.c: blurs of the hidden background at the corners of a tile, and means between them. */
#include "gather/corners.h"

#include <stdlib.h>

#include "background/inpaint.h"
#include "support/compare.h"

enum {
    ALIKE = 256,         /* 1/256 pixel */
    SPAN = 2 * RF_TILE,  /* a tile across, in half pixels */
    WHOLE = SPAN * SPAN, /* the weights of a pixel */
};

static int blur_at(const struct rf_frame *f, int tx, int ty)
{
    const int x = rf_clamp(tx, 0, f->view->tiles_x - 1), y = rf_clamp(ty, 0, f->view->tiles_y - 1);

    return f->bins[(size_t)y * f->view->tiles_x + x].background_blur;
}

/* The mean of the tiles that meet in the upper left corner of one, without those that are in front
 * of the deepest: in the middle of a subject the hidden background has the blur of the subject. */
static int corner_blur(const struct rf_frame *f, int tx, int ty)
{
    const int apart = rf_layers_apart(f->params->max_blur_radius, f->blur.unit);
    const int blur[4] = {blur_at(f, tx - 1, ty - 1), blur_at(f, tx, ty - 1), blur_at(f, tx - 1, ty),
                         blur_at(f, tx, ty)};
    int deepest = blur[0], sum = 0, count = 0;

    for (int k = 1; k < 4; k++)
        deepest = rf_larger(deepest, blur[k]);
    for (int k = 0; k < 4; k++)
        if (deepest - blur[k] <= apart) {
            sum += blur[k];
            count++;
        }
    return sum / count;
}

/* Whether two blurs differ so that it shows: by more than a pixel and an eighth of the lesser one.
 */
static bool differ(const struct rf_frame *f, int a, int b)
{
    const int lesser = rf_smaller(abs(a), abs(b));

    return rf_in_pixels(abs(a - b), f->blur.unit) > ALIKE + rf_in_pixels(lesser, f->blur.unit) / 8;
}

void rf_find_corners(struct rf_corners *corners, const struct rf_frame *f, int tx, int ty)
{
    int blur[4];

    for (int k = 0; k < 4; k++)
        blur[k] = corner_blur(f, tx + k % 2, ty + k / 2);
    corners->across = differ(f, blur[0], blur[1]) || differ(f, blur[2], blur[3]);
    corners->down = differ(f, blur[0], blur[2]) || differ(f, blur[1], blur[3]);
    corners->count = 0;
    for (int y = 0; y <= corners->down; y++)
        for (int x = 0; x <= corners->across; x++) {
            const int right = corners->across ? x : 1, below = corners->down ? y : 1;

            corners->blur[corners->count++] = (blur[2 * y + x] + blur[2 * y + right] +
                                               blur[2 * below + x] + blur[2 * below + right]) /
                                              4;
        }
}

/* The weight of the right or lower corners at a sample, of SPAN: how far its centre is. */
static uint32_t weight_at(int sample, int apart)
{
    return (uint32_t)((2 * sample + 1) * apart);
}

void rf_add_corner(uint32_t *sum, const uint16_t *mean, const struct rf_corners *corners, int k,
                   struct rf_corner_layout layout)
{
    const bool is_right = corners->across && k % 2;
    const bool is_below = corners->down && k / (1 + corners->across);

    for (int y = 0; y < RF_TILE / layout.down; y++) {
        const uint32_t below = weight_at(y, layout.down);
        const uint32_t row = !corners->down ? SPAN : is_below ? below : SPAN - below;

        for (int x = 0; x < RF_TILE; x++) {
            const uint32_t right = weight_at(x / layout.across, layout.across);
            const uint32_t column = !corners->across ? SPAN : is_right ? right : SPAN - right;
            const int i = y * RF_TILE + x;

            sum[i] = (k ? sum[i] : WHOLE / 2) + row * column * mean[i];
        }
    }
}

void rf_corner_means(uint16_t *mean, const uint32_t *sum, struct rf_corner_layout layout)
{
    for (int i = 0; i < RF_TILE / layout.down * RF_TILE; i++)
        mean[i] = (uint16_t)(sum[i] / WHOLE);
}
