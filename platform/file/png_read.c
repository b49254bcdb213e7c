/* png_read.c: a PNG is decoded by libpng's row interface, with limits. libpng reports errors by a
 * jump: everything that is needed behind it lives in a struct, so that no local is lost. */
#include "png_read.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "exif.h"
#include "icc.h"
#include "light.h"
#include "png_chunks.h"
#include "png_colour.h"
#include "reason.h"

struct reader {
    const struct rf_read *read;
    struct rf_bytes file;
    size_t position, most; /* most: where reading has to end; 0: anywhere */
    png_structp png;
    png_infop info;
    struct rf_raster raster;
    struct refocus_blob exif, icc;
    bool alpha;       /* Alpha is kept beside the samples. */
    bool transparent; /* The file has some, by itself or in its palette. */
    int status;       /* status for errors that are not libpng's own */
};

static void on_error(png_structp png, png_const_charp words)
{
    struct reader *const reader = png_get_error_ptr(png);

    if (reader->status == REFOCUS_OK) {
        reader->status =
            rf_fail(reader->read->reason, REFOCUS_ERR_FORMAT, "damaged PNG: %s", words);
    }
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp words)
{
    (void)png;
    (void)words;
}

static void on_read(png_structp png, png_bytep to, size_t size)
{
    struct reader *const reader = png_get_io_ptr(png);

    if (reader->file.size - reader->position < size)
        png_error(png, "it ends too early; copy it again");
    if (reader->most > 0 && reader->position + size > reader->most)
        png_error(png, "it has more data than pixels");
    memcpy(to, reader->file.data + reader->position, size);
    reader->position += size;
}

static png_voidp on_malloc(png_structp png, png_alloc_size_t size)
{
    struct reader *const reader = png_get_mem_ptr(png);
    void *const memory = malloc(size);

    if (!memory && reader->status == REFOCUS_OK)
        reader->status = rf_fail_memory(reader->read->reason);
    return memory;
}

static void on_free(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

/* Samples stay as they are, but for palettes, small samples and transparency. */
static void choose_samples(struct reader *reader)
{
    png_structp const png = reader->png;
    const int bits = png_get_bit_depth(png, reader->info);
    const int type = png_get_color_type(png, reader->info);
    const uint16_t one = 1;

    if (type == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(png);
    else if (type == PNG_COLOR_TYPE_GRAY && bits < 8)
        png_set_expand_gray_1_2_4_to_8(png);
    reader->transparent =
        type & PNG_COLOR_MASK_ALPHA || png_get_valid(png, reader->info, PNG_INFO_tRNS);
    if (reader->alpha && reader->transparent) {
        png_set_tRNS_to_alpha(png);
    } else {
        reader->alpha = false;
        png_set_strip_alpha(png); /* a palette brings its transparency with it */
    }
    if (bits == 16 && *(const uint8_t *)&one == 1)
        png_set_swap(png);
    reader->raster.channels = (type & PNG_COLOR_MASK_COLOR ? 3 : 1) + reader->alpha;
    reader->raster.sample = bits == 16 ? REFOCUS_SAMPLE_U16 : REFOCUS_SAMPLE_U8;
    reader->raster.max_value = bits == 16 ? 65535 : 255;
}

static void read_picture(struct reader *reader)
{
    png_structp const png = reader->png;
    const png_uint_32 width = png_get_image_width(png, reader->info);
    const png_uint_32 height = png_get_image_height(png, reader->info);
    size_t stride;
    int passes, status;

    choose_samples(reader);
    passes = png_set_interlace_handling(png);
    png_read_update_info(png, reader->info);
    reader->raster.width = (int32_t)width;
    reader->raster.height = (int32_t)height;
    stride = rf_raster_stride(&reader->raster);
    if (png_get_rowbytes(png, reader->info) != stride)
        png_error(png, "rows of an unknown layout");
    status = rf_raster_alloc(reader->read, &reader->raster);
    if (status != REFOCUS_OK) {
        reader->status = status;
        png_longjmp(png, 1);
    }
    for (; passes > 0; passes--) {
        for (png_uint_32 y = 0; y < height; y++) {
            /* With the last row libpng unpacks all that follows it, which may be a thousand times
             * as large as the file: a row of noise needs no more than this. */
            if (passes == 1 && y == height - 1)
                reader->most = reader->position + 2 * stride + 65536;
            png_read_row(png, reader->raster.pixels + y * stride, NULL);
        }
    }
    reader->most = 0;
    png_read_end(png, reader->info);
}

static void copy_blob(struct reader *reader, struct refocus_blob *blob, const uint8_t *data,
                      size_t size)
{
    if (size == 0)
        return;
    blob->data = malloc(size);
    if (!blob->data) {
        reader->status = rf_fail_memory(reader->read->reason);
        png_longjmp(reader->png, 1);
    }
    memcpy(blob->data, data, size);
    blob->size = size;
}

static void read_extras(struct reader *reader)
{
    png_uint_32 size = 0;
    png_bytep data = NULL;
    png_charp name;
    int method;

    if (png_get_eXIf_1(reader->png, reader->info, &size, &data) & PNG_INFO_eXIf)
        copy_blob(reader, &reader->exif, data, size);
    if (png_get_iCCP(reader->png, reader->info, &name, &method, &data, &size) & PNG_INFO_iCCP)
        copy_blob(reader, &reader->icc, data, size);
}

/* Chunks that nobody asks for are skipped as they are: unpacked, each may be a thousand times as
 * large as in the file. */
static void skip_extras(png_structp png)
{
    static const uint8_t names[] = "bKGD\0cHRM\0gAMA\0hIST\0iTXt\0oFFs\0pCAL\0pHYs\0sBIT\0sCAL\0"
                                   "sPLT\0sRGB\0tEXt\0tIME\0zTXt";

    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, names, sizeof names / 5);
}

static bool run(struct reader *reader)
{
    const struct refocus_read_limits *const limits = &reader->read->limits;
    const uint64_t most = 64u << 20;
    const uint64_t chunk = limits->max_metadata < most ? limits->max_metadata : most;
    int status;

    if (setjmp(png_jmpbuf(reader->png)))
        return false;
    png_set_read_fn(reader->png, reader, on_read);
    skip_extras(reader->png);
    png_set_user_limits(reader->png, 0x7fffffff, 0x7fffffff);
    png_set_chunk_cache_max(reader->png, 128);
    png_set_chunk_malloc_max(reader->png, (png_alloc_size_t)chunk);
    png_read_info(reader->png, reader->info);
    /* The check comes before libpng's row buffers, and with our words rather than libpng's. */
    status = rf_check_size(reader->read, png_get_image_width(reader->png, reader->info),
                           png_get_image_height(reader->png, reader->info), 1);
    if (status != REFOCUS_OK) {
        reader->status = status;
        return false;
    }
    read_picture(reader);
    read_extras(reader);
    return true;
}

/* The pixels and, unless their places are NULL, EXIF and the colour profile. With *alpha true their
 * transparency is beside them; it becomes whether the file has some. */
static int decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster,
                  bool *alpha, struct refocus_blob *exif, struct refocus_blob *icc)
{
    struct reader reader = {.read = read, .file = file, .alpha = *alpha};

    reader.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning,
                                          &reader, on_malloc, on_free);
    if (!reader.png)
        return rf_fail_memory(read->reason);
    reader.info = png_create_info_struct(reader.png);
    if (!reader.info) {
        reader.status = rf_fail_memory(read->reason);
    } else if (run(&reader) && reader.status == REFOCUS_OK) {
        *raster = reader.raster;
        *alpha = reader.transparent;
        if (exif) {
            *exif = reader.exif;
            reader.exif.data = NULL;
        }
        if (icc) {
            *icc = reader.icc;
            reader.icc.data = NULL;
        }
        reader.raster.pixels = NULL;
    }
    rf_raster_free(&reader.raster);
    free(reader.exif.data);
    free(reader.icc.data);
    png_destroy_read_struct(&reader.png, &reader.info, NULL);
    return reader.status;
}

int rf_png_decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster)
{
    bool alpha = false;

    return decode(read, file, raster, &alpha, NULL, NULL);
}

/* A photo of 16 bits by a curve of HDR becomes light, without a profile, which cICP goes before;
 * other colours than sRGB are told. */
static int settle_colour(struct rf_read *read, struct rf_bytes file, struct refocus_blob *icc)
{
    enum { SIGNATURE = 8 };
    const struct rf_bytes chunks = {file.data + SIGNATURE, file.size - SIGNATURE};
    const struct rf_png_colour colour = rf_png_colour_of(chunks, icc->data != NULL);
    int status;

    if (!colour.by || !read->picture_always)
        return REFOCUS_OK;
    if (!rf_curve_is_hdr(colour.curve) || !colour.whole_range ||
        read->image.sample != REFOCUS_SAMPLE_U16 || read->image.channels != 3) {
        rf_note(read->info, "PNG: other colours than sRGB by %s, which results in PNG keep",
                colour.by);
        return REFOCUS_OK;
    }
    read->info->stored_bits = 16;
    status = rf_raster_to_light(read, &read->image, colour.curve, colour.primaries);
    if (status == REFOCUS_OK) {
        rf_note_curve(read, colour.curve, colour.primaries);
        free(icc->data);
        *icc = (struct refocus_blob){NULL, 0};
    }
    return status;
}

int rf_read_png(struct rf_read *read, struct rf_bytes file)
{
    struct refocus_blob exif = {NULL, 0}, icc = {NULL, 0};
    const bool wanted = rf_wants_alpha(read);
    bool alpha = wanted;
    int status;

    memcpy(read->info->container, "PNG", 4);
    status = decode(read, file, &read->image, &alpha, &exif, &icc);
    if (status == REFOCUS_OK && alpha && wanted)
        status = rf_part_alpha(read);
    if (status == REFOCUS_OK && alpha && !read->holes.pixels)
        rf_note(read->info, "PNG: transparency is dropped");
    if (status == REFOCUS_OK)
        status = rf_exif_take(read, (struct rf_bytes){exif.data, exif.size}, true);
    if (status == REFOCUS_OK)
        status = settle_colour(read, file, &icc);
    if (status == REFOCUS_OK)
        status = rf_icc_take(read, &icc);
    if (status == REFOCUS_OK)
        status = rf_png_keep(read, file);
    free(exif.data);
    free(icc.data);
    return status;
}
