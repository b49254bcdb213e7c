/* yuv_weights.c: weights of eq. 5 for luma and chroma. */
#include "passes/yuv.h"

#include <string.h>

/* The part of the planes, borders too, that goes with a row of tiles. */
static struct rf_rect around_tiles(const struct refocus_renderer *r, int ty)
{
    return (struct rf_rect){
        -r->view.border.x0,
        ty * RF_TILE - (ty == 0 ? r->view.border.y0 : 0),
        r->view.tiles_x * RF_TILE + r->view.border.x1,
        ty + 1 < r->view.tiles_y ? (ty + 1) * RF_TILE : r->view.height + r->view.border.y1,
    };
}

/* Most of the background is what is seen. */
void rf_yuv_weigh_rows(struct refocus_renderer *r, int ty)
{
    const struct rf_rect part = around_tiles(r, ty);
    const uint16_t *const of_light = r->light_weight;

    for (int y = part.y0; y < part.y1; y++) {
        const ptrdiff_t row = y * r->view.stride;
        const uint16_t *seen = r->smooth.channel[0] + row,
                       *behind = r->background.light.channel[0] + row;
        uint16_t *near = r->yuv.weight + row, *far = (uint16_t *)r->background.blur.at + row;

        for (int x = part.x0; x < part.x1; x++)
            near[x] = of_light[seen[x] < RF_LIGHT_MAX ? seen[x] : RF_LIGHT_MAX];
        for (int x = part.x0; x < part.x1; x++)
            far[x] = behind[x] == seen[x]
                         ? near[x]
                         : of_light[behind[x] < RF_LIGHT_MAX ? behind[x] : RF_LIGHT_MAX];
    }
}

/* n pixels of a row of both layers. */
static void weigh_luma(const struct refocus_renderer *r, int x, int y, uint16_t *brightest, int n)
{
    const ptrdiff_t at = y * r->view.stride + x;

    r->exec.kernels->weigh1(
        &(struct rf_weigh1_job){
            .near = r->smooth.channel[0] + at,
            .far = r->background.light.channel[0] + at,
            .near_weight = r->yuv.weight + at,
            .far_weight = (uint16_t *)r->background.blur.at + at,
            .brightest = brightest,
            .light_weight = r->light_weight,
        },
        n);
}

/* Rows of chroma whose first pixels lie in that part, from the first of two columns on.
 */
static void weigh_chroma(const struct refocus_renderer *r, struct rf_rect part)
{
    const int down = r->yuv.down, x = -(r->view.border.x0 & ~1);

    for (int y = part.y0 / (1 << down); y < (part.y1 + down) >> down; y++) {
        const ptrdiff_t at = y * r->view.stride + x, from = y * (1 << down) * r->view.stride + x;

        r->exec.kernels->weigh_chroma(r->yuv.smooth + at, r->yuv.weight + from, (part.x1 - x) / 2);
        r->exec.kernels->weigh_chroma(r->yuv.behind + at, (uint16_t *)r->background.blur.at + from,
                                      (part.x1 - x) / 2);
    }
}

static uint16_t greatest(uint16_t v, const uint16_t *values, int n)
{
    for (int i = 0; i < n; i++)
        v = values[i] > v ? values[i] : v;
    return v;
}

/* What lies beyond the sides counts for the tiles there. */
void rf_yuv_premultiply_rows(struct refocus_renderer *r, uint16_t *scratch, int ty)
{
    const struct rf_rect part = around_tiles(r, ty);
    const int left = r->view.border.x0, right = r->view.border.x1,
              width = r->view.tiles_x * RF_TILE;
    const int tiles = r->view.tiles_x, before = left / RF_TILE + 1, after = right / RF_TILE + 1;
    uint16_t *brightest = scratch + before;

    memset(scratch, 0, (size_t)(before + tiles + after) * sizeof scratch[0]);
    for (int y = part.y0; y < part.y1; y++) {
        weigh_luma(r, -left, y, scratch, left);
        weigh_luma(r, 0, y, brightest, width);
        weigh_luma(r, width, y, brightest + tiles, right);
    }
    weigh_chroma(r, part);
    brightest[0] = greatest(brightest[0], scratch, before);
    brightest[tiles - 1] = greatest(brightest[tiles - 1], brightest + tiles, after);
    for (int tx = 0; tx < tiles; tx++)
        r->bins[(size_t)ty * tiles + tx].brightest = brightest[tx];
}
