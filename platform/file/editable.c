/* editable.c: the result of a refocusing stays editable, in the form that Google's camera gives its
 * pictures: GImage:Data is the all-in-focus original, GDepth:Data the depth, and a note of
 * our own has the lens setting. Original and depth that are there already stay byte for byte. */
#include "editable.h"

#include <stdlib.h>
#include <string.h>

#include "gdepth_write.h"
#include "kept.h"
#include "original.h"
#include "reason.h"
#include "xmp_edit.h"

#define BEGIN  "<rdf:Description xmlns:rdf=\"" RF_NS_RDF "\" rdf:about=\"\""
#define DEPTH  " xmlns:GDepth=\"" RF_NS_DEPTH "\""
#define IMAGE  " xmlns:GImage=\"" RF_NS_IMAGE "\""
#define NOTE   " xmlns:Refocus=\"" RF_NS_REFOCUS "\""
#define FINISH "/>"

static void put_data(struct rf_text *text, const char *begin, struct rf_bytes bytes)
{
    rf_text_words(text, begin);
    rf_text_base64(text, bytes);
    rf_text_words(text, "\"" FINISH);
}

static int add_original(struct rf_editable *editable, const struct refocus_photo *photo,
                        struct refocus_reason *reason)
{
    struct rf_text original = {NULL, 0, 0, false};
    bool is_png;
    int status = rf_original_put(&original, photo, &is_png, reason);

    editable->cut |= RF_XMP_CUT_ORIGINAL;
    rf_text_words(&editable->standard, BEGIN IMAGE " GImage:Mime=\"image/");
    rf_text_words(&editable->standard, is_png ? "png" : "jpeg");
    rf_text_words(&editable->standard, "\"" FINISH);
    put_data(&editable->extended, BEGIN IMAGE " GImage:Data=\"", rf_text_bytes(&original));
    free(original.data);
    return status == REFOCUS_OK && original.failed ? rf_fail_memory(reason) : status;
}

static int add_depth(struct rf_editable *editable, const struct refocus_depth_write *depth,
                     struct refocus_reason *reason)
{
    int status;

    editable->cut |= RF_XMP_CUT_DEPTH | RF_XMP_CUT_BLUR | RF_XMP_CUT_POINT;
    rf_text_words(&editable->standard, BEGIN DEPTH);
    rf_gdepth_put(&editable->standard, depth, 1);
    rf_text_words(&editable->standard, FINISH);
    rf_text_words(&editable->extended, BEGIN DEPTH);
    status = rf_gdepth_put_data(&editable->extended, depth, 1, reason);
    rf_text_words(&editable->extended, FINISH);
    return status;
}

/* The matte that is given, else the one that was given for an earlier result: a byte-for-byte copy
 * of its samples. */
static int add_matte(struct rf_editable *editable, const struct refocus_photo *photo,
                     const struct refocus_editable *given, struct refocus_reason *reason)
{
    struct refocus_depth_write samples = refocus_depth_write_default();
    int status;

    samples.disparity = given->matte;
    samples.width = given->matte_width;
    samples.height = given->matte_height;
    samples.stride = given->matte_stride;
    if (!given->matte && rf_kept_of(photo)->matte && photo->matte->sample == REFOCUS_SAMPLE_U16) {
        samples.disparity = photo->matte->samples;
        samples.width = photo->matte->width;
        samples.height = photo->matte->height;
        samples.stride = photo->matte->stride;
    }
    if (!samples.disparity)
        return REFOCUS_OK;
    rf_text_words(&editable->extended, BEGIN NOTE);
    status = rf_gdepth_put_samples(&editable->extended, " Refocus:Matte=\"", &samples, reason);
    rf_text_words(&editable->extended, FINISH);
    return status;
}

/* Orientations are those that make the stored original and the stored depth upright for the result.
 */
static void add_note(struct rf_text *text, const struct refocus_photo *photo,
                     const struct refocus_editable *given, bool moved)
{
    const struct rf_kept *const kept = rf_kept_of(photo);

    rf_text_words(text, BEGIN NOTE);
    rf_text_number(text, " Refocus:OriginalOrientation",
                   photo->info->original_used   ? (moved ? 1 : kept->original_orientation)
                   : kept->kind == RF_KEPT_JPEG ? photo->info->orientation
                                                : 1);
    rf_text_number(text, " Refocus:DepthOrientation",
                   given->own_depth && !moved ? kept->depth_orientation : 1);
    rf_text_number(text, " Refocus:FocusDisparity", given->focus_disparity);
    rf_text_number(text, " Refocus:MaxBlurRadius", given->max_blur_radius);
    if (given->simulated_f_number > 0)
        rf_text_number(text, " Refocus:SimulatedFNumber", given->simulated_f_number);
    rf_text_words(text, FINISH);
}

int rf_editable_make(struct rf_editable *editable, const struct refocus_write_options *options,
                     bool one_packet, struct refocus_reason *reason)
{
    const struct refocus_photo *const photo = options->keep;
    const struct refocus_editable *const given = options->editable;
    /* Packets of a JPEG are bounded, those of others are not: what is there does not fit. */
    const bool moved = rf_kept_of(photo)->kind != (one_packet ? RF_KEPT_XMP : RF_KEPT_JPEG);
    int status = REFOCUS_OK;

    memset(editable, 0, sizeof *editable);
    editable->cut = RF_XMP_CUT_NOTE;
    if (!photo->info->original_used || moved)
        status = add_original(editable, photo, reason);
    if (status == REFOCUS_OK && (!given->own_depth || moved)) {
        status = given->depth ? add_depth(editable, given->depth, reason)
                              : rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                                        "a file of another kind needs the depth itself");
    }
    if (status == REFOCUS_OK)
        status = add_matte(editable, photo, given, reason);
    add_note(&editable->standard, photo, given, moved);
    if (status == REFOCUS_OK && (editable->standard.failed || editable->extended.failed))
        status = rf_fail_memory(reason);
    return status;
}

void rf_editable_free(struct rf_editable *editable)
{
    free(editable->standard.data);
    free(editable->extended.data);
}
