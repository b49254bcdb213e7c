/* live_range.c: the distances that disparity 1 and 0 stand for follow what a depth camera sees,
 * in 1/m. A range that moves changes no blur by itself, as focus and blur move with it
 * (live_focus.c); but it must not leave out what is near, nor move with every noise. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "live/live_range.h"

enum { CODES = 65536, MOST_LOOKS = 40000, TAIL = 1024 };

/* Shares of the range, seconds, and e-foldings of the range a second. */
static const double clipped_most = 0.02, unused_most = 0.06, there = 0.002;
static const double outward_s = 0.1, outward_rate = 4, patience_s = 1, inward_s = 1.5;
static const double longest_s = 0.25;   /* the longest step in time, after a gap in the depth */
static const double least_ratio = 1.05; /* farthest / nearest distance, at least */

static uint16_t middle(uint16_t a, uint16_t b, uint16_t c)
{
    const uint16_t least = a < b ? a : b, most = a < b ? b : a;

    return c < least ? least : c > most ? most : c;
}

/* Counts codes, of three neighbours the middle one: single wrong samples are none of them. */
static uint32_t count(uint32_t *counts, const struct refocus_depth_map *map, bool alone)
{
    const int64_t looks = (int64_t)map->width * map->height / MOST_LOOKS;
    int step = 1;
    uint32_t n = 0;

    while ((int64_t)step * step <= looks)
        step++;
    memset(counts, 0, CODES * sizeof *counts);
    for (int y = 0; y < map->height; y += step) {
        const uint16_t *row = (const uint16_t *)((const char *)map->samples + y * map->stride);
        const uint16_t *low =
            y + 1 < map->height ? (const uint16_t *)((const char *)row + map->stride) : row;

        for (int x = 0; x < map->width; x += step) {
            const uint16_t v = row[x], right = row[x + 1 < map->width ? x + 1 : x];

            if (alone ? v == 0 : !(v && right && low[x]))
                continue;
            counts[alone ? v : middle(v, right, low[x])]++;
            n++;
        }
    }
    return n;
}

/* The code that so many lie before, from the least on or from the greatest. */
static int code_at(const uint32_t *counts, uint32_t before, bool greatest)
{
    int code = greatest ? CODES - 1 : 0;

    for (uint32_t n = 0; (n += counts[code]) <= before;)
        code += greatest ? -1 : 1;
    return code;
}

bool live_range_measure(struct live_ranger *ranger, const struct refocus_depth_map *map,
                        struct live_range *seen)
{
    uint32_t n;

    if (!ranger->counts)
        ranger->counts = malloc(CODES * sizeof *ranger->counts);
    if (!ranger->counts)
        return false;
    n = count(ranger->counts, map, false);
    if (n == 0)
        n = count(ranger->counts, map, true); /* a few points, none beside another */
    if (n == 0)
        return false;
    seen->near = 1 / (map->metres_per_unit * code_at(ranger->counts, n / TAIL, false));
    seen->far = 1 / (map->metres_per_unit * code_at(ranger->counts, n / TAIL, true));
    return true;
}

/* Keep the ends as far apart as they must be: noise of a bare wall shall not become a scene. */
static void spread(const struct live_ranger *ranger, struct live_range *range)
{
    if (ranger->near_given)
        range->near = ranger->range.near;
    if (ranger->far_given)
        range->far = ranger->range.far;
    if (ranger->near_given)
        range->far = fmin(range->far, range->near / least_ratio);
    else
        range->near = fmax(range->near, range->far * least_ratio);
}

static double middle_of(double a, double b, double c)
{
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

/* Move one end towards the distance where it is seen; outward is 1 for near and -1 for far. A scene
 * that is clipped by more than a little moves it at once and quickly; a part of the range that is
 * not used any more moves it after a while, and slowly. In between it stands still, and once it
 * moves it goes on until it is there. */
static void move(struct live_range_end *end, double *value, double seen, double span,
                 double outward, double seconds)
{
    const double off = (seen - *value) * outward / span;
    double step;

    end->unused_s = off < -unused_most ? end->unused_s + seconds : 0;
    if (off > clipped_most || end->unused_s > patience_s)
        end->moves = true;
    if (fabs(off) < there)
        end->moves = false;
    if (!end->moves)
        return;
    step = off * (1 - exp(-seconds / (off > 0 ? outward_s : inward_s)));
    *value += outward * span * fmin(step, exp(outward_rate * seconds) - 1);
}

void live_range_begin(struct live_ranger *ranger, double near_m, double far_m)
{
    memset(ranger, 0, sizeof *ranger);
    ranger->near_given = near_m > 0;
    ranger->far_given = far_m > 0;
    ranger->range.near = ranger->near_given ? 1 / near_m : 0;
    ranger->range.far = ranger->far_given ? 1 / far_m : 0;
}

void live_range_end(struct live_ranger *ranger)
{
    free(ranger->counts);
    ranger->counts = NULL;
}

void live_range_follow(struct live_ranger *ranger, const struct live_range *seen, int64_t now_ns)
{
    const double since = (double)(now_ns - ranger->last_ns) / 1e9;
    const double seconds = ranger->maps == 0 ? 0 : fmin(fmax(since, 0), longest_s);
    struct live_range *const past = ranger->past;
    struct live_range to;

    ranger->last_ns = now_ns;
    for (int i = 0; i < 3; i++) /* one map that is wrong moves nothing */
        if (ranger->maps == 0 || (int)(ranger->maps % 3) == i)
            past[i] = *seen;
    to.near = middle_of(past[0].near, past[1].near, past[2].near);
    to.far = middle_of(past[0].far, past[1].far, past[2].far);
    spread(ranger, &to);
    if (ranger->maps++ == 0) {
        ranger->range = to;
    } else {
        const double span = ranger->range.near - ranger->range.far;

        move(&ranger->near_end, &ranger->range.near, to.near, span, 1, seconds);
        move(&ranger->far_end, &ranger->range.far, to.far, span, -1, seconds);
        spread(ranger, &ranger->range);
    }
}
