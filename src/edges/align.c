/* align.c: moves the edges of a disparity map onto the photo's, where they do not lie on them.
 *
 * How well edges lie on the photo is the mean, over them, of the photo's gradient across them. An
 * exact map has about twice as much of it in place as a few pixels beside. So
 *
 *   1. For each block the shift with the most of it is looked for. The map is on the photo where
 *      most blocks want none: nothing is done.
 *   2. Else one shift of the whole map, or one number of pixels by which near surfaces are too
 *      large or too small, is undone if it is clearly better than none, and the latter if half of
 *      the edges come to lie on the photo: thin surfaces that are less fat than others would go.
 *   3. Else each block's edges go where they fit best, and then once more in blocks half as large,
 *      if they fit clearly better there.
 *
 * A worked example: 'grown by 4 pixels' has 0.65 of the median support in place, 2.3 with near
 * surfaces smaller by 4: step 2. A map of a network has 1.2 in place, no shift is better, and 1.6
 * after step 3. An exact map by night, where blocks are unsure, has 1.5 in place: it stays. With
 * the photo of another scene it is 0.96 to 1.03: there is nothing to go by, and it stays too.
 */
#include "edges/blocks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/compare.h"

enum {
    REACH = RF_EDGE_SHIFT,
    GROWTHS = 2 * RF_MOST_GROWN + 1,
    FEWEST = 200, /* edges that can tell */
};
static const double ON_PHOTO = 0.75;  /* share of edges: the map needs nothing */
static const double FITS = 1.4;       /* support in place: blocks are unsure, not wrong */
static const double UNRELATED = 1.06; /* less support in place: it is the photo of something else */
static const double CLEARLY = 1.15;   /* times better */
static const double STICKS = 0.05;    /* in a video all of them lean so far to the last decision */
static const double SOFTEST = 3.2;    /* pixels: softer edges say little of their place */

/* 1 or -1: the last frame's edges were moved, or were not; 0: there is none. */
static int was_moved(const struct rf_edges *e)
{
    return !e->last ? 0 : e->last->aligned ? 1 : -1;
}

static double on_photo(const struct rf_edges *e)
{
    return ON_PHOTO + STICKS * was_moved(e);
}

static double clearly(const struct rf_edges *e)
{
    return CLEARLY - STICKS * was_moved(e);
}

/* ----- what is common to all edges ----- */

/* The mean support of all edges in place. */
static double support_in_place(const struct rf_edges *e)
{
    const int every = rf_every_edge(e);
    int64_t total = 0;
    int n = 0;

    for (int i = 0; i < e->edges; i += every, n++)
        total += rf_photo_edge_at(e, &e->edge[i], e->edge[i].x, e->edge[i].y);
    return n ? (double)total / n : 0;
}

/* The support `along` pixels towards the nearer side of each edge; from -REACH - 1 on. */
static void ask_growths(const struct rf_edges *e, int64_t total[GROWTHS])
{
    const int every = rf_every_edge(e);

    for (int k = 0; k < GROWTHS; k++) {
        const int along = k - REACH - 1;

        total[k] = 0;
        for (int i = 0; i < e->edges; i += every) {
            const struct rf_map_edge *edge = &e->edge[i];
            const int x = (along * edge->normal_x + 64) >> 7,
                      y = (along * edge->normal_y + 64) >> 7;

            total[k] += rf_photo_edge_at(e, edge, edge->x + x, edge->y + y);
        }
    }
}

/* One correction of the whole map. */
struct whole {
    struct rf_shift shift;
    double grown;       /* pixels that near surfaces are too large by, a fraction too */
    double worth, zero; /* support with it and without, in medians */
};

/* The peak of a parabola through three values, from the middle one. */
static double peak(double before, double middle, double after)
{
    const double bend = before - 2 * middle + after;

    return bend < 0 ? 0.5 * (before - after) / bend : 0;
}

static struct whole ask_whole(const struct rf_blocks *b)
{
    /* In the photo the silhouette of a near thing lies a little on its far side: it is mixed. */
    static const double FAR_SIDE = 0.2;
    int64_t growth[GROWTHS], all[RF_MOST_SHIFTS + GROWTHS];
    struct whole whole = {{0, 0}, 0, -1e9, 0};
    double middle;

    ask_growths(b->e, growth);
    memcpy(all, b->total, (size_t)b->shifts * sizeof *all);
    memcpy(all + b->shifts, growth, sizeof growth);
    middle = (double)rf_median(all, b->shifts + GROWTHS) + 1e-9;
    for (int k = 1; k < GROWTHS - 1; k++) {
        const int along = k - REACH - 1;
        const double worth = (double)growth[k] / middle - 0.03 * abs(along);

        if (worth <= whole.worth)
            continue;
        whole.worth = worth;
        whole.grown =
            along + FAR_SIDE +
            (along ? peak((double)growth[k - 1], (double)growth[k], (double)growth[k + 1]) : 0);
    }
    for (int i = 0; i < b->shifts; i++) {
        const double worth = (double)b->total[i] / middle - 0.03 * b->length[i];

        if (b->shift[i].x == 0 && b->shift[i].y == 0)
            whole.zero = worth;
        if (worth > whole.worth) {
            whole.worth = worth;
            whole.shift = b->shift[i];
            whole.grown = 0;
        }
    }
    return whole;
}

/* ----- corrections ----- */

struct change {
    struct rf_edges *e;
    const struct rf_blocks *blocks; /* or NULL */
    struct rf_shift shift;
};

/* The pixel at a place, rounded, or the nearest one. */
static uint16_t pixel_at(const struct rf_edges *e, double x, double y)
{
    enum { FAR = 64 }; /* no place is so far out: casts round down */
    const int u = (int)(x + FAR + 0.5) - FAR, v = (int)(y + FAR + 0.5) - FAR;

    return e->map[rf_smaller(rf_larger(v, 0), e->height - 1) * e->stride +
                  rf_smaller(rf_larger(u, 0), e->width - 1)];
}

static void shift_row(void *context, int y, int worker)
{
    const struct change *change = context;
    const struct rf_edges *e = change->e;

    (void)worker;
    for (int x = 0; x < e->width; x++)
        e->spare[y * e->stride + x] = pixel_at(e, x - change->shift.x, y - change->shift.y);
}

/* A field in the middle of a column of blocks, `down` blocks below the middles of the first row. */
static double field_at(const struct rf_blocks *b, const double *field, int column, double down)
{
    const int row = rf_smaller((int)down, rf_larger(b->down - 2, 0));
    const double *at = field + (ptrdiff_t)row * b->across + rf_smaller(column, b->across - 1);

    return at[0] * (1 - (down - row)) + at[b->down > 1 ? b->across : 0] * (down - row);
}

/* Moves each pixel by what is between the fields in the middles of the blocks around. */
static void bend_row(void *context, int y, int worker)
{
    const struct change *change = context;
    const struct rf_blocks *b = change->blocks;
    const struct rf_edges *e = change->e;
    const double down = fmin(fmax((y + 0.5) / b->side - 0.5, 0), b->down - 1);

    (void)worker;
    for (int column = 0, x = 0; x < e->width; column++) {
        const int next = (column + 1) * b->side + b->side / 2;
        const int end = column < b->across - 2 ? rf_smaller(next, e->width) : e->width;
        const double right = field_at(b, b->right, column, down);
        const double below = field_at(b, b->below, column, down);
        const double more_right = field_at(b, b->right, column + 1, down) - right;
        const double more_below = field_at(b, b->below, column + 1, down) - below;

        for (; x < end; x++) {
            const double at = (x + 0.5) / b->side - 0.5 - column;
            const double share = at < 0 ? 0 : at < 1 ? at : 1;

            e->spare[y * e->stride + x] =
                pixel_at(e, x - (right + more_right * share), y - (below + more_below * share));
        }
    }
}

static void move(struct rf_edges *e, const struct rf_blocks *blocks, struct rf_shift shift)
{
    struct change change = {.e = e, .blocks = blocks, .shift = shift};

    rf_pool_run(e->pool, blocks ? bend_row : shift_row, &change, e->height);
    rf_copy_plane(e, e->map, e->spare);
}

/* Ramps of the map as it is now. */
static void find_ramps(struct rf_edges *e, const struct rf_ramp_limits *limits)
{
    if (!limits) {
        rf_find_rough_blocks(e, e->map);
        return;
    }
    rf_find_steepest(e);
    rf_find_ramps(e, *limits);
}

/* Ramps and edges of the map as it is now. */
static void look_again(struct rf_edges *e, const struct rf_ramp_limits *limits)
{
    find_ramps(e, limits);
    rf_find_map_edges(e, limits ? e->label : e->map);
}

/*
 * Makes near surfaces smaller or larger by the whole number of pixels that fits best, by the sum of
 * the support, so that edges of surfaces that are gone count as none. Where half of the edges, or
 * more, come to lie on the photo, with twice the support, there is half as much more. Else they are
 * off by different lengths, and wires would be cut up: 0, and the map is as it was.
 */
static int undo_growth(struct rf_edges *e, double grown, const struct rf_ramp_limits *limits)
{
    static const double HALF_FIT = 1.5;
    const int sign = grown < 0 ? -1 : 1, least = rf_smaller((int)fabs(grown), RF_MOST_GROWN - 1);
    double most = (HALF_FIT - STICKS * was_moved(e)) * e->edges * support_in_place(e);
    int best = 0;

    rf_copy_plane(e, e->kept, e->map);
    for (int pixels = least; pixels <= least + 1; pixels++) {
        double support;

        rf_copy_plane(e, e->map, e->kept);
        rf_regrow(e, sign * pixels);
        look_again(e, limits);
        support = e->edges * support_in_place(e);
        if (support > most) {
            most = support;
            best = sign * pixels;
        }
    }
    if (best == sign * (least + 1))
        return best;
    rf_copy_plane(e, e->map, e->kept);
    if (best)
        rf_regrow(e, best);
    look_again(e, limits);
    return best;
}

/* Moves edges block by block; false, and the map is as it was, if they do not fit clearly better.
 */
static bool bend(struct rf_edges *e, const struct rf_blocks *large,
                 const struct rf_ramp_limits *limits)
{
    const double before = support_in_place(e);
    struct rf_blocks small = rf_blocks_of(e, RF_SMALL_BLOCK, RF_SMALL_REACH);

    rf_copy_plane(e, e->kept, e->map);
    move(e, large, (struct rf_shift){0, 0});
    look_again(e, limits);
    rf_ask_blocks(&small, 0.05);
    move(e, &small, (struct rf_shift){0, 0});
    look_again(e, limits);
    if (support_in_place(e) > clearly(e) * before)
        return true;
    rf_copy_plane(e, e->map, e->kept);
    find_ramps(e, limits);
    return false;
}

struct rf_alignment rf_align(struct rf_edges *e, double softness,
                             const struct rf_ramp_limits *limits)
{
    struct rf_alignment found = {.on_photo = 1};
    struct rf_blocks large = rf_blocks_of(e, RF_LARGE_BLOCK, REACH);
    struct whole whole;
    bool is_related;

    rf_find_map_edges(e, limits ? e->label : e->map);
    if (e->edges < FEWEST || rf_run_cancelled(e->pool->run))
        return found;
    rf_find_photo_gradient(e);
    found.on_photo = rf_ask_blocks(&large, 0.1);
    if (found.on_photo >= on_photo(e) || rf_run_cancelled(e->pool->run))
        return found;
    whole = ask_whole(&large);
    if (whole.worth > clearly(e) * whole.zero) {
        if (fabs(whole.grown) >= 1.5 && (softness == 0 || fabs(whole.grown) > softness))
            found.grown = undo_growth(e, whole.grown, limits);
        else if (rf_shift_length(whole.shift) >= 2) {
            found.shift_x = whole.shift.x;
            found.shift_y = whole.shift.y;
            move(e, NULL, whole.shift);
            look_again(e, limits);
        }
        found.on_photo = rf_ask_blocks(&large, 0.1);
    }
    is_related = whole.zero > UNRELATED || found.grown || found.shift_x || found.shift_y;
    if (found.on_photo < on_photo(e) && softness < SOFTEST && whole.zero < FITS && is_related)
        found.bent = bend(e, &large, limits);
    return found;
}
