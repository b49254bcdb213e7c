/* live_times.c: times are counted in bins, so that any number of them fits. */
#include <math.h>
#include <time.h>
#include "live/live_times.h"

static const double first_ms = 0.001, width = 1.02;

int64_t live_now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

void live_times_add(struct live_times *times, double ms)
{
    int bin = ms > first_ms ? (int)(log(ms / first_ms) / log(width)) : 0;

    bin = bin < LIVE_BINS ? bin : LIVE_BINS - 1;
    times->bin[bin]++;
    times->min_ms = times->count == 0 || ms < times->min_ms ? ms : times->min_ms;
    times->max_ms = times->count == 0 || ms > times->max_ms ? ms : times->max_ms;
    times->sum_ms += ms;
    times->count++;
}

double live_times_quantile(const struct live_times *times, double share)
{
    const double rank = share * (double)times->count;
    uint64_t passed = 0;

    for (int i = 0; i < LIVE_BINS; i++) {
        passed += times->bin[i];
        if (passed > 0 && (double)passed >= rank)
            return fmin(fmax(first_ms * pow(width, i + 0.5), times->min_ms), times->max_ms);
    }
    return times->max_ms;
}

json_t *live_times_json(const struct live_times *times)
{
    if (times->count == 0)
        return json_null();
    return json_pack("{s:f, s:f, s:f, s:f, s:f}", "min", times->min_ms, "median",
                     live_times_quantile(times, 0.5), "p99", live_times_quantile(times, 0.99),
                     "max", times->max_ms, "mean", times->sum_ms / (double)times->count);
}
