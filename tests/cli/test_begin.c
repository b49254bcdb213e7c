/* test_begin.c: each call that makes a lock, a condition, a semaphore or an event of `refocus live`
 * fails once: one line, an exit code, and nothing is kept. */
#include <errno.h>
#include <stdint.h>
#include "unit_test.h"
#include <stdio.h>
#include <string.h>
#include "live/live_sources.h"
#include "wrapped.h"

static int lines; /* lines that were printed */

/* In place of the command's. */
int report_failure(int code, const char *what, const char *format, ...)
{
    lines++;
    assert_string_equal(what, "live");
    assert_null(strchr(format, '%'));
    return code;
}

WRAP(pthread_mutex_init, (pthread_mutex_t * lock, const pthread_mutexattr_t *with), (lock, with),
     EAGAIN, pthread_mutex_destroy, (pthread_mutex_t * lock), (lock))
WRAP(pthread_cond_init, (pthread_cond_t * condition, const pthread_condattr_t *with),
     (condition, with), ENOMEM, pthread_cond_destroy, (pthread_cond_t * condition), (condition))
WRAP(pthread_condattr_init, (pthread_condattr_t * with), (with), ENOMEM, pthread_condattr_destroy,
     (pthread_condattr_t * with), (with))
WRAP(sem_init, (sem_t * semaphore, int shared, unsigned value), (semaphore, shared, value), -1,
     sem_destroy, (sem_t * semaphore), (semaphore))
WRAP(eventfd, (unsigned value, int flags), (value, flags), -1, close, (int fd), (fd))

static int begin(int fail)
{
    struct live_settings settings;
    struct live live;
    int status;

    memset(&settings, 0, sizeof settings);
    memset(&live, 0, sizeof live);
    calls = kept = lines = 0;
    fail_at = fail;
    status = live_begin(&live, &settings, NULL);
    fail_at = 0;
    if (status == EXIT_DONE)
        live_clear(&live);
    return status;
}

TEST(each_fails)
{
    int all;

    assert_int_equal(begin(0), EXIT_DONE);
    assert_int_equal(kept, 0);
    assert_int_equal(lines, 0);
    all = calls;
    assert_int_equal(all, 1 + 1 + 1 + 4 * 3 + 1); /* four with a condition and its attributes */
    for (int i = 1; i <= all; i++) {
        assert_int_equal(begin(i), EXIT_FAILED);
        assert_int_equal(kept, 0);
        assert_int_equal(lines, 1);
    }
}
