/* gdepth.c: Google's depth in XMP is read: GDepth is the map, GImage the all-in-focus original,
 * GFocus the phone's own focus. https://developers.google.com/depthmap-metadata/reference */
#include "gdepth.h"

#include <math.h>
#include <stdlib.h>

#include "apple.h"
#include "base64.h"
#include "depth_part.h"
#include "depth_range.h"
#include "gain_map.h"
#include "number.h"
#include "orient.h"
#include "part.h"
#include "reason.h"

/* The pictures of a packet, unpacked from Base64 in the places of their texts. */
struct pictures {
    /* data NULL: not there, not wanted, or no Base64 */
    struct rf_bytes depth, confidence, original, matte;
};

static struct rf_bytes unpack(const struct rf_xmp *xmp, enum rf_xmp_key key)
{
    struct rf_bytes part = {(const uint8_t *)xmp->value[key], 0};

    if (part.data)
        part.size = rf_base64_decode(xmp->value[key], xmp->length[key]);
    return part.size == (size_t)-1 || part.size == 0 ? (struct rf_bytes){NULL, 0} : part;
}

static int unpack_pictures(const struct rf_read *read, const struct rf_xmp *xmp,
                           struct pictures *pictures)
{
    const struct rf_bytes none = {NULL, 0};

    pictures->depth = unpack(xmp, RF_XMP_DEPTH_DATA);
    pictures->confidence = unpack(xmp, RF_XMP_DEPTH_CONFIDENCE);
    pictures->original = read->picture_always ? unpack(xmp, RF_XMP_IMAGE_DATA) : none;
    pictures->matte = read->picture_always ? unpack(xmp, RF_XMP_NOTE_MATTE) : none;
    return rf_check_parts(read,
                          (const struct rf_bytes[]){pictures->depth, pictures->confidence,
                                                    pictures->original, pictures->matte},
                          4, "GDepth and GImage");
}

/* Decode an unpacked picture by one of the functions of depth_part.h; the property is used up. */
static int decode_data(struct rf_read *read, struct rf_xmp *xmp, enum rf_xmp_key key,
                       struct rf_bytes part, const char *name,
                       int (*take)(struct rf_read *, struct rf_bytes, const char *))
{
    int status;

    if (!part.data)
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its %s is no base64", name);
    status = take(read, part, name);
    free(xmp->value[key]);
    xmp->value[key] = NULL;
    return status;
}

static int read_samples(struct rf_read *read, struct rf_xmp *xmp, const struct pictures *pictures)
{
    const char *const mime = xmp->value[RF_XMP_DEPTH_MIME];
    int status =
        decode_data(read, xmp, RF_XMP_DEPTH_DATA, pictures->depth, "GDepth:Data", rf_take_samples);

    if (status == REFOCUS_OK) {
        rf_note(read->info, "GDepth: %d x %d samples of %d bits (%.40s)", (int)read->samples.width,
                (int)read->samples.height, read->samples.sample == REFOCUS_SAMPLE_U16 ? 16 : 8,
                mime ? mime : "kind not said");
    }
    if (status == REFOCUS_OK && xmp->value[RF_XMP_DEPTH_CONFIDENCE]) {
        status = decode_data(read, xmp, RF_XMP_DEPTH_CONFIDENCE, pictures->confidence,
                             "GDepth:Confidence", rf_take_confidence);
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

    if (map->meaning != REFOCUS_DEPTH_DISPARITY || x < 0.0 || y < 0.0)
        return NAN;
    return (rf_raster_sample(samples,
                             (size_t)fmin(y, samples->height - 1) * (size_t)samples->width +
                                 (size_t)fmin(x, samples->width - 1)) -
            map->value_far) /
           (map->value_near - map->value_far);
}

/* K of the blur at infinity B, see own_blur in file.h. With 1/near - 1/far = 0.0515,
 * zf = 26.5 and B = 0.008 it is 0.0109 of the larger side. Where the range is not said,
 * disparity 0 stands for infinity, and K = B / d of the focus point. */
static double find_own_blur(const struct rf_read *read, const struct rf_depth_range *range)
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

static int read_focus(struct rf_read *read, const struct rf_xmp *xmp,
                      const struct rf_depth_range *range)
{
    struct refocus_photo_info *const info = read->info;
    double x, y;
    bool has_x, has_y, found;
    int status;

    status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_X, "GFocus:FocalPointX", &has_x, &x);
    if (status == REFOCUS_OK)
        status = rf_xmp_number(read, xmp, RF_XMP_FOCUS_Y, "GFocus:FocalPointY", &has_y, &y);
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
        if (range->metres > 0.0)
            info->focus_distance *= range->metres;
    }
    return status;
}

/* An orientation that the note in a result says, see editable.c. */
static int noted_orientation(const struct rf_xmp *xmp, enum rf_xmp_key key)
{
    double value;

    return xmp->value[key] && rf_parse_number(xmp->value[key], &value) && value >= 1.0 &&
                   value <= 8.0
               ? (int)value
               : 1;
}

static double noted(const struct rf_xmp *xmp, enum rf_xmp_key key)
{
    double value;

    return xmp->value[key] && rf_parse_number(xmp->value[key], &value) && value > 0.0 ? value : 0.0;
}

/* Depth in a result of ours may lie as it did in the first photo. */
static int read_note(struct rf_read *read, const struct rf_xmp *xmp)
{
    struct refocus_photo_info *const info = read->info;
    const int orientation = noted_orientation(xmp, RF_XMP_NOTE_DEPTH);

    info->edited_focus_disparity = noted(xmp, RF_XMP_NOTE_FOCUS);
    info->edited_max_blur_radius = noted(xmp, RF_XMP_NOTE_BLUR);
    info->simulated_f_number = noted(xmp, RF_XMP_NOTE_F_NUMBER);
    if (info->focus_x >= 0.0)
        rf_orient_point(&info->focus_x, &info->focus_y, orientation);
    read->kept.depth_orientation = rf_orient_both(orientation, read->orientation);
    return rf_raster_orient(read, &read->samples, orientation);
}

static int take_image(struct rf_read *read, struct rf_bytes part, const char *what)
{
    const int status = rf_decode_part(read, part, what, &read->image);

    return status == REFOCUS_OK ? rf_read_companions(read, part) : status;
}

/* The main picture is the phone's blurred result, or ours, unless GFocus says that it has no
 * blur. */
static int read_original(struct rf_read *read, struct rf_xmp *xmp, struct rf_bytes part)
{
    const bool ours = xmp->value[RF_XMP_NOTE_ORIGINAL];
    const int orientation = noted_orientation(xmp, RF_XMP_NOTE_ORIGINAL);
    int status;

    if (!read->picture_always || !xmp->value[RF_XMP_IMAGE_DATA])
        return REFOCUS_OK;
    if (!ours && xmp->value[RF_XMP_FOCUS_BLUR] && read->info->blur_at_infinity == 0.0) {
        rf_note(read->info, "GImage: original passed over, the main picture has no blur");
        return REFOCUS_OK;
    }
    status = decode_data(read, xmp, RF_XMP_IMAGE_DATA, part, "GImage:Data", take_image);
    if (status == REFOCUS_OK) {
        read->info->original_used = 1;
        read->kept.original_orientation = rf_orient_both(orientation, read->orientation);
        rf_note(read->info,
                "GImage: the file's all-in-focus original is used, its main picture is %s",
                ours ? "our result" : "the phone's blurred result");
        if (ours) {
            rf_note(read->info, "Refocus: the result has disparity %g in focus, blur %g pixels",
                    read->info->edited_focus_disparity, read->info->edited_max_blur_radius);
        }
        status = rf_raster_orient(read, &read->image, orientation);
    }
    if (status == REFOCUS_OK)
        status = rf_raster_orient(read, &read->matte, orientation);
    if (status == REFOCUS_OK && read->gain)
        status = rf_raster_orient(read, &read->gain->samples, orientation);
    return status;
}

/* A matte that was given for an earlier result, upright, in place of the original's own. */
static int read_matte(struct rf_read *read, struct rf_xmp *xmp, struct rf_bytes part)
{
    if (!read->picture_always || !xmp->value[RF_XMP_NOTE_MATTE])
        return REFOCUS_OK;
    rf_raster_free(&read->matte);
    read->kept.matte = true;
    rf_note(read->info, "Refocus: a matte in the file says how much of a pixel is subject");
    return decode_data(read, xmp, RF_XMP_NOTE_MATTE, part, "Refocus:Matte", rf_take_matte);
}

int rf_read_gdepth(struct rf_read *read, struct rf_xmp *xmp)
{
    static const struct rf_range_keys keys = {
        "GDepth",           NULL, RF_XMP_DEPTH_FORMAT, RF_XMP_DEPTH_NEAR, RF_XMP_DEPTH_FAR,
        RF_XMP_DEPTH_UNITS,
    };
    struct rf_depth_range range = {0.0, 0.0, 0.0};
    struct pictures pictures;
    int status;

    if (!xmp->value[RF_XMP_DEPTH_DATA]) {
        if (xmp->value[RF_XMP_DEPTH_FORMAT]) {
            return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                           "damaged: it announces GDepth but holds no GDepth:Data");
        }
        return REFOCUS_OK;
    }
    status = unpack_pictures(read, xmp, &pictures);
    if (status == REFOCUS_OK)
        status = read_samples(read, xmp, &pictures);
    if (status == REFOCUS_OK)
        status = rf_set_range(read, xmp, &keys, &range);
    if (status == REFOCUS_OK)
        status = read_focus(read, xmp, &range);
    if (status == REFOCUS_OK)
        status = read_note(read, xmp);
    if (status == REFOCUS_OK)
        status = read_original(read, xmp, pictures.original);
    if (status == REFOCUS_OK)
        status = read_matte(read, xmp, pictures.matte);
    if (status == REFOCUS_OK)
        read->info->depth_source = REFOCUS_DEPTH_SOURCE_GDEPTH;
    return status;
}
