/* live_estimate.h: depth that a network makes of the pictures, in a thread of its own. */
#ifndef RF_CLI_LIVE_ESTIMATE_H
#define RF_CLI_LIVE_ESTIMATE_H

#include "live/live_state.h"

/* These return exit codes and print why. */
bool live_estimate_is_meant(const char *depth);
int live_estimate_parse(struct live_estimate_settings *settings, const char *depth);
int live_estimate_open(struct live *live);
void live_estimate_close(struct live *live);
/* Number the picture, and when it is its turn give the network a copy of the frame. */
int live_estimate_offer(struct live *live, struct live_picture *picture,
                        const struct refocus_frame *frame, struct refocus_converter *converter,
                        struct refocus_reason *reason);
void *live_estimate_thread(void *live);

#endif
