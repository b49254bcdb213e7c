/* worker.c: the thread of a viewer's session renders a quick picture first, then the full one. */
#include <stdlib.h>
#include <string.h>
#include <refocus/focus.h>
#include "reduce.h"
#include "show.h"
#include "worker.h"

/* Keep the first status that was no success. */
static void note_status(struct rf_session *s, int status)
{
    pthread_mutex_lock(&s->lock);
    if (s->status == REFOCUS_OK)
        s->status = status;
    pthread_mutex_unlock(&s->lock);
}

/* The surface at a pixel, as --focus-at has it. */
static float focus_at(const struct rf_session *s, double at_x, double at_y)
{
    const int w = s->setup.photo->width, h = s->setup.photo->height;
    const struct refocus_disparity map =
        refocus_disparity16(s->setup.disparity, w, h, 2 * (ptrdiff_t)w);
    const int x = (int)(at_x + 0.5), y = (int)(at_y + 0.5);
    float focus = 0;

    refocus_focus_at_point(&map,
                           x < 0   ? 0
                           : x < w ? x
                                   : w - 1,
                           y < 0   ? 0
                           : y < h ? y
                                   : h - 1,
                           0, &focus);
    return focus;
}

/* The lens of a state, for the full picture or for the reduced one. */
static struct refocus_settings lens_of(const struct rf_session *s,
                                       const struct rf_view_state *state, bool full)
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

/* Rays do not count: a picture that was saved may be shown, too. */
static bool same_lens(const struct refocus_settings *a, const struct refocus_settings *b)
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

/* Row of pixels for a frame of the state's size. */
static uint32_t *back_pixels(struct rf_session *s, const struct rf_view_state *state)
{
    struct rf_view_frame *const frame = &s->frames[s->back];
    const int pixels = state->width * state->height;

    if (pixels > frame->room) {
        free(frame->pixels);
        frame->pixels = malloc((size_t)pixels * sizeof *frame->pixels);
        frame->room = frame->pixels ? pixels : 0;
    }
    if (state->width > s->scratch_room) {
        free(s->scratch);
        s->scratch = malloc(RF_SHOW_SCRATCH * ((size_t)state->width + 1) * sizeof *s->scratch);
        s->scratch_room = s->scratch ? state->width : 0;
    }
    return frame->pixels && s->scratch ? frame->pixels : NULL;
}

static void publish(struct rf_session *s, const struct rf_view_state *state, uint64_t request,
                    bool full)
{
    const struct refocus_image *const photo = s->setup.photo;
    const bool result = state->mode == RF_VIEW_RESULT;
    struct rf_show show = {.rgb = result ? s->small_out : s->small_photo,
                           .width = s->width,
                           .height = s->height,
                           .reduction = s->reduction,
                           .disparity = s->setup.disparity,
                           .photo_width = photo->width,
                           .photo_height = photo->height,
                           .focus = state->focus};
    uint32_t *const pixels = back_pixels(s, state);
    struct rf_view_frame *const frame = &s->frames[s->back];
    int swap;

    if (!pixels) {
        note_status(s, REFOCUS_ERR_MEMORY);
        return;
    }
    if (full && (result || photo->stride[0] == 3 * (ptrdiff_t)photo->width)) {
        show.rgb = result ? s->full_out : photo->plane[0];
        show.width = photo->width;
        show.height = photo->height;
        show.reduction = 1;
    }
    rf_show(&show, state, pixels, s->scratch);
    frame->of = *state;
    frame->request = request;
    frame->full = full;
    pthread_mutex_lock(&s->lock);
    swap = s->ready >= 0 ? s->ready : 3 - s->front - s->back;
    s->ready = s->back;
    s->back = swap;
    pthread_mutex_unlock(&s->lock);
    s->setup.notify(s->setup.notify_user);
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

static int render_small(struct rf_session *s, const struct rf_view_state *state)
{
    const struct refocus_settings params = lens_of(s, state, false);
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
    free(light.plane[0]);
    return status;
}

/* REFOCUS_ERR_CANCELLED when something newer came. */
static int render_full(struct rf_session *s, const struct refocus_settings *params)
{
    const struct refocus_image *const photo = s->setup.photo;
    const struct refocus_image out = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->full_out, photo->width, photo->height, 3 * (ptrdiff_t)photo->width);
    struct refocus_settings used = *params;
    const bool deep = s->setup.deep && s->setup.takes_deep(s->setup.deep_user, &used);
    int status;

    s->have_full = false;
    status = prepare_full(s, deep);
    if (status == REFOCUS_OK)
        status = deep && s->setup.to_tones ? render_tones(s, &used, &out)
                                           : refocus_render_settings(s->full, &used, &out);
    s->have_full = status == REFOCUS_OK;
    s->full_of = *params;
    return status;
}

/* Whether the request is still the newest; if so the full picture may be begun. */
static bool begin_full(struct rf_session *s, uint64_t request)
{
    bool newest;

    pthread_mutex_lock(&s->lock);
    newest = s->request == request && !s->quit;
    s->rendering = newest;
    s->rendered = request;
    pthread_mutex_unlock(&s->lock);
    return newest;
}

static void end_full(struct rf_session *s)
{
    pthread_mutex_lock(&s->lock);
    s->rendering = false;
    pthread_mutex_unlock(&s->lock);
}

/* Render both pictures of a state, the second one unless something newer comes; true when both are
 * done, or cannot be. */
static bool answer(struct rf_session *s, struct rf_view_state *state, uint64_t request)
{
    const struct refocus_settings params = lens_of(s, state, true);
    const bool has_it = s->have_full && same_lens(&params, &s->full_of);
    int status = REFOCUS_OK;

    if (state->mode != RF_VIEW_RESULT) {
        publish(s, state, request, false);
        if (!begin_full(s, request))
            return false;
        end_full(s);
        publish(s, state, request, true);
        return true;
    }
    if (!has_it) {
        status = render_small(s, state);
        if (status == REFOCUS_OK)
            publish(s, state, request, false);
    }
    if (status == REFOCUS_OK && state->hold)
        return true;
    if (status == REFOCUS_OK) {
        if (!begin_full(s, request))
            return false;
        if (!has_it)
            status = render_full(s, &params);
        end_full(s);
        if (status == REFOCUS_ERR_CANCELLED)
            return false;
    }
    if (status == REFOCUS_OK)
        publish(s, state, request, true);
    else
        note_status(s, status);
    return true;
}

static void save(struct rf_session *s, const struct rf_view_state *state, uint32_t what)
{
    const struct refocus_image *const photo = s->setup.photo;
    struct refocus_settings params = lens_of(s, state, true);
    const struct refocus_image picture = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->full_out, photo->width, photo->height, 3 * (ptrdiff_t)photo->width);
    const struct rf_view_result result = {.what = what,
                                          .picture = &picture,
                                          .params = &params,
                                          .disparity = s->setup.disparity,
                                          .state = state};
    char words[RF_VIEW_WORDS] = "";
    int status = REFOCUS_OK;

    if (s->setup.still_rays && params.render.method == REFOCUS_METHOD_SWEEP)
        params.render.rays = refocus_still_rays(params.render.max_blur_radius);
    /* Nothing cancels this one: what is saved is what was asked for. */
    if ((what & RF_SAVE_PICTURE) && !(s->have_full && same_lens(&params, &s->full_of) &&
                                      params.render.rays == s->full_of.render.rays))
        status = render_full(s, &params);
    if (status == REFOCUS_OK)
        s->setup.save(s->setup.save_user, &result, words);
    else
        note_status(s, status);
    pthread_mutex_lock(&s->lock);
    memcpy(s->words, words, sizeof words);
    pthread_mutex_unlock(&s->lock);
    s->setup.notify(s->setup.notify_user);
}

/* Wait for something to do; false at the end. */
static bool take_work(struct rf_session *s, struct rf_view_state *state, uint64_t *request,
                      uint32_t *what)
{
    bool quit;

    pthread_mutex_lock(&s->lock);
    while (!s->quit && (!s->shown || (s->answered == s->request && s->save == 0)))
        pthread_cond_wait(&s->wake, &s->lock);
    *state = s->state;
    *request = s->request;
    *what = s->save;
    s->save = 0;
    quit = s->quit;
    pthread_mutex_unlock(&s->lock);
    return !quit;
}

void *rf_worker_run(void *argument)
{
    struct rf_session *const s = argument;
    const struct refocus_image *const photo = s->setup.photo;
    struct rf_view_state state;
    uint64_t request;
    uint32_t what;
    int status;

    rf_reduce_photo(photo, s->reduction, s->small_photo);
    memcpy(s->small_out, s->small_photo, 3 * (size_t)s->width * (size_t)s->height);
    while (take_work(s, &state, &request, &what)) {
        if (!s->small) {
            /* The photo at once; then the renderers, which take their time. */
            publish(s, &state, 0, false);
            status = make_renderer(s, &s->small, false);
            if (status == REFOCUS_OK)
                status = make_renderer(s, &s->full, true);
            if (status != REFOCUS_OK) {
                note_status(s, status);
                s->setup.notify(s->setup.notify_user);
                break;
            }
        }
        if (state.focus_tap > 0)
            state.focus = focus_at(s, state.tap_x, state.tap_y);
        if (what)
            save(s, &state, what);
        if (answer(s, &state, request)) {
            pthread_mutex_lock(&s->lock);
            s->answered = request;
            pthread_mutex_unlock(&s->lock);
        }
    }
    pthread_mutex_lock(&s->lock);
    s->finished = true;
    pthread_mutex_unlock(&s->lock);
    return NULL;
}
