/* work.c: the life of a process of `refocus serve`: it answers requests one after the other, and a
 * thread of its own waits for word that the picture under way is out of date. */
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>
#include "serve/serving.h"

/* A full renderer is kept for so long after the last request. */
enum { KEEP_MS = 15000 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct refocus_renderer *watched; /* these three under the lock */
static uint32_t running, replaced;       /* number of the request at work; of one to end early */

void serve_watch(struct refocus_renderer *renderer)
{
    pthread_mutex_lock(&lock);
    watched = renderer;
    pthread_mutex_unlock(&lock);
}

bool serve_is_replaced(void)
{
    bool result;

    pthread_mutex_lock(&lock);
    result = running != 0 && replaced == running;
    pthread_mutex_unlock(&lock);
    return result;
}

static void set_running(uint32_t number)
{
    pthread_mutex_lock(&lock);
    running = number;
    pthread_mutex_unlock(&lock);
}

static bool receive_all(int socket, void *bytes, size_t size)
{
    char *at = bytes;

    while (size > 0) {
        const ssize_t got = recv(socket, at, size, 0);

        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        at += got;
        size -= (size_t)got;
    }
    return true;
}

/* A cancel that comes before its render begins has no effect: again, until the request is done.
 * Where the server has gone there is nobody to work for. */
static void *wait_for_word(void *of)
{
    const struct timespec pause = {0, 2000000};
    const struct rf_web_work *const work = of;
    uint32_t number;

    while (receive_all(work->control, &number, sizeof number)) {
        bool busy;

        pthread_mutex_lock(&lock);
        replaced = number;
        pthread_mutex_unlock(&lock);
        do {
            pthread_mutex_lock(&lock);
            busy = running == number;
            if (busy && watched)
                refocus_cancel(watched);
            pthread_mutex_unlock(&lock);
            nanosleep(&pause, NULL);
        } while (busy);
    }
    _exit(EXIT_FAILED);
}

/* A frame of a camera is gone with the next one: nothing can be worked out or painted over many
 * requests. */
static bool is_for_photos(uint32_t what)
{
    return what != RF_WEB_OPEN && what != RF_WEB_FOCUS && what != RF_WEB_SAVE &&
           what != RF_WEB_FRAME;
}

static void answer(struct serving *s, const struct rf_web_ask *ask, const char *body)
{
    if (s->feed && is_for_photos(ask->what)) {
        report_failure(EXIT_WRONG, s->work->name, "capture a photo first, and open that");
        answer_failure(s, ANSWER_WRONG);
        return;
    }
    switch ((enum rf_web_what)ask->what) {
    case RF_WEB_OPEN:
        serve_answer_session(s);
        break;
    case RF_WEB_THUMBNAIL:
        serve_answer_thumbnail(s);
        break;
    case RF_WEB_FOCUS:
        serve_answer_focus(s, body, ask->bytes);
        break;
    case RF_WEB_PICTURE:
        serve_answer_picture(s, ask, body);
        break;
    case RF_WEB_OVERLAY:
        serve_answer_overlay(s, ask, body);
        break;
    case RF_WEB_DRAFT:
        serve_answer_draft(s, body, ask->bytes);
        break;
    case RF_WEB_STROKE:
        serve_answer_stroke(s, body, ask->bytes);
        break;
    case RF_WEB_UNDO:
    case RF_WEB_REDO:
        serve_answer_undo(s, ask->what == RF_WEB_REDO);
        break;
    case RF_WEB_STROKES:
        serve_answer_strokes(s);
        break;
    case RF_WEB_SAVE:
        serve_answer_save(s, ask, body);
        break;
    case RF_WEB_PULL:
        serve_answer_pull(s, ask, body);
        break;
    case RF_WEB_FRAME:
        serve_answer_live_frame(s, ask, body);
        break;
    case RF_WEB_NOTHING:
        _exit(EXIT_FAILED);
    }
}

/* Wait for the next request. A session that somebody only looks at gives back the memory of its
 * full renderer, which is most of what it holds; quick pictures stay as quick as they are. */
static bool receive_request(struct serving *s, struct rf_web_ask *ask)
{
    struct pollfd line = {.fd = s->work->socket, .events = POLLIN};

    if (s->full && poll(&line, 1, KEEP_MS) == 0)
        serve_release_full(s);
    return receive_all(s->work->socket, ask, sizeof *ask);
}

void serve_work(void *of, const struct rf_web_work *work)
{
    const struct serve_base *const base = of;
    struct serving serving = {.work = work, .base = base->shot, .live = &base->live};
    struct rf_web_ask ask;
    pthread_t thread;

    report_keep(serving.why, sizeof serving.why);
    if (pthread_create(&thread, NULL, wait_for_word, (void *)work) != 0)
        return;
    while (receive_request(&serving, &ask)) {
        char *body;

        if (ask.bytes > RF_WEB_MOST_BODY)
            return;
        body = malloc((size_t)ask.bytes + 1);
        if (!body || !receive_all(work->socket, body, ask.bytes))
            return;
        body[ask.bytes] = '\0';
        ask.word[sizeof ask.word - 1] = '\0';
        serving.why[0] = '\0';
        set_running(ask.number);
        answer(&serving, &ask, body);
        set_running(0);
        free(body);
    }
}
