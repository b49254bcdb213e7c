/* count_hits_vec.c: counts which pixels the rays of a search of one test see, a vector of pixels at
 * a time.
 *
 * First guesses lie side by side. Mostly they lead all pixels the same way, or, at an edge and on a
 * slope, one of two ways: that of the first pixel, and that of the next that goes another. These
 * are found out for a chunk of rays beforehand, so that nothing waits for them. Pixels that go
 * other ways yet come last.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <stdalign.h>

enum { LANES = (int)VEC_U16 };

struct span {
    uint16_t (*count)[RF_TILE]; /* offset (0, 0), first lane */
    uint8_t *touched;
    const int16_t *blur;
    vec_u16 own; /* blur */
    vec_u16 hidden;
};

/* The rays of a chunk: those whose pixels all look at one offset, and those that have more, with
 * the offsets of all lanes. */
struct chunk {
    alignas(64) int16_t way[RF_RAY_CHUNK][LANES];
    int16_t only[RF_RAY_CHUNK];
    uint16_t one[RF_RAY_CHUNK], more[RF_RAY_CHUNK];
    int ones, mores;
};

static RF_ALWAYS_INLINE vec_u16 guess_of(const struct span *s, const struct rf_counted_rays *rays,
                                         int n)
{
    return vec_u16_load(s->blur + rays->start[n]);
}

static RF_ALWAYS_INLINE void aim(struct chunk *c, const struct span *s,
                                 const struct rf_counted_rays *rays, int first, int end)
{
    const vec_u16 row = vec_u16_set(RF_COUNT_ROW);
    const vec_mask all = vec_mask_all();
    int ones = 0, mores = 0;

    for (int n = first; n < end; n++) {
        const vec_u16 guess = guess_of(s, rays, n);
        const vec_u16 x = vec_u16_offset(guess, vec_u16_set((uint16_t)rays->u[n]));
        const vec_u16 y = vec_u16_offset(guess, vec_u16_set((uint16_t)rays->v[n]));
        const vec_u16 way = vec_u16_add(vec_u16_mul(y, row), x);
        const bool is_more =
            vec_mask_any(vec_mask_without(all, vec_mask_equal(all, way, vec_u16_spread(way))));

        vec_u16_store(c->way[mores], way);
        c->only[ones] = (int16_t)vec_u16_lane0(way);
        c->one[ones] = c->more[mores] = (uint16_t)n;
        ones += !is_more;
        mores += is_more;
    }
    c->ones = ones;
    c->mores = mores;
}

/* The lanes of `mask` that see what they did not guess, and deeper than their pixel. */
static RF_ALWAYS_INLINE vec_mask missing(const struct span *s, vec_mask mask, vec_u16 guess,
                                         vec_u16 seen, uint16_t within)
{
    mask = vec_mask_less(mask, s->own, seen);
    return vec_mask_less(mask, vec_u16_set(within), vec_s16_apart(seen, guess));
}

static RF_ALWAYS_INLINE void count(const struct span *s, ptrdiff_t way, vec_mask hits,
                                   vec_u16 times)
{
    uint16_t *const to = s->count[way];

    vec_u16_store(to, vec_u16_add_where(hits, vec_u16_load(to), times));
    s->touched[way] = 1;
}

static RF_ALWAYS_INLINE void count_one_way(struct span *s, const struct chunk *c,
                                           const struct rf_counted_rays *rays)
{
    const vec_mask all = vec_mask_all();
    vec_u16 hidden = s->hidden;

    for (int k = 0; k < c->ones; k++) {
        const int n = c->one[k];
        const vec_u16 times = vec_u16_set(rays->times[n]);
        const vec_u16 seen = vec_u16_load(s->blur + c->only[k]);
        const vec_mask miss = missing(s, all, guess_of(s, rays, n), seen, rays->within[n]);

        count(s, c->only[k], vec_mask_without(all, miss), times);
        hidden = vec_u16_add_where(miss, hidden, times);
    }
    s->hidden = hidden;
}

/* The lanes `waiting` of a ray, way by way. */
static RF_ALWAYS_INLINE void count_rest(struct span *s, const int16_t ways[LANES],
                                        const struct rf_counted_rays *rays, int n, vec_mask waiting)
{
    const vec_u16 times = vec_u16_set(rays->times[n]), guess = guess_of(s, rays, n);
    const vec_u16 all_ways = vec_u16_load(ways);

    do {
        const int16_t way = ways[vec_mask_first(waiting)];
        const vec_mask mask = vec_mask_equal(waiting, all_ways, vec_u16_set((uint16_t)way));
        const vec_u16 seen = vec_u16_load(s->blur + way);
        const vec_mask miss = missing(s, mask, guess, seen, rays->within[n]);

        count(s, way, vec_mask_without(mask, miss), times);
        s->hidden = vec_u16_add_where(miss, s->hidden, times);
        waiting = vec_mask_without(waiting, mask);
    } while (vec_mask_any(waiting));
}

/* Where all goes one or two ways these are, mostly, those of the first and of the last lane. */
static RF_ALWAYS_INLINE void count_two_ways(struct span *s, const struct chunk *c,
                                            const struct rf_counted_rays *rays)
{
    const vec_mask all = vec_mask_all();
    vec_u16 hidden = s->hidden;
    vec_mask others[RF_RAY_CHUNK];
    uint8_t rest[RF_RAY_CHUNK];
    int left = 0;

    for (int k = 0; k < c->mores; k++) {
        const int n = c->more[k];
        const int16_t one = c->way[k][0], two = c->way[k][LANES - 1];
        const vec_u16 times = vec_u16_set(rays->times[n]), way = vec_u16_load(c->way[k]);
        const vec_mask first = vec_mask_equal(all, way, vec_u16_set((uint16_t)one));
        const vec_mask not_first = vec_mask_without(all, first);
        const vec_mask second = vec_mask_equal(not_first, way, vec_u16_set((uint16_t)two));
        const vec_mask both = vec_mask_or(first, second);
        const vec_u16 seen =
            vec_u16_choose(first, vec_u16_load(s->blur + one), vec_u16_load(s->blur + two));
        const vec_mask miss = missing(s, both, guess_of(s, rays, n), seen, rays->within[n]);

        count(s, one, vec_mask_without(first, miss), times);
        count(s, two, vec_mask_without(second, miss), times);
        hidden = vec_u16_add_where(miss, hidden, times);
        rest[left] = (uint8_t)k;
        others[left] = vec_mask_without(not_first, second);
        left += vec_mask_any(others[left]);
    }
    s->hidden = hidden;
    for (int i = 0; i < left; i++)
        count_rest(s, c->way[rest[i]], rays, c->more[rest[i]], others[i]);
}

void RF_VEC(rf_count_hits)(uint16_t (*counts)[RF_TILE], uint8_t *touched, const int16_t *blur,
                           const struct rf_counted_rays *rays)
{
    const int middle = rf_count_number(0, 0);
    struct chunk chunk;

    for (int lane = 0; lane < RF_TILE; lane += LANES) {
        struct span s;

        s.count = (uint16_t(*)[RF_TILE])(counts[middle] + lane);
        s.touched = touched + middle;
        s.blur = blur + lane;
        s.own = vec_u16_load(s.blur);
        s.hidden = vec_u16_set(0);
        for (int n = 0, end; n < rays->rays; n = end) {
            end = rays->rays - n < RF_RAY_CHUNK ? rays->rays : n + RF_RAY_CHUNK;
            aim(&chunk, &s, rays, n, end);
            count_one_way(&s, &chunk, rays);
            count_two_ways(&s, &chunk, rays);
        }
        if (vec_u16_any(s.hidden))
            count(&s, 0, vec_mask_all(), s.hidden);
    }
}
