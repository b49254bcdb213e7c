/* samples.h: single samples of a depth map of any type are read as numbers. */
#ifndef RF_CLI_SAMPLES_H
#define RF_CLI_SAMPLES_H

#include <math.h>
#include <string.h>
#include <refocus/refocus.h>

/* A sample as the map has it, whatever it stands for. */
static inline double sample_stored(const struct refocus_depth_map *map, int32_t x, int32_t y)
{
    const uint8_t *const row = (const uint8_t *)map->samples + y * map->stride;
    uint16_t code;
    float value;

    if (map->sample == REFOCUS_SAMPLE_U8)
        return row[x];
    if (map->sample == REFOCUS_SAMPLE_U16) {
        memcpy(&code, row + 2 * (size_t)x, sizeof code);
        return code;
    }
    memcpy(&value, row + 4 * (size_t)x, sizeof value);
    return value;
}

/* A sample, or NAN where it holds no value. */
static inline double sample_value(const struct refocus_depth_map *map, int32_t x, int32_t y)
{
    const double value = sample_stored(map, x, y);

    return isfinite(value) && !refocus_depth_is_code(map, value) ? value : NAN;
}

#endif
