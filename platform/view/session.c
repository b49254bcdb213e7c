/* session.c: requests of the viewer are handed to the thread that renders, and frames are taken
 * from it. */
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <refocus/status.h>
#include "session.h"
#include "worker.h"

static int take_memory(struct rf_session *s)
{
    const struct refocus_image *const photo = s->setup.photo;
    const uint64_t pixels = (uint64_t)photo->width * (uint64_t)photo->height;
    const size_t small = (size_t)s->width * (size_t)s->height;
    const struct refocus_disparity map = refocus_disparity16(
        s->setup.disparity, photo->width, photo->height, 2 * (ptrdiff_t)photo->width);

    if (pixels > SIZE_MAX / 4)
        return REFOCUS_ERR_SIZE;
    s->small_photo = malloc(3 * small);
    s->small_out = malloc(3 * small);
    s->selection = malloc(small);
    s->small_disparity = malloc(2 * small);
    s->full_out = malloc(3 * (size_t)pixels);
    if (!s->small_photo || !s->small_out || !s->selection || !s->small_disparity || !s->full_out)
        return REFOCUS_ERR_MEMORY;
    if (s->strokes)
        return REFOCUS_OK;
    return refocus_strokes_create(&s->strokes, photo, s->setup.disparity ? &map : NULL);
}

int rf_session_create(struct rf_session **session, const struct rf_session_setup *setup)
{
    struct rf_session *const s = calloc(1, sizeof *s);
    const struct refocus_image *const photo = setup->photo;
    int status;

    *session = NULL;
    if (!s)
        return REFOCUS_ERR_MEMORY;
    s->setup = *setup;
    s->strokes = setup->strokes;
    s->reduction = 1;
    while ((int64_t)(photo->width / s->reduction) * (photo->height / s->reduction) > PREVIEW_PIXELS)
        s->reduction++;
    s->width = (photo->width + s->reduction - 1) / s->reduction;
    s->height = (photo->height + s->reduction - 1) / s->reduction;
    s->ready = -1;
    s->back = 1;
    s->small_stale = s->full_stale = true;
    pthread_mutex_init(&s->lock, NULL);
    pthread_cond_init(&s->wake, NULL);
    status = take_memory(s);
    if (status == REFOCUS_OK && pthread_create(&s->thread, NULL, rf_worker_run, s) != 0)
        status = REFOCUS_ERR_THREAD;
    s->started = status == REFOCUS_OK;
    *session = s;
    if (status != REFOCUS_OK)
        rf_session_destroy(session);
    return status;
}

static bool is_finished(struct rf_session *s)
{
    bool finished;

    pthread_mutex_lock(&s->lock);
    finished = s->finished;
    pthread_mutex_unlock(&s->lock);
    return finished;
}

void rf_session_destroy(struct rf_session **session)
{
    const struct timespec pause = {0, 2000000};
    struct rf_session *const s = *session;

    if (!s)
        return;
    if (s->started) {
        pthread_mutex_lock(&s->lock);
        s->quit = true;
        pthread_cond_signal(&s->wake);
        pthread_mutex_unlock(&s->lock);
        /* A cancel that comes before its render begins has no effect: again. */
        while (!is_finished(s)) {
            rf_session_tick(s);
            nanosleep(&pause, NULL);
        }
        pthread_join(s->thread, NULL);
    }
    refocus_renderer_destroy(&s->small);
    refocus_renderer_destroy(&s->full);
    if (!s->setup.strokes)
        refocus_strokes_destroy(&s->strokes);
    for (int i = 0; i < 3; i++)
        free(s->frames[i].pixels);
    free(s->orders);
    free(s->small_photo);
    free(s->small_out);
    free(s->full_out);
    free(s->selection);
    free(s->small_disparity);
    free(s->scratch);
    pthread_mutex_destroy(&s->lock);
    pthread_cond_destroy(&s->wake);
    free(s);
    *session = NULL;
}

/* Called with the lock held: there is something new to do. */
static uint64_t renew(struct rf_session *s)
{
    const uint64_t request = ++s->request;

    pthread_cond_signal(&s->wake);
    if (s->rendering)
        refocus_cancel(s->full);
    return request;
}

uint64_t rf_session_show(struct rf_session *s, const struct rf_view_state *state)
{
    uint64_t request;

    pthread_mutex_lock(&s->lock);
    s->state = *state;
    s->shown = true;
    request = renew(s);
    pthread_mutex_unlock(&s->lock);
    return request;
}

static uint64_t order(struct rf_session *s, const struct order *one)
{
    uint64_t request = 0;

    pthread_mutex_lock(&s->lock);
    if (s->order_count == s->order_room) {
        const int room = s->order_room > 0 ? 2 * s->order_room : 16;
        struct order *const more = realloc(s->orders, (size_t)room * sizeof *more);

        if (more) {
            s->orders = more;
            s->order_room = room;
        }
    }
    if (s->order_count < s->order_room) {
        s->orders[s->order_count++] = *one;
        request = renew(s);
    } else if (s->status == REFOCUS_OK) {
        s->status = REFOCUS_ERR_MEMORY;
    }
    pthread_mutex_unlock(&s->lock);
    return request;
}

uint64_t rf_session_begin(struct rf_session *s, const struct refocus_stroke *stroke,
                          bool end_from_depth)
{
    const struct order one = {
        .kind = ORDER_BEGIN, .stroke = *stroke, .end_from_depth = end_from_depth};

    return order(s, &one);
}

uint64_t rf_session_extend(struct rf_session *s, float x, float y)
{
    const struct order one = {.kind = ORDER_POINT, .x = x, .y = y};

    return order(s, &one);
}

uint64_t rf_session_undo(struct rf_session *s)
{
    const struct order one = {.kind = ORDER_UNDO};

    return order(s, &one);
}

uint64_t rf_session_save(struct rf_session *s, uint32_t what)
{
    uint64_t request;

    pthread_mutex_lock(&s->lock);
    s->save |= what;
    request = s->request;
    pthread_cond_signal(&s->wake);
    pthread_mutex_unlock(&s->lock);
    return request;
}

void rf_session_tick(struct rf_session *s)
{
    pthread_mutex_lock(&s->lock);
    if (s->rendering && (s->quit || s->rendered != s->request))
        refocus_cancel(s->full);
    pthread_mutex_unlock(&s->lock);
}

bool rf_session_frame(struct rf_session *s, const struct rf_view_frame **frame)
{
    bool fresh;

    pthread_mutex_lock(&s->lock);
    fresh = s->ready >= 0;
    if (fresh) {
        s->front = s->ready;
        s->ready = -1;
        *frame = &s->frames[s->front];
    }
    pthread_mutex_unlock(&s->lock);
    return fresh;
}

int rf_session_status(struct rf_session *s)
{
    int status;

    pthread_mutex_lock(&s->lock);
    status = s->status;
    pthread_mutex_unlock(&s->lock);
    return status;
}

int rf_session_reduction(const struct rf_session *s)
{
    return s->reduction;
}
