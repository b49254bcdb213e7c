/* worker.c: the thread of a viewer's session answers requests: by a quick picture first, then by
 * the full one; and saves. */
#include <stdlib.h>
#include <string.h>
#include <refocus/focus.h>
#include "reduce.h"
#include "render.h"
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
    const struct refocus_settings params = rf_view_lens(s, state, true);
    const bool has_it = s->have_full && rf_view_same_lens(&params, &s->full_of);
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
        status = rf_view_render_small(s, state);
        if (status == REFOCUS_OK)
            publish(s, state, request, false);
    }
    if (status == REFOCUS_OK && state->hold)
        return true;
    if (status == REFOCUS_OK) {
        if (!begin_full(s, request))
            return false;
        if (!has_it)
            status = rf_view_render_full(s, &params);
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
    struct refocus_settings params = rf_view_lens(s, state, true);
    struct refocus_image picture = {.width = photo->width, .height = photo->height};
    struct rf_view_result result = {.what = what,
                                    .picture = &picture,
                                    .params = &params,
                                    .disparity = s->setup.disparity,
                                    .state = state};
    char words[RF_VIEW_WORDS] = "";
    int status = REFOCUS_OK;

    if (s->setup.still_rays && params.render.method == REFOCUS_METHOD_SWEEP)
        params.render.rays = refocus_still_rays(params.render.max_blur_radius);
    /* Nothing cancels this one: what is saved is what was asked for. */
    if (what & RF_SAVE_PICTURE)
        status = rf_view_render_saved(s, &params, &picture);
    if (picture.plane[0] == s->full_out && s->light.plane[0])
        result.light = &s->light;
    if (status == REFOCUS_OK)
        s->setup.save(s->setup.save_user, &result, words);
    else
        note_status(s, status);
    if (picture.plane[0] != s->full_out)
        free(picture.plane[0]);
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
            status = rf_view_make_renderers(s);
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
