/* list.c: the lists that highlights are kept in. */
#include "highlights/highlights.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "support/places.h"

void rf_forget_highlights(struct refocus_renderer *r)
{
    for (int part = 0; part < RF_LAMP_PARTS; part++)
        r->photo.highlights[part].count = 0;
}

void rf_list_highlight(struct rf_highlights *found, struct rf_highlight lamp)
{
    rf_add_place(found->lamp, &found->count, found->capacity, &lamp, sizeof lamp);
}

void rf_sort_highlights(struct refocus_renderer *r)
{
    for (int part = 0; part < RF_LAMP_PARTS && !rf_cancelled(&r->exec); part++) {
        struct rf_highlights *found = &r->photo.highlights[part];

        rf_sort_places(found->lamp, found->count, sizeof *found->lamp);
    }
}
