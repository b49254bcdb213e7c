/* tiff_write.c: a picture of 8 or 16 bits a channel, or depth in 16-bit grey, becomes a TIFF,
 * deflated without loss, which libtiff writes into memory. */
#include "tiff.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

#include "exif_copy.h"
#include "reason.h"

struct writer {
    struct refocus_blob *file;
    size_t position, room;
};

static bool grow(struct writer *writer, size_t size)
{
    size_t room = writer->room > 0 ? writer->room : 65536;
    uint8_t *grown;

    while (room < size && room <= SIZE_MAX / 2)
        room *= 2;
    if (room < size)
        return false;
    if (room > writer->room) {
        grown = realloc(writer->file->data, room);
        if (!grown)
            return false;
        writer->file->data = grown;
        writer->room = room;
    }
    if (size > writer->file->size) {
        memset(writer->file->data + writer->file->size, 0, size - writer->file->size);
        writer->file->size = size;
    }
    return true;
}

static tmsize_t on_write(thandle_t handle, void *from, tmsize_t size)
{
    struct writer *const writer = handle;

    if (size < 0 || !grow(writer, writer->position + (size_t)size))
        return -1;
    memcpy(writer->file->data + writer->position, from, (size_t)size);
    writer->position += (size_t)size;
    return size;
}

static tmsize_t on_read(thandle_t handle, void *to, tmsize_t size)
{
    struct writer *const writer = handle;
    const size_t end = writer->file->size;
    const size_t left = writer->position < end ? end - writer->position : 0;
    const size_t n = (size_t)size < left ? (size_t)size : left;

    if (n > 0) {
        memcpy(to, writer->file->data + writer->position, n);
        writer->position += n;
    }
    return (tmsize_t)n;
}

static toff_t on_seek(thandle_t handle, toff_t offset, int whence)
{
    struct writer *const writer = handle;

    writer->position = (size_t)(whence == SEEK_SET   ? offset
                                : whence == SEEK_CUR ? writer->position + offset
                                                     : writer->file->size + offset);
    return writer->position;
}

static int on_close(thandle_t handle)
{
    (void)handle;
    return 0;
}

static toff_t on_size(thandle_t handle)
{
    return ((const struct writer *)handle)->file->size;
}

static int on_words(TIFF *tiff, void *user, const char *module, const char *words, va_list list)
{
    (void)tiff;
    (void)user;
    (void)module;
    (void)words;
    (void)list;
    return 1;
}

/* A row as TIFF stores it: grey, or R, G, B and perhaps alpha. */
static void store_row(uint8_t *to, const struct rf_rows *rows, const uint8_t *from)
{
    const int bytes = rf_format_bytes(rows->format);
    const bool swapped =
        rows->format == REFOCUS_FORMAT_BGR8 || rows->format == REFOCUS_FORMAT_BGRA8;

    memcpy(to, from, (size_t)rows->width * (size_t)(bytes > 0 ? bytes : 2));
    for (int32_t x = 0; swapped && x < rows->width; x++) {
        const uint8_t first = to[(size_t)x * (size_t)bytes];

        to[(size_t)x * (size_t)bytes] = to[(size_t)x * (size_t)bytes + 2];
        to[(size_t)x * (size_t)bytes + 2] = first;
    }
}

/* Put the camera's settings and the place, each a directory of its own, behind the header, and a
 * few texts of the main directory into that of the picture. */
static bool put_exif(TIFF *tiff, struct writer *writer, const struct refocus_blob *exif)
{
    static const struct {
        uint32_t from, to;
    } directories[] = {{0x8769, TIFFTAG_EXIFIFD}, {0x8825, TIFFTAG_GPSIFD}};
    static const uint32_t texts[] = {TIFFTAG_IMAGEDESCRIPTION, TIFFTAG_MAKE,     TIFFTAG_MODEL,
                                     TIFFTAG_SOFTWARE,         TIFFTAG_DATETIME, TIFFTAG_ARTIST,
                                     TIFFTAG_COPYRIGHT};
    const struct rf_bytes block = {exif->data, exif->size};
    uint8_t *const copy = malloc(RF_EXIF_COPY_ROOM);
    bool good = copy != NULL;

    for (int i = 0; good && i < 2; i++) {
        const size_t base = writer->file->size + (writer->file->size & 1);
        const size_t size = rf_exif_directory(block, directories[i].from, (uint32_t)base, copy);

        if (size > 0) {
            good =
                grow(writer, base + size) && TIFFSetField(tiff, directories[i].to, (uint64_t)base);
            if (good)
                memcpy(writer->file->data + base, copy, size);
        }
    }
    for (size_t i = 0; good && i < sizeof texts / sizeof *texts; i++)
        if (rf_exif_text(block, texts[i], (char *)copy, 1024))
            good = TIFFSetField(tiff, texts[i], (const char *)copy);
    free(copy);
    return good;
}

static bool put(TIFF *tiff, const struct rf_rows *rows, const struct rf_extras *extras,
                uint8_t *row)
{
    const bool grey = rows->format == REFOCUS_FORMAT_NONE;
    const bool alpha = rows->format == REFOCUS_FORMAT_RGBA8 || rows->format == REFOCUS_FORMAT_BGRA8;
    const uint16_t kind = EXTRASAMPLE_UNASSALPHA;
    bool good = true;

    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, (uint32_t)rows->width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, (uint32_t)rows->height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE,
                 grey || rows->format == REFOCUS_FORMAT_RGB16 ? 16 : 8);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, grey ? 1 : alpha ? 4 : 3);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, grey ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
    if (alpha)
        TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
    if (extras->icc.size > 0 && extras->icc.data)
        good = TIFFSetField(tiff, TIFFTAG_ICCPROFILE, (uint32_t)extras->icc.size, extras->icc.data);
    if (extras->xmp.size > 0 && extras->xmp.data)
        good &= TIFFSetField(tiff, TIFFTAG_XMLPACKET, (uint32_t)extras->xmp.size, extras->xmp.data);
    for (int32_t y = 0; good && y < rows->height; y++) {
        store_row(row, rows, rows->top + y * rows->stride);
        good = TIFFWriteScanline(tiff, row, (uint32_t)y, 0) == 1;
    }
    return good && TIFFFlush(tiff);
}

int rf_tiff_write(struct refocus_blob *file, const struct rf_rows *rows,
                  const struct rf_extras *extras, struct refocus_reason *reason)
{
    struct writer writer = {.file = file};
    TIFFOpenOptions *const options = TIFFOpenOptionsAlloc();
    /* Above this BigTIFF is for certain never needed: offsets have 32 bits. */
    const bool big = (uint64_t)rows->width * (uint64_t)rows->height > UINT32_MAX / 10;
    /* The order of bytes is that of EXIF, whose directories are copied as they are. */
    const bool exif = extras->exif.data && extras->exif.size > 0 && !big;
    const char *const mode = big                                   ? "w8"
                             : exif && extras->exif.data[0] == 'M' ? "wb"
                             : exif                                ? "wl"
                                                                   : "w";
    uint8_t *const row = malloc((size_t)rows->width * 6);
    TIFF *tiff = NULL;
    bool good = false;

    if (options && row) {
        TIFFOpenOptionsSetErrorHandlerExtR(options, on_words, NULL);
        TIFFOpenOptionsSetWarningHandlerExtR(options, on_words, NULL);
        tiff = TIFFClientOpenExt("photo", mode, &writer, on_read, on_write, on_seek, on_close,
                                 on_size, NULL, NULL, options);
    }
    if (options)
        TIFFOpenOptionsFree(options);
    if (tiff) {
        good = (!exif || put_exif(tiff, &writer, &extras->exif)) && put(tiff, rows, extras, row);
        TIFFClose(tiff);
    }
    free(row);
    if (!good)
        return rf_fail(reason, REFOCUS_ERR_MEMORY, "not enough memory to make a TIFF");
    if (big && extras->exif.size > 0)
        rf_leave_out(reason, "EXIF is not written into a TIFF of more than 4 GiB");
    else if (exif &&
             rf_exif_has_maker_note((struct rf_bytes){extras->exif.data, extras->exif.size}))
        rf_leave_out(reason, "the maker's note of EXIF is not written into a TIFF");
    return REFOCUS_OK;
}

__attribute__((visibility("default"))) extern const struct rf_codec rf_codec_tiff;
const struct rf_codec rf_codec_tiff = {
    .version = RF_CODEC_VERSION, .read = rf_tiff_read, .write = rf_tiff_write};
