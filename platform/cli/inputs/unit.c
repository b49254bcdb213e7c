/* unit.c: the samples of a depth file that says no unit are taken for disparities, bright near.
 * Depth cameras write distances as often, and bright is far then. */
#include "inputs/unit.h"

#include <stdio.h>

/* Rooms and streets in millimetres, and in fifths of them, lie within these, and have a nearest and
 * a farthest place; disparities that fill 16 bits do not. */
enum { LEAST = 100, MOST = 32767 };

bool unit_is_doubtful(const struct refocus_photo *photo, char *line, size_t size)
{
    const struct refocus_depth_map *const map = photo->depth;
    unsigned least = UINT16_MAX, most = 0;

    if (photo->info->depth_source != REFOCUS_DEPTH_SOURCE_FILE ||
        map->meaning != REFOCUS_DEPTH_DISPARITY || map->sample != REFOCUS_SAMPLE_U16)
        return false;
    for (int32_t y = 0; y < map->height; y++) {
        const void *const row = (const char *)map->samples + y * map->stride;
        const uint16_t *const sample = row;

        for (int32_t x = 0; x < map->width; x++) {
            if (sample[x] > 0 && sample[x] < least)
                least = sample[x];
            if (sample[x] > most)
                most = sample[x];
        }
    }
    snprintf(line, size,
             "its samples from %u to %u are taken for disparities, bright = near; if they are "
             "distances, give --depth-unit mm, or 5000/m, else disparity",
             least, most);
    return least >= LEAST && most <= MOST && 2 * most > 3 * least;
}
