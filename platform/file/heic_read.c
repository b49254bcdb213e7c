/* heic_read.c: a HEIC photo is read by libheif. libheif turns every picture upright by the
 * container's own irot and imir; EXIF orientation says the same once more and is not applied. */
#include "heic_read.h"

#include <libheif/heif.h>
#include <stdlib.h>
#include <string.h>

#include "exif.h"
#include "depth_part.h"
#include "heic_deep.h"
#include "heic_gain.h"
#include "heic_keep.h"
#include "heic_picture.h"
#include "heif_boxes.h"
#include "heif_targets.h"
#include "heif_tone_map.h"
#include "heif_turn.h"
#include "icc.h"
#include "orient.h"
#include "reason.h"

/* Take the portrait matte, as depth is taken, upright. */
static int take_matte(struct rf_heic *heic, struct heif_image_handle *handle, heif_item_id item)
{
    struct rf_read *const read = heic->read;
    int status = rf_heic_decode(heic, handle, RF_HEIC_SAMPLES, &read->matte);

    if (status == REFOCUS_OK) {
        rf_note(read->info, "HEIC: auxiliary image is the portrait matte: how much of a pixel is "
                            "subject");
        if (rf_heif_orientation(heic->file, item) == 1)
            status = rf_raster_orient(read, &read->matte, read->info->orientation);
    }
    return status;
}

/* One auxiliary image: the portrait matte and the gain map are taken, anything else is passed over.
 */
static int read_auxiliary(struct rf_heic *heic, struct heif_image_handle *handle, heif_item_id item)
{
    int status = REFOCUS_OK;
    const char *type = NULL;

    if (heif_image_handle_get_auxiliary_type(handle, &type).code != heif_error_Ok)
        return REFOCUS_OK;
    if (rf_is_matte(type) && heic->read->picture_always && !heic->read->matte.pixels) {
        status = take_matte(heic, handle, item);
    } else if (rf_heic_is_gain_map(type)) {
        status = rf_heic_gain_auxiliary(heic, handle, item, type);
    } else {
        rf_note(heic->read->info, "%s: auxiliary image passed over, it is no depth but \"%.80s\"",
                heic->read->info->container, type);
    }
    heif_image_handle_free_auxiliary_types(handle, &type);
    return status;
}

/* Gain maps and mattes are auxiliary images too. */
static int read_auxiliaries(struct rf_heic *heic)
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

static int read_exif(struct rf_heic *heic)
{
    struct rf_read *const read = heic->read;
    struct rf_bytes tiff = {NULL, 0};
    heif_item_id item;
    size_t size, skip;
    uint8_t *block;
    int status;

    if (heif_image_handle_get_list_of_metadata_block_IDs(heic->primary, "Exif", &item, 1) < 1)
        return REFOCUS_OK;
    size = heif_image_handle_get_metadata_size(heic->primary, item);
    status = rf_check_metadata(read, size, "its EXIF");
    if (status != REFOCUS_OK || size < 4)
        return status;
    block = malloc(size);
    if (!block)
        return rf_fail_memory(read->reason);
    if (heif_image_handle_get_metadata(heic->primary, item, block).code == heif_error_Ok) {
        /* ISO/IEC 23008-12, A.2.1: the offset of the TIFF header, counted from behind this. */
        skip = rf_big_endian(block, 4);
        if (skip < size - 4)
            tiff = (struct rf_bytes){block + 4 + skip, size - 4 - skip};
    }
    status = rf_exif_take(read, tiff, false);
    free(block);
    return status;
}

static int read_icc(struct rf_heic *heic)
{
    struct rf_read *const read = heic->read;
    struct refocus_blob profile = {NULL, 0};
    const enum heif_color_profile_type type =
        heif_image_handle_get_color_profile_type(heic->primary);
    int status;

    if (type != heif_color_profile_type_rICC && type != heif_color_profile_type_prof)
        return REFOCUS_OK;
    profile.size = heif_image_handle_get_raw_color_profile_size(heic->primary);
    status = rf_check_metadata(read, profile.size, "its ICC profile");
    if (status != REFOCUS_OK || profile.size == 0)
        return status;
    profile.data = malloc(profile.size);
    if (!profile.data)
        return rf_fail_memory(read->reason);
    if (heif_image_handle_get_raw_color_profile(heic->primary, profile.data).code != heif_error_Ok)
        profile.size = 0;
    return rf_icc_take(read, &profile);
}

static void say_orientation(struct rf_heic *heic)
{
    struct refocus_photo_info *const info = heic->read->info;

    info->stored_width = heif_image_handle_get_ispe_width(heic->primary);
    info->stored_height = heif_image_handle_get_ispe_height(heic->primary);
    info->orientation = rf_heif_orientation(heic->file, 0);
    if (info->orientation != 1) {
        rf_note(info, "HEIC: the container's orientation %d is applied to photo and depth",
                info->orientation);
    }
}

/* Whether the file holds a stereo pair, left first, that its photo is none of. */
static bool has_pair_beside(struct rf_bytes file, uint32_t pair[2])
{
    struct rf_bytes meta, main_id;
    uint32_t id;

    if (!rf_heif_stereo_pair(file, pair) || !rf_heif_meta(file, &meta) ||
        !rf_heif_primary(meta, &main_id))
        return false;
    id = rf_big_endian(main_id.data, main_id.size);
    return id != pair[0] && id != pair[1];
}

/* Go on with the right one of a stereo pair, or the other of two pictures, instead of the main one.
 */
static int take_second(struct rf_heic *heic)
{
    heif_item_id id[2], main_id = 0;
    struct heif_error error;

    heif_context_get_primary_image_ID(heic->context, &main_id);
    if (!rf_heif_stereo_pair(heic->file, id) &&
        (heif_context_get_number_of_top_level_images(heic->context) != 2 ||
         heif_context_get_list_of_top_level_image_IDs(heic->context, id, 2) != 2)) {
        return rf_fail(heic->read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it does not hold two pictures; give an MPO, a stereo HEIC, or "
                       "two pictures");
    }
    heif_image_handle_release(heic->primary);
    heic->primary = NULL;
    error = heif_context_get_image_handle(heic->context, id[1] == main_id ? id[0] : id[1],
                                          &heic->primary);
    return error.code == heif_error_Ok ? REFOCUS_OK : rf_heic_fail(heic->read, error);
}

static void say_views(struct rf_heic *heic)
{
    uint32_t pair[2];

    if (has_pair_beside(heic->file, pair)) {
        heic->read->info->views++;
        rf_note(heic->read->info, "HEIC: a stereo pair lies beside the photo; no depth is made of "
                                  "it unasked");
    } else if (rf_heif_stereo_pair(heic->file, pair)) {
        rf_note_view(heic->read->info, "HEIC", 2);
    }
}

static int run(struct rf_heic *heic)
{
    struct rf_read *const read = heic->read;
    struct heif_error error;
    int status;

    if (rf_heif_is_sequence(heic->file)) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is a HEIF image sequence, a film without a still picture; give one of "
                       "its pictures as HEIC or JPEG");
    }
    heic->options->strict_decoding = 1;
    error = heif_context_read_from_memory_without_copy(heic->context, heic->file.data,
                                                       heic->file.size, NULL);
    if (error.code == heif_error_Ok)
        error = heif_context_get_primary_image_handle(heic->context, &heic->primary);
    if (error.code != heif_error_Ok)
        return rf_heic_fail(read, error);
    if (read->view == RF_VIEW_SECOND) {
        status = take_second(heic);
        return status == REFOCUS_OK
                   ? rf_heic_decode(heic, heic->primary, RF_HEIC_COLOUR, &read->image)
                   : status;
    }
    read->info->stored_bits = heif_image_handle_get_luma_bits_per_pixel(heic->primary);
    status = read_exif(heic);
    say_orientation(heic);
    say_views(heic);
    if (status == REFOCUS_OK)
        status = read_icc(heic);
    if (status == REFOCUS_OK)
        status = rf_heic_keep(read, heic->primary);
    if (status == REFOCUS_OK)
        status = read_auxiliaries(heic);
    if (status == REFOCUS_OK)
        status = rf_heic_gain_tone_map(heic);
    if (status == REFOCUS_OK && !read->samples.pixels)
        status = rf_heic_depth(heic);
    if (status == REFOCUS_OK && !read->image.pixels &&
        (read->picture_always || !read->samples.pixels)) {
        status = rf_heic_decode(heic, heic->primary, RF_HEIC_COLOUR, &read->image);
        status = status == REFOCUS_OK ? rf_heic_settle_light(read, heic->primary) : status;
        if (status == REFOCUS_OK && heif_image_handle_has_alpha_channel(heic->primary))
            rf_note(read->info, "%s: transparency is dropped", read->info->container);
    }
    return status;
}

/* Make the left one of a stereo pair beside the photo the main picture of *changed, a copy of the
 * file, or NULL where there is none yet. */
static int choose_first(struct rf_bytes file, uint8_t **changed)
{
    uint8_t *const before = *changed;
    uint32_t pair[2];
    int status;

    file.data = before ? before : file.data;
    if (!has_pair_beside(file, pair))
        return REFOCUS_OK;
    status = rf_heif_with_main_picture(file, pair[0], changed);
    free(before);
    return status;
}

int rf_read_heic(struct rf_read *read, struct rf_bytes file)
{
    struct rf_heic heic = {.read = read, .file = file};
    uint8_t *changed = NULL;
    int status = rf_heif_single_targets(file, &changed);

    memcpy(read->info->container, rf_heic_is_avif(file) ? "AVIF" : "HEIC", 5);
    if (status == REFOCUS_OK && read->view == RF_VIEW_FIRST)
        status = choose_first(file, &changed);
    heic.file.data = changed ? changed : file.data;
    heic.context = rf_heic_context(&read->limits);
    heic.options = heif_decoding_options_alloc();
    if (status == REFOCUS_ERR_FORMAT) {
        rf_fail(read->reason, status, "damaged HEIC: its stereo pair is not there");
    } else {
        status = status == REFOCUS_OK && heic.context && heic.options
                     ? run(&heic)
                     : rf_fail_memory(read->reason);
    }
    if (heic.primary)
        heif_image_handle_release(heic.primary);
    if (heic.options)
        heif_decoding_options_free(heic.options);
    if (heic.context)
        heif_context_free(heic.context);
    free(changed);
    return status;
}
