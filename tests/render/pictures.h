/* pictures.h: pictures and settings that the render tests share. */
#ifndef RENDER_PICTURES_H
#define RENDER_PICTURES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit_test.h"
#include <refocus/refocus.h>

/* A photo, R G B without padding, and its disparities. */
struct picture {
    int width, height;
    uint8_t *rgb;
    uint16_t *disparity;
};

/* A textured slope with lights, balls before it and bars close to the lens: every
 * class of tile, hard edges, clipped pixels. The same for the same seed everywhere. */
struct picture picture_make(int width, int height, uint32_t seed);

/* A wall with a box before it, a fence of wires before both, and a beam as near as the fence. */
enum { FENCE_FAR = 2000, FENCE_NEAR = 60000 }; /* disparities of the wall and the fence */
struct picture picture_fence(int width, int height, uint32_t seed);

/* Draws a line through (x0, y0) along (dx, dy), `wide` pixels wide, as near as the fence. */
void picture_line(struct picture *picture, double x0, double y0, double dx, double dy, double wide,
                  int code);

/* All pixels of one colour, all disparities the same. */
struct picture picture_flat(int width, int height, const uint8_t rgb[3], uint16_t disparity);
void picture_free(struct picture *picture);

/* Light of a code of sRGB, 1 = white, and the nearest code of light. */
double picture_light(int code);
uint8_t picture_code(double light);

struct refocus_image picture_image(const struct picture *picture);
struct refocus_disparity picture_disparity(const struct picture *picture);

/* A way to render, with a name for messages. */
struct style {
    const char *name;
    uint32_t method;
    int rays;
    int iterations;
    int mirror, background, prefilter;
    uint32_t blend;
    float sigma; /* 0: plain average */
    int blades;  /* 0: disc; -1: a mask with an L in it */
    int variant; /* selects the method's own settings; see style_params() */
    int leaks;   /* pixels in focus may change beside blurred ones */
};
extern const struct style styles[];
extern const int style_count;

struct refocus_settings style_params(const struct style *style, float focus, float blur);
/* Settings that no style has, with a name each; false: there is none of that number. All of
 * `sweep`, but for the first 4: one of each method that takes any focus. */
bool effect_params(int i, float focus, float blur, struct refocus_settings *params,
                   const char **name);
/* To be destroyed by the caller; NULL for a disc. */
struct refocus_aperture *effect_aperture(int i);

/* To be destroyed by the caller; NULL for a disc. */
struct refocus_aperture *style_aperture(const struct style *style);

/* A prepared renderer, threads as given; fails the test when it cannot. */
struct refocus_renderer *prepared(const struct picture *picture, float blur, int threads);

/* Renders all of the picture, to R G B without padding, by a renderer of its own; fails the test
 * when it cannot. */
void render_once(const struct refocus_renderer_params *limits, const struct picture *picture,
                 const struct refocus_settings *settings, uint8_t *out);

/* Renders all of the picture to R G B without padding; fails the test when it cannot. */
void render_style(struct refocus_renderer *renderer, const struct picture *picture,
                  const struct style *style, float focus, float blur, uint8_t *out);

/* Fails with the place of the first difference. */
void assert_same_pixels(const uint8_t *a, const uint8_t *b, int width, int height,
                        const char *what);

uint32_t noise(uint32_t *state);

/* For builds in which a pixel takes 10 to 100 times as long, REFOCUS_BRIEF in their tests'
 * environment: true but for one i in n. What is left out there differs from what is done in
 * nothing but its numbers, and is done in the other builds. */
bool left_out(int i, int n);

#endif
