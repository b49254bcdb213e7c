/* heic_gain.c: the gain map of a HEIC or AVIF, which is said in three ways: an auxiliary image of
 * Apple, whose headroom is in the EXIF or in XMP; one of others, beside which lies the XMP of Ultra
 * HDR; and a tone map with the metadata of ISO 21496-1. */
#include "heic_gain.h"

#include <stdlib.h>
#include <string.h>

#include "gain_map_read.h"
#include "gain_values.h"
#include "heic_deep.h"
#include "heif_tone_map.h"
#include "heif_turn.h"
#include "kept.h"
#include "orient.h"
#include "reason.h"
#ifdef RF_HAVE_XMP
#include "heic_xmp.h"
#endif

/* A map that is the same in all channels is a grey one. */
static void drop_equal_channels(struct rf_raster *samples)
{
    const size_t pixels = (size_t)samples->width * (size_t)samples->height;
    const uint8_t *const from = samples->pixels;

    for (size_t i = 0; i < pixels; i++)
        if (from[3 * i] != from[3 * i + 1] || from[3 * i] != from[3 * i + 2])
            return;
    for (size_t i = 0; i < pixels; i++)
        samples->pixels[i] = from[3 * i];
    samples->channels = 1;
}

/* Decode the map upright as the picture is, and settle it; by Apple's curve if headroom > 0. `file`
 * is what the handle is of. */
static int take(struct rf_heic *heic, struct rf_bytes file, struct heif_image_handle *handle,
                heif_item_id item, double headroom)
{
    struct rf_read *const read = heic->read;
    struct rf_raster *const samples = &read->gain->samples;
    struct refocus_reason unused = {""};
    struct rf_read quiet = *read;
    struct rf_heic inner = *heic;
    int status;

    inner.read = &quiet;
    quiet.reason = &unused;
    status = rf_heic_decode(&inner, handle, RF_HEIC_COLOUR_8, samples);
    if (status == REFOCUS_OK) {
        drop_equal_channels(samples);
        if (rf_heif_orientation(file, item) == 1)
            status = rf_raster_orient(&quiet, samples, read->info->orientation);
    }
    if (status == REFOCUS_ERR_MEMORY)
        return rf_fail_memory(read->reason);
    rf_gain_settle(read,
                   status == REFOCUS_OK         ? NULL
                   : status == REFOCUS_ERR_SIZE ? "it is beyond the limits"
                                                : "it is damaged",
                   headroom);
    return REFOCUS_OK;
}

/* *why: the map is of no use; NULL: it is. *headroom is 0 unless it is one of Apple's. */
static int judge(struct rf_heic *heic, const struct heif_image_handle *handle, const char *type,
                 const char **why, double *headroom)
{
    struct rf_xmp xmp = {.items = 0};
    int status = REFOCUS_OK;

    *headroom = 0;
    *why = "what its samples mean is not said";
#ifdef RF_HAVE_XMP
    status = rf_heic_parse_xmp(heic->read, handle, &xmp);
#else
    (void)handle;
#endif
    if (strcmp(type, "urn:com:apple:photo:2020:aux:hdrgainmap") == 0)
        *why = rf_gain_from_apple(heic->read, &xmp, headroom);
    else if (xmp.value[RF_XMP_GAIN_MAP])
        *why = rf_gain_from_xmp(&xmp, &heic->read->gain->values);
    rf_xmp_free(&xmp);
    return status;
}

bool rf_heic_is_gain_map(const char *type)
{
    return strstr(type, "hdrgainmap") != NULL;
}

int rf_heic_gain_auxiliary(struct rf_heic *heic, struct heif_image_handle *handle,
                           heif_item_id item, const char *type)
{
    struct rf_read *const read = heic->read;
    const char *why;
    double headroom;
    int status;

    read->kept.gain_map = true;
    if (!read->gain || read->gain->samples.pixels)
        return REFOCUS_OK;
    status = judge(heic, handle, type, &why, &headroom);
    if (status == REFOCUS_OK && !why)
        status = take(heic, heic->file, handle, item, headroom);
    else if (status == REFOCUS_OK)
        rf_gain_settle(read, why, 0);
    return status;
}

/* Decode an item that libheif gives to nobody, as the main picture of a copy of the file. */
static int take_hidden(struct rf_heic *heic, heif_item_id item)
{
    struct rf_read *const read = heic->read;
    struct heif_image_handle *handle = NULL;
    struct heif_context *context = NULL;
    struct rf_bytes copy = heic->file;
    uint8_t *changed = NULL;
    struct refocus_reason unused = {""};
    struct rf_read quiet = *read;
    int status;

    quiet.reason = &unused;
    status = rf_check_memory(&quiet, copy.size);
    if (status == REFOCUS_OK)
        status = rf_heif_with_main_picture(heic->file, item, &changed);
    if (status == REFOCUS_OK) {
        context = rf_heic_context(&read->limits);
        status = context ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
        copy.data = changed;
    }
    if (status == REFOCUS_OK &&
        (heif_context_read_from_memory_without_copy(context, changed, copy.size, NULL).code !=
             heif_error_Ok ||
         heif_context_get_primary_image_handle(context, &handle).code != heif_error_Ok))
        status = REFOCUS_ERR_FORMAT;
    if (status == REFOCUS_OK) {
        status = take(heic, copy, handle, item, 0);
        heif_image_handle_release(handle);
    } else if (status == REFOCUS_ERR_MEMORY) {
        status = rf_fail_memory(read->reason);
    } else {
        rf_gain_settle(read,
                       status == REFOCUS_ERR_SIZE ? "it is beyond the limits" : "it is damaged", 0);
        status = REFOCUS_OK;
    }
    if (context)
        heif_context_free(context);
    free(changed);
    return status;
}

int rf_heic_gain_tone_map(struct rf_heic *heic)
{
    struct rf_read *const read = heic->read;
    struct rf_heif_tone_map map;
    const char *why;

    if (!rf_heif_find_tone_map(heic->file, &map))
        return REFOCUS_OK;
    read->kept.gain_map = true;
    if (!read->gain || read->gain->samples.pixels)
        return REFOCUS_OK;
    if (map.metadata.size < 1 || map.metadata.data[0] != 0) {
        why = "its metadata is of a version that is not known";
    } else {
        map.metadata.data++;
        map.metadata.size--;
        why = rf_gain_from_iso(map.metadata, &read->gain->values);
    }
    if (!why && rf_heic_is_light(heic->primary))
        why = "its photo is not the darker rendition";
    if (why) {
        rf_gain_settle(read, why, 0);
        return REFOCUS_OK;
    }
    return take_hidden(heic, map.item);
}
