/* tiff_read.c: a TIFF is read by libtiff: samples of 8 and 16 bits as they are, floats as linear
 * light or depth; palettes, few bits, YCbCr and CMYK by libtiff's own way to 8-bit RGB. */
#include "tiff.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

#include "half.h"
#include "reason.h"

struct reader {
    struct rf_read *read;
    struct rf_bytes file;
    toff_t position;
    TIFF *tiff;
    char error[160]; /* libtiff's first words */
    uint32_t width, height;
    uint16_t bits, channels, format, photometric, planar;
};

static tmsize_t on_read(thandle_t handle, void *to, tmsize_t size)
{
    struct reader *const reader = handle;
    const uint64_t left =
        reader->position < reader->file.size ? reader->file.size - reader->position : 0;
    const tmsize_t n = (uint64_t)size < left ? size : (tmsize_t)left;

    if (n > 0) {
        memcpy(to, reader->file.data + reader->position, (size_t)n);
        reader->position += (toff_t)n;
    }
    return n;
}

static tmsize_t on_write(thandle_t handle, void *from, tmsize_t size)
{
    (void)handle;
    (void)from;
    (void)size;
    return -1;
}

static toff_t on_seek(thandle_t handle, toff_t offset, int whence)
{
    struct reader *const reader = handle;

    reader->position = whence == SEEK_SET   ? offset
                       : whence == SEEK_CUR ? reader->position + offset
                                            : reader->file.size + offset;
    return reader->position;
}

static int on_close(thandle_t handle)
{
    (void)handle;
    return 0;
}

static toff_t on_size(thandle_t handle)
{
    return ((const struct reader *)handle)->file.size;
}

/* Mapped, the file is not copied strip by strip. */
static int on_map(thandle_t handle, void **base, toff_t *size)
{
    const struct reader *const reader = handle;

    *base = (void *)(uintptr_t)reader->file.data;
    *size = reader->file.size;
    return 1;
}

static void on_unmap(thandle_t handle, void *base, toff_t size)
{
    (void)handle;
    (void)base;
    (void)size;
}

static int on_error(TIFF *tiff, void *user, const char *module, const char *words, va_list list)
{
    struct reader *const reader = user;

    (void)tiff;
    (void)module;
    if (!reader->error[0])
        vsnprintf(reader->error, sizeof reader->error, words, list);
    return 1;
}

static int on_warning(TIFF *tiff, void *user, const char *module, const char *words, va_list list)
{
    (void)tiff;
    (void)user;
    (void)module;
    (void)words;
    (void)list;
    return 1;
}

static int fail_damaged(const struct reader *reader)
{
    return rf_fail(reader->read->reason, REFOCUS_ERR_FORMAT, "damaged TIFF: %s",
                   reader->error[0] ? reader->error : "it ends too early; copy it again");
}

/* Place a row of samples of one plane, or of all of them side by side. */
static void put(const struct reader *reader, struct rf_raster *raster, const uint8_t *from,
                uint32_t x, uint32_t y, uint32_t n, int plane)
{
    const bool apart = reader->planar == PLANARCONFIG_SEPARATE;
    const size_t step = apart ? 1 : reader->channels, channels = (size_t)raster->channels;
    /* Three channels of one are alike. */
    const size_t grey = reader->channels < 3 && channels == 3 ? 0 : 1;
    const bool inverted = reader->photometric == PHOTOMETRIC_MINISWHITE;
    const size_t at = ((size_t)y * (size_t)raster->width + x) * channels;

    for (size_t i = 0; i < n; i++) {
        for (size_t c = 0; c < channels; c++) {
            const size_t s = i * step + (apart ? 0 : c * grey);
            const size_t to = at + i * channels + c;

            if (apart && grey && c != (size_t)plane)
                continue;
            if (raster->sample == REFOCUS_SAMPLE_U8) {
                raster->pixels[to] = inverted ? (uint8_t)~from[s] : from[s];
            } else if (raster->sample == REFOCUS_SAMPLE_U16) {
                uint16_t value;
                memcpy(&value, from + 2 * s, 2);
                ((uint16_t *)(void *)raster->pixels)[to] = inverted ? (uint16_t)~value : value;
            } else if (reader->bits == 32) {
                memcpy(raster->pixels + 4 * to, from + 4 * s, 4);
            } else {
                uint16_t value;
                float light;
                memcpy(&value, from + 2 * s, 2);
                light = value & 0x8000 ? -rf_half_value(value & 0x7fff) : rf_half_value(value);
                memcpy(raster->pixels + 4 * to, &light, 4);
            }
        }
    }
}

/* Read all strips, or all tiles. */
static int read_blocks(struct reader *reader, struct rf_raster *raster)
{
    const bool tiled = TIFFIsTiled(reader->tiff);
    const uint64_t bytes = tiled ? TIFFTileSize64(reader->tiff) : TIFFStripSize64(reader->tiff);
    const uint64_t row = tiled ? TIFFTileRowSize64(reader->tiff) : TIFFScanlineSize64(reader->tiff);
    const bool apart = reader->planar == PLANARCONFIG_SEPARATE;
    const int planes = apart && reader->channels >= 3 ? 3 : 1;
    uint32_t wide = reader->width, high = reader->height;
    uint8_t *block;
    int status = rf_check_memory(reader->read, 2 * bytes);

    TIFFGetField(reader->tiff, tiled ? TIFFTAG_TILELENGTH : TIFFTAG_ROWSPERSTRIP, &high);
    if (tiled)
        TIFFGetField(reader->tiff, TIFFTAG_TILEWIDTH, &wide);
    if (status == REFOCUS_OK)
        status = rf_check_bytes(reader->read, bytes, "a block of it");
    if (status != REFOCUS_OK)
        return status;
    if (bytes == 0 || wide == 0 || high == 0 ||
        row < ((uint64_t)wide * (apart ? 1 : reader->channels) * reader->bits + 7) / 8)
        return fail_damaged(reader);
    block = malloc((size_t)bytes);
    if (!block)
        return rf_fail_memory(reader->read->reason);
    high = high < reader->height ? high : reader->height;
    for (int plane = 0; status == REFOCUS_OK && plane < planes; plane++) {
        for (uint64_t y = 0; status == REFOCUS_OK && y < reader->height; y += high) {
            for (uint64_t x = 0; status == REFOCUS_OK && x < reader->width; x += wide) {
                const uint32_t left = reader->width - (uint32_t)x;
                const uint32_t below = reader->height - (uint32_t)y;
                const uint32_t rows = below < high ? below : high;
                const tmsize_t wanted = (tmsize_t)(row * rows);
                const tmsize_t got =
                    tiled ? TIFFReadTile(reader->tiff, block, (uint32_t)x, (uint32_t)y, 0,
                                         (uint16_t)plane)
                          : TIFFReadEncodedStrip(
                                reader->tiff,
                                TIFFComputeStrip(reader->tiff, (uint32_t)y, (uint16_t)plane), block,
                                wanted);

                if (got < wanted)
                    status = fail_damaged(reader);
                for (uint32_t i = 0; status == REFOCUS_OK && i < rows; i++) {
                    put(reader, raster, block + (size_t)row * i, (uint32_t)x, (uint32_t)y + i,
                        left < wide ? left : wide, plane);
                }
            }
        }
    }
    free(block);
    return status;
}

/* Palettes and colour spaces that libtiff turns into RGB of 8 bits. */
static int read_rgba(struct reader *reader, struct rf_raster *raster)
{
    const uint64_t pixels = (uint64_t)reader->width * reader->height;
    char why[1024] = "";
    uint16_t orientation = ORIENTATION_TOPLEFT;
    uint32_t *rgba;
    int status;

    if (!TIFFRGBAImageOK(reader->tiff, why)) {
        why[150] = '\0';
        return rf_fail(reader->read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "TIFF of a kind that is not read: %s", why);
    }
    raster->channels = 3;
    status = rf_raster_alloc(reader->read, raster);
    if (status == REFOCUS_OK)
        status = rf_check_memory(reader->read, 8 * pixels);
    if (status != REFOCUS_OK)
        return status;
    rgba = malloc((size_t)pixels * 4);
    if (!rgba)
        return rf_fail_memory(reader->read->reason);
    /* In the orientation of the file libtiff turns nothing: it mirrors for others, and never turns
     * a picture onto its side. */
    TIFFGetFieldDefaulted(reader->tiff, TIFFTAG_ORIENTATION, &orientation);
    if (!TIFFReadRGBAImageOriented(reader->tiff, reader->width, reader->height, rgba, orientation,
                                   1))
        status = fail_damaged(reader);
    for (uint64_t i = 0; status == REFOCUS_OK && i < pixels; i++) {
        raster->pixels[3 * i] = (uint8_t)TIFFGetR(rgba[i]);
        raster->pixels[3 * i + 1] = (uint8_t)TIFFGetG(rgba[i]);
        raster->pixels[3 * i + 2] = (uint8_t)TIFFGetB(rgba[i]);
    }
    free(rgba);
    return status;
}

/* Whether the channel behind the colour is transparency, which is of use. */
static bool has_alpha(const struct reader *reader)
{
    uint16_t count = 0, *kinds = NULL;

    return rf_wants_alpha(reader->read) && reader->planar == PLANARCONFIG_CONTIG &&
           reader->photometric != PHOTOMETRIC_MINISWHITE &&
           TIFFGetField(reader->tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds) && count > 0 &&
           (kinds[0] == EXTRASAMPLE_ASSOCALPHA || kinds[0] == EXTRASAMPLE_UNASSALPHA);
}

static int read_samples(struct reader *reader)
{
    struct rf_read *const read = reader->read;
    const bool floats = reader->format == SAMPLEFORMAT_IEEEFP;
    const bool grey = reader->channels < 3;
    const bool depth = floats && grey && !read->picture_always;
    const bool alpha = !floats && has_alpha(reader);
    struct rf_raster *const raster = depth ? &read->samples : &read->image;
    int status;

    raster->width = (int32_t)reader->width;
    raster->height = (int32_t)reader->height;
    raster->channels = (!grey || (floats && !depth) ? 3 : 1) + alpha;
    raster->sample = floats               ? REFOCUS_SAMPLE_F32
                     : reader->bits == 16 ? REFOCUS_SAMPLE_U16
                                          : REFOCUS_SAMPLE_U8;
    raster->max_value = floats ? 0 : reader->bits == 16 ? 65535 : 255;
    status = rf_raster_alloc(read, raster);
    if (status == REFOCUS_OK)
        status = read_blocks(reader, raster);
    if (status == REFOCUS_OK && alpha)
        status = rf_part_alpha(read);
    if (status == REFOCUS_OK && reader->channels != (grey ? 1 : 3) && !read->holes.pixels)
        rf_note(read->info, "TIFF: channels beyond its colour, as of transparency, are dropped");
    if (status == REFOCUS_OK && floats) {
        rf_note(read->info, "TIFF: floats of %d bits, %s", reader->bits,
                depth ? "a depth map" : "linear light");
    }
    return status;
}

static int copy(const struct rf_read *read, struct refocus_blob *blob, const void *data,
                uint32_t size)
{
    int status = rf_check_metadata(read, size, "a block of it");

    if (status != REFOCUS_OK || size == 0)
        return status;
    blob->data = malloc(size);
    if (!blob->data)
        return rf_fail_memory(read->reason);
    memcpy(blob->data, data, size);
    blob->size = size;
    return REFOCUS_OK;
}

static int read_extras(struct reader *reader, struct rf_extras *extras)
{
    uint16_t orientation = 1;
    uint32_t size = 0;
    void *data = NULL;
    int status = REFOCUS_OK;

    if (TIFFGetField(reader->tiff, TIFFTAG_ICCPROFILE, &size, &data))
        status = copy(reader->read, &extras->icc, data, size);
    if (status == REFOCUS_OK && TIFFGetField(reader->tiff, TIFFTAG_XMLPACKET, &size, &data))
        status = copy(reader->read, &extras->xmp, data, size);
    if (TIFFGetField(reader->tiff, TIFFTAG_ORIENTATION, &orientation) && orientation >= 1 &&
        orientation <= 8)
        reader->read->orientation = orientation;
    return status;
}

static bool is_plain(const struct reader *reader)
{
    const bool colour = reader->photometric == PHOTOMETRIC_RGB && reader->channels >= 3;
    const bool grey = (reader->photometric == PHOTOMETRIC_MINISBLACK ||
                       reader->photometric == PHOTOMETRIC_MINISWHITE) &&
                      reader->channels >= 1 && reader->channels <= 2;
    const bool integers =
        reader->format == SAMPLEFORMAT_UINT && (reader->bits == 8 || reader->bits == 16);
    const bool floats = reader->format == SAMPLEFORMAT_IEEEFP &&
                        (reader->bits == 16 || reader->bits == 32) &&
                        reader->photometric != PHOTOMETRIC_MINISWHITE;

    return (colour || grey) && (integers || floats);
}

static int run(struct reader *reader, struct rf_extras *extras)
{
    TIFF *const tiff = reader->tiff;
    int status;

    if (!TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &reader->width) ||
        !TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &reader->height) ||
        !TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &reader->photometric))
        return fail_damaged(reader);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &reader->bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &reader->channels);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &reader->format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &reader->planar);
    status = rf_check_size(reader->read, reader->width, reader->height, 3);
    if (status == REFOCUS_OK)
        status = read_extras(reader, extras);
    if (status != REFOCUS_OK)
        return status;
    if (is_plain(reader)) {
        status = read_samples(reader);
    } else if (reader->bits <= 8) {
        struct rf_raster *const raster = &reader->read->image;

        raster->width = (int32_t)reader->width;
        raster->height = (int32_t)reader->height;
        raster->sample = REFOCUS_SAMPLE_U8;
        raster->max_value = 255;
        status = read_rgba(reader, raster);
    } else {
        status = rf_fail(reader->read->reason, REFOCUS_ERR_UNSUPPORTED,
                         "TIFF with %d channels of %d bits in this form is not read; save it with "
                         "8 or 16 bits, or as floats",
                         reader->channels, reader->bits);
    }
    return status;
}

int rf_tiff_read(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras)
{
    struct reader reader = {.read = read, .file = file};
    TIFFOpenOptions *const options = TIFFOpenOptionsAlloc();
    const uint64_t most = read->limits.max_memory;
    int status;

    if (!options)
        return rf_fail_memory(read->reason);
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, &reader);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, &reader);
    TIFFOpenOptionsSetMaxSingleMemAlloc(
        options, (tmsize_t)(most < TIFF_TMSIZE_T_MAX ? most : TIFF_TMSIZE_T_MAX));
    reader.tiff = TIFFClientOpenExt("photo", "r", &reader, on_read, on_write, on_seek, on_close,
                                    on_size, on_map, on_unmap, options);
    TIFFOpenOptionsFree(options);
    if (!reader.tiff)
        return fail_damaged(&reader);
    status = run(&reader, extras);
    TIFFClose(reader.tiff);
    return status;
}
