/* diffusion_layer.c: the region that a layer blurs over, and how much it is blurred there.
 * Kosloff & Barsky 2007, sections 7.1 and 7.2. */
#include "methods/diffusion.h"
#include "renderer/bands.h"

#include <math.h>
#include <string.h>

static int lesser(int a, int b)
{
    return a < b ? a : b;
}

static bool is_member(const struct rf_diffusion_layer *layer, int x, int y)
{
    const struct refocus_renderer *r = layer->r;

    return x < 0 || y < 0 || x >= r->width || y >= r->height ||
           layer->member[(size_t)y * (size_t)r->width + (size_t)x] == layer->number;
}

/* A ring at a time is the same as the chessboard distance: two passes over the picture. */
static void number_rings(struct rf_diffusion_layer *layer)
{
    const int w = layer->r->width, h = layer->r->height;
    uint16_t *rings = layer->rings;

    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < h; j++) {
            const int y = pass ? h - 1 - j : j, dy = pass ? 1 : -1;

            if (rf_cancelled(layer->r))
                return;
            for (int i = 0; i < w; i++) {
                const int x = pass ? w - 1 - i : i;
                const size_t at = (size_t)y * (size_t)w + (size_t)x;
                int ring = pass ? rings[at]
                                : layer->member[at] == layer->number ? 0 : UINT16_MAX - 1;

                if (x + dy >= 0 && x + dy < w)
                    ring = lesser(ring, rings[at + (size_t)(ptrdiff_t)dy] + 1);
                for (int dx = -1; dx <= 1 && j > 0; dx++)
                    if (x + dx >= 0 && x + dx < w)
                        ring = lesser(ring, rings[at + (size_t)((ptrdiff_t)dy * w + dx)] + 1);
                rings[at] = (uint16_t)lesser(ring, UINT16_MAX - 1);
            }
        }
    }
}

bool rf_layer_grow(struct rf_diffusion_layer *layer)
{
    const int w = layer->r->width, h = layer->r->height;
    struct rf_box box = {w, h, 0, 0, layer->stride};
    float most = -1;

    for (int y = 0; y < h && !rf_cancelled(layer->r); y++)
        for (int x = 0; x < w; x++)
            if (layer->member[(size_t)y * (size_t)w + (size_t)x] == layer->number &&
                layer->radius[y * layer->stride + x] > most)
                most = layer->radius[y * layer->stride + x];
    if (most < 0)
        return false;
    /* A disc of radius r is matched by a Gaussian of sigma r / 2; 3 sigma hold 99 %. */
    layer->reach = most < 0.5f ? 0 : (int)ceilf(1.5f * most) + 2;
    number_rings(layer);
    for (int y = 0; y < h && !rf_cancelled(layer->r); y++) {
        for (int x = 0; x < w; x++) {
            if (layer->rings[(size_t)y * (size_t)w + (size_t)x] > layer->reach)
                continue;
            box.x0 = lesser(box.x0, x);
            box.y0 = lesser(box.y0, y);
            box.x1 = -lesser(-box.x1, -x - 1);
            box.y1 = -lesser(-box.y1, -y - 1);
        }
    }
    layer->box = box;
    return true;
}

void rf_layer_list_edge(struct rf_diffusion_layer *layer)
{
    const int w = layer->r->width, h = layer->r->height;
    int count = 0, *link = &layer->first_tile;

    for (int t = 0; t < layer->tiles_x * layer->tiles_y; t++) {
        struct rf_edge_tile *tile = &layer->tile[t];
        const int x0 = t % layer->tiles_x * RF_EDGE_TILE, y0 = t / layer->tiles_x * RF_EDGE_TILE;

        if (t % 64 == 0 && rf_cancelled(layer->r))
            return;
        *tile = (struct rf_edge_tile){.first = count};
        for (int y = y0; y < lesser(y0 + RF_EDGE_TILE, h); y++) {
            for (int x = x0; x < lesser(x0 + RF_EDGE_TILE, w); x++) {
                if (!is_member(layer, x, y) ||
                    (is_member(layer, x - 1, y) && is_member(layer, x + 1, y) &&
                     is_member(layer, x, y - 1) && is_member(layer, x, y + 1)))
                    continue;
                layer->edge[count++] = (struct rf_edge){(int16_t)(x - INT16_MAX),
                                                        (int16_t)(y - INT16_MAX)};
                tile->x += x;
                tile->y += y;
                tile->radius += layer->radius[y * layer->stride + x];
            }
        }
        tile->count = count - tile->first;
        if (tile->count > 0) {
            *link = t;
            link = &tile->next;
        }
    }
    *link = -1;
}

/* Eq. 3 with weights 1 / distance^2. The edge pixels of a tile that is farther than one tile
 * away count together, at their middle. */
static float extrapolate(const struct rf_diffusion_layer *layer, int x, int y)
{
    const int tx = x / RF_EDGE_TILE, ty = y / RF_EDGE_TILE;
    double sum = 0, weight = 0;

    for (int t = layer->first_tile; t >= 0; t = layer->tile[t].next) {
        const struct rf_edge_tile *tile = &layer->tile[t];
        const int i = t % layer->tiles_x, j = t / layer->tiles_x, n = tile->count;

        if (i < tx - 1 || i > tx + 1 || j < ty - 1 || j > ty + 1) {
            const double dx = tile->x / n - x, dy = tile->y / n - y;
            const double g = 1 / (dx * dx + dy * dy);

            sum += g * tile->radius;
            weight += g * n;
            continue;
        }
        for (int k = tile->first; k < tile->first + n; k++) {
            const int ex = layer->edge[k].x + INT16_MAX, ey = layer->edge[k].y + INT16_MAX;
            const double g = 1.0 / ((double)(ex - x) * (ex - x) + (double)(ey - y) * (ey - y));

            sum += g * layer->radius[ey * layer->stride + ex];
            weight += g;
        }
    }
    return weight > 0 ? (float)(sum / weight) : 0;
}

void rf_layer_extrapolate_row(const struct rf_diffusion_layer *layer, int y)
{
    const int w = layer->r->width;

    for (int x = layer->box.x0; x < layer->box.x1; x++) {
        const int ring = layer->rings[(size_t)y * (size_t)w + (size_t)x];

        if (rf_cancelled(layer->r))
            return;
        if (ring > 0 && ring <= layer->reach)
            layer->radius[y * layer->stride + x] = extrapolate(layer, x, y);
    }
}
