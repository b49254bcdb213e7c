/* heic_picture.c: one picture of a HEIC is decoded by libheif within the limits. */
#include "heic_picture.h"

#include <string.h>

#include "heic_deep.h"
#include "reason.h"

int rf_heic_fail(const struct rf_read *read, struct heif_error error)
{
    int status = REFOCUS_ERR_FORMAT;
    size_t length = strlen(error.message);

    while (length > 0 && strchr(" \n", error.message[length - 1]))
        length--;
    if (error.subcode == heif_suberror_End_of_data)
        return rf_fail(read->reason, status, "damaged HEIC: it ends too early; copy it again");
    if (error.subcode == heif_suberror_Security_limit_exceeded)
        status = REFOCUS_ERR_SIZE;
    else if (error.code == heif_error_Memory_allocation_error)
        status = REFOCUS_ERR_MEMORY;
    else if (error.code == heif_error_Unsupported_feature ||
             error.code == heif_error_Unsupported_filetype ||
             error.subcode == heif_suberror_Unsupported_codec)
        status = REFOCUS_ERR_UNSUPPORTED;
    return rf_fail(read->reason, status, "HEIC: %.*s", length < 200 ? (int)length : 200,
                   error.message);
}

/* Copy the rows of a plane out of libheif. */
static int copy_plane(struct rf_read *read, const struct heif_image *image,
                      enum heif_channel channel, struct rf_raster *raster)
{
    int stride = 0, status;
    const uint8_t *const plane = heif_image_get_plane_readonly(image, channel, &stride);

    raster->width = heif_image_get_width(image, channel);
    raster->height = heif_image_get_height(image, channel);
    if (!plane || raster->width < 1 || raster->height < 1) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "HEIC: its picture is of an unknown layout");
    }
    status = rf_raster_alloc(read, raster);
    for (int32_t y = 0; status == REFOCUS_OK && y < raster->height; y++) {
        const size_t bytes = rf_raster_stride(raster);
        memcpy(raster->pixels + (size_t)y * bytes, plane + (ptrdiff_t)y * stride, bytes);
    }
    return status;
}

struct heif_context *rf_heic_context(const struct refocus_read_limits *limits)
{
    struct heif_context *const context = heif_context_alloc();

    if (context) {
        /* libheif takes a side of what is coded, in blocks of 64 at most. Pixels are counted before
         * anything is decoded: the root of their limit would refuse panoramas that are within it.
         */
        heif_context_set_maximum_image_size_limit(context, (int)limits->max_side + 63);
        heif_context_set_max_decoding_threads(context, 0);
    }
    return context;
}

int rf_heic_decode(struct rf_heic *heic, struct heif_image_handle *handle, enum rf_heic_form form,
                   struct rf_raster *raster)
{
    struct rf_read *const read = heic->read;
    enum heif_channel channel = heif_channel_Y;
    struct heif_image *image = NULL;
    struct heif_error error;
    const bool colour = form != RF_HEIC_SAMPLES;
    const bool deep =
        form == RF_HEIC_COLOUR && heif_image_handle_get_luma_bits_per_pixel(handle) > 8;
    int bits, status;

    status = rf_check_size(read, (uint64_t)heif_image_handle_get_width(handle),
                           (uint64_t)heif_image_handle_get_height(handle), deep ? 6 : 3);
    if (status == REFOCUS_OK) {
        /* libheif keeps the picture as it is coded and as RGB. */
        status = rf_check_memory(read, (uint64_t)heif_image_handle_get_width(handle) *
                                           (uint64_t)heif_image_handle_get_height(handle) *
                                           (deep ? 18 : 9));
    }
    if (status != REFOCUS_OK)
        return status;
    heic->options->convert_hdr_to_8bit = !deep;
    error =
        heif_decode_image(handle, &image, colour ? heif_colorspace_RGB : heif_colorspace_undefined,
                          deep     ? rf_heic_deep_chroma()
                          : colour ? heif_chroma_interleaved_RGB
                                   : heif_chroma_undefined,
                          heic->options);
    if (error.code != heif_error_Ok)
        return rf_heic_fail(read, error);
    if (colour)
        channel = heif_channel_interleaved;
    else if (!heif_image_has_channel(image, heif_channel_Y))
        channel = heif_channel_R; /* a grid of tiles becomes R, G, B, which are alike */
    bits = colour && !deep ? 8 : heif_image_get_bits_per_pixel_range(image, channel);
    raster->channels = colour ? 3 : 1;
    raster->sample = bits > 8 ? REFOCUS_SAMPLE_U16 : REFOCUS_SAMPLE_U8;
    raster->max_value = bits >= 1 && bits <= 16 ? (1u << bits) - 1 : 0;
    status = raster->max_value == 0 ? rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                                              "HEIC: its picture is of an unknown layout")
                                    : copy_plane(read, image, channel, raster);
    heif_image_release(image);
    return status;
}
