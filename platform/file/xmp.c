/* xmp.c: XMP properties as numbers. */
#include "xmp.h"

#include <stdlib.h>

#include "number.h"
#include "reason.h"

void rf_xmp_free(struct rf_xmp *xmp)
{
    for (int key = 0; key < RF_XMP_KEYS; key++) {
        free(xmp->value[key]);
        xmp->value[key] = NULL;
    }
}

int rf_xmp_number(const struct rf_read *read, const struct rf_xmp *xmp, enum rf_xmp_key key,
                  const char *name, bool *found, double *value)
{
    *found = false;
    *value = 0.0;
    if (!xmp->value[key])
        return REFOCUS_OK;
    if (!rf_parse_number(xmp->value[key], value))
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its %s is no number", name);
    *found = true;
    return REFOCUS_OK;
}

double rf_xmp_simulated_f_number(const struct rf_xmp *xmp)
{
    const char *const text = xmp->value[RF_XMP_APPLE_APERTURE];
    double value;

    /* Anything but a number is passed over: the depth is as good without it. */
    return text && rf_parse_number(text, &value) && value > 0.0 ? value : 0.0;
}
