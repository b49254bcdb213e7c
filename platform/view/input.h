/* input.h: events of the mouse, fingers and keys, and the buttons along the lower border. */
#ifndef RF_VIEW_INPUT_H
#define RF_VIEW_INPUT_H

#include "window_state.h"

void rf_window_event(struct rf_window *w, const SDL_Event *event);
int rf_window_buttons(const struct rf_window *w);
SDL_Rect rf_window_button(const struct rf_window *w, int index, const char **label, bool *on);

#endif
