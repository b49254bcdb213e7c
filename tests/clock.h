/* clock.h: clocks and pauses of tests and measurements. */
#ifndef TESTS_CLOCK_H
#define TESTS_CLOCK_H

#include <time.h>

static inline double clock_ms(clockid_t clock)
{
    struct timespec t;

    clock_gettime(clock, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static inline double now_ms(void)
{
    return clock_ms(CLOCK_MONOTONIC);
}

static inline void sleep_ms(double ms)
{
    const time_t seconds = (time_t)(ms / 1e3);
    const struct timespec pause = {seconds, (long)((ms - 1e3 * (double)seconds) * 1e6)};

    nanosleep(&pause, NULL);
}

#endif
