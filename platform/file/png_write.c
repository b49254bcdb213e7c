/* png_write.c: a PNG is written by libpng's row interface; png_read.c explains libpng's jumps. */
#include "png_write.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "exif.h"
#include "kept.h"
#include "png_chunks.h"
#include "reason.h"

struct writer {
    struct rf_store *store;
    const struct rf_rows *rows;
    const struct refocus_write_options *options;
    struct refocus_reason *reason;
    png_structp png;
    png_infop info;
    struct rf_xmp_keep keep; /* XMP of options->keep */
    uint8_t *own;            /* a chunk in the making */
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

    if (!memory && writer->status == REFOCUS_OK)
        writer->status = rf_fail_memory(writer->reason);
    return memory;
}

static void on_free(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

/* Memory for a chunk, which is freed behind any jump. */
static uint8_t *own_bytes(struct writer *writer, size_t size)
{
    free(writer->own);
    writer->own = on_malloc(writer->png, size);
    if (!writer->own)
        png_error(writer->png, "no memory");
    return writer->own;
}

static void set_header(struct writer *writer)
{
    const uint32_t format = writer->rows->format;
    const bool alpha = format == REFOCUS_FORMAT_RGBA8 || format == REFOCUS_FORMAT_BGRA8;
    const bool grey = format == REFOCUS_FORMAT_NONE;
    const struct refocus_write_options *const options = writer->options;

    png_set_IHDR(writer->png, writer->info, (png_uint_32)writer->rows->width,
                 (png_uint_32)writer->rows->height, grey || format == REFOCUS_FORMAT_RGB16 ? 16 : 8,
                 grey    ? PNG_COLOR_TYPE_GRAY
                 : alpha ? PNG_COLOR_TYPE_RGB_ALPHA
                         : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (options && options->icc && options->icc->data) {
        png_set_iCCP(writer->png, writer->info, "ICC", PNG_COMPRESSION_TYPE_BASE,
                     options->icc->data, (png_uint_32)options->icc->size);
        if (!png_get_valid(writer->png, writer->info, PNG_INFO_iCCP))
            rf_leave_out(writer->reason, "the ICC profile is damaged: left out");
    }
    if (options && options->exif && options->exif->data) {
        const size_t size = options->exif->size;
        uint8_t *const own = own_bytes(writer, size);

        memcpy(own, options->exif->data, size);
        rf_exif_set_size(own, size, (uint32_t)writer->rows->width, (uint32_t)writer->rows->height);
        png_set_eXIf_1(writer->png, writer->info, (png_uint_32)size, own);
    }
}

static void write_xmp(struct writer *writer, struct rf_bytes packet)
{
    uint8_t *own;

    if (packet.size > 0 && packet.size <= PNG_UINT_31_MAX - RF_PNG_XMP_HEAD) {
        own = own_bytes(writer, RF_PNG_XMP_HEAD + packet.size);
        memcpy(own, rf_png_xmp_head, RF_PNG_XMP_HEAD);
        memcpy(own + RF_PNG_XMP_HEAD, packet.data, packet.size);
        png_write_chunk(writer->png, (png_const_bytep) "iTXt", own, RF_PNG_XMP_HEAD + packet.size);
    }
}

/* Write the chunks of the photo that the picture was made from, or what a PNG takes of the
 * segments of a JPEG. */
static void write_kept(struct writer *writer, const struct rf_kept *kept)
{
    struct rf_bytes rest = {kept->bytes.data, kept->bytes.size};
    struct rf_png_chunk chunk;

    if (kept->kind != RF_KEPT_PNG) {
        for (int i = 0; i < writer->keep.count; i++) {
            const struct rf_bytes packet = rf_xmp_kept(&writer->keep.packet[i]);

            if (packet.size > 0) {
                write_xmp(writer, packet);
                break;
            }
        }
        return;
    }
    while (rf_png_next_chunk(&rest, &chunk)) {
        const struct rf_bytes packet = rf_png_xmp_of(&chunk);

        if (writer->keep.count > 0 && packet.data == writer->keep.packet[0].standard.data)
            write_xmp(writer, rf_xmp_kept(&writer->keep.packet[0]));
        else
            png_write_chunk(writer->png, chunk.type, chunk.content.data, chunk.content.size);
    }
}

static void run(struct writer *writer)
{
    const struct rf_rows *const rows = writer->rows;
    const uint16_t one = 1;

    if (setjmp(png_jmpbuf(writer->png)))
        return;
    png_set_write_fn(writer->png, writer, on_write, on_flush);
    png_set_benign_errors(writer->png, 1);
    png_set_user_limits(writer->png, REFOCUS_MAX_SIDE, REFOCUS_MAX_SIDE);
    /* Level 6 takes twice the time of 4 for a few per cent of the size. */
    png_set_compression_level(writer->png, 4);
    set_header(writer);
    png_write_info(writer->png, writer->info);
    if (writer->options && writer->options->keep)
        write_kept(writer, rf_kept_of(writer->options->keep));
    if (rows->format == REFOCUS_FORMAT_BGR8 || rows->format == REFOCUS_FORMAT_BGRA8)
        png_set_bgr(writer->png);
    if ((rows->format == REFOCUS_FORMAT_NONE || rows->format == REFOCUS_FORMAT_RGB16) &&
        *(const uint8_t *)&one == 1)
        png_set_swap(writer->png);
    for (int32_t y = 0; y < rows->height && rf_store_goes_on(writer->store); y++)
        png_write_row(writer->png, rows->top + y * rows->stride);
    if (writer->store->error == 0)
        png_write_end(writer->png, NULL); /* all that the info has stands before the pixels */
}

static void encode(struct writer *writer)
{
    writer->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, writer, on_error, on_warning,
                                            writer, on_malloc, on_free);
    writer->info = writer->png ? png_create_info_struct(writer->png) : NULL;
    if (writer->info)
        run(writer);
    else
        writer->status = rf_fail_memory(writer->reason);
    png_destroy_write_struct(&writer->png, &writer->info);
    free(writer->own);
}

int rf_write_png(struct rf_store *store, const struct rf_rows *rows,
                 const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct writer writer = {.store = store, .rows = rows, .options = options, .reason = reason};

    if (!options || !options->keep) {
        encode(&writer);
        return writer.status;
    }
    writer.keep.cut = RF_XMP_CUT_EDITABLE | RF_XMP_CUT_EXTENDED;
    writer.status = rf_keep_xmp(options->keep, &writer.keep, rows->width, rows->height, reason);
    if (writer.status == REFOCUS_OK) {
        rf_keep_warn(options->keep, &writer.keep, reason);
        rf_keep_warn_kind(options->keep, RF_KEPT_PNG, reason);
        encode(&writer);
    }
    rf_xmp_keep_free(&writer.keep);
    return writer.status;
}
