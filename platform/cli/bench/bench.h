/* The parts of `refocus bench`. */
#ifndef RF_CLI_BENCH_H
#define RF_CLI_BENCH_H

#include "shot/engine.h"

/* A photo in memory and its disparities. */
struct scene {
    struct refocus_image photo;
    uint16_t *disparity;
    int map_width, map_height;
};

/* A made-up scene. Returns an exit code and prints why it is not EXIT_DONE;
 * bench_scene_free() in any case. */
int bench_scene_make(struct scene *scene, int width, int height);
void bench_scene_free(struct scene *scene);

/*
 * --frames: times of whole frames over blur, quality and threads, each in turns with a
 * memcpy of the frame and a plain box blur; of the scene, or without one of made-up
 * scenes of several sizes. Returns an exit code.
 */
int bench_frames(const struct engine_settings *settings, const struct scene *scene,
                 const char *name);

/* --kernels: a table of refocus_measure_kernel(). Returns an exit code. */
int bench_kernels(const struct engine_settings *settings);

#endif
