/* make_trailer.c: makes JPEGs with the trailers of Samsung and Huawei. */
#include "make.h"

#include <string.h>

/* A map of 6 x 4 whose samples count up. */
static struct bytes map_of(void)
{
    struct bytes map = {NULL, 0};

    for (int i = 0; i < 24; i++)
        bytes_number(&map, (uint64_t)(10 * i), 1, false);
    return map;
}

static void add_block(struct bytes *blocks, struct bytes *entries, int type, const char *name,
                      struct bytes data)
{
    const size_t size = 8 + strlen(name) + data.size;

    bytes_number(entries, 0, 2, false);
    bytes_number(entries, (uint64_t)type, 2, false);
    bytes_number(entries, blocks->size, 4, false); /* for now from the first block on */
    bytes_number(entries, size, 4, false);
    bytes_number(blocks, 0, 2, false);
    bytes_number(blocks, (uint64_t)type, 2, false);
    bytes_number(blocks, strlen(name), 4, false);
    bytes_text(blocks, name);
    bytes_join(blocks, data);
}

static struct bytes extra_of(int mark_at, int width, int height)
{
    struct bytes extra = {NULL, 0};

    while (extra.size < (size_t)mark_at)
        bytes_number(&extra, 0, 4, false);
    bytes_number(&extra, 0xffff0003, 4, false);
    bytes_number(&extra, (uint64_t)width, 4, false);
    bytes_number(&extra, (uint64_t)height, 4, false);
    bytes_number(&extra, 0, 4, false);
    return extra;
}

struct bytes make_samsung(int mark_at, int width, int height, bool original, bool other_block)
{
    struct bytes file = make_jpeg(64, 32, false, false), blocks = {NULL, 0}, entries = {NULL, 0};
    const int count = original ? 3 : 2;
    size_t directory;

    if (original)
        add_block(&blocks, &entries, 1, "DualShot_1", make_jpeg(60, 30, false, false));
    add_block(&blocks, &entries, 0xab1, "DualShot_DepthMap_1", map_of());
    add_block(&blocks, &entries, 0xab3, "DualShot_Extra_Info", extra_of(mark_at, width, height));
    for (int i = 0; i < count; i++) {
        uint8_t *const back = entries.data + 12 * i + 4;
        const size_t at = back[0] | (size_t)back[1] << 8 | (size_t)back[2] << 16;
        const size_t value = blocks.size - at;

        for (int k = 0; k < 4; k++)
            back[k] = (uint8_t)(value >> 8 * k);
    }
    bytes_join(&file, blocks);
    directory = 12 + entries.size;
    bytes_text(&file, "SEFH");
    bytes_number(&file, 106, 4, false);
    bytes_number(&file, (uint64_t)count, 4, false);
    bytes_join(&file, entries);
    bytes_number(&file, directory, 4, false);
    bytes_text(&file, "SEFT");
    if (other_block) {
        bytes_add(&file, "\1\2\3\4", 4);
        bytes_number(&file, 4, 4, false);
        bytes_text(&file, "QDIOBS");
    }
    return file;
}

struct bytes make_huawei(int width, int height, bool original)
{
    struct bytes file = make_jpeg(64, 32, false, false);

    if (original)
        bytes_join(&file, make_jpeg(60, 30, false, false));
    bytes_add(&file, "edof\0\0\0\0\1", 9);
    for (int i = 9; i < 20; i++)
        bytes_number(&file, 0, 1, false);
    bytes_number(&file, (uint64_t)width, 2, false);
    bytes_number(&file, (uint64_t)height, 2, false);
    for (int i = 24; i < 72; i++)
        bytes_number(&file, 0, 1, false);
    bytes_join(&file, map_of());
    return file;
}
