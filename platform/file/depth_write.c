/* depth_write.c: depth is put into a JPEG that exists, as GDepth in a standard and an extended XMP
 * packet of our own, in front of the first segment that is neither JFIF nor EXIF. All other bytes
 * stay. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <refocus/platform/file.h>

#include "formats.h"
#include "jpeg_walk.h"
#include "load.h"
#include "md5.h"
#include "orient.h"
#include "own_xmp.h"
#include "reason.h"
#include "rows.h"
#include "store.h"

enum { MARKER_APP0 = 0xe0, MARKER_APP1 = 0xe1, CHUNK = 65000 };

#define RDF                                                                                        \
    "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"                          \
    "<rdf:Description rdf:about=\"\""
#define CLOSING "/></rdf:RDF></x:xmpmeta>"
#define GDEPTH  " xmlns:GDepth=\"http://ns.google.com/photos/1.0/depthmap/\""
#define GFOCUS  " xmlns:GFocus=\"http://ns.google.com/photos/1.0/focus/\""
#define NOTE                                                                                       \
    " xmlns:xmpNote=\"http://ns.adobe.com/xmp/note/\" "                                            \
    "xmpNote:HasExtendedXMP=\""

/* A text that grows; it has failed once memory ran out. */
struct text {
    char *data;
    size_t size, room;
    bool failed;
};

static void put(struct text *text, const char *words, size_t size)
{
    if (text->room - text->size < size && !text->failed) {
        const size_t room = text->room + size + text->room / 2;
        char *const data = realloc(text->data, room);

        text->failed = !data;
        if (data) {
            text->data = data;
            text->room = room;
        }
    }
    if (!text->failed) {
        memcpy(text->data + text->size, words, size);
        text->size += size;
    }
}

static void put_words(struct text *text, const char *words)
{
    put(text, words, strlen(words));
}

/* With 12 digits a reader that is off in the last bits writes the same ones again. The locale's
 * decimal point becomes a dot. */
static void put_number(struct text *text, const char *name, double value)
{
    char number[64];

    snprintf(number, sizeof number, "%.12g", value);
    for (char *c = number; *c; c++) {
        if (*c != '-' && *c != '+' && *c != 'e' && (*c < '0' || *c > '9')) {
            *c = '.';
        }
    }
    put_words(text, name);
    put_words(text, "=\"");
    put_words(text, number);
    put_words(text, "\"");
}

static void put_base64(struct text *text, struct rf_bytes bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

    for (size_t i = 0; i < bytes.size; i += 3) {
        const size_t n = bytes.size - i < 3 ? bytes.size - i : 3;
        const uint8_t *const b = bytes.data + i;
        const uint32_t bits =
            (uint32_t)b[0] << 16 | (n > 1 ? (uint32_t)b[1] << 8 : 0) | (n > 2 ? b[2] : 0);
        const char four[4] = {digits[bits >> 18], digits[bits >> 12 & 63],
                              n > 1 ? digits[bits >> 6 & 63] : '=',
                              n > 2 ? digits[bits & 63] : '='};

        put(text, four, 4);
    }
}

/* Write a PNG in the meaning RangeInverse: 0 is near, 65535 far, turned as the JPEG's pixels lie.
 */
static int encode(const struct rf_format *format, const struct refocus_depth_write *depth,
                  int orientation, struct refocus_blob *png, struct refocus_reason *reason)
{
    struct rf_read read = {.reason = reason};
    struct rf_raster raster = {.width = depth->width,
                               .height = depth->height,
                               .channels = 1,
                               .sample = REFOCUS_SAMPLE_U16,
                               .max_value = 65535};
    struct rf_store store = {NULL, NULL, NULL, 0, false};
    struct rf_rows rows = {.format = REFOCUS_FORMAT_NONE};
    char *bytes = NULL;
    size_t size = 0;
    int status;

    read.limits.max_pixels = read.limits.max_bytes = UINT64_MAX / 16;
    status = rf_raster_alloc(&read, &raster);
    if (status != REFOCUS_OK) {
        return status;
    }
    for (int32_t y = 0; y < depth->height; y++) {
        const uint16_t *const in =
            (const uint16_t *)((const char *)depth->disparity + y * depth->stride);
        uint16_t *const out = (uint16_t *)raster.pixels + (size_t)y * (size_t)depth->width;

        for (int32_t x = 0; x < depth->width; x++) {
            out[x] = (uint16_t)(65535 - in[x]);
        }
    }
    status = rf_raster_orient(&read, &raster, rf_orient_inverse(orientation));
    if (status == REFOCUS_OK) {
        store.stream = open_memstream(&bytes, &size);
        status = store.stream ? REFOCUS_OK : rf_fail_memory(reason);
    }
    if (status == REFOCUS_OK) {
        rows.top = raster.pixels;
        rows.width = raster.width;
        rows.height = raster.height;
        rows.stride = (ptrdiff_t)rf_raster_stride(&raster);
        status = format->write(&store, &rows, NULL, reason);
        if (fclose(store.stream) != 0 || store.error) {
            status = status == REFOCUS_OK ? rf_fail_memory(reason) : status;
        }
    }
    rf_raster_free(&raster);
    if (status != REFOCUS_OK) {
        free(bytes);
        return status;
    }
    png->data = (uint8_t *)bytes;
    png->size = size;
    return REFOCUS_OK;
}

static void make_standard(struct text *text, const struct refocus_depth_write *depth,
                          int orientation, const char *guid)
{
    put_words(text, RF_XMP_OPENING RDF GDEPTH NOTE);
    put_words(text, guid);
    put_words(text, "\" GDepth:Format=\"RangeInverse\" GDepth:Mime=\"image/png\"");
    if (depth->near_m > 0 && depth->far_m > depth->near_m) {
        put_number(text, " GDepth:Near", depth->near_m);
        /* Far has to be a number; farther than this no blur can be told from
         * infinity. */
        put_number(text, " GDepth:Far", isfinite(depth->far_m) ? depth->far_m : 1e9);
        put_words(text, " GDepth:Units=\"m\"");
    }
    if (depth->focus_x >= 0 && depth->focus_y >= 0) {
        double x = depth->focus_x, y = depth->focus_y;

        rf_orient_point(&x, &y, rf_orient_inverse(orientation));
        put_words(text, GFOCUS);
        put_number(text, " GFocus:FocalPointX", x);
        put_number(text, " GFocus:FocalPointY", y);
        if (depth->focus_distance > 0 && isfinite(depth->focus_distance)) {
            put_number(text, " GFocus:FocalDistance", depth->focus_distance);
        }
        if (depth->blur_at_infinity > 0) {
            put_number(text, " GFocus:BlurAtInfinity", depth->blur_at_infinity);
        }
    }
    put_words(text, CLOSING);
}

static void put_segment(struct rf_store *store, const void *head, size_t head_size,
                        const void *body, size_t size)
{
    const size_t length = head_size + size + 2;
    const uint8_t marker[4] = {0xff, MARKER_APP1, (uint8_t)(length >> 8), (uint8_t)length};

    rf_store_write(store, marker, sizeof marker);
    rf_store_write(store, head, head_size);
    rf_store_write(store, body, size);
}

static void put_packets(struct rf_store *store, const struct text *standard,
                        const struct text *extended, const char *guid)
{
    uint8_t head[sizeof rf_jpeg_extended_signature + 40];
    uint8_t *const numbers = head + sizeof rf_jpeg_extended_signature + 32;

    put_segment(store, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature, standard->data,
                standard->size);
    memcpy(head, rf_jpeg_extended_signature, sizeof rf_jpeg_extended_signature);
    memcpy(head + sizeof rf_jpeg_extended_signature, guid, 32);
    for (size_t at = 0; at < extended->size; at += CHUNK) {
        const size_t n = extended->size - at < CHUNK ? extended->size - at : CHUNK;

        for (int i = 0; i < 4; i++) {
            numbers[i] = (uint8_t)(extended->size >> (24 - 8 * i));
            numbers[4 + i] = (uint8_t)(at >> (24 - 8 * i));
        }
        put_segment(store, head, sizeof head, extended->data + at, n);
    }
}

/* Whether a segment is of a packet that an earlier writing left; its GUID comes
 * first. */
static bool is_old(struct rf_bytes segment, char guid[33])
{
    const size_t before = sizeof(RF_XMP_OPENING RDF GDEPTH NOTE) - 1;
    struct rf_bytes rest;

    if (rf_jpeg_after(segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature, &rest) &&
        rf_xmp_is_ours(rest)) {
        if (rest.size >= before + 32) {
            memcpy(guid, rest.data + before, 32);
        }
        return true;
    }
    return guid[0] &&
           rf_jpeg_after(segment, rf_jpeg_extended_signature, sizeof rf_jpeg_extended_signature,
                         &rest) &&
           rest.size >= 32 && memcmp(rest.data, guid, 32) == 0;
}

/* Copy the original and put the packets in. */
static int splice(struct rf_store *store, struct rf_bytes file, const struct text *standard,
                  const struct text *extended, const char *guid, struct refocus_reason *reason)
{
    struct rf_jpeg_walk walk;
    enum rf_jpeg_step step;
    char old[33] = "";
    size_t copied = 0;
    bool placed = false;

    if (!rf_jpeg_walk_begin(&walk, file)) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "depth is saved into JPEG photos; the photo is none");
    }
    while ((step = rf_jpeg_walk_next(&walk)) == RF_JPEG_SEGMENT) {
        const size_t begin = (size_t)(walk.segment.data - file.data) - 4;
        struct rf_bytes rest;
        const bool head = walk.marker == MARKER_APP0 ||
                          (walk.marker == MARKER_APP1 &&
                           rf_jpeg_after(walk.segment, rf_jpeg_exif_signature, 6, &rest));
        const bool skip = walk.marker == MARKER_APP1 && is_old(walk.segment, old);

        if ((!head && !placed) || skip) {
            rf_store_write(store, file.data + copied, begin - copied);
            copied = begin;
        }
        if (!head && !placed) {
            put_packets(store, standard, extended, guid);
            placed = true;
        }
        if (skip) {
            copied = walk.position;
        }
    }
    if (step != RF_JPEG_END || !placed) {
        return rf_fail(reason, REFOCUS_ERR_FORMAT,
                       "damaged JPEG: it ends in the middle of the picture; copy it "
                       "again");
    }
    rf_store_write(store, file.data + copied, file.size - copied);
    return REFOCUS_OK;
}

static bool good(const struct refocus_depth_write *depth)
{
    return depth->disparity && depth->width >= 1 && depth->width <= REFOCUS_MAX_SIDE &&
           depth->height >= 1 && depth->height <= REFOCUS_MAX_SIDE && depth->stride % 2 == 0 &&
           rf_good_rows(depth->stride, 2 * (int64_t)depth->width, depth->height) &&
           depth->focus_x <= 1 && depth->focus_y <= 1 && isfinite(depth->near_m) &&
           !isnan(depth->far_m) && !isnan(depth->focus_distance) &&
           isfinite(depth->blur_at_infinity);
}

static int write_all(const char *path, struct rf_bytes file, int orientation,
                     const struct rf_format *png_format, const struct refocus_depth_write *depth,
                     struct refocus_reason *reason)
{
    struct text standard = {NULL, 0, 0, false}, extended = {NULL, 0, 0, false};
    struct refocus_blob png = {NULL, 0};
    struct rf_store store;
    char guid[33];
    int status = encode(png_format, depth, orientation, &png, reason);

    if (status != REFOCUS_OK) {
        return status;
    }
    put_words(&extended, RF_XMP_OPENING RDF GDEPTH " GDepth:Data=\"");
    put_base64(&extended, (struct rf_bytes){png.data, png.size});
    put_words(&extended, "\"" CLOSING);
    free(png.data);
    if (!extended.failed) {
        rf_md5_hex((struct rf_bytes){(const uint8_t *)extended.data, extended.size}, guid);
        make_standard(&standard, depth, orientation, guid);
    }
    if (standard.failed || extended.failed) {
        status = rf_fail_memory(reason);
    } else if (extended.size > UINT32_MAX) {
        status = rf_fail(reason, REFOCUS_ERR_SIZE, "the depth is too large for XMP");
    }
    if (status == REFOCUS_OK) {
        status = rf_store_open(&store, path, reason);
        if (status == REFOCUS_OK) {
            status = splice(&store, file, &standard, &extended, guid, reason);
            status = rf_store_close(&store, status, reason);
        }
    }
    free(standard.data);
    free(extended.data);
    return status;
}

int refocus_photo_write_depth(const char *path, const char *original,
                              const struct refocus_depth_write *depth,
                              struct refocus_reason *reason)
{
    const struct rf_format *const jpeg = rf_format_of_name(".jpg"), *const png =
                                                                        rf_format_of_name(".png");
    struct refocus_reason unused;
    struct refocus_photo *photo = NULL;
    struct refocus_blob file = {NULL, 0};
    struct refocus_depth_write own;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if ((status = refocus_struct_read(&own, sizeof own,
                                      REFOCUS_SIZE_TO(struct refocus_depth_write, blur_at_infinity),
                                      depth)))
        return rf_fail(reason, status, "the depth is not of a known size of struct");
    depth = &own;
    if (!path || !original || !good(depth)) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "the depth is out of its range");
    }
    if (!jpeg->read || !png->write) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "depth in JPEG needs TurboJPEG and libpng, which this build lacks");
    }
    status = rf_load(original, UINT32_MAX, reason, &file);
    if (status != REFOCUS_OK) {
        return status;
    }
    /* Read as a whole: no depth goes into what cannot be opened again. */
    status = refocus_photo_read_memory(&photo, file.data, file.size, NULL, reason);
    if (status == REFOCUS_OK) {
        status = write_all(path, (struct rf_bytes){file.data, file.size}, photo->info->orientation,
                           png, depth, reason);
    }
    refocus_photo_free(&photo);
    free(file.data);
    return status;
}
