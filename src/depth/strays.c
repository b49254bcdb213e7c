/* strays.c: finds single samples of a map of distances that are far nearer than all others. */
#include "depth/strays.h"

#include <stdbool.h>

#include "depth/samples.h"

enum {
    SHARE = 1000, /* strays are fewer than one of so many samples */
    LOOKS = 32,
    SQUARE = 3, /* a square of this side is a thing */
    VALUES = 65536,
};

/* How many ranks lie above the middle, the least of them, and the greatest of the rest. */
struct parted {
    double middle, least, next;
    uint64_t above;
};

static void part(struct parted *parted, double rank, uint64_t count)
{
    if (rank > parted->middle) {
        parted->above += count;
        if (rank < parted->least)
            parted->least = rank;
    } else if (rank > parted->next) {
        parted->next = rank;
    }
}

/* Comparisons with NAN, which stands for no value, are false. */
static void look(const struct rf_ranks *ranks, struct parted *parted)
{
    const struct refocus_depth_map *map = ranks->map;

    for (int v = 0; ranks->count && v < VALUES; v++)
        if (ranks->count[v])
            part(parted, rf_rank_of(map, v), ranks->count[v]);
    for (int y = 0; !ranks->count && y < map->height; y++)
        for (int x = 0; x < map->width; x++)
            part(parted, rf_rank_of(map, rf_value_of(map, rf_row_of(map, y), x)), 1);
}

/* Whether all samples of the square with this upper left corner lie above the middle. */
static bool is_filled(const struct refocus_depth_map *map, int left, int top, double middle)
{
    for (int y = top; y < top + SQUARE; y++)
        for (int x = left; x < left + SQUARE; x++)
            if (!(rf_rank_of(map, rf_value_of(map, rf_row_of(map, y), x)) > middle))
                return false;
    return true;
}

static bool is_thing(const struct refocus_depth_map *map, double middle)
{
    for (int y = 0; y + SQUARE <= map->height; y++)
        for (int x = 0; x + SQUARE <= map->width; x++)
            if (is_filled(map, x, y, middle))
                return true;
    return false;
}

uint64_t rf_find_strays(const struct rf_ranks *ranks, double *near)
{
    const double far = ranks->far;
    double top = *near;
    uint64_t strays = 0;

    for (int i = 0; i < LOOKS; i++) {
        struct parted parted = {top / 2 + far / 2, INFINITY, far, 0};

        look(ranks, &parted);
        if (parted.above == 0 || parted.above * SHARE >= ranks->known ||
            is_thing(ranks->map, parted.middle))
            break;
        if (parted.least / 2 + far / 2 > parted.next) {
            strays = parted.above;
            *near = parted.next;
        }
        top = parted.next;
    }
    return strays;
}
