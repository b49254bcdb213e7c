/* heic_deep.c: HEIC and AVIF of 10 and 12 bits: by the curves of HDR (nclx, ISO/IEC 23091-2) they
 * are light, brighter than white in places; by others they are codes as those of 8 bits are. */
#include "heic_deep.h"

#include <string.h>

#include "light.h"
#include "reason.h"

bool rf_heic_is_avif(struct rf_bytes file)
{
    return file.size >= 12 && memcmp(file.data + 8, "avi", 3) == 0;
}

enum heif_chroma rf_heic_deep_chroma(void)
{
    const uint16_t one = 1;

    return *(const uint8_t *)&one == 1 ? heif_chroma_interleaved_RRGGBB_LE
                                       : heif_chroma_interleaved_RRGGBB_BE;
}

/* The curve, if it is one of HDR, and the primaries; false: it is none. */
static bool find_curve(const struct heif_image_handle *handle, int *curve, int *primaries)
{
    struct heif_color_profile_nclx *nclx = NULL;

    if (heif_image_handle_get_luma_bits_per_pixel(handle) <= 8 ||
        heif_image_handle_get_nclx_color_profile(handle, &nclx).code != heif_error_Ok || !nclx)
        return false;
    *curve = (int)nclx->transfer_characteristics;
    *primaries = (int)nclx->color_primaries;
    heif_nclx_color_profile_free(nclx);
    return rf_curve_is_hdr(*curve);
}

bool rf_heic_is_light(const struct heif_image_handle *handle)
{
    int curve, primaries;

    return find_curve(handle, &curve, &primaries);
}

int rf_heic_settle_light(struct rf_read *read, const struct heif_image_handle *handle)
{
    int curve, primaries, status;

    if (read->image.max_value <= 255 || !find_curve(handle, &curve, &primaries))
        return REFOCUS_OK;
    status = rf_raster_to_light(read, &read->image, curve, primaries);
    if (status == REFOCUS_OK)
        rf_note_curve(read, curve, primaries);
    return status;
}
