/* live_settings.h: what the command line of refocus live asks for. */
#ifndef RF_CLI_LIVE_SETTINGS_H
#define RF_CLI_LIVE_SETTINGS_H

#include <stdbool.h>
#include "commands/stack_shots.h"
#include "inputs/read_input.h"
#include "inputs/lens.h"
#include "live/live_lens.h"
#include "shot/engine.h"

/* "--depth estimate:MODEL,every=N,preset=NAME" */
struct live_estimate_settings {
    char model[4096]; /* empty: not wanted */
    long every;
    int preset;
};

struct live_settings {
    const char *camera, *out, *calibration, *socket, *focus_way;
    struct depth_settings depth;
    struct live_estimate_settings estimate;
    struct live_lens_settings autofocus;
    struct shots_settings stack; /* parts of "--depth stack:"; no steps: not wanted */
    struct lens_settings lens;
    struct engine_settings engine;
    double size[2], fps, frames, duration, patience, blur_most, steady;
    int format, policy, matrix; /* the matrix -1: as the source says */
    bool fast, loop, no_commands, list, dmabuf;
    bool offline; /* from files to files: nothing goes by the clock on the wall */
};

enum { POLICY_DEFAULT = -1, POLICY_NEWEST, POLICY_EVERY };

#endif
