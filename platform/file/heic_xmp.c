/* heic_xmp.c: the XMP packet of an auxiliary picture of a HEIC is parsed. */
#include "heic_xmp.h"

#include <stdlib.h>

#include "reason.h"
#include "xmp_parse.h"

int rf_heic_parse_xmp(const struct rf_read *read, const struct heif_image_handle *handle,
                      struct rf_xmp *xmp)
{
    struct refocus_reason unused;
    struct rf_read quiet = {.limits = read->limits, .reason = &unused};
    struct rf_bytes packet;
    heif_item_id item;
    uint8_t *bytes;
    int status = REFOCUS_OK;

    *xmp = (struct rf_xmp){.items = 0};
    if (heif_image_handle_get_list_of_metadata_block_IDs(handle, "mime", &item, 1) < 1)
        return REFOCUS_OK;
    packet.size = heif_image_handle_get_metadata_size(handle, item);
    if (packet.size == 0 || rf_check_metadata(&quiet, packet.size, "its XMP") != REFOCUS_OK)
        return REFOCUS_OK;
    packet.data = bytes = malloc(packet.size);
    if (!bytes)
        return rf_fail_memory(read->reason);
    if (heif_image_handle_get_metadata(handle, item, bytes).code == heif_error_Ok)
        status = rf_xmp_parse(&quiet, packet, xmp);
    free(bytes);
    if (status == REFOCUS_OK)
        return status;
    rf_xmp_free(xmp);
    return status == REFOCUS_ERR_MEMORY ? rf_fail_memory(read->reason) : REFOCUS_OK;
}
