/* diffusion_layer.c: the region that a layer blurs over, and how much it is blurred there.
 * Kosloff & Barsky 2007, sections 7.1 and 7.2. */
#include "papers/diffusion.h"
#include "image/viewport.h"
#include "support/compare.h"

#include <math.h>
#include <string.h>

static bool is_member(const struct rf_diffusion_layer *layer, int x, int y)
{
    const struct rf_frame *f = layer->f;

    return x < 0 || y < 0 || x >= f->view->width || y >= f->view->height ||
           layer->member[(size_t)y * (size_t)f->view->width + (size_t)x] == layer->number;
}

/* The least of three neighbours in the row before, and one more. */
static void from_row_before(uint16_t *restrict row, const uint16_t *restrict before, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t side = before[x - 1] < before[x + 1] ? before[x - 1] : before[x + 1];
        const uint16_t least = (uint16_t)((side < before[x] ? side : before[x]) + 1);

        row[x] = least < row[x] ? least : row[x];
    }
}

/* A ring at a time is the same as the chessboard distance: two passes over the picture, down
 * and to the right, up and to the left. */
static void number_rings(struct rf_diffusion_layer *layer)
{
    const int w = layer->f->view->width, h = layer->f->view->height;

    for (int j = 0; j < 2 * h; j++) {
        const bool up = j >= h;
        const int y = up ? 2 * h - 1 - j : j, step = up ? -1 : 1;
        uint16_t *row = layer->rings + (size_t)y * (size_t)w;
        const uint16_t *before = up ? row + w : row - w;
        int ring = UINT16_MAX - 1;

        if (rf_cancelled(layer->f->exec))
            return;
        for (int x = 0; x < w && !up; x++)
            row[x] = layer->member[(size_t)y * (size_t)w + (size_t)x] == layer->number
                         ? 0
                         : UINT16_MAX - 1;
        if (j % h > 0) {
            if (w > 2)
                from_row_before(row + 1, before + 1, w - 2);
            row[0] = (uint16_t)rf_smaller(row[0], rf_smaller(before[0], before[w > 1]) + 1);
            row[w - 1] = (uint16_t)rf_smaller(
                row[w - 1], rf_smaller(before[w - 1], before[w - 1 - (w > 1)]) + 1);
        }
        for (int x = up ? w - 1 : 0; x >= 0 && x < w; x += step)
            row[x] = (uint16_t)(ring = rf_smaller(row[x], ring + 1));
    }
}

bool rf_layer_grow(struct rf_diffusion_layer *layer)
{
    const int w = layer->f->view->width, h = layer->f->view->height;
    struct rf_box box = {w, h, 0, 0, layer->stride};
    float most = -1;

    for (int y = 0; y < h && !rf_cancelled(layer->f->exec); y++)
        for (int x = 0; x < w; x++)
            if (layer->member[(size_t)y * (size_t)w + (size_t)x] == layer->number &&
                layer->radius[y * layer->stride + x] > most)
                most = layer->radius[y * layer->stride + x];
    if (most < 0)
        return false;
    /* A disc of radius r is matched by a Gaussian of sigma r / 2; 3 sigma hold 99 %. */
    layer->most = most;
    layer->reach = most < 0.5f ? 0 : (int)ceilf(1.5f * most) + 2;
    number_rings(layer);
    for (int y = 0; y < h && !rf_cancelled(layer->f->exec); y++) {
        struct rf_span *span = &layer->span[y];

        *span = (struct rf_span){w, 0};
        for (int x = 0; x < w; x++) {
            if (layer->rings[(size_t)y * (size_t)w + (size_t)x] > layer->reach + 1)
                continue;
            span->x0 = rf_smaller(span->x0, x);
            span->x1 = x + 1;
        }
        if (span->x0 >= span->x1) {
            *span = (struct rf_span){0, 0};
            continue;
        }
        box.x0 = rf_smaller(box.x0, span->x0);
        box.y0 = rf_smaller(box.y0, y);
        box.x1 = -rf_smaller(-box.x1, -span->x1);
        box.y1 = y + 1;
    }
    layer->box = box;
    return true;
}

void rf_layer_list_edge(struct rf_diffusion_layer *layer)
{
    const int w = layer->f->view->width, h = layer->f->view->height;
    int count = 0, *link = &layer->first_tile;

    for (int t = 0; t < layer->tiles_x * layer->tiles_y; t++) {
        struct rf_edge_tile *tile = &layer->tile[t];
        const int x0 = t % layer->tiles_x * RF_EDGE_TILE, y0 = t / layer->tiles_x * RF_EDGE_TILE;

        if (t % 64 == 0 && rf_cancelled(layer->f->exec))
            return;
        *tile = (struct rf_edge_tile){.first = count};
        for (int y = y0; y < rf_smaller(y0 + RF_EDGE_TILE, h); y++) {
            for (int x = x0; x < rf_smaller(x0 + RF_EDGE_TILE, w); x++) {
                if (!is_member(layer, x, y) ||
                    (is_member(layer, x - 1, y) && is_member(layer, x + 1, y) &&
                     is_member(layer, x, y - 1) && is_member(layer, x, y + 1)))
                    continue;
                layer->edge_x[count] = (float)x;
                layer->edge_y[count] = (float)y;
                layer->edge_radius[count] = layer->radius[y * layer->stride + x];
                tile->x += (float)x;
                tile->y += (float)y;
                tile->radius += layer->edge_radius[count++];
            }
        }
        tile->count = count - tile->first;
        if (tile->count > 0) {
            tile->x /= (float)tile->count;
            tile->y /= (float)tile->count;
            tile->radius /= (float)tile->count;
            *link = t;
            link = &tile->next;
        }
    }
    *link = -1;
}

/* Eq. 3: sums of 1 / distance^2, and of radii by them. */
struct sums {
    float weight[RF_EDGE_TILE], radius[RF_EDGE_TILE];
};

/* Adds an edge pixel, or `count` of them together, to the sums of n points of a row, `step` apart.
 */
static void add_edge(struct sums *restrict sums, float dx, float dy, float step, float count,
                     float radius, int n)
{
    for (int i = 0; i < n; i++) {
        const float x = dx - step * (float)i, g = count / (x * x + dy * dy);

        sums->weight[i] += g;
        sums->radius[i] += g * radius;
    }
}

enum { NODES = 5, NODE_STEP = RF_EDGE_TILE / (NODES - 1) };

/* The sums over edge pixels that are farther than one tile away vary slowly: those of a tile
 * count together, at their middle, and between nodes the sums are interpolated. */
static void far_sums(const struct rf_diffusion_layer *layer, int tx, int ty,
                     struct sums node[NODES])
{
    memset(node, 0, NODES * sizeof *node);
    for (int t = layer->first_tile; t >= 0; t = layer->tile[t].next) {
        const struct rf_edge_tile *tile = &layer->tile[t];
        const int i = t % layer->tiles_x, j = t / layer->tiles_x;
        const float dx = tile->x - (float)(tx * RF_EDGE_TILE);
        const float dy = tile->y - (float)(ty * RF_EDGE_TILE);

        if (i >= tx - 1 && i <= tx + 1 && j >= ty - 1 && j <= ty + 1)
            continue;
        for (int k = 0; k < NODES; k++)
            add_edge(&node[k], dx, dy - (float)(k * NODE_STEP), NODE_STEP, (float)tile->count,
                     tile->radius, NODES);
    }
}

static void interpolate(const struct sums node[NODES], int y, struct sums *out)
{
    const int j = y / NODE_STEP;
    const float ay = (float)(y % NODE_STEP) / NODE_STEP;

    for (int x = 0; x < RF_EDGE_TILE; x++) {
        const int i = x / NODE_STEP;
        const float ax = (float)(x % NODE_STEP) / NODE_STEP;

        out->weight[x] = (1 - ay) * ((1 - ax) * node[j].weight[i] + ax * node[j].weight[i + 1]) +
                         ay * ((1 - ax) * node[j + 1].weight[i] + ax * node[j + 1].weight[i + 1]);
        out->radius[x] = (1 - ay) * ((1 - ax) * node[j].radius[i] + ax * node[j].radius[i + 1]) +
                         ay * ((1 - ax) * node[j + 1].radius[i] + ax * node[j + 1].radius[i + 1]);
    }
}

static void add_near(const struct rf_diffusion_layer *layer, int tx, int ty, int y,
                     struct sums *sums)
{
    for (int j = ty - 1; j <= ty + 1; j++) {
        for (int i = tx - 1; i <= tx + 1; i++) {
            const struct rf_edge_tile *tile;

            if (i < 0 || j < 0 || i >= layer->tiles_x || j >= layer->tiles_y)
                continue;
            tile = &layer->tile[j * layer->tiles_x + i];
            for (int k = tile->first; k < tile->first + tile->count; k++)
                add_edge(sums, layer->edge_x[k] - (float)(tx * RF_EDGE_TILE),
                         layer->edge_y[k] - (float)y, 1, 1, layer->edge_radius[k], RF_EDGE_TILE);
        }
    }
}

static bool is_outside(const struct rf_diffusion_layer *layer, int x, int y)
{
    const int ring = layer->rings[(size_t)y * (size_t)layer->f->view->width + (size_t)x];

    return ring > 0 && ring <= layer->reach;
}

void rf_layer_extrapolate_tile(const struct rf_diffusion_layer *layer, int tile)
{
    const int tx = tile % layer->tiles_x, ty = tile / layer->tiles_x;
    const int x0 = tx * RF_EDGE_TILE, x1 = rf_smaller(x0 + RF_EDGE_TILE, layer->f->view->width);
    const int y0 = ty * RF_EDGE_TILE, y1 = rf_smaller(y0 + RF_EDGE_TILE, layer->f->view->height);
    struct sums node[NODES], sums;
    bool have_nodes = false;

    for (int y = y0; y < y1; y++) {
        int any = 0;

        for (int x = x0; x < x1; x++)
            any += is_outside(layer, x, y);
        if (!any)
            continue;
        if (!have_nodes)
            far_sums(layer, tx, ty, node);
        have_nodes = true;
        interpolate(node, y - y0, &sums);
        add_near(layer, tx, ty, y, &sums);
        for (int x = x0; x < x1; x++)
            if (is_outside(layer, x, y))
                layer->outside[y * layer->stride + x] = sums.radius[x - x0] / sums.weight[x - x0];
    }
}
