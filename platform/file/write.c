/* write.c: pictures and depth maps are written, in the format that the end of the name says. */
#include <math.h>

#include <refocus/platform/file.h>

#include "formats.h"
#include "gain_make.h"
#include "gdepth_write.h"
#include "kept.h"
#include "reason.h"
#include "rows.h"
#include "store.h"

static int write_rows(const char *path, const struct rf_format *format, const struct rf_rows *rows,
                      const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct rf_store store;
    int status;

    /* A missing encoder is refused before a file is made. */
    if (!format->write)
        return rf_fail_absent(reason, format->name, format->library);
    status = rf_store_open(&store, path, reason);
    if (status != REFOCUS_OK)
        return status;
    store.unsynced = options->unsynced;
    store.cancelled = options->cancelled;
    store.user = options->user;
    if (rf_store_goes_on(&store))
        status = format->write(&store, rows, options, reason);
    return rf_store_close(&store, status, reason);
}

/* The ending belongs to no format that is written so. */
static int fail_ending(struct refocus_reason *reason, bool depth)
{
    char endings[192];

    rf_list_endings(endings, sizeof endings, depth);
    return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                   "a %s is written as %s; end the name in one of them",
                   depth ? "depth map" : "picture", endings);
}

static bool fits(int64_t width, int64_t height, ptrdiff_t stride, int64_t pixel_bytes)
{
    return width >= 1 && width <= REFOCUS_MAX_SIDE && height >= 1 && height <= REFOCUS_MAX_SIDE &&
           rf_good_rows(stride, width * pixel_bytes, height);
}

/* The structs that make a picture editable, read once. */
struct editable {
    struct refocus_editable given;
    struct refocus_depth_write depth;
};

/* Whether a JPEG or a PNG holds all of a photo. */
static bool is_storable(const struct refocus_photo *photo)
{
    return photo->image->plane[0] &&
           (!photo->deep->plane[0] || photo->deep->format == REFOCUS_FORMAT_RGB16);
}

static int check_editable(struct refocus_write_options *parts, const struct rf_format *format,
                          struct editable *own, struct refocus_reason *reason)
{
#if defined(RF_HAVE_XMP) && defined(RF_HAVE_PNG) && defined(RF_HAVE_JPEG)
    const bool can = true;
#else
    const bool can = false;
#endif
    int status;

    if (!parts->editable)
        return REFOCUS_OK;
    if ((status = refocus_struct_read(&own->given, sizeof own->given,
                                      REFOCUS_SIZE_TO(struct refocus_editable, simulated_f_number),
                                      parts->editable)))
        return rf_fail(reason, status, "the editable is not of a known size of struct");
    if ((own->given.depth || !own->given.own_depth) &&
        (status = refocus_struct_read(&own->depth, sizeof own->depth,
                                      REFOCUS_SIZE_TO(struct refocus_depth_write, blur_at_infinity),
                                      own->given.depth)))
        return rf_fail(reason, status, "the depth is not of a known size of struct");
    if (!parts->keep || !isfinite(own->given.focus_disparity) ||
        !isfinite(own->given.max_blur_radius) || !isfinite(own->given.simulated_f_number) ||
        ((own->given.depth || !own->given.own_depth) && !rf_gdepth_is_good(&own->depth)) ||
        (own->given.matte &&
         (own->given.matte_stride % 2 != 0 ||
          !fits(own->given.matte_width, own->given.matte_height, own->given.matte_stride, 2)))) {
        return rf_fail(
            reason, REFOCUS_ERR_ARGUMENT,
            "there is no photo to keep, or the depth, matte or lens is out of its range");
    }
    if ((format != &rf_format_jpeg && format != &rf_format_heic) || !can ||
        !is_storable(parts->keep)) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED, "%s",
                       can ? "a picture is editable as a JPEG or HEIC, made from a photo that is "
                             "not of floats"
                           : "an editable picture needs expat, libpng and TurboJPEG, one of which "
                             "this build lacks");
    }
    own->given.depth = own->given.depth ? &own->depth : NULL;
    parts->editable = &own->given;
    return REFOCUS_OK;
}

static int check_light(struct refocus_write_options *parts, const struct rf_format *format,
                       const struct rf_rows *rows, struct refocus_image *own,
                       struct refocus_reason *reason)
{
    int status;

    if (!parts->light)
        return REFOCUS_OK;
    if ((status = refocus_image_read(own, parts->light)))
        return rf_fail(reason, status, "the light is not of a known size of struct");
    if (!rf_gain_can_make(rows, own)) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                       "the light is no picture of halves, or the picture is not RGB8");
    }
    if (format != &rf_format_jpeg) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED, "%s holds no gain map; write a JPEG",
                       format->name);
    }
    parts->light = own;
    return REFOCUS_OK;
}

int refocus_image_write(const char *path, const struct refocus_image *image,
                        const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_rows rows;
    const struct rf_format *format;
    struct refocus_image own, light;
    struct refocus_write_options parts = refocus_write_options_default();
    struct editable editable;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if ((status = refocus_image_read(&own, image)))
        return rf_fail(reason, status, "the picture is not of a known size of struct");
    image = &own;
    if (options && (status = refocus_struct_read(
                        &parts, sizeof parts,
                        REFOCUS_SIZE_TO(struct refocus_write_options, unsynced), options)))
        return rf_fail(reason, status, "the options are not of a known size of struct");
    if (!path || !image->plane[0] || rf_format_bytes(image->format) == 0 ||
        !fits(image->width, image->height, image->stride[0], rf_format_bytes(image->format)) ||
        parts.quality < 0 || parts.quality > 100) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                       "the picture or the quality is out of its range");
    }
    format = rf_format_of_name(path);
    if (!format || !format->writes_pictures)
        return fail_ending(reason, false);
    if (image->format > REFOCUS_FORMAT_YUYV && image->format != format->deep) {
        return rf_fail(
            reason, REFOCUS_ERR_UNSUPPORTED,
            "%s does not hold such samples; PNG and TIFF hold 16 bits, OpenEXR and PFM floats",
            format->name);
    }
    if ((status = check_editable(&parts, format, &editable, reason)))
        return status;
    rows.top = image->plane[0];
    rows.stride = image->stride[0];
    rows.width = image->width;
    rows.height = image->height;
    rows.format = image->format;
    if ((status = check_light(&parts, format, &rows, &light, reason)))
        return status;
    return write_rows(path, format, &rows, &parts, reason);
}

int refocus_gray16_write(const char *path, const uint16_t *samples, int width, int height,
                         ptrdiff_t stride, struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_rows rows;
    const struct rf_format *format;
    const struct refocus_write_options none = refocus_write_options_default();

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!path || !samples || stride % 2 != 0 || !fits(width, height, stride, 2))
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "the samples are out of their range");
    format = rf_format_of_name(path);
    if (!format || !format->writes_depth)
        return fail_ending(reason, true);
    rows.top = (const uint8_t *)samples;
    rows.stride = stride;
    rows.width = width;
    rows.height = height;
    rows.format = REFOCUS_FORMAT_NONE;
    return write_rows(path, format, &rows, &none, reason);
}
