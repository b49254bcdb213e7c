/* live_depth_camera.h: the thread that takes depth from a camera, and the fixed depth map in its
 * place. */
#ifndef RF_CLI_LIVE_DEPTH_CAMERA_H
#define RF_CLI_LIVE_DEPTH_CAMERA_H

#include "live/live_state.h"

void *live_depth_thread(void *live);
/* Read the depth file as the one map of all frames; an exit code, and prints why. */
int live_read_fixed_depth(struct live *live);

#endif
