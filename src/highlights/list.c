/* list.c: the lists that highlights are kept in. */
#include <string.h>

#include "highlights/highlights.h"
#include "renderer/bands.h"
#include "renderer/renderer.h"

/* Whether a comes after b, row by row. */
static bool is_after(const struct rf_highlight *a, const struct rf_highlight *b)
{
    return a->y > b->y || (a->y == b->y && a->x > b->x);
}

/* What is at i of a heap of n, whose last comes first, sinks to where it belongs. */
static void sink(struct rf_highlight *lamp, uint32_t i, uint32_t n)
{
    const struct rf_highlight own = lamp[i];

    for (uint32_t child; (child = 2 * i + 1) < n; i = child) {
        child += child + 1 < n && is_after(&lamp[child + 1], &lamp[child]);
        if (!is_after(&lamp[child], &own))
            break;
        lamp[i] = lamp[child];
    }
    lamp[i] = own;
}

static void make_heap(struct rf_highlight *lamp, uint32_t n)
{
    for (uint32_t i = n / 2; i-- > 0;)
        sink(lamp, i, n);
}

void rf_forget_highlights(struct refocus_renderer *r)
{
    for (int part = 0; part < RF_LAMP_PARTS; part++)
        r->photo[r->used].highlights[part].count = 0;
}

void rf_list_highlight(struct rf_highlights *found, struct rf_highlight lamp)
{
    if (found->count < found->capacity) {
        found->lamp[found->count++] = lamp;
        if (found->count == found->capacity)
            make_heap(found->lamp, found->count);
    } else if (found->count && is_after(&found->lamp[0], &lamp)) {
        found->lamp[0] = lamp;
        sink(found->lamp, 0, found->count);
    }
}

void rf_sort_highlights(struct refocus_renderer *r)
{
    for (int part = 0; part < RF_LAMP_PARTS && !rf_cancelled(r); part++) {
        struct rf_highlight *lamp = r->photo[r->used].highlights[part].lamp;
        const uint32_t n = r->photo[r->used].highlights[part].count;

        make_heap(lamp, n);
        for (uint32_t left = n; left > 1;) {
            const struct rf_highlight last = lamp[0];

            lamp[0] = lamp[--left];
            lamp[left] = last;
            sink(lamp, 0, left);
        }
    }
}
