/* both_ways.c: two walks over the rows of a map, down and up, at the same time. */
#include "focus_stack/focus_stack.h"

struct walks {
    rf_stack_part_fn *part;
    void *context;
    int rows, middle;
    bool second; /* the half that the other walk has been in */
};

static void walk(void *context, int item, int worker)
{
    const struct walks *w = context;
    const int own = item ? w->rows - w->middle : w->middle; /* rows of the half where it enters */

    (void)worker;
    w->part(w->context, (struct rf_stack_part){.way = item ? -1 : 1,
                                               .begin = w->second ? own : 0,
                                               .end = w->second ? w->rows : own,
                                               .second = w->second});
}

void rf_stack_both_ways(struct rf_pool *pool, rf_stack_part_fn *part, void *context, int rows)
{
    struct walks walks = {.part = part, .context = context, .rows = rows, .middle = rows / 2};

    rf_pool_run(pool, walk, &walks, 2);
    walks.second = true;
    rf_pool_run(pool, walk, &walks, 2);
}
