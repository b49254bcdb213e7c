/* rays.c: the ray sets of the current aperture, kept until it changes. */
#include "aperture/aperture.h"
#include "methods/method.h"
#include "renderer/bands.h"
#include "renderer/rays.h"

#include <string.h>

/* Sizes of sets: a tile takes the smallest that is dense enough, at most the preset's; one
 * that a highlight reaches, whose disc would show the single rays, at most twice that. */
static const int class_rays[] = {24, 32, 48, 64, 96, 128, 192, 256, 384, 512};
enum { CLASSES = sizeof class_rays / sizeof *class_rays, DENSER = 2 };

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

/* By weight, so that few runs of equal ones are left, then down and across. */
static bool comes_before(const struct refocus_ray *a, const struct refocus_ray *b)
{
    if (a->weight != b->weight)
        return a->weight < b->weight;
    return a->v != b->v ? a->v < b->v : a->u < b->u;
}

static void sift_down(struct refocus_ray *ray, int root, int count)
{
    const struct refocus_ray moved = ray[root];

    for (int child; (child = 2 * root + 1) < count; root = child) {
        if (child + 1 < count && comes_before(&ray[child], &ray[child + 1]))
            child++;
        if (!comes_before(&moved, &ray[child]))
            break;
        ray[root] = ray[child];
    }
    ray[root] = moved;
}

/* A heap sort: in place. */
static void sort_rays(struct refocus_ray *ray, int count)
{
    for (int root = count / 2 - 1; root >= 0; root--)
        sift_down(ray, root, count);
    for (int end = count - 1; end > 0; end--) {
        const struct refocus_ray last = ray[end];

        ray[end] = ray[0];
        ray[0] = last;
        sift_down(ray, 0, end);
    }
}

/* Rays that chroma shares become the first ones of each chunk. Of sets that lie on
 * spirals or along a curve (aperture/rays.c) every second ray is as even a set. */
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

/* Coordinates of a set's rays apart from each other; returns where memory goes on. */
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

void rf_make_rays(struct refocus_renderer *r, const struct refocus_aperture *aperture, int rays,
                  bool denser, float max_blur_radius)
{
    struct refocus_ray *next = r->rays;
    int sets = 0;

    if (rays != REFOCUS_RAYS_FULL)
        max_blur_radius = 0; /* sets of N do not depend on it */
    if (r->sets && r->set_aperture == aperture->id && r->set_rays == rays &&
        r->set_denser == denser && r->set_blur == max_blur_radius && r->set_shared == r->yuv.on)
        return;
    r->sets = 0;
    if (rays == REFOCUS_RAYS_FULL) {
        r->set[0].ray = next;
        r->set[0].count =
            rf_aperture_full_rays(aperture, max_blur_radius, RF_FULL_RAYS, next, &r->run);
        sort_rays(next, r->set[0].count);
        r->set[0].total_weight = total_weight(&r->set[0]);
        r->set[0].before = next;
        r->set[0].equal = are_equal(&r->set[0]);
        r->set[0].u = r->set[0].v = NULL;
        r->set[0].shared = r->set[0].count;
        sets = 1;
        r->preset = 0;
    } else {
        bool own = false; /* the preset's set is there */

        for (int i = 0; i < CLASSES || !own; i++) {
            int count = i < CLASSES ? class_rays[i] : rays;
            struct rf_ray_set *set = &r->set[sets];

            if (!own && count >= rays) {
                i -= count > rays; /* comes before this one */
                count = rays;
                own = true;
                r->preset = sets;
            } else if (own && (!denser || count > DENSER * rays)) {
                break;
            }
            set->ray = next;
            set->count = count;
            rf_aperture_rays(aperture, count, false, next, &r->run);
            set->total_weight = total_weight(set);
            set->equal = true;
            set->before = next;
            next += count;
            if (rf_aperture_has_sides(aperture)) {
                rf_aperture_rays(aperture, count, true, next, &r->run);
                set->before = next;
                next += count;
            }
            set->shared = rf_chroma_rays(count);
            if (r->yuv.on)
                share_rays(set, next);
            next = part_coordinates(set, next);
            sets++;
        }
    }
    if (rf_cancelled(r)) /* what was made may be half made */
        return;
    r->sets = sets;
    r->set_aperture = aperture->id;
    r->set_rays = rays;
    r->set_denser = denser;
    r->set_shared = r->yuv.on;
    r->set_blur = max_blur_radius;
}

/* N >= 1.3 pi reach^2 rays are as good as all. */
const struct rf_ray_set *rf_rays_for(const struct refocus_renderer *r, int reach, bool lamp)
{
    const int64_t need = (int64_t)reach * reach * 4084 / 1000; /* Q16 */
    const int last = lamp ? r->sets - 1 : r->preset;

    for (int i = 0; i < last; i++)
        if ((int64_t)r->set[i].count << 16 >= need)
            return &r->set[i];
    return &r->set[last];
}

int rf_rays_alike(const struct rf_ray_set *set, int first)
{
    const int most = chunk_end(set, first) - first;
    int n = set->equal ? most : 1;

    while (n < most && set->ray[first + n].weight == set->ray[first].weight)
        n++;
    return n;
}
