/** @file scene.h  A photo and what is known of the depth in it, for refocus_prepare_scene(). */
#ifndef REFOCUS_SCENE_H
#define REFOCUS_SCENE_H

#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/sized.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The edges of a map of disparities. */
enum refocus_depth_edges {
    REFOCUS_DEPTH_EDGES_AS_GIVEN = 0, /**< every disparity as the map has it */
    REFOCUS_DEPTH_EDGES_AUTO = 1,     /**< refocus_depth_edges() of depth_edges.h: where the map is
                                           soft, coarse or beside the photo, its edges go to the
                                           photo's. Renderers whose parameters have depth_edges
                                           alone have the memory for it */
};

/** A photo and what is known of the depth in it. Start from refocus_scene_default(). */
struct refocus_scene {
    uint32_t struct_size;              /**< sizeof(struct refocus_scene) */
    uint32_t depth_edges;              /**< enum refocus_depth_edges; default as given */
    const struct refocus_image *photo; /**< all in focus; at most max_width x max_height of the
                                          renderer; any enum refocus_format. Each byte is read once,
                                          each plane in order: camera memory may be uncached */
    const struct refocus_disparity
        *disparity; /**< any size; covers the same view as the photo. Another size than the
                         photo's is brought to it by following the photo's edges */
};

/** A photo and its disparities alone, which stay the caller's. */
static inline struct refocus_scene refocus_scene_default(const struct refocus_image *photo,
                                                         const struct refocus_disparity *disparity)
{
    struct refocus_scene scene;

    memset(&scene, 0, sizeof scene);
    scene.struct_size = sizeof scene;
    scene.photo = photo;
    scene.disparity = disparity;
    return scene;
}

#ifdef __cplusplus
}
#endif
#endif
