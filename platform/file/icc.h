/* icc.h: colour profiles of photos. */
#ifndef RF_FILE_ICC_H
#define RF_FILE_ICC_H

#include "reading.h"

/* An ICC profile for RGB is taken over; any other would be wrong for the RGB8 photo and is freed.
 */
int rf_icc_take(struct rf_read *read, struct refocus_blob *profile);

#endif
