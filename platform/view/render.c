/* render.c: the pictures of a viewer's session: a quick one of the reduced photo, the full one, and
 * the one that is saved. */
#include "render.h"

#include <stdlib.h>
#include <string.h>
#include "reduce.h"

struct refocus_settings rf_view_lens(const struct rf_session *s, const struct rf_view_state *state,
                                     bool full)
{
    const int reduction = full ? 1 : s->reduction;
    struct refocus_settings params = s->setup.params;

    params.render.method = state->method;
    params.render.focus_disparity = state->focus;
    params.field.disparity = state->focus;
    params.render.max_blur_radius = state->blur;
    if (s->setup.aim)
        s->setup.aim(s->setup.aim_user, state, &params);
    params.render.max_blur_radius /= (float)reduction;
    params.focus.blur_limit /= (float)reduction;
    params.look.star_length /= (float)reduction;
    if (!full) {
        /* The quickest; the full picture is by the method that was asked for. */
        params.render.method = REFOCUS_METHOD_SWEEP;
        if (params.render.rays > PREVIEW_RAYS || params.render.rays == REFOCUS_RAYS_FULL)
            params.render.rays = PREVIEW_RAYS;
    }
    return params;
}

static bool is_same(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

bool rf_view_same_lens(const struct refocus_settings *a, const struct refocus_settings *b)
{
    /* Numbers that come from the same places: equal when nothing has changed. */
    return a->render.method == b->render.method &&
           is_same(a->render.focus_disparity, b->render.focus_disparity) &&
           is_same(a->render.max_blur_radius, b->render.max_blur_radius) &&
           is_same(a->field.disparity, b->field.disparity) &&
           is_same(a->focus.tilt_x, b->focus.tilt_x) && is_same(a->focus.tilt_y, b->focus.tilt_y) &&
           is_same(a->focus.tilt_across, b->focus.tilt_across) &&
           is_same(a->focus.tilt_down, b->focus.tilt_down);
}

static int make_renderer(struct rf_session *s, struct refocus_renderer **renderer, bool full)
{
    const struct refocus_image *const photo = s->setup.photo;
    struct refocus_renderer_params params = refocus_renderer_params_default(
        full ? photo->width : s->width, full ? photo->height : s->height,
        (float)REFOCUS_PLAIN_BLUR_RADIUS / (full ? 1.0f : (float)s->reduction));

    params.threads = s->setup.threads;
    params.cpu = s->setup.cpu;
    params.thin = 1;
    params.textured = full && s->setup.params.render.inpaint == REFOCUS_INPAINT_TEXTURED;
    params.papers = refocus_papers();
    params.deep = full && s->setup.deep;
    return refocus_renderer_create(renderer, &params);
}

static int prepare(const struct rf_session *s, struct refocus_renderer *renderer,
                   const struct refocus_image *photo, const struct refocus_disparity *map)
{
    struct refocus_scene scene = refocus_scene_default(photo, map);

    scene.matte = s->setup.matte;
    return refocus_prepare_scene(renderer, &scene);
}

static int prepare_small(struct rf_session *s)
{
    const struct refocus_image *const photo = s->setup.photo;
    const struct refocus_image image = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->small_photo, s->width, s->height, 3 * (ptrdiff_t)s->width);
    const struct refocus_disparity map =
        refocus_disparity16(s->small_disparity, s->width, s->height, 2 * (ptrdiff_t)s->width);
    int status;

    if (s->small_prepared)
        return REFOCUS_OK;
    rf_reduce_disparity(s->setup.disparity, photo->width, photo->height, s->reduction,
                        s->small_disparity);
    status = prepare(s, s->small, &image, &map);
    s->small_prepared = status == REFOCUS_OK;
    return status;
}

int rf_view_render_small(struct rf_session *s, const struct rf_view_state *state)
{
    const struct refocus_settings params = rf_view_lens(s, state, false);
    const struct refocus_image out = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->small_out, s->width, s->height, 3 * (ptrdiff_t)s->width);
    const int status = prepare_small(s);

    return status == REFOCUS_OK ? refocus_render_settings(s->small, &params, &out) : status;
}

/* Prepare the photo with all that it holds, or with its 8 bits, unless it is prepared so. */
static int prepare_full(struct rf_session *s, bool deep)
{
    const struct refocus_image *const photo = s->setup.photo;
    const struct refocus_disparity map = refocus_disparity16(
        s->setup.disparity, photo->width, photo->height, 2 * (ptrdiff_t)photo->width);
    int status;

    if (s->full_prepared && s->full_deep == deep)
        return REFOCUS_OK;
    s->full_prepared = false;
    status = prepare(s, s->full, deep ? s->setup.deep : photo, &map);
    s->full_prepared = status == REFOCUS_OK;
    s->full_deep = deep;
    return status;
}

static bool takes_deep(const struct rf_session *s, struct refocus_settings *params)
{
    return s->setup.deep && s->setup.takes_deep(s->setup.deep_user, params);
}

/* Render light, and bring it into the tones of the photo. */
static int render_tones(struct rf_session *s, const struct refocus_settings *params,
                        const struct refocus_image *out)
{
    const uint64_t stride = 6 * (uint64_t)out->width, bytes = stride * (uint64_t)out->height;
    struct refocus_image light = refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, NULL, out->width,
                                                      out->height, (ptrdiff_t)stride);
    int status = REFOCUS_ERR_MEMORY;

    if (bytes <= SIZE_MAX)
        light.plane[0] = malloc((size_t)bytes);
    if (light.plane[0])
        status = refocus_render_settings(s->full, params, &light);
    if (status == REFOCUS_OK)
        status = s->setup.to_tones(s->setup.deep_user, &light, params, out);
    if (status == REFOCUS_OK && s->setup.keeps_light)
        s->light = light;
    else
        free(light.plane[0]);
    return status;
}

int rf_view_render_full(struct rf_session *s, const struct refocus_settings *params)
{
    const struct refocus_image *const photo = s->setup.photo;
    const struct refocus_image out = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->full_out, photo->width, photo->height, 3 * (ptrdiff_t)photo->width);
    struct refocus_settings used = *params;
    const bool deep = takes_deep(s, &used);
    int status;

    s->have_full = false;
    free(s->light.plane[0]);
    s->light.plane[0] = NULL;
    status = prepare_full(s, deep);
    if (status == REFOCUS_OK)
        status = deep && s->setup.to_tones ? render_tones(s, &used, &out)
                                           : refocus_render_settings(s->full, &used, &out);
    s->have_full = status == REFOCUS_OK;
    s->full_of = *params;
    return status;
}

int rf_view_make_renderers(struct rf_session *s)
{
    const int status = make_renderer(s, &s->small, false);

    return status == REFOCUS_OK ? make_renderer(s, &s->full, true) : status;
}

int rf_view_render_saved(struct rf_session *s, const struct refocus_settings *params,
                         struct refocus_image *picture)
{
    const struct refocus_image *const photo = s->setup.photo;
    const uint64_t stride =
        (uint64_t)refocus_format_bytes(s->setup.saved.format) * (uint64_t)photo->width;
    const uint64_t bytes = stride * (uint64_t)photo->height;
    struct refocus_settings used = *params;
    int status;

    *picture = refocus_image_packed(REFOCUS_FORMAT_RGB8, s->full_out, photo->width, photo->height,
                                    3 * (ptrdiff_t)photo->width);
    if (!stride || !takes_deep(s, &used))
        return s->have_full && rf_view_same_lens(params, &s->full_of) &&
                       params->render.rays == s->full_of.render.rays
                   ? REFOCUS_OK
                   : rf_view_render_full(s, params);
    picture->format = s->setup.saved.format;
    picture->transfer = s->setup.saved.transfer;
    picture->white = s->setup.saved.white;
    picture->stride[0] = (ptrdiff_t)stride;
    picture->plane[0] = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    status = picture->plane[0] ? prepare_full(s, true) : REFOCUS_ERR_MEMORY;
    return status == REFOCUS_OK ? refocus_render_settings(s->full, &used, picture) : status;
}
