/* light_grid_pixels.c: the pixels of a photo of any format that the means of the light grid are of,
 * and which of them may be clipped. */
#include "highlights/light_grid.h"

#include "colour/guide.h"
#include "kernels/kernels.h"

/* The codes of pixel (x, y), x even, of a photo of Y, U and V. */
static const uint8_t *luma_at(const struct rf_photo_source *photo, int x, int y)
{
    return photo->codes.y + y * photo->codes.y_stride + x;
}

static const uint8_t *chroma_at(const struct rf_photo_source *photo, int x, int y)
{
    return photo->codes.uv + (y >> photo->yuv->down) * photo->codes.uv_stride + x;
}

struct rf_grid_pixels rf_grid_pixels(const struct rf_light_grid *grid, int x, int y, int n,
                                     uint8_t rgb[3 * RF_GRID_RUN])
{
    const struct rf_photo_source *p = grid->photo;
    struct rf_grid_pixels pixels = {.code = NULL};

    if (p->yuv) {
        grid->exec->kernels->guide(rgb, luma_at(p, x, y), chroma_at(p, x, y), &p->yuv->curve, n);
        pixels.code = rgb;
        pixels.order = rf_order_of(REFOCUS_FORMAT_RGB8);
        pixels.to_light = p->transfer->to_light;
    } else if (rf_has_planes(p)) {
        for (int c = 0; c < 3; c++)
            pixels.light[c] = p->light.channel[c] + y * p->light.stride + x;
    } else {
        pixels.order = rf_order_of(p->image->format);
        pixels.code =
            p->image->plane[0] + y * p->image->stride[0] + (ptrdiff_t)x * pixels.order.bytes;
        pixels.to_light = p->transfer->to_light;
    }
    return pixels;
}

/* Whether any of n pixels may be clipped: R', G' or B' of the largest codes of Y, U and V that are
 * among them, or of the least ones of U and V. */
static bool codes_may_be_clipped(const struct rf_light_grid *grid, int x, int y, int n)
{
    const struct rf_photo_source *p = grid->photo;
    const struct rf_yuv_curve *curve = &p->yuv->curve;
    const uint8_t *luma = luma_at(p, x, y), *uv = chroma_at(p, x, y);
    uint8_t brightest = 0, least_u = 255, least_v = 255, most_u = 0, most_v = 0;
    int more;

    for (int i = 0; i < n; i++)
        brightest = luma[i] > brightest ? luma[i] : brightest;
    for (int i = 0; i < n; i += 2) {
        const uint8_t u = uv[i], v = uv[i + 1];

        least_u = u < least_u ? u : least_u;
        least_v = v < least_v ? v : least_v;
        most_u = u > most_u ? u : most_u;
        most_v = v > most_v ? v : most_v;
    }
    more = rf_larger(rf_larger(rf_more(curve, 0, most_u), rf_more(curve, 1, most_v)),
                     -rf_less_green(curve, least_u, least_v));
    return p->transfer->to_light[rf_code_of_tone(curve->luma[brightest] + more)] >
           grid->tables->clipped;
}

bool rf_grid_may_be_clipped(const struct rf_light_grid *grid, int x, int y, int n)
{
    const struct rf_light_q12 *light = &grid->photo->light;
    const ptrdiff_t at = y * light->stride + x;

    if (grid->photo->yuv)
        return codes_may_be_clipped(grid, x, y, n);
    if (!rf_has_planes(grid->photo))
        return true;
    return grid->exec->kernels->brightest(light->channel[0] + at, light->channel[1] + at,
                                          light->channel[2] + at, n) > grid->tables->clipped;
}
