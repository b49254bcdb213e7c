/* vote.c: gives each pixel of a ramp to the surface at one of its ends.
 *
 * A pixel p between the ends N (near) and F (far) of its ramp lies at a share a = (d - F) / (N -
 * F). Those around it that are on no ramp, and whose disparity fits N or F, vote by how near they
 * are to p and how much they look like it, as in joint bilateral filters:
 *
 *     p is near where  (near - far) / (near + far) + a - 1/2 > 0
 *
 * and takes the mean of those that it was given to. The second term is what the map itself says: it
 * decides where the photo does not. A ramp of little contrast may as well be a slope, or what a
 * network is off by within a surface: its pixels stay as they are unless the photo is sure of them.
 */
#include "edges/window.h"

#include <stdlib.h>
#include <string.h>

#include "depth/median.h"

enum {
    LOW_CONTRAST = 6554, /* 0.1, of a ramp that the photo has to be sure of */
    SURE = 80,           /* percent of all votes that one side has more than the other */
};

struct vote {
    struct rf_edges *e;
    uint16_t *voter;
    struct rf_vote_shape shape;
};

/* Columns beyond the right side of a narrow map do not vote. */
static void find_voters(void *context, int y, int worker)
{
    const struct vote *vote = context;
    const struct rf_edges *e = vote->e;
    const ptrdiff_t at = y * e->stride;
    uint16_t *voter = vote->voter + at;
    bool rough;

    (void)worker;
    for (int x = 0; x < e->width; x++)
        voter[x] = (uint16_t)(e->label[at + x] + (e->label[at + x] == 0));
    for (int x = 0, n; x < e->width; x += n) {
        n = rf_edge_run(e, x, y, &rough);
        for (int u = x; u < x + n && rough; u++)
            if (rf_is_between(e, at + u, e->map[at + u]))
                voter[u] = 0;
    }
    for (int x = e->width; x < RF_MOST_VOTE_COLUMNS; x++)
        voter[x] = 0;
}

static struct rf_votes ask(const struct vote *vote, int x, int y)
{
    const struct rf_edges *e = vote->e;
    const ptrdiff_t at = y * e->stride + x;
    const struct rf_vote_place place = rf_place_window(e, &vote->shape, x, y);
    const int near = e->near[at], far = e->far[at], half = (near - far) / 2;
    const struct rf_vote_window window = {
        .colour = {e->colour[0] + place.first, e->colour[1] + place.first,
                   e->colour[2] + place.first},
        .voter = vote->voter + place.first,
        .stride = e->stride,
        .nearness = place.nearness,
        .nearness_stride = (ptrdiff_t)sizeof vote->shape.nearness[0] * vote->shape.step,
        .columns = vote->shape.columns,
        .rows = place.rows,
        .step = vote->shape.step,
        .own = {e->colour[0][at], e->colour[1][at], e->colour[2][at]},
        .least = (uint16_t)rf_larger(far - half, 1),
        .middle = (uint16_t)((near + far) / 2),
        .most = (uint16_t)rf_smaller(near + half, 65535),
    };

    return e->kernels->tally(&window);
}

/* The mean of those on one side, or the end of the ramp where there is none of them. */
static uint16_t mean_of(uint32_t value, uint32_t weight, int least, uint16_t end)
{
    return weight ? (uint16_t)rf_smaller(least + (int)(value * UINT64_C(32) / weight) + 16, 65535)
                  : end;
}

/* A pixel that is left alone is on no ramp for settle.c. */
static uint16_t decide(const struct vote *vote, int x, int y)
{
    struct rf_edges *e = vote->e;
    const ptrdiff_t at = y * e->stride + x;
    const int near = e->near[at], far = e->far[at];
    const struct rf_votes votes = ask(vote, x, y);
    const int64_t all = (int64_t)votes.near + votes.far + 1;
    const int64_t more = (int64_t)votes.near - votes.far;
    /* Twice the sum above, times `all` and the contrast. */
    const int64_t photo = 2 * more * (near - far);
    const int64_t map = (2 * ((int64_t)e->map[at] - far) - (near - far)) * all;
    const int least = rf_larger(far - (near - far) / 2, 1);

    if (near - far < LOW_CONTRAST && llabs(more) * 100 < all * SURE) {
        e->near[at] = e->far[at] = e->map[at];
        return e->map[at];
    }
    return photo + map > 0 ? mean_of(votes.near_value, votes.near, least, e->near[at])
                           : mean_of(votes.far_value, votes.far, least, e->far[at]);
}

static void decide_row(void *context, int y, int worker)
{
    const struct vote *vote = context;
    struct rf_edges *e = vote->e;
    const ptrdiff_t at = y * e->stride;
    bool rough;

    (void)worker;
    memcpy(e->spare + at, e->label + at, (size_t)e->width * sizeof *e->label);
    for (int x = 0, n; x < e->width; x += n) {
        n = rf_edge_run(e, x, y, &rough);
        for (int u = x; u < x + n && rough; u++)
            if (!vote->voter[at + u])
                e->spare[at + u] = decide(vote, u, y);
    }
}

/* Single pixels that were given to the other side than all around them are put right. */
static void clean_row(void *context, int y, int worker)
{
    const struct vote *vote = context;
    struct rf_edges *e = vote->e;
    const ptrdiff_t at = y * e->stride;
    bool rough;

    (void)worker;
    memcpy(e->label + at, e->spare + at, (size_t)e->width * sizeof *e->label);
    if (y == 0 || y == e->height - 1)
        return;
    for (int x = 0, n; x < e->width; x += n) {
        n = rf_edge_run(e, x, y, &rough);
        for (int u = rf_larger(x, 1); u < rf_smaller(x + n, e->width - 1) && rough; u++)
            if (!vote->voter[at + u])
                e->label[at + u] = rf_median_of_nine(e->spare + at + u, e->stride);
    }
}

void rf_vote(struct rf_edges *e, double softness)
{
    struct vote vote = {.e = e, .voter = e->largest, .shape = rf_vote_shape(softness, 0.75)};

    rf_pool_run(e->pool, find_voters, &vote, e->height);
    rf_pool_run(e->pool, decide_row, &vote, e->height);
    rf_pool_run(e->pool, clean_row, &vote, e->height);
}
