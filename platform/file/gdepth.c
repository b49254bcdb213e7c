/* gdepth.c: Google's depth in XMP is read: GDepth is the map, GImage the all-in-focus original,
 * GFocus the phone's own focus. https://developers.google.com/depthmap-metadata/reference */
#include "gdepth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base64.h"
#include "convert.h"
#include "part.h"
#include "reason.h"

/* Near and Far as the file says them, and its unit. */
struct range {
    double near, far; /* both 0: not said */
    double metres;    /* in a unit; 0: no unit that is known */
};

static int read_range(const struct rf_read *read, const struct rf_xmp *xmp, struct range *range)
{
    const char *const units = xmp->value[RF_XMP_DEPTH_UNITS];
    bool has_near, has_far;
    int status;

    status = rf_xmp_number(read, xmp, RF_XMP_DEPTH_NEAR, "GDepth:Near", &has_near, &range->near);
    if (status == REFOCUS_OK) {
        status = rf_xmp_number(read, xmp, RF_XMP_DEPTH_FAR, "GDepth:Far", &has_far, &range->far);
    }
    if (status != REFOCUS_OK) {
        return status;
    }
    range->metres = !units                     ? 0.0
                    : strcmp(units, "m") == 0  ? 1.0
                    : strcmp(units, "mm") == 0 ? 0.001
                                               : 0.0;
    if (!has_near || !has_far) {
        range->near = range->far = 0.0;
        rf_note(read->info, "GDepth: no Near and Far: distances are unknown");
        return REFOCUS_OK;
    }
    if (range->near < 0.0 || range->far <= range->near) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its GDepth:Near %g and GDepth:Far %g are no range", range->near,
                       range->far);
    }
    if (!units) {
        rf_note(read->info, "GDepth: Near %g, Far %g without a unit: no metres", range->near,
                range->far);
    } else if (range->metres > 0.0) {
        rf_note(read->info, "GDepth: Near %g %s, Far %g %s", range->near, units, range->far, units);
    } else {
        rf_note(read->info, "GDepth: Near %g, Far %g in \"%.40s\": no metres", range->near,
                range->far, units);
    }
    return REFOCUS_OK;
}

/* Distances of an unknown unit as disparities, which need none: linear in 1/z, the
 * nearest 65535. */
static int linear_to_disparity(struct rf_read *read, const struct range *range)
{
    struct rf_raster disparity = read->samples;
    const size_t count = (size_t)disparity.width * (size_t)disparity.height;
    const double step = (range->far - range->near) / disparity.max_value;
    const double near = range->near > 0.0 ? range->near : step; /* 1/0 is no disparity */
    int status;

    disparity.sample = REFOCUS_SAMPLE_U16;
    disparity.max_value = 65535;
    status = rf_raster_alloc(read, &disparity);
    if (status != REFOCUS_OK) {
        return status;
    }
    for (size_t i = 0; i < count; i++) {
        const double z = fmax(range->near + rf_raster_sample(&read->samples, i) * step, near);
        const double d = (1.0 / z - 1.0 / range->far) / (1.0 / near - 1.0 / range->far);

        /* fmax() makes 0 of NaN, where 1 / Near is more than a double holds. */
        ((uint16_t *)(void *)disparity.pixels)[i] =
            (uint16_t)(fmin(fmax(d, 0.0), 1.0) * 65535.0 + 0.5);
    }
    rf_raster_free(&read->samples);
    read->samples = disparity;
    read->depth.meaning = REFOCUS_DEPTH_DISPARITY;
    read->depth.value_near = 65535.0;
    read->depth.value_far = 0.0;
    rf_note(read->info, "GDepth: RangeLinear without a unit: taken over as disparities");
    return REFOCUS_OK;
}

static int set_meaning(struct rf_read *read, const struct rf_xmp *xmp, struct range *range)
{
    const char *const format = xmp->value[RF_XMP_DEPTH_FORMAT];
    struct refocus_depth_map *const map = &read->depth;
    const double max = read->samples.max_value;
    int status = read_range(read, xmp, range);

    if (status != REFOCUS_OK) {
        return status;
    }
    map->near_m = range->near * range->metres;
    map->far_m = range->far * range->metres;
    if (format && strcmp(format, "RangeInverse") == 0) {
        map->meaning = REFOCUS_DEPTH_DISPARITY;
        map->value_near = 0.0;
        map->value_far = max;
        rf_note(read->info, "GDepth: RangeInverse: linear in 1/z, 0 is near, %g is far", max);
        return REFOCUS_OK;
    }
    if (format && strcmp(format, "RangeLinear") == 0) {
        if (range->far <= 0.0) {
            return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                           "damaged: its GDepth is RangeLinear without Near and Far");
        }
        if (range->metres == 0.0) {
            return linear_to_disparity(read, range);
        }
        map->meaning = REFOCUS_DEPTH_DISTANCE;
        map->metres_at_zero = map->near_m;
        map->metres_per_unit = (map->far_m - map->near_m) / max;
        rf_note(read->info, "GDepth: RangeLinear: linear in z, 0 is near, %g is far", max);
        return REFOCUS_OK;
    }
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                   "damaged: its GDepth:Format is neither RangeInverse nor RangeLinear");
}

/* Base64 text of a property to a picture; the text is used up. */
static int decode_data(struct rf_read *read, struct rf_xmp *xmp, enum rf_xmp_key key,
                       const char *name, struct rf_raster *raster)
{
    const size_t size = rf_base64_decode(xmp->value[key], xmp->length[key]);
    const struct rf_bytes part = {(const uint8_t *)xmp->value[key], size};
    int status;

    if (size == (size_t)-1 || size == 0) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its %s is no base64", name);
    }
    status = rf_decode_part(read, part, name, raster);
    free(xmp->value[key]);
    xmp->value[key] = NULL;
    return status;
}

static int read_samples(struct rf_read *read, struct rf_xmp *xmp)
{
    const char *const mime = xmp->value[RF_XMP_DEPTH_MIME];
    int status = decode_data(read, xmp, RF_XMP_DEPTH_DATA, "GDepth:Data", &read->samples);

    if (status == REFOCUS_OK) {
        status = rf_raster_to_grey(read, &read->samples);
        if (status == REFOCUS_ERR_NO_DEPTH) {
            status = rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                             "damaged: its GDepth:Data is a colour picture");
        }
    }
    if (status == REFOCUS_OK) {
        rf_note(read->info, "GDepth: %d x %d samples of %d bits (%.40s)", (int)read->samples.width,
                (int)read->samples.height, read->samples.sample == REFOCUS_SAMPLE_U16 ? 16 : 8,
                mime ? mime : "kind not said");
    }
    return status;
}

/* Disparity at the focus point, or NAN. */
static double focus_disparity(const struct rf_read *read)
{
    const struct rf_raster *const samples = &read->samples;
    const struct refocus_depth_map *const map = &read->depth;
    const double x = read->info->focus_x * samples->width;
    const double y = read->info->focus_y * samples->height;

    if (map->meaning != REFOCUS_DEPTH_DISPARITY || x < 0.0 || y < 0.0) {
        return NAN;
    }
    return (rf_raster_sample(samples,
                             (size_t)fmin(y, samples->height - 1) * (size_t)samples->width +
                                 (size_t)fmin(x, samples->width - 1)) -
            map->value_far) /
           (map->value_near - map->value_far);
}

/* K of the blur at infinity B, see own_blur in file.h. With 1/near - 1/far = 0.0515,
 * zf = 26.5 and B = 0.008 it is 0.0109 of the larger side. Where the range is not said,
 * disparity 0 stands for infinity, and K = B / d of the focus point. */
static double find_own_blur(const struct rf_read *read, const struct range *range)
{
    const struct refocus_photo_info *const info = read->info;
    const bool known = range->near > 0.0;
    const double inverse_far = known ? 1.0 / range->far : 0.0;
    const double across = (known ? 1.0 / range->near : 1.0) - inverse_far;
    const double inverse_focus = known && info->focus_distance > 0.0
                                     ? 1.0 / info->focus_distance
                                     : inverse_far + focus_disparity(read) * across;
    const double blur = info->blur_at_infinity * across / inverse_focus;

    return isfinite(blur) && blur > 0.0 ? blur : 0.0;
}

static int read_focus(struct rf_read *read, const struct rf_xmp *xmp, const struct range *range)
{
    struct refocus_photo_info *const info = read->info;
    double x, y;
    bool has_x, has_y, found;
    int status;

    status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_X, "GFocus:FocalPointX", &has_x, &x);
    if (status == REFOCUS_OK) {
        status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_Y, "GFocus:FocalPointY", &has_y, &y);
    }
    if (status == REFOCUS_OK) {
        status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_DISTANCE, "GFocus:FocalDistance", &found,
                               &info->focus_distance);
    }
    if (status == REFOCUS_OK) {
        status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_BLUR, "GFocus:BlurAtInfinity", &found,
                               &info->blur_at_infinity);
    }
    if (status == REFOCUS_OK) {
        if (has_x && has_y && x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0) {
            info->focus_x = x;
            info->focus_y = y;
        }
        info->own_blur = find_own_blur(read, range);
        if (range->metres > 0.0) {
            info->focus_distance *= range->metres;
        }
    }
    return status;
}

/* The main picture is the phone's blurred result unless GFocus says that it has no
 * blur. */
static int read_original(struct rf_read *read, struct rf_xmp *xmp)
{
    int status;

    if (!read->picture_always || !xmp->value[RF_XMP_IMAGE_DATA]) {
        return REFOCUS_OK;
    }
    if (xmp->value[RF_XMP_FOCUS_BLUR] && read->info->blur_at_infinity == 0.0) {
        rf_note(read->info, "GImage: original passed over, the main picture has no blur");
        return REFOCUS_OK;
    }
    status = decode_data(read, xmp, RF_XMP_IMAGE_DATA, "GImage:Data", &read->image);
    if (status == REFOCUS_OK) {
        read->info->original_used = 1;
        rf_note(read->info, "GImage: the file's all-in-focus original is used, its main picture is "
                            "the phone's blurred result");
    }
    return status;
}

int rf_read_gdepth(struct rf_read *read, struct rf_xmp *xmp)
{
    struct range range = {0.0, 0.0, 0.0};
    int status;

    if (!xmp->value[RF_XMP_DEPTH_DATA]) {
        if (xmp->value[RF_XMP_DEPTH_FORMAT]) {
            return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                           "damaged: it announces GDepth but holds no GDepth:Data");
        }
        return REFOCUS_OK;
    }
    status = read_samples(read, xmp);
    if (status == REFOCUS_OK) {
        status = set_meaning(read, xmp, &range);
    }
    if (status == REFOCUS_OK) {
        status = read_focus(read, xmp, &range);
    }
    if (status == REFOCUS_OK) {
        status = read_original(read, xmp);
    }
    if (status == REFOCUS_OK) {
        read->info->depth_source = REFOCUS_DEPTH_SOURCE_GDEPTH;
    }
    return status;
}
