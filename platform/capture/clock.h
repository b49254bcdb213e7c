/* clock.h: the clock of sources and sinks, and the pace of files and scripts. */
#ifndef RF_CAPTURE_CLOCK_H
#define RF_CAPTURE_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

int64_t rf_now_ns(void);

/* Frame n of a file or script is due at a moment. */
struct rf_pace {
    int64_t start_ns, period_ns;
    bool fast;
};
void rf_pace_start(struct rf_pace *pace, double fps, bool fast);
int64_t rf_pace_due(const struct rf_pace *pace, int64_t frame);

#ifdef __cplusplus
}
#endif

#endif
