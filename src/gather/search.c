/* search.c: randomized intersection search, Yang et al. 2016, section "Randomized
 * Intersection Searching".
 *
 * A ray (u, v) of pixel p starts with the disparity found where it would hit the nearest plane, d =
 * 1: at p + (u, v) K (df - 1), the same offset for every pixel. A guess d leads to the pixel q = p
 * + (u, v) K (df - d) (eq. 4). If the disparity at q confirms the guess to half a pixel, |u| K |d_q
 * - d| <= 1/2, q is an intersection. If not, d_q is the next guess. After T tests the last pixel
 * looked at is used, unless it is no intersection and farther than p: then p itself is used (or, by
 * option, the mirrored pixel, or the hidden background).
 *
 * An example: K = 20, df = 0.5, and the ray is (1, 0). The first guess, d = 1, leads 10 pixels to
 * the left, where the disparity is 0.4: 20 x 0.6 is 12 pixels, so it is not confirmed. The next
 * guess, 0.4, leads 2 pixels to the right, where the disparity is 0.41: 20 x 0.01 is 0.2 pixels,
 * and the ray hits this pixel.
 */
#include "gather/frame.h"
#include "gather/sums.h"
#include "image/viewport.h"

#include <assert.h>
#include <stdalign.h>
#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* Sums of a run of rays: of light, or of light times weight and of weights. */
union run {
    uint32_t sum[3][LANES];
    uint64_t weighted[4][LANES];
};

/* At most RF_RAY_CHUNK rays of equal weight, and the cells of their first guesses. */
struct chunk {
    struct rf_search_rays rays;
    int32_t cell[RF_RAY_CHUNK];
};

/* The rays of a strip: those that are settled for the strip as a whole, which are added as the
 * sweep adds rays that need no test, and those to be searched. */
struct sorted {
    alignas(64) struct rf_sorted_rays settled;
    alignas(64) struct rf_search_rays left;
};

/* Sets n rays. */
static void set_chunk(struct chunk *chunk, const struct rf_frame *f, const struct refocus_ray *ray,
                      int n)
{
    struct rf_search_rays *rays = &chunk->rays;

    rays->rays = n;
    for (int i = 0; i < n; i++) {
        rays->u[i] = ray[i].u;
        rays->v[i] = ray[i].v;
    }
    f->exec->kernels->aim(rays->start, chunk->cell, rays->u, rays->v, rf_nearest_blur(f), 0,
                          (int32_t)f->view->stride, (int32_t)f->range.stride, n);
    f->exec->kernels->tolerances(rays->within, rays->u, rays->v, n);
}

/* The planes of light and of weights have rows of their own: where a settled ray looks is told as
 * x + PLACE_ROW y, from which either's offset follows. */
enum { PLACE_ROW = 256 };

static void sort_chunk(struct sorted *sorted, const struct rf_frame *f, const struct chunk *chunk,
                       int tx, int y)
{
    const uint16_t *const light =
        rf_searched_light(f).channel[0] + y * f->view->stride + tx * RF_TILE;
    const struct rf_search_rays *rays = &chunk->rays;
    struct rf_sorted_rays *settled = &sorted->settled;
    struct rf_search_rays *left = &sorted->left;
    uint8_t is_settled[RF_RAY_CHUNK];
    int32_t place[RF_RAY_CHUNK];
    int add = 0, search = 0;

    f->exec->kernels->settle(
        is_settled, place, f->range.at + y / RF_CELL * f->range.stride + tx * (RF_TILE / RF_CELL),
        chunk->cell, rays, f->params->iterations, PLACE_ROW, (int32_t)f->range.stride);
    for (int n = 0; n < rays->rays; n++) {
        const int row = (place[n] + PLACE_ROW / 2) >> 8, x = place[n] - row * PLACE_ROW;

        left->start[search] = rays->start[n];
        left->u[search] = rays->u[n];
        left->v[search] = rays->v[n];
        left->within[search] = rays->within[n];
        settled->tests[add] = 0;
        settled->last[add] = light + x + row * f->view->stride;
        settled->last_is_background[add] = false;
        if (f->weighted)
            settled->last_weight[add] =
                f->weight.at + (y + row) * f->weight.stride + tx * RF_TILE + x;
        search += !is_settled[n];
        add += is_settled[n];
    }
    left->rays = search;
    settled->rays = add;
}

static_assert(UINT64_C(16) * RF_CHROMA_MAX * RF_WEIGHT_MAX <= UINT32_MAX &&
                  UINT64_C(32) * RF_LIGHT_MAX * RF_WEIGHT_MAX <= UINT32_MAX,
              "sums of weighted light");
static_assert((int)RF_CHROMA_MAX <= (int)RF_PLAIN_GAIN * RF_LIGHT_MAX, "chroma is RF_BRIGHT");

/* The most that a plane of what is searched holds. */
static int most_light(const struct rf_frame *f)
{
    return f->yuv->on                  ? RF_CHROMA_MAX
           : rf_searches_subtracted(f) ? rf_most_light(f->bright)
                                       : RF_LIGHT_MAX;
}

/* The light of what is searched in a strip. */
static struct rf_search_job job_of(const struct rf_frame *f, const struct rf_search_rays *rays,
                                   int tx, int y)
{
    const ptrdiff_t at = y * f->view->stride + tx * RF_TILE;
    const struct rf_light_q12 light = rf_searched_light(f);
    struct rf_search_job job = {
        .blur = f->blur.at + at,
        .stride = f->view->stride,
        .tests = f->params->iterations,
        .steps = f->weighted ? f->yuv->on ? 16 : 32 : UINT16_MAX / most_light(f),
        .rays = rays,
        .fallback = f->params->background ? RF_FALLBACK_BACKGROUND
                    : f->params->mirror   ? RF_FALLBACK_MIRRORED
                                          : RF_FALLBACK_OWN,
    };

    for (int c = 0; c < 3; c++)
        job.light[c] = light.channel[c] + at;
    if (f->params->background) {
        job.background_blur = f->background.blur.at + at;
        for (int c = 0; c < 3; c++)
            job.background[c] = f->background.light.channel[c] + at;
    }
    if (f->weighted) {
        job.weight = f->weight.at + y * f->weight.stride + tx * RF_TILE;
        job.weight_stride = f->weight.stride;
        job.light_weight = f->light_weight;
        job.first_weighs = f->yuv->on;
    }
    return job;
}

/* The share of a worker. */
struct share {
    alignas(64) struct rf_sums sums;
    alignas(64) union run run;
    alignas(64) struct chunk chunk;
    struct sorted sorted;
};

uint64_t rf_search_share(void)
{
    return sizeof(struct share);
}

static void search_strip(const struct rf_frame *f, struct share *share, int tx, int y)
{
    const struct rf_kernels *const k = f->exec->kernels;
    const int i = y % RF_TILE * RF_TILE;
    union run *const run = &share->run;
    struct sorted *const sorted = &share->sorted;
    const struct rf_search_job search = job_of(f, &sorted->left, tx, y);
    const struct rf_light_q12 light = rf_searched_light(f);
    const struct rf_sweep_job sweep = {
        .blur = search.blur,
        .stride = search.stride,
        .pitch = light.channel[1] - light.channel[0],
        .rays = &sorted->settled,
        .steps = UINT16_MAX / most_light(f),
        .bright = f->yuv->on ? RF_BRIGHT : RF_WHITE,
        .lanes = RF_STRIP_LANES,
        .weight = search.weight,
        .weight_stride = search.weight_stride,
    };

    sort_chunk(sorted, f, &share->chunk, tx, y);
    if (f->weighted) {
        uint64_t *const sum[4] = {run->weighted[0] + i, run->weighted[1] + i, run->weighted[2] + i,
                                  run->weighted[3] + i};

        k->sweep_weighted(sum, &sweep);
        k->search_weighted(sum, &search);
    } else {
        uint32_t *const sum[3] = {run->sum[0] + i, run->sum[1] + i, run->sum[2] + i};

        k->sweep(sum, &sweep);
        k->search(sum, &search);
    }
}

/* Adds a run of rays of equal weight as often as they weigh. */
static void add_run(const struct rf_frame *f, const union run *run, uint64_t ray_weight,
                    struct rf_sums *sums)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            sums->light[c][i] += ray_weight * (f->weighted ? run->weighted[c][i] : run->sum[c][i]);
    for (int i = 0; f->weighted && i < LANES; i++)
        sums->weight[i] += ray_weight * run->weighted[3][i];
}

/* Adds up the rays of a tile. */
static void search_sums(const struct rf_frame *f, int tx, int ty, struct share *share)
{
    const struct rf_ray_set *const set = &f->ray_sets->set[f->ray_sets->preset];
    struct rf_sums *const sums = &share->sums;

    memset(sums, 0, sizeof *sums);
    memset(&share->run, 0, sizeof share->run);
    for (int n = 0, rays; n < set->count; n += rays) {
        const struct refocus_ray *ray = &set->ray[n];

        if (rf_cancelled(f->exec))
            return;
        rays = rf_rays_of_equal_weight(set, n);
        set_chunk(&share->chunk, f, ray, rays);
        for (int y = 0; y < RF_TILE; y += RF_STRIP)
            search_strip(f, share, tx, ty * RF_TILE + y);
        if (n + rays < set->count && ray[rays].weight == ray->weight)
            continue;
        add_run(f, &share->run, ray->weight, sums);
        memset(&share->run, 0, sizeof share->run);
    }
    for (int i = 0; !f->weighted && i < LANES; i++)
        sums->weight[i] = set->total_weight;
}

static void compute_means(const struct rf_sums *sums, uint16_t mean[3][LANES])
{
    const uint64_t most = 4 * RF_MOST_MEAN;

    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) {
            const uint64_t w = sums->weight[i], v = (4 * sums->light[c][i] + w / 2) / w;

            mean[c][i] = (uint16_t)(v < most ? v : most);
        }
}

/* Draws highlights into the means of red, green and blue. Works in `share`, whose sums are lost. */
static void splat(const struct rf_frame *f, int tx, int ty, struct share *share,
                  uint16_t mean[3][LANES])
{
    struct rf_tile_plan plan;

    if (!f->splats)
        return;
    rf_plan_tile(f->view, f->bins, &f->reach, tx, ty, &plan);
    rf_splat_highlights(&f->splat, &plan, tx, ty, share,
                        (uint16_t *const[3]){mean[0], mean[1], mean[2]});
    if (!f->deep_out->on)
        f->exec->kernels->clamp_row(mean[0], RF_MEAN_MAX, 3 * LANES);
}

void rf_search_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    struct share *const share = rf_share(&f->exec->shares, worker);
    uint16_t mean[3][LANES];

    search_sums(f, tx, ty, share);
    if (rf_cancelled(f->exec)) /* a cancelled run has no weights to divide by */
        return;
    compute_means(&share->sums, mean);
    splat(f, tx, ty, share, mean);
    rf_encode_means(f, rect, mean);
}

/* The chroma of a sample is the mean of that of its pixels. */
static void join_samples(struct rf_decode_job *means, uint16_t mean[3][LANES])
{
    const int down = means->down, below = down * RF_TILE;

    for (int y = 0; y < RF_TILE; y += 1 << down)
        for (int x = 0; x < RF_TILE; x++) {
            const uint16_t *const at = mean[1 + (x & 1)] + y * RF_TILE + (x & ~1);

            means->chroma[(y >> down) * RF_TILE + x] =
                (uint16_t)((at[0] + at[1] + at[below] + at[below + 1] + 2) / 4);
        }
}

void rf_search_yuv_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    struct share *const share = rf_share(&f->exec->shares, worker);
    struct rf_decode_job means;
    struct rf_tile_plan plan;
    uint16_t mean[3][LANES];

    search_sums(f, tx, ty, share);
    if (rf_cancelled(f->exec))
        return;
    compute_means(&share->sums, mean);
    means.down = f->yuv->down;
    join_samples(&means, mean);
    memcpy(means.luma, mean[0], sizeof means.luma);
    if (f->splats) {
        rf_plan_tile(f->view, f->bins, &f->reach, tx, ty, &plan);
        rf_splat_yuv_highlights(&f->splat, &plan, tx, ty, share, means.luma, means.chroma);
    }
    rf_encode_yuv_means(f, tx, ty, rect, &means);
}
