/* upsample.c: a small depth map is brought to the photo's size by a filter of OpenCV. */
#include "inputs/upsample.h"
#include "line/report.h"

#ifdef RF_HAVE_OPENCV
#include <refocus/platform/opencv.h>

const char *upsample_name(uint32_t index)
{
    return index ? refocus_cv_filter_name(index - 1) : "core";
}

int upsample_by_filter(uint32_t filter, const struct refocus_image *photo,
                       const struct refocus_disparity *map, uint16_t *out, const char *name)
{
    struct refocus_cv_reason reason = {""};
    const int status = refocus_cv_upsample_by(filter, photo, map, out, &reason);

    if (status == REFOCUS_OK)
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, name, "--upsample %s: %s", refocus_cv_filter_name(filter),
                          reason.text[0] ? reason.text : refocus_strerror(status));
}
#else
const char *upsample_name(uint32_t index)
{
    return index ? NULL : "core";
}

int upsample_by_filter(uint32_t filter, const struct refocus_image *photo,
                       const struct refocus_disparity *map, uint16_t *out, const char *name)
{
    (void)filter;
    (void)photo;
    (void)map;
    (void)out;
    return report_failure(EXIT_FAILED, name, "this build has no OpenCV; build it with OpenCV");
}
#endif
