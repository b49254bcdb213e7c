/* editable.h: a picture that is written holds the all-in-focus original and the depth. */
#ifndef RF_FILE_EDITABLE_H
#define RF_FILE_EDITABLE_H

#include "reading.h"
#include "text.h"

/* Parts of the XMP that makes a file editable; rf_editable_free() ends it. */
struct rf_editable {
    unsigned cut; /* RF_XMP_CUT_... of what is there already and goes */
    struct rf_text standard, extended;
};

/* Make them of options->keep and options->editable, for a JPEG or for one packet that holds both.
 */
int rf_editable_make(struct rf_editable *editable, const struct refocus_write_options *options,
                     bool one_packet, struct refocus_reason *reason);
void rf_editable_free(struct rf_editable *editable);

#endif
