/* clock.c: the monotonic clock, and the moments at which frames of files are due. */
#include "clock.h"
#include <time.h>

int64_t rf_now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

void rf_pace_start(struct rf_pace *pace, double fps, bool fast)
{
    pace->start_ns = fast ? 0 : rf_now_ns(); /* fast: the times of the stream itself */
    pace->period_ns = (int64_t)(1e9 / fps + 0.5);
    pace->fast = fast;
}

int64_t rf_pace_due(const struct rf_pace *pace, int64_t frame)
{
    return pace->start_ns + frame * pace->period_ns;
}
