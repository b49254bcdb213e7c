/* dynamic_write.h: depth as Dynamic Depth has it. */
#ifndef RF_FILE_DYNAMIC_WRITE_H
#define RF_FILE_DYNAMIC_WRITE_H

#include "behind.h"

/* Add depth and confidence to what lies behind a picture: JPEGs of 8 bits, of the meaning
 * RangeInverse and of 255 for sure. */
int rf_dynamic_add(struct rf_behind *behind, const struct refocus_depth_write *depth,
                   struct refocus_reason *reason);
/* The rdf:Description that says so; nothing when there is no depth. */
void rf_dynamic_put(struct rf_text *text, const struct rf_behind *behind,
                    const struct refocus_depth_write *depth);

#endif
