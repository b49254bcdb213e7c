/* exact.c: tells whether a window inpaints its background as the whole photo would. */
#include "background/inpaint.h"

#include "image/rect.h"
#include "kernels/kernels.h"

/* The parents that unknown pixels of `need` at a level take from; x1 <= x0: none is unknown. */
static struct rf_rect parents(const int16_t *blur, ptrdiff_t stride, struct rf_rect need)
{
    struct rf_rect unknown = {need.x1, need.y1, need.x0, need.y0};

    for (int y = need.y0; y < need.y1; y++) {
        for (int x = need.x0; x < need.x1; x++) {
            if (blur[y * stride + x] != RF_NO_BLUR)
                continue;
            unknown.x0 = x < unknown.x0 ? x : unknown.x0;
            unknown.x1 = x >= unknown.x1 ? x + 1 : unknown.x1;
            unknown.y0 = y < unknown.y0 ? y : unknown.y0;
            unknown.y1 = y + 1;
        }
    }
    if (unknown.x1 <= unknown.x0)
        return (struct rf_rect){0, 0, 0, 0};
    return (struct rf_rect){unknown.x0 / 2 - 1, unknown.y0 / 2 - 1, (unknown.x1 - 1) / 2 + 2,
                            (unknown.y1 - 1) / 2 + 2};
}

bool rf_background_is_exact(const struct rf_viewport *view, const struct rf_pyramid *pyramid,
                            struct rf_rect need, struct rf_rect exact)
{
    for (int i = 0; i <= pyramid->levels; i++) {
        const struct rf_level *level = &pyramid->level[i];
        const int side = 1 << i, width = level->width, height = level->height;

        need = (struct rf_rect){rf_within(need.x0, width), rf_within(need.y0, height),
                                rf_within(need.x1, width), rf_within(need.y1, height)};
        /* pixels of this level are those of the whole photo's? */
        if ((view->x0 | view->y0) & (side - 1))
            return false;
        if ((int64_t)need.x0 * side < exact.x0 || (int64_t)need.y0 * side < exact.y0 ||
            (int64_t)need.x1 * side > exact.x1 || (int64_t)need.y1 * side > exact.y1)
            return false;
        need = parents(level->blur.at, level->blur.stride, need);
        if (need.x1 <= need.x0)
            return true;
    }
    return false;
}
