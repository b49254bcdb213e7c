/* openexr.hpp: the two halves of the module of OpenEXR. */
#ifndef RF_OPENEXR_HPP
#define RF_OPENEXR_HPP

extern "C" {
#include "codec.h"
#include "reason.h"
}

int rf_openexr_read(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras);
int rf_openexr_write(struct refocus_blob *file, const struct rf_rows *rows,
                     const struct rf_extras *extras, struct refocus_reason *reason);

#endif
