/* reading.c: the limits of a reading are checked before memory is asked for. */
#include "reading.h"

#include <stdlib.h>
#include <string.h>

#include "gain_map.h"
#include "reason.h"

int rf_check_size(const struct rf_read *read, uint64_t width, uint64_t height, uint64_t pixel_bytes)
{
    if (width == 0 || height == 0) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: it claims a picture without pixels");
    }
    if (width > read->limits.max_side || height > read->limits.max_side) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %llu x %llu pixels are more than the limit of %u a side; scale it down",
                       (unsigned long long)width, (unsigned long long)height,
                       (unsigned)read->limits.max_side);
    }
    if (width * height > read->limits.max_pixels) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %llu x %llu pixels are more than the limit of %llu pixels",
                       (unsigned long long)width, (unsigned long long)height,
                       (unsigned long long)read->limits.max_pixels);
    }
    return rf_check_bytes(read, width * height * pixel_bytes, "its picture");
}

static int check(const struct rf_read *read, uint64_t bytes, uint64_t most, const char *what)
{
    if (bytes > most || bytes > PTRDIFF_MAX) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "%s needs %llu bytes, more than the limit of %llu", what,
                       (unsigned long long)bytes, (unsigned long long)most);
    }
    return REFOCUS_OK;
}

int rf_check_bytes(const struct rf_read *read, uint64_t bytes, const char *what)
{
    return check(read, bytes, read->limits.max_bytes, what);
}

int rf_check_metadata(const struct rf_read *read, uint64_t bytes, const char *what)
{
    return check(read, bytes, read->limits.max_metadata, what);
}

static uint64_t raster_bytes(const struct rf_raster *raster)
{
    return raster->pixels ? (uint64_t)rf_raster_stride(raster) * (uint64_t)raster->height : 0;
}

/* The sum cannot overflow: each of its parts was checked, or is a few bytes for each of 2^32
 * pixels. */
int rf_check_memory(const struct rf_read *read, uint64_t more)
{
    const uint64_t gain = read->gain ? raster_bytes(&read->gain->samples) : 0;

    return check(read,
                 read->file_bytes + raster_bytes(&read->image) + raster_bytes(&read->samples) +
                     raster_bytes(&read->confidence) + raster_bytes(&read->holes) +
                     raster_bytes(&read->matte) + gain + more,
                 read->limits.max_memory, "decoding it");
}

int rf_raster_alloc(const struct rf_read *read, struct rf_raster *raster)
{
    const size_t bytes = (size_t)raster->channels * rf_sample_bytes(raster->sample);
    int status = rf_check_size(read, (uint64_t)raster->width, (uint64_t)raster->height, bytes);

    raster->pixels = NULL;
    if (status == REFOCUS_OK)
        status = rf_check_memory(read, (uint64_t)raster->width * (uint64_t)raster->height * bytes);
    if (status != REFOCUS_OK)
        return status;
    raster->pixels = malloc((size_t)raster->width * (size_t)raster->height * bytes);
    return raster->pixels ? REFOCUS_OK : rf_fail_memory(read->reason);
}

bool rf_wants_alpha(const struct rf_read *read)
{
    return !read->picture_always;
}

int rf_part_alpha(struct rf_read *read)
{
    static const uint8_t zero[4] = {0};
    struct rf_raster *const raster = &read->image;
    const size_t sample = rf_sample_bytes(raster->sample);
    const size_t colour = (size_t)(raster->channels - 1) * sample;
    const size_t count = (size_t)raster->width * (size_t)raster->height;
    struct rf_raster holes = {.width = raster->width,
                              .height = raster->height,
                              .channels = 1,
                              .sample = REFOCUS_SAMPLE_U8,
                              .max_value = 255};
    const int status = rf_raster_alloc(read, &holes);
    bool any = false;

    if (status != REFOCUS_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *const from = raster->pixels + i * (colour + sample);
        const bool hole = memcmp(from + colour, zero, sample) == 0;

        holes.pixels[i] = hole ? 0 : 255;
        any |= hole;
        memmove(raster->pixels + i * colour, from, colour);
    }
    raster->channels--;
    if (any)
        read->holes = holes;
    else
        rf_raster_free(&holes);
    return REFOCUS_OK;
}
