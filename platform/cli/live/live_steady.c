/* live_steady.c: depth is kept from flickering by the temporal filter, between pairing and
 * preparing. */
#include <pthread.h>
#include <stdlib.h>
#include "live/live_steady.h"

/* The handle of the filter, while a thread cancels or another changes it. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

/* Depth that is older shows another moment: the camera was away, or a file begins again. */
static const int64_t longest_gap_ns = 1000000000;

static int fit(struct live_steady *steady, double strength, const struct live_depth_map *map)
{
    struct refocus_temporal_params params =
        refocus_temporal_params_default(map->width, map->height);
    struct refocus_temporal *filter;
    int status;

    if (steady->filter && steady->map.width == map->width && steady->map.height == map->height)
        return REFOCUS_OK;
    live_steady_end(steady);
    params.strength = (float)strength;
    status = refocus_temporal_create(&filter, &params);
    if (status != REFOCUS_OK)
        return status;
    pthread_mutex_lock(&lock);
    steady->filter = filter;
    pthread_mutex_unlock(&lock);
    steady->map.disparity = malloc((size_t)map->width * (size_t)map->height * 2);
    steady->map.width = map->width;
    steady->map.height = map->height;
    return steady->map.disparity ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
}

/* Forget the past where the next map does not follow on it in time. */
static void follow_time(struct live_steady *steady, int64_t timestamp_ns)
{
    const int64_t step_ns = timestamp_ns - steady->map.timestamp_ns;

    if (step_ns < 0 || step_ns > longest_gap_ns)
        refocus_temporal_reset(steady->filter);
    steady->map.timestamp_ns = timestamp_ns;
}

/* The past on the scale of a map, where its range has moved. */
static int follow_range(struct live_steady *steady, const struct live_range *range)
{
    const struct live_range was = steady->map.range;
    const double span = range->near - range->far;

    steady->map.range = *range;
    if (!live_range_is_known(&was) || !live_range_is_known(range) ||
        (was.near == range->near && was.far == range->far))
        return REFOCUS_OK;
    return refocus_temporal_rescale(steady->filter, (was.near - was.far) / span,
                                    (was.far - range->far) / span);
}

int live_steady_run(struct live_steady *steady, double strength, const struct live_depth_map **map,
                    const struct refocus_image *photo)
{
    const struct live_depth_map *const from = *map;
    const ptrdiff_t stride = (ptrdiff_t)from->width * 2;
    const struct refocus_disparity in =
        refocus_disparity16(from->disparity, from->width, from->height, stride);
    const int64_t begin = live_now_ns();
    int status = fit(steady, strength, from);

    if (status == REFOCUS_OK && steady->map.number != from->number) {
        /* One map may serve several frames. */
        follow_time(steady, from->timestamp_ns);
        status = follow_range(steady, &from->range);
        if (status == REFOCUS_OK)
            status =
                refocus_temporal_run(steady->filter, photo, &in, steady->map.disparity, stride);
        steady->map.number = from->number;
        live_times_add(&steady->times, (double)(live_now_ns() - begin) / 1e6);
    }
    if (status == REFOCUS_OK)
        *map = &steady->map;
    return status;
}

void live_steady_cancel(struct live_steady *steady)
{
    pthread_mutex_lock(&lock);
    refocus_temporal_cancel(steady->filter);
    pthread_mutex_unlock(&lock);
}

void live_steady_end(struct live_steady *steady)
{
    pthread_mutex_lock(&lock);
    refocus_temporal_destroy(&steady->filter);
    pthread_mutex_unlock(&lock);
    free(steady->map.disparity);
    steady->map = (struct live_depth_map){0};
}
