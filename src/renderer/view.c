/* view.c: gives out the disparities of a prepared photo and the blurs of its last render. */
#include <refocus/render.h>

#include <stdlib.h>
#include <string.h>

#include "depth/dequantise.h"
#include "image/format.h"
#include "renderer/renderer.h"
#include "support/compare.h"
#include "support/log.h"

/* Copies the prepared disparities. Strip mode, which stores none, computes them again. */
static void copy_disparities(const struct refocus_renderer *r, uint16_t *out, ptrdiff_t pitch)
{
    enum { SIDE = RF_DEQUANTISE_PATCH };
    const struct rf_photo *photo = &r->photo;
    const struct rf_in_place *in_place = &r->in_place;
    uint16_t patch[SIDE * SIDE];

    for (int y = 0; y < photo->height && !in_place->on; y++)
        memcpy(out + y * pitch, photo->disparity + y * photo->stride, (size_t)photo->width * 2);
    for (int y = 0; y < photo->height && in_place->on; y += SIDE)
        for (int x = 0; x < photo->width; x += SIDE) {
            const int width = rf_smaller(SIDE, photo->width - x);
            const int height = rf_smaller(SIDE, photo->height - y);

            rf_dequantised_patch(r->exec.kernels, &in_place->map, in_place->code_step, x, y, width,
                                 height, patch);
            for (int v = 0; v < height; v++)
                memcpy(out + (y + v) * pitch + x, patch + v * width, (size_t)width * 2);
        }
}

enum { RUN = 256 };

/* Replaces disparities by the signed blurs of the last render, then by their sizes in pixels. */
static void to_blur(const struct refocus_renderer *r, uint16_t *out, ptrdiff_t pitch)
{
    const struct rf_photo *photo = &r->photo;
    const uint32_t silhouettes = r->last_silhouettes ? photo->silhouettes.count : 0;
    int16_t *blur = (int16_t *)out;
    uint16_t row[RUN];

    for (int y = 0; y < photo->height; y++) {
        for (int x = 0; x < photo->width; x += RUN) {
            const int n = photo->width - x < RUN ? photo->width - x : RUN;

            memcpy(row, out + y * pitch + x, (size_t)n * 2);
            rf_focus_row(&r->last_plan, blur + y * pitch + x, row, x, y, n);
        }
    }
    for (uint32_t i = 0; i < silhouettes; i++) {
        const struct rf_silhouette *at = &photo->silhouettes.pixel[i];

        rf_focus_row(&r->last_plan, blur + at->y * pitch + at->x, &at->disparity, at->x, at->y, 1);
    }
    for (int y = 0; y < photo->height; y++)
        for (int x = 0; x < photo->width; x++) {
            const int size = rf_in_pixels(abs(blur[y * pitch + x]), r->last_plan.focus.unit);

            out[y * pitch + x] = (uint16_t)rf_smaller(size, UINT16_MAX);
        }
}

static int get_view(const struct refocus_renderer *r, const struct rf_log *log, uint32_t view,
                    uint16_t *out, ptrdiff_t stride)
{
    const struct rf_photo *photo;

    if (!out || ((uintptr_t)out & 1))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "out is %s, must be at an even address",
                         out ? "odd" : "NULL");
    if (view > REFOCUS_VIEW_BLUR)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "view is %u, may be 0 to %d", (unsigned)view,
                         REFOCUS_VIEW_BLUR);
    if (stride % 2)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "stride is %lld, must be even",
                         (long long)stride);
    if (!r->prepared || (view == REFOCUS_VIEW_BLUR && !r->blurred))
        return rf_refuse(log, REFOCUS_ERR_STATE, "nothing is %s yet",
                         r->prepared ? "rendered" : "prepared");
    photo = &r->photo;
    if (!rf_good_stride(stride, 2 * (ptrdiff_t)photo->width, photo->height))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "stride is %lld, may be %d or more either way",
                         (long long)stride, 2 * photo->width);
    copy_disparities(r, out, stride / 2);
    if (view == REFOCUS_VIEW_BLUR)
        to_blur(r, out, stride / 2);
    return REFOCUS_OK;
}

int refocus_get_view(struct refocus_renderer *r, uint32_t view, uint16_t *out, ptrdiff_t stride)
{
    struct rf_log log = {.function = "refocus_get_view"};
    const int status = rf_enter(r, &log);

    return status ? status : rf_leave(r, get_view(r, &log, view, out, stride));
}
