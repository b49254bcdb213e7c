/* spans.h: the pixels that a layer covers, as spans of each row. */
#ifndef RF_STROKES_SPANS_H
#define RF_STROKES_SPANS_H

#include <stdbool.h>
#include <stdint.h>
#include "stroke.h"

/* x[2 i] is the first column inside, x[2 i + 1] the first outside again. */
struct rf_spans {
    int32_t y, rows;
    int64_t *first; /* row i has the numbers first[i] to first[i + 1] of x */
    int32_t *x;
};
int rf_spans_of_mask(struct rf_spans *spans, const uint8_t *mask, struct rf_area area);
int rf_spans_of_all(struct rf_spans *spans, int32_t width, int32_t height);
int rf_spans_copy(struct rf_spans *to, const struct rf_spans *from);
void rf_spans_free(struct rf_spans *spans);
/* Spans of picture row y: how many numbers, and where. */
int64_t rf_spans_row(const struct rf_spans *spans, int32_t y, const int32_t **x);
/* The columns of row y in which two differ; false when none. */
bool rf_spans_differ(const struct rf_spans *a, const struct rf_spans *b, int32_t y, int32_t *from,
                     int32_t *to);

#endif
