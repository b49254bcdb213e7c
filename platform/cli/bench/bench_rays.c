/* bench_rays.c: every ray of a scene is followed and counted by the surface that it hits first. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bench/bench_rays.h"

/* Pixels of the grid at the most, and rays of the full mask at K = 127 and less. */
enum { MOST_PIXELS = 4000, MOST_RAYS = 255 * 255, SIDE = 2 * REFOCUS_PLAIN_BLUR_RADIUS + 5 };

struct scene {
    const uint16_t *disparity;
    int width, height;
    double K, df;
};

struct hit {
    int x, y;
};

static double d_at(const struct scene *s, struct hit q)
{
    const int x = q.x < 0 ? 0 : q.x >= s->width ? s->width - 1 : q.x;
    const int y = q.y < 0 ? 0 : q.y >= s->height ? s->height - 1 : q.y;

    return s->disparity[(size_t)y * (size_t)s->width + (size_t)x] / 65535.0;
}

/* Eq. 4: where ray (u, v) of p hits disparity d. */
static struct hit hit_at(const struct scene *s, struct hit p, double u, double v, double d)
{
    const double blur = s->K * (s->df - d);

    return (struct hit){p.x + (int)floor(u * blur + 0.5), p.y + (int)floor(v * blur + 0.5)};
}

static bool confirms(const struct scene *s, struct hit q, double length, double d)
{
    return length * s->K * fabs(d_at(s, q) - d) <= 0.5;
}

/* The front-most hit: disparities from the nearest on, half a pixel apart. */
static bool trace(const struct scene *s, struct hit p, double u, double v, struct hit *q)
{
    const double length = hypot(u, v);
    const int steps = (int)ceil(2 * length * s->K);

    for (int i = 0; i <= steps; i++) {
        const double d = steps ? 1 - (double)i / steps : 1;

        *q = steps ? hit_at(s, p, u, v, d) : p;
        if (steps == 0 || confirms(s, *q, length, d))
            return true;
    }
    return false;
}

/* The randomized search with T tests. Returns after how many it found something, or 0;
 * *q is the last pixel looked at. */
static int search(const struct scene *s, struct hit p, double u, double v, int tests, struct hit *q)
{
    double d = d_at(s, hit_at(s, p, u, v, 1));

    for (int i = 1; i <= tests; i++) {
        *q = hit_at(s, p, u, v, d);
        if (confirms(s, *q, hypot(u, v), d))
            return i;
        d = d_at(s, *q);
    }
    return 0;
}

static uint8_t *in_set(uint8_t set[SIDE][SIDE], struct hit p, struct hit q)
{
    return &set[q.y - p.y + SIDE / 2][q.x - p.x + SIDE / 2];
}

/* Rounding may put the same surface a pixel away: a hit counts for its neighbours too. */
static void mark(uint8_t set[SIDE][SIDE], struct hit p, struct hit q)
{
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            *in_set(set, p, (struct hit){q.x + x, q.y + y}) = 1;
}

static bool is_beside(struct hit a, struct hit b)
{
    return abs(a.x - b.x) <= 1 && abs(a.y - b.y) <= 1;
}

static void look(const struct scene *s, struct hit p, const struct refocus_ray *ray, int rays,
                 struct hit *front, uint8_t set[SIDE][SIDE], struct ray_statistics *all)
{
    memset(set, 0, (size_t)SIDE * SIDE);
    for (int n = 0; n < rays; n++) {
        if (trace(s, p, ray[n].u / 32768.0, ray[n].v / 32768.0, &front[n])) {
            mark(set, p, front[n]);
        } else {
            front[n] = (struct hit){INT16_MIN, INT16_MIN};
            all->hidden++;
        }
    }
    for (int n = 0; n < rays; n++) {
        const double u = ray[n].u / 32768.0, v = ray[n].v / 32768.0;
        struct hit q;
        const int found = search(s, p, u, v, RAYS_TESTS, &q);

        if (found)
            all->found[found - 1]++;
        else
            all->never++;
        for (int T = 1; T <= RAYS_TESTS; T++) {
            const int valid = search(s, p, u, v, T, &q);

            all->first[T - 1] += is_beside(q, front[n]);
            if (!valid && d_at(s, q) < d_at(s, p))
                q = p;
            all->in_set[T - 1] += *in_set(set, p, q);
        }
    }
    all->rays += rays;
    all->pixels++;
}

int ray_statistics(struct ray_statistics *all, const uint16_t *disparity, int width, int height,
                   double focus, double blur, const struct refocus_aperture *aperture)
{
    const struct scene scene = {disparity, width, height, blur, focus};
    struct refocus_ray *ray = malloc(MOST_RAYS * sizeof *ray);
    struct hit *front = malloc(MOST_RAYS * sizeof *front);
    uint8_t(*set)[SIDE] = malloc((size_t)SIDE * SIDE);
    int rays, step = 1, result = -1;

    *all = (struct ray_statistics){.K = blur, .focus = focus};
    if (!ray || !front || !set)
        goto end;
    rays = refocus_aperture_full_rays(aperture, blur > 0 ? blur : 0.1, MOST_RAYS, ray);
    /* few enough that tens of millions of rays are the most */
    while ((double)(width / step + 1) * (height / step + 1) > MOST_PIXELS ||
           (double)(width / step + 1) * (height / step + 1) * rays > 4e6)
        step++;
    for (int y = step / 2; y < height; y += step) {
        for (int x = step / 2; x < width; x += step)
            look(&scene, (struct hit){x, y}, ray, rays, front, set, all);
        report_progress("looking at rays", (double)y / height);
    }
    result = 0;
end:
    report_progress_end();
    free(ray);
    free(front);
    free(set);
    return result;
}

static json_t *shares(const long *count, long of)
{
    json_t *list = json_array();

    for (int i = 0; i < RAYS_TESTS; i++)
        json_array_append_new(list, json_real((double)count[i] / (double)of));
    return list;
}

json_t *ray_statistics_json(const struct ray_statistics *s)
{
    return json_pack("{s:f, s:f, s:i, s:i, s:f, s:o, s:f, s:o, s:o}", "blur", s->K, "focus",
                     s->focus, "pixels", (int)s->pixels, "rays", (int)s->rays, "hidden",
                     (double)s->hidden / (double)s->rays, "found_after", shares(s->found, s->rays),
                     "never", (double)s->never / (double)s->rays, "front_most",
                     shares(s->first, s->rays), "in_set", shares(s->in_set, s->rays));
}

void ray_statistics_print(const struct ray_statistics *s)
{
    const double of = (double)s->rays / 100;

    printf("%ld rays of %ld pixels, blur %.4g, focus %.3f; %.2f %% hit nothing\n", s->rays,
           s->pixels, s->K, s->focus, (double)s->hidden / of);
    printf("tests  first found  front-most  in the set of p\n");
    for (int i = 0; i < RAYS_TESTS; i++)
        printf("%5d  %9.3f %%  %8.3f %%  %13.3f %%\n", i + 1, (double)s->found[i] / of,
               (double)s->first[i] / of, (double)s->in_set[i] / of);
    printf("never  %9.3f %%\n", (double)s->never / of);
}
