/* icc.c: an ICC profile is taken over when it is one for RGB. */
#include "icc.h"

#include <stdlib.h>
#include <string.h>

#include "reason.h"

int rf_icc_take(struct rf_read *read, struct refocus_blob *profile)
{
    /* ICC.1, 7.2: a header of 128 bytes, the colour space at 16, "acsp" at 36 */
    if (profile->size >= 128 && memcmp(profile->data + 16, "RGB ", 4) == 0 &&
        memcmp(profile->data + 36, "acsp", 4) == 0) {
        read->icc = *profile;
    } else {
        if (profile->data)
            rf_note(read->info, "ICC profile: not for RGB or damaged, passed over");
        free(profile->data);
    }
    profile->data = NULL;
    profile->size = 0;
    return REFOCUS_OK;
}
