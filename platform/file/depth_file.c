/* depth_file.c: depth is read from a file of its own, by a unit such as "disparity" or "mm". */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert.h"
#include "formats.h"
#include "load.h"
#include "number.h"
#include "read.h"
#include "reason.h"
#include "rows.h"

/* The metres in a unit of "m", "mm" or "N/m"; 0 for any other text. */
static double metres_in(const char *unit)
{
    const size_t length = strlen(unit);
    char number[64];
    double per_metre;

    if (strcmp(unit, "m") == 0)
        return 1.0;
    if (strcmp(unit, "mm") == 0)
        return 0.001;
    if (length < 3 || length - 2 >= sizeof number || strcmp(unit + length - 2, "/m") != 0)
        return 0.0;
    memcpy(number, unit, length - 2);
    number[length - 2] = '\0';
    if (!rf_parse_number(number, &per_metre) || per_metre <= 0.0 || !isfinite(1.0 / per_metre))
        return 0.0;
    return 1.0 / per_metre;
}

/* Floats have no greatest code, but for those that were whole numbers. "Greatest is nearest" needs
 * no measuring here, see value_near in depth.h; for the inverse the ends of the map are its ends.
 */
static void set_float_ends(struct refocus_depth_map *map, bool inverse)
{
    const uint8_t *row = map->samples;
    double low = INFINITY, high = -INFINITY;

    map->value_near = map->value_far = 0.0;
    if (!inverse || !row)
        return;
    for (int32_t y = 0; y < map->height; y++, row += map->stride) {
        for (int32_t x = 0; x < map->width; x++) {
            float value;
            memcpy(&value, row + 4 * (size_t)x, 4);
            if (isfinite(value)) {
                low = value < low ? value : low;
                high = value > high ? value : high;
            }
        }
    }
    if (low < high) {
        map->value_near = low;
        map->value_far = high;
    }
}

/* Give the map the meaning of a unit's words, for samples whose white is max_value; 0: floats. */
static int set_unit(struct refocus_depth_map *map, const char *unit, double max_value)
{
    const bool inverse = strcmp(unit, "inverse") == 0;
    double metres;

    if (inverse || strcmp(unit, "disparity") == 0) {
        map->meaning = REFOCUS_DEPTH_DISPARITY;
        map->flags = 0;
        map->metres_per_unit = map->metres_at_zero = 0.0;
        if (max_value == 0.0) {
            set_float_ends(map, inverse);
        } else {
            map->value_near = inverse ? 0.0 : max_value;
            map->value_far = inverse ? max_value : 0.0;
        }
        return REFOCUS_OK;
    }
    metres = metres_in(unit);
    if (metres <= 0.0)
        return REFOCUS_ERR_ARGUMENT;
    map->meaning = REFOCUS_DEPTH_DISTANCE;
    map->flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
    map->metres_per_unit = metres;
    map->metres_at_zero = 0.0;
    map->value_near = map->value_far = 0.0;
    return REFOCUS_OK;
}

int refocus_depth_set_unit(struct refocus_depth_map *given, const char *unit)
{
    const size_t first = REFOCUS_SIZE_TO(struct refocus_depth_map, far_m);
    struct refocus_depth_map own, *const map = &own;
    int status = refocus_struct_read(&own, sizeof own, first, given);

    if (status != REFOCUS_OK)
        return status;
    if (!unit)
        return REFOCUS_ERR_ARGUMENT;
    /* Floats are looked at: the ends of the map are its own. */
    if (map->samples && map->sample == REFOCUS_SAMPLE_F32 &&
        (map->width < 1 || map->width > REFOCUS_MAX_SIDE || map->height < 1 ||
         map->height > REFOCUS_MAX_SIDE ||
         !rf_good_rows(map->stride, 4 * (int64_t)map->width, map->height)))
        return REFOCUS_ERR_ARGUMENT;
    status = set_unit(map, unit,
                      map->sample == REFOCUS_SAMPLE_F32   ? 0.0
                      : map->sample == REFOCUS_SAMPLE_U16 ? 65535.0
                                                          : 255.0);
    return status == REFOCUS_OK ? refocus_struct_write(given, first, map, sizeof *map) : status;
}

/* The flag of a word of that length; 0: it is none. */
static uint32_t code_of(const char *word, size_t length)
{
    static const struct {
        const char *name;
        uint32_t flag;
    } codes[] = {{"zero", REFOCUS_DEPTH_ZERO_IS_UNKNOWN},
                 {"max", REFOCUS_DEPTH_MAX_IS_UNKNOWN},
                 {"2047", REFOCUS_DEPTH_2047_IS_UNKNOWN}};

    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
        if (strlen(codes[i].name) == length && strncmp(word, codes[i].name, length) == 0)
            return codes[i].flag;
    return 0;
}

int refocus_depth_set_invalid(struct refocus_depth_map *given, const char *codes)
{
    const size_t first = REFOCUS_SIZE_TO(struct refocus_depth_map, far_m);
    struct refocus_depth_map map;
    const int status = refocus_struct_read(&map, sizeof map, first, given);

    if (status != REFOCUS_OK)
        return status;
    while (codes && *codes) {
        const size_t length = strcspn(codes, ",");
        const uint32_t flag = code_of(codes, length);

        if (!flag)
            return REFOCUS_ERR_ARGUMENT;
        map.flags |= flag;
        codes += length + (codes[length] == ',');
    }
    return refocus_struct_write(given, first, &map, sizeof map);
}

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
        const int status = set_unit(map, unit ? unit : "disparity", max_value);
        if (status != REFOCUS_OK) {
            return rf_fail(read->reason, status,
                           "the depth unit is none of disparity, inverse, m, mm, or a "
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
    if (status == REFOCUS_OK && unit && set_unit(&probe, unit, 255.0) != REFOCUS_OK) {
        status = rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                         "the depth unit is none of disparity, inverse, m, mm, or a "
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
