/* gain_write.c: a gain map becomes a JPEG with the metadata of ISO 21496-1 and of Ultra HDR 1.1,
 * https://developer.android.com/media/platform/hdr-image-format, of which readers know one or the
 * other. */
#include "gain_write.h"

#include <stdlib.h>

#include "jpeg_encode.h"
#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "reason.h"
#include "text.h"
#include "xmp.h"

enum {
    QUALITY = 95,
    UNITS = 1 << 16,
    IN_COLOURS_OF_PHOTO = 0x40, /* gains are for the primaries of the base rendition */
};

static void put_number(struct rf_text *text, uint32_t value)
{
    const uint8_t bytes[4] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8),
                              (uint8_t)value};

    rf_text_put(text, bytes, sizeof bytes);
}

static void put_fraction(struct rf_text *text, double value)
{
    put_number(text, (uint32_t)(int32_t)(value * UNITS));
    put_number(text, UNITS);
}

static void put_iso(struct rf_store *store, struct rf_text *text,
                    const struct rf_gain_values *values)
{
    const uint8_t flags = IN_COLOURS_OF_PHOTO; /* values for all channels in one */

    put_number(text, 0); /* versions: to be read by, and of the writer */
    rf_text_put(text, &flags, 1);
    put_fraction(text, values->base_headroom);
    put_fraction(text, values->other_headroom);
    put_fraction(text, values->least[0]);
    put_fraction(text, values->greatest[0]);
    put_fraction(text, values->gamma[0]);
    put_fraction(text, values->base_offset[0]);
    put_fraction(text, values->other_offset[0]);
    rf_jpeg_put_segment(store, RF_JPEG_APP2, rf_jpeg_gain_signature, sizeof rf_jpeg_gain_signature,
                        text->data, text->size);
}

static void put_xmp(struct rf_store *store, struct rf_text *text,
                    const struct rf_gain_values *values)
{
    rf_text_words(text, "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"" RF_NS_RDF
                        "\"><rdf:Description rdf:about=\"\" xmlns:hdrgm=\"" RF_NS_GAIN_MAP
                        "\" hdrgm:Version=\"1.0\"");
    rf_text_number(text, " hdrgm:GainMapMin", values->least[0]);
    rf_text_number(text, " hdrgm:GainMapMax", values->greatest[0]);
    rf_text_number(text, " hdrgm:Gamma", values->gamma[0]);
    rf_text_number(text, " hdrgm:OffsetSDR", values->base_offset[0]);
    rf_text_number(text, " hdrgm:OffsetHDR", values->other_offset[0]);
    rf_text_number(text, " hdrgm:HDRCapacityMin", values->base_headroom);
    rf_text_number(text, " hdrgm:HDRCapacityMax", values->other_headroom);
    rf_text_words(text, " hdrgm:BaseRenditionIsHDR=\"False\"/></rdf:RDF></x:xmpmeta>");
    rf_jpeg_put_xmp(store, rf_text_bytes(text));
}

static int put_all(struct rf_store *store, const struct rf_jpeg_encoded *jpeg,
                   const struct rf_gain_values *values, struct refocus_reason *reason)
{
    struct rf_text xmp = {NULL, 0, 0, false}, iso = {NULL, 0, 0, false};
    bool failed;

    rf_store_write(store, jpeg->bytes, jpeg->split);
    put_xmp(store, &xmp, values);
    put_iso(store, &iso, values);
    rf_store_write(store, jpeg->bytes + jpeg->split, jpeg->size - jpeg->split);
    failed = xmp.failed || iso.failed;
    free(xmp.data);
    free(iso.data);
    return failed ? rf_fail_memory(reason) : REFOCUS_OK;
}

int rf_gain_write(struct refocus_blob *jpeg, const struct rf_gain_map *map,
                  struct refocus_reason *reason)
{
    const struct rf_rows rows = {.top = map->samples.pixels,
                                 .width = map->samples.width,
                                 .height = map->samples.height,
                                 .stride = (ptrdiff_t)rf_raster_stride(&map->samples),
                                 .format = map->samples.channels == 1
                                               ? (uint32_t)RF_FORMAT_GRAY8
                                               : (uint32_t)REFOCUS_FORMAT_RGB8};
    struct rf_jpeg_encoded encoded;
    struct rf_store store;
    int status = rf_jpeg_encode(&encoded, &rows, QUALITY, reason);

    if (status == REFOCUS_OK) {
        status = rf_store_open_memory(&store, reason);
        if (status == REFOCUS_OK) {
            status = put_all(&store, &encoded, &map->values, reason);
            status = rf_store_close_memory(&store, status, jpeg, reason);
        }
    }
    rf_jpeg_encoded_free(&encoded);
    return status;
}
