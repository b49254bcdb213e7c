/* samples.c: checks a depth map, and counts its greatest code, which may be no distance. */
#include "depth/samples.h"
#include "image/format.h"

enum {
    KNOWN_FLAGS = REFOCUS_DEPTH_ZERO_IS_UNKNOWN | REFOCUS_DEPTH_MAX_IS_UNKNOWN |
                  REFOCUS_DEPTH_2047_IS_UNKNOWN,
    MUCH_PERCENT = 10 * RF_RARE_PERCENT,
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

int rf_check_map(const struct refocus_depth_map *map)
{
    if (!map->samples || map->width < 1 || map->height < 1 || map->width > REFOCUS_MAX_SIDE ||
        map->height > REFOCUS_MAX_SIDE)
        return REFOCUS_ERR_ARGUMENT;

    const int bytes = sample_bytes(map->sample);
    if (bytes == 0 || (map->flags & ~(uint32_t)KNOWN_FLAGS) != 0 || map->unknown_count < 0 ||
        map->unknown_count > REFOCUS_DEPTH_MOST_UNKNOWN ||
        !rf_good_stride(map->stride, (ptrdiff_t)map->width * bytes, map->height))
        return REFOCUS_ERR_ARGUMENT;

    if (!is_depth_or_unknown(map->near_m) || !is_depth_or_unknown(map->far_m) ||
        map->near_m == INFINITY || (map->near_m > 0 && map->far_m > 0 && map->near_m >= map->far_m))
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

bool rf_greatest_is_below(const struct refocus_depth_map *map, int percent)
{
    uint64_t count = 0;

    if (map->meaning != REFOCUS_DEPTH_DISTANCE || map->sample != REFOCUS_SAMPLE_U16)
        return false;
    for (int y = 0; y < map->height; y++) {
        const char *row = rf_row_of(map, y);

        for (int x = 0; x < map->width; x++)
            count += rf_whole_of(map, row, x) == UINT16_MAX;
    }
    return 100 * count < (uint64_t)percent * (uint64_t)map->width * (uint64_t)map->height;
}

int refocus_depth_follow_flags(const struct refocus_depth_map *given, uint32_t *flags)
{
    struct refocus_depth_map map;
    int status = refocus_struct_read(&map, sizeof map, RF_FIRST_MAP, given);

    if (status == REFOCUS_OK)
        status = flags ? rf_check_map(&map) : REFOCUS_ERR_ARGUMENT;
    if (status != REFOCUS_OK)
        return status;

    const bool hole = *flags & REFOCUS_DEPTH_MAX_IS_UNKNOWN;
    *flags = rf_greatest_is_below(&map, hole ? MUCH_PERCENT : RF_RARE_PERCENT)
                 ? REFOCUS_DEPTH_MAX_IS_UNKNOWN
                 : 0;
    return REFOCUS_OK;
}
