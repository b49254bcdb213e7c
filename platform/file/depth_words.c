/* depth_words.c: the words of the command line for what samples of a depth map mean, and which of
 * them hold no value. */
#include "depth_words.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <refocus/platform/file.h>

#include "number.h"
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

/* Whether a unit is "disparity/N": N-ths of a pixel, in which matchers store whole numbers. The
 * range is measured then, as their type's is not that of the scene. */
static bool is_fixed_point(const char *unit)
{
    static const char word[] = "disparity/";
    double parts;

    return strncmp(unit, word, sizeof word - 1) == 0 &&
           rf_parse_number(unit + sizeof word - 1, &parts) && parts > 0.0;
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
            if (isfinite(value) && !refocus_depth_is_code(map, (double)value)) {
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

int rf_depth_set_unit(struct refocus_depth_map *map, const char *unit, double max_value)
{
    const bool inverse = strcmp(unit, "inverse") == 0, fixed_point = is_fixed_point(unit);
    double metres;

    if (inverse || fixed_point || strcmp(unit, "disparity") == 0) {
        map->meaning = REFOCUS_DEPTH_DISPARITY;
        map->flags = 0;
        map->metres_per_unit = map->metres_at_zero = 0.0;
        if (fixed_point || max_value == 0.0) {
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

/* Whether there are floats to be looked at, which can be read. */
static bool are_good_floats(const struct refocus_depth_map *map)
{
    return map->width >= 1 && map->width <= REFOCUS_MAX_SIDE && map->height >= 1 &&
           map->height <= REFOCUS_MAX_SIDE &&
           rf_good_rows(map->stride, 4 * (int64_t)map->width, map->height);
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
    if (map->samples && map->sample == REFOCUS_SAMPLE_F32 && !are_good_floats(map))
        return REFOCUS_ERR_ARGUMENT;
    status = rf_depth_set_unit(map, unit,
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

/* Where an end of floats is a code, as that of the inverse may be, it is measured without. */
static int measure_again(struct refocus_depth_map *map)
{
    if (map->sample != REFOCUS_SAMPLE_F32 || !map->samples ||
        map->meaning != REFOCUS_DEPTH_DISPARITY || map->value_near == map->value_far ||
        (!refocus_depth_is_code(map, map->value_near) &&
         !refocus_depth_is_code(map, map->value_far)))
        return REFOCUS_OK;
    if (!are_good_floats(map))
        return REFOCUS_ERR_ARGUMENT;
    set_float_ends(map, true);
    return REFOCUS_OK;
}

/* Adds a number, as a float has it, to the values that are unknown. */
static bool add_number(struct refocus_depth_map *map, const char *word, size_t length)
{
    char text[64];
    double value;

    if (length >= sizeof text)
        return false;
    memcpy(text, word, length);
    text[length] = '\0';
    if (!rf_parse_number(text, &value) || !isfinite((float)value))
        return false;
    value = (double)(float)value;
    if (refocus_depth_is_code(map, value))
        return true;
    if (map->unknown_count < 0 || map->unknown_count >= REFOCUS_DEPTH_MOST_UNKNOWN)
        return false;
    map->unknown[map->unknown_count++] = value;
    return true;
}

int refocus_depth_set_invalid(struct refocus_depth_map *given, const char *codes)
{
    const size_t first = REFOCUS_SIZE_TO(struct refocus_depth_map, far_m);
    struct refocus_depth_map map;
    int status = refocus_struct_read(&map, sizeof map, first, given);

    if (status != REFOCUS_OK)
        return status;
    while (codes && *codes) {
        const size_t length = strcspn(codes, ",");
        const uint32_t flag = code_of(codes, length);

        if (!flag && !add_number(&map, codes, length))
            return REFOCUS_ERR_ARGUMENT;
        map.flags |= flag;
        codes += length + (codes[length] == ',');
    }
    if (map.unknown_count > 0 && given->struct_size < sizeof map)
        return REFOCUS_ERR_ARGUMENT; /* there is no place for them */
    status = measure_again(&map);
    return status == REFOCUS_OK ? refocus_struct_write(given, first, &map, sizeof map) : status;
}
