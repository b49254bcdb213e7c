/* cut.h: the least cut of a grid of pixels between an object and its background. */
#ifndef RF_STROKES_CUT_H
#define RF_STROKES_CUT_H

#include <stdint.h>

/*
 * A graph of nodes with up to eight neighbours each, for the algorithm of Boykov and
 * Kolmogorov (2004). Slot d of a node leads to its neighbour in direction d, and slot 7
 * - d of that one back:
 *
 *     0 1 2
 *     3 . 4
 *     5 6 7
 *
 * Capacities are whole numbers; the cut with the smallest object among the least ones
 * is unique, so the result depends on nothing but the graph.
 */
enum { RF_CUT_NEIGHBOURS = 8 };

struct rf_cut_node {
    int32_t neighbour[RF_CUT_NEIGHBOURS]; /* index, or -1 */
    int32_t capacity[RF_CUT_NEIGHBOURS];  /* >= 0; in the end what is left of it */
    int32_t terminal;                     /* > 0: for the object, < 0: against it */
    int32_t parent;                       /* direction, or one of cut.c */
    int32_t tree;
    int32_t stamp, distance; /* when its way to a terminal was last walked, steps */
    int32_t next_active, next_orphan;
    uint32_t place; /* the caller's: y << 16 | x */
};

struct rf_cut {
    struct rf_cut_node *nodes;
    int32_t count, room;

    int32_t active_first, active_last;
    int32_t orphan_first, orphan_last;
    int32_t stamp;
};

/* Room for that many nodes; what is there is lost. REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_cut_reserve(struct rf_cut *cut, int64_t nodes);
void rf_cut_free(struct rf_cut *cut);

/* The caller has set neighbour, capacity and terminal of nodes 0 to count - 1. */
void rf_cut_solve(struct rf_cut *cut);

/* Instead, where the guesses of rf_cut_guess() are good: let each node in turn take the
 * side that costs it less, until none changes. A cut that no single node makes better,
 * in a tenth of the time. */
void rf_cut_guess(struct rf_cut *cut, int32_t node, int inside);
void rf_cut_settle(struct rf_cut *cut);

/* Whether a node belongs to the object. */
int rf_cut_inside(const struct rf_cut *cut, int32_t node);

#endif
