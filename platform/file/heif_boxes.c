/* heif_boxes.c: the rotation and mirroring that a HEIF container states for an item are found.
 * libheif applies them but does not tell them. ISO/IEC 23008-12, 6.5.10, 6.5.12 and 9.3; ISO/IEC
 * 14496-12. */
#include "heif_boxes.h"

#include <string.h>

struct box {
    char type[5];
    struct rf_bytes content;
};

static uint32_t get(struct rf_bytes bytes, size_t at, size_t size)
{
    uint32_t value = 0;

    for (size_t i = 0; i < size; i++) {
        value = value << 8 | bytes.data[at + i];
    }
    return value;
}

static void skip(struct rf_bytes *bytes, size_t size)
{
    bytes->data += size;
    bytes->size -= size;
}

/* Take the next box off the front; false at the end and where no box begins. */
static bool next_box(struct rf_bytes *rest, struct box *box)
{
    uint64_t size, head = 8;

    if (rest->size < 8) {
        return false;
    }
    size = get(*rest, 0, 4);
    memcpy(box->type, rest->data + 4, 4);
    box->type[4] = '\0';
    if (size == 0) {
        size = rest->size;
    } else if (size == 1) {
        if (rest->size < 16) {
            return false;
        }
        size = (uint64_t)get(*rest, 8, 4) << 32 | get(*rest, 12, 4);
        head = 16;
    }
    if (size < head || size > rest->size) {
        return false;
    }
    box->content.data = rest->data + head;
    box->content.size = (size_t)(size - head);
    skip(rest, (size_t)size);
    return true;
}

static bool find_box(struct rf_bytes rest, const char *type, struct rf_bytes *content)
{
    struct box box;

    while (next_box(&rest, &box)) {
        if (strcmp(box.type, type) == 0) {
            *content = box.content;
            return true;
        }
    }
    return false;
}

/* The steps in the stored picture that lead right and down in the upright one. */
struct turn {
    int right_x, right_y, down_x, down_y;
};

static void apply_property(struct turn *turn, struct rf_bytes properties, uint32_t index)
{
    const struct turn old = *turn;
    struct box box = {.type = ""};

    for (uint32_t i = 0; i < index; i++) {
        if (!next_box(&properties, &box)) {
            return;
        }
    }
    if (index == 0 || box.content.size < 1) {
        return;
    }
    if (strcmp(box.type, "irot") == 0) {
        /* Quarter turns anticlockwise: the step right was the step down before. */
        for (int i = box.content.data[0] & 3; i > 0; i--) {
            const struct turn before = *turn;
            *turn = (struct turn){before.down_x, before.down_y, -before.right_x, -before.right_y};
        }
    } else if (strcmp(box.type, "imir") == 0) {
        if (box.content.data[0] & 1) { /* left and right are exchanged */
            *turn = (struct turn){-old.right_x, -old.right_y, old.down_x, old.down_y};
        } else { /* top and bottom */
            *turn = (struct turn){old.right_x, old.right_y, -old.down_x, -old.down_y};
        }
    }
}

/* Item property associations say which properties, counted from 1, each item has. Returns whether
 * this item is among them: an item is once at most, and no box is looked at behind it. */
static bool apply_associations(struct turn *turn, struct rf_bytes ipma, struct rf_bytes properties,
                               uint32_t item)
{
    size_t id_bytes, index_bytes;
    uint32_t entries;

    if (ipma.size < 8) {
        return false;
    }
    id_bytes = ipma.data[0] < 1 ? 2 : 4;
    index_bytes = ipma.data[3] & 1 ? 2 : 1;
    entries = get(ipma, 4, 4);
    skip(&ipma, 8);
    for (; entries > 0 && ipma.size >= id_bytes + 1; entries--) {
        const bool wanted = get(ipma, 0, id_bytes) == item;
        uint32_t count = ipma.data[id_bytes];

        skip(&ipma, id_bytes + 1);
        for (; count > 0 && ipma.size >= index_bytes; count--) {
            if (wanted) {
                apply_property(turn, properties,
                               get(ipma, 0, index_bytes) & (index_bytes == 2 ? 0x7fff : 0x7f));
            }
            skip(&ipma, index_bytes);
        }
        if (wanted) {
            return true;
        }
    }
    return false;
}

static int orientation_of(struct turn turn)
{
    static const struct turn turns[9] = {
        {0, 0, 0, 0}, {1, 0, 0, 1},  {-1, 0, 0, 1},  {-1, 0, 0, -1}, {1, 0, 0, -1},
        {0, 1, 1, 0}, {0, -1, 1, 0}, {0, -1, -1, 0}, {0, 1, -1, 0},
    };

    for (int orientation = 1; orientation <= 8; orientation++) {
        if (memcmp(&turns[orientation], &turn, sizeof turn) == 0) {
            return orientation;
        }
    }
    return 1;
}

int rf_heif_orientation(struct rf_bytes file, uint32_t item)
{
    struct rf_bytes meta, primary, iprp, properties;
    struct turn turn = {1, 0, 0, 1};
    struct box box;

    if (!find_box(file, "meta", &meta) || meta.size < 4) {
        return 1;
    }
    skip(&meta, 4);
    if (item == 0) {
        if (!find_box(meta, "pitm", &primary) || primary.size < 6 ||
            (primary.data[0] > 0 && primary.size < 8)) {
            return 1;
        }
        item = get(primary, 4, primary.data[0] > 0 ? 4 : 2);
    }
    if (!find_box(meta, "iprp", &iprp) || !find_box(iprp, "ipco", &properties)) {
        return 1;
    }
    while (next_box(&iprp, &box)) {
        if (strcmp(box.type, "ipma") == 0 &&
            apply_associations(&turn, box.content, properties, item)) {
            break;
        }
    }
    return orientation_of(turn);
}

bool rf_heif_is_stereo(struct rf_bytes file)
{
    struct rf_bytes meta, groups, pair;

    if (!find_box(file, "meta", &meta) || meta.size < 4) {
        return false;
    }
    skip(&meta, 4);
    return find_box(meta, "grpl", &groups) && find_box(groups, "ster", &pair);
}

bool rf_heif_is_sequence(struct rf_bytes file)
{
    struct rf_bytes content;

    return find_box(file, "moov", &content) && !find_box(file, "meta", &content);
}
