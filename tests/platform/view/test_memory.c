/* test_memory.c: every allocation of the session fails once, and each call that makes its lock, its
 * condition and its thread: a status, and nothing is kept. */
#define _POSIX_C_SOURCE 200809L
#include "unit_test.h"
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "failing.h"
#include "session.h"
#include "wrapped.h"

static void nothing(void *user)
{
    (void)user;
}

static void nothing_saved(void *user, const struct rf_view_result *result,
                          char words[RF_VIEW_WORDS])
{
    (void)user;
    (void)result;
    (void)words;
}

/* Locks, conditions and threads: made, counted, ended. */
WRAP(pthread_mutex_init, (pthread_mutex_t * lock, const pthread_mutexattr_t *with), (lock, with),
     EAGAIN, pthread_mutex_destroy, (pthread_mutex_t * lock), (lock))
WRAP(pthread_cond_init, (pthread_cond_t * condition, const pthread_condattr_t *with),
     (condition, with), EAGAIN, pthread_cond_destroy, (pthread_cond_t * condition), (condition))
WRAP(pthread_create,
     (pthread_t * thread, const pthread_attr_t *with, void *(*run)(void *), void *user),
     (thread, with, run, user), EAGAIN, pthread_join, (pthread_t thread, void **result),
     (thread, result))

/* Until it is answered wholly or has failed. */
static int wait_for(struct rf_session *session, uint64_t request)
{
    const struct timespec pause = {0, 1000000};

    for (;;) {
        const struct rf_view_frame *frame;

        if (rf_session_status(session) != REFOCUS_OK)
            return rf_session_status(session);
        if (rf_session_frame(session, &frame) && frame->full && frame->request >= request)
            return REFOCUS_OK;
        rf_session_tick(session);
        nanosleep(&pause, NULL);
    }
}

enum { W = 64, H = 48 };

static struct rf_session_setup small_setup(void)
{
    static uint8_t pixels[3 * W * H];
    static uint16_t depth[W * H];
    static struct refocus_image photo;
    struct rf_session_setup setup;

    photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
    memset(&setup, 0, sizeof setup);
    setup.photo = &photo;
    setup.disparity = depth;
    setup.params = refocus_settings_default(0, 0);
    setup.threads = 1;
    setup.notify = nothing;
    setup.save = nothing_saved;
    return setup;
}

TEST(test_every_allocation)
{
    const struct rf_session_setup setup = small_setup();
    int status = REFOCUS_ERR_MEMORY;

    for (failing.fail_at = 1; status != REFOCUS_OK; failing.fail_at++) {
        const long before = failing.live;
        struct rf_session *session;

        failing.calls = 0;
        status = rf_session_create(&session, &setup);
        if (status == REFOCUS_OK) {
            struct rf_view_state state;

            memset(&state, 0, sizeof state);
            state.scale = 1;
            state.width = W;
            state.height = H;
            state.blur = 3;
            rf_session_save(session, RF_SAVE_DEPTH | RF_SAVE_PICTURE);
            status = wait_for(session, rf_session_show(session, &state));
        } else {
            assert_null(session);
        }
        rf_session_destroy(&session);
        assert_int_equal(failing.live, before);
        assert_true(status == REFOCUS_OK || status == REFOCUS_ERR_MEMORY);
    }
    printf("%ld allocations failed\n", failing.fail_at - 2);
    assert_true(failing.fail_at > 9);
}

TEST(test_every_lock)
{
    const struct rf_session_setup setup = small_setup();
    const long before = failing.live;
    struct rf_session *session;
    int made;

    failing.fail_at = 0;
    for (fail_at = calls = 0, made = 1; fail_at <= made; fail_at++, calls = 0) {
        const int status = rf_session_create(&session, &setup);

        if (fail_at == 0) {
            assert_int_equal(status, REFOCUS_OK);
            made = calls;
            assert_true(made >= 3);
        } else {
            assert_int_equal(status, REFOCUS_ERR_THREAD);
            assert_null(session);
        }
        rf_session_destroy(&session);
        assert_int_equal(kept, 0);
        assert_int_equal(failing.live, before);
    }
}
