/* raw.c: a camera raw is developed by libraw: white balance as the camera set it, primaries of
 * sRGB, 16 bits by the curve of sRGB and nothing else, so that they are light; upright. */
#include <libraw/libraw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "codec.h"
#include "reason.h"

static int fail(const struct rf_read *read, int error)
{
    if (error == LIBRAW_UNSUFFICIENT_MEMORY || error == LIBRAW_TOO_BIG)
        return rf_fail_memory(read->reason);
    return rf_fail(read->reason,
                   error == LIBRAW_FILE_UNSUPPORTED ? REFOCUS_ERR_UNSUPPORTED : REFOCUS_ERR_FORMAT,
                   "camera raw: %s", libraw_strerror(error));
}

static void tell(struct rf_read *read, const libraw_data_t *raw)
{
    struct refocus_photo_info *const info = read->info;
    const libraw_iparams_t *const camera = &raw->idata;

    snprintf(info->camera, sizeof info->camera, "%.47s%s%.47s", camera->make,
             camera->make[0] && camera->model[0] ? " " : "", camera->model);
    rf_clean_text(info->camera);
    info->focal_length_mm = raw->other.focal_len > 0 ? (double)raw->other.focal_len : 0;
    info->f_number = raw->other.aperture > 0 ? (double)raw->other.aperture : 0;
    info->focal_length_35mm = raw->lens.FocalLengthIn35mmFormat;
    rf_note(info, "raw: developed by libraw, white balance of the camera, primaries of sRGB, no "
                  "tone curve");
}

/* Copy the picture that was made. */
static int take(struct rf_read *read, libraw_data_t *raw)
{
    struct rf_raster *const raster = &read->image;
    int error = 0, status;
    libraw_processed_image_t *const made = libraw_dcraw_make_mem_image(raw, &error);

    if (!made)
        return fail(read, error);
    raster->width = made->width;
    raster->height = made->height;
    raster->channels = made->colors;
    raster->sample = REFOCUS_SAMPLE_U16;
    raster->max_value = 65535;
    if (made->type != LIBRAW_IMAGE_BITMAP || made->bits != 16 ||
        (made->colors != 1 && made->colors != 3)) {
        status = rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                         "camera raw of %d colours is not read", made->colors);
    } else {
        status = rf_raster_alloc(read, raster);
    }
    if (status == REFOCUS_OK)
        memcpy(raster->pixels, made->data, rf_raster_stride(raster) * (size_t)raster->height);
    libraw_dcraw_clear_mem(made);
    return status;
}

static int develop(struct rf_read *read, libraw_data_t *raw)
{
    const libraw_image_sizes_t *const sizes = &raw->sizes;
    uint64_t pixels;
    int error, status;

    status = rf_check_size(read, sizes->raw_width, sizes->raw_height, 8);
    if (status != REFOCUS_OK)
        return status;
    /* The samples, four of 16 bits a pixel while colours are found, and the picture. */
    pixels = (uint64_t)sizes->raw_width * sizes->raw_height;
    status = rf_check_memory(read, pixels * 24);
    if (status != REFOCUS_OK)
        return status;
    error = libraw_unpack(raw);
    if (error == LIBRAW_SUCCESS)
        error = libraw_dcraw_process(raw);
    if (error != LIBRAW_SUCCESS)
        return fail(read, error);
    return take(read, raw);
}

static int read_raw(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras)
{
    libraw_data_t *const raw =
        libraw_init(LIBRAW_OPIONS_NO_MEMERR_CALLBACK | LIBRAW_OPIONS_NO_DATAERR_CALLBACK);
    int error, status;

    extras->upright = true;
    if (!raw)
        return rf_fail_memory(read->reason);
    raw->params.use_camera_wb = 1;
    raw->params.output_color = 1; /* sRGB */
    raw->params.output_bps = 16;
    raw->params.no_auto_bright = 1;
    raw->params.gamm[0] = 1 / 2.4;
    raw->params.gamm[1] = 12.92;
    raw->params.max_raw_memory_mb =
        (unsigned)(read->limits.max_memory >> 20 < 65536 ? read->limits.max_memory >> 20 : 65536);
    error = libraw_open_buffer(raw, (void *)(uintptr_t)file.data, file.size);
    status = error == LIBRAW_SUCCESS ? develop(read, raw) : fail(read, error);
    if (status == REFOCUS_OK)
        tell(read, raw);
    libraw_close(raw);
    return status;
}

__attribute__((visibility("default"))) extern const struct rf_codec rf_codec_raw;
const struct rf_codec rf_codec_raw = {.version = RF_CODEC_VERSION, .read = read_raw};
