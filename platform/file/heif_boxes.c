/* heif_boxes.c: a HEIF container is taken apart into boxes. ISO/IEC 14496-12; ISO/IEC 23008-12. */
#include "heif_boxes.h"

#include <string.h>

void rf_heif_skip(struct rf_bytes *bytes, size_t size)
{
    bytes->data += size;
    bytes->size -= size;
}

bool rf_heif_next(struct rf_bytes *rest, struct rf_heif_box *box)
{
    uint64_t size, head = 8;

    if (rest->size < 8)
        return false;
    size = rf_big_endian(rest->data, 4);
    memcpy(box->type, rest->data + 4, 4);
    box->type[4] = '\0';
    if (size == 0) {
        size = rest->size;
    } else if (size == 1) {
        if (rest->size < 16)
            return false;
        size = (uint64_t)rf_big_endian(rest->data + 8, 4) << 32 | rf_big_endian(rest->data + 12, 4);
        head = 16;
    }
    if (size < head || size > rest->size)
        return false;
    box->content.data = rest->data + head;
    box->content.size = (size_t)(size - head);
    rf_heif_skip(rest, (size_t)size);
    return true;
}

bool rf_heif_find(struct rf_bytes rest, const char *type, struct rf_bytes *content)
{
    struct rf_heif_box box;

    while (rf_heif_next(&rest, &box)) {
        if (strcmp(box.type, type) == 0) {
            *content = box.content;
            return true;
        }
    }
    return false;
}

bool rf_heif_meta(struct rf_bytes file, struct rf_bytes *boxes)
{
    if (!rf_heif_find(file, "meta", boxes) || boxes->size < 4)
        return false;
    rf_heif_skip(boxes, 4);
    return true;
}

bool rf_heif_primary(struct rf_bytes meta, struct rf_bytes *number)
{
    size_t size;

    if (!rf_heif_find(meta, "pitm", number) || number->size < 6)
        return false;
    size = number->data[0] > 0 ? 4 : 2;
    rf_heif_skip(number, 4);
    if (number->size < size)
        return false;
    number->size = size;
    return true;
}

bool rf_heif_stereo_pair(struct rf_bytes file, uint32_t pair[2])
{
    enum { COUNT_AT = 8, FIRST_AT = 12, SECOND_AT = 16, END = 20 };
    struct rf_bytes meta, groups, group;

    if (!rf_heif_meta(file, &meta) || !rf_heif_find(meta, "grpl", &groups) ||
        !rf_heif_find(groups, "ster", &group) || group.size < END ||
        rf_big_endian(group.data + COUNT_AT, 4) != 2)
        return false;
    pair[0] = rf_big_endian(group.data + FIRST_AT, 4);
    pair[1] = rf_big_endian(group.data + SECOND_AT, 4);
    return true;
}

bool rf_heif_is_sequence(struct rf_bytes file)
{
    struct rf_bytes content;

    return rf_heif_find(file, "moov", &content) && !rf_heif_find(file, "meta", &content);
}
