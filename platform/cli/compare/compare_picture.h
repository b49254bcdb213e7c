/* compare_picture.h: the renderings of `refocus compare`, side by side in one picture. */
#ifndef RF_CLI_COMPARE_PICTURE_H
#define RF_CLI_COMPARE_PICTURE_H

#include <refocus/refocus.h>
#include "compare/compare_list.h"
#include "metrics.h"
#include "line/report.h"

enum { COMPARE_MOST = VARIANTS_MOST + 2 }; /* variants, the reference and the photo */

struct compared {
    const char *name; /* NAME:OPTION=VALUE:... */
    uint8_t *rgb;     /* packed */
    bool scored;
    struct quality_scores scores;
    struct spread ms, cpu_ms;
    uint64_t memory; /* bytes of a renderer for this method alone */
};

struct comparison {
    int width, height, count;
    struct compared item[COMPARE_MOST];
};

/* Labelled crops where depth jumps, a column for each picture; plane[0] is to be freed,
 * NULL without memory. disparity: packed, of the photo's size. */
struct refocus_image compare_picture(const struct comparison *comparison,
                                     const uint16_t *disparity);

#endif
