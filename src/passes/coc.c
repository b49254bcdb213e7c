/* coc.c: computes the circle of confusion of each pixel and of each sample of chroma. */
#include "passes/coc.h"

#include "image/border.h"
#include "kernels/kernels.h"

void rf_coc_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                 const struct rf_focus_plan *plan, struct rf_disparity_q16 disparity,
                 struct rf_blur_q8 blur, int y0, int y1)
{
    for (int y = y0; y < y1; y++) {
        int16_t *out = blur.at + y * blur.stride;
        const uint16_t *in = disparity.at + y * disparity.stride;

        if (plan->plain)
            exec->kernels->signed_blur(out, in, plan->focus, view->width);
        else
            rf_focus_row(plan, out, in, view->x0, view->y0 + y, view->width);
    }
    rf_extend_rows(view, blur.at, blur.stride, y0, y1);
}

void rf_coc_chroma_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                        const struct rf_chroma_size *size, struct rf_blur_q8 blur,
                        struct rf_blur_q8 chroma_blur, int y0, int y1)
{
    const int c0 = y0 >> size->down, c1 = rf_chroma_end(size->down, y1);

    for (int cy = c0; cy < c1; cy++) {
        const int y = cy << size->down;
        const int16_t *upper = blur.at + y * blur.stride;
        const int16_t *lower = size->down && y + 1 < view->height ? upper + blur.stride : upper;

        exec->kernels->sharpest4(chroma_blur.at + cy * chroma_blur.stride, upper, lower,
                                 size->width);
    }
    rf_extend_chroma(view, size, chroma_blur.at, chroma_blur.stride, c0, c1);
}
