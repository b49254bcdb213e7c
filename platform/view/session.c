/* session.c: requests of the viewer are handed to the thread that renders, and frames are taken
 * from it. */
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <refocus/status.h>
#include "session.h"
#include "shared.h"
#include "worker.h"

static int take_memory(struct rf_session *s)
{
    const struct refocus_image *const photo = s->setup.photo;
    const uint64_t pixels = (uint64_t)photo->width * (uint64_t)photo->height;
    const size_t small = (size_t)s->width * (size_t)s->height;

    if (pixels > SIZE_MAX / 4)
        return REFOCUS_ERR_SIZE;
    s->small_photo = malloc(3 * small);
    s->small_out = malloc(3 * small);
    s->small_disparity = malloc(2 * small);
    s->full_out = malloc(3 * (size_t)pixels);
    if (!s->small_photo || !s->small_out || !s->small_disparity || !s->full_out)
        return REFOCUS_ERR_MEMORY;
    return REFOCUS_OK;
}

int rf_session_create(struct rf_session **session, const struct rf_session_setup *setup)
{
    struct rf_session *const s = calloc(1, sizeof *s);
    const struct refocus_image *const photo = setup->photo;
    int status;

    *session = NULL;
    if (!s)
        return REFOCUS_ERR_MEMORY;
    if (pthread_mutex_init(&s->lock, NULL)) {
        free(s);
        return REFOCUS_ERR_THREAD;
    }
    if (pthread_cond_init(&s->wake, NULL)) {
        pthread_mutex_destroy(&s->lock);
        free(s);
        return REFOCUS_ERR_THREAD;
    }
    s->setup = *setup;
    s->reduction = 1;
    while ((int64_t)(photo->width / s->reduction) * (photo->height / s->reduction) > PREVIEW_PIXELS)
        s->reduction++;
    s->width = (photo->width + s->reduction - 1) / s->reduction;
    s->height = (photo->height + s->reduction - 1) / s->reduction;
    s->ready = -1;
    s->back = 1;
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
    for (int i = 0; i < 3; i++)
        free(s->frames[i].pixels);
    free(s->small_photo);
    free(s->small_out);
    free(s->full_out);
    free(s->light.plane[0]);
    free(s->small_disparity);
    free(s->scratch);
    pthread_mutex_destroy(&s->lock);
    pthread_cond_destroy(&s->wake);
    free(s);
    *session = NULL;
}

uint64_t rf_session_show(struct rf_session *s, const struct rf_view_state *state)
{
    uint64_t request;

    pthread_mutex_lock(&s->lock);
    s->state = *state;
    s->shown = true;
    request = ++s->request;
    pthread_cond_signal(&s->wake);
    if (s->rendering)
        refocus_cancel(s->full);
    pthread_mutex_unlock(&s->lock);
    return request;
}

void rf_session_save(struct rf_session *s, uint32_t what)
{
    pthread_mutex_lock(&s->lock);
    s->save |= what;
    pthread_cond_signal(&s->wake);
    pthread_mutex_unlock(&s->lock);
}

bool rf_session_words(struct rf_session *s, char words[RF_VIEW_WORDS])
{
    bool fresh;

    pthread_mutex_lock(&s->lock);
    fresh = s->words[0] != '\0';
    if (fresh)
        memcpy(words, s->words, sizeof s->words);
    s->words[0] = '\0';
    pthread_mutex_unlock(&s->lock);
    return fresh;
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
