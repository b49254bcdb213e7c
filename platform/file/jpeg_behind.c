/* jpeg_behind.c: pictures are put behind the main one of a JPEG: its gain map, which a container
 * directory in XMP and an MPF index (CIPA DC-007) name, and depth, by a directory of its own. With
 * a gain map it is an Ultra HDR photo:
 * https://developer.android.com/media/platform/hdr-image-format */
#include "jpeg_behind.h"

#include "dynamic_write.h"
#include "gain_make.h"
#include "gain_write.h"
#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "reason.h"
#include "xmp.h"

/* A display brightens the result as far as it did the photo. */
static double headroom_of(const struct refocus_photo *photo)
{
    const struct rf_gain_map *const map = photo ? rf_photo_gain_map(photo) : NULL;

    return map ? map->values.other_headroom : 0;
}

static int make_gain_map(struct rf_behind *behind, const struct rf_rows *rows,
                         const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct refocus_blob jpeg = {NULL, 0};
    struct rf_gain_map map;
    int status = rf_gain_make(&map, rows, options->light, headroom_of(options->keep));

    if (status != REFOCUS_OK)
        return rf_fail_memory(reason);
    status = rf_gain_write(&jpeg, &map, reason);
    rf_raster_free(&map.samples);
    if (status == REFOCUS_OK)
        rf_behind_add(behind, rf_gain_map_semantic, "android/gainmap", jpeg);
    return status;
}

int rf_behind_make(struct rf_behind *behind, const struct rf_rows *rows,
                   const struct refocus_write_options *options, struct refocus_reason *reason)
{
    int status = options->light ? make_gain_map(behind, rows, options, reason) : REFOCUS_OK;

    if (status == REFOCUS_OK && options->editable && options->editable->depth)
        status = rf_dynamic_add(behind, options->editable->depth, reason);
    return status;
}

void rf_behind_put_xmp(struct rf_text *text, const struct rf_behind *behind,
                       const struct refocus_write_options *options)
{
    if (rf_behind_has_gain_map(behind)) {
        rf_text_words(text, "<rdf:Description xmlns:rdf=\"" RF_NS_RDF "\" rdf:about=\"\""
                            " xmlns:Container=\"" RF_NS_CONTAINER "\" xmlns:Item=\"" RF_NS_CONTAINER
                            "item/\" xmlns:hdrgm=\"" RF_NS_GAIN_MAP "\" hdrgm:Version=\"1.0\">");
        rf_behind_put_items(text, behind, true);
        rf_text_words(text, "</rdf:Description>");
    }
    if (options->editable)
        rf_dynamic_put(text, behind, options->editable->depth);
}

static uint8_t *put_number(uint8_t *to, uint64_t value, int bytes)
{
    for (int i = bytes - 1; i >= 0; i--)
        *to++ = (uint8_t)(value >> 8 * i);
    return to;
}

static uint8_t *put_tag(uint8_t *to, int tag, int type, int count, uint32_t value)
{
    to = put_number(to, (uint64_t)tag, 2);
    to = put_number(to, (uint64_t)type, 2);
    to = put_number(to, (uint64_t)count, 4);
    return put_number(to, value, 4);
}

void rf_behind_put_index(struct rf_store *store, const struct rf_behind *behind, size_t left)
{
    enum { PICTURES = 2, AT = 50, SIZE = AT + 16 * PICTURES, HEAD = 4 + 4 };
    enum { LONG = 4, UNDEFINED = 7, PRIMARY = 0x30000 };
    uint8_t tiff[SIZE], *to = tiff;
    uint64_t header, size;

    if (!rf_behind_has_gain_map(behind))
        return;
    /* Two versions alone: the whole metadata lies with the map. */
    rf_jpeg_put_segment(store, RF_JPEG_APP2, rf_jpeg_gain_signature, sizeof rf_jpeg_gain_signature,
                        "\0\0\0", 4);
    header = store->written + HEAD; /* places are counted from here */
    size = header + SIZE + left;
    to = put_number(to, 0x4d4d002a, 4);
    to = put_number(to, 8, 4);
    to = put_number(to, 3, 2);
    to = put_tag(to, 0xb000, UNDEFINED, 4, 0x30313030); /* "0100" */
    to = put_tag(to, 0xb001, LONG, 1, PICTURES);
    to = put_tag(to, 0xb002, UNDEFINED, 16 * PICTURES, AT);
    to = put_number(to, 0, 4); /* no other directory */
    to = put_number(to, PRIMARY, 4);
    to = put_number(to, size, 4);
    to = put_number(to, 0, 8);
    to = put_number(to, 0, 4);
    to = put_number(to, behind->item[0].bytes.size, 4);
    to = put_number(to, size - header, 4);
    put_number(to, 0, 4);
    rf_jpeg_put_segment(store, RF_JPEG_APP2, rf_jpeg_mpf_signature, sizeof rf_jpeg_mpf_signature,
                        tiff, sizeof tiff);
}

void rf_behind_put(struct rf_store *store, const struct rf_behind *behind)
{
    for (int i = 0; i < behind->count; i++)
        rf_store_write(store, behind->item[i].bytes.data, behind->item[i].bytes.size);
}
