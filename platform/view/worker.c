/* worker.c: the thread of a viewer's session renders a quick picture first, then the full one. */
#include <stdlib.h>
#include <string.h>
#include <refocus/focus.h>
#include "reduce.h"
#include "show.h"
#include "worker.h"

void rf_worker_note(struct rf_session *s, int status)
{
    pthread_mutex_lock(&s->lock);
    if (s->status == REFOCUS_OK)
        s->status = status;
    pthread_mutex_unlock(&s->lock);
}

static const uint16_t *disparity_of(const struct rf_session *s)
{
    return refocus_strokes_disparity(s->strokes);
}

/* The surface at a pixel, as --focus-at has it. */
static float focus_at(const struct rf_session *s, double at_x, double at_y)
{
    const int w = s->setup.photo->width, h = s->setup.photo->height;
    const struct refocus_disparity map =
        refocus_disparity16(disparity_of(s), w, h, 2 * (ptrdiff_t)w);
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

/* Depth of the gradient's far end: what lies there before it is painted. */
static void look_up_end(const struct rf_session *s, struct refocus_fill *fill)
{
    const int w = s->setup.photo->width, h = s->setup.photo->height;
    const int x = fill->x1 < 0 ? 0 : fill->x1 > (float)(w - 1) ? w - 1 : (int)fill->x1;
    const int y = fill->y1 < 0 ? 0 : fill->y1 > (float)(h - 1) ? h - 1 : (int)fill->y1;

    fill->d1 = (float)disparity_of(s)[(size_t)y * (size_t)w + (size_t)x] / 65535;
}

/* Points that follow each other are one segment, however late this comes to them. */
static int paint_points(struct rf_session *s, const struct order *orders, int count)
{
    float *const points = malloc(2 * (size_t)count * sizeof *points);
    int status = REFOCUS_ERR_MEMORY;

    if (points) {
        for (int i = 0; i < count; i++) {
            points[2 * i] = orders[i].x;
            points[2 * i + 1] = orders[i].y;
        }
        status = refocus_strokes_extend(s->strokes, points, count, NULL);
    }
    free(points);
    return status;
}

static void paint(struct rf_session *s, struct order *orders, int count)
{
    for (int i = 0, next; i < count; i = next) {
        int status;

        next = i + 1;
        if (orders[i].kind == ORDER_POINT) {
            while (next < count && orders[next].kind == ORDER_POINT)
                next++;
            status = paint_points(s, orders + i, next - i);
        } else if (orders[i].kind == ORDER_UNDO) {
            status = refocus_strokes_undo(s->strokes, NULL);
        } else {
            if (orders[i].end_from_depth)
                look_up_end(s, &orders[i].stroke.fill);
            status = refocus_strokes_begin(s->strokes, &orders[i].stroke, NULL);
        }
        /* More without an object before it, or nothing to undo, is no failure of ours.
         */
        if (status != REFOCUS_OK && status != REFOCUS_ERR_STATE)
            rf_worker_note(s, status);
        s->small_stale = s->full_stale = true;
        s->have_full = false;
    }
}

static int make_renderer(struct rf_session *s, struct refocus_renderer **renderer, int width,
                         int height, int reduction)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(
        width, height, (float)REFOCUS_PLAIN_BLUR_RADIUS / (float)reduction);

    params.threads = s->setup.threads;
    params.cpu = s->setup.cpu;
    params.thin = 1;
    params.textured = reduction == 1 && s->setup.params.render.inpaint == REFOCUS_INPAINT_TEXTURED;
    params.papers = refocus_papers();
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
                           .disparity = disparity_of(s),
                           .photo_width = photo->width,
                           .photo_height = photo->height,
                           .selection_width = s->width,
                           .selection_height = s->height,
                           .selection_reduction = s->reduction,
                           .focus = state->focus};
    uint32_t *const pixels = back_pixels(s, state);
    struct rf_view_frame *const frame = &s->frames[s->back];
    int swap;

    if (!pixels) {
        rf_worker_note(s, REFOCUS_ERR_MEMORY);
        return;
    }
    if (state->selection &&
        !refocus_strokes_selection(s->strokes, s->selection, s->width, s->height, s->width))
        show.selection = s->selection;
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
    frame->strokes = refocus_strokes_count(s->strokes);
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

    if (!s->small_stale)
        return REFOCUS_OK;
    rf_reduce_disparity(disparity_of(s), photo->width, photo->height, s->reduction,
                        s->small_disparity);
    status = prepare(s, s->small, &image, &map);
    s->small_stale = status != REFOCUS_OK;
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

/* REFOCUS_ERR_CANCELLED when something newer came. */
static int render_full(struct rf_session *s, const struct rf_view_state *state)
{
    const struct refocus_image *const photo = s->setup.photo;
    const struct refocus_settings params = lens_of(s, state, true);
    const struct refocus_image out = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->full_out, photo->width, photo->height, 3 * (ptrdiff_t)photo->width);
    const struct refocus_disparity map = refocus_disparity16(
        disparity_of(s), photo->width, photo->height, 2 * (ptrdiff_t)photo->width);
    int status = REFOCUS_OK;

    if (s->have_full && same_lens(&params, &s->full_of))
        return REFOCUS_OK;
    s->have_full = false;
    if (s->full_stale)
        status = prepare(s, s->full, photo, &map);
    if (status != REFOCUS_OK)
        return status;
    s->full_stale = false;
    status = refocus_render_settings(s->full, &params, &out);
    s->have_full = status == REFOCUS_OK;
    s->full_of = params;
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
    int status = REFOCUS_OK;

    if (state->mode != RF_VIEW_RESULT) {
        publish(s, state, request, false);
        if (!begin_full(s, request))
            return false;
        end_full(s);
        publish(s, state, request, true);
        return true;
    }
    if (!s->have_full || !same_lens(&params, &s->full_of)) {
        status = render_small(s, state);
        if (status == REFOCUS_OK)
            publish(s, state, request, false);
    }
    if (status == REFOCUS_OK && state->hold)
        return true;
    if (status == REFOCUS_OK) {
        if (!begin_full(s, request))
            return false;
        status = render_full(s, state);
        end_full(s);
        if (status == REFOCUS_ERR_CANCELLED)
            return false;
    }
    if (status == REFOCUS_OK)
        publish(s, state, request, true);
    else
        rf_worker_note(s, status);
    return true;
}

static void save(struct rf_session *s, const struct rf_view_state *state, uint32_t what)
{
    const struct refocus_image *const photo = s->setup.photo;
    const struct refocus_settings params = lens_of(s, state, true);
    const struct refocus_image picture = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, s->full_out, photo->width, photo->height, 3 * (ptrdiff_t)photo->width);
    const struct rf_view_result result = {.what = what,
                                          .picture = &picture,
                                          .params = &params,
                                          .disparity = disparity_of(s),
                                          .strokes = s->strokes,
                                          .state = state};
    int status = REFOCUS_OK;

    /* Nothing cancels this one: what is saved is what was asked for. */
    if (what & RF_SAVE_PICTURE)
        status = render_full(s, state);
    if (status == REFOCUS_OK)
        s->setup.save(s->setup.save_user, &result);
    else
        rf_worker_note(s, status);
}

/* The focus of the state's tap; of a newer depth only after a newer tap. */
static void find_focus(struct rf_session *s, struct rf_view_state *state)
{
    if (state->focus_tap == 0)
        return;
    if (state->focus_tap != s->tap) {
        s->tap = state->focus_tap;
        s->tap_focus = focus_at(s, state->tap_x, state->tap_y);
    }
    state->focus = s->tap_focus;
}

/* Wait for something to do; false at the end. */
static bool take_work(struct rf_session *s, struct rf_view_state *state, uint64_t *request,
                      struct order **orders, int *count, uint32_t *what)
{
    bool quit;

    pthread_mutex_lock(&s->lock);
    while (!s->quit && (!s->shown || (s->answered == s->request && s->save == 0)))
        pthread_cond_wait(&s->wake, &s->lock);
    *state = s->state;
    *request = s->request;
    *orders = s->orders;
    *count = s->order_count;
    *what = s->save;
    s->orders = NULL;
    s->order_count = s->order_room = 0;
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
    struct order *orders = NULL;
    uint64_t request;
    uint32_t what;
    int count, status;

    rf_reduce_photo(photo, s->reduction, s->small_photo);
    memcpy(s->small_out, s->small_photo, 3 * (size_t)s->width * (size_t)s->height);
    while (take_work(s, &state, &request, &orders, &count, &what)) {
        if (!s->small) {
            /* The photo at once; then the renderers, which take their time. */
            publish(s, &state, 0, false);
            status = make_renderer(s, &s->small, s->width, s->height, s->reduction);
            if (status == REFOCUS_OK)
                status = make_renderer(s, &s->full, photo->width, photo->height, 1);
            if (status != REFOCUS_OK) {
                rf_worker_note(s, status);
                s->setup.notify(s->setup.notify_user);
                break;
            }
        }
        paint(s, orders, count);
        free(orders);
        orders = NULL;
        find_focus(s, &state);
        if (what)
            save(s, &state, what);
        if (answer(s, &state, request)) {
            pthread_mutex_lock(&s->lock);
            s->answered = request;
            pthread_mutex_unlock(&s->lock);
        }
    }
    free(orders);
    pthread_mutex_lock(&s->lock);
    s->finished = true;
    pthread_mutex_unlock(&s->lock);
    return NULL;
}
