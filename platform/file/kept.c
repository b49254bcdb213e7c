/* kept.c: a photo keeps bytes of its file for pictures that are made from it: of a JPEG the main
 * picture as it lies, and behind it the gain map and the portrait matte, of a PNG the chunks beside
 * the pixels, of a HEIC the XMP packet. */
#include "kept.h"

#include <stdlib.h>
#include <string.h>

#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "png_chunks.h"
#include "png_colour.h"
#include "read.h"
#include "reason.h"
#ifdef RF_HAVE_XMP
#include "xmp_parse.h"
#endif

/* Whether a packet by itself is damaged: readers of a JPEG that had it would refuse that. */
static bool is_damaged(const struct rf_read *read, struct rf_bytes packet)
{
#ifdef RF_HAVE_XMP
    struct refocus_reason unused;
    const struct rf_read quiet = {.limits = read->limits, .reason = &unused};
    struct rf_xmp xmp = {.items = 0};
    const int status = rf_xmp_parse(&quiet, packet, &xmp);

    rf_xmp_free(&xmp);
    return status != REFOCUS_OK && status != REFOCUS_ERR_MEMORY;
#else
    (void)read;
    (void)packet;
    return false;
#endif
}

void rf_keep_companion(struct rf_read *read, struct rf_bytes picture)
{
    if (read->companions < (int)(sizeof read->companion / sizeof *read->companion))
        read->companion[read->companions++] = picture;
}

int rf_keep(struct rf_read *read, enum rf_kept_kind kind, struct rf_bytes bytes)
{
    const int companions = kind == RF_KEPT_JPEG ? read->companions : 0;
    uint64_t size = bytes.size;
    uint8_t *to;
    int status;

    if (!read->picture_always || bytes.size == 0 || read->kept.bytes.data ||
        (kind == RF_KEPT_XMP && is_damaged(read, bytes)))
        return REFOCUS_OK;
    for (int i = 0; i < companions; i++)
        size += read->companion[i].size;
    status = rf_check_memory(read, size);
    if (status != REFOCUS_OK)
        return status;
    to = malloc((size_t)size);
    if (!to)
        return rf_fail_memory(read->reason);
    read->kept.bytes.data = to;
    read->kept.bytes.size = (size_t)size;
    read->kept.kind = kind;
    memcpy(to, bytes.data, bytes.size);
    to += bytes.size;
    for (int i = 0; i < companions; i++) {
        memcpy(to, read->companion[i].data, read->companion[i].size);
        to += read->companion[i].size;
    }
    return REFOCUS_OK;
}

const struct rf_kept *rf_kept_of(const struct refocus_photo *photo)
{
    return &((const struct rf_photo *)(const void *)photo)->kept;
}

/* An empty reading with the limits of that photo's, if there is one: what a writer reads again
 * keeps them too. */
static void begin_read(const struct refocus_photo *photo, struct rf_read *read,
                       struct refocus_photo_info *info, struct refocus_reason *reason)
{
    memset(read, 0, sizeof *read);
    memset(info, 0, sizeof *info);
    if (photo)
        read->limits = ((const struct rf_photo *)(const void *)photo)->limits;
    read->info = info;
    read->reason = reason;
    read->orientation = 1;
}

/* The bits of RF_XMP_CUT_... that were there. */
static unsigned found_in(const struct rf_xmp_keep *keep)
{
    unsigned found = 0;

    for (int i = 0; i < keep->count; i++)
        found |= keep->packet[i].edit.found | keep->packet[i].edit_extended.found;
    return found;
}

struct rf_bytes rf_xmp_kept(const struct rf_xmp_packet *packet)
{
    return packet->edit.outcome == RF_XMP_SAME ? packet->standard
                                               : rf_text_bytes(&packet->edit.packet);
}

void rf_xmp_keep_free(struct rf_xmp_keep *keep)
{
    for (int i = 0; i < keep->count; i++) {
        free(keep->packet[i].extended.data);
        free(keep->packet[i].edit.packet.data);
        free(keep->packet[i].edit_extended.packet.data);
    }
    keep->count = 0;
}

/* Whether sides that the file says are no longer true. */
static bool has_other_size(const struct refocus_photo *photo, int32_t width, int32_t height)
{
    return photo->info->orientation > 4 || photo->image->width != width ||
           photo->image->height != height;
}

int rf_keep_xmp(const struct refocus_photo *photo, struct rf_xmp_keep *keep, int32_t width,
                int32_t height, struct refocus_reason *reason)
{
    const struct rf_bytes none = {NULL, 0};
    struct rf_kept kept = {.kind = RF_KEPT_NOTHING};
    struct rf_bytes bytes;
    int status;

    if (photo) {
        kept = *rf_kept_of(photo);
        keep->cut |= RF_XMP_CUT_STALE | RF_XMP_CUT_GAIN_MAP |
                     (photo->info->orientation != 1 ? RF_XMP_CUT_ORIENTATION : 0) |
                     (has_other_size(photo, width, height) ? RF_XMP_CUT_SIZE : 0);
    }
    begin_read(photo, &keep->read, &keep->info, &keep->unused);
    bytes = (struct rf_bytes){kept.bytes.data, kept.bytes.size};
    status = kept.kind == RF_KEPT_JPEG  ? rf_xmp_keep_jpeg(keep, bytes)
             : kept.kind == RF_KEPT_XMP ? rf_xmp_keep_packet(keep, bytes)
             : kept.kind == RF_KEPT_PNG ? rf_xmp_keep_packet(keep, rf_png_xmp(bytes))
                                        : rf_xmp_keep_packet(keep, none);
    return status == REFOCUS_OK ? status : rf_fail_memory(reason);
}

/* Name the segments of a JPEG that no other format takes. */
static void warn_segments(struct rf_bytes jpeg, struct refocus_reason *reason)
{
    static const char photoshop[14] = "Photoshop 3.0"; /* whose resources hold IPTC */
    bool iptc = false, comments = false;
    struct rf_jpeg_walk walk;
    struct rf_bytes rest;

    if (!rf_jpeg_walk_begin(&walk, jpeg))
        return;
    while (rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT && walk.marker != RF_JPEG_SOS) {
        comments |= walk.marker == RF_JPEG_COM;
        iptc |= walk.marker == RF_JPEG_APP13 &&
                rf_jpeg_after(walk.segment, photoshop, sizeof photoshop, &rest);
    }
    if (iptc || comments) {
        rf_leave_out(reason, "it is written without the photo's %s%s%s; a JPEG keeps them",
                     iptc ? "IPTC" : "", iptc && comments ? " and " : "",
                     comments ? "comments" : "");
    }
}

void rf_keep_warn_kind(const struct refocus_photo *photo, enum rf_kept_kind written,
                       struct refocus_reason *reason)
{
    const struct rf_kept *const kept = rf_kept_of(photo);
    const struct rf_bytes bytes = {kept->bytes.data, kept->bytes.size};

    if (kept->kind == RF_KEPT_JPEG && written != RF_KEPT_JPEG)
        warn_segments(bytes, reason);
    if (kept->kind == RF_KEPT_PNG && written != RF_KEPT_PNG) {
        const struct rf_png_colour colour = rf_png_colour_of(bytes, photo->icc.data != NULL);

        if (colour.by) {
            rf_leave_out(reason,
                         "it is written without %s, by which the photo has other colours than "
                         "sRGB; a PNG keeps them",
                         colour.by);
        }
    }
}

void rf_keep_warn(const struct refocus_photo *photo, const struct rf_xmp_keep *keep,
                  struct refocus_reason *reason)
{
    if (rf_kept_of(photo)->gain_map || found_in(keep) & RF_XMP_CUT_GAIN_MAP)
        rf_leave_out(reason, "it is written without an HDR gain map, which the photo has");
}
