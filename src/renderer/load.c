/* load.c: loads a photo and its disparities into the planes of the window. */
#include "renderer/load.h"

#include "passes/disparity.h"
#include "passes/linearise.h"
#include "passes/linearise_yuv.h"

static struct rf_linearise_yuv linearise_yuv(const struct refocus_renderer *r)
{
    return (struct rf_linearise_yuv){
        .curve = &r->yuv->curve,
        .size = r->chroma.size,
        .codes = r->chroma.codes,
        .light = r->light,
        .chroma = r->chroma.light,
    };
}

void rf_load_light(struct refocus_renderer *r, const struct refocus_image *photo,
                   const struct refocus_image *guide)
{
    if (r->yuv->on) {
        struct rf_linearise_yuv pass = linearise_yuv(r);

        pass.photo = photo;
        pass.guide = guide;
        rf_linearise_yuv(&r->exec, &r->view, &pass);
        return;
    }
    if (r->deep.on) {
        rf_linearise_deep(&r->exec, &r->view,
                          &(struct rf_linearise_deep){&r->deep, &r->transfer[r->blend], r->light,
                                                      r->alpha, guide});
        return;
    }
    rf_linearise(&r->exec, &r->view,
                 &(struct rf_linearise){photo, &r->transfer[r->blend], r->light, r->alpha});
}

void rf_reload_yuv_rows(struct refocus_renderer *r, int y0, int y1, int worker)
{
    const struct rf_linearise_yuv pass = linearise_yuv(r);

    rf_reblend_yuv_rows(&r->exec, &r->view, &pass, y0, y1, worker);
}

/* Uses the planes of pre-filtered light as scratch: they are free until something is rendered. */
void rf_load_disparity(struct refocus_renderer *r, const struct refocus_disparity *map, int step,
                       int left, int above)
{
    const ptrdiff_t stride = r->disparity.stride, first = -above * stride - left;

    rf_plane_begin(&r->lifetimes, RF_PLANE_PREPARE_SPARE);
    rf_copy_disparity(&r->exec, &(struct rf_copy_disparity){
                                    .map = map,
                                    .step = step,
                                    .disparity = {r->disparity.at + first, stride},
                                    .spare = {{r->smooth.channel[1] + first, r->smooth.stride},
                                              {r->smooth.channel[2] + first, r->smooth.stride}},
                                });
}
