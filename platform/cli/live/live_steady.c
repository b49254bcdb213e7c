/* Depth that does not flicker: the temporal filter between pairing and preparing. */
#include <stdlib.h>
#include "live/live.h"

static bool fit(struct live_steady *steady, double strength,
                const struct live_depth_map *map)
{
    struct refocus_temporal_params params =
        refocus_temporal_params_default(map->width, map->height);

    if (steady->filter && steady->map.width == map->width &&
        steady->map.height == map->height)
        return true;
    live_steady_end(steady);
    params.strength = (float)strength;
    if (refocus_temporal_create(&steady->filter, &params) != REFOCUS_OK)
        return false;
    steady->map.disparity = malloc((size_t)map->width * (size_t)map->height * 2);
    steady->map.width = map->width;
    steady->map.height = map->height;
    return steady->map.disparity != NULL;
}

const struct live_depth_map *live_steady_run(struct live_steady *steady,
                                             double strength,
                                             const struct live_depth_map *map,
                                             const struct refocus_image *photo)
{
    const ptrdiff_t stride = (ptrdiff_t)map->width * 2;
    const struct refocus_disparity in =
        refocus_disparity16(map->disparity, map->width, map->height, stride);
    const int64_t begin = live_now_ns();

    if (!fit(steady, strength, map))
        return NULL;
    if (steady->map.number == map->number)
        return &steady->map; /* one map for several frames */
    if (refocus_temporal_run(steady->filter, photo, &in, steady->map.disparity,
                             stride) != REFOCUS_OK)
        return NULL;
    steady->map.number = map->number;
    steady->map.timestamp_ns = map->timestamp_ns;
    live_times_add(&steady->times, (double)(live_now_ns() - begin) / 1e6);
    return &steady->map;
}

void live_steady_end(struct live_steady *steady)
{
    refocus_temporal_destroy(&steady->filter);
    free(steady->map.disparity);
    steady->map = (struct live_depth_map){0};
}
