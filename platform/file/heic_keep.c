/* heic_keep.c: the XMP packet of a HEIC is kept for pictures that are made from it. */
#include "heic_keep.h"

#include <stdlib.h>
#include <string.h>

#include "kept.h"
#include "reason.h"

int rf_heic_keep(struct rf_read *read, const struct heif_image_handle *primary)
{
    enum { MOST = 16 };
    struct refocus_blob packet = {NULL, 0};
    heif_item_id items[MOST];
    const int count =
        heif_image_handle_get_list_of_metadata_block_IDs(primary, "mime", items, MOST);
    int status = REFOCUS_OK;

    for (int i = 0; i < count && status == REFOCUS_OK && !read->kept.bytes.data; i++) {
        const char *const type = heif_image_handle_get_metadata_content_type(primary, items[i]);

        packet.size = heif_image_handle_get_metadata_size(primary, items[i]);
        if (!type || strcmp(type, "application/rdf+xml") != 0 || packet.size == 0 ||
            rf_check_metadata(read, packet.size, "its XMP") != REFOCUS_OK) {
            continue;
        }
        packet.data = malloc(packet.size);
        if (!packet.data) {
            return rf_fail_memory(read->reason);
        }
        if (heif_image_handle_get_metadata(primary, items[i], packet.data).code == heif_error_Ok) {
            status = rf_keep(read, RF_KEPT_XMP, (struct rf_bytes){packet.data, packet.size});
        }
        free(packet.data);
    }
    return status;
}
