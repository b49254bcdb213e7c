/* jpeg_keep.c: the segments of a photo go into the JPEG that is made from it, byte for byte and in
 * their order, but for those that tell about the pixels or places of the old file: JFIF, Adobe's
 * colour transform, MPF. EXIF and the ICC profile are written by jpeg_write.c. */
#include "jpeg_keep.h"

#include <string.h>

#include "editable.h"
#include "gain_map.h"
#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "kept.h"
#include "reason.h"
#include "xmp_keep.h"

enum { DENSITY_AT = 7, DENSITY_BYTES = 5 };

static bool begins(struct rf_bytes segment, const char *signature, size_t size)
{
    struct rf_bytes rest;

    return rf_jpeg_after(segment, signature, size, &rest);
}

/* Whether a segment is one of those that are not copied. */
static bool is_of_the_file(int marker, struct rf_bytes segment)
{
    switch (marker) {
    case RF_JPEG_APP0:
        return begins(segment, "JFIF", 5) || begins(segment, "JFXX", 5);
    case RF_JPEG_APP1:
        return begins(segment, rf_jpeg_exif_signature, 6);
    case RF_JPEG_APP2:
        return begins(segment, rf_jpeg_icc_signature, sizeof rf_jpeg_icc_signature) ||
               begins(segment, rf_jpeg_mpf_signature, sizeof rf_jpeg_mpf_signature) ||
               begins(segment, rf_jpeg_gain_signature, sizeof rf_jpeg_gain_signature);
    case RF_JPEG_APP14:
        return begins(segment, "Adobe", 5);
    default:
        return marker != RF_JPEG_COM && (marker < RF_JPEG_APP0 || marker > RF_JPEG_APP15);
    }
}

static void put_packet(struct rf_store *store, const struct rf_xmp_packet *packet,
                       struct refocus_reason *reason)
{
    const struct rf_bytes standard = rf_xmp_kept(packet);

    if (standard.size > rf_jpeg_xmp_most()) {
        rf_leave_out(reason, "XMP of more than 65,504 bytes does not fit into a JPEG: left out");
        return;
    }
    if (standard.size > 0)
        rf_jpeg_put_xmp(store, standard);
    if (packet->edit_extended.outcome == RF_XMP_CHANGED)
        rf_jpeg_put_extended(store, rf_text_bytes(&packet->edit_extended.packet), packet->new_guid);
}

/* Write a segment of XMP, if it is one. Chunks of an extended packet that changed are left out:
 * they are written anew behind their standard packet. */
static bool put_xmp(struct rf_store *store, const struct rf_xmp_keep *keep, struct rf_bytes segment,
                    int *packets, struct refocus_reason *reason)
{
    struct rf_bytes rest;

    if (rf_jpeg_after(segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature, &rest)) {
        if (*packets < keep->count)
            put_packet(store, &keep->packet[(*packets)++], reason);
        return true;
    }
    if (!rf_jpeg_after(segment, rf_jpeg_extended_signature, sizeof rf_jpeg_extended_signature,
                       &rest))
        return false;
    for (int i = 0; i < keep->count; i++)
        if (keep->packet[i].guid[0] && keep->packet[i].edit_extended.outcome != RF_XMP_SAME &&
            rest.size >= 32 && memcmp(rest.data, keep->packet[i].guid, 32) == 0)
            return true;
    return keep->count == 0; /* without expat nobody knows what it holds */
}

static void put_segments(struct rf_store *store, const struct rf_xmp_keep *keep,
                         struct rf_bytes jpeg, struct refocus_reason *reason)
{
    struct rf_jpeg_walk walk;
    int packets = 0;

    /* A photo without XMP gets a packet of its own. */
    if (keep->count > 0 && keep->packet[0].standard.size == 0)
        put_packet(store, &keep->packet[packets++], reason);
    if (rf_jpeg_walk_begin(&walk, jpeg)) {
        while (rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT) {
            if (is_of_the_file(walk.marker, walk.segment) ||
                (walk.marker == RF_JPEG_APP1 &&
                 put_xmp(store, keep, walk.segment, &packets, reason)))
                continue;
            rf_jpeg_put_segment(store, walk.marker, NULL, 0, walk.segment.data, walk.segment.size);
        }
    }
}

/* Whether what makes the picture editable is in its XMP, and can be read again. */
static bool is_editable(const struct rf_xmp_keep *keep)
{
    const struct rf_xmp_packet *const last = &keep->packet[keep->count - 1];
    const uint64_t most = keep->read.limits.max_metadata;

    return !keep->damaged && rf_xmp_kept(last).size <= rf_jpeg_xmp_most() &&
           last->edit_extended.packet.size <= (most < UINT32_MAX ? most : UINT32_MAX);
}

/* Edit the XMP; what makes the picture editable is given up where that leaves no room for it. */
static int edit_xmp(struct rf_xmp_keep *keep, const struct refocus_write_options *options,
                    const struct rf_rows *rows, struct rf_behind *behind, struct rf_text *xmp,
                    bool *editable, struct refocus_reason *reason)
{
    int status = rf_keep_xmp(options->keep, keep, rows->width, rows->height, reason);

    if (status != REFOCUS_OK || !*editable || is_editable(keep))
        return status;
    rf_leave_out(reason, "the XMP of the photo leaves no room to make it editable: the original "
                         "and its depth are left out");
    *editable = false;
    rf_xmp_keep_free(keep);
    rf_behind_drop_depth(behind);
    xmp->size = 0;
    rf_behind_put_xmp(xmp, behind, options);
    *keep = (struct rf_xmp_keep){.cut = RF_XMP_CUT_EDITABLE, .insert = rf_text_bytes(xmp)};
    return rf_keep_xmp(options->keep, keep, rows->width, rows->height, reason);
}

static int put_kept(struct rf_store *store, struct rf_xmp_keep *keep,
                    const struct refocus_write_options *options, const struct rf_rows *rows,
                    struct rf_behind *behind, struct rf_text *xmp, struct refocus_reason *reason)
{
    const struct rf_kept *const kept = options->keep ? rf_kept_of(options->keep) : NULL;
    bool editable = options->editable;
    const int status = edit_xmp(keep, options, rows, behind, xmp, &editable, reason);

    if (status != REFOCUS_OK)
        return status;
    if (kept && kept->kind == RF_KEPT_JPEG)
        put_segments(store, keep, (struct rf_bytes){kept->bytes.data, kept->bytes.size}, reason);
    else if (keep->count > 0)
        put_packet(store, &keep->packet[0], reason);
    if (kept)
        rf_keep_warn_kind(options->keep, RF_KEPT_JPEG, reason);
    /* In an editable picture the gain map lies behind the original, if it could be read. */
    if (kept && !(editable && rf_photo_gain_map(options->keep)) && !rf_behind_has_gain_map(behind))
        rf_keep_warn(options->keep, keep, reason);
    return REFOCUS_OK;
}

int rf_jpeg_put_kept(struct rf_store *store, const struct refocus_write_options *options,
                     const struct rf_rows *rows, struct rf_behind *behind,
                     struct refocus_reason *reason)
{
    struct rf_xmp_keep keep = {.cut = RF_XMP_CUT_EDITABLE};
    struct rf_editable editable = {.cut = 0};
    int status = REFOCUS_OK;

    if (options->editable) {
        status = rf_editable_make(&editable, options, false, reason);
        keep.cut = editable.cut;
    }
    rf_behind_put_xmp(&editable.standard, behind, options);
    keep.insert = rf_text_bytes(&editable.standard);
    keep.insert_extended = rf_text_bytes(&editable.extended);
    if (status == REFOCUS_OK && editable.standard.failed)
        status = rf_fail_memory(reason);
    if (status == REFOCUS_OK && (options->keep || behind->count > 0))
        status = put_kept(store, &keep, options, rows, behind, &editable.standard, reason);
    rf_xmp_keep_free(&keep);
    rf_editable_free(&editable);
    return status;
}

static bool is_jfif(const uint8_t *jpeg, size_t size)
{
    return size >= 20 && memcmp(jpeg, "\xff\xd8\xff\xe0", 4) == 0 &&
           memcmp(jpeg + 6, "JFIF", 5) == 0;
}

void rf_jpeg_keep_density(const struct refocus_write_options *options, uint8_t *jpeg, size_t size)
{
    const struct rf_kept *const kept = options->keep ? rf_kept_of(options->keep) : NULL;

    if (kept && kept->kind == RF_KEPT_JPEG && is_jfif(kept->bytes.data, kept->bytes.size) &&
        is_jfif(jpeg, size))
        memcpy(jpeg + 6 + DENSITY_AT, kept->bytes.data + 6 + DENSITY_AT, DENSITY_BYTES);
}
