#include <refocus/render.h>

#include <stdlib.h>
#include <string.h>

#include "planes/format.h"
#include "renderer/renderer.h"

int refocus_get_view(struct refocus_renderer *r, uint32_t view, uint16_t *out,
                     ptrdiff_t stride)
{
    if (!r || !out || view > REFOCUS_VIEW_BLUR || stride % 2)
        return REFOCUS_ERR_ARGUMENT;
    if (!r->prepared || (view == REFOCUS_VIEW_BLUR && !r->blurred))
        return REFOCUS_ERR_STATE;
    if (!rf_good_stride(stride, 2 * (ptrdiff_t)r->width, r->height))
        return REFOCUS_ERR_ARGUMENT;
    for (int y = 0; y < r->height; y++, out += stride / 2) {
        const int16_t *s = r->front.blur + y * r->stride;

        if (view == REFOCUS_VIEW_DISPARITY)
            memcpy(out, r->disparity + y * r->stride, (size_t)r->width * 2);
        else
            for (int x = 0; x < r->width; x++)
                out[x] = (uint16_t)abs(s[x]);
    }
    return REFOCUS_OK;
}
