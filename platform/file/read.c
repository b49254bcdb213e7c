/* read.c: a photo is recognised by its first bytes, read by its format and turned upright. */
#include "read.h"

#include <stdlib.h>
#include <string.h>

#include "convert.h"
#include "formats.h"
#include "load.h"
#include "orient.h"
#include "reason.h"

const char *refocus_file_formats(void)
{
    return RF_FORMATS;
}

static int read_container(struct rf_read *read, struct rf_bytes file)
{
    const struct rf_format *const format = rf_format_of_content(file);

    if (read->second && !(format && format->has_second)) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is no stereo file; give an MPO, a stereo HEIC, or two "
                       "pictures");
    }
    if (!format && file.size == 0) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "it is empty");
    }
    if (!format) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "its content is of no known format; known are %s", RF_FORMATS);
    }
    if (format->only_depth && read->picture_always) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "a %s file is a depth map, not a photo; give it as the depth", format->name);
    }
    if (!format->read) {
        return rf_fail_absent(read->reason, format->name, format->library);
    }
    return format->read(read, file);
}

int rf_read_limits(struct refocus_read_limits *limits, const struct refocus_read_limits *given,
                   struct refocus_reason *reason)
{
    int status = REFOCUS_OK;

    *limits = refocus_read_limits_default();
    if (given)
        status = refocus_struct_read(limits, sizeof *limits,
                                     REFOCUS_SIZE_TO(struct refocus_read_limits, max_bytes), given);
    if (status != REFOCUS_OK)
        return rf_fail(reason, status,
                       "the struct_size of the limits is wrong, or a limit is set "
                       "that this library does not know");
    if (limits->max_pixels == 0)
        limits->max_pixels = 1u << 28;
    if (limits->max_bytes == 0)
        limits->max_bytes = 1u << 30;
    return REFOCUS_OK;
}

struct rf_photo *rf_photo_new(void)
{
    struct rf_photo *const photo = calloc(1, sizeof *photo);

    if (photo) {
        photo->image.struct_size = sizeof photo->image;
        photo->depth = refocus_depth_map_default();
        photo->info.struct_size = sizeof photo->info;
        photo->shown.image = &photo->image;
        photo->shown.depth = &photo->depth;
        photo->shown.info = &photo->info;
    }
    return photo;
}

int rf_read_begin(struct rf_read *read, struct rf_bytes file,
                  const struct refocus_read_limits *limits, bool picture_always, bool second,
                  struct refocus_photo_info *info, struct refocus_reason *reason)
{
    int status;

    memset(read, 0, sizeof *read);
    read->depth.struct_size = sizeof read->depth; /* no meaning yet */
    read->reason = reason;
    read->picture_always = picture_always;
    read->second = second;
    read->info = info;
    read->orientation = 1;
    info->orientation = 1;
    info->focus_x = info->focus_y = -1.0;
    status = rf_read_limits(&read->limits, limits, reason);
    if (status == REFOCUS_OK) {
        status = rf_check_bytes(read, file.size, "it");
    }
    if (status == REFOCUS_OK) {
        status = read_container(read, file);
    }
    if (status == REFOCUS_OK) {
        const struct rf_raster *const stored = read->image.pixels ? &read->image : &read->samples;
        /* HEIC says its own size: its picture is upright already. */
        if (info->stored_width == 0) {
            info->stored_width = stored->width;
            info->stored_height = stored->height;
        }
        if (read->orientation != 1) {
            info->orientation = read->orientation;
            rf_note(info, "EXIF: orientation %d is applied to photo and depth", read->orientation);
        }
        if (info->focus_x >= 0.0) {
            rf_orient_point(&info->focus_x, &info->focus_y, read->orientation);
        }
    }
    return status;
}

/* Give the finished parts to the photo. */
static void hand_over(struct rf_read *read, struct rf_photo *photo)
{
    struct refocus_photo *const shown = &photo->shown;

    photo->pixels = read->image.pixels;
    photo->samples = read->samples.pixels;
    photo->exif = read->exif.data;
    photo->icc = read->icc.data;
    if (read->image.pixels) {
        photo->image =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, read->image.pixels, read->image.width,
                                 read->image.height, (ptrdiff_t)rf_raster_stride(&read->image));
    }
    if (read->samples.pixels) {
        photo->depth = read->depth;
        photo->depth.samples = read->samples.pixels;
        photo->depth.width = read->samples.width;
        photo->depth.height = read->samples.height;
        photo->depth.stride = (ptrdiff_t)rf_raster_stride(&read->samples);
        photo->depth.sample = read->samples.sample;
    }
    shown->exif = read->exif;
    shown->icc = read->icc;
    memset(&read->image, 0, sizeof read->image);
    memset(&read->samples, 0, sizeof read->samples);
    read->exif.data = read->icc.data = NULL;
}

int rf_read_finish(struct rf_read *read, int status, struct rf_photo **photo)
{
    if (status == REFOCUS_OK && read->info->stored_bits == 0) {
        const uint32_t max = read->image.pixels ? read->image.max_value : read->samples.max_value;

        while (max >> read->info->stored_bits) {
            read->info->stored_bits++;
        }
    }
    if (status == REFOCUS_OK && read->image.pixels) {
        status = rf_raster_to_rgb8(read, &read->image);
    }
    if (status == REFOCUS_OK) {
        status = rf_raster_orient(read, &read->image, read->orientation);
    }
    if (status == REFOCUS_OK) {
        status = rf_raster_orient(read, &read->samples, read->orientation);
    }
    if (status == REFOCUS_OK) {
        hand_over(read, *photo);
    } else {
        free(*photo);
        *photo = NULL;
    }
    rf_raster_free(&read->image);
    rf_raster_free(&read->samples);
    free(read->exif.data);
    free(read->icc.data);
    return status;
}

static int read_memory(struct refocus_photo **photo, const void *bytes, size_t size,
                       const struct refocus_read_limits *limits, bool second,
                       struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_photo *made;
    struct rf_read read;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!photo) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no place for the photo");
    }
    *photo = NULL;
    if (!bytes && size > 0) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no bytes to read");
    }
    made = rf_photo_new();
    if (!made) {
        return rf_fail_memory(reason);
    }
    status = rf_read_begin(&read, (struct rf_bytes){bytes, size}, limits, true, second, &made->info,
                           reason);
    status = rf_read_finish(&read, status, &made);
    *photo = made ? &made->shown : NULL;
    return status;
}

static int read_path(struct refocus_photo **photo, const char *path,
                     const struct refocus_read_limits *limits, bool second,
                     struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct refocus_read_limits own;
    struct refocus_blob file;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!photo || !path) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no photo or no path");
    }
    *photo = NULL;
    status = rf_read_limits(&own, limits, reason);
    if (status == REFOCUS_OK) {
        status = rf_load(path, own.max_bytes, reason, &file);
    }
    if (status == REFOCUS_OK) {
        status = read_memory(photo, file.data, file.size, limits, second, reason);
        free(file.data);
    }
    return status;
}

int refocus_photo_read_memory(struct refocus_photo **photo, const void *bytes, size_t size,
                              const struct refocus_read_limits *limits,
                              struct refocus_reason *reason)
{
    return read_memory(photo, bytes, size, limits, false, reason);
}

int refocus_photo_read(struct refocus_photo **photo, const char *path,
                       const struct refocus_read_limits *limits, struct refocus_reason *reason)
{
    return read_path(photo, path, limits, false, reason);
}

int refocus_photo_read_second(struct refocus_photo **photo, const char *path,
                              const struct refocus_read_limits *limits,
                              struct refocus_reason *reason)
{
    return read_path(photo, path, limits, true, reason);
}

void refocus_photo_free(struct refocus_photo **photo)
{
    struct rf_photo *owner;

    if (!photo || !*photo) {
        return;
    }
    owner = (struct rf_photo *)(void *)*photo;
    free(owner->pixels);
    free(owner->samples);
    free(owner->exif);
    free(owner->icc);
    free(owner);
    *photo = NULL;
}
