/* steady.c: keeps the edges of a video's depth from flickering.
 *
 * Votes are taken by a photo with noise, and close ones turn from frame to frame, although nothing
 * moves. An edge that moves changes the map: half a pixel of motion changes a ramp of 8 pixels by a
 * sixteenth of its contrast. So where the map is that of the last frame, the result is too. Small
 * differences are followed by a quarter a frame.
 *
 * But the photo decides where an edge is, up to 5 pixels from its place in the map, and may come
 * more often than the map does. So nothing stays near what moves in the photo: edges would leave
 * crumbs behind wherever they have been.
 */
#include "edges/edges.h"

#include <stdlib.h>

#include "support/compare.h"

enum {
    SAME = 2,     /* codes of eight bits */
    MOVED = 32,   /* codes of the photo: something has moved over the pixel */
    FEWEST = 4,   /* such pixels of a block; fewer are noise */
    SMALL = 1024, /* 1/64 of the range; larger ones are another decision */
    NONE = 0,     /* as a result: it is decided anew */
};
_Static_assert((int)RF_EDGE_BLOCK > (int)RF_EDGE_SHIFT, "a block around is as far as edges go");

static bool has_moved(const struct rf_edges *e, const struct rf_last_edges *last, int x0, int y0)
{
    const int x1 = rf_smaller(x0 + RF_EDGE_BLOCK, e->width);
    const int y1 = rf_smaller(y0 + RF_EDGE_BLOCK, e->height);
    int found = 0;

    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            found += abs(e->colour[1][y * e->stride + x] -
                         last->photo[(ptrdiff_t)y * e->width + x]) > MOVED;
    return found >= FEWEST;
}

/* Marks blocks in which something has moved since their pixels were decided. */
static void find_moved(struct rf_edges *e, const struct rf_last_edges *last)
{
    uint8_t *moved = e->moved[0];

    for (int y = 0; y < e->height; y += RF_EDGE_BLOCK)
        for (int x = 0; x < e->width; x += RF_EDGE_BLOCK)
            *moved++ = has_moved(e, last, x, y);
}

/* Whether the block of a pixel is marked, or one of those around it. */
static bool is_near_moved(const struct rf_edges *e, int x, int y)
{
    const int across = rf_edge_blocks_across(e);
    const int last_row = (e->height - 1) / RF_EDGE_BLOCK;
    const int column = x / RF_EDGE_BLOCK, row = y / RF_EDGE_BLOCK;

    for (int v = rf_larger(row - 1, 0); v <= rf_smaller(row + 1, last_row); v++)
        for (int u = rf_larger(column - 1, 0); u <= rf_smaller(column + 1, across - 1); u++)
            if (e->moved[0][v * across + u])
                return true;
    return false;
}

/* The pixels of a row that lie in one block. */
static void forget_run(const struct rf_edges *e, struct rf_last_edges *last, int x, int y,
                       bool moved)
{
    const int end = rf_smaller(x + RF_EDGE_BLOCK, e->width);

    for (; x < end; x++) {
        const ptrdiff_t at = (ptrdiff_t)y * e->width + x, in = y * e->stride + x;
        const uint8_t map = (uint8_t)(e->map[in] >> 8);

        if (!moved && abs(map - last->map[at]) <= SAME)
            continue;
        last->result[at] = NONE;
        last->map[at] = map;
        last->photo[at] = e->colour[1][in];
    }
}

void rf_forget_moved(struct rf_edges *e, struct rf_last_edges *last)
{
    const bool none = !e->last;

    if (!none)
        find_moved(e, last);
    for (int y = 0; y < e->height; y++)
        for (int x = 0; x < e->width; x += RF_EDGE_BLOCK)
            forget_run(e, last, x, y, none || is_near_moved(e, x, y));
}

void rf_hold_still(struct rf_edges *e, struct rf_last_edges *last)
{
    for (int y = 0; y < e->height; y++) {
        uint16_t *now = e->map + y * e->stride;
        uint16_t *was = last->result + (ptrdiff_t)y * e->width;

        for (int x = 0; x < e->width; x++) {
            const int by = now[x] - was[x];

            if (was[x] != NONE)
                now[x] = (uint16_t)(was[x] + (abs(by) < SMALL ? by / 4 : 0));
            was[x] = (uint16_t)rf_larger(now[x], NONE + 1);
        }
    }
    last->width = e->width;
    last->height = e->height;
}
