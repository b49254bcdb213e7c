/* gdepth_write.c: depth and its confidence become PNGs and the properties of GDepth and GFocus that
 * go with it. */
#include "gdepth_write.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats.h"
#include "orient.h"
#include "reason.h"
#include "rows.h"
#include "store.h"
#include "xmp.h"

#define GFOCUS " xmlns:GFocus=\"" RF_NS_FOCUS "\""

bool rf_gdepth_is_good(const struct refocus_depth_write *depth)
{
    return depth->disparity && depth->width >= 1 && depth->width <= REFOCUS_MAX_SIDE &&
           depth->height >= 1 && depth->height <= REFOCUS_MAX_SIDE && depth->stride % 2 == 0 &&
           rf_good_rows(depth->stride, 2 * (int64_t)depth->width, depth->height) &&
           (!depth->confidence ||
            rf_good_rows(depth->confidence_stride, depth->width, depth->height)) &&
           depth->focus_x <= 1 && depth->focus_y <= 1 && isfinite(depth->near_m) &&
           !isnan(depth->far_m) && !isnan(depth->focus_distance) &&
           isfinite(depth->blur_at_infinity);
}

/* RangeInverse: 0 is near, 65535 far. */
static void fill_depth(uint16_t *out, const struct refocus_depth_write *depth)
{
    for (int32_t y = 0; y < depth->height; y++) {
        const uint16_t *const in =
            (const uint16_t *)((const char *)depth->disparity + y * depth->stride);

        for (int32_t x = 0; x < depth->width; x++)
            *out++ = (uint16_t)(65535 - in[x]);
    }
}

static void fill_samples(uint16_t *out, const struct refocus_depth_write *depth)
{
    for (int32_t y = 0; y < depth->height; y++) {
        memcpy(out + (size_t)y * (size_t)depth->width,
               (const char *)depth->disparity + y * depth->stride, 2 * (size_t)depth->width);
    }
}

static void fill_confidence(uint16_t *out, const struct refocus_depth_write *depth)
{
    for (int32_t y = 0; y < depth->height; y++)
        for (int32_t x = 0; x < depth->width; x++)
            *out++ = (uint16_t)(257 * depth->confidence[y * depth->confidence_stride + x]);
}

static int write_png(struct refocus_blob *png, const struct rf_raster *raster,
                     struct refocus_reason *reason)
{
    struct rf_rows rows = {.format = REFOCUS_FORMAT_NONE,
                           .top = raster->pixels,
                           .width = raster->width,
                           .height = raster->height,
                           .stride = (ptrdiff_t)rf_raster_stride(raster)};
    struct rf_store store;
    int status = rf_store_open_memory(&store, reason);

    if (status != REFOCUS_OK)
        return status;
    status = rf_format_of_name(".png")->write(&store, &rows, NULL, reason);
    return rf_store_close_memory(&store, status, png, reason);
}

/* Write an attribute whose value is a PNG of the size of the depth. */
static int put_png(struct rf_text *text, const char *begin,
                   void (*fill)(uint16_t *out, const struct refocus_depth_write *depth),
                   const struct refocus_depth_write *depth, int orientation,
                   struct refocus_reason *reason)
{
    struct rf_read read = {.reason = reason};
    struct rf_raster raster = {.width = depth->width,
                               .height = depth->height,
                               .channels = 1,
                               .sample = REFOCUS_SAMPLE_U16,
                               .max_value = 65535};
    struct refocus_blob png = {NULL, 0};
    int status;

    read.limits.max_side = REFOCUS_MAX_SIDE;
    read.limits.max_pixels = read.limits.max_bytes = read.limits.max_memory = UINT64_MAX / 16;
    status = rf_raster_alloc(&read, &raster);
    if (status != REFOCUS_OK)
        return status;
    fill((uint16_t *)(void *)raster.pixels, depth);
    status = rf_raster_orient(&read, &raster, rf_orient_inverse(orientation));
    if (status == REFOCUS_OK)
        status = write_png(&png, &raster, reason);
    rf_raster_free(&raster);
    if (status == REFOCUS_OK) {
        rf_text_words(text, begin);
        rf_text_base64(text, (struct rf_bytes){png.data, png.size});
        rf_text_words(text, "\"");
    }
    free(png.data);
    return status;
}

int rf_gdepth_put_samples(struct rf_text *text, const char *begin,
                          const struct refocus_depth_write *samples, struct refocus_reason *reason)
{
    return put_png(text, begin, fill_samples, samples, 1, reason);
}

int rf_gdepth_put_data(struct rf_text *text, const struct refocus_depth_write *depth,
                       int orientation, struct refocus_reason *reason)
{
    int status = put_png(text, " GDepth:Data=\"", fill_depth, depth, orientation, reason);

    if (status == REFOCUS_OK && depth->confidence) {
        status =
            put_png(text, " GDepth:Confidence=\"", fill_confidence, depth, orientation, reason);
    }
    return status;
}

void rf_gdepth_put(struct rf_text *text, const struct refocus_depth_write *depth, int orientation)
{
    rf_text_words(text, " GDepth:Format=\"RangeInverse\" GDepth:Mime=\"image/png\"");
    if (depth->confidence)
        rf_text_words(text, " GDepth:ConfidenceMime=\"image/png\"");
    if (depth->near_m > 0 && depth->far_m > depth->near_m) {
        rf_text_number(text, " GDepth:Near", depth->near_m);
        /* Far has to be a number; farther than this no blur can be told from
         * infinity. */
        rf_text_number(text, " GDepth:Far", isfinite(depth->far_m) ? depth->far_m : 1e9);
        rf_text_words(text, " GDepth:Units=\"m\"");
    }
    if (depth->focus_x >= 0 && depth->focus_y >= 0) {
        double x = depth->focus_x, y = depth->focus_y;

        rf_orient_point(&x, &y, rf_orient_inverse(orientation));
        rf_text_words(text, GFOCUS);
        rf_text_number(text, " GFocus:FocalPointX", x);
        rf_text_number(text, " GFocus:FocalPointY", y);
        if (depth->focus_distance > 0 && isfinite(depth->focus_distance))
            rf_text_number(text, " GFocus:FocalDistance", depth->focus_distance);
        if (depth->blur_at_infinity > 0)
            rf_text_number(text, " GFocus:BlurAtInfinity", depth->blur_at_infinity);
    }
}
