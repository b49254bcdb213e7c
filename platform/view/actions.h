/* actions.h: what keys and gestures do. */
#ifndef RF_VIEW_ACTIONS_H
#define RF_VIEW_ACTIONS_H

#include "window_state.h"

void rf_window_act(struct rf_window *w, enum rf_action action);
/* Ask for a picture of the state; cause is a literal. */
void rf_window_show(struct rf_window *w, const char *cause);
void rf_window_tap(struct rf_window *w, double x, double y);
void rf_window_blur(struct rf_window *w, double blur);
void rf_window_zoom(struct rf_window *w, double factor, double x, double y);
void rf_window_pan(struct rf_window *w, double dx, double dy);
void rf_window_fit(struct rf_window *w);
double rf_window_cpu_ms(void);
void rf_window_measure(struct rf_window *w);

#endif
