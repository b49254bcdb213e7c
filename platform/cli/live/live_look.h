/* live_look.h: the look of live pictures beside focus and blur, by the options that render has. */
#ifndef RF_CLI_LIVE_LOOK_H
#define RF_CLI_LIVE_LOOK_H

#include "live/live_state.h"

/* These return exit codes, and print why it is not EXIT_DONE. */

/* Refuse options that do not go together, and those that live does not take; once, before the
 * engine begins. */
int live_look_check(struct live_settings *settings);
/* Refuse looks that the method does not have; once, behind engine_begin(). */
int live_look_check_method(const struct live *live);
/* The pixels that options name in pictures of this size, and the blur of the lens. */
int live_look_place(struct live *live, int width, int height);
/* The settings of one frame, whose focus and blur are in them. */
int live_look_aim(struct live *live, const struct refocus_image *photo,
                  struct refocus_settings *params);

/* Whether focus or blur need a depth in metres, and what to say where it is in none. */
bool live_look_needs_metres(const struct live_settings *settings);
extern const char live_look_no_metres[];

/* Whether pictures of Y, U and V can be rendered so as they are. */
bool live_look_takes_yuv(const struct engine *engine);

#endif
