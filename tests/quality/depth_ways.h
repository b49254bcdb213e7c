/* depth_ways.h: ways to bring coarse depth to the size of a photo. */
#ifndef QUALITY_DEPTH_WAYS_H
#define QUALITY_DEPTH_WAYS_H

#include <stdint.h>

#include "scene.h"

struct depth_coarse {
    int width, height;
    uint16_t *disparity;
    uint8_t *confidence; /* 0 where the sensor saw nothing, or NULL */
};

/* The tables that a way is in: of scenes, of decimated ground truth, of maps that are off. */
enum { IN_SCENES = 1, IN_TRUTH = 2 };

/* Makes disparities of the scene's size; 0 or a status of refocus. */
struct depth_way {
    const char *name;
    int (*run)(const struct quality_scene *scene, const struct depth_coarse *coarse, uint16_t *out);
    unsigned tables;
};

extern const struct depth_way depth_ways[]; /* until one without a name */

#ifdef RF_HAVE_OPENCV
/* Upsamples by a filter of refocus_cv_upsample_by(). */
int depth_by_opencv(uint32_t filter, const struct quality_scene *scene,
                    const struct depth_coarse *c, uint16_t *out);
#endif

#endif
