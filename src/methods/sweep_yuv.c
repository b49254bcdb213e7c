/* sweep_yuv.c: the sweep for a photo of Y, U and V.
 *
 * What sweep.c does for three planes is done here for luma and, with the same slabs, for chroma,
 * whose samples lie two pixels apart: its rays are half as long across, and in 4:2:0 down,
 * and fewer of them lie as densely among its samples.
 */
#include "methods/method.h"
#include "methods/tile_rows.h"

#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* Luma or chroma, from a tile's first element on. */
struct plane {
    const int16_t *blur;
    const uint16_t *light, *behind;
    const uint16_t *weighing, *weighing_behind; /* luma of the tile, for eq. 5 */
    int rows, steps;
    struct rf_tile_rows computed;
    ptrdiff_t row[RF_TILE]; /* where those are, elements */
    int across, down; /* shifts from pixels to samples */
    const uint32_t *range; /* of the tile's first pixel */
    const struct rf_ray_set *set;
};

/* rf_offset() in samples of 1 << shift pixels. */
static int offset(int u, int s, int shift)
{
    return (u * s + (1 << (22 + shift))) >> (23 + shift);
}

/* Elements of a plane, across and down. */
struct place {
    int x, y;
};

static struct place shift_of(const struct plane *plane, const struct refocus_ray *ray, int blur)
{
    return (struct place){offset(ray->u, blur, plane->across) * (1 << plane->across),
                          offset(ray->v, blur, plane->down)};
}

/* Where some rays see the slabs of a tile, and the background. */
struct sight {
    int rays;
    int32_t offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t cell[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
};

static void set_sight(struct sight *sight, const struct refocus_renderer *r,
                      const struct plane *plane, const struct rf_tile_plan *plan,
                      const struct refocus_ray *ray, int behind)
{
    int16_t u[RF_RAY_CHUNK], v[RF_RAY_CHUNK];

    for (int n = 0; n < sight->rays; n++) {
        u[n] = ray[n].u;
        v[n] = ray[n].v;
    }
    for (int k = 0; k <= plan->slabs; k++) {
        const int blur = k < plan->slabs ? plan->slab[k].centre : behind;

        if (plane->across)
            r->kernels.aim_chroma(sight->offset[k], sight->cell[k], u, v, blur, plane->down,
                                  (int32_t)r->stride, (int32_t)r->range_stride, sight->rays);
        else
            r->kernels.aim(sight->offset[k], sight->cell[k], u, v, blur, (int32_t)r->stride,
                           (int32_t)r->range_stride, sight->rays);
    }
}

/* Strips of a tile together: of one plane, sorting each by itself costs more than it saves. */
static void sweep_tile(const struct refocus_renderer *r, const struct rf_tile_plan *plan,
                       const struct plane *plane, const struct sight *sight,
                       uint32_t run[LANES])
{
    struct rf_sorted_rays sorted;
    const struct rf_sort_job sort = {
        .range = plane->range,
        .below = plane->range + RF_STRIP / RF_CELL * r->range_stride,
        .front = plane->light,
        .behind = plane->behind,
        .rays = sight->rays,
        .slabs = plan->slabs,
        .slab = plan->slab,
        .joined = plan->joined,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])sight->offset,
        .cell = (const int32_t(*)[RF_RAY_CHUNK])sight->cell,
    };
    const struct rf_sweep1_job job = {
        .blur = plane->blur,
        .light = plane->light,
        .row = plane->row,
        .rows = plane->computed.count,
        .steps = plane->steps,
        .rays = &sorted,
    };

    r->kernels.sort_rays(&sorted, &sort);
    r->kernels.sweep1(run, &job);
}

static void add_run(uint32_t run[LANES], uint64_t weight, uint64_t sum[LANES])
{
    for (int i = 0; i < LANES; i++)
        sum[i] += weight * run[i];
    memset(run, 0, LANES * sizeof run[0]);
}

/* As sweep_rays() of sweep.c: sums of rays of one weight in `run`, of others in `sum`. */
static void sweep_rays(const struct rf_frame *f, const struct rf_tile_plan *plan,
                       const struct plane *plane, int behind, uint32_t run[LANES],
                       uint64_t sum[LANES])
{
    const struct rf_ray_set *set = plane->set;
    struct sight sight;

    memset(run, 0, LANES * sizeof run[0]);
    for (int n = 0; n < set->count; n += sight.rays) {
        const struct refocus_ray *ray = &set->ray[n];

        sight.rays = rf_rays_alike(set, n);
        set_sight(&sight, f->r, plane, plan, ray, behind);
        sweep_tile(f->r, plan, plane, &sight, run);
        if (!set->equal &&
            (n + sight.rays == set->count || ray[sight.rays].weight != ray->weight))
            add_run(run, ray->weight, sum);
    }
}

/* Weight of eq. 5: of luma, of chroma that of the first pixel that shares the sample. */
static uint64_t weight_of(const struct rf_frame *f, const struct plane *plane,
                          const uint16_t *luma, struct place q)
{
    const int x = q.x - (plane->across ? q.x & 1 : 0), y = q.y * (1 << plane->down);
    const uint16_t light = luma[y * f->r->stride + x];

    return f->r->light_weight[light > RF_LIGHT_MAX ? RF_LIGHT_MAX : light];
}

/* One ray with eq. 5's weights, plain C. */
static void weigh_ray(const struct rf_frame *f, const struct rf_tile_plan *plan,
                      const struct plane *plane, const struct refocus_ray *ray, int behind,
                      uint64_t sum[LANES], uint64_t weight[LANES])
{
    struct place shift[RF_MAX_SLABS + 1];

    for (int k = 0; k <= plan->slabs; k++)
        shift[k] = shift_of(plane, ray, k < plan->slabs ? plan->slab[k].centre : behind);
    for (int i = 0; i < plane->rows * RF_TILE; i++) {
        struct place q = {0, 0};
        ptrdiff_t at = 0;
        uint64_t w;
        int k = 0;

        for (;; k++) {
            q = (struct place){i % RF_TILE + shift[k].x, i / RF_TILE + shift[k].y};
            at = q.y * f->r->stride + q.x;
            if (k == plan->slabs ||
                (uint16_t)(plane->blur[at] - plan->slab[k].low) <= plan->slab[k].width)
                break;
        }
        w = ray->weight * weight_of(f, plane,
                                    k < plan->slabs ? plane->weighing : plane->weighing_behind,
                                    q);
        sum[i] += w * (k < plan->slabs ? plane->light[at] : plane->behind[at]);
        weight[i] += w;
    }
}

static void set_rows(struct plane *plane, struct rf_tile_rows rows, ptrdiff_t stride)
{
    plane->computed = rows;
    for (int i = 0; i < rows.count; i++)
        plane->row[i] = rf_row_at(rows, i) * stride;
}

/* Means of rays that weigh the same, of some rows and then of those between. */
static void sweep_means(const struct rf_frame *f, const struct rf_tile_plan *plan,
                        const struct plane *plane, int behind, uint16_t mean[LANES])
{
    const struct rf_kernels *kernels = &f->r->kernels;
    const bool all = plane->computed.step == 1;
    uint16_t computed[LANES];
    uint32_t run[LANES];

    sweep_rays(f, plan, plane, behind, run, NULL);
    kernels->means(all ? mean : computed, run, rf_mean_scale((uint64_t)plane->set->count),
                   plane->computed.count * RF_TILE);
    if (!all && plane->rows == RF_TILE)
        kernels->between_rows(mean, computed, plane->computed.step);
    else if (!all)
        kernels->between_chroma(mean, computed);
}

static void sweep_plane(const struct rf_frame *f, const struct rf_tile_plan *plan,
                        struct plane *plane, int behind, uint16_t mean[LANES])
{
    const struct rf_ray_set *set = plane->set;
    const ptrdiff_t stride = f->r->stride;
    uint64_t sum[LANES], weight[LANES];
    uint32_t run[LANES];

    if (set->equal && !f->weighted) {
        set_rows(plane,
                 plane->rows == RF_TILE ? rf_tile_rows(f, plan, behind)
                                        : rf_chroma_rows(f, plan, behind),
                 stride);
        sweep_means(f, plan, plane, behind, mean);
        return;
    }
    set_rows(plane, (struct rf_tile_rows){1, plane->rows}, stride);
    memset(sum, 0, sizeof sum);
    memset(weight, 0, sizeof weight);
    if (f->weighted) {
        for (int n = 0; n < set->count; n++)
            weigh_ray(f, plan, plane, &set->ray[n], behind, sum, weight);
    } else {
        sweep_rays(f, plan, plane, behind, run, sum);
        for (int i = 0; i < LANES; i++)
            weight[i] = set->total_weight;
    }
    for (int i = 0; i < plane->rows * RF_TILE; i++)
        mean[i] = (uint16_t)((4 * sum[i] + weight[i] / 2) / weight[i]);
}

void rf_sweep_yuv_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect,
                       int worker)
{
    const struct refocus_renderer *r = f->r;
    const struct rf_yuv *yuv = &r->yuv;
    const ptrdiff_t origin = ty * RF_TILE * r->stride + tx * RF_TILE;
    const ptrdiff_t at = (ty * RF_TILE >> yuv->down) * r->stride + tx * RF_TILE;
    const int behind = r->behind.blur[rf_tile_middle(r, tx, ty)];
    const uint32_t *range =
        r->range + RF_TILE / RF_CELL * (ty * r->range_stride + tx);
    struct plane luma = {
        .blur = r->front.blur + origin,
        .light = r->smooth[0] + origin,
        .behind = r->behind.light[0] + origin,
        .weighing = r->smooth[0] + origin,
        .weighing_behind = r->behind.light[0] + origin,
        .rows = RF_TILE,
        .range = range,
        .steps = f->bright ? 4 : 16,
    };
    struct plane chroma = {
        .blur = yuv->blur + at,
        .light = yuv->smooth + at,
        .behind = yuv->behind + at,
        .weighing = r->smooth[0] + origin,
        .weighing_behind = r->behind.light[0] + origin,
        .rows = RF_TILE >> yuv->down,
        .range = range,
        .steps = 65535 / RF_CHROMA_MAX, /* 8 */
        .across = 1,
        .down = yuv->down,
    };
    struct rf_decode_job means;
    struct rf_tile_plan plan;

    (void)worker;
    rf_plan_tile(r, f->scale, &f->reach, tx, ty, &plan);
    if (plan.sharp) {
        rf_copy_yuv_tile(f, rect);
        return;
    }
    luma.set = rf_rays_for(r, plan.reach, plan.lamp);
    chroma.set = rf_chroma_rays(r, luma.set);
    sweep_plane(f, &plan, &luma, behind, means.luma);
    sweep_plane(f, &plan, &chroma, behind, means.chroma);
    rf_encode_yuv_means(f, tx, ty, rect, &means);
}
