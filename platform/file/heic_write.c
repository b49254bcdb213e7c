/* heic_write.c: a HEIC is written by libheif and its encoder of HEVC. libheif 1.15 writes no
 * auxiliary images: depth and original lie in the XMP, in one packet, whose size HEIC does not
 * bound. */
#include "heic_write.h"

#include <libheif/heif.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "exif.h"
#include "kept.h"
#include "reason.h"
#ifdef RF_HAVE_JPEG
#include "editable.h"
#endif

enum { DEFAULT_QUALITY = 90 };

struct writer {
    struct rf_store *store;
    const struct rf_rows *rows;
    const struct refocus_write_options *options;
    struct refocus_reason *reason;
    struct heif_context *context;
    struct heif_encoder *encoder;
    struct heif_image *image;
    struct heif_image_handle *handle;
    struct rf_text insert;
    struct rf_xmp_keep keep;
};

static int check(const struct writer *writer, struct heif_error error)
{
    if (error.code == heif_error_Ok)
        return REFOCUS_OK;
    return error.code == heif_error_Memory_allocation_error
               ? rf_fail_memory(writer->reason)
               : rf_fail(writer->reason, REFOCUS_ERR_UNSUPPORTED, "libheif cannot write it: %.160s",
                         error.message);
}

static int copy_pixels(struct writer *writer)
{
    const struct rf_rows *const rows = writer->rows;
    const int bytes = rf_format_bytes(rows->format);
    const int red =
        rows->format == REFOCUS_FORMAT_BGR8 || rows->format == REFOCUS_FORMAT_BGRA8 ? 2 : 0;
    uint8_t *plane;
    int stride = 0;
    int status = check(writer, heif_image_create(rows->width, rows->height, heif_colorspace_RGB,
                                                 heif_chroma_interleaved_RGB, &writer->image));

    if (status == REFOCUS_OK) {
        status = check(writer, heif_image_add_plane(writer->image, heif_channel_interleaved,
                                                    rows->width, rows->height, 8));
    }
    if (status != REFOCUS_OK)
        return status;
    plane = heif_image_get_plane(writer->image, heif_channel_interleaved, &stride);
    for (int32_t y = 0; y < rows->height; y++) {
        const uint8_t *in = rows->top + y * rows->stride;
        uint8_t *out = plane + (ptrdiff_t)y * stride;

        for (int32_t x = 0; x < rows->width; x++, in += bytes, out += 3) {
            out[0] = in[red];
            out[1] = in[1];
            out[2] = in[2 - red];
        }
    }
    return REFOCUS_OK;
}

static int encode(struct writer *writer)
{
    const struct refocus_blob *const icc = writer->options->icc;
    const int quality = writer->options->quality ? writer->options->quality : DEFAULT_QUALITY;
    int status = copy_pixels(writer);

    if (status == REFOCUS_OK && icc && icc->data && icc->size > 0) {
        status = check(
            writer, heif_image_set_raw_color_profile(writer->image, "prof", icc->data, icc->size));
    }
    if (status == REFOCUS_OK)
        status = check(writer, heif_encoder_set_lossy_quality(writer->encoder, quality));
    if (status == REFOCUS_OK) {
        status = check(writer, heif_context_encode_image(writer->context, writer->image,
                                                         writer->encoder, NULL, &writer->handle));
    }
    return status;
}

static int add_exif(struct writer *writer)
{
    const struct refocus_blob *const exif = writer->options->exif;
    uint8_t *own;
    int status;

    if (!exif || !exif->data || exif->size == 0 || exif->size > INT_MAX)
        return REFOCUS_OK;
    own = malloc(exif->size);
    if (!own)
        return rf_fail_memory(writer->reason);
    memcpy(own, exif->data, exif->size);
    rf_exif_set_size(own, exif->size, (uint32_t)writer->rows->width,
                     (uint32_t)writer->rows->height);
    status = check(writer, heif_context_add_exif_metadata(writer->context, writer->handle, own,
                                                          (int)exif->size));
    free(own);
    return status;
}

/* Put original and depth into one text. */
static int make_editable(struct writer *writer)
{
#ifdef RF_HAVE_JPEG
    struct rf_editable editable = {.cut = 0};
    int status = REFOCUS_OK;

    if (writer->options->editable) {
        status = rf_editable_make(&editable, writer->options, true, writer->reason);
        writer->keep.cut = editable.cut | RF_XMP_CUT_EXTENDED;
        rf_text_put(&editable.standard, editable.extended.data, editable.extended.size);
        writer->insert = editable.standard;
        editable.standard.data = NULL;
        rf_editable_free(&editable);
    }
    return status == REFOCUS_OK && writer->insert.failed ? rf_fail_memory(writer->reason) : status;
#else
    (void)writer;
    return REFOCUS_OK;
#endif
}

static int add_xmp(struct writer *writer)
{
    const struct refocus_photo *const photo = writer->options->keep;
    struct rf_bytes packet = {NULL, 0};
    int status;

    if (!photo)
        return REFOCUS_OK;
    status = make_editable(writer);
    if (status == REFOCUS_OK) {
        writer->keep.insert = rf_text_bytes(&writer->insert);
        status = rf_keep_xmp(photo, &writer->keep, writer->rows->width, writer->rows->height,
                             writer->reason);
    }
    /* The last packet of a JPEG is the one that was put in. */
    for (int i = 0; status == REFOCUS_OK && i < writer->keep.count; i++) {
        const struct rf_bytes next = rf_xmp_kept(&writer->keep.packet[i]);

        packet = next.size > 0 && next.size <= INT_MAX ? next : packet;
    }
    if (status == REFOCUS_OK && packet.size > 0) {
        status = check(writer, heif_context_add_XMP_metadata(writer->context, writer->handle,
                                                             packet.data, (int)packet.size));
    }
    if (status == REFOCUS_OK)
        rf_keep_warn_kind(photo, RF_KEPT_XMP, writer->reason);
    if (status == REFOCUS_OK && !writer->options->editable)
        rf_keep_warn(photo, &writer->keep, writer->reason);
    return status;
}

static struct heif_error on_write(struct heif_context *context, const void *bytes, size_t size,
                                  void *user)
{
    (void)context;
    rf_store_write(user, bytes, size);
    return (struct heif_error){heif_error_Ok, heif_suberror_Unspecified, ""};
}

static int run(struct writer *writer)
{
    struct heif_writer out = {.writer_api_version = 1, .write = on_write};
    int status;

    if (heif_context_get_encoder_for_format(writer->context, heif_compression_HEVC,
                                            &writer->encoder)
            .code != heif_error_Ok) {
        return rf_fail(writer->reason, REFOCUS_ERR_UNSUPPORTED,
                       "libheif has no encoder of HEVC here; install its plug-in of x265, or write "
                       "a JPEG");
    }
    status = encode(writer);
    if (status == REFOCUS_OK)
        status = add_exif(writer);
    if (status == REFOCUS_OK)
        status = add_xmp(writer);
    if (status == REFOCUS_OK)
        status = check(writer, heif_context_write(writer->context, &out, writer->store));
    return status;
}

int rf_write_heic(struct rf_store *store, const struct rf_rows *rows,
                  const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct writer writer = {.store = store,
                            .rows = rows,
                            .options = options,
                            .reason = reason,
                            .context = heif_context_alloc(),
                            .keep = {.cut = RF_XMP_CUT_EDITABLE | RF_XMP_CUT_EXTENDED}};
    const int status = writer.context ? run(&writer) : rf_fail_memory(reason);

    rf_xmp_keep_free(&writer.keep);
    free(writer.insert.data);
    if (writer.handle)
        heif_image_handle_release(writer.handle);
    if (writer.image)
        heif_image_release(writer.image);
    if (writer.encoder)
        heif_encoder_release(writer.encoder);
    if (writer.context)
        heif_context_free(writer.context);
    return status;
}
