/* live_upsample.c: depth of each frame is brought to the photo's size as --upsample asks for. */
#include "inputs/upsample.h"
#include "live/live_upsample.h"

int live_upsample(struct live_depth_map *full, const struct live_depth_map **map,
                  const struct refocus_image *photo, int way, struct refocus_reason *reason)
{
    const struct live_depth_map *const from = *map;
    const struct refocus_disparity small =
        refocus_disparity16(from->disparity, from->width, from->height, (ptrdiff_t)from->width * 2);
    int status;

    if (way == 0 || (from->width == photo->width && from->height == photo->height))
        return REFOCUS_OK;
    if (!live_depth_reserve(full, photo->width, photo->height))
        return REFOCUS_ERR_MEMORY;
    status = upsample_by_filter(way, photo, &small, full->disparity, reason);
    full->timestamp_ns = from->timestamp_ns;
    full->number = from->number;
    full->range = from->range;
    *map = full;
    return status;
}
