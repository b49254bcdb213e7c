/* draw.h: what the window shows. */
#ifndef RF_VIEW_DRAW_H
#define RF_VIEW_DRAW_H

#include "window_state.h"

void rf_window_draw(struct rf_window *w);

#endif
