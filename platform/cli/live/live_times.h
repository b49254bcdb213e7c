/* live_times.h: the clock of refocus live, and times without end in constant memory. */
#ifndef RF_CLI_LIVE_TIMES_H
#define RF_CLI_LIVE_TIMES_H

#include <stdint.h>
#include <jansson.h>

int64_t live_now_ns(void);

enum { LIVE_BINS = 1200 };

/* Bins are 2 % wide, from 1 microsecond on. */
struct live_times {
    uint64_t bin[LIVE_BINS], count;
    double sum_ms, min_ms, max_ms;
};
void live_times_add(struct live_times *times, double ms);
double live_times_quantile(const struct live_times *times, double share);
json_t *live_times_json(const struct live_times *times);

#endif
