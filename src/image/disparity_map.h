/* disparity_map.h: the samples of a map of disparities, and where they lie in the photo. */
#ifndef RF_DISPARITY_MAP_H
#define RF_DISPARITY_MAP_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <refocus/image.h>

/* A row of the map. */
static inline const void *rf_map_row(const struct refocus_disparity *map, int y)
{
    return (const uint8_t *)map->samples + y * map->stride;
}

/* A sample of a row of the map, 65535 nearest. */
static inline uint16_t rf_map_sample(const struct refocus_disparity *map, const void *row, int x)
{
    return (uint16_t)(map->bits == 16 ? ((const uint16_t *)row)[x]
                                      : ((const uint8_t *)row)[x] * 257);
}

/* Copies all samples of the map to rows `stride` bytes apart. */
static inline void rf_copy_map(const struct refocus_disparity *map, uint16_t *out, ptrdiff_t stride)
{
    for (int y = 0; y < map->height; y++) {
        const void *const row = rf_map_row(map, y);
        uint16_t *const to = (uint16_t *)((char *)out + y * stride);

        if (map->bits == 16)
            memcpy(to, row, (size_t)map->width * sizeof *to);
        for (int x = 0; x < map->width && map->bits == 8; x++)
            to[x] = (uint16_t)(((const uint8_t *)row)[x] * 257);
    }
}

/* The pixel, of `size`, in the middle of the i-th of n parts. */
static inline int rf_middle_of(int i, int n, int size)
{
    return (int)((2 * (int64_t)i + 1) * size / (2 * (int64_t)n));
}

#endif
