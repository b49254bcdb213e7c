/* jpeg_write.c: a JPEG is written by TurboJPEG; EXIF and the ICC profile go in behind its JFIF
 * segment. */
#include "jpeg_write.h"

#include <limits.h>
#include <string.h>
#include <turbojpeg.h>

#include "jpeg_walk.h"
#include "reason.h"

enum {
    SEGMENT_MAX = 65533,   /* payload of a segment: 65535 less the 2 bytes of its length */
    JPEG_SIDE_MAX = 65500, /* the limit of libjpeg */
    ICC_CHUNK = SEGMENT_MAX - 14,
    DEFAULT_QUALITY = 95,
};

static void write_segment(struct rf_store *store, uint8_t marker, const char *signature,
                          size_t signature_size, const uint8_t *data, size_t size)
{
    const size_t length = signature_size + size + 2;
    const uint8_t head[4] = {0xff, marker, (uint8_t)(length >> 8), (uint8_t)length};

    rf_store_write(store, head, sizeof head);
    rf_store_write(store, signature, signature_size);
    rf_store_write(store, data, size);
}

static void write_exif(struct rf_store *store, const struct refocus_blob *exif,
                       struct refocus_reason *reason)
{
    if (!exif || !exif->data || exif->size == 0) {
        return;
    }
    if (exif->size > SEGMENT_MAX - 6) {
        rf_fail(reason, REFOCUS_OK,
                "EXIF of %zu bytes does not fit into a JPEG: left out; PNG takes it", exif->size);
        return;
    }
    write_segment(store, 0xe1, rf_jpeg_exif_signature, 6, exif->data, exif->size);
}

static void write_icc(struct rf_store *store, const struct refocus_blob *icc,
                      struct refocus_reason *reason)
{
    size_t count;

    if (!icc || !icc->data || icc->size == 0) {
        return;
    }
    count = (icc->size + ICC_CHUNK - 1) / ICC_CHUNK;
    if (count > 255) {
        rf_fail(reason, REFOCUS_OK, "ICC profile of %zu bytes does not fit into a JPEG: left out",
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
        write_segment(store, 0xe2, signature, 14, icc->data + from, size);
    }
}

static int pixel_format(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_BGR8:
        return TJPF_BGR;
    case REFOCUS_FORMAT_RGBA8:
        return TJPF_RGBX;
    case REFOCUS_FORMAT_BGRA8:
        return TJPF_BGRX;
    default:
        return TJPF_RGB;
    }
}

static int compress(tjhandle jpeg, const struct rf_rows *rows, int quality, unsigned char **bytes,
                    unsigned long *size)
{
    const bool flipped = rows->stride < 0;
    const ptrdiff_t step = flipped ? -rows->stride : rows->stride;
    const uint8_t *const first =
        flipped ? rows->top + (rows->height - 1) * rows->stride : rows->top;
    /* Chroma is halved where it does not show: 4:4:4 keeps coloured edges from 90 up.
     */
    const int sampling = quality >= 90 ? TJSAMP_444 : TJSAMP_420;

    return tjCompress2(jpeg, first, rows->width, rows->height == 1 ? 0 : (int)step, rows->height,
                       pixel_format(rows->format), bytes, size, sampling, quality,
                       TJFLAG_ACCURATEDCT | (flipped ? TJFLAG_BOTTOMUP : 0));
}

/* Our segments belong behind SOI and JFIF. */
static size_t find_insertion(const unsigned char *bytes, unsigned long size)
{
    size_t length;

    if (size < 6 || bytes[2] != 0xff || bytes[3] != 0xe0) {
        return 2;
    }
    length = 4 + ((size_t)bytes[4] << 8 | bytes[5]);
    return length <= size ? length : 2;
}

int rf_write_jpeg(struct rf_store *store, const struct rf_rows *rows,
                  const struct refocus_write_options *options, struct refocus_reason *reason)
{
    const int quality = options && options->quality ? options->quality : DEFAULT_QUALITY;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    int status = REFOCUS_OK;
    tjhandle jpeg;

    if (rows->width > JPEG_SIDE_MAX || rows->height > JPEG_SIDE_MAX) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "a JPEG has at most %d pixels a side; write a PNG", JPEG_SIDE_MAX);
    }
    if (rows->height > 1 && (rows->stride > INT_MAX || rows->stride < -INT_MAX)) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "rows lie too far apart in memory for a JPEG; write a PNG");
    }
    jpeg = tjInitCompress();
    if (!jpeg) {
        return rf_fail_memory(reason);
    }
    if (compress(jpeg, rows, quality, &bytes, &size) != 0) {
        status = rf_fail(reason, REFOCUS_ERR_MEMORY, "the JPEG encoder gave up: %s",
                         tjGetErrorStr2(jpeg));
    } else {
        const size_t split = find_insertion(bytes, size);
        rf_store_write(store, bytes, split);
        if (options) {
            write_exif(store, options->exif, reason);
            write_icc(store, options->icc, reason);
        }
        rf_store_write(store, bytes + split, size - split);
    }
    tjFree(bytes);
    tjDestroy(jpeg);
    return status;
}
