#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/depth.h>
#include <refocus/image.h>
#include "depth/fill.h"

/* A sample is first brought to a number that is linear in d, its rank: the sample itself for
 * disparities, 1/z for distances. */
struct conversion {
    const struct refocus_depth_map *map;
    double rank_near, rank_far; /* of d = 1 and d = 0 */
    double scale;               /* from ranks to 65535 d; 0 for a map of one depth */
    uint64_t unknown, clamped;
};

static int sample_bytes(uint32_t sample)
{
    switch (sample) {
    case REFOCUS_SAMPLE_U8:
        return 1;
    case REFOCUS_SAMPLE_U16:
        return 2;
    case REFOCUS_SAMPLE_F32:
        return 4;
    }
    return 0;
}

static bool is_depth_or_unknown(double metres)
{
    return metres == 0 || (metres > 0 && 1 / metres < INFINITY);
}

static bool is_stride(ptrdiff_t stride, int64_t row, int height)
{
    const int64_t bytes = stride < 0 ? -(int64_t)stride : stride;
    return height == 1 || bytes >= row;
}

static int check(const struct refocus_depth_map *map, const uint16_t *disparity,
                 ptrdiff_t stride)
{
    if (!map || !map->samples || !disparity || map->width < 1 || map->height < 1 ||
        map->width > REFOCUS_MAX_SIDE || map->height > REFOCUS_MAX_SIDE)
        return REFOCUS_ERR_ARGUMENT;

    const int bytes = sample_bytes(map->sample);
    if (bytes == 0 || (map->flags & ~(uint32_t)REFOCUS_DEPTH_ZERO_IS_UNKNOWN) != 0 ||
        map->stride == PTRDIFF_MIN || stride == PTRDIFF_MIN || stride % 2 != 0 ||
        !is_stride(map->stride, (int64_t)map->width * bytes, map->height) ||
        !is_stride(stride, (int64_t)map->width * 2, map->height))
        return REFOCUS_ERR_ARGUMENT;

    if (!is_depth_or_unknown(map->near_m) || !is_depth_or_unknown(map->far_m) ||
        map->near_m == INFINITY ||
        (map->near_m > 0 && map->far_m > 0 && map->near_m >= map->far_m))
        return REFOCUS_ERR_ARGUMENT;

    if (map->meaning == REFOCUS_DEPTH_DISPARITY)
        return isfinite(map->value_near) && isfinite(map->value_far) &&
                       isfinite(map->value_near - map->value_far)
                   ? REFOCUS_OK
                   : REFOCUS_ERR_ARGUMENT;
    if (map->meaning == REFOCUS_DEPTH_DISTANCE)
        return isfinite(map->metres_per_unit) && map->metres_per_unit != 0 &&
                       isfinite(map->metres_at_zero)
                   ? REFOCUS_OK
                   : REFOCUS_ERR_ARGUMENT;
    return REFOCUS_ERR_ARGUMENT;
}

/* Rank of sample (x, y); NAN when it holds no value. Samples lie at any address. */
static double rank_of(const struct refocus_depth_map *map, const char *row, int x)
{
    double v;

    switch (map->sample) {
    case REFOCUS_SAMPLE_U8:
        v = (unsigned char)row[x];
        break;
    case REFOCUS_SAMPLE_U16: {
        uint16_t u16;
        memcpy(&u16, row + (size_t)x * sizeof u16, sizeof u16);
        v = u16;
        break;
    }
    default: {
        float f32;
        memcpy(&f32, row + (size_t)x * sizeof f32, sizeof f32);
        v = f32;
        break;
    }
    }
    if (!isfinite(v) || (v == 0 && (map->flags & REFOCUS_DEPTH_ZERO_IS_UNKNOWN)))
        return NAN;
    if (map->meaning == REFOCUS_DEPTH_DISPARITY)
        return v;

    const double z = map->metres_at_zero + v * map->metres_per_unit;
    return z > 0 && z < INFINITY && 1 / z < INFINITY ? 1 / z : NAN;
}

static const char *row_of(const struct refocus_depth_map *map, int y)
{
    return (const char *)map->samples + y * map->stride;
}

/* Count what is unknown and find the greatest and the least rank. */
static int measure(struct conversion *conversion)
{
    const struct refocus_depth_map *map = conversion->map;
    double least = INFINITY, greatest = -INFINITY;

    for (int y = 0; y < map->height; y++) {
        const char *row = row_of(map, y);
        for (int x = 0; x < map->width; x++) {
            const double rank = rank_of(map, row, x);
            if (isnan(rank)) {
                conversion->unknown++;
                continue;
            }
            least = rank < least ? rank : least;
            greatest = rank > greatest ? rank : greatest;
        }
    }
    if (conversion->unknown == (uint64_t)map->width * (uint64_t)map->height)
        return REFOCUS_ERR_NO_DEPTH;
    conversion->rank_near = greatest;
    conversion->rank_far = least;
    return REFOCUS_OK;
}

/* What the map says of its range goes before what was measured. */
static void choose_range(struct conversion *conversion)
{
    const struct refocus_depth_map *map = conversion->map;

    if (map->meaning == REFOCUS_DEPTH_DISPARITY) {
        if (map->value_near != map->value_far) {
            conversion->rank_near = map->value_near;
            conversion->rank_far = map->value_far;
        }
    } else {
        if (map->near_m > 0)
            conversion->rank_near = 1 / map->near_m;
        if (map->far_m > 0)
            conversion->rank_far = 1 / map->far_m;
        /* All samples beyond the one end that is given: they lie on it. */
        if (conversion->rank_near < conversion->rank_far) {
            if (map->near_m > 0)
                conversion->rank_far = conversion->rank_near;
            else
                conversion->rank_near = conversion->rank_far;
        }
    }

    const double span = conversion->rank_near - conversion->rank_far;
    const double scale = 65535 / span;
    conversion->scale = span != 0 && isfinite(scale) ? scale : 0;
}

/* Convert all rows; @p state tells known from unknown samples unless it is NULL. */
static void convert(struct conversion *conversion, uint16_t *disparity, ptrdiff_t stride,
                    uint8_t *state)
{
    const struct refocus_depth_map *map = conversion->map;
    const double near = conversion->rank_near, far = conversion->rank_far;
    const double scale = conversion->scale;
    const double least = near < far ? near : far, greatest = near < far ? far : near;

    for (int y = 0; y < map->height; y++) {
        const char *row = row_of(map, y);
        uint16_t *out = (uint16_t *)((char *)disparity + y * stride);

        for (int x = 0; x < map->width; x++) {
            const double rank = rank_of(map, row, x);
            const bool unknown = isnan(rank);
            double d = 0;

            if (!unknown) {
                conversion->clamped += rank < least || rank > greatest;
                d = (rank - far) * scale + 0.5;
            }
            out[x] = d >= 65535 ? 65535 : d > 0 ? (uint16_t)d : 0;
            if (state)
                *state++ = unknown ? RF_SAMPLE_UNKNOWN : RF_SAMPLE_KNOWN;
        }
    }
}

static void fill_report(const struct conversion *conversion,
                        struct refocus_depth_report *report)
{
    const struct refocus_depth_map *map = conversion->map;

    memset(report, 0, sizeof *report);
    report->near_m = map->near_m;
    report->far_m = map->far_m;
    if (map->meaning == REFOCUS_DEPTH_DISTANCE) {
        if (map->near_m == 0)
            report->near_m = 1 / conversion->rank_near;
        if (map->far_m == 0)
            report->far_m = 1 / conversion->rank_far;
    } else {
        report->value_near = conversion->rank_near;
        report->value_far = conversion->rank_far;
    }
    report->unknown = conversion->unknown;
    report->clamped = conversion->clamped;
}

int refocus_depth_to_disparity(const struct refocus_depth_map *map, uint16_t *disparity,
                               ptrdiff_t stride, struct refocus_depth_report *report)
{
    struct conversion conversion = {.map = map};
    uint8_t *state = NULL;
    int status;

    status = check(map, disparity, stride);
    if (status != REFOCUS_OK)
        return status;
    status = measure(&conversion);
    if (status != REFOCUS_OK)
        return status;
    choose_range(&conversion);

    /* A map of one depth is all 0, holes and all. */
    if (conversion.unknown > 0 && conversion.scale != 0) {
        const uint64_t samples = (uint64_t)map->width * (uint64_t)map->height;
        if (samples > SIZE_MAX)
            return REFOCUS_ERR_MEMORY;
        state = malloc((size_t)samples);
        if (!state)
            return REFOCUS_ERR_MEMORY;
    }
    convert(&conversion, disparity, stride, state);
    if (state)
        rf_fill_holes(disparity, stride, map->width, map->height, state);
    free(state);
    if (report)
        fill_report(&conversion, report);
    return REFOCUS_OK;
}
