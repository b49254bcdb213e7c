/* opencv.h: the library of depth by OpenCV, which is loaded when it is first asked for: it brings
 * some thirty libraries with it. */
#ifndef RF_CLI_OPENCV_H
#define RF_CLI_OPENCV_H

#include <refocus/platform/opencv.h>

/* The functions of refocus/platform/opencv.h, by the rest of their names. */
struct opencv {
    __typeof__(refocus_cv_stereo) *stereo;
    __typeof__(refocus_cv_network_name) *network_name;
    __typeof__(refocus_cv_network) *network;
    __typeof__(refocus_cv_network_fit) *network_fit;
    __typeof__(refocus_cv_estimate) *estimate;
    __typeof__(refocus_cv_estimate_free) *estimate_free;
    __typeof__(refocus_cv_estimator_create) *estimator_create;
    __typeof__(refocus_cv_estimator_run) *estimator_run;
    __typeof__(refocus_cv_estimator_destroy) *estimator_destroy;
    __typeof__(refocus_cv_filter_name) *filter_name;
    __typeof__(refocus_cv_upsample_by) *upsample_by;
};

/* The names that refocus_cv_network_name() gives, for help that loads nothing; NULL ends them. */
const char *opencv_network_name(uint32_t index);

/* The functions; NULL: they cannot be had, and `why` says so. By the main thread alone. */
enum { OPENCV_WHY = 320 };
const struct opencv *opencv_load(char why[OPENCV_WHY]);

#endif
