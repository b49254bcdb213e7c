#include "planes/planes.h"
#include "tiles/tiles.h"

static int brightest(uint16_t *const light[3], ptrdiff_t at)
{
    int most = light[0][at];

    most = light[1][at] > most ? light[1][at] : most;
    most = light[2][at] > most ? light[2][at] : most;
    return most > RF_LIGHT_MAX ? RF_LIGHT_MAX : most; /* highlights lie above */
}

void rf_note_behind(struct refocus_renderer *r, int ty)
{
    for (int tx = 0; tx < r->tiles_x; tx++)
        r->bins[(size_t)ty * r->tiles_x + tx].behind =
            r->behind.blur[rf_tile_middle(r, tx, ty)];
}

void rf_weigh_rows(struct refocus_renderer *r, int ty)
{
    const int y0 = ty * RF_TILE - (ty == 0 ? r->border.y0 : 0);
    const int y1 = ty + 1 < r->tiles_y ? (ty + 1) * RF_TILE : r->height + r->border.y1;
    const int x1 = r->tiles_x * RF_TILE + r->border.x1;

    for (int y = y0; y < y1; y++) {
        const ptrdiff_t row = y * r->stride;
        uint16_t *seen = r->weight + y * r->weight_stride;
        uint16_t *behind = (uint16_t *)r->behind.blur + row;

        for (int x = -r->border.x0; x < x1; x++) {
            seen[x] = r->light_weight[brightest(r->smooth, row + x)];
            behind[x] = r->light_weight[brightest(r->behind.light, row + x)];
        }
    }
}
