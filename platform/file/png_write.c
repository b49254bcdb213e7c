/* png_write.c: a PNG is written by libpng's row interface; png_read.c explains libpng's jumps. */
#include "png_write.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>

#include "reason.h"

struct writer {
    struct rf_store *store;
    const struct rf_rows *rows;
    const struct refocus_write_options *options;
    struct refocus_reason *reason;
    png_structp png;
    png_infop info;
    int status;
};

static void on_error(png_structp png, png_const_charp words)
{
    struct writer *const writer = png_get_error_ptr(png);

    if (writer->status == REFOCUS_OK) {
        writer->status =
            rf_fail(writer->reason, REFOCUS_ERR_MEMORY, "the PNG encoder gave up: %s", words);
    }
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp words)
{
    (void)png;
    (void)words;
}

static void on_write(png_structp png, png_bytep bytes, size_t size)
{
    struct writer *const writer = png_get_io_ptr(png);

    rf_store_write(writer->store, bytes, size);
}

static void on_flush(png_structp png)
{
    (void)png;
}

static png_voidp on_malloc(png_structp png, png_alloc_size_t size)
{
    struct writer *const writer = png_get_mem_ptr(png);
    void *const memory = malloc(size);

    if (!memory && writer->status == REFOCUS_OK) {
        writer->status = rf_fail_memory(writer->reason);
    }
    return memory;
}

static void on_free(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

static void set_header(struct writer *writer)
{
    const uint32_t format = writer->rows->format;
    const bool alpha = format == REFOCUS_FORMAT_RGBA8 || format == REFOCUS_FORMAT_BGRA8;
    const bool grey = format == REFOCUS_FORMAT_NONE;
    const struct refocus_write_options *const options = writer->options;

    png_set_IHDR(writer->png, writer->info, (png_uint_32)writer->rows->width,
                 (png_uint_32)writer->rows->height, grey ? 16 : 8,
                 grey    ? PNG_COLOR_TYPE_GRAY
                 : alpha ? PNG_COLOR_TYPE_RGB_ALPHA
                         : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (options && options->icc && options->icc->data) {
        png_set_iCCP(writer->png, writer->info, "ICC", PNG_COMPRESSION_TYPE_BASE,
                     options->icc->data, (png_uint_32)options->icc->size);
        if (!png_get_valid(writer->png, writer->info, PNG_INFO_iCCP)) {
            rf_fail(writer->reason, REFOCUS_OK, "the ICC profile is damaged: left out");
        }
    }
    if (options && options->exif && options->exif->data) {
        png_set_eXIf_1(writer->png, writer->info, (png_uint_32)options->exif->size,
                       options->exif->data);
    }
}

static void run(struct writer *writer)
{
    const struct rf_rows *const rows = writer->rows;
    const uint16_t one = 1;

    if (setjmp(png_jmpbuf(writer->png))) {
        return;
    }
    png_set_write_fn(writer->png, writer, on_write, on_flush);
    png_set_benign_errors(writer->png, 1);
    png_set_user_limits(writer->png, REFOCUS_MAX_SIDE, REFOCUS_MAX_SIDE);
    /* Level 6 takes twice the time of 4 for a few per cent of the size. */
    png_set_compression_level(writer->png, 4);
    set_header(writer);
    png_write_info(writer->png, writer->info);
    if (rows->format == REFOCUS_FORMAT_BGR8 || rows->format == REFOCUS_FORMAT_BGRA8) {
        png_set_bgr(writer->png);
    }
    if (rows->format == REFOCUS_FORMAT_NONE && *(const uint8_t *)&one == 1) {
        png_set_swap(writer->png);
    }
    for (int32_t y = 0; y < rows->height && writer->store->error == 0; y++) {
        png_write_row(writer->png, rows->top + y * rows->stride);
    }
    if (writer->store->error == 0) {
        png_write_end(writer->png, writer->info);
    }
}

int rf_write_png(struct rf_store *store, const struct rf_rows *rows,
                 const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct writer writer = {.store = store, .rows = rows, .options = options, .reason = reason};

    writer.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &writer, on_error, on_warning,
                                           &writer, on_malloc, on_free);
    if (!writer.png) {
        return rf_fail_memory(reason);
    }
    writer.info = png_create_info_struct(writer.png);
    if (writer.info) {
        run(&writer);
    } else {
        writer.status = rf_fail_memory(reason);
    }
    png_destroy_write_struct(&writer.png, &writer.info);
    return writer.status;
}
