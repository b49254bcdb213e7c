/* select.h: the object that strokes are painted over is found. */
#ifndef RF_STROKES_SELECT_H
#define RF_STROKES_SELECT_H

#include "pyramid.h"
#include "selector.h"
#include "spans.h"
#include "stroke.h"

/* The object that strokes 0 to count - 1 (object, more, less) are painted over. */
int rf_select(struct rf_selector *selector, const struct rf_pyramid *pyramid,
              const struct rf_stroke *strokes, int count, struct rf_spans *spans);

/* Work of such a selection, as in work.h. */
int64_t rf_select_work(const struct rf_pyramid *pyramid, const struct rf_stroke *strokes,
                       int count);

#endif
