/* fuzz.h: readings and checks that the targets of this folder share. */
#ifndef RF_FUZZ_FILE_H
#define RF_FUZZ_FILE_H

#include <stdlib.h>
#include <string.h>

#include "base64.h"
#include "convert.h"
#include "dynamic.h"
#include "exif.h"
#include "format.h"
#include "gdepth.h"
#include "heif_boxes.h"
#include "heif_targets.h"
#include "heif_tone_map.h"
#include "heif_turn.h"
#include "mpf.h"
#include "number.h"
#include "read.h"
#include "xmp_extended.h"
#include "xmp_parse.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Bounds that keep a run short; readers must keep them anyway. */
static const struct refocus_read_limits fuzz_limits = {
    .struct_size = sizeof fuzz_limits,
    .max_pixels = 1u << 20,
    .max_bytes = 1u << 23,
    .max_memory = UINT64_C(1) << 30}; /* 0 would ask the system how much there is, each time. */

/* A reading as rf_read_begin() sets it up. */
struct fuzz_reading {
    struct rf_read read;
    struct refocus_photo_info info;
    struct refocus_reason reason;
};

static inline void fuzz_begin(struct fuzz_reading *reading)
{
    memset(reading, 0, sizeof *reading);
    rf_read_limits(&reading->read.limits, &fuzz_limits, &reading->reason); /* fills in the zeros */
    reading->read.reason = &reading->reason;
    reading->read.info = &reading->info;
    reading->read.picture_always = true;
    reading->read.orientation = 1;
}

static inline void fuzz_end(struct fuzz_reading *reading)
{
    rf_raster_free(&reading->read.image);
    rf_raster_free(&reading->read.deep);
    rf_raster_free(&reading->read.samples);
    rf_raster_free(&reading->read.confidence);
    rf_raster_free(&reading->read.matte);
    free(reading->read.exif.data);
    free(reading->read.icc.data);
    free(reading->read.kept.bytes.data);
}

/* Checks the promises that the caller may rely on; reads every byte, for the sanitizers. */
static inline void fuzz_check_photo(const struct refocus_photo *photo)
{
    volatile unsigned sum = 0;

    if (photo->image->plane[0]) {
        for (int32_t y = 0; y < photo->image->height; y++)
            for (int32_t x = 0; x < photo->image->width * 3; x++)
                sum += photo->image->plane[0][y * photo->image->stride[0] + x];
    }
    if (photo->depth->samples) {
        const uint8_t *const samples = photo->depth->samples;
        const int32_t bytes = (int32_t)rf_sample_bytes(photo->depth->sample);
        for (int32_t y = 0; y < photo->depth->height; y++)
            for (int32_t x = 0; x < photo->depth->width * bytes; x++)
                sum += samples[y * photo->depth->stride + x];
        if (photo->depth->meaning != REFOCUS_DEPTH_DISPARITY &&
            photo->depth->meaning != REFOCUS_DEPTH_DISTANCE)
            abort();
        if (photo->info->depth_source == REFOCUS_DEPTH_SOURCE_NONE ||
            !(photo->depth->near_m >= 0.0) || !(photo->depth->far_m >= 0.0))
            abort();
    }
    if (photo->matte->samples) {
        const uint8_t *const samples = photo->matte->samples;
        for (int32_t i = 0; i < photo->matte->height * (int32_t)photo->matte->stride; i++)
            sum += samples[i];
    }
    if (photo->confidence)
        for (int32_t i = 0; i < photo->depth->width * photo->depth->height; i++)
            sum += photo->confidence[i];
    for (size_t i = 0; i < photo->exif.size; i++)
        sum += photo->exif.data[i];
    for (size_t i = 0; i < photo->icc.size; i++)
        sum += photo->icc.data[i];
    (void)sum;
    if (photo->info->evidence_count > REFOCUS_INFO_LINES || photo->info->orientation < 1 ||
        photo->info->orientation > 8)
        abort();
}

#endif
