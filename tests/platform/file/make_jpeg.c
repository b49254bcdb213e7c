/* make_jpeg.c: makes small JPEG files, and puts metadata and further pictures into them. */
#include "make.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <turbojpeg.h>

const char test_guid[33] = "0123456789ABCDEF0123456789ABCDEF";

static void fill(uint8_t *pixels, int width, int height, bool grey)
{
    static const uint8_t colours[4][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};
    static const uint8_t greys[4] = {32, 96, 160, 224};

    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            const int quarter = (y >= height / 2) * 2 + (x >= width / 2);
            if (grey) {
                *pixels++ = greys[quarter];
            } else {
                memcpy(pixels, colours[quarter], 3);
                pixels += 3;
            }
        }
    }
}

struct bytes make_jpeg(int width, int height, bool grey, bool progressive)
{
    struct bytes jpeg = {NULL, 0};
    uint8_t *const pixels = malloc((size_t)width * (size_t)height * 3);
    tjhandle compressor = tjInitCompress();
    unsigned char *out = NULL;
    unsigned long size = 0;

    fill(pixels, width, height, grey);
    if (tjCompress2(compressor, pixels, width, 0, height, grey ? TJPF_GRAY : TJPF_RGB, &out, &size,
                    grey ? TJSAMP_GRAY : TJSAMP_444, 95, progressive ? TJFLAG_PROGRESSIVE : 0) != 0)
        exit(98);
    bytes_add(&jpeg, out, size);
    tjFree(out);
    tjDestroy(compressor);
    free(pixels);
    return jpeg;
}

void jpeg_insert(struct bytes *jpeg, int marker, const char *signature, size_t signature_size,
                 const void *data, size_t size)
{
    struct bytes whole = {NULL, 0};

    bytes_number(&whole, 0xffd8, 2, true);
    bytes_number(&whole, 0xff, 1, true);
    bytes_number(&whole, (uint64_t)marker, 1, true);
    bytes_number(&whole, signature_size + size + 2, 2, true);
    bytes_add(&whole, signature, signature_size);
    bytes_add(&whole, data, size);
    bytes_add(&whole, jpeg->data + 2, jpeg->size - 2);
    bytes_free(jpeg);
    *jpeg = whole;
}

void jpeg_insert_exif(struct bytes *jpeg, struct bytes exif)
{
    jpeg_insert(jpeg, 0xe1, "Exif\0", 6, exif.data, exif.size);
    bytes_free(&exif);
}

void jpeg_insert_xmp(struct bytes *jpeg, const char *xmp)
{
    jpeg_insert(jpeg, 0xe1, "http://ns.adobe.com/xap/1.0/", 29, xmp, strlen(xmp));
}

void jpeg_insert_extended(struct bytes *jpeg, const char *guid, struct bytes packet, size_t chunk,
                          int step, int skip)
{
    const int count = (int)((packet.size + chunk - 1) / chunk);

    for (int i = 0; i < count; i++) {
        const int index = (int)((long)i * step % count);
        const size_t from = (size_t)index * chunk;
        const size_t size = packet.size - from < chunk ? packet.size - from : chunk;
        struct bytes body = {NULL, 0};

        if (index == skip)
            continue;
        bytes_text(&body, guid);
        bytes_number(&body, packet.size, 4, true);
        bytes_number(&body, from, 4, true);
        bytes_add(&body, packet.data + from, size);
        jpeg_insert(jpeg, 0xe1, "http://ns.adobe.com/xmp/extension/", 35, body.data, body.size);
        bytes_free(&body);
    }
}

static void add_attribute(struct bytes *text, const char *name, const char *value)
{
    if (value) {
        bytes_text(text, name);
        bytes_text(text, "=\"");
        bytes_text(text, value);
        bytes_text(text, "\" ");
    }
}

static void add_data(struct bytes *text, const char *name, struct bytes *data)
{
    struct bytes coded;

    if (data->data) {
        coded = base64(data->data, data->size);
        add_attribute(text, name, (const char *)coded.data);
        bytes_free(&coded);
        bytes_free(data);
    }
}

struct bytes make_gdepth(struct gdepth gdepth, int orientation)
{
    struct bytes jpeg = make_jpeg(48, 32, false, false), text = {NULL, 0}, xmp;

    add_attribute(&text, "GDepth:Format", gdepth.format);
    bytes_text(&text, gdepth.extra ? gdepth.extra : "");
    bytes_text(&text, " ");
    add_data(&text, "GDepth:Data", &gdepth.depth);
    add_data(&text, "GImage:Data", &gdepth.original);
    xmp = make_xmp((const char *)text.data);
    jpeg_insert_xmp(&jpeg, (const char *)xmp.data);
    bytes_free(&xmp);
    bytes_free(&text);
    if (orientation)
        jpeg_insert_exif(&jpeg, make_exif(true, orientation));
    return jpeg;
}

struct bytes make_gdepth_extended(struct gdepth gdepth, size_t chunk, int step, int skip)
{
    struct bytes jpeg = make_jpeg(48, 32, false, false);
    struct bytes text = {NULL, 0}, data = {NULL, 0}, xmp;

    add_data(&data, "GDepth:Data", &gdepth.depth);
    add_data(&data, "GImage:Data", &gdepth.original);
    xmp = make_xmp((const char *)data.data);
    jpeg_insert_extended(&jpeg, test_guid, xmp, chunk, step, skip);
    bytes_free(&xmp);
    add_attribute(&text, "GDepth:Format", gdepth.format);
    add_attribute(&text, "xmpNote:HasExtendedXMP", test_guid);
    bytes_text(&text, gdepth.extra ? gdepth.extra : "");
    xmp = make_xmp((const char *)text.data);
    jpeg_insert_xmp(&jpeg, (const char *)xmp.data);
    bytes_free(&xmp);
    bytes_free(&text);
    bytes_free(&data);
    return jpeg;
}

static void add_item(struct bytes *text, const struct dynamic *dynamic, const char *semantic,
                     const char *uri, size_t length)
{
    char item[256];

    snprintf(item, sizeof item,
             dynamic->plain ? "<rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Mime=\"x\" "
                              "Item:Semantic=\"%s\" Item:Length=\"%zu\" Item:Padding=\"%zu\"/>"
                              "</rdf:li>"
                            : "<rdf:li rdf:parseType=\"Resource\"><Item:DataURI>%s</Item:DataURI>"
                              "<Item:Length>%zu</Item:Length><Item:Padding>%zu</Item:Padding>"
                              "</rdf:li>",
             dynamic->plain ? semantic : uri, length, dynamic->padding);
    bytes_text(text, item);
}

struct bytes make_dynamic_xmp(const struct dynamic *dynamic)
{
    struct bytes text = {NULL, 0};

    bytes_text(&text,
               "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
               "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description ");
#define DD "http://ns.google.com/photos/dd/1.0/"
    bytes_text(&text, dynamic->plain
                          ? "xmlns:Container=\"http://ns.google.com/photos/1.0/container/\" "
                            "xmlns:Item=\"http://ns.google.com/photos/1.0/container/item/\" "
                          : "xmlns:Container=\"" DD "container/\" xmlns:Item=\"" DD "item/\" ");
    bytes_text(&text, "xmlns:Device=\"" DD "device/\" xmlns:Camera=\"" DD "camera/\" "
                      "xmlns:Image=\"" DD "image/\" xmlns:DepthMap=\"" DD "depthmap/\">"
                      "<Container:Directory><rdf:Seq>");
    add_item(&text, dynamic, "Primary", "primary_image", 0);
    if (dynamic->gain.data)
        add_item(&text, dynamic, "GainMap", "android/gainmap", dynamic->gain.size);
    if (dynamic->original.data)
        add_item(&text, dynamic, "Original", "android/original_image", dynamic->original.size);
    if (dynamic->depth.data)
        add_item(&text, dynamic, "Depth", "android/depthmap", dynamic->depth.size);
    if (dynamic->confidence.data)
        add_item(&text, dynamic, "Confidence", "android/confidencemap", dynamic->confidence.size);
    bytes_text(&text, "</rdf:Seq></Container:Directory>");
    if (dynamic->map) {
        bytes_text(&text,
                   "<Device:Cameras><rdf:Seq><rdf:li><Device:Camera Camera:Trait=\"Physical\">");
        if (dynamic->original.data) {
            bytes_text(&text, "<Camera:Image Image:ItemSemantic=\"Original\" "
                              "Image:ItemURI=\"android/original_image\"/>");
        }
        bytes_text(&text, "<Camera:DepthMap ");
        bytes_text(&text, dynamic->map);
        /* A second camera, of which nothing is taken. */
        bytes_text(&text, "/></Device:Camera></rdf:li><rdf:li><Device:Camera>"
                          "<Camera:DepthMap DepthMap:Near=\"7\" DepthMap:ConfidenceURI=\"x\"/>"
                          "</Device:Camera></rdf:li></rdf:Seq></Device:Cameras>");
    }
    bytes_text(&text, "</rdf:Description></rdf:RDF></x:xmpmeta>");
    return text;
}

static void add_zeros(struct bytes *file, size_t count)
{
    while (count-- > 0)
        bytes_add(file, "", 1);
}

static void add_behind(struct bytes *file, struct bytes part, size_t padding)
{
    if (part.data) {
        bytes_join(file, part);
        add_zeros(file, padding);
    }
}

struct bytes make_dynamic(struct dynamic dynamic, int orientation)
{
    struct bytes jpeg = make_jpeg(48, 32, false, false), xmp = make_dynamic_xmp(&dynamic);

    jpeg_insert_xmp(&jpeg, (const char *)xmp.data);
    bytes_free(&xmp);
    if (orientation)
        jpeg_insert_exif(&jpeg, make_exif(true, orientation));
    add_zeros(&jpeg, dynamic.between + dynamic.padding);
    add_behind(&jpeg, dynamic.gain, dynamic.padding);
    add_behind(&jpeg, dynamic.original, dynamic.padding);
    add_behind(&jpeg, dynamic.depth, dynamic.padding);
    add_behind(&jpeg, dynamic.confidence, dynamic.padding);
    return jpeg;
}

struct bytes make_mpf(struct bytes main_jpeg, struct bytes *parts, int count, bool big_endian)
{
    const size_t entries = 16 * (size_t)(count + 1);
    const size_t segment = 4 + 4 + 8 + 2 + 36 + 4 + entries;
    const size_t tiff_at = 2 + 4 + 4; /* offset of the TIFF header in the file */
    size_t at = main_jpeg.size + segment - tiff_at;
    struct bytes tiff = {NULL, 0};

    bytes_text(&tiff, big_endian ? "MM" : "II");
    bytes_number(&tiff, 42, 2, big_endian);
    bytes_number(&tiff, 8, 4, big_endian);
    bytes_number(&tiff, 3, 2, big_endian);
    bytes_number(&tiff, 0xb000, 2, big_endian);
    bytes_number(&tiff, 7, 2, big_endian);
    bytes_number(&tiff, 4, 4, big_endian);
    bytes_text(&tiff, "0100");
    bytes_number(&tiff, 0xb001, 2, big_endian);
    bytes_number(&tiff, 4, 2, big_endian);
    bytes_number(&tiff, 1, 4, big_endian);
    bytes_number(&tiff, (uint64_t)count + 1, 4, big_endian);
    bytes_number(&tiff, 0xb002, 2, big_endian);
    bytes_number(&tiff, 7, 2, big_endian);
    bytes_number(&tiff, entries, 4, big_endian);
    bytes_number(&tiff, 50, 4, big_endian);
    bytes_number(&tiff, 0, 4, big_endian);
    for (int i = -1; i < count; i++) {
        bytes_number(&tiff, i < 0 ? 0x30000 : 0, 4, big_endian);
        bytes_number(&tiff, i < 0 ? main_jpeg.size + segment : parts[i].size, 4, big_endian);
        bytes_number(&tiff, i < 0 ? 0 : at, 4, big_endian);
        bytes_number(&tiff, 0, 4, big_endian);
        at += i < 0 ? 0 : parts[i].size;
    }
    jpeg_insert(&main_jpeg, 0xe2, "MPF", 4, tiff.data, tiff.size);
    bytes_free(&tiff);
    for (int i = 0; i < count; i++)
        bytes_join(&main_jpeg, parts[i]);
    return main_jpeg;
}

struct bytes make_auxiliary(const char *type, const char *extra)
{
    struct bytes jpeg = make_jpeg(32, 16, true, false), text = {NULL, 0}, xmp;

    add_attribute(&text, "apdi:AuxiliaryImageType", type);
    bytes_text(&text, extra ? extra : "");
    xmp = make_xmp((const char *)text.data);
    jpeg_insert_xmp(&jpeg, (const char *)xmp.data);
    bytes_free(&xmp);
    bytes_free(&text);
    return jpeg;
}
