/* unit.c: the samples of a depth file that says no unit are taken for disparities, greatest
 * nearest. Depth cameras write distances as often, others the inverse, and then what is nearest
 * comes out as farthest. */
#include "inputs/unit.h"

#include <math.h>
#include <stdio.h>
#include "inputs/no_value.h"
#include "inputs/samples.h"

/* Rooms and streets in millimetres, and in fifths of them, lie within these, and have a nearest and
 * a farthest place; disparities that fill 16 bits do not. */
enum { LEAST = 100, MOST = 32767 };

/* The ground before a camera comes nearer from row to row, so in most pictures what lies lower is
 * nearer. The lowest and the highest eighth of the rows say so more often than halves, in which a
 * subject stands. They differ enough where a quarter of the samples do. */
enum { PART = 8, LESS = 3, OF_LESS = 4, OF_ALL = 4 };

/* A sample, or 0 where there is none: 0 itself stands for that in many maps. */
static double sample_at(const struct refocus_depth_map *map, int32_t x, int32_t y)
{
    const double value = sample_stored(map, x, y);

    return isfinite(value) ? value : 0;
}

/* Whether 16-bit samples lie within the range of distances. */
static bool are_distances(const struct refocus_depth_map *map, char line[UNIT_LINE])
{
    double least = UINT16_MAX, most = 0;
    bool zeros = false;

    if (map->sample != REFOCUS_SAMPLE_U16)
        return false;
    for (int32_t y = 0; y < map->height; y++) {
        for (int32_t x = 0; x < map->width; x++) {
            const double sample = sample_at(map, x, y);

            if (sample > 0 && sample < least)
                least = sample;
            if (sample > most)
                most = sample;
            zeros |= sample == 0;
        }
    }
    zeros = zeros && !(map->flags & REFOCUS_DEPTH_ZERO_IS_UNKNOWN);
    snprintf(line, UNIT_LINE,
             "its samples from %.0f to %.0f%s are taken for disparities, bright = near; if they "
             "are distances, give --depth-unit mm, or 5000/m, else disparity%s",
             least, most, zeros ? ", and zeros," : "",
             zeros ? "; if zeros have no value, --invalid zero" : "");
    return least >= LEAST && most <= MOST && 2 * most > 3 * least;
}

/* Whether the lowest rows have less of the samples that differ from their mirror images in the
 * highest rows, LESS of OF_LESS of them. */
static bool are_upside_down(const struct refocus_depth_map *map, char line[UNIT_LINE])
{
    const int32_t rows = (map->height + PART - 1) / PART;
    int64_t less = 0, differ = 0;

    for (int32_t y = 0; y < rows; y++) {
        for (int32_t x = 0; x < map->width; x++) {
            const double upper = sample_at(map, x, y);
            const double lower = sample_at(map, x, map->height - 1 - y);

            if (upper != 0 && lower != 0) {
                less += lower < upper;
                differ += lower != upper;
            }
        }
    }
    snprintf(
        line, UNIT_LINE,
        "as disparities, %s = near, its bottom is farther than its top; if that is wrong, give "
        "--depth-unit inverse, mm, m or 5000/m, else disparity",
        map->sample == REFOCUS_SAMPLE_F32 ? "greater" : "bright");
    return OF_ALL * differ >= (int64_t)rows * map->width && differ > 0 &&
           OF_LESS * less >= LESS * differ;
}

bool unit_is_doubtful(const struct refocus_photo *photo, const struct depth_settings *settings,
                      bool turned, char line[UNIT_LINE])
{
    const struct refocus_depth_map *const map = photo->depth;

    if (photo->info->depth_source != REFOCUS_DEPTH_SOURCE_FILE ||
        map->meaning != REFOCUS_DEPTH_DISPARITY)
        return false;
    return (!settings->unit &&
            (are_distances(map, line) || (!turned && are_upside_down(map, line)))) ||
           ends_are_doubtful(map, settings->invalid != NULL, line);
}
