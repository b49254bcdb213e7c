/* live_depth.c: depth maps wait for the frame that they go with. */
#include <errno.h>
#include <math.h>
#include <refocus/status.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "live/live_depth.h"
#include "live/live_lock.h"
#include "live/live_times.h"

bool live_depths_init(struct live_depths *depths, bool every)
{
    memset(depths, 0, sizeof *depths);
    depths->made = live_lock_make(&depths->lock, &depths->changed);
    depths->pinned = -1;
    depths->every = every;
    depths->needed_ns = INT64_MIN;
    return depths->made;
}

void live_depths_free(struct live_depths *depths)
{
    for (int i = 0; i < LIVE_DEPTHS; i++)
        free(depths->map[i].disparity);
    if (depths->made)
        live_lock_end(&depths->lock, &depths->changed);
    depths->made = false;
}

void live_depths_end(struct live_depths *depths, bool failed)
{
    pthread_mutex_lock(&depths->lock);
    depths->ended = true;
    depths->failed |= failed;
    pthread_cond_broadcast(&depths->changed);
    pthread_mutex_unlock(&depths->lock);
}

bool live_depths_have_failed(struct live_depths *depths)
{
    bool failed;

    pthread_mutex_lock(&depths->lock);
    failed = depths->failed;
    pthread_mutex_unlock(&depths->lock);
    return failed;
}

bool live_depth_reserve(struct live_depth_map *map, int width, int height)
{
    const uint64_t bytes = (uint64_t)width * (uint64_t)height * 2;

    if (bytes > map->capacity) {
        free(map->disparity);
        map->disparity = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
        map->capacity = map->disparity ? (size_t)bytes : 0;
    }
    map->width = width;
    map->height = height;
    return map->disparity != NULL;
}

/* The last map from before the present frame, or NULL. */
static const struct live_depth_map *last_before(const struct live_depths *depths)
{
    const struct live_depth_map *found = NULL;

    for (int i = 0; i < LIVE_DEPTHS; i++) {
        const struct live_depth_map *map = &depths->map[i];

        if (map->number > 0 && map->timestamp_ns < depths->needed_ns &&
            (!found || map->timestamp_ns > found->timestamp_ns))
            found = map;
    }
    return found;
}

/* The oldest map that may be overwritten, or NULL. When every frame counts, only those
 * from before the present frame may, but the last of them: it may be the nearest. */
static struct live_depth_map *oldest(struct live_depths *depths)
{
    const struct live_depth_map *const last = depths->every ? last_before(depths) : NULL;
    struct live_depth_map *found = NULL;

    for (int i = 0; i < LIVE_DEPTHS; i++) {
        struct live_depth_map *map = &depths->map[i];

        if (i == depths->pinned || map == last)
            continue;
        if (map->number > 0 && depths->every && map->timestamp_ns >= depths->needed_ns)
            continue;
        if (!found || map->number < found->number)
            found = map;
    }
    return found;
}

struct live_depth_map *live_depths_fill(struct live_depths *depths, int width, int height)
{
    struct live_depth_map *map = NULL;

    pthread_mutex_lock(&depths->lock);
    while (!depths->ended && !(map = oldest(depths)))
        pthread_cond_wait(&depths->changed, &depths->lock);
    if (map)
        map->number = 0;
    pthread_mutex_unlock(&depths->lock);
    return map && live_depth_reserve(map, width, height) ? map : NULL;
}

/* The first map tells the lag, the second the period, until there are three of each. */
static void note_habits(struct live_depths *depths, int64_t timestamp_ns, int64_t now_ns)
{
    const int64_t period_ns = depths->count > 0 ? timestamp_ns - depths->newest_ns : 0;

    for (uint64_t i = 0; i < LIVE_HABITS; i++) {
        const bool mine = i == depths->count % LIVE_HABITS;

        if (mine || depths->count <= 1)
            depths->period_ns[i] = period_ns;
        if (mine || depths->count == 0)
            depths->lag_ns[i] = now_ns - timestamp_ns;
    }
    depths->newest_ns = timestamp_ns;
}

void live_depths_put(struct live_depths *depths, struct live_depth_map *map, int64_t timestamp_ns,
                     bool still)
{
    pthread_mutex_lock(&depths->lock);
    depths->still |= still;
    for (int i = 0; still && i < LIVE_DEPTHS; i++)
        depths->map[i].number = 0; /* none before it counts any more */
    note_habits(depths, timestamp_ns, live_now_ns());
    map->timestamp_ns = timestamp_ns;
    map->number = ++depths->count;
    pthread_cond_broadcast(&depths->changed);
    pthread_mutex_unlock(&depths->lock);
}

static bool is_nearer(int64_t a, int64_t b, int64_t time)
{
    const int64_t far_a = llabs(a - time), far_b = llabs(b - time);

    return far_a < far_b || (far_a == far_b && a < b);
}

/* The map nearest in time, the earlier of two, and the newest. */
static const struct live_depth_map *nearest(const struct live_depths *depths, int64_t time,
                                            const struct live_depth_map **newest)
{
    const struct live_depth_map *found = NULL;

    *newest = NULL;
    for (int i = 0; i < LIVE_DEPTHS; i++) {
        const struct live_depth_map *map = &depths->map[i];

        if (map->number == 0)
            continue;
        if (!found || is_nearer(map->timestamp_ns, found->timestamp_ns, time))
            found = map;
        if (!*newest || map->number > (*newest)->number)
            *newest = map;
    }
    return found;
}

/* The one in the middle of three. */
static double middle(const int64_t value[LIVE_HABITS])
{
    const double a = (double)value[0], b = (double)value[1], c = (double)value[2];

    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

int64_t live_depths_due(const struct live_depths *depths, int64_t timestamp_ns, int64_t half_ns,
                        int64_t now_ns)
{
    const double newest = (double)depths->newest_ns, time = (double)timestamp_ns;
    const double period = middle(depths->period_ns), lag = middle(depths->lag_ns);
    double next = time;

    if (depths->count == 0)
        return INT64_MIN;
    if (period > 0)
        next = newest + fmax(round((time - newest) / period), 1) * period;
    /* Cameras are not punctual. One that has missed three maps may not go on at all. */
    if (fabs(next - time) > 1.5 * (double)half_ns ||
        (period > 0 && (double)now_ns > newest + lag + 3 * period))
        return INT64_MAX;
    return next + lag < 9e18 ? (int64_t)(next + lag) : INT64_MAX;
}

const struct live_depth_map *live_depths_pair(struct live_depths *depths, int64_t timestamp_ns,
                                              int64_t half_ns, int64_t deadline_ns, bool *paired)
{
    const struct timespec until = {.tv_sec = (time_t)(deadline_ns / 1000000000),
                                   .tv_nsec = (long)(deadline_ns % 1000000000)};
    const struct live_depth_map *map, *newest;
    int error = 0;

    pthread_mutex_lock(&depths->lock);
    depths->pinned = -1;
    depths->needed_ns = timestamp_ns - half_ns; /* time may go back, when a clock was set */
    pthread_cond_broadcast(&depths->changed);
    for (;;) {
        map = nearest(depths, timestamp_ns, &newest);
        *paired = map && (depths->still || llabs(map->timestamp_ns - timestamp_ns) <= half_ns);
        /* A newer map that does not fit says that none will. */
        if (*paired || depths->ended || error == ETIMEDOUT ||
            (newest && newest->timestamp_ns > timestamp_ns + half_ns))
            break;
        if (!depths->every &&
            live_depths_due(depths, timestamp_ns, half_ns, live_now_ns()) > deadline_ns)
            break;
        error = depths->every ? pthread_cond_wait(&depths->changed, &depths->lock)
                              : pthread_cond_timedwait(&depths->changed, &depths->lock, &until);
    }
    if (!*paired && !depths->every)
        map = newest;
    else if (!*paired && depths->failed && newest && newest->timestamp_ns < timestamp_ns)
        map = NULL;
    depths->pinned = map ? (int)(map - depths->map) : -1;
    pthread_mutex_unlock(&depths->lock);
    return map;
}

int live_depth_widen(struct live_depth_map *wide, const struct live_depth_map **map,
                     const struct live_range *range)
{
    const struct live_depth_map *const from = *map;
    const size_t samples = (size_t)from->width * (size_t)from->height;
    const double span = range->near - range->far;
    const double scale = (from->range.near - from->range.far) / span;
    const double offset = (from->range.far - range->far) / span * 65535 + 0.5;

    if (!live_range_is_known(&from->range) ||
        (range->near == from->range.near && range->far == from->range.far))
        return REFOCUS_OK;
    if (!live_depth_reserve(wide, from->width, from->height))
        return REFOCUS_ERR_MEMORY;
    for (size_t i = 0; i < samples; i++)
        wide->disparity[i] = (uint16_t)(from->disparity[i] * scale + offset);
    wide->timestamp_ns = from->timestamp_ns;
    wide->number = from->number;
    wide->range = *range;
    *map = wide;
    return REFOCUS_OK;
}
