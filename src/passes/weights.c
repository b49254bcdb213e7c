#include "passes/planes.h"

#include <string.h>

#include "tiles/tiles.h"

/* n pixels of a row of both layers. */
static void weigh(const struct refocus_renderer *r, int x, int y, uint16_t *brightest, int n)
{
    const ptrdiff_t at = y * r->view.stride + x;
    struct rf_weigh_job job = {
        .near_weight = r->weight.at + y * r->weight.stride + x,
        .far_weight = (uint16_t *)r->background.blur.at + at,
        .brightest = brightest,
        .light_weight = r->light_weight,
    };

    for (int c = 0; c < 3; c++) {
        job.near[c] = r->smooth.channel[c] + at;
        job.far[c] = r->background.light.channel[c] + at;
    }
    r->exec.kernels->weigh(&job, n);
}

/* The greatest of n values and v. */
static uint16_t greatest(uint16_t v, const uint16_t *values, int n)
{
    for (int i = 0; i < n; i++)
        v = values[i] > v ? values[i] : v;
    return v;
}

/* What lies beyond the sides counts for the tiles there. */
void rf_premultiply_rows(struct refocus_renderer *r, uint16_t *scratch, int ty)
{
    const int left = r->view.border.x0, right = r->view.border.x1,
              width = r->view.tiles_x * RF_TILE;
    const int y0 = ty * RF_TILE - (ty == 0 ? r->view.border.y0 : 0);
    const int y1 =
        ty + 1 < r->view.tiles_y ? (ty + 1) * RF_TILE : r->view.height + r->view.border.y1;
    const int tiles = r->view.tiles_x, before = left / RF_TILE + 1, after = right / RF_TILE + 1;
    uint16_t *brightest = scratch + before;

    memset(scratch, 0, (size_t)(before + tiles + after) * sizeof scratch[0]);
    for (int y = y0; y < y1; y++) {
        weigh(r, -left, y, scratch, left);
        weigh(r, 0, y, brightest, width);
        weigh(r, width, y, brightest + tiles, right);
    }
    brightest[0] = greatest(brightest[0], scratch, before);
    brightest[tiles - 1] = greatest(brightest[tiles - 1], brightest + tiles, after);
    for (int tx = 0; tx < tiles; tx++)
        r->bins[(size_t)ty * tiles + tx].brightest = brightest[tx];
}

static int brightest(uint16_t *const light[3], ptrdiff_t at)
{
    int most = light[0][at];

    most = light[1][at] > most ? light[1][at] : most;
    most = light[2][at] > most ? light[2][at] : most;
    return most > RF_LIGHT_MAX ? RF_LIGHT_MAX : most; /* highlights lie above */
}

void rf_weigh_rows(struct refocus_renderer *r, int ty)
{
    const int y0 = ty * RF_TILE - (ty == 0 ? r->view.border.y0 : 0);
    const int y1 =
        ty + 1 < r->view.tiles_y ? (ty + 1) * RF_TILE : r->view.height + r->view.border.y1;
    const int x1 = r->view.tiles_x * RF_TILE + r->view.border.x1;

    for (int y = y0; y < y1; y++) {
        const ptrdiff_t row = y * r->view.stride;
        uint16_t *seen = r->weight.at + y * r->weight.stride;
        uint16_t *behind = (uint16_t *)r->background.blur.at + row;

        for (int x = -r->view.border.x0; x < x1; x++) {
            seen[x] = r->light_weight[brightest(r->smooth.channel, row + x)];
            behind[x] = r->light_weight[brightest(r->background.light.channel, row + x)];
        }
    }
}
