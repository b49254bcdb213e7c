/* diffusion.c: generalized depth of field by simulated heat diffusion, Kosloff & Barsky 2007.
 *
 * How much a point is blurred is a field in space, free of any lens: |s| as focus/ makes it. The
 * picture is split into layers by depth. Each is cut out with an alpha of 1, its region
 * grown, its blur extrapolated into the region (diffusion_layer.c), and its colours and alpha
 * flow as heat through a medium that conducts where there is blur (diffusion_solver.c): what
 * stays sharp is a barrier that no colour passes. The layers are composited back to front.
 *
 * A step with weight W everywhere adds W / 2 to the variance along an axis; a disc of
 * radius r has r^2 / 4. So W is proportional to r^2, and it takes r^2 / 2 W steps.
 */
#include "papers/diffusion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 5 }; /* light times weight, weight, alpha; premultiplied by alpha */

struct work {
    struct rf_frame *f;
    struct rf_series series;
    struct rf_diffusion_layer layer;
    uint8_t *member;
    float *weight; /* W of the layer's pixels; for the series, `across` */
    float *own, *radius;
    float *plane[CHANNELS]; /* the layer */
    float *scratch[2][CHANNELS];
    float *below[CHANNELS]; /* the layers composited so far */
    ptrdiff_t stride;
    uint64_t planes_size;                 /* floats of a plane */
    float most_radius, weight_per_square; /* W = weight_per_square radius^2 */
    int steps;
};

/* Lays out the memory of the arena; without any it fills *counted and only counts the bytes. */
static struct work *lay_out(const struct rf_limits *limits, struct rf_arena *arena,
                            struct work *counted)
{
    struct work *work = rf_arena_take(arena, 1, sizeof *work);
    const uint64_t w = (uint64_t)limits->width, h = (uint64_t)limits->height;
    const uint64_t size = (w + 2) * (h + 2), origin = w + 3; /* where pixel (0, 0) lies */
    float *plane;

    if (!work)
        work = counted;
#define PLANE(to)                                                                                  \
    ((to) = (plane = rf_arena_take(arena, size, sizeof(float))) ? plane + origin : NULL)
    for (int c = 0; c < CHANNELS; c++) {
        PLANE(work->plane[c]);
        PLANE(work->below[c]);
        for (int i = 0; i < 2; i++)
            PLANE(work->scratch[i][c]);
    }
    PLANE(work->weight);
    PLANE(work->own);
    PLANE(work->radius);
#undef PLANE
    work->planes_size = size;
    work->stride = (ptrdiff_t)w + 2;
    work->member = rf_arena_take(arena, w * h, 1);
    work->layer.rings = rf_arena_take(arena, w * h, sizeof(uint16_t));
    work->layer.span = rf_arena_take(arena, h, sizeof *work->layer.span);
    work->layer.tiles_x = (int)((w + RF_EDGE_TILE - 1) / RF_EDGE_TILE);
    work->layer.tiles_y = (int)((h + RF_EDGE_TILE - 1) / RF_EDGE_TILE);
    work->layer.tile =
        rf_arena_take(arena, (uint64_t)work->layer.tiles_x * (uint64_t)work->layer.tiles_y,
                      sizeof *work->layer.tile);
    return work;
}

static uint64_t work_bytes(const struct rf_limits *limits)
{
    struct rf_arena arena = {NULL, 0};
    struct work counted;

    lay_out(limits, &arena, &counted);
    return arena.used;
}

static void radius_row(void *context, int y, int worker)
{
    const struct work *work = context;

    (void)worker;
    for (int x = 0; x < work->f->view->width; x++)
        work->radius[y * work->stride + x] =
            (float)abs(work->f->blur.at[y * work->f->view->stride + x]) / 256;
}

/* Cuts the disparities into layers where the fewest pixels are, a least distance apart. */
static void split_layers(struct work *work)
{
    const struct rf_frame *f = work->f;
    const int layers = work->f->params->layers, apart = 256 / (2 * layers);
    uint32_t count[256] = {0};
    bool cut[257] = {false}; /* cut[i]: a layer begins at bin i */
    uint8_t number[256];

    for (int y = 0; y < f->view->height && !rf_cancelled(f->exec); y++)
        for (int x = 0; x < f->view->width; x++)
            count[f->disparity.at[y * f->view->stride + x] >> 8]++;
    for (int n = 1; n < layers; n++) {
        uint64_t least = UINT64_MAX;
        int best = 0;

        for (int i = apart; i <= 256 - apart; i++) {
            uint64_t near_by = 0;
            bool too_close = false;

            for (int j = i - apart + 1; j < i + apart; j++)
                too_close = too_close || cut[j];
            for (int j = i - 2; j < i + 2; j++)
                near_by += count[j < 0 ? 0 : j > 255 ? 255 : j];
            if (!too_close && near_by < least) {
                least = near_by;
                best = i;
            }
        }
        if (best > 0)
            cut[best] = true;
    }
    for (int i = 0, n = 0; i < 256; i++) {
        n += cut[i];
        number[i] = (uint8_t)n;
    }
    for (int y = 0; y < f->view->height && !rf_cancelled(f->exec); y++)
        for (int x = 0; x < f->view->width; x++)
            work->member[(size_t)y * (size_t)f->view->width + (size_t)x] =
                number[f->disparity.at[y * f->view->stride + x] >> 8];
}

static void extrapolate_tile(void *context, int item, int worker)
{
    const struct work *work = context;

    (void)worker;
    rf_layer_extrapolate_tile(&work->layer, item);
}

static float conductance(const struct work *work, float radius)
{
    const float most = work->layer.most, part = radius / most;

    if (work->f->params->solver == REFOCUS_SOLVER_ITERATED)
        return radius < 0.5f ? 0 : work->weight_per_square * radius * radius;
    return radius < 0.5f ? RF_ACROSS_LEAST : 0.5f * (part < 1 ? part * part : 1);
}

/* Sets the weights of the region, and puts the object alone into the planes. */
static void cut_out_row(void *context, int item, int worker)
{
    const struct work *work = context;
    const struct rf_diffusion_layer *layer = &work->layer;
    const struct rf_frame *f = work->f;
    const int y = layer->box.y0 + item;

    (void)worker;
    for (int x = layer->box.x0; x < layer->box.x1; x++) {
        const ptrdiff_t at = y * work->stride + x, p = y * f->view->stride + x;
        const int ring = layer->rings[(size_t)y * (size_t)f->view->width + (size_t)x];
        const float radius = ring == 0              ? work->radius[at]
                             : ring <= layer->reach ? work->weight[at]
                                                    : 0;
        const double w = ring == 0 ? rf_weight_of(f, p) : 0;

        work->weight[at] = conductance(work, radius);
        for (int c = 0; c < 3; c++)
            work->plane[c][at] = (float)(w * f->light.channel[c][p]);
        work->plane[3][at] = (float)w;
        work->plane[4][at] = ring == 0;
    }
}

static void own_row(void *context, int item, int worker)
{
    const struct work *work = context;
    const int y = work->layer.box.y0 + item;

    (void)worker;
    for (int x = work->layer.box.x0; x < work->layer.box.x1; x++) {
        const float *w = work->weight + y * work->stride + x;

        work->own[y * work->stride + x] =
            2 - ((w[-work->stride] + w[work->stride]) + (w[-1] + w[1]));
    }
}

static void diffuse_channel(void *context, int c, int worker)
{
    const struct work *work = context;
    const struct rf_frame *f = work->f;
    const struct rf_heat heat = {f,
                                 work->layer.box,
                                 work->layer.span,
                                 work->weight,
                                 work->own,
                                 f->exec->kernels->series_row};

    (void)worker;
    if (c == 3 && !f->weighted) { /* then weight and alpha are the same */
        return;
    }
    if (f->params->solver == REFOCUS_SOLVER_ITERATED)
        rf_diffuse_steps(f, &work->layer.box, work->weight, work->plane[c], work->scratch[0][c],
                         work->steps);
    else
        rf_diffuse_series(&heat, &work->series, work->plane[c], work->scratch[0][c],
                          work->scratch[1][c]);
}

/* Composites a row of the layer over the layers below it. These count as whole wherever there is
 * any of them, because a surface goes on behind the one that hides it. */
static void composite_row(void *context, int item, int worker)
{
    const struct work *work = context;
    const int y = work->layer.box.y0 + item;

    (void)worker;
    for (int x = work->layer.box.x0; x < work->layer.box.x1; x++) {
        const ptrdiff_t at = y * work->stride + x;
        const float below = work->below[4][at], alpha = work->plane[4][at];
        const float rest = (1 - alpha) / (below > 0.05f ? below : 0.05f);

        if (alpha < 1e-4f)
            continue;
        for (int c = 0; c < CHANNELS; c++)
            work->below[c][at] = (alpha < 1 ? rest * work->below[c][at] : 0) +
                                 work->plane[c == 3 && !work->f->weighted ? 4 : c][at];
    }
}

/* Clears rows y0 - 1 to y1 of a plane, its sides included. */
static void clear(const struct work *work, float *plane, int y0, int y1)
{
    for (int y = y0 - 1; y <= y1 && !rf_cancelled(work->f->exec); y++)
        memset(plane + y * work->stride - 1, 0, sizeof(float) * (size_t)work->stride);
}

static void do_layer(struct work *work, int number)
{
    struct rf_diffusion_layer *layer = &work->layer;
    struct rf_pool *pool = work->f->exec->pool;
    int rows;

    layer->number = number;
    if (!rf_layer_grow(layer) || rf_cancelled(work->f->exec))
        return;
    rows = layer->box.y1 - layer->box.y0;
    clear(work, work->weight, layer->box.y0, layer->box.y1);
    if (layer->reach > 0) {
        layer->edge_x = work->scratch[0][0];
        layer->edge_y = work->scratch[0][1];
        layer->edge_radius = work->scratch[0][2];
        rf_layer_list_edge(layer);
        if (rf_cancelled(work->f->exec)) /* a cancelled list may have no end */
            return;
        rf_pool_run(pool, extrapolate_tile, work, layer->tiles_x * layer->tiles_y);
    }
    for (int c = 0; c < CHANNELS; c++) {
        clear(work, work->plane[c], layer->box.y0, layer->box.y1);
        for (int i = 0; i < 2; i++)
            clear(work, work->scratch[i][c], layer->box.y0, layer->box.y1);
    }
    rf_pool_run(pool, cut_out_row, work, rows);
    if (layer->reach > 0) {
        if (work->f->params->solver == REFOCUS_SOLVER_FAST) {
            rf_pool_run(pool, own_row, work, rows);
            rf_series_make(&work->series, work->steps,
                           (double)work->weight_per_square * layer->most * layer->most);
        }
        rf_pool_run(pool, diffuse_channel, work, CHANNELS);
    }
    if (!rf_cancelled(work->f->exec))
        rf_pool_run(pool, composite_row, work, rows);
}

static void write_row(void *context, int item, int worker)
{
    const struct work *work = context;
    const struct rf_frame *f = work->f;
    const int y = f->region.y0 + item;

    (void)worker;
    for (int x = f->region.x0; x < f->region.x1; x++) {
        const ptrdiff_t at = y * work->stride + x, p = y * f->view->stride + x;
        /* Where almost nothing was composited, the picture itself counts. */
        const double own = work->below[4][at] < 0.05 ? 0.05 - work->below[4][at] : 0;
        const double w = own * rf_weight_of(f, p);
        double light[3];

        for (int c = 0; c < 3; c++)
            light[c] = work->below[c][at] + w * f->light.channel[c][p];
        if (work->below[3][at] + w > 0)
            rf_write_real(f, x, y, light, work->below[3][at] + w);
        else
            rf_copy_tile(f, (struct rf_rect){x, y, x + 1, y + 1});
    }
}

static void measure(struct work *work)
{
    const struct rf_frame *f = work->f;
    double steps;

    work->most_radius = 0;
    for (int y = 0; y < f->view->height && !rf_cancelled(f->exec); y++)
        for (int x = 0; x < f->view->width; x++)
            work->most_radius = fmaxf(work->most_radius, work->radius[y * work->stride + x]);
    steps = (double)work->most_radius * work->most_radius / (2 * work->f->params->conductivity);
    work->steps = (int)ceil(steps);
}

static void render_frame(struct rf_frame *f)
{
    const struct rf_limits limits = f->limits;
    struct rf_arena arena = {f->work->at, 0};
    struct work *work = lay_out(&limits, &arena, NULL);

    f->work->owner = RF_NO_METHOD;
    work->f = f;
    work->layer.f = f;
    work->layer.member = work->member;
    work->layer.radius = work->radius;
    work->layer.outside = work->weight;
    work->layer.stride = work->stride;
    work->layer.tiles_x = (f->view->width + RF_EDGE_TILE - 1) / RF_EDGE_TILE;
    work->layer.tiles_y = (f->view->height + RF_EDGE_TILE - 1) / RF_EDGE_TILE;
    for (int c = 0; c < CHANNELS; c++)
        clear(work, work->below[c], 0, f->view->height);
    rf_pool_run(f->exec->pool, radius_row, work, f->view->height);
    if (rf_cancelled(f->exec))
        return;
    measure(work);
    split_layers(work);
    if (rf_cancelled(f->exec))
        return;
    if (work->most_radius < 0.5f)
        work->most_radius = 1; /* nothing conducts */
    work->weight_per_square = f->params->conductivity / (work->most_radius * work->most_radius);
    for (int i = 0; i < f->params->layers && !rf_cancelled(f->exec); i++)
        do_layer(work, i);
    rf_pool_run(f->exec->pool, write_row, work, f->region.y1 - f->region.y0);
}

const struct rf_method rf_diffusion_method = {.frame = render_frame, .work_bytes = work_bytes};
