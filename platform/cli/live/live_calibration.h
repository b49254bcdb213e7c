/* live_calibration.h: where a depth camera and a colour camera are, from a JSON file. */
#ifndef RF_CLI_LIVE_CALIBRATION_H
#define RF_CLI_LIVE_CALIBRATION_H

#include <refocus/platform/convert.h>

/* An exit code, and prints why. */
int live_read_calibration(struct refocus_calibration **calibration, const char *file);

#endif
