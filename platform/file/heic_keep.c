/* heic_keep.c: the XMP packet of a HEIC is kept for pictures that are made from it, and read when
 * it makes a result editable. */
#include "heic_keep.h"

#include <stdlib.h>
#include <string.h>

#include "kept.h"
#include "reason.h"
#ifdef RF_HAVE_XMP
#include "gdepth.h"
#include "xmp_parse.h"
#endif

/* Packets of others and damaged ones are passed over. */
static int read_result(struct rf_read *read, struct rf_bytes packet)
{
#ifdef RF_HAVE_XMP
    struct refocus_reason unused;
    struct rf_read quiet = {.limits = read->limits, .reason = &unused};
    struct rf_xmp xmp = {.items = 0};
    int status = rf_xmp_parse(&quiet, packet, &xmp);

    if (status == REFOCUS_ERR_MEMORY)
        status = rf_fail_memory(read->reason);
    else if (status == REFOCUS_OK && xmp.value[RF_XMP_NOTE_ORIGINAL] &&
             xmp.value[RF_XMP_DEPTH_DATA])
        status = rf_read_gdepth(read, &xmp);
    else
        status = REFOCUS_OK;
    rf_xmp_free(&xmp);
    return status;
#else
    (void)read;
    (void)packet;
    return REFOCUS_OK;
#endif
}

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
            rf_check_metadata(read, packet.size, "its XMP") != REFOCUS_OK)
            continue;
        packet.data = malloc(packet.size);
        if (!packet.data)
            return rf_fail_memory(read->reason);
        if (heif_image_handle_get_metadata(primary, items[i], packet.data).code == heif_error_Ok) {
            const struct rf_bytes whole = {packet.data, packet.size};

            status = rf_keep(read, RF_KEPT_XMP, whole);
            status = status == REFOCUS_OK ? read_result(read, whole) : status;
        }
        free(packet.data);
    }
    return status;
}
