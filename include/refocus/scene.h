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
    REFOCUS_DEPTH_EDGES_AS_GIVEN = 0, /**< every edge where the map has it. Maps of the photo's
                                           size that use 32 to 320 codes, as those of 8 bits do and
                                           those of 16 that were made of 8, are smoothed over steps
                                           from one of them to the next, by less than a step; not
                                           where a tenth of these are wider than 1/64, or codes have
                                           fewer than 64 pixels each */
    REFOCUS_DEPTH_EDGES_AUTO = 1,     /**< refocus_depth_edges() of depth_edges.h: where the map is
                                           soft, coarse or beside the photo, its edges go to the
                                           photo's. A renderer has to be made for it:
                                           refocus_renderer_params.depth_edges */
    REFOCUS_DEPTH_EDGES_STEADY = 2,   /**< AUTO for frames of a video: where the scene before
                                           was prepared so too and was of this size, decisions that
                                           are close stay as they were in it, unless the map changes
                                           there, or the photo within some 8 pixels */
};

/**
 * A photo and what is known of the depth in it. Start from refocus_scene_default().
 *
 * The matte says how much of each pixel the subject covers,
 *
 *     C = alpha N + (1 - alpha) F
 *
 * with N the colour of the subject and F that of what is behind it. The subject is the nearer of
 * the two surfaces at its silhouette: where what has alpha 0 is not farther by 1/32 of disparity,
 * as the ground at its feet or something before it, the matte changes nothing. Elsewhere
 *
 * - alpha within 1/32 of 0 or 1 counts as 0 or 1. Such a pixel up to 6 pixels from the silhouette
 *   keeps its disparity if one farther in on its side and up to 10 pixels away has it, within 1/32,
 *   and else gets that of the nearest of these. Where there is none, as in hair, it keeps its own,
 *   unless a pixel beside it on the other side has the same: it gets one from the rest of its side
 *   then, as the map has lost it.
 * - between them F is the mean of what is behind, and the disparity is that of the side with the
 *   greater part. What is darker or brighter than any such mixture is more of the subject than
 *   alpha says: by all that it takes where alpha is 1/2 and more, else by less. The sweep draws
 *   alpha N over what is behind, where N is in focus and F is not; else the pixel as one of N, with
 *   the mean colour of the background in place of F, if alpha is 1/8 or more, and as it is with
 *   what is behind if it is less. Other methods draw it as it is.
 *
 * There is room for as many mixtures as a fourth of the pixels of a row of tiles of 16 x 16;
 * further ones are drawn as they are. In tiles with mixtures of the matte no others are looked for
 * (struct refocus_thin_params). A matte of one value, 0 or 1 for example, changes nothing.
 */
struct refocus_scene {
    uint32_t struct_size;              /**< sizeof(struct refocus_scene) */
    uint32_t depth_edges;              /**< enum refocus_depth_edges; default as given */
    const struct refocus_image *photo; /**< all in focus; at most max_width x max_height of the
                                          renderer; any enum refocus_format. Each byte is read once,
                                          each plane in order: camera memory may be uncached */
    const struct refocus_disparity
        *disparity; /**< any size; covers the same view as the photo. Another size than the
                         photo's is brought to it by following the photo's edges */
    const struct refocus_disparity
        *matte; /**< NULL, the default, or alpha of each pixel: any size, bilinear between samples;
                     0 = background, the greatest value of its bits = subject. Of photos of R, G, B,
                     to renderers with `thin` */
    const struct refocus_image *behind; /**< NULL, the default, or what the photo hides, where that
                                           is known: a picture of R, G, B of the photo's size, for
                                           photos of R, G, B. Alpha 0: nothing is known there;
                                           else all of the pixel is. What a blurred foreground
                                           uncovers then shows it, in place of what is made up of
                                           its surroundings. The renderer has to be made for it:
                                           refocus_renderer_params.behind */
    const struct refocus_disparity
        *behind_disparity; /**< disparities of what is behind, in the units of `disparity` and of
                              the photo's size; NULL if `behind` is. Counts where it is farther than
                              the photo's own */
    const uint8_t *confidence; /**< NULL, the default, or a byte for each sample of `disparity`: 255
                                  = sure, 0 = a guess that counts where there is nothing else, as
                                  in refocus_upsample(). It weighs where a map is brought to the
                                  photo's size; of a map of that size with
                                  REFOCUS_DEPTH_EDGES_AUTO, samples below 128 are made anew from
                                  those up to 4 samples away. Strip mode refuses it */
    ptrdiff_t confidence_stride; /**< bytes from a row to the next; may be negative */
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
