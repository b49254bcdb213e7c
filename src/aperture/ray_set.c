/* ray_set.c: makes sets of few and of many rays for an aperture, and chooses one for each tile. */
#include "aperture/ray_set.h"

#include "aperture/aperture.h"
#include "kernels/kernels.h"
#include "support/places.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <string.h>

/* The sizes of sets. A tile uses the smallest set that is dense enough for its blur, at most the
 * preset's. Fewer than 48 would do for a blur of up to two pixels, but as the focus or the aperture
 * moves, the weights of the pixels there would change in steps that show. Where a small highlight
 * is in reach, whose disc would show the single rays, it is at most twice that. */
static const int class_rays[] = {48, 64, 96, 128, 192, 256, 384, 512};
enum { CLASSES = sizeof class_rays / sizeof *class_rays, DENSER = 2 };
enum { MASK_SIDE = 2 * REFOCUS_PLAIN_BLUR_RADIUS + 1 };
static_assert(MASK_SIDE * MASK_SIDE == RF_FULL_RAYS, "a ray for each pixel of the largest mask");

static uint64_t total_weight(const struct rf_ray_set *set)
{
    uint64_t sum = 0;

    for (int i = 0; i < set->count; i++)
        sum += set->ray[i].weight;
    return sum;
}

static int chunk_end(const struct rf_ray_set *set, int first)
{
    return set->count - first < RF_RAY_CHUNK ? set->count : first + RF_RAY_CHUNK;
}

static bool are_equal(const struct rf_ray_set *set)
{
    for (int i = 1; i < set->count; i++)
        if (set->ray[i].weight != set->ray[0].weight)
            return false;
    return true;
}

/* Orders rays by weight, so that there are few runs of equal weight, then down and across. */
static bool comes_after(const void *a, const void *b)
{
    const struct refocus_ray *p = a, *q = b;

    if (p->weight != q->weight)
        return p->weight > q->weight;
    return p->v != q->v ? p->v > q->v : p->u > q->u;
}

/* Makes the rays that chroma shares the first ones of each chunk. In sets that lie on spirals or
 * along a curve (rays.c) every second ray makes an equally even set. */
static void share_rays(struct rf_ray_set *set, struct refocus_ray *spare)
{
    struct refocus_ray *const ray = set->ray;
    int chosen = 0, others = set->shared;

    for (int n = 0; n < set->count; n++)
        spare[rf_shared_rays(set, n, n + 1) ? chosen++ : others++] = ray[n];
    chosen = 0;
    others = set->shared;
    for (int n = 0, end; n < set->count; n = end) {
        const int shared = rf_shared_rays(set, n, end = chunk_end(set, n));

        memcpy(ray + n, spare + chosen, (size_t)shared * sizeof *ray);
        memcpy(ray + n + shared, spare + others, (size_t)(end - n - shared) * sizeof *ray);
        chosen += shared;
        others += end - n - shared;
    }
}

/* Copies the coordinates of a set's rays into two arrays; returns where memory goes on. */
static struct refocus_ray *part_coordinates(struct rf_ray_set *set, struct refocus_ray *next)
{
    enum { EACH = sizeof *next / sizeof(int16_t) };
    int16_t *const u = (int16_t *)(void *)next, *const v = u + set->count;

    for (int i = 0; i < set->count; i++) {
        u[i] = set->ray[i].u;
        v[i] = set->ray[i].v;
    }
    set->u = u;
    set->v = v;
    return next + (2 * set->count + EACH - 1) / EACH;
}

/* The number of rays of chroma, whose samples lie two pixels apart, for so many of luma: half of
 * them, or all of a few. */
static int chroma_rays(int rays)
{
    return rays < 48 ? rays : rays / 2;
}

/* Makes the set in which every pixel of the aperture mask is a ray. */
static void make_full_set(struct rf_ray_sets *sets, const struct refocus_aperture *aperture,
                          float max_blur_radius, struct rf_run *run)
{
    struct rf_ray_set *set = &sets->set[0];

    set->ray = set->before = sets->memory;
    set->count = rf_aperture_full_rays(aperture, max_blur_radius, RF_FULL_RAYS, sets->memory, run);
    rf_sort(set->ray, (uint32_t)set->count, sizeof *set->ray, comes_after);
    set->total_weight = total_weight(set);
    set->equal = are_equal(set);
    set->u = set->v = NULL;
    set->shared = set->count;
    sets->preset = 0;
}

/* Makes a set of `count` rays at `next`; returns where memory goes on. */
static struct refocus_ray *make_set(struct rf_ray_set *set, const struct refocus_aperture *aperture,
                                    int count, bool chroma, struct refocus_ray *next,
                                    struct rf_run *run)
{
    set->ray = set->before = next;
    set->count = count;
    rf_aperture_rays(aperture, count, false, next, run);
    set->total_weight = total_weight(set);
    set->equal = true;
    next += count;
    if (rf_aperture_has_sides(aperture)) {
        rf_aperture_rays(aperture, count, true, next, run);
        set->before = next;
        next += count;
    }
    set->shared = chroma_rays(count);
    if (chroma)
        share_rays(set, next);
    return part_coordinates(set, next);
}

/* Makes the set of as many rays as were asked for, the smaller ones, and if asked for denser ones.
 * For 80 rays they are 48, 64 and 80, and then 96 and 128. */
static int make_classes(struct rf_ray_sets *sets, const struct rf_ray_request *request,
                        struct rf_run *run)
{
    struct refocus_ray *next = sets->memory;
    bool own = false; /* the set of request->rays is there */
    int filled = 0;

    for (int i = 0; i < CLASSES || !own; i++) {
        int count = i < CLASSES ? class_rays[i] : request->rays;

        if (!own && count >= request->rays) {
            i -= count > request->rays; /* comes before this one */
            count = request->rays;
            own = true;
            sets->preset = filled;
        } else if (own && (!request->denser || count > DENSER * request->rays)) {
            break;
        }
        next = make_set(&sets->set[filled++], request->aperture, count, request->chroma, next, run);
    }
    return filled;
}

static bool are_made_for(const struct rf_ray_sets *sets, const struct rf_ray_request *request,
                         float blur)
{
    return sets->sets && sets->aperture == request->aperture->id && sets->rays == request->rays &&
           sets->denser == request->denser && sets->blur == blur && sets->shared == request->chroma;
}

void rf_ray_sets_make(struct rf_ray_sets *sets, const struct rf_ray_request *request,
                      struct rf_run *run)
{
    const bool full = request->rays == REFOCUS_RAYS_FULL;
    const float blur = full ? request->max_blur_radius : 0; /* sets of N rays do not depend on it */
    int filled = 1;

    if (are_made_for(sets, request, blur))
        return;
    sets->sets = 0;
    if (full)
        make_full_set(sets, request->aperture, blur, run);
    else
        filled = make_classes(sets, request, run);
    if (rf_run_cancelled(run)) /* sets may be incomplete */
        return;
    sets->sets = filled;
    sets->aperture = request->aperture->id;
    sets->rays = request->rays;
    sets->denser = request->denser;
    sets->shared = request->chroma;
    sets->blur = blur;
}

/* N >= 1.3 pi reach^2 rays are as good as all. A tile that blurs of up to 4 pixels reach needs 66
 * of them, so it uses the set of 96; with a preset of 64 rays it uses these. */
const struct rf_ray_set *rf_choose_ray_set(const struct rf_ray_sets *sets, int reach,
                                           bool undersampled)
{
    const int64_t need = (int64_t)reach * reach * 4084 / 1000; /* Q16 */
    const int last = undersampled ? sets->sets - 1 : sets->preset;

    for (int i = 0; i < last; i++)
        if ((int64_t)sets->set[i].count << 16 >= need)
            return &sets->set[i];
    return &sets->set[last];
}

int rf_rays_of_equal_weight(const struct rf_ray_set *set, int first)
{
    const int most = chunk_end(set, first) - first;
    int n = set->equal ? most : 1;

    while (n < most && set->ray[first + n].weight == set->ray[first].weight)
        n++;
    return n;
}

double rf_ray_gap(int rays)
{
    return sqrt(3.14159265358979 / (rays == REFOCUS_RAYS_FULL ? INT_MAX : rays));
}
