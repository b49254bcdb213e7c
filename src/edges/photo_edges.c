/* photo_edges.c: finds the edges of a disparity map, and how much of an edge the photo has there.
 */
#include "edges/edges.h"

#include <math.h>
#include <string.h>

#include "support/compare.h"

enum {
    MARGIN = 12,        /* pixels from the sides, within which no edge is looked for */
    LEAST_SLOPE = 393,  /* 0.006 a pixel */
    LEAST_RANGE = 2621, /* 0.04 within 5 x 5 pixels */
};

struct channel {
    struct rf_edges *e;
    const uint8_t *codes;        /* one of them */
    const uint16_t *disparities; /* or these */
    uint16_t *smooth;
    bool first;
};

/* Three values around i by weights 1, 2, 1, at the ends of a row with the last one repeated. */
static inline int binomial(int before, int own, int after)
{
    return before + 2 * own + after;
}

/* A binomial 3x3 mean of codes in 1/16, or of disparities. */
static void smooth_band(void *context, int band, int worker)
{
    const struct channel *channel = context;
    const struct rf_edges *e = channel->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++) {
        const ptrdiff_t here = y * e->stride, above = rf_larger(y - 1, 0) * e->stride;
        const ptrdiff_t below = rf_smaller(y + 1, e->height - 1) * e->stride;
        uint16_t *out = channel->smooth + here;
        int column[3]; /* sums of the columns to the left, in the middle and to the right */

        for (int x = 0; x <= e->width; x++) {
            const int at = rf_smaller(x, e->width - 1);

            column[0] = x > 1 ? column[1] : 0;
            column[1] = x > 0 ? column[2] : 0;
            column[2] =
                channel->codes
                    ? binomial(channel->codes[above + at], channel->codes[here + at],
                               channel->codes[below + at])
                    : binomial(channel->disparities[above + at], channel->disparities[here + at],
                               channel->disparities[below + at]);
            if (x == 1)
                column[0] = column[1];
            if (x > 0)
                out[x - 1] = (uint16_t)(binomial(column[0], column[1], column[2]) >>
                                        (channel->codes ? 0 : 4));
        }
    }
}

/* Sobel's operator at a pixel that is not at a side: eight times the slope. */
static inline int slope_x(const uint16_t *p, ptrdiff_t s)
{
    return binomial(p[1 - s], p[1], p[1 + s]) - binomial(p[-1 - s], p[-1], p[-1 + s]);
}

static inline int slope_y(const uint16_t *p, ptrdiff_t s)
{
    return binomial(p[s - 1], p[s], p[s + 1]) - binomial(p[-s - 1], p[-s], p[-s + 1]);
}

static void gradient_band(void *context, int band, int worker)
{
    const struct channel *channel = context;
    const struct rf_edges *e = channel->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++) {
        int16_t *gx = e->gradient.x + y * e->stride, *gy = e->gradient.y + y * e->stride;
        const uint16_t *smooth = channel->smooth + y * e->stride;

        if (channel->first) {
            memset(gx, 0, (size_t)e->width * sizeof *gx);
            memset(gy, 0, (size_t)e->width * sizeof *gy);
        }
        if (y == 0 || y == e->height - 1)
            continue;
        for (int x = 1; x < e->width - 1; x++) {
            const int right = slope_x(smooth + x, e->stride) / 8;
            const int down = slope_y(smooth + x, e->stride) / 8;
            const int now = gx[x] * gx[x] + gy[x] * gy[x];

            if (right * right + down * down > now) {
                gx[x] = (int16_t)right;
                gy[x] = (int16_t)down;
            }
        }
    }
}

void rf_find_photo_gradient(struct rf_edges *e)
{
    for (int c = 0; c < 3; c++) {
        struct channel channel = {
            .e = e, .codes = e->colour[c], .smooth = e->spare, .first = c == 0};

        rf_pool_run(e->pool, smooth_band, &channel, rf_edge_bands(e));
        rf_pool_run(e->pool, gradient_band, &channel, rf_edge_bands(e));
    }
}

int rf_photo_edge_at(const struct rf_edges *e, const struct rf_map_edge *edge, int x, int y)
{
    const ptrdiff_t at = rf_smaller(rf_larger(y, 0), e->height - 1) * e->stride +
                         rf_smaller(rf_larger(x, 0), e->width - 1);
    const int across = e->gradient.x[at] * edge->normal_x + e->gradient.y[at] * edge->normal_y;

    return rf_smaller((across < 0 ? -across : across) >> 7, RF_MOST_PHOTO_EDGE);
}

/* ----- edges of the map ----- */

/* The slope at a pixel of the smoothed map in 1/65536 a pixel, at most 2^16 / 2 sqrt(2). */
static void slope_band(void *context, int band, int worker)
{
    const struct channel *channel = context;
    const struct rf_edges *e = channel->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++) {
        const uint16_t *smooth = channel->smooth + y * e->stride;
        uint16_t *slope = e->largest + y * e->stride;
        const bool inside = y > 0 && y < e->height - 1;

        for (int x = 0; x < e->width; x++) {
            double right, down;

            slope[x] = 0;
            if (!inside || x == 0 || x == e->width - 1 || !rf_edge_is_rough(e, x, y))
                continue;
            right = slope_x(smooth + x, e->stride);
            down = slope_y(smooth + x, e->stride);
            slope[x] = (uint16_t)(sqrt(right * right + down * down) / 8);
        }
    }
}

/* The slope between pixels, at an offset of at most one pixel in Q7: 16384 times it. */
static int64_t slope_at(const struct rf_edges *e, int x, int y, int right, int down)
{
    const int u = x + (right < 0 ? -1 : 0), v = y + (down < 0 ? -1 : 0);
    const int across = right < 0 ? right + 128 : right, along = down < 0 ? down + 128 : down;
    const uint16_t *p = e->largest + v * e->stride + u;
    const int64_t above = p[0] * (128 - across) + p[1] * across;
    const int64_t below = p[e->stride] * (128 - across) + p[e->stride + 1] * across;

    return above * (128 - along) + below * along;
}

static bool is_step(const struct rf_edges *e, const uint16_t *plane, int x, int y)
{
    int least = 65535, most = 0;

    for (int v = y - 2; v <= y + 2; v++)
        for (int u = x - 2; u <= x + 2; u++) {
            least = rf_smaller(least, plane[v * e->stride + u]);
            most = rf_larger(most, plane[v * e->stride + u]);
        }
    return most - least > LEAST_RANGE;
}

/* A pixel where the map is steeper than to either side, as Canny has it. */
static bool is_edge(const struct rf_edges *e, const uint16_t *smooth, int x, int y,
                    struct rf_map_edge *edge)
{
    const ptrdiff_t at = y * e->stride + x;
    const int slope = e->largest[at];

    if (slope <= LEAST_SLOPE)
        return false;
    *edge = (struct rf_map_edge){
        .x = (uint16_t)x,
        .y = (uint16_t)y,
        .normal_x = (int16_t)(slope_x(smooth + at, e->stride) * 16 / slope),
        .normal_y = (int16_t)(slope_y(smooth + at, e->stride) * 16 / slope),
    };
    edge->normal_x = (int16_t)rf_smaller(rf_larger(edge->normal_x, -127), 127);
    edge->normal_y = (int16_t)rf_smaller(rf_larger(edge->normal_y, -127), 127);
    return (int64_t)slope << 14 >= slope_at(e, x, y, edge->normal_x, edge->normal_y) &&
           (int64_t)slope << 14 > slope_at(e, x, y, -edge->normal_x, -edge->normal_y);
}

void rf_find_map_edges(struct rf_edges *e, const uint16_t *plane)
{
    struct channel channel = {.e = e, .disparities = plane, .smooth = e->spare};

    rf_find_rough_blocks(e, plane);
    rf_pool_run(e->pool, smooth_band, &channel, rf_edge_bands(e));
    rf_pool_run(e->pool, slope_band, &channel, rf_edge_bands(e));
    e->edges = 0;
    for (int y = MARGIN; y < e->height - MARGIN; y++)
        for (int x = MARGIN; x < e->width - MARGIN; x++) {
            struct rf_map_edge edge;

            if (!rf_edge_is_rough(e, x, y) || !is_edge(e, e->spare, x, y, &edge) ||
                !is_step(e, plane, x, y))
                continue;
            if (e->edges == e->most_edges) { /* noise */
                e->edges = 0;
                return;
            }
            e->edge[e->edges++] = edge;
        }
}
