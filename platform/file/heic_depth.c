/* heic_depth.c: the auxiliary depth image of a HEIC, and what its samples mean. */
#include <math.h>

#include "depth_part.h"
#include "depth_values.h"
#include "heic_picture.h"
#include "heif_turn.h"
#include "orient.h"
#include "reason.h"
#ifdef RF_HAVE_XMP
#include "heic_xmp.h"
#endif

static bool has_disparity(const struct heif_depth_representation_info *about)
{
    return about->has_d_min && about->has_d_max && isfinite(about->d_min) &&
           isfinite(about->d_max) && about->d_min < about->d_max;
}

static bool has_distance(const struct heif_depth_representation_info *about)
{
    return about->has_z_near && about->has_z_far && isfinite(about->z_near) &&
           isfinite(about->z_far) && about->z_near > 0.0 && about->z_near < about->z_far;
}

/* Read the depth representation information (ISO/IEC 23008-2). False when it does not say enough.
 */
static bool set_meaning(struct rf_read *read, const struct heif_depth_representation_info *about)
{
    struct refocus_depth_map *const map = &read->depth;
    const double max = read->samples.max_value;

    switch (about->depth_representation_type) {
    case heif_depth_representation_type_uniform_disparity:
        if (has_disparity(about)) {
            rf_depth_from_disparity(map, 0.0, max, about->d_min, about->d_max);
            rf_note(read->info, "HEIC: uniform disparity from %g to %g per metre, bright is near",
                    about->d_min, about->d_max);
        } else {
            rf_depth_from_disparity(map, 0.0, max, 0.0, 0.0);
            rf_note(read->info, "HEIC: uniform disparity without a range, bright is near");
        }
        return true;
    case heif_depth_representation_type_uniform_inverse_Z:
        rf_depth_from_disparity(map, 0.0, max, 0.0, 0.0);
        if (has_distance(about)) {
            map->near_m = about->z_near;
            map->far_m = about->z_far;
        }
        rf_note(read->info, "HEIC: uniform 1/z from %g to %g m, bright is near", map->near_m,
                map->far_m);
        return true;
    case heif_depth_representation_type_uniform_Z:
        if (!has_distance(about))
            return false;
        map->meaning = REFOCUS_DEPTH_DISTANCE;
        map->metres_at_zero = about->z_near;
        map->metres_per_unit = (about->z_far - about->z_near) / max;
        map->near_m = about->z_near;
        map->far_m = about->z_far;
        rf_note(read->info, "HEIC: uniform z from %g to %g m, bright is far", map->near_m,
                map->far_m);
        return true;
    default:
        return false;
    }
}

/* Only the simulated aperture is wanted of the XMP that Apple puts beside the depth image. */
static int read_simulated(struct rf_heic *heic, const struct heif_image_handle *depth)
{
#ifdef RF_HAVE_XMP
    struct rf_xmp xmp;
    const int status = rf_heic_parse_xmp(heic->read, depth, &xmp);

    heic->read->info->simulated_f_number = rf_xmp_simulated_f_number(&xmp);
    rf_xmp_free(&xmp);
    return status;
#else
    (void)heic;
    (void)depth;
    return REFOCUS_OK;
#endif
}

static int take_depth(struct rf_heic *heic, heif_item_id item,
                      const struct heif_depth_representation_info *about)
{
    struct rf_read *const read = heic->read;
    struct heif_image_handle *handle = NULL;
    struct heif_error error =
        heif_image_handle_get_depth_image_handle(heic->primary, item, &handle);
    int status;

    if (error.code != heif_error_Ok)
        return rf_heic_fail(read, error);
    status = rf_heic_decode(heic, handle, RF_HEIC_SAMPLES, &read->samples);
    if (status == REFOCUS_OK)
        status = read_simulated(heic, handle);
    heif_image_handle_release(handle);
    if (status != REFOCUS_OK)
        return status;
    rf_note(read->info, "HEIC: auxiliary depth image, %d x %d samples of %d bits",
            (int)read->samples.width, (int)read->samples.height,
            read->samples.sample == REFOCUS_SAMPLE_U16 ? 16 : 8);
    if (set_meaning(read, about)) {
        read->info->depth_source = REFOCUS_DEPTH_SOURCE_HEIF;
        if (rf_heif_orientation(heic->file, item) == 1) {
            /* libheif has not turned it then: it lies as the main picture was stored. */
            status = rf_raster_orient(read, &read->samples, read->info->orientation);
        }
    } else {
        rf_note(read->info, "HEIC: what its samples mean is not said in a known way: passed over");
        rf_raster_free(&read->samples);
    }
    return status;
}

int rf_heic_depth(struct rf_heic *heic)
{
    const struct heif_depth_representation_info *about = NULL;
    struct rf_read *const read = heic->read;
    heif_item_id item;
    int status;

    if (heif_image_handle_get_list_of_depth_image_IDs(heic->primary, &item, 1) < 1)
        return REFOCUS_OK;
    if (!heif_image_handle_get_depth_image_representation_info(heic->primary, item, &about) ||
        !about) {
        rf_note(read->info, "HEIC: a depth image that does not say which end is near: passed over");
        return REFOCUS_OK;
    }
    status = take_depth(heic, item, about);
    heif_depth_representation_info_free(about);
    return status;
}
