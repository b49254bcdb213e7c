/* gdepth_write.h: depth as GDepth has it. */
#ifndef RF_FILE_GDEPTH_WRITE_H
#define RF_FILE_GDEPTH_WRITE_H

#include "reading.h"
#include "text.h"

/* Whether all fields are within their ranges. */
bool rf_gdepth_is_good(const struct refocus_depth_write *depth);
/* Write the attributes GDepth:Data and, where it is given, GDepth:Confidence: PNGs of 16 bits, of
 * the meaning RangeInverse and of 65535 for sure, turned as pixels lie that this orientation makes
 * upright. */
int rf_gdepth_put_data(struct rf_text *text, const struct refocus_depth_write *depth,
                       int orientation, struct refocus_reason *reason);
/* Write an attribute that begins so: a PNG of 16 bits of samples with this size and stride. */
int rf_gdepth_put_samples(struct rf_text *text, const char *begin,
                          const struct refocus_depth_write *samples, struct refocus_reason *reason);
/* The attributes of GDepth and GFocus beside it, with their namespaces. */
void rf_gdepth_put(struct rf_text *text, const struct refocus_depth_write *depth, int orientation);

#endif
