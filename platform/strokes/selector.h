/* selector.h: the memory of a selection, which is kept for the next one. */
#ifndef RF_STROKES_SELECTOR_H
#define RF_STROKES_SELECTOR_H

#include <stddef.h>
#include <stdint.h>
#include "colour.h"
#include "cut.h"

struct rf_selector {
    struct rf_cut cut;
    struct rf_likeness likeness;
    struct {
        void *memory;
        size_t size;
    } scratch[8];
};
void rf_selector_free(struct rf_selector *selector);
/* Memory that is kept for the next time; its content is lost. NULL: there is none. */
void *rf_selector_scratch(struct rf_selector *selector, int which, int64_t count, size_t size);

#endif
