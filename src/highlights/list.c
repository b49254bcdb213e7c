/* list.c: the lists that highlights are kept in, and where each row of the photo has its own. */
#include "highlights/highlights.h"

#include <string.h>

#include "highlights/in_window.h"
#include "support/places.h"

static int parts_of(int height)
{
    return (height + RF_HIGHLIGHT_ROWS - 1) / RF_HIGHLIGHT_ROWS;
}

/* The room of a part of the photo, if all have the same. */
static uint32_t room_of(int width, bool known)
{
    return (uint32_t)width * RF_HIGHLIGHT_ROWS / (known ? 12 : 76) + 6;
}

void rf_lay_out_highlights(struct rf_highlights *highlights, struct rf_arena *arena, int max_width,
                           int max_height, bool known)
{
    const uint64_t room = (uint64_t)parts_of(max_height) * room_of(max_width, known);

    highlights->part = rf_arena_take(arena, RF_HIGHLIGHT_PARTS, sizeof *highlights->part);
    if (highlights->part)
        memset(highlights->part, 0, RF_HIGHLIGHT_PARTS * sizeof *highlights->part);
    highlights->run = rf_arena_take(arena, room, sizeof *highlights->run);
}

void rf_clear_highlights(struct rf_highlights *highlights, int width, int height, bool known)
{
    const uint32_t room = room_of(width, known);

    memset(highlights->part, 0, RF_HIGHLIGHT_PARTS * sizeof *highlights->part);
    for (int part = 0; part < parts_of(height); part++)
        highlights->part[part] =
            (struct rf_highlight_list){highlights->run + (ptrdiff_t)part * room, 0, room};
}

bool rf_share_room(struct rf_highlights *highlights, int width, int height)
{
    const uint32_t room = (uint32_t)parts_of(height) * room_of(width, false);
    uint32_t taken = 0;
    bool fits = true;

    for (int part = 0; part < parts_of(height); part++) {
        struct rf_highlight_list *const list = &highlights->part[part];

        fits = fits && list->capacity <= room - taken;
        list->run = highlights->run + taken;
        list->capacity = list->capacity < room - taken ? list->capacity : room - taken;
        taken += list->capacity;
    }
    return fits;
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
