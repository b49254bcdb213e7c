/* read.c: a photo is recognised by its first bytes, read by its format and turned upright. */
#include "read.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "convert.h"
#include "exif_subject.h"
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

    if (read->view == RF_VIEW_SECOND && !(format && format->has_second)) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is no stereo file; give an MPO, a stereo HEIC, or two pictures");
    }
    if (!format && file.size == 0)
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "it is empty");
    if (!format) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "its content is of no known format; known are %s", RF_FORMATS);
    }
    if (!format->read)
        return rf_fail_absent(read->reason, format->name, format->library);
    return format->read(read, file);
}

/* A gigabyte where the system does not say. */
static uint64_t half_the_memory(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGESIZE);

    return pages > 0 && bytes > 0 ? (uint64_t)pages * (uint64_t)bytes / 2 : 1u << 30;
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
    if (limits->max_side == 0)
        limits->max_side = 32768;
    if (limits->max_side > REFOCUS_MAX_SIDE)
        limits->max_side = REFOCUS_MAX_SIDE;
    if (limits->max_pixels == 0)
        limits->max_pixels = 16384 * 12288;
    if (limits->max_bytes == 0)
        limits->max_bytes = 1u << 30;
    if (limits->max_memory == 0)
        limits->max_memory = half_the_memory();
    if (limits->max_metadata == 0)
        limits->max_metadata = 256u << 20;
    if (limits->max_segments == 0)
        limits->max_segments = 65536;
    if (limits->max_scans == 0)
        limits->max_scans = 100;
    if (limits->max_elements == 0)
        limits->max_elements = 100000;
    if (limits->max_depth == 0)
        limits->max_depth = 256;
    return REFOCUS_OK;
}

struct rf_photo *rf_photo_new(void)
{
    struct rf_photo *const photo = calloc(1, sizeof *photo);

    if (photo) {
        photo->image.struct_size = photo->deep.struct_size = sizeof photo->image;
        photo->depth = photo->matte = refocus_depth_map_default();
        photo->info.struct_size = sizeof photo->info;
        photo->shown.image = &photo->image;
        photo->shown.deep = &photo->deep;
        photo->shown.depth = &photo->depth;
        photo->shown.matte = &photo->matte;
        photo->shown.info = &photo->info;
    }
    return photo;
}

int rf_read_begin(struct rf_read *read, struct rf_bytes file,
                  const struct refocus_read_limits *limits, bool picture_always, enum rf_view view,
                  struct refocus_photo_info *info, struct rf_gain_map *gain,
                  struct refocus_reason *reason)
{
    int status;

    memset(read, 0, sizeof *read);
    read->gain = view == RF_VIEW_SECOND ? NULL : gain;
    read->depth.struct_size = sizeof read->depth; /* no meaning yet */
    read->reason = reason;
    read->picture_always = picture_always;
    read->view = view;
    read->info = info;
    read->orientation = 1;
    read->file_bytes = file.size;
    info->orientation = 1;
    info->focus_x = info->focus_y = -1.0;
    status = rf_read_limits(&read->limits, limits, reason);
    if (status == REFOCUS_OK)
        status = rf_check_bytes(read, file.size, "it");
    if (status == REFOCUS_OK)
        status = read_container(read, file);
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
        if (info->focus_x >= 0.0)
            rf_orient_point(&info->focus_x, &info->focus_y, read->orientation);
        rf_subject_settle(read);
    }
    return status;
}

static void show_samples(struct refocus_depth_map *map, const struct rf_raster *raster)
{
    map->samples = raster->pixels;
    map->width = raster->width;
    map->height = raster->height;
    map->stride = (ptrdiff_t)rf_raster_stride(raster);
    map->sample = raster->sample;
}

/* Give the finished parts to the photo. */
static void hand_over(struct rf_read *read, struct rf_photo *photo)
{
    struct refocus_photo *const shown = &photo->shown;

    photo->pixels = read->image.pixels;
    photo->deep_pixels = read->deep.pixels;
    photo->samples = read->samples.pixels;
    photo->confidence = read->confidence.pixels;
    photo->matte_samples = read->matte.pixels;
    photo->exif = read->exif.data;
    photo->icc = read->icc.data;
    photo->kept = read->kept;
    photo->limits = read->limits;
    if (read->image.pixels) {
        photo->image =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, read->image.pixels, read->image.width,
                                 read->image.height, (ptrdiff_t)rf_raster_stride(&read->image));
    }
    if (read->deep.pixels) {
        photo->deep =
            refocus_image_packed(read->deep.sample == REFOCUS_SAMPLE_F32 ? REFOCUS_FORMAT_RGB_FLOAT
                                                                         : REFOCUS_FORMAT_RGB16,
                                 read->deep.pixels, read->deep.width, read->deep.height,
                                 (ptrdiff_t)rf_raster_stride(&read->deep));
    }
    if (read->samples.pixels) {
        photo->depth = read->depth;
        show_samples(&photo->depth, &read->samples);
    }
    if (read->matte.pixels) {
        photo->matte.meaning = REFOCUS_DEPTH_DISPARITY;
        photo->matte.value_near = read->matte.max_value;
        show_samples(&photo->matte, &read->matte);
    }
    shown->confidence = read->confidence.pixels;
    shown->exif = read->exif;
    shown->icc = read->icc;
    memset(&read->image, 0, sizeof read->image);
    memset(&read->deep, 0, sizeof read->deep);
    memset(&read->samples, 0, sizeof read->samples);
    memset(&read->confidence, 0, sizeof read->confidence);
    memset(&read->matte, 0, sizeof read->matte);
    read->exif.data = read->icc.data = read->kept.bytes.data = NULL;
}

int rf_read_finish(struct rf_read *read, int status, struct rf_photo **photo)
{
    if (status == REFOCUS_OK && read->info->stored_bits == 0) {
        const uint32_t max = read->image.pixels ? read->image.max_value : read->samples.max_value;

        while (max >> read->info->stored_bits)
            read->info->stored_bits++;
    }
    rf_raster_free(&read->holes);
    if (status == REFOCUS_OK && read->image.pixels)
        status = rf_image_to_rgb8(read);
    if (status == REFOCUS_OK)
        status = rf_raster_orient(read, &read->image, read->orientation);
    if (status == REFOCUS_OK)
        status = rf_raster_orient(read, &read->deep, read->orientation);
    if (status == REFOCUS_OK)
        status = rf_raster_orient(read, &read->samples, read->orientation);
    if (status == REFOCUS_OK && read->gain)
        status = rf_raster_orient(read, &read->gain->samples, read->orientation);
    if (status == REFOCUS_OK)
        status = rf_raster_orient(read, &read->confidence, read->orientation);
    if (status == REFOCUS_OK)
        status = rf_raster_orient(read, &read->matte, read->orientation);
    if (status == REFOCUS_OK) {
        hand_over(read, *photo);
    } else {
        if (read->gain)
            rf_raster_free(&read->gain->samples);
        free(*photo);
        *photo = NULL;
    }
    rf_raster_free(&read->image);
    rf_raster_free(&read->deep);
    rf_raster_free(&read->samples);
    rf_raster_free(&read->confidence);
    rf_raster_free(&read->matte);
    free(read->exif.data);
    free(read->icc.data);
    free(read->kept.bytes.data);
    return status;
}

static int read_memory(struct refocus_photo **photo, const void *bytes, size_t size,
                       const struct refocus_read_limits *limits, enum rf_view view,
                       struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_photo *made;
    struct rf_read read;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!photo)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no place for the photo");
    *photo = NULL;
    if (!bytes && size > 0)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no bytes to read");
    made = rf_photo_new();
    if (!made)
        return rf_fail_memory(reason);
    status = rf_read_begin(&read, (struct rf_bytes){bytes, size}, limits, true, view, &made->info,
                           &made->gain, reason);
    status = rf_read_finish(&read, status, &made);
    *photo = made ? &made->shown : NULL;
    return status;
}

static int read_path(struct refocus_photo **photo, const char *path,
                     const struct refocus_read_limits *limits, enum rf_view view,
                     struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct refocus_read_limits own;
    struct refocus_blob file;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!photo || !path)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no photo or no path");
    *photo = NULL;
    status = rf_read_limits(&own, limits, reason);
    if (status == REFOCUS_OK)
        status = rf_load(path, own.max_bytes, rf_format_is_known, reason, &file);
    if (status == REFOCUS_OK) {
        status = read_memory(photo, file.data, file.size, limits, view, reason);
        free(file.data);
    }
    return status;
}

int refocus_photo_read_memory(struct refocus_photo **photo, const void *bytes, size_t size,
                              const struct refocus_read_limits *limits,
                              struct refocus_reason *reason)
{
    return read_memory(photo, bytes, size, limits, RF_VIEW_PHOTO, reason);
}

int refocus_photo_read(struct refocus_photo **photo, const char *path,
                       const struct refocus_read_limits *limits, struct refocus_reason *reason)
{
    return read_path(photo, path, limits, RF_VIEW_PHOTO, reason);
}

int refocus_photo_read_first(struct refocus_photo **photo, const char *path,
                             const struct refocus_read_limits *limits,
                             struct refocus_reason *reason)
{
    return read_path(photo, path, limits, RF_VIEW_FIRST, reason);
}

int refocus_photo_read_second(struct refocus_photo **photo, const char *path,
                              const struct refocus_read_limits *limits,
                              struct refocus_reason *reason)
{
    return read_path(photo, path, limits, RF_VIEW_SECOND, reason);
}

const struct rf_gain_map *rf_photo_gain_map(const struct refocus_photo *photo)
{
    const struct rf_photo *const owner = (const struct rf_photo *)(const void *)photo;

    return owner->gain.samples.pixels ? &owner->gain : NULL;
}

void refocus_photo_free(struct refocus_photo **photo)
{
    struct rf_photo *owner;

    if (!photo || !*photo)
        return;
    owner = (struct rf_photo *)(void *)*photo;
    free(owner->pixels);
    free(owner->deep_pixels);
    free(owner->samples);
    free(owner->confidence);
    free(owner->matte_samples);
    free(owner->exif);
    free(owner->icc);
    rf_raster_free(&owner->gain.samples);
    free(owner->kept.bytes.data);
    free(owner);
    *photo = NULL;
}
