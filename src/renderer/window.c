/* window.c: makes a part of the photo the window, and gives a frame the views of its planes. */
#include "renderer/layout.h"

#include <math.h>
#include <string.h>

#include "renderer/renderer.h"
#include "gather/frame.h"
#include "tiles/ranges.h"
#include "support/compare.h"

/* The place of pixel (0, 0) of the window in a group of planes of a photo; see rf_use(). */
static uint16_t *origin(const struct refocus_renderer *r, const struct rf_photo *photo,
                        uint16_t *group)
{
    if (r->in_place.on) /* above it lies the border, or spare rows where the photo goes on */
        return group + (RF_SPARE_ROWS + r->view.border.y0) * photo->stride + r->view.border.x0;
    return group + (photo->pad + r->view.y0) * photo->stride + photo->pad + r->view.x0;
}

static void place_planes(struct refocus_renderer *r, const struct rf_photo *photo)
{
    uint16_t *const light = origin(r, photo, photo->group);
    uint16_t *const smooth = origin(r, photo, r->smooth_group);
    uint16_t *const background = origin(r, photo, r->background_group);

    for (int c = 0; c < 3; c++) {
        r->light.channel[c] = light + c * photo->pitch;
        r->smooth.channel[c] = smooth + (1 + c) * photo->pitch;
        r->background.light.channel[c] = background + (1 + c) * photo->pitch;
    }
    r->disparity.at = light + 3 * photo->pitch;
    r->blur.at = (int16_t *)smooth;
    r->background.blur.at = (int16_t *)background;
    r->blur.unit = r->background.blur.unit = r->unit;
    r->light.stride = r->smooth.stride = r->background.light.stride = r->disparity.stride =
        r->blur.stride = r->background.blur.stride = photo->stride;
}

/*
 * Makes the views of planes that share memory with others: memory_plan.h. The weights of a photo of
 * Y, U and V lie in the third plane of the background's light.
 */
static void share_planes(struct refocus_renderer *r)
{
    const struct rf_light_q12 *light = &r->background.light;
    const struct rf_blur_q8 shared = r->background.blur;

    r->cells = (struct rf_cells){shared.at, shared.at + r->view.tiles_x * (RF_TILE / RF_CELL),
                                 shared.stride};
    r->cone = (struct rf_dilated_blur){light->channel[0], light->channel[1], light->stride};
    r->background_weight = (struct rf_weight_q15){(uint16_t *)shared.at, shared.stride};
    r->own_weight = (struct rf_weight_q15){(uint16_t *)r->foreground.most, r->foreground.stride};
    r->weight =
        r->yuv->on ? (struct rf_weight_q15){light->channel[2], light->stride} : r->own_weight;
}

/* The place of row 0 of a plane of chroma. The window begins at a row of the photo that is a
 * multiple of RF_TILE, so the shift is exact. */
static uint16_t *chroma_of(const struct refocus_renderer *r, uint16_t *plane)
{
    return plane - (r->view.y0 - (r->view.y0 >> r->yuv->down)) * r->light.stride;
}

/*
 * Makes the views of a photo of Y, U and V. Luminance is in the first plane of light of each group
 * and chroma in the second; the blur of chroma is in the third of the pre-filtered light. The codes
 * that came in are kept: Y in place of alpha, U and V in the photo's third plane of light. All of
 * light.channel is luminance, so that the brightest channel is luminance too.
 */
static void place_chroma(struct refocus_renderer *r)
{
    const ptrdiff_t stride = r->light.stride;
    const int down = r->yuv->down;

    if (!r->yuv->on)
        return;
    r->chroma = (struct rf_chroma_planes){
        .size = {(r->view.width + 1) / 2, rf_chroma_end(down, r->view.height), down},
        .light = {chroma_of(r, r->light.channel[1]), stride},
        .smooth = {chroma_of(r, r->smooth.channel[1]), stride},
        .background = {chroma_of(r, r->background.light.channel[1]), stride},
        .blur = {(int16_t *)chroma_of(r, r->smooth.channel[2]), stride, r->unit},
        .codes = {r->alpha.at,
                  (uint8_t *)(chroma_of(r, r->light.channel[2]) - r->view.x0) + r->view.x0,
                  r->alpha.stride, stride * (ptrdiff_t)sizeof(uint16_t)},
    };
    for (int c = 1; c < 3; c++)
        r->light.channel[c] = r->light.channel[0];
}

void rf_use(struct refocus_renderer *r, struct rf_rect part)
{
    const struct rf_photo *photo = &r->photo;
    const struct rf_rect *const beyond = &r->in_place.beyond;
    const int pad = photo->pad, width = part.x1 - part.x0, height = part.y1 - part.y0;

    r->pitch = photo->pitch;
    r->view = (struct rf_viewport){
        .photo_width = photo->width,
        .photo_height = photo->height,
        .x0 = part.x0,
        .y0 = part.y0,
        .width = width,
        .height = height,
        .tiles_x = (width + RF_TILE - 1) / RF_TILE,
        .tiles_y = (height + RF_TILE - 1) / RF_TILE,
        .pad = pad,
        .border = {pad, pad, pad, pad + RF_TILE},
        .stride = photo->stride,
    };
    r->alpha.at = photo->alpha + (ptrdiff_t)part.y0 * photo->width + part.x0;
    r->alpha.stride = photo->width;
    if (r->in_place.on) {
        r->view.border = (struct rf_rect){
            part.x0 ? 0 : rf_smaller(pad, beyond->x0),
            part.y0 ? 0 : rf_smaller(pad, beyond->y0),
            part.x1 < photo->width ? 0 : rf_smaller(pad, beyond->x1),
            part.y1 < photo->height ? 0 : rf_smaller(pad, beyond->y1) + RF_TILE,
        };
        r->alpha.at = photo->alpha;
        r->alpha.stride = rf_block_side(&r->in_place);
    }
    place_planes(r, photo);
    share_planes(r);
    place_chroma(r);
    rf_pyramid_shape(&r->pyramid, width, height);
    r->pyramid.level[0].light = r->background.light;
    r->pyramid.level[0].blur = r->background.blur;
}

void rf_set_planes(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    f->exec = &r->exec;
    f->view = &r->view;
    f->light = r->light;
    f->smooth = r->smooth;
    f->blur = r->blur;
    f->background = r->background;
    f->weight = rf_is_search(f) ? r->own_weight : r->weight;
    f->background_weight = r->background_weight;
    f->disparity = r->disparity;
    f->alpha = r->alpha;
    f->range = r->range;
    f->bins = r->bins;
    f->yuv = r->yuv;
    f->deep = &r->deep;
    f->deep_out = &r->deep_out;
    f->chroma = r->chroma;
    f->transfer = &r->transfer[f->params->blend];
    f->light_weight = r->light_weight;
    f->ray_sets = &r->ray_sets;
    f->cat_eye = r->cat_eye;
    f->cat_shape = r->cat_shape;
    f->limits = (struct rf_limits){r->max_width, r->max_height, r->view.pad, r->pool.threads,
                                   fminf(r->max_blur_radius, RF_PLAIN_RADIUS)};
    f->work = &r->work;
    f->splat = (struct rf_splat){
        .exec = &r->exec,
        .window = {.view = &r->view,
                   .light = r->light,
                   .blur = r->blur,
                   .highlights = &r->photo.highlights,
                   .bins = r->bins,
                   .yuv = r->yuv->on ? r->yuv : NULL,
                   .known = r->deep.on && r->deep.exceeds ? &r->deep : NULL},
        .range = r->range,
        .aperture = f->aperture,
        .gain = f->params->highlight_gain,
        .cat_eye = f->params->cat_eye,
        .fringe = f->params->fringe,
        .largest_radius = rf_in_pixels(f->focus.radius, f->focus.unit),
    };
    f->thin.exec = &r->exec;
    f->thin.view = &r->view;
    f->thin.plan = &f->plan;
    f->thin.disparity = r->disparity;
    f->thin.light = r->light;
    f->thin.chroma = NULL;
    if (r->yuv->on) {
        f->thin.light.channel[1] = f->thin.light.channel[2] = r->light.channel[0];
        f->thin.chroma = &f->chroma;
    }
    f->thin.smooth = r->smooth;
    f->thin.blur = r->blur;
    f->thin.cell_most = r->cells.most;
    f->thin.cell_stride = r->cells.stride;
    f->thin.bins = r->bins;
    f->thin.behind = r->photo.behind.width ? &r->photo.behind : NULL;
    f->thin.transfer = &r->transfer[f->params->blend];
    f->thin.list = &r->photo.thin;
    f->thin.coverage = &r->coverage;
}

struct rf_photo_source rf_photo_source(const struct refocus_renderer *r)
{
    const struct rf_photo *photo = &r->photo;
    struct rf_photo_source source = {
        .width = photo->width, .height = photo->height, .transfer = &r->transfer[r->blend]};

    if (r->in_place.on) {
        source.image = &r->in_place.photo;
        source.map = &r->in_place.map;
        source.code_step = r->in_place.code_step;
        return source;
    }
    for (int c = 0; c < 3; c++)
        source.light.channel[c] = photo->light[c];
    source.disparity.at = photo->disparity;
    source.light.stride = source.disparity.stride = photo->stride;
    if (r->yuv->on) { /* as place_chroma() places them */
        source.yuv = r->yuv;
        source.codes = (struct rf_yuv_codes){photo->alpha, (uint8_t *)photo->light[2], photo->width,
                                             photo->stride * (ptrdiff_t)sizeof(uint16_t)};
    }
    return source;
}

void rf_set_gather_planes(struct rf_frame *f)
{
    const struct rf_lifetimes *lifetimes = &rf_renderer_of(f)->lifetimes;

    rf_set_planes(f);
#ifdef NDEBUG
    (void)lifetimes;
#else
    if (!rf_plane_lives(lifetimes, RF_PLANE_BLUR))
        f->blur.at = NULL;
    if (!rf_plane_lives(lifetimes, RF_PLANE_SMOOTH))
        memset(f->smooth.channel, 0, sizeof f->smooth.channel);
    if (!rf_plane_lives(lifetimes, RF_PLANE_BACKGROUND_LIGHT))
        memset(f->background.light.channel, 0, sizeof f->background.light.channel);
    if (!rf_plane_lives(lifetimes, RF_PLANE_BACKGROUND_BLUR))
        f->background.blur.at = NULL;
    if (!rf_plane_lives(lifetimes, RF_PLANE_BACKGROUND_WEIGHT))
        f->background_weight.at = NULL;
    if (!rf_plane_lives(lifetimes, RF_PLANE_WEIGHT) &&
        !rf_plane_lives(lifetimes, RF_PLANE_OWN_WEIGHT))
        f->weight.at = NULL;
#endif
}
