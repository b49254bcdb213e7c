/* make_formats.c: small TIFF, OpenEXR and DNG files, put together byte by byte. */
#include "make_formats.h"

#include <string.h>

/* An entry of a directory: SHORT where it fits, else LONG. */
static void entry(struct bytes *file, int tag, int type, uint32_t count, uint32_t value, bool big)
{
    bytes_number(file, (uint64_t)tag, 2, big);
    bytes_number(file, (uint64_t)type, 2, big);
    bytes_number(file, count, 4, big);
    if (type == 3 && count == 1) {
        bytes_number(file, value, 2, big);
        bytes_number(file, 0, 2, big);
    } else {
        bytes_number(file, value, 4, big);
    }
}

static void add_float(struct bytes *file, float value, bool big)
{
    uint32_t bits;

    memcpy(&bits, &value, 4);
    bytes_number(file, bits, 4, big);
}

static void add_sample(struct bytes *file, struct tiff_kind kind, int x, int y, int c)
{
    const uint32_t most = kind.bits == 16 ? 65535 : 255;

    if (kind.alpha && c == kind.channels - 1)
        bytes_number(file, x == 1 && y == 1 ? 0 : most, kind.bits / 8, kind.big_endian);
    else if (kind.floats)
        add_float(file, (float)pattern(x, y, c, 255) / 64, kind.big_endian);
    else
        bytes_number(file, pattern(x, y, c, most), kind.bits / 8, kind.big_endian);
}

struct bytes make_tiff(int width, int height, struct tiff_kind kind)
{
    enum { ENTRIES = 11, DATA = 8 };
    const bool big = kind.big_endian;
    const uint32_t plane = (uint32_t)(width * height * kind.bits / 8);
    const uint32_t bytes = plane * (uint32_t)kind.channels;
    const uint32_t strips = kind.planar ? (uint32_t)kind.channels : 1;
    const uint32_t tables = DATA + bytes;
    const uint32_t directory = tables + (strips > 1 ? 8 * strips : 0);
    struct bytes file = {NULL, 0};

    bytes_add(&file, big ? "MM\0*" : "II*\0", 4);
    bytes_number(&file, directory, 4, big);
    for (int p = 0; p < (int)strips; p++) {
        for (int y = 0; y < height; y++) {
            for (int x = 0; x < width; x++)
                for (int c = 0; c < (kind.planar ? 1 : kind.channels); c++)
                    add_sample(&file, kind, x, y, c + p);
        }
    }
    for (uint32_t i = 0; strips > 1 && i < strips; i++)
        bytes_number(&file, DATA + plane * i, 4, big);
    for (uint32_t i = 0; strips > 1 && i < strips; i++)
        bytes_number(&file, plane, 4, big);
    bytes_number(&file, ENTRIES + kind.alpha, 2, big);
    entry(&file, 254, 4, 1, kind.thumbnail, big);
    entry(&file, 256, 3, 1, (uint32_t)width, big);
    entry(&file, 257, 3, 1, (uint32_t)height, big);
    /* Each channel has as many bits, which is read of one alone, too. */
    entry(&file, 258, 3, 1, (uint32_t)kind.bits, big);
    entry(&file, 262, 3, 1, (uint32_t)kind.photometric, big);
    entry(&file, 273, 4, strips, strips > 1 ? tables : DATA, big);
    entry(&file, 274, 3, 1, (uint32_t)kind.orientation, big);
    entry(&file, 277, 3, 1, (uint32_t)kind.channels, big);
    entry(&file, 279, 4, strips, strips > 1 ? tables + 4 * strips : bytes, big);
    if (kind.thumbnail)
        entry(&file, 330, 4, 1, 0, big);
    else
        entry(&file, 284, 3, 1, kind.planar ? 2 : 1, big);
    if (kind.alpha)
        entry(&file, 338, 3, 1, 2, big);
    entry(&file, 339, 3, 1, kind.floats ? 3 : 1, big);
    bytes_number(&file, 0, 4, big);
    return file;
}

static void attribute(struct bytes *file, const char *name, const char *type, uint32_t size)
{
    bytes_add(file, name, strlen(name) + 1);
    bytes_add(file, type, strlen(type) + 1);
    bytes_number(file, size, 4, false);
}

static void add_box(struct bytes *file, const char *name, int x, int y, int width, int height)
{
    attribute(file, name, "box2i", 16);
    bytes_number(file, (uint32_t)x, 4, false);
    bytes_number(file, (uint32_t)y, 4, false);
    bytes_number(file, (uint32_t)(x + width - 1), 4, false);
    bytes_number(file, (uint32_t)(y + height - 1), 4, false);
}

static void add_channels(struct bytes *file, const char *channels, int *count)
{
    struct bytes list = {NULL, 0};

    *count = 0;
    while (*channels) {
        const size_t length = strcspn(channels, " ");

        bytes_add(&list, channels, length);
        bytes_number(&list, 0, 1, false);
        bytes_number(&list, 2, 4, false); /* FLOAT */
        bytes_number(&list, 0, 4, false);
        bytes_number(&list, 1, 4, false);
        bytes_number(&list, 1, 4, false);
        channels += length + (channels[length] == ' ');
        ++*count;
    }
    bytes_number(&list, 0, 1, false);
    attribute(file, "channels", "chlist", (uint32_t)list.size);
    bytes_join(file, list);
}

static void add_text(struct bytes *file, const char *name, const char *text)
{
    attribute(file, name, "string", (uint32_t)strlen(text));
    bytes_add(file, text, strlen(text));
}

/* The header of a part, and how many channels it has. */
static int add_header(struct bytes *file, int width, int height, const struct exr_part *part,
                      bool alone)
{
    int count;

    add_channels(file, part->channels, &count);
    attribute(file, "compression", "compression", 1);
    bytes_number(file, 0, 1, false);
    add_box(file, "dataWindow", part->x, part->y, part->width, height);
    add_box(file, "displayWindow", 0, 0, width, height); /* one for all parts */
    attribute(file, "lineOrder", "lineOrder", 1);
    bytes_number(file, 0, 1, false);
    attribute(file, "pixelAspectRatio", "float", 4);
    add_float(file, 1, false);
    attribute(file, "screenWindowCenter", "v2f", 8);
    bytes_number(file, 0, 8, false);
    attribute(file, "screenWindowWidth", "float", 4);
    add_float(file, 1, false);
    if (!alone) {
        add_text(file, "name", part->name);
        add_text(file, "type", part->deep ? "deepscanline" : "scanlineimage");
        attribute(file, "chunkCount", "int", 4);
        bytes_number(file, (uint32_t)height, 4, false);
        if (part->deep) {
            attribute(file, "version", "int", 4);
            bytes_number(file, 1, 4, false);
            attribute(file, "maxSamplesPerPixel", "int", 4);
            bytes_number(file, 1, 4, false);
        }
    }
    if (part->view)
        add_text(file, "view", part->view);
    bytes_number(file, 0, 1, false);
    return count;
}

struct bytes make_exr_parts(int height, const struct exr_part *parts, int count)
{
    const size_t mark = count > 1 ? 4 : 0; /* bytes of the number of a part before each chunk */
    struct bytes file = {NULL, 0};
    size_t at;
    int channels[8], before = 0;

    bytes_add(&file, count > 1 ? "\x76\x2f\x31\x01\2\x10\0\0" : "\x76\x2f\x31\x01\2\0\0\0", 8);
    for (int i = 0; i < count; i++)
        channels[i] = add_header(&file, parts[0].width, height, &parts[i], count == 1);
    bytes_number(&file, 0, count > 1, false);
    at = file.size + 8 * (size_t)(count * height);
    for (int i = 0; i < count; i++) {
        for (int y = 0; y < height; y++) {
            bytes_number(&file, at, 8, false);
            at += mark + 8 + (size_t)(4 * parts[i].width * channels[i]);
        }
    }
    for (int i = 0; i < count; before += channels[i++]) {
        for (int y = 0; y < height; y++) {
            bytes_number(&file, (uint32_t)i, (int)mark, false);
            bytes_number(&file, (uint32_t)(y + parts[i].y), 4, false);
            bytes_number(&file, (uint32_t)(4 * parts[i].width * channels[i]), 4, false);
            for (int c = before; c < before + channels[i]; c++)
                for (int x = 0; x < parts[i].width; x++)
                    add_float(&file, (float)pattern(x, y, c, 255) / 64, false);
        }
    }
    return file;
}

struct bytes make_exr(int width, int height, const char *channels, int x, int y)
{
    const struct exr_part part = {.channels = channels, .width = width, .x = x, .y = y};

    return make_exr_parts(height, &part, 1);
}

struct bytes make_dng(int width, int height, unsigned level, struct bytes preview)
{
    enum { ENTRIES = 16, DATA = 8 };
    /* Colours of the camera are those of XYZ, and its white is grey in them. */
    static const int matrix[9] = {32405, -15371, -4985, -9693, 18760, 416, 556, -2040, 10572};
    const uint32_t bytes = (uint32_t)(width * height * 2);
    const uint32_t matrix_at = DATA + bytes, neutral_at = matrix_at + 72;
    const uint32_t model_at = neutral_at + 24, directory = model_at + 8;
    struct bytes file = {NULL, 0};

    bytes_add(&file, "II*\0", 4);
    bytes_number(&file, directory, 4, false);
    for (int i = 0; i < width * height; i++)
        bytes_number(&file, level, 2, false);
    for (int i = 0; i < 9; i++) {
        bytes_number(&file, (uint32_t)matrix[i], 4, false);
        bytes_number(&file, 10000, 4, false);
    }
    for (int i = 0; i < 6; i++)
        bytes_number(&file, 1, 4, false);
    bytes_add(&file, "Model X\0", 8);
    bytes_number(&file, ENTRIES, 2, false);
    entry(&file, 254, 4, 1, 0, false);
    entry(&file, 256, 3, 1, (uint32_t)width, false);
    entry(&file, 257, 3, 1, (uint32_t)height, false);
    entry(&file, 258, 3, 1, 16, false);
    entry(&file, 259, 3, 1, 1, false);
    entry(&file, 262, 3, 1, 32803, false);
    entry(&file, 273, 4, 1, DATA, false);
    entry(&file, 274, 3, 1, 1, false);
    entry(&file, 277, 3, 1, 1, false);
    entry(&file, 278, 3, 1, (uint32_t)height, false);
    entry(&file, 279, 4, 1, bytes, false);
    entry(&file, 33421, 3, 2, 2 | 2 << 16, false);
    entry(&file, 33422, 1, 4, 0 | 1 << 8 | 1 << 16 | 2 << 24, false);
    entry(&file, 50706, 1, 4, 1 | 4 << 8, false);
    entry(&file, 50708, 2, 8, model_at, false);
    entry(&file, 50721, 10, 9, matrix_at, false);
    bytes_number(&file, 0, 4, false);
    if (preview.size > 0)
        bytes_join(&file, preview);
    return file;
}

struct bytes make_npy(int version, const char *header, const void *samples, size_t size)
{
    struct bytes file = {NULL, 0};

    bytes_add(&file, "\x93NUMPY", 6);
    bytes_number(&file, (uint64_t)version, 1, false);
    bytes_number(&file, 0, 1, false);
    bytes_number(&file, strlen(header), version == 1 ? 2 : 4, false);
    bytes_text(&file, header);
    bytes_add(&file, samples, size);
    return file;
}
