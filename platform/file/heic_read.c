/* heic_read.c: a HEIC photo is read by libheif. libheif turns every picture upright by the
 * container's own irot and imir; EXIF orientation says the same once more and is not applied. */
#include "heic_read.h"

#include <libheif/heif.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "depth_part.h"
#include "depth_values.h"
#include "exif.h"
#include "gain_map_read.h"
#include "heic_deep.h"
#include "heic_keep.h"
#include "heif_boxes.h"
#include "icc.h"
#include "orient.h"
#include "reason.h"
#ifdef RF_HAVE_XMP
#include "xmp_parse.h"
#endif

struct heic {
    struct rf_read *read;
    struct rf_bytes file;
    struct heif_context *context;
    struct heif_image_handle *primary;
    struct heif_decoding_options *options;
};

static int fail_heif(const struct rf_read *read, struct heif_error error)
{
    int status = REFOCUS_ERR_FORMAT;
    size_t length = strlen(error.message);

    while (length > 0 && strchr(" \n", error.message[length - 1]))
        length--;
    if (error.subcode == heif_suberror_End_of_data)
        return rf_fail(read->reason, status, "damaged HEIC: it ends too early; copy it again");
    if (error.subcode == heif_suberror_Security_limit_exceeded) {
        status = REFOCUS_ERR_SIZE;
    } else if (error.code == heif_error_Memory_allocation_error) {
        status = REFOCUS_ERR_MEMORY;
    } else if (error.code == heif_error_Unsupported_feature ||
               error.code == heif_error_Unsupported_filetype ||
               error.subcode == heif_suberror_Unsupported_codec) {
        status = REFOCUS_ERR_UNSUPPORTED;
    }
    return rf_fail(read->reason, status, "HEIC: %.*s", length < 200 ? (int)length : 200,
                   error.message);
}

/* Copy the rows of a plane out of libheif. */
static int copy_plane(struct rf_read *read, const struct heif_image *image,
                      enum heif_channel channel, struct rf_raster *raster)
{
    int stride = 0, status;
    const uint8_t *const plane = heif_image_get_plane_readonly(image, channel, &stride);

    raster->width = heif_image_get_width(image, channel);
    raster->height = heif_image_get_height(image, channel);
    if (!plane || raster->width < 1 || raster->height < 1) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "HEIC: its picture is of an unknown layout");
    }
    status = rf_raster_alloc(read, raster);
    for (int32_t y = 0; status == REFOCUS_OK && y < raster->height; y++) {
        const size_t bytes = rf_raster_stride(raster);
        memcpy(raster->pixels + (size_t)y * bytes, plane + (ptrdiff_t)y * stride, bytes);
    }
    return status;
}

static int decode(struct heic *heic, struct heif_image_handle *handle, bool colour,
                  struct rf_raster *raster)
{
    struct rf_read *const read = heic->read;
    enum heif_channel channel = heif_channel_Y;
    struct heif_image *image = NULL;
    struct heif_error error;
    const bool deep = colour && heif_image_handle_get_luma_bits_per_pixel(handle) > 8;
    int bits, status;

    status = rf_check_size(read, (uint64_t)heif_image_handle_get_width(handle),
                           (uint64_t)heif_image_handle_get_height(handle), deep ? 6 : 3);
    if (status == REFOCUS_OK) {
        /* libheif keeps the picture as it is coded and as RGB. */
        status = rf_check_memory(read, (uint64_t)heif_image_handle_get_width(handle) *
                                           (uint64_t)heif_image_handle_get_height(handle) *
                                           (deep ? 18 : 9));
    }
    if (status != REFOCUS_OK) {
        return status;
    }
    heic->options->convert_hdr_to_8bit = !deep;
    error =
        heif_decode_image(handle, &image, colour ? heif_colorspace_RGB : heif_colorspace_undefined,
                          deep     ? rf_heic_deep_chroma()
                          : colour ? heif_chroma_interleaved_RGB
                                   : heif_chroma_undefined,
                          heic->options);
    if (error.code != heif_error_Ok) {
        return fail_heif(read, error);
    }
    if (colour) {
        channel = heif_channel_interleaved;
    }
    bits = colour && !deep ? 8 : heif_image_get_bits_per_pixel_range(image, channel);
    raster->channels = colour ? 3 : 1;
    raster->sample = bits > 8 ? REFOCUS_SAMPLE_U16 : REFOCUS_SAMPLE_U8;
    raster->max_value = bits >= 1 && bits <= 16 ? (1u << bits) - 1 : 0;
    status = raster->max_value == 0 ? rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                                              "HEIC: its picture is of an unknown layout")
                                    : copy_plane(read, image, channel, raster);
    heif_image_release(image);
    return status;
}

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
        if (!has_distance(about)) {
            return false;
        }
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

/* Only the simulated aperture is wanted of the XMP that Apple puts beside the depth image, so
 * damage there is passed over. */
static int read_simulated(struct heic *heic, const struct heif_image_handle *depth)
{
    int status = REFOCUS_OK;
#ifdef RF_HAVE_XMP
    struct refocus_reason unused;
    struct rf_read quiet = {.limits = heic->read->limits, .reason = &unused};
    struct rf_xmp xmp = {.items = 0};
    struct rf_bytes packet;
    heif_item_id item;
    uint8_t *bytes;

    if (heif_image_handle_get_list_of_metadata_block_IDs(depth, "mime", &item, 1) < 1) {
        return REFOCUS_OK;
    }
    packet.size = heif_image_handle_get_metadata_size(depth, item);
    if (packet.size == 0 || rf_check_metadata(&quiet, packet.size, "its XMP") != REFOCUS_OK) {
        return REFOCUS_OK;
    }
    packet.data = bytes = malloc(packet.size);
    if (!bytes) {
        return rf_fail_memory(heic->read->reason);
    }
    if (heif_image_handle_get_metadata(depth, item, bytes).code == heif_error_Ok &&
        rf_xmp_parse(&quiet, packet, &xmp) == REFOCUS_ERR_MEMORY) {
        status = rf_fail_memory(heic->read->reason);
    }
    heic->read->info->simulated_f_number = rf_xmp_simulated_f_number(&xmp);
    rf_xmp_free(&xmp);
    free(bytes);
#else
    (void)heic;
    (void)depth;
#endif
    return status;
}

static int take_depth(struct heic *heic, heif_item_id item,
                      const struct heif_depth_representation_info *about)
{
    struct rf_read *const read = heic->read;
    struct heif_image_handle *handle = NULL;
    struct heif_error error =
        heif_image_handle_get_depth_image_handle(heic->primary, item, &handle);
    int status;

    if (error.code != heif_error_Ok) {
        return fail_heif(read, error);
    }
    status = decode(heic, handle, false, &read->samples);
    if (status == REFOCUS_OK) {
        status = read_simulated(heic, handle);
    }
    heif_image_handle_release(handle);
    if (status != REFOCUS_OK) {
        return status;
    }
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
        rf_note(read->info, "HEIC: what its samples mean is not said in a known way: "
                            "passed over");
        rf_raster_free(&read->samples);
    }
    return status;
}

static int read_depth(struct heic *heic)
{
    const struct heif_depth_representation_info *about = NULL;
    struct rf_read *const read = heic->read;
    heif_item_id item;
    int status;

    if (heif_image_handle_get_list_of_depth_image_IDs(heic->primary, &item, 1) < 1) {
        return REFOCUS_OK;
    }
    if (!heif_image_handle_get_depth_image_representation_info(heic->primary, item, &about) ||
        !about) {
        rf_note(read->info, "HEIC: a depth image that does not say which end is near: "
                            "passed over");
        return REFOCUS_OK;
    }
    status = take_depth(heic, item, about);
    heif_depth_representation_info_free(about);
    return status;
}

/* Apple's gain map, upright as the picture is; the headroom is in the EXIF. */
static int take_gain_map(struct heic *heic, struct heif_image_handle *handle, heif_item_id item)
{
    struct rf_read *const read = heic->read;
    struct rf_raster *const samples = &read->gain->samples;
    struct refocus_reason unused = {""};
    struct rf_read quiet = *read;
    struct heic inner = *heic;
    const char *why = read->apple_headroom > 0 ? NULL : "the photo does not say its headroom";
    int status = REFOCUS_OK;

    inner.read = &quiet;
    quiet.reason = &unused;
    if (!why) {
        status = decode(&inner, handle, false, samples);
        if (status == REFOCUS_OK && rf_heif_orientation(heic->file, item) == 1) {
            status = rf_raster_orient(&quiet, samples, read->info->orientation);
        }
        if (status == REFOCUS_ERR_MEMORY) {
            return rf_fail_memory(read->reason);
        }
        why = status == REFOCUS_OK         ? NULL
              : status == REFOCUS_ERR_SIZE ? "it is beyond the limits"
                                           : "it is damaged";
    }
    rf_gain_settle(read, why, read->apple_headroom);
    return REFOCUS_OK;
}

/* Take the portrait matte, as depth is taken, upright. */
static int take_matte(struct heic *heic, struct heif_image_handle *handle, heif_item_id item)
{
    struct rf_read *const read = heic->read;
    int status = decode(heic, handle, false, &read->matte);

    if (status == REFOCUS_OK) {
        rf_note(read->info, "HEIC: auxiliary image is the portrait matte: how much of a pixel is "
                            "subject");
        if (rf_heif_orientation(heic->file, item) == 1) {
            status = rf_raster_orient(read, &read->matte, read->info->orientation);
        }
    }
    return status;
}

/* One auxiliary image: the portrait matte and the gain map are taken, anything else is passed over.
 */
static int read_auxiliary(struct heic *heic, struct heif_image_handle *handle, heif_item_id item)
{
    int status = REFOCUS_OK;
    const char *type = NULL;

    if (heif_image_handle_get_auxiliary_type(handle, &type).code != heif_error_Ok) {
        return REFOCUS_OK;
    }
    heic->read->kept.gain_map |= strstr(type, "hdrgainmap") != NULL;
    if (rf_is_matte(type) && heic->read->picture_always && !heic->read->matte.pixels) {
        status = take_matte(heic, handle, item);
    } else {
        rf_note(heic->read->info, "HEIC: auxiliary image passed over, it is no depth but \"%.80s\"",
                type);
        if (heic->read->gain && !heic->read->gain->samples.pixels &&
            strcmp(type, "urn:com:apple:photo:2020:aux:hdrgainmap") == 0) {
            status = take_gain_map(heic, handle, item);
        }
    }
    heif_image_handle_free_auxiliary_types(handle, &type);
    return status;
}

/* Gain maps and mattes are auxiliary images too. */
static int read_auxiliaries(struct heic *heic)
{
    enum { MOST = 8 };
    heif_item_id items[MOST];
    const int filter = LIBHEIF_AUX_IMAGE_FILTER_OMIT_DEPTH | LIBHEIF_AUX_IMAGE_FILTER_OMIT_ALPHA;
    const int count =
        heif_image_handle_get_list_of_auxiliary_image_IDs(heic->primary, filter, items, MOST);
    int status = REFOCUS_OK;

    for (int i = 0; i < count && status == REFOCUS_OK; i++) {
        struct heif_image_handle *handle = NULL;

        if (heif_image_handle_get_auxiliary_image_handle(heic->primary, items[i], &handle).code ==
            heif_error_Ok) {
            status = read_auxiliary(heic, handle, items[i]);
            heif_image_handle_release(handle);
        }
    }
    return status;
}

static int read_exif(struct heic *heic)
{
    struct rf_read *const read = heic->read;
    struct rf_bytes tiff = {NULL, 0};
    heif_item_id item;
    size_t size, skip;
    uint8_t *block;
    int status;

    if (heif_image_handle_get_list_of_metadata_block_IDs(heic->primary, "Exif", &item, 1) < 1) {
        return REFOCUS_OK;
    }
    size = heif_image_handle_get_metadata_size(heic->primary, item);
    status = rf_check_metadata(read, size, "its EXIF");
    if (status != REFOCUS_OK || size < 4) {
        return status;
    }
    block = malloc(size);
    if (!block) {
        return rf_fail_memory(read->reason);
    }
    if (heif_image_handle_get_metadata(heic->primary, item, block).code == heif_error_Ok) {
        /* ISO/IEC 23008-12, A.2.1: the offset of the TIFF header, counted from behind this. */
        skip = (size_t)block[0] << 24 | (size_t)block[1] << 16 | (size_t)block[2] << 8 | block[3];
        if (skip < size - 4) {
            tiff = (struct rf_bytes){block + 4 + skip, size - 4 - skip};
        }
    }
    status = rf_exif_take(read, tiff, false);
    free(block);
    return status;
}

static int read_icc(struct heic *heic)
{
    struct rf_read *const read = heic->read;
    struct refocus_blob profile = {NULL, 0};
    const enum heif_color_profile_type type =
        heif_image_handle_get_color_profile_type(heic->primary);
    int status;

    if (type != heif_color_profile_type_rICC && type != heif_color_profile_type_prof) {
        return REFOCUS_OK;
    }
    profile.size = heif_image_handle_get_raw_color_profile_size(heic->primary);
    status = rf_check_metadata(read, profile.size, "its ICC profile");
    if (status != REFOCUS_OK || profile.size == 0) {
        return status;
    }
    profile.data = malloc(profile.size);
    if (!profile.data) {
        return rf_fail_memory(read->reason);
    }
    if (heif_image_handle_get_raw_color_profile(heic->primary, profile.data).code !=
        heif_error_Ok) {
        profile.size = 0;
    }
    return rf_icc_take(read, &profile);
}

static void say_orientation(struct heic *heic)
{
    struct refocus_photo_info *const info = heic->read->info;

    info->stored_width = heif_image_handle_get_ispe_width(heic->primary);
    info->stored_height = heif_image_handle_get_ispe_height(heic->primary);
    info->orientation = rf_heif_orientation(heic->file, 0);
    if (info->focus_x >= 0.0) {
        rf_orient_point(&info->focus_x, &info->focus_y, info->orientation);
    }
    if (info->orientation != 1) {
        rf_note(info, "HEIC: the container's orientation %d is applied to photo and depth",
                info->orientation);
    }
}

/* Go on with the other of two pictures instead of the main one. */
static int take_second(struct heic *heic)
{
    heif_item_id id[2], main_id = 0;
    struct heif_error error;

    heif_context_get_primary_image_ID(heic->context, &main_id);
    if (heif_context_get_number_of_top_level_images(heic->context) != 2 ||
        heif_context_get_list_of_top_level_image_IDs(heic->context, id, 2) != 2) {
        return rf_fail(heic->read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it does not hold two pictures; give an MPO, a stereo HEIC, or "
                       "two pictures");
    }
    heif_image_handle_release(heic->primary);
    heic->primary = NULL;
    error = heif_context_get_image_handle(heic->context, id[0] == main_id ? id[1] : id[0],
                                          &heic->primary);
    return error.code == heif_error_Ok ? REFOCUS_OK : fail_heif(heic->read, error);
}

static int run(struct heic *heic)
{
    struct rf_read *const read = heic->read;
    struct heif_error error;
    int status;

    if (rf_heif_is_sequence(heic->file)) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is a HEIF image sequence, a film without a still picture; give one of "
                       "its pictures as HEIC or JPEG");
    }
    /* libheif takes a side and allows its square. */
    heif_context_set_maximum_image_size_limit(
        heic->context, (int)fmin(ceil(sqrt((double)read->limits.max_pixels)), 65535.0));
    heif_context_set_max_decoding_threads(heic->context, 0);
    heic->options->strict_decoding = 1;
    error = heif_context_read_from_memory_without_copy(heic->context, heic->file.data,
                                                       heic->file.size, NULL);
    if (error.code == heif_error_Ok) {
        error = heif_context_get_primary_image_handle(heic->context, &heic->primary);
    }
    if (error.code != heif_error_Ok) {
        return fail_heif(read, error);
    }
    if (read->second) {
        status = take_second(heic);
        return status == REFOCUS_OK ? decode(heic, heic->primary, true, &read->image) : status;
    }
    read->info->stored_bits = heif_image_handle_get_luma_bits_per_pixel(heic->primary);
    status = read_exif(heic);
    say_orientation(heic);
    if (heif_context_get_number_of_top_level_images(heic->context) == 2) {
        rf_note_view(read->info, "HEIC", 2);
    }
    if (status == REFOCUS_OK) {
        status = read_icc(heic);
    }
    if (status == REFOCUS_OK) {
        status = read_auxiliaries(heic);
    }
    if (status == REFOCUS_OK) {
        status = read_depth(heic);
    }
    if (status == REFOCUS_OK && (read->picture_always || !read->samples.pixels)) {
        status = decode(heic, heic->primary, true, &read->image);
        status = status == REFOCUS_OK ? rf_heic_settle_light(read, heic->primary) : status;
    }
    if (status == REFOCUS_OK) {
        status = rf_heic_keep(read, heic->primary);
    }
    return status;
}

int rf_read_heic(struct rf_read *read, struct rf_bytes file)
{
    struct heic heic = {.read = read, .file = file};
    int status;

    memcpy(read->info->container, rf_heic_is_avif(file) ? "AVIF" : "HEIC", 5);
    heic.context = heif_context_alloc();
    heic.options = heif_decoding_options_alloc();
    status = heic.context && heic.options ? run(&heic) : rf_fail_memory(read->reason);
    if (heic.primary) {
        heif_image_handle_release(heic.primary);
    }
    if (heic.options) {
        heif_decoding_options_free(heic.options);
    }
    if (heic.context) {
        heif_context_free(heic.context);
    }
    return status;
}
