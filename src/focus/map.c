/* map.c: looks up a map that covers the picture at any size. */
#include "focus/focus.h"

#include "image/disparity_map.h"

static int sample(const struct refocus_disparity *map, int x, int y)
{
    return rf_map_sample(map, rf_map_row(map, y), x);
}

/* The place of the middle of pixel `at` of `pixels` among `samples`, Q16 from the middle of the
 * first, clamped to the first and the last. */
static int64_t place(int at, int pixels, int samples)
{
    const int64_t twice = ((int64_t)(2 * at + 1) * samples << 16) / pixels;
    const int64_t from = (twice - 65536) / 2, last = (int64_t)(samples - 1) << 16;

    return from < 0 ? 0 : from > last ? last : from;
}

static int64_t mix(int64_t a, int64_t b, int64_t part)
{
    return (a << 16) + (b - a) * part;
}

int rf_map_at(const struct refocus_disparity *map, int width, int height, int x, int y)
{
    int64_t fx, fy, upper, lower;
    int i, j, right, below;

    if (map->width == width && map->height == height)
        return sample(map, x, y);
    fx = place(x, width, map->width);
    fy = place(y, height, map->height);
    i = (int)(fx >> 16);
    j = (int)(fy >> 16);
    fx &= 0xffff;
    fy &= 0xffff;
    right = i + (fx > 0); /* a sample with no share may not be there */
    below = j + (fy > 0);
    upper = mix(sample(map, i, j), sample(map, right, j), fx) >> 8;
    lower = mix(sample(map, i, below), sample(map, right, below), fx) >> 8;
    return (int)((mix(upper, lower, fy) + (1 << 23)) >> 24);
}
