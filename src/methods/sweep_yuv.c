/* sweep_yuv.c: the sweep for a photo of Y, U and V.
 *
 * What sweep.c does for three planes is done here for luma and, with the same slabs, for chroma,
 * whose samples lie two pixels apart: rays are half as long there across, and in 4:2:0 down, and
 * some of them lie as densely among its samples as all do among pixels.
 */
#include "methods/method.h"
#include "methods/tile_rows.h"

#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* Luma or chroma, from a tile's first element on. */
struct plane {
    const int16_t *blur;
    const uint16_t *light, *behind;
    int rows, steps;
    struct rf_tile_rows computed;
    int across, down; /* shifts from pixels to samples */
};

struct tile {
    const struct rf_frame *f;
    struct rf_tile_plan plan;
    const struct rf_ray_set *set;
    int behind;            /* blur of the background */
    const uint32_t *range; /* of the tile's first pixel, */
    const uint16_t *weighing, *weighing_behind; /* and luma, for eq. 5 */
    struct plane luma, chroma;
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

/* Some rays of one weight, where they see the slabs of the tile and the background, and what they
 * have to look at. */
struct sight {
    int rays;
    const int16_t *u, *v;
    int16_t own_u[RF_RAY_CHUNK], own_v[RF_RAY_CHUNK];
    int32_t offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t cell[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t chroma_offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK]; /* of the first of them */
    struct rf_sorted_rays sorted;
};

static void set_rays(struct sight *sight, const struct rf_ray_set *set, int first)
{
    sight->rays = rf_rays_alike(set, first);
    sight->u = set->u ? set->u + first : sight->own_u;
    sight->v = set->u ? set->v + first : sight->own_v;
    for (int n = 0; !set->u && n < sight->rays; n++) {
        sight->own_u[n] = set->ray[first + n].u;
        sight->own_v[n] = set->ray[first + n].v;
    }
}

static void sweep_plane(const struct tile *tile, const struct plane *plane,
                        const struct rf_sorted_rays *rays, uint32_t run[LANES])
{
    const struct refocus_renderer *r = tile->f->r;
    const struct rf_sweep1_job job = {
        .blur = plane->blur,
        .light = plane->light,
        .apart = rf_row_at(plane->computed, 1) * r->stride,
        .half = rf_row_at(plane->computed, plane->computed.count / 2) * r->stride,
        .rows = plane->computed.count,
        .steps = plane->steps,
        .chroma = plane->across,
        .rays = rays,
    };

    r->kernels.sweep1(run, &job);
}

/* Rays, of which chroma shares the first so many. Strips of a tile together: of one plane, sorting
 * each by itself costs more than it saves. */
static void sort_rays(const struct tile *tile, struct sight *sight, int shared)
{
    const struct refocus_renderer *r = tile->f->r;
    const struct rf_sort_job job = {
        .range = tile->range,
        .front = tile->luma.light,
        .behind = tile->luma.behind,
        .rays = sight->rays,
        .slabs = tile->plan.slabs,
        .slab = tile->plan.slab,
        .joined = tile->plan.joined,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])sight->offset,
        .cell = (const int32_t(*)[RF_RAY_CHUNK])sight->cell,
        .shared = shared,
        .chroma_offset = (const int32_t(*)[RF_RAY_CHUNK])sight->chroma_offset,
        .chroma_front = tile->chroma.light,
        .chroma_behind = tile->chroma.behind,
    };

    for (int k = 0; k <= tile->plan.slabs; k++) {
        const int blur = k < tile->plan.slabs ? tile->plan.slab[k].centre : tile->behind;

        r->kernels.aim(sight->offset[k], sight->cell[k], sight->u, sight->v, blur,
                       (int32_t)r->stride, (int32_t)r->range_stride, sight->rays);
        r->kernels.aim_chroma(sight->chroma_offset[k], sight->u, sight->v, blur,
                              tile->chroma.down, (int32_t)r->stride, shared);
    }
    r->kernels.sort_rays(&sight->sorted, &job);
}

/* Sums of luma and of chroma: of rays of one weight in `run`, of others times their weight in
 * `sum`. */
struct sums {
    uint32_t run[2][LANES];
    uint64_t sum[2][LANES], weight[2][LANES];
};

static void add_run(struct sums *sums, uint64_t weight)
{
    for (int p = 0; p < 2; p++)
        for (int i = 0; i < LANES; i++)
            sums->sum[p][i] += weight * sums->run[p][i];
    memset(sums->run, 0, sizeof sums->run);
}

/* As sweep_rays() of sweep.c. */
static void sweep_rays(const struct tile *tile, struct sums *sums)
{
    const struct rf_ray_set *set = tile->set;
    struct sight sight;

    memset(sums->run[0], 0, (size_t)tile->luma.computed.count * RF_TILE * sizeof sums->run[0][0]);
    memset(sums->run[1], 0,
           (size_t)tile->chroma.computed.count * RF_TILE * sizeof sums->run[1][0]);
    for (int n = 0, end; n < set->count; n = end) {
        const uint64_t weight = set->ray[n].weight;

        set_rays(&sight, set, n);
        end = n + sight.rays;
        sort_rays(tile, &sight, rf_shared_rays(set, n, end));
        sweep_plane(tile, &tile->luma, &sight.sorted, sums->run[0]);
        sweep_plane(tile, &tile->chroma, &sight.sorted, sums->run[1]);
        if (!set->equal && (end == set->count || set->ray[end].weight != weight))
            add_run(sums, weight);
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
static void weigh_ray(const struct tile *tile, const struct plane *plane,
                      const struct refocus_ray *ray, uint64_t sum[LANES], uint64_t weight[LANES])
{
    const struct rf_tile_plan *plan = &tile->plan;
    const ptrdiff_t stride = tile->f->r->stride;
    struct place shift[RF_MAX_SLABS + 1];

    for (int k = 0; k <= plan->slabs; k++)
        shift[k] = shift_of(plane, ray, k < plan->slabs ? plan->slab[k].centre : tile->behind);
    for (int i = 0; i < plane->rows * RF_TILE; i++) {
        struct place q = {0, 0};
        ptrdiff_t at = 0;
        uint64_t w;
        int k = 0;

        for (;; k++) {
            q = (struct place){i % RF_TILE + shift[k].x, i / RF_TILE + shift[k].y};
            at = q.y * stride + q.x;
            if (k == plan->slabs ||
                (uint16_t)(plane->blur[at] - plan->slab[k].low) <= plan->slab[k].width)
                break;
        }
        w = ray->weight * weight_of(tile->f, plane,
                                    k < plan->slabs ? tile->weighing : tile->weighing_behind, q);
        sum[i] += w * (k < plan->slabs ? plane->light[at] : plane->behind[at]);
        weight[i] += w;
    }
}

static void weigh_rays(const struct tile *tile, struct sums *sums)
{
    const struct rf_ray_set *set = tile->set;

    for (int n = 0, end; n < set->count; n = end) {
        const int shared = rf_shared_rays(set, n, end = n + rf_rays_alike(set, n));

        for (int i = n; i < end; i++)
            weigh_ray(tile, &tile->luma, &set->ray[i], sums->sum[0], sums->weight[0]);
        for (int i = n; i < n + shared; i++)
            weigh_ray(tile, &tile->chroma, &set->ray[i], sums->sum[1], sums->weight[1]);
    }
}

/* Means of rays that weigh the same, of some rows and then of those between. */
static void take_means(const struct tile *tile, const struct plane *plane, const uint32_t *run,
                       int rays, uint16_t mean[LANES])
{
    const struct rf_kernels *kernels = &tile->f->r->kernels;
    const bool all = plane->computed.step == 1;
    uint16_t computed[LANES];

    kernels->means(all ? mean : computed, run, rf_mean_scale((uint64_t)rays),
                   plane->computed.count * RF_TILE);
    if (!all && plane->rows == RF_TILE)
        kernels->between_rows(mean, computed, plane->computed.step);
    else if (!all)
        kernels->between_chroma(mean, computed);
}

static void sweep_means(struct tile *tile, struct sums *sums, struct rf_decode_job *means)
{
    const struct rf_frame *f = tile->f;

    tile->luma.computed = rf_tile_rows(f, &tile->plan, tile->behind);
    tile->chroma.computed = tile->chroma.down ? rf_chroma_rows(f, &tile->plan, tile->behind)
                                              : tile->luma.computed;
    sweep_rays(tile, sums);
    take_means(tile, &tile->luma, sums->run[0], tile->set->count, means->luma);
    take_means(tile, &tile->chroma, sums->run[1], tile->set->shared, means->chroma);
}

/* The same from rays that do not weigh the same, or from eq. 5. */
static void sweep_sums(struct tile *tile, struct sums *sums, struct rf_decode_job *means)
{
    const int lanes[2] = {LANES, tile->chroma.rows * RF_TILE};
    uint16_t *const mean[2] = {means->luma, means->chroma};

    tile->luma.computed = (struct rf_tile_rows){1, tile->luma.rows};
    tile->chroma.computed = (struct rf_tile_rows){1, tile->chroma.rows};
    memset(sums, 0, sizeof *sums);
    if (tile->f->weighted)
        weigh_rays(tile, sums);
    else
        sweep_rays(tile, sums);
    for (int p = 0; p < 2; p++) {
        for (int i = 0; i < lanes[p]; i++) {
            const uint64_t w = tile->f->weighted ? sums->weight[p][i] : tile->set->total_weight;

            mean[p][i] = (uint16_t)((4 * sums->sum[p][i] + w / 2) / w);
        }
    }
}

static void set_planes(struct tile *tile, int tx, int ty)
{
    const struct refocus_renderer *r = tile->f->r;
    const struct rf_yuv *yuv = &r->yuv;
    const ptrdiff_t origin = ty * RF_TILE * r->stride + tx * RF_TILE;
    const ptrdiff_t at = (ty * RF_TILE >> yuv->down) * r->stride + tx * RF_TILE;

    tile->range = r->range + RF_TILE / RF_CELL * (ty * r->range_stride + tx);
    tile->weighing = r->smooth[0] + origin;
    tile->weighing_behind = r->behind.light[0] + origin;
    tile->luma = (struct plane){
        .blur = r->front.blur + origin,
        .light = r->smooth[0] + origin,
        .behind = r->behind.light[0] + origin,
        .rows = RF_TILE,
        .steps = tile->f->bright ? 4 : 16,
    };
    tile->chroma = (struct plane){
        .blur = yuv->blur + at,
        .light = yuv->smooth + at,
        .behind = yuv->behind + at,
        .rows = RF_TILE >> yuv->down,
        .steps = 65535 / RF_CHROMA_MAX, /* 8 */
        .across = 1,
        .down = yuv->down,
    };
}

void rf_sweep_yuv_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect,
                       int worker)
{
    const struct refocus_renderer *r = f->r;
    struct rf_decode_job means;
    struct tile tile;
    struct sums sums;

    (void)worker;
    tile.f = f;
    tile.behind = r->behind.blur[rf_tile_middle(r, tx, ty)];
    rf_plan_tile(r, f->scale, &f->reach, tx, ty, &tile.plan);
    if (tile.plan.sharp) {
        rf_copy_yuv_tile(f, rect);
        return;
    }
    tile.set = rf_rays_for(r, tile.plan.reach, tile.plan.lamp);
    set_planes(&tile, tx, ty);
    if (tile.set->equal && !f->weighted)
        sweep_means(&tile, &sums, &means);
    else
        sweep_sums(&tile, &sums, &means);
    rf_encode_yuv_means(f, tx, ty, rect, &means);
}
