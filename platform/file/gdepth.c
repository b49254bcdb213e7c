/* Google's depth in XMP: GDepth the map, GImage the all-in-focus original, GFocus the
 * phone's own focus. https://developers.google.com/depthmap-metadata/reference */
#include "internal.h"

#include <string.h>

void rf_xmp_free(struct rf_xmp *xmp)
{
    for (int key = 0; key < RF_XMP_KEYS; key++) {
        free(xmp->value[key]);
        xmp->value[key] = NULL;
    }
}

int rf_xmp_number(const struct rf_read *read, const struct rf_xmp *xmp,
                  enum rf_xmp_key key, const char *name, bool *found, double *value)
{
    *found = false;
    *value = 0.0;
    if (!xmp->value[key]) {
        return REFOCUS_OK;
    }
    if (!rf_parse_number(xmp->value[key], value)) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its %s is no number",
                       name);
    }
    *found = true;
    return REFOCUS_OK;
}

/* Near and Far as metres; both 0 when not said. */
static int read_range(const struct rf_read *read, const struct rf_xmp *xmp,
                      double *near_m, double *far_m, double *unit)
{
    const char *const units = xmp->value[RF_XMP_DEPTH_UNITS];
    bool has_near, has_far;
    int status;

    status =
        rf_xmp_number(read, xmp, RF_XMP_DEPTH_NEAR, "GDepth:Near", &has_near, near_m);
    if (status == REFOCUS_OK) {
        status =
            rf_xmp_number(read, xmp, RF_XMP_DEPTH_FAR, "GDepth:Far", &has_far, far_m);
    }
    if (status != REFOCUS_OK) {
        return status;
    }
    *unit = units && strcmp(units, "mm") == 0 ? 0.001 : 1.0;
    if (!has_near || !has_far) {
        *near_m = *far_m = 0.0;
        rf_note(read->info, "GDepth: no Near and Far: distances are unknown");
        return REFOCUS_OK;
    }
    if (*near_m < 0.0 || *far_m <= *near_m) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its GDepth:Near %g and GDepth:Far %g are no range",
                       *near_m, *far_m);
    }
    if (!units) {
        rf_note(read->info, "GDepth: Near %g, Far %g without a unit: taken for metres",
                *near_m, *far_m);
    } else if (*unit != 1.0 || strcmp(units, "m") == 0) {
        rf_note(read->info, "GDepth: Near %g %s, Far %g %s", *near_m, units, *far_m,
                units);
    } else {
        rf_note(read->info, "GDepth: Near %g, Far %g in \"%.40s\": taken for metres",
                *near_m, *far_m, units);
    }
    *near_m *= *unit;
    *far_m *= *unit;
    return REFOCUS_OK;
}

static int set_meaning(struct rf_read *read, const struct rf_xmp *xmp, double *unit)
{
    const char *const format = xmp->value[RF_XMP_DEPTH_FORMAT];
    struct refocus_depth_map *const map = &read->depth;
    const double max = read->samples.max_value;
    double near_m, far_m;
    int status = read_range(read, xmp, &near_m, &far_m, unit);

    if (status != REFOCUS_OK) {
        return status;
    }
    map->near_m = near_m;
    map->far_m = far_m;
    if (format && strcmp(format, "RangeInverse") == 0) {
        map->meaning = REFOCUS_DEPTH_DISPARITY;
        map->value_near = 0.0;
        map->value_far = max;
        rf_note(read->info, "GDepth: RangeInverse: linear in 1/z, 0 is near, %g is far",
                max);
        return REFOCUS_OK;
    }
    if (format && strcmp(format, "RangeLinear") == 0) {
        if (far_m <= 0.0) {
            return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                           "damaged: its GDepth is RangeLinear without Near and Far");
        }
        map->meaning = REFOCUS_DEPTH_DISTANCE;
        map->metres_at_zero = near_m;
        map->metres_per_unit = (far_m - near_m) / max;
        rf_note(read->info, "GDepth: RangeLinear: linear in z, 0 is near, %g is far",
                max);
        return REFOCUS_OK;
    }
    return rf_fail(
        read->reason, REFOCUS_ERR_FORMAT,
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
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its %s is no base64",
                       name);
    }
    status = rf_decode_part(read, part, name, raster);
    free(xmp->value[key]);
    xmp->value[key] = NULL;
    return status;
}

static int read_samples(struct rf_read *read, struct rf_xmp *xmp)
{
    const char *const mime = xmp->value[RF_XMP_DEPTH_MIME];
    int status =
        decode_data(read, xmp, RF_XMP_DEPTH_DATA, "GDepth:Data", &read->samples);

    if (status == REFOCUS_OK) {
        status = rf_raster_to_grey(read, &read->samples);
        if (status == REFOCUS_ERR_NO_DEPTH) {
            status = rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                             "damaged: its GDepth:Data is a colour picture");
        }
    }
    if (status == REFOCUS_OK) {
        rf_note(read->info, "GDepth: %d x %d samples of %d bits (%.40s)",
                (int)read->samples.width, (int)read->samples.height,
                read->samples.sample == REFOCUS_SAMPLE_U16 ? 16 : 8,
                mime ? mime : "kind not said");
    }
    return status;
}

static int read_focus(struct rf_read *read, const struct rf_xmp *xmp, double unit)
{
    struct refocus_photo_info *const info = read->info;
    double x, y;
    bool has_x, has_y, found;
    int status;

    status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_X, "GFocus:FocalPointX", &has_x, &x);
    if (status == REFOCUS_OK) {
        status =
            rf_xmp_number(read, xmp, RF_XMP_FOCUS_Y, "GFocus:FocalPointY", &has_y, &y);
    }
    if (status == REFOCUS_OK) {
        status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_DISTANCE, "GFocus:FocalDistance",
                               &found, &info->focus_distance);
    }
    if (status == REFOCUS_OK) {
        status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_BLUR, "GFocus:BlurAtInfinity",
                               &found, &info->blur_at_infinity);
    }
    if (status == REFOCUS_OK) {
        info->focus_distance *= unit;
        if (has_x && has_y && x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0) {
            info->focus_x = x;
            info->focus_y = y;
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
        rf_note(read->info,
                "GImage: original passed over, the main picture has no blur");
        return REFOCUS_OK;
    }
    status = decode_data(read, xmp, RF_XMP_IMAGE_DATA, "GImage:Data", &read->image);
    if (status == REFOCUS_OK) {
        read->info->original_used = 1;
        rf_note(read->info,
                "GImage: the file's all-in-focus original is used, its main picture is "
                "the phone's blurred result");
    }
    return status;
}

int rf_read_gdepth(struct rf_read *read, struct rf_xmp *xmp)
{
    double unit;
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
        status = set_meaning(read, xmp, &unit);
    }
    if (status == REFOCUS_OK) {
        status = read_focus(read, xmp, unit);
    }
    if (status == REFOCUS_OK) {
        status = read_original(read, xmp);
    }
    if (status == REFOCUS_OK) {
        read->info->depth_source = REFOCUS_DEPTH_SOURCE_GDEPTH;
    }
    return status;
}
