/* list.c: the lists that highlights are kept in, and where each row of the photo has its own. */
#include "highlights/highlights.h"

#include <string.h>

#include "highlights/in_window.h"
#include "support/places.h"

static uint32_t capacity_of(int max_width, bool known)
{
    return (uint32_t)max_width * RF_HIGHLIGHT_ROWS / (known ? 12 : 76) + 6;
}

void rf_lay_out_highlights(struct rf_highlights *highlights, struct rf_arena *arena, int max_width,
                           int max_height, bool known)
{
    const int parts = (max_height + RF_HIGHLIGHT_ROWS - 1) / RF_HIGHLIGHT_ROWS;

    highlights->part = rf_arena_take(arena, RF_HIGHLIGHT_PARTS, sizeof *highlights->part);
    if (highlights->part)
        memset(highlights->part, 0, RF_HIGHLIGHT_PARTS * sizeof *highlights->part);
    for (int part = 0; part < parts; part++) {
        const uint32_t capacity = capacity_of(max_width, known);
        struct rf_highlight *const run = rf_arena_take(arena, capacity, sizeof *run);

        if (highlights->part)
            highlights->part[part] = (struct rf_highlight_list){.run = run, .capacity = capacity};
    }
}

void rf_clear_highlights(struct rf_highlights *highlights)
{
    for (int part = 0; part < RF_HIGHLIGHT_PARTS; part++)
        highlights->part[part].count = 0;
}

void rf_list_highlight(struct rf_highlights *highlights, const struct rf_highlight *run)
{
    struct rf_highlight_list *list = &highlights->part[run->y / RF_HIGHLIGHT_ROWS];

    rf_add_place(list->run, &list->count, list->capacity, run, sizeof *run);
}

void rf_sort_highlights(const struct rf_executor *exec, struct rf_highlights *highlights)
{
    for (int part = 0; part < RF_HIGHLIGHT_PARTS && !rf_cancelled(exec); part++) {
        struct rf_highlight_list *list = &highlights->part[part];

        rf_sort_places(list->run, list->count, sizeof *list->run);
    }
}

struct rf_highlight_parts rf_parts_in(const struct rf_viewport *view)
{
    const int first = view->y0 / RF_HIGHLIGHT_ROWS;
    const int last = (view->y0 + view->height - 1) / RF_HIGHLIGHT_ROWS;

    return (struct rf_highlight_parts){first, last - first + 1};
}

bool rf_has_highlights(const struct rf_highlights *highlights, const struct rf_viewport *view)
{
    const struct rf_highlight_parts parts = rf_parts_in(view);

    for (int i = 0; i < parts.count; i++)
        if (highlights->part[parts.first + i].count)
            return true;
    return false;
}

struct rf_highlight *rf_first_run(struct rf_highlight *run, const struct rf_highlight *end, int x,
                                  int y)
{
    ptrdiff_t count = end - run;

    while (count > 0) {
        struct rf_highlight *const middle = run + count / 2;
        const bool before = middle->y < y || (middle->y == y && middle->x < x);

        run = before ? middle + 1 : run;
        count = before ? count - count / 2 - 1 : count / 2;
    }
    return run;
}
