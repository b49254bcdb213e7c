/* samples.h: checks and reads the samples of a depth map, and brings them to a number that is
 * linear in d. */
#ifndef RF_DEPTH_SAMPLES_H
#define RF_DEPTH_SAMPLES_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/depth.h>

enum {
    RF_FIRST_MAP = REFOCUS_SIZE_TO(struct refocus_depth_map, far_m),
    RF_RARE_PERCENT = 1, /* 65535 of distances is a hole where less of the map has it */
};

/* Whether a map can be read: REFOCUS_OK or REFOCUS_ERR_ARGUMENT. */
int rf_check_map(const struct refocus_depth_map *map);

/* Whether distances of 16 bits have the greatest code in less than so much of the map: a sensor
 * found nothing there. More of them are a sky that is beyond the range. */
bool rf_greatest_is_below(const struct refocus_depth_map *map, int percent);

static inline const char *rf_row_of(const struct refocus_depth_map *map, int y)
{
    return (const char *)map->samples + y * map->stride;
}

/* Sample x of a row, which lies at any address. */
static inline uint16_t rf_whole_of(const struct refocus_depth_map *map, const char *row, int x)
{
    uint16_t u16;

    if (map->sample == REFOCUS_SAMPLE_U8)
        return (unsigned char)row[x];
    memcpy(&u16, row + (size_t)x * sizeof u16, sizeof u16);
    return u16;
}

static inline double rf_value_of(const struct refocus_depth_map *map, const char *row, int x)
{
    float f32;

    if (map->sample != REFOCUS_SAMPLE_F32)
        return rf_whole_of(map, row, x);
    memcpy(&f32, row + (size_t)x * sizeof f32, sizeof f32);
    return f32;
}

/* The rank of a value, which is linear in d: the value itself for disparities, 1/z for distances;
 * NAN when it is none. */
static inline double rf_rank_of(const struct refocus_depth_map *map, double v)
{
    if (!isfinite(v) || ((map->flags || map->unknown_count) && refocus_depth_is_code(map, v)))
        return NAN;
    if (map->meaning == REFOCUS_DEPTH_DISPARITY)
        return v;

    const double z = map->metres_at_zero + v * map->metres_per_unit;
    return z > 0 && z < INFINITY && 1 / z < INFINITY ? 1 / z : NAN;
}

#endif
