/* make.c: puts together small PNG files, EXIF, HEIF boxes and XMP, byte by byte. */
#include "make.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Room goes up in powers of two: a file may be put together byte by byte. */
static size_t room_for(size_t size)
{
    size_t room = 64;

    while (room < size + 1)
        room *= 2;
    return room;
}

void bytes_add(struct bytes *bytes, const void *data, size_t size)
{
    const size_t room = room_for(bytes->size + size);

    if (!bytes->data || room != room_for(bytes->size)) {
        uint8_t *const grown = realloc(bytes->data, room);
        if (!grown)
            exit(99);
        bytes->data = grown;
    }
    if (size > 0)
        memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    bytes->data[bytes->size] = 0;
}

void bytes_text(struct bytes *bytes, const char *text)
{
    bytes_add(bytes, text, strlen(text));
}

void bytes_number(struct bytes *bytes, uint64_t value, int size, bool big_endian)
{
    for (int i = 0; i < size; i++) {
        const uint8_t byte = (uint8_t)(value >> 8 * (big_endian ? size - 1 - i : i));
        bytes_add(bytes, &byte, 1);
    }
}

void bytes_join(struct bytes *bytes, struct bytes tail)
{
    bytes_add(bytes, tail.data, tail.size);
    free(tail.data);
}

void bytes_free(struct bytes *bytes)
{
    free(bytes->data);
    bytes->data = NULL;
    bytes->size = 0;
}

struct bytes bytes_copy(const void *data, size_t size)
{
    struct bytes copy = {NULL, 0};

    bytes_add(&copy, data, size);
    return copy;
}

unsigned pattern(int x, int y, int c, unsigned max)
{
    return (unsigned)(x * 37 + y * 91 + c * 53 + x * y * 7) * (max > 255 ? 251u : 1u) % (max + 1);
}

/* PNG ----------------------------------------------------------------- */

static uint32_t crc32_of(const uint8_t *data, size_t size)
{
    uint32_t crc = 0xffffffffu;

    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

void png_chunk(struct bytes *png, const char *type, const void *data, size_t size)
{
    bytes_number(png, size, 4, true);
    bytes_add(png, type, 4);
    bytes_add(png, data, size);
    bytes_number(png, crc32_of(png->data + png->size - size - 4, size + 4), 4, true);
}

/* zlib's format with stored blocks. */
static struct bytes zlib_stored(const uint8_t *data, size_t size)
{
    struct bytes z = {NULL, 0};
    uint32_t a = 1, b = 0;
    size_t at = 0;

    bytes_number(&z, 0x7801, 2, true);
    do {
        const size_t n = size - at < 65535 ? size - at : 65535;
        bytes_number(&z, at + n == size, 1, true);
        bytes_number(&z, n, 2, false);
        bytes_number(&z, ~n & 0xffff, 2, false);
        bytes_add(&z, data + at, n);
        at += n;
    } while (at < size);
    for (size_t i = 0; i < size; i++) {
        a = (a + data[i]) % 65521;
        b = (b + a) % 65521;
    }
    bytes_number(&z, b << 16 | a, 4, true);
    return z;
}

static int png_channels(int type)
{
    return type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1;
}

struct bytes make_png_raw(int width, int height, int type, int bits, const uint8_t *samples,
                          const struct bytes *exif)
{
    const size_t stride = ((size_t)(width * png_channels(type) * bits) + 7) / 8;
    struct bytes png = {NULL, 0}, header = {NULL, 0}, rows = {NULL, 0}, packed;

    bytes_add(&png, "\x89PNG\r\n\x1a\n", 8);
    bytes_number(&header, (uint64_t)width, 4, true);
    bytes_number(&header, (uint64_t)height, 4, true);
    bytes_number(&header, (uint64_t)bits, 1, true);
    bytes_number(&header, (uint64_t)type, 1, true);
    bytes_number(&header, 0, 3, true);
    png_chunk(&png, "IHDR", header.data, header.size);
    if (exif)
        png_chunk(&png, "eXIf", exif->data, exif->size);
    if (type == 3) {
        uint8_t palette[768];
        for (int i = 0; i < 768; i++)
            palette[i] = (uint8_t)(i / 3);
        png_chunk(&png, "PLTE", palette, sizeof palette);
        png_chunk(&png, "tRNS", "\0\200", 2);
    }
    for (int y = 0; y < height; y++) {
        bytes_number(&rows, 0, 1, true);
        bytes_add(&rows, samples + (size_t)y * stride, stride);
    }
    packed = zlib_stored(rows.data, rows.size);
    png_chunk(&png, "IDAT", packed.data, packed.size);
    png_chunk(&png, "IEND", NULL, 0);
    bytes_free(&header);
    bytes_free(&rows);
    bytes_free(&packed);
    return png;
}

struct bytes make_png(int width, int height, int type, int bits)
{
    const int channels = png_channels(type);
    struct bytes samples = {NULL, 0}, png;

    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            for (int c = 0; c < channels; c++) {
                const unsigned max = bits == 16 ? 65535 : 255;
                bytes_number(&samples, pattern(x, y, c, max), bits / 8, true);
            }
        }
    }
    png = make_png_raw(width, height, type, bits, samples.data, NULL);
    bytes_free(&samples);
    return png;
}

/* EXIF ---------------------------------------------------------------- */

struct tiff {
    struct bytes block;
    bool big_endian;
};

static void add(struct tiff *tiff, uint64_t value, int size)
{
    bytes_number(&tiff->block, value, size, tiff->big_endian);
}

static void entry(struct tiff *tiff, int tag, int type, uint32_t count, uint32_t value)
{
    add(tiff, (uint64_t)tag, 2);
    add(tiff, (uint64_t)type, 2);
    add(tiff, count, 4);
    if (type == 3) {
        add(tiff, value, 2);
        add(tiff, 0, 2);
    } else {
        add(tiff, value, 4);
    }
}

struct bytes make_exif(bool big_endian, int orientation)
{
    enum { SETTINGS = 62, TEXT = 128, THUMBNAIL = 160 };
    struct tiff tiff = {{NULL, 0}, big_endian};

    bytes_text(&tiff.block, big_endian ? "MM" : "II");
    add(&tiff, 42, 2);
    add(&tiff, 8, 4);
    add(&tiff, 4, 2); /* at 8 */
    entry(&tiff, 0x010f, 2, 6, TEXT);
    entry(&tiff, 0x0110, 2, 8, TEXT + 6);
    entry(&tiff, 0x0112, 3, 1, (uint32_t)orientation);
    entry(&tiff, 0x8769, 4, 1, SETTINGS);
    add(&tiff, THUMBNAIL, 4);
    add(&tiff, 5, 2); /* at 62 */
    entry(&tiff, 0x829d, 5, 1, TEXT + 14);
    entry(&tiff, 0x920a, 5, 1, TEXT + 22);
    entry(&tiff, 0xa002, 3, 1, 640);
    entry(&tiff, 0xa003, 4, 1, 480);
    entry(&tiff, 0xa405, 3, 1, 75);
    add(&tiff, 0, 4);
    bytes_add(&tiff.block, "Maker\0Model X", 14); /* at 128 */
    add(&tiff, 18, 4);
    add(&tiff, 10, 4);
    add(&tiff, 101, 4);
    add(&tiff, 2, 4);
    add(&tiff, 0, 2);
    add(&tiff, 1, 2); /* the thumbnail's directory, at 160 */
    entry(&tiff, 0x0103, 3, 1, 6);
    add(&tiff, 0, 4);
    return tiff.block;
}

/* HEIF ---------------------------------------------------------------- */

static void add_box(struct bytes *to, const char *type, struct bytes content)
{
    bytes_number(to, content.size + 8, 4, true);
    bytes_add(to, type, 4);
    bytes_join(to, content);
}

struct bytes make_heif_boxes(const struct heif_property *properties, int count, bool large)
{
    struct bytes file = {NULL, 0}, meta = {NULL, 0}, iprp = {NULL, 0}, ipco = {NULL, 0};
    struct bytes ipma = {NULL, 0}, pitm = {NULL, 0};

    /* large: 32-bit item numbers and 15-bit indices */
    bytes_number(&pitm, large ? 1u << 24 : 0, 4, true);
    bytes_number(&pitm, 1, large ? 4 : 2, true);
    add_box(&ipco, "ispe", bytes_copy("\0\0\0\0\0\0\0\2\0\0\0\1", 12));
    bytes_number(&ipma, large ? 1u << 24 | 1 : 0, 4, true);
    bytes_number(&ipma, 2, 4, true);
    for (int item = 2; item >= 1; item--) {
        const int own = item == 1 ? count + 1 : 1;
        bytes_number(&ipma, (uint64_t)item, large ? 4 : 2, true);
        bytes_number(&ipma, (uint64_t)own, 1, true);
        for (int i = 1; i <= own; i++)
            bytes_number(&ipma, (uint64_t)i | (large ? 0x8000 : 0x80), large ? 2 : 1, true);
    }
    for (int i = 0; i < count; i++) {
        const uint8_t value = (uint8_t)properties[i].value;
        add_box(&ipco, properties[i].type, bytes_copy(&value, 1));
    }
    add_box(&iprp, "ipco", ipco);
    add_box(&iprp, "ipma", ipma);
    bytes_number(&meta, 0, 4, true);
    add_box(&meta, "pitm", pitm);
    add_box(&meta, "iprp", iprp);
    add_box(&file, "ftyp", bytes_copy("heic\0\0\0\0mif1", 12));
    add_box(&file, "meta", meta);
    return file;
}

/* Text ---------------------------------------------------------------- */

struct bytes base64(const void *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *const from = data;
    struct bytes text = {NULL, 0};

    for (size_t i = 0; i < size; i += 3) {
        const uint32_t group = (uint32_t)from[i] << 16 |
                               (uint32_t)(i + 1 < size ? from[i + 1] : 0) << 8 |
                               (uint32_t)(i + 2 < size ? from[i + 2] : 0);
        char four[4];
        for (int k = 0; k < 4; k++)
            four[k] = digits[group >> (18 - 6 * k) & 63];
        four[3] = i + 2 < size ? four[3] : '=';
        four[2] = i + 1 < size ? four[2] : '=';
        bytes_add(&text, four, 4);
    }
    return text;
}

struct bytes make_gain_xmp(const char *elements)
{
    struct bytes xmp = {NULL, 0};

    bytes_text(&xmp, "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf="
                     "\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description "
                     "xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" "
                     "hdrgm:Version=\"1.0\">");
    bytes_text(&xmp, elements);
    bytes_text(&xmp, "</rdf:Description></rdf:RDF></x:xmpmeta>");
    return xmp;
}

static struct bytes make_iso(int channels, const int32_t *values, bool common)
{
    struct bytes iso = {NULL, 0};

    bytes_number(&iso, 0, 4, true);
    bytes_number(&iso, (channels == 3 ? 0xc0 : 0x40) + 8 * common, 1, true);
    if (common)
        bytes_number(&iso, 1000, 4, true);
    for (int i = 0; i < 2 + 5 * channels; i++) {
        bytes_number(&iso, (uint32_t)values[i], 4, true);
        if (!common)
            bytes_number(&iso, 1000, 4, true);
    }
    return iso;
}

struct bytes make_gain_iso(int channels, const int32_t *values)
{
    return make_iso(channels, values, false);
}

struct bytes make_gain_iso_common(int channels, const int32_t *values)
{
    return make_iso(channels, values, true);
}

struct bytes make_xmp(const char *attributes)
{
    struct bytes xmp = {NULL, 0};

    bytes_text(&xmp, "<?xpacket begin=\"\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>"
                     "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf="
                     "\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description "
                     "rdf:about=\"\" xmlns:GDepth=\"http://ns.google.com/photos/1.0/depthmap/\" "
                     "xmlns:GImage=\"http://ns.google.com/photos/1.0/image/\" "
                     "xmlns:GFocus=\"http://ns.google.com/photos/1.0/focus/\" "
                     "xmlns:apdi=\"http://ns.apple.com/pixeldatainfo/1.0/\" "
                     "xmlns:depthData=\"http://ns.apple.com/depthData/1.0/\" "
                     "xmlns:xmpNote=\"http://ns.adobe.com/xmp/note/\" ");
    bytes_text(&xmp, attributes);
    bytes_text(&xmp, "/></rdf:RDF></x:xmpmeta><?xpacket end=\"w\"?>  \n");
    return xmp;
}
