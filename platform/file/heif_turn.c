/* heif_turn.c: the rotation and mirroring that a HEIF container states for an item are found.
 * libheif applies them but does not tell them. ISO/IEC 23008-12, 6.5.10, 6.5.12 and 9.3. */
#include "heif_turn.h"

#include <string.h>

#include "heif_boxes.h"

/* The steps in the stored picture that lead right and down in the upright one. */
struct turn {
    int right_x, right_y, down_x, down_y;
};

static void apply_property(struct turn *turn, struct rf_bytes properties, uint32_t index)
{
    const struct turn old = *turn;
    struct rf_heif_box box = {.type = ""};

    for (uint32_t i = 0; i < index; i++)
        if (!rf_heif_next(&properties, &box))
            return;
    if (index == 0 || box.content.size < 1)
        return;
    if (strcmp(box.type, "irot") == 0) {
        /* Quarter turns anticlockwise: the step right was the step down before. */
        for (int i = box.content.data[0] & 3; i > 0; i--) {
            const struct turn before = *turn;
            *turn = (struct turn){before.down_x, before.down_y, -before.right_x, -before.right_y};
        }
    } else if (strcmp(box.type, "imir") == 0) {
        if (box.content.data[0] & 1) /* left and right are exchanged */
            *turn = (struct turn){-old.right_x, -old.right_y, old.down_x, old.down_y};
        else /* top and bottom */
            *turn = (struct turn){old.right_x, old.right_y, -old.down_x, -old.down_y};
    }
}

/* Item property associations say which properties, counted from 1, each item has. Returns whether
 * this item is among them: an item is once at most, and no box is looked at behind it. */
static bool apply_associations(struct turn *turn, struct rf_bytes ipma, struct rf_bytes properties,
                               uint32_t item)
{
    size_t id_bytes, index_bytes;
    uint32_t entries;

    if (ipma.size < 8)
        return false;
    id_bytes = ipma.data[0] < 1 ? 2 : 4;
    index_bytes = ipma.data[3] & 1 ? 2 : 1;
    entries = rf_big_endian(ipma.data + 4, 4);
    rf_heif_skip(&ipma, 8);
    for (; entries > 0 && ipma.size >= id_bytes + 1; entries--) {
        const bool wanted = rf_big_endian(ipma.data, id_bytes) == item;
        uint32_t count = ipma.data[id_bytes];

        rf_heif_skip(&ipma, id_bytes + 1);
        for (; count > 0 && ipma.size >= index_bytes; count--) {
            if (wanted) {
                apply_property(turn, properties,
                               rf_big_endian(ipma.data, index_bytes) &
                                   (index_bytes == 2 ? 0x7fff : 0x7f));
            }
            rf_heif_skip(&ipma, index_bytes);
        }
        if (wanted)
            return true;
    }
    return false;
}

static int orientation_of(struct turn turn)
{
    static const struct turn turns[9] = {
        {0, 0, 0, 0}, {1, 0, 0, 1},  {-1, 0, 0, 1},  {-1, 0, 0, -1}, {1, 0, 0, -1},
        {0, 1, 1, 0}, {0, -1, 1, 0}, {0, -1, -1, 0}, {0, 1, -1, 0},
    };

    for (int orientation = 1; orientation <= 8; orientation++)
        if (memcmp(&turns[orientation], &turn, sizeof turn) == 0)
            return orientation;
    return 1;
}

int rf_heif_orientation(struct rf_bytes file, uint32_t item)
{
    struct rf_bytes meta, primary, iprp, properties;
    struct turn turn = {1, 0, 0, 1};
    struct rf_heif_box box;

    if (!rf_heif_meta(file, &meta))
        return 1;
    if (item == 0) {
        if (!rf_heif_primary(meta, &primary))
            return 1;
        item = rf_big_endian(primary.data, primary.size);
    }
    if (!rf_heif_find(meta, "iprp", &iprp) || !rf_heif_find(iprp, "ipco", &properties))
        return 1;
    while (rf_heif_next(&iprp, &box))
        if (strcmp(box.type, "ipma") == 0 &&
            apply_associations(&turn, box.content, properties, item))
            break;
    return orientation_of(turn);
}
