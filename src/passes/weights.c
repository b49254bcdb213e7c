/* weights.c: computes the highlight weights of eq. 5, and light times weight. */
#include "passes/weights.h"

#include <string.h>

#include "colour/transfer.h"
#include "kernels/kernels.h"
#include "support/compare.h"

/* The part of the planes, borders too, that goes with a row of tiles. */
static struct rf_rect around_tiles(const struct rf_viewport *view, int ty)
{
    return (struct rf_rect){
        -view->border.x0,
        ty * RF_TILE - (ty == 0 ? view->border.y0 : 0),
        view->tiles_x * RF_TILE + view->border.x1,
        ty + 1 < view->tiles_y ? (ty + 1) * RF_TILE : view->height + view->border.y1,
    };
}

static int brightest(const struct rf_light_q12 *light, ptrdiff_t at)
{
    return rf_smaller(rf_brightest_at(light, at), RF_LIGHT_MAX); /* highlights lie above */
}

static void weigh_row(const struct rf_weights *pass, int y, int x0, int x1)
{
    const struct rf_light_q12 smooth = pass->smooth, background = pass->background;
    const uint16_t *const of_light = pass->light_weight;
    const ptrdiff_t row = y * smooth.stride;
    uint16_t *near = pass->weight.at + y * pass->weight.stride;
    uint16_t *far = pass->background_weight.at + y * pass->background_weight.stride;

    for (int x = x0; x < x1; x++)
        near[x] = of_light[brightest(&smooth, row + x)];
    for (int x = x0; pass->has_background && x < x1; x++)
        far[x] = of_light[brightest(&background, row + x)];
}

/* Weighs luminance. Most pixels of the background layer are those of the picture, and so have their
 * weight. */
static void weigh_luminance_row(const struct rf_weights *pass, int y, int x0, int x1)
{
    const uint16_t *const of_light = pass->light_weight;
    const uint16_t *seen = pass->smooth.channel[0] + y * pass->smooth.stride;
    const uint16_t *background = pass->background.channel[0] + y * pass->background.stride;
    uint16_t *near = pass->weight.at + y * pass->weight.stride;
    uint16_t *far = pass->background_weight.at + y * pass->background_weight.stride;

    for (int x = x0; x < x1; x++)
        near[x] = of_light[seen[x] < RF_LIGHT_MAX ? seen[x] : RF_LIGHT_MAX];
    for (int x = x0; x < x1; x++)
        far[x] = background[x] == seen[x]
                     ? near[x]
                     : of_light[background[x] < RF_LIGHT_MAX ? background[x] : RF_LIGHT_MAX];
}

void rf_weigh_rows(const struct rf_viewport *view, const struct rf_weights *pass, int ty)
{
    const struct rf_rect part = around_tiles(view, ty);

    for (int y = part.y0; y < part.y1; y++) {
        if (pass->chroma)
            weigh_luminance_row(pass, y, part.x0, part.x1);
        else
            weigh_row(pass, y, part.x0, part.x1);
    }
}

/* n pixels of a row of both layers. */
static void premultiply(const struct rf_executor *exec, const struct rf_weights *pass, int x, int y,
                        uint16_t *most, int n)
{
    const ptrdiff_t at = y * pass->smooth.stride + x;
    struct rf_weigh_job job = {
        .near_weight = pass->weight.at + y * pass->weight.stride + x,
        .far_weight = pass->background_weight.at + y * pass->background_weight.stride + x,
        .brightest = most,
        .light_weight = pass->light_weight,
    };

    if (pass->chroma) {
        exec->kernels->weigh1(
            &(struct rf_weigh1_job){
                .near = pass->smooth.channel[0] + at,
                .far = pass->background.channel[0] + at,
                .near_weight = job.near_weight,
                .far_weight = job.far_weight,
                .brightest = most,
                .light_weight = pass->light_weight,
            },
            n);
        return;
    }
    for (int c = 0; c < 3; c++) {
        job.near[c] = pass->smooth.channel[c] + at;
        job.far[c] = pass->background.channel[c] + at;
    }
    exec->kernels->weigh(&job, n);
}

/* Rows of chroma whose first pixels lie in that part, from the first of two columns on. */
static void premultiply_chroma(const struct rf_executor *exec, const struct rf_viewport *view,
                               const struct rf_weights *pass, struct rf_rect part)
{
    const struct rf_weights_chroma *chroma = pass->chroma;
    const int down = chroma->size.down, x = -(view->border.x0 & ~1), n = (part.x1 - x) / 2;

    for (int y = part.y0 / (1 << down); y < (part.y1 + down) >> down; y++) {
        const int first = y * (1 << down); /* row of pixels */

        exec->kernels->weigh_chroma(chroma->smooth.at + y * chroma->smooth.stride + x,
                                    pass->weight.at + first * pass->weight.stride + x, n);
        exec->kernels->weigh_chroma(
            chroma->background.at + y * chroma->background.stride + x,
            pass->background_weight.at + first * pass->background_weight.stride + x, n);
    }
}

/* The greatest of n values and v. */
static uint16_t greatest(uint16_t v, const uint16_t *values, int n)
{
    for (int i = 0; i < n; i++)
        v = values[i] > v ? values[i] : v;
    return v;
}

/* Pixels beyond the sides count for the tiles there. */
void rf_premultiply_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                         const struct rf_weights *pass, int ty, int worker)
{
    const struct rf_rect part = around_tiles(view, ty);
    const int left = view->border.x0, right = view->border.x1, tiles = view->tiles_x;
    const int width = tiles * RF_TILE, before = left / RF_TILE + 1, after = right / RF_TILE + 1;
    uint16_t *const scratch = rf_scratch(exec, worker), *const most = scratch + before;

    memset(scratch, 0, (size_t)(before + tiles + after) * sizeof scratch[0]);
    for (int y = part.y0; y < part.y1; y++) {
        premultiply(exec, pass, -left, y, scratch, left);
        premultiply(exec, pass, 0, y, most, width);
        premultiply(exec, pass, width, y, most + tiles, right);
    }
    if (pass->chroma)
        premultiply_chroma(exec, view, pass, part);
    most[0] = greatest(most[0], scratch, before);
    most[tiles - 1] = greatest(most[tiles - 1], most + tiles, after);
    for (int tx = 0; tx < tiles; tx++)
        pass->bins[(size_t)ty * tiles + tx].brightest = most[tx];
}
