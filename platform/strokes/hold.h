/* hold.h: strokes are added or taken back many at a time. */
#ifndef RF_STROKES_HOLD_H
#define RF_STROKES_HOLD_H

#include "spans.h"

/* Between hold and release strokes are only listed, so that each layer is selected and painted
 * once. Instead of release, return goes back to the first count strokes and needs no memory for it,
 * as the area of the last of their layers is kept. Strokes that would take too long are not
 * released: REFOCUS_ERR_SIZE. */
int rf_strokes_hold(struct refocus_strokes *strokes, struct rf_spans *kept);
int rf_strokes_release(struct refocus_strokes *strokes);
void rf_strokes_return(struct refocus_strokes *strokes, int count, struct rf_spans *kept);
void rf_strokes_size(const struct refocus_strokes *strokes, int32_t *width, int32_t *height);

#endif
