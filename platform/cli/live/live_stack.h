/* live_stack.h: depth of a still scene from a focus stack that the camera takes itself. */
#ifndef RF_CLI_LIVE_STACK_H
#define RF_CLI_LIVE_STACK_H

#include "live/live_lane.h"

/* "--depth stack:", with parts behind it. */
bool live_stack_is_meant(const char *depth);

/* These return exit codes and print why. */

/* Read the parts into the settings, whose camera is known. */
int live_stack_parse(struct live_settings *settings);
/* Plan the positions of the lens; the camera is open. */
int live_stack_open(struct live *live);
/* Take a stack where one is wanted, which is at the beginning and when somebody has asked. Only the
 * first one that fails is an error. */
int live_stack_take(struct live_lane *lane);

/* Ask for a new one; false with a reason where depth is not of a stack. */
bool live_stack_ask(struct live *live, char *why, size_t size);
void live_stack_close(struct live *live);

#endif
