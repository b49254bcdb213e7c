/* reading.c: the limits of a reading are checked before memory is asked for. */
#include "reading.h"

#include <stdlib.h>

#include "reason.h"

int rf_check_size(const struct rf_read *read, uint64_t width, uint64_t height, uint64_t pixel_bytes)
{
    if (width == 0 || height == 0) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: it claims a picture without pixels");
    }
    if (width > REFOCUS_MAX_SIDE || height > REFOCUS_MAX_SIDE) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %llu x %llu pixels are more than %d a side; scale it down",
                       (unsigned long long)width, (unsigned long long)height, REFOCUS_MAX_SIDE);
    }
    if (width * height > read->limits.max_pixels) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %llu x %llu pixels are more than the limit of %llu pixels",
                       (unsigned long long)width, (unsigned long long)height,
                       (unsigned long long)read->limits.max_pixels);
    }
    return rf_check_bytes(read, width * height * pixel_bytes, "its picture");
}

int rf_check_bytes(const struct rf_read *read, uint64_t bytes, const char *what)
{
    if (bytes > read->limits.max_bytes || bytes > PTRDIFF_MAX) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "%s needs %llu bytes, more than the limit of %llu", what,
                       (unsigned long long)bytes, (unsigned long long)read->limits.max_bytes);
    }
    return REFOCUS_OK;
}

int rf_raster_alloc(const struct rf_read *read, struct rf_raster *raster)
{
    const size_t bytes = (size_t)raster->channels * rf_sample_bytes(raster->sample);
    const int status =
        rf_check_size(read, (uint64_t)raster->width, (uint64_t)raster->height, bytes);

    raster->pixels = NULL;
    if (status != REFOCUS_OK) {
        return status;
    }
    raster->pixels = malloc((size_t)raster->width * (size_t)raster->height * bytes);
    return raster->pixels ? REFOCUS_OK : rf_fail_memory(read->reason);
}
