/* bench_scene.h: a made-up scene to measure with. */
#ifndef RF_CLI_BENCH_SCENE_H
#define RF_CLI_BENCH_SCENE_H

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

#endif
