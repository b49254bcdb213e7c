/* original.c: the all-in-focus original that an editable result holds is made of the photo. */
#include "original.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "depth_part.h"
#include "formats.h"
#include "gain_make.h"
#include "gain_write.h"
#include "jpeg_encode.h"
#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "kept.h"
#include "reason.h"
#include "xmp.h"

/* Whether a segment says how the pixels are to be decoded and shown. Others are in the result. */
static bool is_needed(int marker, struct rf_bytes segment)
{
    struct rf_bytes rest;

    return (marker != RF_JPEG_COM && (marker < RF_JPEG_APP0 || marker > RF_JPEG_APP15)) ||
           marker == RF_JPEG_APP14 ||
           (marker == RF_JPEG_APP0 && rf_jpeg_after(segment, "JFIF", 5, &rest)) ||
           (marker == RF_JPEG_APP2 &&
            rf_jpeg_after(segment, rf_jpeg_icc_signature, sizeof rf_jpeg_icc_signature, &rest));
}

static void put_orientation(struct rf_text *jpeg, int orientation)
{
    uint8_t segment[] = "\xff\xe1\0\x22"
                        "Exif\0\0MM\0*\0\0\0\x08"
                        "\0\1\x01\x12\0\3\0\0\0\1\0\1\0\0\0\0\0\0";

    segment[29] = (uint8_t)orientation;
    rf_text_put(jpeg, segment, sizeof segment - 1);
}

/* Copy a JPEG without what the result keeps itself; its coefficients stay. For others than this
 * library, EXIF says how its pixels lie. */
static void put_plain(struct rf_text *out, struct rf_bytes jpeg, int orientation)
{
    struct rf_jpeg_walk walk;
    size_t copied = 0, end = 2;
    bool told = orientation == 1, in_scans = false;

    if (!rf_jpeg_walk_begin(&walk, jpeg))
        return;
    while (rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT) {
        const size_t begin = (size_t)(walk.segment.data - jpeg.data) - 4;
        const bool needed = is_needed(walk.marker, walk.segment);

        /* Decoders make their own sense of bytes between segments: the whole is copied then. */
        if (!in_scans && begin != end) {
            out->size = 0;
            rf_text_put(out, jpeg.data, jpeg.size);
            return;
        }
        if (!needed || (!told && walk.marker != RF_JPEG_APP0)) {
            rf_text_put(out, jpeg.data + copied, begin - copied);
            copied = needed ? begin : walk.position;
        }
        if (!told && walk.marker != RF_JPEG_APP0) {
            put_orientation(out, orientation);
            told = true;
        }
        end = walk.position;
        in_scans |= walk.marker == RF_JPEG_SOS;
    }
    rf_text_put(out, jpeg.data + copied, jpeg.size - copied);
}

static struct rf_rows rows_of(const struct refocus_image *image)
{
    return (struct rf_rows){.top = image->plane[0],
                            .stride = image->stride[0],
                            .width = image->width,
                            .height = image->height,
                            .format = image->format};
}

/* The pixels of a photo, all of their bits, as a PNG. */
static int put_png(struct rf_text *out, const struct refocus_image *pixels,
                   struct refocus_reason *reason)
{
    const struct rf_rows rows = rows_of(pixels);
    struct refocus_blob png = {NULL, 0};
    struct rf_store store;
    int status = rf_store_open_memory(&store, reason);

    if (status == REFOCUS_OK) {
        status = rf_format_of_name(".png")->write(&store, &rows, NULL, reason);
        status = rf_store_close_memory(&store, status, &png, reason);
    }
    rf_text_put(out, png.data, png.size);
    free(png.data);
    return status;
}

static void put_matte_xmp(struct rf_store *store)
{
    static const char xmp[] =
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"" RF_NS_RDF
        "\"><rdf:Description rdf:about=\"\" xmlns:apdi=\"http://ns.apple.com/pixeldatainfo/1.0/\" "
        "apdi:AuxiliaryImageType=\"" RF_MATTE_TYPE "\"/></rdf:RDF></x:xmpmeta>";

    rf_jpeg_put_xmp(store, (struct rf_bytes){(const uint8_t *)xmp, sizeof xmp - 1});
}

/* A JPEG in a file, and whether it says that it is a matte. */
static int put_rows(struct rf_store *store, const struct rf_rows *rows, bool is_matte,
                    struct refocus_reason *reason)
{
    enum { QUALITY = 95 };
    struct rf_jpeg_encoded jpeg;
    const int status = rf_jpeg_encode(&jpeg, rows, QUALITY, reason);

    if (status == REFOCUS_OK) {
        rf_store_write(store, jpeg.bytes, jpeg.split);
        if (is_matte)
            put_matte_xmp(store);
        rf_store_write(store, jpeg.bytes + jpeg.split, jpeg.size - jpeg.split);
    }
    rf_jpeg_encoded_free(&jpeg);
    return status;
}

/* The portrait matte, white for the subject, as iPhones have it in their JPEGs. */
static int put_matte(struct rf_store *store, const struct refocus_depth_map *matte,
                     struct refocus_reason *reason)
{
    struct rf_rows rows = {.width = matte->width,
                           .height = matte->height,
                           .stride = matte->width,
                           .format = RF_FORMAT_GRAY8};
    uint8_t *const samples = malloc((size_t)rows.width * (size_t)rows.height);
    uint8_t *out = samples;
    int status;

    if (!samples)
        return rf_fail_memory(reason);
    for (int32_t y = 0; y < rows.height; y++) {
        const uint8_t *const row = (const uint8_t *)matte->samples + y * matte->stride;

        for (int32_t x = 0; x < rows.width; x++) {
            const double value = matte->sample == REFOCUS_SAMPLE_U16
                                     ? ((const uint16_t *)(const void *)row)[x]
                                     : row[x];

            *out++ = (uint8_t)(fmin(255 * value / matte->value_near, 255) + 0.5);
        }
    }
    rows.top = samples;
    status = put_rows(store, &rows, true, reason);
    free(samples);
    return status;
}

static int put_gain_map(struct rf_store *store, const struct rf_gain_map *map,
                        struct refocus_reason *reason)
{
    struct rf_gain_map copy;
    struct refocus_blob jpeg = {NULL, 0};
    int status = rf_gain_copy(&copy, map);

    if (status == REFOCUS_ERR_UNSUPPORTED) {
        rf_leave_out(reason, "its original is written without the photo's HDR gain map, whose "
                             "channels differ");
        return REFOCUS_OK;
    }
    if (status != REFOCUS_OK)
        return rf_fail_memory(reason);
    status = rf_gain_write(&jpeg, &copy, reason);
    rf_store_write(store, jpeg.data, jpeg.size);
    rf_raster_free(&copy.samples);
    free(jpeg.data);
    return status;
}

/* The pixels of a photo as a JPEG, with its gain map and portrait matte behind. */
static int put_jpeg(struct rf_text *out, const struct refocus_photo *photo,
                    struct refocus_reason *reason)
{
    const struct rf_gain_map *const map = rf_photo_gain_map(photo);
    const struct rf_rows rows = rows_of(photo->image);
    struct refocus_blob jpeg = {NULL, 0};
    struct rf_store store;
    int status = rf_store_open_memory(&store, reason);

    if (status != REFOCUS_OK)
        return status;
    status = put_rows(&store, &rows, false, reason);
    if (status == REFOCUS_OK && map)
        status = put_gain_map(&store, map, reason);
    if (status == REFOCUS_OK && photo->matte->samples)
        status = put_matte(&store, photo->matte, reason);
    status = rf_store_close_memory(&store, status, &jpeg, reason);
    rf_text_put(out, jpeg.data, jpeg.size);
    free(jpeg.data);
    return status;
}

/* A JPEG goes in as it lies. HEIC becomes a JPEG, which other readers of GImage know; HEIC bytes
 * they do not; so does the original of a result that becomes a file of another kind. What lost
 * nothing so far goes on so, as a PNG. */
int rf_original_put(struct rf_text *out, const struct refocus_photo *photo, bool *is_png,
                    struct refocus_reason *reason)
{
    const struct rf_kept *const kept = rf_kept_of(photo);
    const bool is_deep = photo->deep->plane[0], is_used = photo->info->original_used;

    *is_png = false;
    if (kept->kind == RF_KEPT_JPEG && !is_used) {
        put_plain(out, (struct rf_bytes){kept->bytes.data, kept->bytes.size},
                  photo->info->orientation);
        return REFOCUS_OK;
    }
    if (strcmp(photo->info->container, "HEIC") == 0 || (is_used && !is_deep))
        return put_jpeg(out, photo, reason);
    *is_png = true;
    return put_png(out, is_deep ? photo->deep : photo->image, reason);
}
