/* upsample.c: a small depth map is brought to the photo's size by a filter of OpenCV. */
#include <stdio.h>
#include "inputs/opencv.h"
#include "inputs/upsample.h"
#include "line/report.h"

/* After "core" in the order of enum refocus_cv_filter, in builds without OpenCV as well. */
const struct option_word upsample_words[] = {{"core", NULL},
                                             {"bilinear", NULL},
                                             {"joint-bilateral", NULL},
                                             {"guided", NULL},
                                             {"fast-global", NULL},
                                             {"joint-bilateral-full", NULL},
                                             {0}};

int upsample_check(int way)
{
#ifdef RF_HAVE_OPENCV
    (void)way;
    return EXIT_DONE;
#else
    if (way == 0)
        return EXIT_DONE;
    return report_failure(EXIT_WRONG, "--upsample",
                          "this build has no OpenCV, which '%s' is of; give core",
                          upsample_words[way].name);
#endif
}

int upsample_by_filter(int way, const struct refocus_image *photo,
                       const struct refocus_disparity *map, uint16_t *out,
                       struct refocus_reason *reason)
{
    struct refocus_cv_reason why = {""};
    char absent[OPENCV_WHY];
    const struct opencv *cv = opencv_load(absent);
    int status;

    if (!cv) {
        snprintf(reason->text, sizeof reason->text, "%.250s", absent);
        return REFOCUS_ERR_UNSUPPORTED;
    }
    status = cv->upsample_by((uint32_t)way - 1, photo, map, out, &why);
    if (status != REFOCUS_OK)
        snprintf(reason->text, sizeof reason->text, "%s: %.200s",
                 cv->filter_name((uint32_t)way - 1),
                 why.text[0] ? why.text : refocus_strerror(status));
    return status;
}
