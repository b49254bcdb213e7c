/* lightfield.c: light field rendering, the comparison of Yang et al. 2016.
 *
 * Each ray (u, v) of the aperture is a camera. The picture is warped forward to it: pixel q
 * goes to p = q - (u, v) s(q), which is eq. 4 read backwards; where several go to one place
 * the nearest stays. Places that nothing went to are holes: they get the colour of the
 * farther of the two ends of the hole in their row, or the mean of both where they are as
 * far. Each view is added up at once, so no view is stored: O(N) memory, as the paper notes.
 *
 * The picture is done in bands of rows, all views of a band by one thread. A view is stored
 * as the blur s of the pixel that was seen, which also tells its place, p + (u, v) s.
 */
#include "papers/papers.h"
#include "support/compare.h"

#include <string.h>

enum { BAND = 32, HOLE = INT16_MAX };

struct band {
    int16_t *seen; /* signed blur of the nearest, or HOLE */
    uint64_t *light[3], *weight;
};

static void lay_out(struct band *band, int width, struct rf_arena *arena)
{
    band->seen = rf_arena_take(arena, (uint64_t)width * BAND, sizeof *band->seen);
    for (int c = 0; c < 3; c++)
        band->light[c] = rf_arena_take(arena, (uint64_t)width * BAND, sizeof(uint64_t));
    band->weight = rf_arena_take(arena, (uint64_t)width * BAND, sizeof(uint64_t));
}

static uint64_t band_bytes(const struct rf_limits *limits)
{
    struct rf_arena arena = {NULL, 0};
    struct band band;

    lay_out(&band, limits->width, &arena);
    return arena.used;
}

static uint64_t work_bytes(const struct rf_limits *limits)
{
    struct rf_arena arena = {NULL, 0};

    rf_arena_take(&arena, (uint64_t)limits->threads, band_bytes(limits));
    return arena.used;
}

/* Warps all pixels that can come to rows y0 .. y1 - 1 in the view of a ray. */
static void warp(const struct rf_frame *f, const struct refocus_ray *ray, int y0, int y1,
                 struct band *band)
{
    const int near_s = rf_nearest_blur(f), far_s = rf_farthest_blur(f);
    const int xa = rf_offset(ray->u, near_s), xb = rf_offset(ray->u, far_s);
    const int ya = rf_offset(ray->v, near_s), yb = rf_offset(ray->v, far_s);

    for (ptrdiff_t i = 0; i < (ptrdiff_t)(y1 - y0) * f->view->width; i++)
        band->seen[i] = HOLE;
    for (int y = y0 + rf_smaller(ya, yb); y < y1 + rf_larger(ya, yb); y++) {
        const int16_t *s = f->blur.at + y * f->view->stride;

        if (rf_cancelled(f->exec))
            return;
        for (int x = rf_smaller(xa, xb); x < f->view->width + rf_larger(xa, xb); x++) {
            const int px = x - rf_offset(ray->u, s[x]), py = y - rf_offset(ray->v, s[x]);
            int16_t *seen;

            if (py < y0 || py >= y1 || px < 0 || px >= f->view->width)
                continue;
            seen = &band->seen[(ptrdiff_t)(py - y0) * f->view->width + px];
            if (s[x] < *seen)
                *seen = s[x];
        }
    }
}

/* The pixel of the photo that a place p of a row of the view shows, which is no hole. */
static ptrdiff_t shown_at(const struct rf_frame *f, const struct refocus_ray *ray, int y,
                          const int16_t *seen, int p)
{
    return (y + rf_offset(ray->v, seen[p])) * f->view->stride + p + rf_offset(ray->u, seen[p]);
}

/* Adds a part of the ray's weight, of which there are two. */
static void add(const struct rf_frame *f, const struct refocus_ray *ray, int parts, ptrdiff_t q,
                ptrdiff_t at, struct band *band)
{
    const uint64_t w = (uint64_t)rf_weight_of(f, q) * ray->weight * (unsigned)parts;

    band->weight[at] += w;
    for (int c = 0; c < 3; c++)
        band->light[c][at] += w * f->light.channel[c][q];
}

/* Fills the hole x0 .. x1 - 1 of a row. */
static void add_hole(const struct rf_frame *f, const struct refocus_ray *ray, int y, int row,
                     int x0, int x1, struct band *band)
{
    const ptrdiff_t first = (ptrdiff_t)row * f->view->width;
    const int16_t *seen = band->seen + first;
    const bool has_left = x0 > 0, has_right = x1 < f->view->width;
    int left = x0 - 1, right = x1;

    if (!has_left && !has_right) { /* nothing came to this row at all */
        for (int x = x0; x < x1; x++)
            add(f, ray, 2, y * f->view->stride + x, first + x, band);
        return;
    }
    if (!has_left || (has_right && seen[right] > seen[left]))
        left = right;
    if (!has_right || (has_left && seen[left] > seen[right]))
        right = left;
    for (int x = x0; x < x1; x++) {
        add(f, ray, 1, shown_at(f, ray, y, seen, left), first + x, band);
        add(f, ray, 1, shown_at(f, ray, y, seen, right), first + x, band);
    }
}

/* Adds a row of a view to the sums, with its holes filled. */
static void add_row(const struct rf_frame *f, const struct refocus_ray *ray, int y, int row,
                    struct band *band)
{
    const ptrdiff_t first = (ptrdiff_t)row * f->view->width;
    const int16_t *seen = band->seen + first;

    for (int x = 0; x < f->view->width;) {
        int end = x;

        while (end < f->view->width && seen[end] == HOLE)
            end++;
        if (end > x) {
            add_hole(f, ray, y, row, x, end, band);
            x = end;
        } else {
            add(f, ray, 2, shown_at(f, ray, y, seen, x), first + x, band);
            x++;
        }
    }
}

static void do_band(void *context, int item, int worker)
{
    const struct rf_frame *f = context;
    const struct rf_limits limits = f->limits;
    struct rf_arena arena = {f->work->at + (size_t)worker * band_bytes(&limits), 0};
    const struct rf_ray_set *set = &f->ray_sets->set[f->ray_sets->preset];
    const int y0 = f->region.y0 + item * BAND;
    const int y1 = rf_smaller(y0 + BAND, f->region.y1);
    struct band band;

    lay_out(&band, f->view->width, &arena);
    for (int c = 0; c < 3; c++)
        memset(band.light[c], 0, sizeof(uint64_t) * BAND * (size_t)f->view->width);
    memset(band.weight, 0, sizeof(uint64_t) * BAND * (size_t)f->view->width);
    for (int n = 0; n < set->count && !rf_cancelled(f->exec); n++) {
        warp(f, &set->ray[n], y0, y1, &band);
        for (int y = y0; y < y1 && !rf_cancelled(f->exec); y++)
            add_row(f, &set->ray[n], y, y - y0, &band);
    }
    if (rf_cancelled(f->exec))
        return;
    for (int y = y0; y < y1; y++) {
        for (int x = f->region.x0; x < f->region.x1; x++) {
            const int at = (y - y0) * f->view->width + x;
            const uint64_t light[3] = {band.light[0][at], band.light[1][at], band.light[2][at]};

            rf_write_mean(f, x, y, light, band.weight[at]);
        }
    }
}

static void render_frame(struct rf_frame *f)
{
    const int rows = f->region.y1 - f->region.y0;

    rf_pool_run(f->exec->pool, do_band, f, (rows + BAND - 1) / BAND);
}

const struct rf_method rf_lightfield_method = {.frame = render_frame, .work_bytes = work_bytes};
