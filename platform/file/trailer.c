/* trailer.c: the depth of Samsung's Live Focus and of Huawei's wide aperture is read: 8-bit samples
 * without compression behind the main picture. Neither maker describes it; the layout is that which
 * ExifTool documents (Samsung trailer) and which public converters agree on (Huawei). */
#include "trailer.h"

#include <string.h>

#include "depth_part.h"
#include "jpeg_walk.h"
#include "part.h"
#include "reason.h"

enum { DUAL_MAP = 0x0ab1, DUAL_EXTRA = 0x0ab3, SUB_IMAGE = 0x0001 };

/* A map of bytes, near where it is bright. */
static int take_map(struct rf_read *read, struct rf_bytes map, uint32_t width, uint32_t height,
                    const char *maker)
{
    struct rf_raster raster = {.width = (int32_t)width,
                               .height = (int32_t)height,
                               .channels = 1,
                               .sample = REFOCUS_SAMPLE_U8,
                               .max_value = 255};
    int status = rf_check_size(read, width, height, 1);

    if (status == REFOCUS_OK)
        status = rf_raster_alloc(read, &raster);
    if (status != REFOCUS_OK)
        return status;
    memcpy(raster.pixels, map.data, (size_t)width * height);
    read->samples = raster;
    read->depth.meaning = REFOCUS_DEPTH_DISPARITY;
    read->depth.value_near = 255;
    read->depth.value_far = 0;
    read->info->depth_source = REFOCUS_DEPTH_SOURCE_TRAILER;
    rf_note(read->info, "%s: %u x %u samples of 8 bits in its trailer, bright is near; no metres",
            maker, (unsigned)width, (unsigned)height);
    return REFOCUS_OK;
}

/* Take the picture before it was blurred, when it is one: of about as many pixels as it. */
static int take_original(struct rf_read *read, struct rf_bytes picture,
                         struct rf_bytes main_picture, const char *maker)
{
    return read->picture_always && rf_is_jpeg(picture) &&
                   2 * rf_part_pixels(picture) >= rf_part_pixels(main_picture)
               ? rf_take_original(read, picture, maker)
               : REFOCUS_OK;
}

/* Samsung ------------------------------------------------------------- */

struct samsung {
    struct rf_bytes map, extra, original;
};

/* The directory of blocks: the last bytes of a file are blocks of others and it, each followed by
 * its size and its name. False: there is none. *end is where it ends. */
static bool find_directory(struct rf_bytes file, struct rf_bytes *directory)
{
    size_t end = file.size;

    if (end >= 6 && memcmp(file.data + end - 6, "QDIOBS", 6) == 0)
        end -= 2;
    for (int blocks = 0; blocks < 8 && end >= 8; blocks++) {
        const uint32_t size = rf_little_endian(file.data + end - 8, 4);

        if (size < 4 || size >= 0x10000 || size > end - 8)
            return false;
        *directory = (struct rf_bytes){file.data + end - 8 - size, size};
        if (memcmp(file.data + end - 4, "SEFT", 4) == 0)
            return size >= 12 && memcmp(directory->data, "SEFH", 4) == 0;
        end -= 8 + size;
    }
    return false;
}

static bool is_named(struct rf_bytes name, const char *begin)
{
    return name.size >= strlen(begin) && memcmp(name.data, begin, strlen(begin)) == 0;
}

/* Blocks lie before the directory: two zeros, the type, the length of the name, the name, data. */
static void take_block(struct samsung *found, struct rf_bytes block)
{
    const uint32_t type = rf_little_endian(block.data + 2, 2),
                   length = rf_little_endian(block.data + 4, 4);
    struct rf_bytes name, data;

    if (length > block.size - 8)
        return;
    name = (struct rf_bytes){block.data + 8, length};
    data = (struct rf_bytes){block.data + 8 + length, block.size - 8 - length};
    if (type == DUAL_MAP && is_named(name, "DualShot_DepthMap_") && !found->map.data)
        found->map = data;
    else if (type == DUAL_EXTRA && !found->extra.data)
        found->extra = data;
    else if (type == SUB_IMAGE && length == 10 && is_named(name, "DualShot_1"))
        found->original = data;
}

static void take_blocks(struct samsung *found, struct rf_bytes file, size_t main_end,
                        struct rf_bytes directory)
{
    const size_t at = (size_t)(directory.data - file.data);
    const uint32_t count = rf_little_endian(directory.data + 8, 4);

    for (uint32_t i = 0; i < count && 12 + 12 * ((size_t)i + 1) <= directory.size; i++) {
        const uint8_t *const entry = directory.data + 12 + 12 * (size_t)i;
        const uint32_t back = rf_little_endian(entry + 4, 4), size = rf_little_endian(entry + 8, 4);

        if (back <= at - main_end && size <= back && size >= 8)
            take_block(found, (struct rf_bytes){file.data + at - back, size});
    }
}

/* The sides stand behind a small number and ff ff, whose place differs from phone to phone. */
static bool find_sides(struct rf_bytes extra, uint32_t *width, uint32_t *height)
{
    for (size_t at = 32; at + 12 <= extra.size && at < 96; at += 4) {
        const uint8_t *const p = extra.data + at;

        if (p[0] >= 1 && p[0] <= 9 && p[1] == 0 && p[2] == 0xff && p[3] == 0xff) {
            *width = rf_little_endian(p + 4, 4);
            *height = rf_little_endian(p + 8, 4);
            return true;
        }
    }
    return false;
}

static int read_samsung(struct rf_read *read, struct rf_bytes file, size_t main_end,
                        struct rf_bytes directory)
{
    static const char maker[] = "Samsung";
    struct samsung found = {.map = {NULL, 0}};
    uint32_t width, height;
    int status;

    take_blocks(&found, file, main_end, directory);
    if (!found.map.data)
        return REFOCUS_OK;
    if (!find_sides(found.extra, &width, &height) || width == 0 || height == 0 ||
        (uint64_t)width * height != found.map.size) {
        rf_note(read->info, "Samsung: its depth map does not say its sides, passed over");
        return REFOCUS_OK;
    }
    status = take_map(read, found.map, width, height, maker);
    return status == REFOCUS_OK
               ? take_original(read, found.original, (struct rf_bytes){file.data, main_end}, maker)
               : status;
}

/* Huawei -------------------------------------------------------------- */

/* The last header whose map is whole: "edof", four zeros, 1; sides at 20 and 22; samples at 72. */
static int read_huawei(struct rf_read *read, struct rf_bytes file, size_t main_end)
{
    enum { SIDES_AT = 20, MAP_AT = 72 };
    static const char maker[] = "Huawei", mark[] = "edof\0\0\0\0\1";

    for (size_t at = file.size; at-- > main_end;) {
        const struct rf_bytes rest = {file.data + at, file.size - at};
        uint32_t width, height;
        int status;

        if (rest.data[0] != 'e' || rest.size < MAP_AT ||
            memcmp(rest.data, mark, sizeof mark - 1) != 0)
            continue;
        width = rf_little_endian(rest.data + SIDES_AT, 2);
        height = rf_little_endian(rest.data + SIDES_AT + 2, 2);
        if (width == 0 || height == 0 || (uint64_t)width * height > rest.size - MAP_AT) {
            rf_note(read->info, "Huawei: its depth map is not whole, passed over");
            continue;
        }
        status = take_map(read, (struct rf_bytes){rest.data + MAP_AT, rest.size - MAP_AT}, width,
                          height, maker);
        return status == REFOCUS_OK
                   ? take_original(read, (struct rf_bytes){file.data + main_end, at - main_end},
                                   (struct rf_bytes){file.data, main_end}, maker)
                   : status;
    }
    return REFOCUS_OK;
}

int rf_read_trailer(struct rf_read *read, struct rf_bytes file, size_t main_end)
{
    const struct rf_bytes behind = {file.data + main_end, file.size - main_end};
    struct rf_bytes directory;

    if (read->samples.pixels)
        return REFOCUS_OK;
    return find_directory(behind, &directory) ? read_samsung(read, file, main_end, directory)
                                              : read_huawei(read, file, main_end);
}
