/* input.h: events of the mouse, fingers and keys. */
#ifndef RF_VIEW_INPUT_H
#define RF_VIEW_INPUT_H

#include "window_state.h"

void rf_window_event(struct rf_window *w, const SDL_Event *event);

/* Keys and gestures, and what they do, two of each line; NULL ends them. */
const char *rf_window_help(int index, const char **what);

#endif
