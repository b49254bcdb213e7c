/* test_memory.c: every allocation of the session fails once: a status, and nothing is kept. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "failing.h"
#include "session.h"

static void nothing(void *user)
{
    (void)user;
}

static void nothing_saved(void *user, const struct rf_view_result *result)
{
    (void)user;
    (void)result;
}

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

static void test_every_allocation(void **unused)
{
    enum { W = 64, H = 48 };
    static uint8_t pixels[3 * W * H];
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
    struct rf_session_setup setup;
    struct refocus_stroke stroke = refocus_stroke_default(REFOCUS_STROKE_OBJECT, 5);
    int status = REFOCUS_ERR_MEMORY;

    (void)unused;
    stroke.fill.kind = REFOCUS_FILL_SOLID;
    stroke.fill.d0 = 1;
    memset(&setup, 0, sizeof setup);
    setup.photo = &photo;
    setup.params = refocus_settings_default(0, 0);
    setup.threads = 1;
    setup.notify = nothing;
    setup.save = nothing_saved;
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
            rf_session_show(session, &state);
            rf_session_begin(session, &stroke, false);
            rf_session_save(session, RF_SAVE_DEPTH | RF_SAVE_PICTURE);
            status = wait_for(session, rf_session_extend(session, 20, 20));
        } else {
            assert_null(session);
        }
        rf_session_destroy(&session);
        assert_int_equal(failing.live, before);
        assert_true(status == REFOCUS_OK || status == REFOCUS_ERR_MEMORY);
    }
    printf("%ld allocations failed\n", failing.fail_at - 2);
    assert_true(failing.fail_at > 25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_allocation)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
