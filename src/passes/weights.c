/* weights.c: computes the highlight weights of eq. 5. */
#include "passes/weights.h"

#include "colour/transfer.h"
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
        if (pass->is_luminance)
            weigh_luminance_row(pass, y, part.x0, part.x1);
        else
            weigh_row(pass, y, part.x0, part.x1);
    }
}
