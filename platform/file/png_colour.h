/* png_colour.h: what a PNG says about its colours beside an ICC profile. */
#ifndef RF_FILE_PNG_COLOUR_H
#define RF_FILE_PNG_COLOUR_H

#include <stdbool.h>
#include "bytes.h"

struct rf_png_colour {
    const char *by;       /* name of the chunks that say other colours than sRGB; NULL: none do */
    int curve, primaries; /* by cICP, numbers of ITU-T H.273; 0: not said */
    bool whole_range;     /* codes of cICP are R, G and B from 0 to the largest */
};

/* Look through chunks; gamma and chromaticities do not count where there is a profile. */
struct rf_png_colour rf_png_colour_of(struct rf_bytes chunks, bool has_profile);

#endif
