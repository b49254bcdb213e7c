/* depth_file.c: depth is read from a file of its own, by a unit such as "disparity" or "mm". */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert.h"
#include "depth_words.h"
#include "formats.h"
#include "load.h"
#include "read.h"
#include "reason.h"

static int check_range(double near_m, double far_m, struct refocus_reason *reason)
{
    if (!(near_m >= 0.0) || isinf(near_m) || !(far_m >= 0.0) ||
        (near_m > 0.0 && far_m > 0.0 && near_m >= far_m)) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                       "near and far must be metres, near the smaller");
    }
    return REFOCUS_OK;
}

/* Transparent samples of a picture hold no value: floats can say so of each. */
static int mark_holes(struct rf_read *read)
{
    const struct rf_raster *const from = &read->samples;
    const size_t count = (size_t)from->width * (size_t)from->height;
    struct rf_raster floats = *from;
    unsigned long long holes = 0;
    int status;

    if (!read->holes.pixels)
        return REFOCUS_OK;
    floats.sample = REFOCUS_SAMPLE_F32;
    status = rf_raster_alloc(read, &floats);
    if (status != REFOCUS_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        const bool hole = read->holes.pixels[i] == 0;
        float value = NAN;

        if (!hole && from->sample == REFOCUS_SAMPLE_F32)
            memcpy(&value, from->pixels + 4 * i, 4);
        else if (!hole)
            value = (float)rf_raster_sample(from, i);
        memcpy(floats.pixels + 4 * i, &value, 4);
        holes += hole;
    }
    rf_raster_free(&read->samples);
    read->samples = floats;
    rf_note(read->info, "depth: %llu samples are transparent: no value, filled", holes);
    return REFOCUS_OK;
}

/* A grey picture becomes the depth when the file carries no other. */
static int picture_as_samples(struct rf_read *read, double *max_value)
{
    int status;

    if (read->samples.pixels) {
        *max_value = read->samples.max_value;
        return REFOCUS_OK;
    }
    status = rf_raster_to_grey(read, &read->image);
    if (status == REFOCUS_OK) {
        read->samples = read->image;
        read->image.pixels = NULL;
        *max_value = read->samples.max_value;
        status = mark_holes(read);
    }
    return status;
}

/* The samples of the file, whose white that is. */
static const char *sample_name(double max_value)
{
    return max_value == 0.0 ? "32-bit float" : max_value > 255.0 ? "16-bit" : "8-bit";
}

/* Say how the samples are read, and why. */
static int apply_unit(struct rf_read *read, const char *unit, double max_value)
{
    struct refocus_depth_map *const map = &read->depth;
    const bool said = map->meaning != 0;
    const uint32_t meaning = map->meaning;

    map->samples = read->samples.pixels;
    map->width = read->samples.width;
    map->height = read->samples.height;
    map->stride = (ptrdiff_t)rf_raster_stride(&read->samples);
    map->sample = read->samples.sample;
    if (unit || !said) {
        const int status = rf_depth_set_unit(map, unit ? unit : "disparity", max_value);
        if (status != REFOCUS_OK) {
            return rf_fail(
                read->reason, status,
                "the depth unit is none of disparity, disparity/16, inverse, m, mm, or a "
                "number per metre such as 5000/m");
        }
        if (meaning != map->meaning)
            map->near_m = map->far_m = 0.0;
    }
    if (!said) {
        read->info->depth_source = REFOCUS_DEPTH_SOURCE_FILE;
        rf_note(read->info, "depth file: %d x %d %s samples", (int)map->width, (int)map->height,
                sample_name(max_value));
    }
    if (unit) {
        rf_note(read->info, "depth: read as \"%s\", as asked for", unit);
    } else if (!said) {
        rf_note(read->info, "depth: no unit in the file, read as disparity: %s is near",
                max_value == 0.0 ? "greater" : "brighter");
    }
    return REFOCUS_OK;
}

int refocus_depth_read_memory(struct refocus_photo **depth, const void *bytes, size_t size,
                              const char *unit, double near_m, double far_m,
                              const struct refocus_read_limits *limits,
                              struct refocus_reason *reason)
{
    struct refocus_depth_map probe = refocus_depth_map_default();
    struct refocus_reason unused;
    struct rf_photo *made;
    struct rf_read read;
    double max_value = 0;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!depth)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no place for the depth");
    *depth = NULL;
    status = check_range(near_m, far_m, reason);
    if (status == REFOCUS_OK && unit && rf_depth_set_unit(&probe, unit, 255.0) != REFOCUS_OK) {
        status = rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                         "the depth unit is none of disparity, disparity/16, inverse, m, mm, or a "
                         "number per metre such as 5000/m");
    }
    if (status == REFOCUS_OK && !bytes && size > 0)
        status = rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no bytes to read");
    if (status != REFOCUS_OK)
        return status;
    made = rf_photo_new();
    if (!made)
        return rf_fail_memory(reason);
    status = rf_read_begin(&read, (struct rf_bytes){bytes, size}, limits, false, RF_VIEW_PHOTO,
                           &made->info, NULL, reason);
    if (status == REFOCUS_OK)
        status = picture_as_samples(&read, &max_value);
    if (status == REFOCUS_OK)
        status = apply_unit(&read, unit, max_value);
    if (status == REFOCUS_OK) {
        read.depth.near_m = near_m > 0.0 ? near_m : read.depth.near_m;
        read.depth.far_m = far_m > 0.0 ? far_m : read.depth.far_m;
        rf_raster_free(&read.image);
    }
    status = rf_read_finish(&read, status, &made);
    *depth = made ? &made->shown : NULL;
    return status;
}

int refocus_depth_read(struct refocus_photo **depth, const char *path, const char *unit,
                       double near_m, double far_m, const struct refocus_read_limits *limits,
                       struct refocus_reason *reason)
{
    struct refocus_read_limits own;
    struct refocus_reason unused;
    struct refocus_blob file;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!depth || !path)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "no depth or no path");
    *depth = NULL;
    status = rf_read_limits(&own, limits, reason);
    if (status == REFOCUS_OK)
        status = rf_load(path, own.max_bytes, rf_format_is_known, reason, &file);
    if (status == REFOCUS_OK) {
        status = refocus_depth_read_memory(depth, file.data, file.size, unit, near_m, far_m, limits,
                                           reason);
        free(file.data);
    }
    return status;
}
