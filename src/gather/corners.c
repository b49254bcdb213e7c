/* corners.c: blurs of the hidden background at the corners of a tile, and means between them. */
#include "gather/corners.h"

#include <stdlib.h>

#include "background/inpaint.h"
#include "gather/tile_rows.h"
#include "support/compare.h"

enum {
    ALIKE = 256,         /* 1/256 pixel */
    SPAN = 2 * RF_TILE,  /* a tile across, in half pixels */
    WHOLE = SPAN * SPAN, /* the weights of a pixel */
};

/* The blurs of the hidden background of a tile and of those around it. */
static void blurs_around(const struct rf_frame *f, int tx, int ty, int blur[3][3])
{
    const int last_x = f->view->tiles_x - 1, last_y = f->view->tiles_y - 1;

    for (int j = 0; j < 3; j++) {
        const struct rf_bins *row =
            f->bins + (size_t)rf_clamp(ty + j - 1, 0, last_y) * f->view->tiles_x;

        for (int i = 0; i < 3; i++)
            blur[j][i] = row[rf_clamp(tx + i - 1, 0, last_x)].background_blur;
    }
}

/* The mean of four tiles that meet in a corner, without those that are in front of the deepest: in
 * the middle of a subject the hidden background has the blur of the subject. */
static int corner_blur(const int above[2], const int below[2], int apart)
{
    const int a = above[0], b = above[1], c = below[0], d = below[1];
    const int least = rf_larger(rf_larger(a, b), rf_larger(c, d)) - apart;
    const int count = (a >= least) + (b >= least) + (c >= least) + (d >= least);

    return ((a >= least) * a + (b >= least) * b + (c >= least) * c + (d >= least) * d) / count;
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
    const int apart = rf_layers_apart(f->params->max_blur_radius, f->blur.unit);
    int around[3][3], blur[4];

    blurs_around(f, tx, ty, around);
    for (int k = 0; k < 4; k++)
        blur[k] = corner_blur(&around[k / 2][k % 2], &around[k / 2 + 1][k % 2], apart);
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

bool rf_corner_repeats(const struct rf_corners *corners, int k, const struct rf_frame *f,
                       const struct rf_tile_plan *plan, bool past_slabs)
{
    return k > 0 && !past_slabs &&
           rf_least_blur(f, plan, corners->blur[k]) == rf_least_blur(f, plan, corners->blur[k - 1]);
}

/* The weight of a corner at a sample, of SPAN, by how far the centre of that is. */
static uint16_t weight_at(int sample, int apart, bool differs, bool is_farther)
{
    const int farther = (2 * sample + 1) * apart;

    return (uint16_t)(!differs ? SPAN : is_farther ? farther : SPAN - farther);
}

void rf_add_corner(uint32_t *sum, const uint16_t *mean, const struct rf_corners *corners, int k,
                   struct rf_corner_layout layout)
{
    const bool is_right = corners->across && k % 2;
    const bool is_below = corners->down && k / (1 + corners->across);
    uint16_t column[RF_TILE];

    for (int x = 0; x < RF_TILE; x++)
        column[x] = weight_at(x / layout.across, layout.across, corners->across, is_right);
    for (int y = 0; y < RF_TILE / layout.down; y++) {
        const uint16_t row = weight_at(y, layout.down, corners->down, is_below);

        for (int x = 0; x < RF_TILE; x++) { /* products of 16 bits each are what vectors have */
            const uint16_t weight = (uint16_t)(row * column[x]);
            const int i = y * RF_TILE + x;

            sum[i] = (k ? sum[i] : WHOLE / 2) + (uint32_t)weight * mean[i];
        }
    }
}

void rf_corner_means(uint16_t *mean, const uint32_t *sum, struct rf_corner_layout layout)
{
    for (int i = 0; i < RF_TILE / layout.down * RF_TILE; i++)
        mean[i] = (uint16_t)(sum[i] / WHOLE);
}
