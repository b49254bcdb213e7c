/* holes.c: gives samples of a depth map without a value that of the surface around them. */
#include <stdlib.h>
#include <string.h>
#include "depth/holes.h"

enum {
    STRAIGHT = 2, /* distance to a neighbour in half samples, */
    DIAGONAL = 3, /* the distance to one across a corner */
    FARTHEST = RF_SAMPLE_UNKNOWN - 1,
    CONTINUOUS = 65535 / 32, /* largest step within a surface */
    THIN_STEP = 65535 / 2,   /* from a thin thing at the border to what is behind it, at least */
    SPREADS = 4,             /* scans to spread: enough to turn three corners */
    WIDEST = 16,             /* widest smoothing step, a power of 2 */
    OUTER = 4,               /* w is so much less in the outer columns */
    COLOUR = 3 * 65535 / 255 /* w is paid so often for a code between colours; holes.h */
};

struct holes {
    uint16_t *disparity;
    ptrdiff_t stride;
    uint8_t *state;
    int width, height;
    uint32_t weight; /* w in half samples */
    uint32_t gap;    /* half samples from a known one on where a hole begins; 0 in a dense map */
    struct rf_hole_colours colours;
};

static uint16_t *disparity_row(const struct holes *holes, int y)
{
    return (uint16_t *)((char *)holes->disparity + y * holes->stride);
}

static uint8_t *state_row(const struct holes *holes, int y)
{
    return holes->state + (size_t)y * (size_t)holes->width;
}

enum { EIGHT = 8 }; /* states that are looked at together: most are known */

static int all_known(const uint8_t *state)
{
    uint64_t eight;

    memcpy(&eight, state, sizeof eight);
    return eight == 0; /* RF_SAMPLE_KNOWN */
}

/* The first sample from x on that is not known, or the width. */
static int unknown_from(const uint8_t *state, int x, int width)
{
    while (x + EIGHT <= width && all_known(state + x))
        x += EIGHT;
    while (x < width && state[x] == RF_SAMPLE_KNOWN)
        x++;
    return x;
}

/* The last unknown sample up to x, or -1. */
static int unknown_to(const uint8_t *state, int x)
{
    while (x + 1 >= EIGHT && all_known(state + x + 1 - EIGHT))
        x -= EIGHT;
    while (x >= 0 && state[x] == RF_SAMPLE_KNOWN)
        x--;
    return x;
}

/* |p - q|, and in holes + w (d(q) + 3 |c(p) - c(q)|), in units of 1/65535 half sample: below 2^33.
 * p and q are numbered as the states are. */
static uint64_t cost(const struct holes *holes, uint32_t weight, uint32_t distance,
                     uint32_t disparity, ptrdiff_t p, ptrdiff_t q)
{
    uint32_t apart = disparity;

    if (distance <= holes->gap)
        return (uint64_t)distance * 65535;
    if (holes->colours.own)
        apart += COLOUR * rf_hole_colours_apart(&holes->colours, (size_t)p, (size_t)q);
    return (uint64_t)distance * 65535 + (uint64_t)weight * apart;
}

/* A row's samples from the first known one to the last one; last < first if none is known. */
struct known {
    int first, last;
};

static struct known known_of(const uint8_t *state, int width)
{
    struct known known = {0, width - 1};

    while (known.first < width && state[known.first] != RF_SAMPLE_KNOWN)
        known.first++;
    while (known.last >= 0 && state[known.last] != RF_SAMPLE_KNOWN)
        known.last--;
    return known;
}

enum samples { ALL, INNER }; /* inner ones have a known one at either side in their row */

static int is_outer(struct known known, int x)
{
    return x < known.first || x > known.last;
}

static int is_meant(struct known known, int x, enum samples which)
{
    return which == ALL || !is_outer(known, x);
}

static uint32_t weight_at(const struct holes *holes, struct known known, int x)
{
    return is_outer(known, x) ? holes->weight / OUTER : holes->weight;
}

/* Let an unknown sample take the disparity of another one, `step` away, when that costs less. */
static void spread_from(const struct holes *holes, uint32_t weight, uint16_t *disparity,
                        uint8_t *state, const uint16_t *from, const uint8_t *from_state,
                        uint32_t step)
{
    const ptrdiff_t p = state - holes->state, q = from_state - holes->state;
    uint32_t distance;

    if (*from_state == RF_SAMPLE_UNKNOWN)
        return;
    distance = *from_state + step;
    if (distance > FARTHEST)
        distance = FARTHEST;
    if (*state != RF_SAMPLE_UNKNOWN &&
        cost(holes, weight, distance, *from, p, q) >= cost(holes, weight, *state, *disparity, p, p))
        return;
    *disparity = *from;
    *state = (uint8_t)distance;
    if (holes->colours.own)
        memcpy(holes->colours.surface + 3 * p, holes->colours.surface + 3 * q, 3);
}

/* Samples from a border of the map on, along a row or a column. */
struct line {
    int x, y, dx, dy, length;
};

static uint8_t *state_at(const struct holes *holes, const struct line *line, int i)
{
    return state_row(holes, line->y + i * line->dy) + line->x + i * line->dx;
}

static uint16_t *disparity_at(const struct holes *holes, const struct line *line, int i)
{
    return disparity_row(holes, line->y + i * line->dy) + line->x + i * line->dx;
}

/* Samples of a hole at the border, which is the start of the line. */
static int unknown_at_start(const struct holes *holes, const struct line *line)
{
    int count = 0;

    while (count < line->length && *state_at(holes, line, count) != RF_SAMPLE_KNOWN)
        count++;
    return count < line->length ? count : 0;
}

/* The first known sample of the farther surface behind a thin thing that begins at `first` and is
 * no wider than the hole before it; 0 when there is none. */
static int behind_thin(const struct holes *holes, const struct line *line, int first)
{
    int nearer = *disparity_at(holes, line, first);

    for (int i = first + 1; i <= 2 * first && i < line->length; i++) {
        const int disparity = *disparity_at(holes, line, i);

        if (*state_at(holes, line, i) != RF_SAMPLE_KNOWN)
            continue;
        if (disparity + THIN_STEP < nearer)
            return i;
        nearer = disparity;
    }
    return 0;
}

/* Lets the last sample of a hole at the border have what lies behind a thin thing. */
static void look_behind(const struct holes *holes, const struct line *line)
{
    const int first = unknown_at_start(holes, line);
    const int behind = first > 0 ? behind_thin(holes, line, first) : 0;

    if (behind > 0)
        spread_from(holes, holes->weight, disparity_at(holes, line, first - 1),
                    state_at(holes, line, first - 1), disparity_at(holes, line, behind),
                    state_at(holes, line, behind), STRAIGHT);
}

static void look_behind_from_borders(const struct holes *holes)
{
    const int width = holes->width, height = holes->height;

    if (holes->gap > 0)
        return; /* single samples are no thin things */
    for (int y = 0; y < height; y++) {
        look_behind(holes, &(struct line){0, y, 1, 0, width});
        look_behind(holes, &(struct line){width - 1, y, -1, 0, width});
    }
    for (int x = 0; x < width; x++) {
        look_behind(holes, &(struct line){x, 0, 0, 1, height});
        look_behind(holes, &(struct line){x, height - 1, 0, -1, height});
    }
}

/* Lets an unknown sample take disparities of its neighbours in the row before. */
static void spread_down(const struct holes *holes, uint32_t weight, int x, int y, int before)
{
    uint16_t *d = disparity_row(holes, y) + x;
    uint8_t *state = state_row(holes, y) + x;
    const uint16_t *last = disparity_row(holes, before);
    const uint8_t *last_state = state_row(holes, before);

    spread_from(holes, weight, d, state, last + x, last_state + x, STRAIGHT);
    if (x > 0)
        spread_from(holes, weight, d, state, last + x - 1, last_state + x - 1, DIAGONAL);
    if (x + 1 < holes->width)
        spread_from(holes, weight, d, state, last + x + 1, last_state + x + 1, DIAGONAL);
}

/* Scans rows from the top or the bottom, and each row in both directions. */
static void spread(const struct holes *holes, int down, enum samples which)
{
    const int width = holes->width;

    for (int i = 0; i < holes->height; i++) {
        const int y = down ? i : holes->height - 1 - i;
        uint16_t *d = disparity_row(holes, y);
        uint8_t *state = state_row(holes, y);
        const struct known known = known_of(state, width);

        for (int x = -1; i > 0 && (x = unknown_from(state, x + 1, width)) < width;)
            if (is_meant(known, x, which))
                spread_down(holes, weight_at(holes, known, x), x, y, down ? y - 1 : y + 1);
        for (int x = 0; (x = unknown_from(state, x + 1, width)) < width;)
            if (is_meant(known, x, which))
                spread_from(holes, weight_at(holes, known, x), d + x, state + x, d + x - 1,
                            state + x - 1, STRAIGHT);
        for (int x = width - 1; (x = unknown_to(state, x - 1)) >= 0;)
            if (is_meant(known, x, which))
                spread_from(holes, weight_at(holes, known, x), d + x, state + x, d + x + 1,
                            state + x + 1, STRAIGHT);
    }
}

static int has_outer(const struct holes *holes)
{
    for (int y = 0; y < holes->height; y++) {
        const uint8_t *state = state_row(holes, y);

        if (state[0] != RF_SAMPLE_KNOWN || state[holes->width - 1] != RF_SAMPLE_KNOWN)
            return 1;
    }
    return 0;
}

static void forget_inner(const struct holes *holes)
{
    for (int y = 0; y < holes->height; y++) {
        uint8_t *state = state_row(holes, y);
        const struct known known = known_of(state, holes->width);

        for (int x = known.first; x <= known.last; x++)
            if (state[x] != RF_SAMPLE_KNOWN)
                state[x] = RF_SAMPLE_UNKNOWN;
    }
}

/* Fills all samples; then the inner ones anew, as they may have what an outer one had that took
 * another disparity since. */
static void spread_all(const struct holes *holes)
{
    look_behind_from_borders(holes);
    for (int i = 0; i < SPREADS; i++)
        spread(holes, i % 2 == 0, ALL);
    if (!has_outer(holes))
        return;
    forget_inner(holes);
    look_behind_from_borders(holes);
    for (int i = 0; i < SPREADS; i++)
        spread(holes, i % 2 == 0, INNER);
}

/* Mean of the sample and of those of its eight neighbours @p step away that continue it. */
static uint16_t smoothed(const struct holes *holes, int x, int y, int step)
{
    const int centre = disparity_row(holes, y)[x];
    int sum = centre, count = 1;

    for (int j = y - step; j <= y + step; j += step) {
        if (j < 0 || j >= holes->height)
            continue;
        const uint16_t *d = disparity_row(holes, j);
        for (int i = x - step; i <= x + step; i += step) {
            if (i < 0 || i >= holes->width || (i == x && j == y) || abs(d[i] - centre) > CONTINUOUS)
                continue;
            sum += d[i];
            count++;
        }
    }
    return (uint16_t)((sum + count / 2) / count);
}

/* Smooths in place, which carries values on along the scan: so it goes to and fro in turns. */
static void smooth(const struct holes *holes, int step, int forwards)
{
    for (int i = 0; i < holes->height; i++) {
        const int y = forwards ? i : holes->height - 1 - i;
        uint16_t *d = disparity_row(holes, y);
        const uint8_t *state = state_row(holes, y);

        for (int x = -1; forwards && (x = unknown_from(state, x + 1, holes->width)) < holes->width;)
            if (state[x] >= step * STRAIGHT)
                d[x] = smoothed(holes, x, y, step);
        for (int x = holes->width; !forwards && (x = unknown_to(state, x - 1)) >= 0;)
            if (state[x] >= step * STRAIGHT)
                d[x] = smoothed(holes, x, y, step);
    }
}

/* Known samples among the neighbours of one. */
static int known_around(const struct holes *holes, int x, int y)
{
    int count = 0;

    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < holes->height; j++)
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < holes->width; i++)
            count += (i != x || j != y) && state_row(holes, j)[i] == RF_SAMPLE_KNOWN;
    return count;
}

/* Twice the mean distance of known samples, in half samples, where most of them are single ones,
 * which have less than half of their neighbours; else 0, as where half of all are known. With 5 %
 * of them at random the mean distance is 4.5 samples, and 4 of a million gaps are wider than 9. */
static uint32_t gap_of(const struct holes *holes)
{
    const uint64_t samples = (uint64_t)holes->width * (uint64_t)holes->height;
    uint64_t unknown = 0, single = 0, known;
    uint32_t gap = 0;

    for (int y = 0; y < holes->height; y++)
        for (int x = -1;
             (x = unknown_from(state_row(holes, y), x + 1, holes->width)) < holes->width;)
            unknown++;
    known = samples - unknown;
    if (known > unknown || holes->width < 3 || holes->height < 3)
        return 0; /* in a line all have few neighbours */
    for (int y = 0; y < holes->height; y++)
        for (int x = 0; x < holes->width; x++)
            single += state_row(holes, y)[x] == RF_SAMPLE_KNOWN && known_around(holes, x, y) < 4;
    if (2 * single <= known)
        return 0;
    while (gap < FARTHEST && (uint64_t)gap * gap * known < 4 * 4 * samples)
        gap++;
    return gap;
}

/* Settles what surfaces look like beside holes, which is where they spread from. */
static void settle_colours(const struct holes *holes)
{
    const int width = holes->width, height = holes->height;

    for (int y = 0; y < height; y++)
        for (int x = -1; (x = unknown_from(state_row(holes, y), x + 1, width)) < width;)
            for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < height; j++)
                for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < width; i++)
                    if (state_row(holes, j)[i] == RF_SAMPLE_KNOWN)
                        rf_hole_colours_settle(&holes->colours, holes->disparity, holes->stride,
                                               holes->state, i, j, CONTINUOUS);
}

void rf_fill_holes(uint16_t *disparity, ptrdiff_t stride, int width, int height, uint8_t *state,
                   const struct refocus_image *photo)
{
    const size_t samples = (size_t)width * (size_t)height;
    const int side = width > height ? width : height;
    struct holes holes = {.disparity = disparity,
                          .stride = stride,
                          .state = state,
                          .width = width,
                          .height = height,
                          .weight = (uint32_t)(side > 128 ? side / 8 : 16) * STRAIGHT};

    holes.gap = gap_of(&holes);
    if (photo) {
        holes.colours =
            (struct rf_hole_colours){width, height, state + samples, state + 4 * samples};
        rf_hole_colours_load(&holes.colours, photo);
        settle_colours(&holes);
    }
    spread_all(&holes);
    for (int step = WIDEST; step >= 1; step /= 2) {
        smooth(&holes, step, 1);
        smooth(&holes, step, 0);
    }
}
