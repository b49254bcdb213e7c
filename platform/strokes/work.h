/* work.h: how much painting a layer will take, known before it is painted. */
#ifndef RF_STROKES_WORK_H
#define RF_STROKES_WORK_H

#include "pyramid.h"
#include "stroke.h"

/* Work is counted in pixels that a selection looks at, some 10 ns each. */
int64_t rf_layer_work(const struct rf_pyramid *pyramid, const struct rf_stroke *strokes, int count);

#endif
