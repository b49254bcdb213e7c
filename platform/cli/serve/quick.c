/* quick.c: pictures of the reduced photo, while something is being moved. */
#include <stdlib.h>
#include <string.h>
#include "serve/serving.h"
#include "view/reduce.h"
#include "views/falsecolour.h"
#include "views/peaking.h"

enum { QUICK_RAYS = 32 };

static struct refocus_disparity map_of(const uint16_t *samples, int width, int height)
{
    return refocus_disparity16(samples, width, height, 2 * (ptrdiff_t)width);
}

static int prepare_small(struct serving *s)
{
    const struct refocus_image *const photo = s->input.photo->image;
    const struct refocus_image small = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->small_photo, s->width, s->height, 3 * (ptrdiff_t)s->width);
    const struct refocus_disparity map =
        s->feed ? map_of(s->input.disparity, s->input.width, s->input.height)
                : map_of(s->small_disparity, s->width, s->height);
    struct refocus_renderer_params params = refocus_renderer_params_default(
        s->width, s->height, (float)REFOCUS_PLAIN_BLUR_RADIUS / (float)s->reduction);
    struct refocus_scene scene = refocus_scene_default(&small, &map);
    int status = REFOCUS_OK;

    params.threads = (int32_t)s->base.engine.threads;
    params.cpu = (uint32_t)s->base.engine.cpu;
    params.thin = 1;
    if (!s->small)
        status = refocus_renderer_create(&s->small, &params);
    if (status != REFOCUS_OK || !s->small_stale)
        return status;
    rf_reduce_disparity(serve_disparity(s), photo->width, photo->height, s->reduction,
                        s->small_disparity);
    scene.matte = s->input.matte.samples ? &s->input.matte : NULL;
    status = refocus_prepare_scene(s->small, &scene);
    s->small_stale = status != REFOCUS_OK;
    return status;
}

/* The lens that does the same on the reduced photo; the quickest method, as `refocus view` does. */
static void reduce_lens(const struct serving *s, int most_rays, struct refocus_settings *params)
{
    params->field.disparity = params->render.focus_disparity;
    params->render.max_blur_radius /= (float)s->reduction;
    params->focus.blur_limit /= (float)s->reduction;
    params->look.star_length /= (float)s->reduction;
    params->render.method = REFOCUS_METHOD_SWEEP;
    params->render.inpaint = REFOCUS_INPAINT_SMOOTH;
    if (params->render.rays > most_rays || params->render.rays == REFOCUS_RAYS_FULL)
        params->render.rays = most_rays;
}

int serve_render_reduced(struct serving *s, struct refocus_settings *params, int most_rays,
                         struct refocus_image *out)
{
    int status = serve_new_picture(s, s->width, s->height, out);

    if (status == EXIT_DONE)
        status = serve_failed(s, prepare_small(s));
    if (status == EXIT_DONE) {
        reduce_lens(s, most_rays, params);
        serve_watch(s->small);
        status = serve_failed(s, refocus_render_settings(s->small, params, out));
    }
    return status;
}

int serve_aim(struct serving *s, const struct shot_settings *settings, struct engine *engine)
{
    int status = engine_begin(engine, &settings->engine);

    if (status == EXIT_DONE)
        status = serve_lens_of(s, settings, engine);
    if (status == EXIT_DONE)
        status = controls_check_method(&engine->params);
    return status == EXIT_DONE ? bokeh_check_method(&engine->params, engine->has_sides) : status;
}

int serve_render_quick(struct serving *s, const struct shot_settings *settings,
                       struct engine *engine, struct refocus_image *out)
{
    const int status = serve_aim(s, settings, engine);

    out->plane[0] = NULL;
    return status == EXIT_DONE ? serve_render_reduced(s, &engine->params, QUICK_RAYS, out) : status;
}

/* The depth, the blur, or edges in focus, of the reduced photo. */
static int draw_overlay(struct serving *s, const char *kind, struct refocus_settings *params,
                        struct refocus_image *out)
{
    const struct refocus_image small = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->small_photo, s->width, s->height, 3 * (ptrdiff_t)s->width);
    const struct refocus_depth_range known = {s->input.report.near_m, s->input.report.far_m};
    const struct refocus_depth_range *const range =
        known.near_m > 0 && known.far_m > known.near_m ? &known : NULL;
    uint16_t *const blur = malloc(2 * (size_t)s->width * (size_t)s->height);
    struct refocus_image made = {0};
    int status = blur ? REFOCUS_OK : REFOCUS_ERR_MEMORY;

    if (status == REFOCUS_OK)
        status = refocus_get_view(s->small, REFOCUS_VIEW_BLUR, blur, 2 * (ptrdiff_t)s->width);
    if (status == REFOCUS_OK && strcmp(kind, "peaking") == 0) {
        peaking_draw(&small, blur, out);
    } else if (status == REFOCUS_OK) {
        made = strcmp(kind, "depth") == 0
                   ? falsecolour_depth(s->small_disparity, s->width, s->height, range, NULL)
                   : falsecolour_blur(blur, s->small_disparity, s->width, s->height,
                                      (double)params->render.max_blur_radius, range, NULL);
        status = made.plane[0] ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    }
    free(blur);
    if (made.plane[0]) {
        free(out->plane[0]);
        *out = made;
        out->height = s->height; /* without the legend, so that it fits over the picture */
    }
    return serve_failed(s, status);
}

void serve_answer_overlay(struct serving *s, const struct rf_web_ask *ask, const char *bytes)
{
    struct refocus_image picture = {0};
    struct shot_settings settings;
    struct engine engine;
    int status;

    if (!serve_has_settings(s, ask, bytes, &settings))
        return;
    status = serve_render_quick(s, &settings, &engine, &picture);
    if (status == EXIT_DONE && strcmp(ask->word, "picture") != 0)
        status = draw_overlay(s, ask->word, &engine.params, &picture);
    engine_end(&engine);
    serve_answer_rendered(s, status, ask->size, s->feed ? SERVE_QUICK_QUALITY : 0, &picture);
}
