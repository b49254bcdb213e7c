/* jpeg_write.c: a JPEG is written; what else its file says goes in behind its JFIF segment, and
 * other pictures behind the main one. */
#include "jpeg_write.h"

#include <stdlib.h>
#include <string.h>

#include "exif.h"
#include "jpeg_behind.h"
#include "jpeg_encode.h"
#include "jpeg_keep.h"
#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "reason.h"

enum {
    ICC_CHUNK = RF_JPEG_SEGMENT_MAX - 14,
    DEFAULT_QUALITY = 95,
};

static int write_exif(struct rf_store *store, const struct refocus_blob *exif,
                      const struct rf_rows *rows, struct refocus_reason *reason)
{
    uint8_t *own;

    if (!exif || !exif->data || exif->size == 0)
        return REFOCUS_OK;
    if (exif->size > RF_JPEG_SEGMENT_MAX - 6) {
        rf_leave_out(reason, "EXIF of %zu bytes does not fit into a JPEG: left out; PNG takes it",
                     exif->size);
        return REFOCUS_OK;
    }
    own = malloc(exif->size);
    if (!own)
        return rf_fail_memory(reason);
    memcpy(own, exif->data, exif->size);
    rf_exif_set_size(own, exif->size, (uint32_t)rows->width, (uint32_t)rows->height);
    rf_jpeg_put_segment(store, RF_JPEG_APP1, rf_jpeg_exif_signature, 6, own, exif->size);
    free(own);
    return REFOCUS_OK;
}

static void write_icc(struct rf_store *store, const struct refocus_blob *icc,
                      struct refocus_reason *reason)
{
    size_t count;

    if (!icc || !icc->data || icc->size == 0)
        return;
    count = (icc->size + ICC_CHUNK - 1) / ICC_CHUNK;
    if (count > 255) {
        rf_leave_out(reason, "ICC profile of %zu bytes does not fit into a JPEG: left out",
                     icc->size);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const size_t from = i * ICC_CHUNK;
        const size_t size = icc->size - from < ICC_CHUNK ? icc->size - from : ICC_CHUNK;
        char signature[14];

        memcpy(signature, rf_jpeg_icc_signature, 12);
        signature[12] = (char)(uint8_t)(i + 1);
        signature[13] = (char)(uint8_t)count;
        rf_jpeg_put_segment(store, RF_JPEG_APP2, signature, 14, icc->data + from, size);
    }
}

int rf_write_jpeg(struct rf_store *store, const struct rf_rows *rows,
                  const struct refocus_write_options *options, struct refocus_reason *reason)
{
    const int quality = options && options->quality ? options->quality : DEFAULT_QUALITY;
    struct rf_behind behind = {.count = 0};
    struct rf_jpeg_encoded jpeg;
    int status = rf_jpeg_encode(&jpeg, rows, quality, reason);

    if (options && status == REFOCUS_OK)
        status = rf_behind_make(&behind, rows, options, reason);
    if (options && status == REFOCUS_OK)
        rf_jpeg_keep_density(options, jpeg.bytes, jpeg.split);
    if (status == REFOCUS_OK)
        rf_store_write(store, jpeg.bytes, jpeg.split);
    if (options && status == REFOCUS_OK)
        status = write_exif(store, options->exif, rows, reason);
    if (options && status == REFOCUS_OK) {
        status = rf_jpeg_put_kept(store, options, rows, &behind, reason);
        write_icc(store, options->icc, reason);
        rf_behind_put_index(store, &behind, jpeg.size - jpeg.split);
    }
    if (status == REFOCUS_OK) {
        rf_store_write(store, jpeg.bytes + jpeg.split, jpeg.size - jpeg.split);
        rf_behind_put(store, &behind);
    }
    rf_behind_free(&behind);
    rf_jpeg_encoded_free(&jpeg);
    return status;
}
