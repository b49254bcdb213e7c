/* cut.c: the least cut of a grid of pixels between object and background. */
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <refocus/status.h>
#include "cut.h"

enum { FREE, OBJECT, OUTSIDE };
enum { TERMINAL = 8, ORPHAN = 9, NONE = 10 };
enum { NOBODY = -1, NOT_QUEUED = -2 };

int rf_cut_reserve(struct rf_cut *cut, int64_t nodes)
{
    struct rf_cut_node *more;

    if (nodes <= cut->room)
        return REFOCUS_OK;
    nodes += nodes / 4;
    if (nodes > INT32_MAX || (uint64_t)nodes > SIZE_MAX / sizeof *more)
        return REFOCUS_ERR_MEMORY;
    more = malloc((size_t)nodes * sizeof *more);
    if (!more)
        return REFOCUS_ERR_MEMORY;
    free(cut->nodes);
    cut->nodes = more;
    cut->room = (int32_t)nodes;
    return REFOCUS_OK;
}

void rf_cut_free(struct rf_cut *cut)
{
    free(cut->nodes);
    cut->nodes = NULL;
    cut->room = cut->count = 0;
}

int rf_cut_inside(const struct rf_cut *cut, int32_t node)
{
    return cut->nodes[node].tree == OBJECT;
}

static void push_active(struct rf_cut *cut, int32_t node)
{
    if (cut->nodes[node].next_active != NOT_QUEUED)
        return;
    cut->nodes[node].next_active = NOBODY;
    if (cut->active_last == NOBODY)
        cut->active_first = node;
    else
        cut->nodes[cut->active_last].next_active = node;
    cut->active_last = node;
}

static int32_t pop_active(struct rf_cut *cut)
{
    const int32_t node = cut->active_first;

    if (node == NOBODY)
        return NOBODY;
    cut->active_first = cut->nodes[node].next_active;
    if (cut->active_first == NOBODY)
        cut->active_last = NOBODY;
    cut->nodes[node].next_active = NOT_QUEUED;
    return node;
}

static void push_orphan(struct rf_cut *cut, int32_t node, bool first)
{
    struct rf_cut_node *const p = &cut->nodes[node];

    p->parent = ORPHAN;
    p->next_orphan = NOBODY;
    if (cut->orphan_last == NOBODY) {
        cut->orphan_first = cut->orphan_last = node;
    } else if (first) {
        p->next_orphan = cut->orphan_first;
        cut->orphan_first = node;
    } else {
        cut->nodes[cut->orphan_last].next_orphan = node;
        cut->orphan_last = node;
    }
}

static int32_t pop_orphan(struct rf_cut *cut)
{
    const int32_t node = cut->orphan_first;

    if (node == NOBODY)
        return NOBODY;
    cut->orphan_first = cut->nodes[node].next_orphan;
    if (cut->orphan_first == NOBODY)
        cut->orphan_last = NOBODY;
    return node;
}

static void start(struct rf_cut *cut)
{
    cut->active_first = cut->active_last = NOBODY;
    cut->orphan_first = cut->orphan_last = NOBODY;
    cut->stamp = 0;
    for (int32_t i = 0; i < cut->count; i++) {
        struct rf_cut_node *const p = &cut->nodes[i];

        p->next_active = NOT_QUEUED;
        p->stamp = 0;
        p->distance = 1;
        p->tree = p->terminal > 0 ? OBJECT : p->terminal < 0 ? OUTSIDE : FREE;
        p->parent = p->tree == FREE ? NONE : TERMINAL;
        if (p->tree != FREE)
            push_active(cut, i);
    }
}

/* The amount that may still flow between a node of a tree and its neighbour, away from the object.
 */
static int32_t outward(const struct rf_cut *cut, const struct rf_cut_node *p, int d)
{
    return p->tree == OBJECT ? p->capacity[d] : cut->nodes[p->neighbour[d]].capacity[7 - d];
}

/* Let the tree grow from a node; the direction in which it meets the other tree, or -1.
 */
static int grow(struct rf_cut *cut, int32_t node)
{
    struct rf_cut_node *const p = &cut->nodes[node];

    for (int d = 0; d < RF_CUT_NEIGHBOURS; d++) {
        const int32_t other = p->neighbour[d];
        struct rf_cut_node *q;

        if (other < 0 || outward(cut, p, d) == 0)
            continue;
        q = &cut->nodes[other];
        if (q->tree == FREE) {
            q->tree = p->tree;
            q->parent = 7 - d;
            q->stamp = p->stamp;
            q->distance = p->distance + 1;
            push_active(cut, other);
        } else if (q->tree != p->tree) {
            return d;
        } else if (q->stamp <= p->stamp && q->distance > p->distance) {
            q->parent = 7 - d;
            q->stamp = p->stamp;
            q->distance = p->distance + 1;
        }
    }
    return -1;
}

/* The least that is left on the way from a node to its terminal. */
static int32_t least_upward(const struct rf_cut *cut, int32_t node, int32_t least)
{
    const struct rf_cut_node *p = &cut->nodes[node];
    const bool object = p->tree == OBJECT;
    int32_t rest;

    for (; p->parent != TERMINAL; p = &cut->nodes[p->neighbour[p->parent]]) {
        rest = object ? cut->nodes[p->neighbour[p->parent]].capacity[7 - p->parent]
                      : p->capacity[p->parent];
        if (rest < least)
            least = rest;
    }
    rest = abs(p->terminal);
    return rest < least ? rest : least;
}

static void push_upward(struct rf_cut *cut, int32_t node, int32_t flow)
{
    struct rf_cut_node *p = &cut->nodes[node];
    const bool object = p->tree == OBJECT;

    while (p->parent != TERMINAL) {
        const int d = p->parent;
        const int32_t above = p->neighbour[d];
        struct rf_cut_node *const q = &cut->nodes[above];
        int32_t *const with = object ? &q->capacity[7 - d] : &p->capacity[d];
        int32_t *const against = object ? &p->capacity[d] : &q->capacity[7 - d];

        *with -= flow;
        *against += flow;
        if (*with == 0)
            push_orphan(cut, node, true);
        node = above;
        p = q;
    }
    p->terminal += object ? -flow : flow;
    if (p->terminal == 0)
        push_orphan(cut, node, true);
}

static void augment(struct rf_cut *cut, int32_t node, int direction)
{
    struct rf_cut_node *p = &cut->nodes[node], *q;
    int32_t other = p->neighbour[direction], flow;

    if (p->tree == OUTSIDE) {
        const int32_t swap = node;

        node = other;
        other = swap;
        direction = 7 - direction;
        p = &cut->nodes[node];
    }
    q = &cut->nodes[other];
    flow = least_upward(cut, node, p->capacity[direction]);
    flow = least_upward(cut, other, flow);
    p->capacity[direction] -= flow;
    q->capacity[7 - direction] += flow;
    push_upward(cut, node, flow);
    push_upward(cut, other, flow);
}

/* Steps from a node to its terminal, INT32_MAX when an orphan is among them. */
static int32_t walk(const struct rf_cut *cut, const struct rf_cut_node *p)
{
    int32_t steps = 0;

    for (;;) {
        if (p->stamp == cut->stamp)
            return steps + p->distance;
        steps++;
        if (p->parent == TERMINAL)
            return steps;
        if (p->parent >= ORPHAN)
            return INT32_MAX;
        p = &cut->nodes[p->neighbour[p->parent]];
    }
}

static void mark(struct rf_cut *cut, struct rf_cut_node *p, int32_t distance)
{
    for (; p->stamp != cut->stamp; p = &cut->nodes[p->neighbour[p->parent]]) {
        p->stamp = cut->stamp;
        p->distance = distance--;
        if (p->parent == TERMINAL)
            return;
    }
}

/* Whether something may flow from a node's neighbour (of its own tree) down to the
 * node. */
static bool feeds(const struct rf_cut *cut, const struct rf_cut_node *p, int d)
{
    const struct rf_cut_node *const q = &cut->nodes[p->neighbour[d]];

    return q->tree == p->tree && (p->tree == OBJECT ? q->capacity[7 - d] : p->capacity[d]) > 0;
}

static void adopt(struct rf_cut *cut, int32_t node)
{
    struct rf_cut_node *const p = &cut->nodes[node];
    int32_t nearest = INT32_MAX;
    int best = NONE;

    for (int d = 0; d < RF_CUT_NEIGHBOURS; d++) {
        struct rf_cut_node *q;
        int32_t distance;

        if (p->neighbour[d] < 0 || !feeds(cut, p, d))
            continue;
        q = &cut->nodes[p->neighbour[d]];
        if (q->parent == NONE)
            continue;
        distance = walk(cut, q);
        if (distance == INT32_MAX)
            continue;
        if (distance < nearest) {
            best = d;
            nearest = distance;
        }
        mark(cut, q, distance);
    }
    p->parent = best;
    if (best != NONE) {
        p->stamp = cut->stamp;
        p->distance = nearest + 1;
        return;
    }
    for (int d = 0; d < RF_CUT_NEIGHBOURS; d++) {
        const int32_t other = p->neighbour[d];
        struct rf_cut_node *q;

        if (other < 0 || cut->nodes[other].tree != p->tree)
            continue;
        q = &cut->nodes[other];
        if (feeds(cut, p, d))
            push_active(cut, other);
        if (q->parent < TERMINAL && q->neighbour[q->parent] == node)
            push_orphan(cut, other, false);
    }
    p->tree = FREE;
}

void rf_cut_solve(struct rf_cut *cut)
{
    int32_t node = NOBODY;

    start(cut);
    for (;;) {
        int direction;

        if (node == NOBODY || cut->nodes[node].tree == FREE) {
            node = pop_active(cut);
            if (node == NOBODY)
                return;
            if (cut->nodes[node].tree == FREE)
                continue;
        }
        direction = grow(cut, node);
        cut->stamp++;
        if (direction < 0) {
            node = NOBODY;
            continue;
        }
        augment(cut, node, direction);
        for (int32_t orphan = pop_orphan(cut); orphan != NOBODY; orphan = pop_orphan(cut))
            adopt(cut, orphan);
    }
}

void rf_cut_settle(struct rf_cut *cut)
{
    enum { ROUNDS = 12 };
    bool changed = true;

    for (int round = 0; round < ROUNDS && changed; round++) {
        changed = false;
        for (int32_t i = 0; i < cut->count; i++) {
            struct rf_cut_node *const p = &cut->nodes[i];
            int32_t sum = p->terminal, tree;

            for (int d = 0; d < RF_CUT_NEIGHBOURS; d++)
                if (p->neighbour[d] >= 0)
                    sum += cut->nodes[p->neighbour[d]].tree == OBJECT ? p->capacity[d]
                                                                      : -p->capacity[d];
            tree = sum > 0 ? OBJECT : FREE;
            changed |= tree != p->tree;
            p->tree = tree;
        }
    }
}

void rf_cut_guess(struct rf_cut *cut, int32_t node, int inside)
{
    cut->nodes[node].tree = inside ? OBJECT : FREE;
}
