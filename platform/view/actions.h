/* actions.h: what keys, buttons and gestures do. */
#ifndef RF_VIEW_ACTIONS_H
#define RF_VIEW_ACTIONS_H

#include "window_state.h"

void rf_window_act(struct rf_window *w, enum rf_action action);
void rf_window_show(struct rf_window *w, const char *cause);
void rf_window_tap(struct rf_window *w, double x, double y);
void rf_window_blur(struct rf_window *w, double blur);
void rf_window_zoom(struct rf_window *w, double factor, double x, double y);
void rf_window_pan(struct rf_window *w, double dx, double dy);
void rf_window_fit(struct rf_window *w);
void rf_window_stroke(struct rf_window *w, double x, double y, uint32_t kind);
void rf_window_stroke_to(struct rf_window *w, double x, double y);
void rf_window_gradient(struct rf_window *w, double x, double y);
double rf_window_cpu_ms(void);
/* A request was made now; cause is a literal. */
void rf_window_asked(struct rf_window *w, uint64_t request, const char *cause);

#endif
