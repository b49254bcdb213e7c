/* depth_part.c: pictures within a photo become its depth, its confidence and its original. */
#include "depth_part.h"

#include <string.h>

#include "convert.h"
#include "part.h"
#include "reason.h"

int rf_check_parts(const struct rf_read *read, const struct rf_bytes *parts, int count,
                   const char *what)
{
    const uint64_t most = read->limits.max_pixels;
    uint64_t sum = 0;

    for (int i = 0; i < count; i++) {
        const uint64_t pixels = parts[i].data ? rf_part_pixels(parts[i]) : 0;

        if (pixels > most)
            return REFOCUS_OK; /* the decoder has better words for that */
        sum += pixels;
    }
    if (sum > most) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %s have %llu pixels, more than the limit of %llu pixels", what,
                       (unsigned long long)sum, (unsigned long long)most);
    }
    return REFOCUS_OK;
}

static int take_grey(const struct rf_read *read, struct rf_bytes part, const char *what,
                     struct rf_raster *raster)
{
    int status = rf_decode_part(read, part, what, raster);

    if (status == REFOCUS_OK) {
        status = rf_raster_to_grey(read, raster);
        if (status == REFOCUS_ERR_NO_DEPTH) {
            status = rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                             "damaged: its %s is a colour picture", what);
        }
    }
    return status;
}

int rf_take_samples(struct rf_read *read, struct rf_bytes part, const char *what)
{
    return take_grey(read, part, what, &read->samples);
}

bool rf_is_matte(const char *type)
{
    return strcmp(type, RF_MATTE_TYPE) == 0 || strcmp(type, RF_MATTE_SUBTYPE) == 0;
}

int rf_take_matte(struct rf_read *read, struct rf_bytes part, const char *what)
{
    return take_grey(read, part, what, &read->matte);
}

int rf_take_confidence(struct rf_read *read, struct rf_bytes part, const char *what)
{
    struct rf_raster *const raster = &read->confidence;
    const size_t count = (size_t)read->samples.width * (size_t)read->samples.height;
    const int status = take_grey(read, part, what, raster);

    if (status != REFOCUS_OK)
        return status;
    if (raster->width != read->samples.width || raster->height != read->samples.height) {
        rf_note(read->info, "confidence: %d x %d samples, not as many as the depth: passed over",
                (int)raster->width, (int)raster->height);
        rf_raster_free(raster);
        return REFOCUS_OK;
    }
    for (size_t i = 0; i < count && raster->max_value != 255; i++) {
        /* In place: a byte is never written behind the sample that it is made of. */
        raster->pixels[i] = (uint8_t)(rf_raster_sample(raster, i) * 255 / raster->max_value);
    }
    raster->sample = REFOCUS_SAMPLE_U8;
    raster->max_value = 255;
    rf_note(read->info, "confidence: a byte for each sample of the depth, weighs it");
    return REFOCUS_OK;
}

int rf_take_original(struct rf_read *read, struct rf_bytes part, const char *what)
{
    const int status = rf_decode_part(read, part, what, &read->image);

    if (status == REFOCUS_OK) {
        read->info->original_used = 1;
        rf_note(read->info,
                "%.40s: the file's all-in-focus original is used, its main picture is "
                "the phone's blurred result",
                what);
    }
    return status;
}
