/* silhouette_blur.c: the list of pixels at silhouettes of something bright, and the blur that they
 * get. */
#include "highlights/highlights.h"

#include "focus/focus.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

/* Sets a pixel's blur, in its plane and in the bins and the cell that it is in. */
static void set_blur(const struct rf_blur_patch *patch, int x, int y, int16_t blur)
{
    patch->blur.at[y * patch->blur.stride + x] = blur;
    rf_add_bin(patch->view, patch->bins, patch->scale, x, y, blur);
    rf_add_to_cell(patch->cells, x, y, blur);
}

void rf_patch_silhouettes(const struct rf_executor *exec, const struct rf_silhouettes *silhouettes,
                          const struct rf_focus_plan *plan, const struct rf_blur_patch *patch)
{
    const struct rf_viewport *view = patch->view;

    for (uint32_t i = 0; i < silhouettes->count; i++) {
        const struct rf_silhouette *pixel = &silhouettes->pixel[i];
        const int x = pixel->x - view->x0, y = pixel->y - view->y0;
        int16_t blur;

        if (i % 1024 == 0 && rf_cancelled(exec))
            return;
        if (x < 0 || y < 0 || x >= view->width || y >= view->height)
            continue;
        rf_focus_row(plan, &blur, &pixel->disparity, pixel->x, pixel->y, 1);
        set_blur(patch, x, y, blur);
    }
}

void rf_lay_out_silhouettes(struct rf_silhouettes *silhouettes, struct rf_arena *arena,
                            int max_width, int max_height)
{
    const uint64_t pixels = (uint64_t)max_width * (uint64_t)max_height;

    silhouettes->capacity = (uint32_t)(pixels / 64 + 64);
    silhouettes->pixel = rf_arena_take(arena, silhouettes->capacity, sizeof *silhouettes->pixel);
}
