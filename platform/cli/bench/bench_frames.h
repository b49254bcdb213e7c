/* bench_frames.h: times of whole frames. */
#ifndef RF_CLI_BENCH_FRAMES_H
#define RF_CLI_BENCH_FRAMES_H

#include "bench/bench_scene.h"
#include "shot/engine.h"

/*
 * --frames: times of whole frames over blur, quality and threads, each in turns with a
 * memcpy of the frame and a plain box blur; of the scene, or without one of made-up
 * scenes of several sizes. Returns an exit code.
 */
int bench_frames(const struct engine_settings *settings, const struct scene *scene,
                 const char *name);

#endif
