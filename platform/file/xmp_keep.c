/* xmp_keep.c: the XMP packets of a photo are edited together: where an extended packet changes, so
 * does its GUID, which the standard packet names. */
#include "xmp_keep.h"

#include <stdlib.h>
#include <string.h>

#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "md5.h"
#include "reason.h"
#include "xmp_extended.h"
#include "xmp_parse.h"

static bool may_stay(int status)
{
    return status == REFOCUS_ERR_FORMAT || status == REFOCUS_ERR_SIZE;
}

/* Put the extended packet together that the standard one names. */
static int find_extended(struct rf_xmp_keep *keep, struct rf_xmp_packet *packet,
                         struct rf_bytes jpeg)
{
    struct rf_xmp xmp = {.items = 0};
    int status =
        packet->standard.size > 0 ? rf_xmp_parse(&keep->read, packet->standard, &xmp) : REFOCUS_OK;

    if (status == REFOCUS_OK && jpeg.size > 0 && xmp.value[RF_XMP_EXTENDED]) {
        status = rf_xmp_extended(&keep->read, jpeg, xmp.value[RF_XMP_EXTENDED],
                                 xmp.length[RF_XMP_EXTENDED], &packet->extended);
        if (status == REFOCUS_OK)
            memcpy(packet->guid, xmp.value[RF_XMP_EXTENDED], 32);
    }
    rf_xmp_free(&xmp);
    return may_stay(status) ? REFOCUS_OK : status;
}

static int edit(struct rf_xmp_keep *keep, struct rf_bytes packet, struct rf_xmp_edit *edit)
{
    const int status = rf_xmp_edit(&keep->read, packet, edit);

    if (may_stay(status)) {
        edit->outcome = RF_XMP_SAME;
        keep->damaged = true;
        return REFOCUS_OK;
    }
    return status;
}

static int edit_extended(struct rf_xmp_keep *keep, struct rf_xmp_packet *packet,
                         struct rf_text *insert)
{
    const int status = edit(keep, (struct rf_bytes){packet->extended.data, packet->extended.size},
                            &packet->edit_extended);

    if (status != REFOCUS_OK || packet->edit_extended.outcome == RF_XMP_SAME)
        return status;
    packet->edit.cut |= RF_XMP_CUT_EXTENDED;
    if (packet->edit_extended.outcome == RF_XMP_CHANGED && !(keep->cut & RF_XMP_CUT_EXTENDED)) {
        rf_md5_hex(rf_text_bytes(&packet->edit_extended.packet), packet->new_guid);
        rf_text_words(insert, "<rdf:Description xmlns:rdf=\"" RF_NS_RDF
                              "\" rdf:about=\"\" xmlns:xmpNote=\"" RF_NS_NOTE
                              "\" xmpNote:HasExtendedXMP=\"");
        rf_text_words(insert, packet->new_guid);
        rf_text_words(insert, "\"/>");
    }
    return insert->failed ? rf_fail_memory(keep->read.reason) : REFOCUS_OK;
}

static int edit_packet(struct rf_xmp_keep *keep, int index, struct rf_bytes jpeg)
{
    struct rf_xmp_packet *const packet = &keep->packet[index];
    const bool last = index == keep->count - 1;
    struct rf_text insert = {NULL, 0, 0, false};
    int status = find_extended(keep, packet, jpeg);

    packet->edit.cut = packet->edit_extended.cut = keep->cut;
    if (last)
        packet->edit_extended.insert = keep->insert_extended;
    if (status == REFOCUS_OK)
        status = edit_extended(keep, packet, &insert);
    if (last) {
        rf_text_put(&insert, keep->insert.data, keep->insert.size);
        status = insert.failed ? rf_fail_memory(keep->read.reason) : status;
    }
    if (status == REFOCUS_OK) {
        packet->edit.insert = rf_text_bytes(&insert);
        status = edit(keep, packet->standard, &packet->edit);
    }
    packet->edit.insert.data = NULL;
    free(insert.data);
    return status;
}

static int edit_packets(struct rf_xmp_keep *keep, struct rf_bytes jpeg)
{
    int status = REFOCUS_OK;

    if (keep->count == 0 && keep->insert.size > 0)
        keep->count = 1;
    for (int i = 0; i < keep->count && status == REFOCUS_OK; i++)
        status = edit_packet(keep, i, jpeg);
    return status;
}

int rf_xmp_keep_jpeg(struct rf_xmp_keep *keep, struct rf_bytes jpeg)
{
    struct rf_jpeg_walk walk;

    if (rf_jpeg_walk_begin(&walk, jpeg)) {
        while (keep->count < RF_XMP_PACKETS && rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT)
            if (walk.marker == RF_JPEG_APP1 &&
                rf_jpeg_after(walk.segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature,
                              &keep->packet[keep->count].standard))
                keep->count++;
    }
    return edit_packets(keep, jpeg);
}

int rf_xmp_keep_packet(struct rf_xmp_keep *keep, struct rf_bytes packet)
{
    keep->packet[0].standard = packet;
    keep->count = packet.size > 0;
    return edit_packets(keep, (struct rf_bytes){NULL, 0});
}
