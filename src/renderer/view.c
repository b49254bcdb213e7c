#include <refocus/render.h>

#include <stdlib.h>
#include <string.h>

#include "planes/format.h"
#include "renderer/renderer.h"

/* |s| of n pixels, as the last render had it. */
static void blur_run(const struct refocus_renderer *r, const uint16_t *disparity, uint16_t *out,
                     int n)
{
    r->kernels.signed_blur((int16_t *)out, disparity, r->last_focus, n);
    for (int x = 0; x < n; x++)
        out[x] = (uint16_t)abs((int16_t)out[x]);
}

int refocus_get_view(struct refocus_renderer *r, uint32_t view, uint16_t *out,
                     ptrdiff_t stride)
{
    const struct rf_photo *photo;

    if (!r || !out || view > REFOCUS_VIEW_BLUR || stride % 2)
        return REFOCUS_ERR_ARGUMENT;
    if (!r->prepared || (view == REFOCUS_VIEW_BLUR && !r->blurred))
        return REFOCUS_ERR_STATE;
    photo = &r->photo[0];
    if (!rf_good_stride(stride, 2 * (ptrdiff_t)photo->width, photo->height))
        return REFOCUS_ERR_ARGUMENT;
    for (int y = 0; y < photo->height; y++) {
        const uint16_t *disparity = photo->disparity + y * photo->stride;
        uint16_t *row = out + y * (stride / 2);

        if (view == REFOCUS_VIEW_DISPARITY)
            memcpy(row, disparity, (size_t)photo->width * 2);
        else
            blur_run(r, disparity, row, photo->width);
    }
    for (uint64_t i = 0; view == REFOCUS_VIEW_BLUR && r->last_rims && i < photo->rims; i++) {
        const struct rf_rim *rim = &photo->rim[i];

        blur_run(r, &rim->disparity, out + rim->y * (stride / 2) + rim->x, 1);
    }
    return REFOCUS_OK;
}
