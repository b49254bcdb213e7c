/* heif_targets.c: metadata and auxiliary images of a HEIF container belong to one picture each.
 *
 * iPhones write since iOS 18 that EXIF and XMP describe the main picture and the one that is toned
 * with its gain map, and since iOS 26 that depth is auxiliary to both. libheif 1.15, that of Debian
 * 12, refuses a file where there is more than one. So one is left, the main picture if it is among
 * them, and the bytes that become free lie behind the number of the main picture, where nothing is
 * read: all else stays in its place in the file.
 *
 *     meta { ... pitm ... iref { cdsc: 67 -> 46, 66; auxl: 65 -> 46, 66 } }
 *     meta { ... pitm 00 00 00 00 ... iref { cdsc: 67 -> 46; auxl: 65 -> 46 } }
 *
 * ISO/IEC 14496-12, 8.11.12; ISO/IEC 23008-12, 6.4.4 and 6.5.
 */
#include "heif_targets.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A box from `begin` to `end` in the file; its content begins at `content`. */
struct span {
    size_t begin, content, end;
};

/* The box at `at`, whose size is said in 32 bits, before `end`. */
static bool box_at(const uint8_t *data, size_t at, size_t end, struct span *box)
{
    uint32_t size;

    if (at > end || end - at < 8)
        return false;
    size = rf_big_endian(data + at, 4);
    *box = (struct span){at, at + 8, at + size};
    return size >= 8 && size <= end - at;
}

/* The first box of a type from `at` on. */
static bool find(const uint8_t *data, size_t at, size_t end, const char *type, struct span *box)
{
    for (; box_at(data, at, end, box); at = box->end)
        if (memcmp(data + box->begin + 4, type, 4) == 0)
            return true;
    return false;
}

/* Boxes that are changed, and how many bytes a number of an item has. */
struct boxes {
    struct span primary, references;
    size_t id_bytes;
};

static bool find_boxes(const uint8_t *data, size_t size, struct boxes *boxes)
{
    struct span meta;

    if (!find(data, 0, size, "meta", &meta) || meta.end - meta.content < 4 ||
        !find(data, meta.content + 4, meta.end, "pitm", &boxes->primary) ||
        !find(data, boxes->primary.end, meta.end, "iref", &boxes->references) ||
        boxes->primary.end - boxes->primary.content < 8 - 2 * !data[boxes->primary.content] ||
        boxes->references.end - boxes->references.content < 4)
        return false;
    boxes->id_bytes = data[boxes->references.content] ? 4 : 2;
    return true;
}

/* Whether libheif takes one target alone for references of the box at `at`. */
static bool is_single(const uint8_t *data, size_t at)
{
    return memcmp(data + at + 4, "cdsc", 4) == 0 || memcmp(data + at + 4, "auxl", 4) == 0;
}

/* Copies references to `out`, and leaves such ones one target. Returns how many bytes they
 * have there; 0: they are damaged. */
static size_t copy_references(const uint8_t *data, const struct boxes *boxes, uint8_t *out)
{
    const size_t id = boxes->id_bytes, end = boxes->references.end;
    const uint8_t *const pitm = data + boxes->primary.content;
    const uint32_t primary = rf_big_endian(pitm + 4, pitm[0] ? 4 : 2);
    size_t at = boxes->references.content + 4, length = 0;
    struct span box;

    for (; box_at(data, at, end, &box); at = box.end) {
        const size_t head = 8 + id + 2;
        uint32_t count, target;

        if (box.end - box.begin < head)
            return 0;
        count = rf_big_endian(data + box.begin + 8 + id, 2);
        if (!is_single(data, box.begin) || count < 2) {
            memcpy(out + length, data + box.begin, box.end - box.begin);
            length += box.end - box.begin;
            continue;
        }
        if (box.end - box.begin != head + count * id)
            return 0;
        target = rf_big_endian(data + box.begin + head, id);
        for (uint32_t i = 1; i < count; i++) {
            target =
                rf_big_endian(data + box.begin + head + i * id, id) == primary ? primary : target;
        }
        memcpy(out + length, data + box.begin, head);
        rf_put_big_endian(out + length, 4, (uint32_t)(head + id));
        rf_put_big_endian(out + length + 8 + id, 2, 1);
        rf_put_big_endian(out + length + head, id, target);
        length += head + id;
    }
    return at == end ? length : 0;
}

/* Puts the free bytes behind `pitm`, and `iref` with its new references behind what lies between
 * the two. */
static void lay_out(const uint8_t *data, const struct boxes *boxes, const uint8_t *references,
                    size_t length, uint8_t *out)
{
    const struct span *const iref = &boxes->references, *const pitm = &boxes->primary;
    const size_t spare = iref->end - iref->content - 4 - length;
    uint8_t *const to = out + iref->begin + spare;

    memcpy(out + pitm->end + spare, data + pitm->end, iref->begin - pitm->end);
    memset(out + pitm->end, 0, spare);
    rf_put_big_endian(out + pitm->begin, 4, (uint32_t)(pitm->end - pitm->begin + spare));
    memcpy(to, data + iref->begin, 12);
    rf_put_big_endian(to, 4, (uint32_t)(12 + length));
    memcpy(to + 12, references, length);
}

int rf_heif_single_targets(struct rf_bytes file, uint8_t **changed)
{
    struct boxes boxes;
    uint8_t *references;
    size_t length;

    *changed = NULL;
    if (!find_boxes(file.data, file.size, &boxes))
        return REFOCUS_OK;
    references = malloc(boxes.references.end - boxes.references.begin);
    if (!references)
        return REFOCUS_ERR_MEMORY;
    length = copy_references(file.data, &boxes, references);
    if (length == 0 || length == boxes.references.end - boxes.references.content - 4) {
        free(references);
        return REFOCUS_OK;
    }
    *changed = malloc(file.size);
    if (*changed) {
        memcpy(*changed, file.data, file.size);
        lay_out(file.data, &boxes, references, length, *changed);
    }
    free(references);
    return *changed ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
}
