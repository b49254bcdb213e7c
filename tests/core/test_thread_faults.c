/* test_thread_faults.c: threads, locks and conditions fail at each of the calls that make them:
 * REFOCUS_ERR_THREAD, and nothing stays behind: no thread, lock, condition or memory. */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "unit_test.h"
#include <errno.h>
#include <pthread.h>

#include <refocus/refocus.h>

#include "failing.h"

static int calls, fail_at; /* the call that fails, from 1 on */
static int live;           /* threads, locks and conditions */

static int fails(void)
{
    return ++calls == fail_at;
}

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*run)(void *),
                          void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*run)(void *),
                          void *argument);
int __real_pthread_join(pthread_t thread, void **result);
int __wrap_pthread_join(pthread_t thread, void **result);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*run)(void *),
                          void *argument)
{
    if (fails())
        return EAGAIN;
    live++;
    return __real_pthread_create(thread, attr, run, argument);
}

int __wrap_pthread_join(pthread_t thread, void **result)
{
    live--;
    return __real_pthread_join(thread, result);
}

/* Locks and conditions: made, counted, ended. */
#define WRAP(object, attributes)                                                                   \
    int __real_##object##_init(object##_t *made, const attributes *with);                          \
    int __wrap_##object##_init(object##_t *made, const attributes *with);                          \
    int __real_##object##_destroy(object##_t *made);                                               \
    int __wrap_##object##_destroy(object##_t *made);                                               \
    int __wrap_##object##_init(object##_t *made, const attributes *with)                           \
    {                                                                                              \
        if (fails())                                                                               \
            return ENOMEM;                                                                         \
        live++;                                                                                    \
        return __real_##object##_init(made, with);                                                 \
    }                                                                                              \
    int __wrap_##object##_destroy(object##_t *made)                                                \
    {                                                                                              \
        live--;                                                                                    \
        return __real_##object##_destroy(made);                                                    \
    }
WRAP(pthread_mutex, pthread_mutexattr_t)
WRAP(pthread_cond, pthread_condattr_t)

enum { SIDE = 24, THREADS = 4 };
static uint8_t pixels[3 * SIDE * SIDE];
static uint16_t samples[SIDE * SIDE], small[4], out[SIDE * SIDE];

static int create(void)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(SIDE, SIDE, 4);
    struct refocus_renderer *renderer = (struct refocus_renderer *)&params;
    int status;

    params.threads = THREADS;
    status = refocus_renderer_create(&renderer, &params);
    assert_true(!renderer == (status != REFOCUS_OK));
    refocus_renderer_destroy(&renderer);
    return status;
}

static int upsample(void)
{
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, SIDE, SIDE, 3 * SIDE);
    const struct refocus_disparity map = refocus_disparity16(small, 2, 2, 4);
    struct refocus_upsample_params params = refocus_upsample_params_default();

    params.threads = THREADS;
    return refocus_upsample(&photo, &map, &params, out, 2 * SIDE);
}

static int place_edges(void)
{
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, SIDE, SIDE, 3 * SIDE);
    const struct refocus_disparity map = refocus_disparity16(samples, SIDE, SIDE, 2 * SIDE);
    struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();

    params.threads = THREADS;
    return refocus_depth_edges(&photo, &map, &params, out, 2 * SIDE, &report);
}

/* A focus stack of two frames whose last one or whose end meets the fault: it is as it was. */
static int make_stack(bool finish)
{
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, SIDE, SIDE, 3 * SIDE);
    struct refocus_stack_params params = refocus_stack_params_default(SIDE, SIDE, 2);
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_stack *stack = NULL;
    const int fault = fail_at;
    int status;

    params.threads = THREADS;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    fail_at = 0;
    assert_int_equal(refocus_stack_add(stack, &photo, 0), REFOCUS_OK);
    if (finish)
        assert_int_equal(refocus_stack_add(stack, &photo, 1), REFOCUS_OK);
    fail_at = fault;
    calls = 0;
    status = finish ? refocus_stack_finish(stack, &result) : refocus_stack_add(stack, &photo, 1);
    if (status != REFOCUS_OK) {
        fail_at = 0;
        if (!finish)
            assert_int_equal(refocus_stack_add(stack, &photo, 1), REFOCUS_OK);
        assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
        fail_at = fault;
        calls = fault;
    }
    refocus_stack_destroy(&stack);
    return status;
}

static int add_to_stack(void)
{
    return make_stack(false);
}

static int finish_stack(void)
{
    return make_stack(true);
}

TEST(each_call)
{
    int (*const acts[])(void) = {create, upsample, place_edges, add_to_stack, finish_stack};

    for (size_t i = 0; i < sizeof acts / sizeof *acts; i++) {
        const long blocks = failing.live;
        int made;

        calls = fail_at = 0;
        assert_int_equal(acts[i](), REFOCUS_OK);
        made = calls;
        assert_int_equal(made, 3 + THREADS - 1); /* a lock, two conditions, threads */
        for (int at = 1; at <= made; at++) {
            calls = 0;
            fail_at = at;
            assert_int_equal(acts[i](), REFOCUS_ERR_THREAD);
            assert_int_equal(calls, at);
            assert_int_equal(live, 0);
            assert_int_equal(failing.live, blocks);
        }
        fail_at = 0;
        assert_int_equal(acts[i](), REFOCUS_OK);
        assert_int_equal(live, 0);
        assert_int_equal(failing.live, blocks);
    }
}
