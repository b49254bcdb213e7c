/* focus.h: how far each pixel is out of focus, where eq. 4, K (df - d), is not all there is.
 *
 * Everything ends in one signed blur a pixel, s = K e with e in units of disparity,
 * 65535 = 1; what renders it need not know how it came about. All of it is whole
 * numbers.
 */
#ifndef RF_FOCUS_H
#define RF_FOCUS_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/render.h>

#include "kernels/kernels.h"
#include "support/settings.h"

enum { RF_ONE = 65535 }; /* disparity 1, or a picture's width, in what follows */

/* A band about a focus: the offset of its middle from df, the distance from there at which blur
 * begins, and that from which on it is the lens's again. */
struct rf_band {
    int32_t offset, sharp, whole;
};

/* A field of blur about a centre, all lengths RF_ONE = 1. */
struct rf_field {
    uint32_t shape; /* enum refocus_field */
    int32_t x;
    uint32_t y; /* up to 65535 picture widths */
    int32_t disparity, radius, falloff;
    int32_t normal_x, normal_d; /* Q30 */
};

/* The focus that struct rf_settings asks for, in fixed point. */
struct rf_focus_plan {
    struct rf_focus focus;
    bool plain;                   /* s = K (df - d) and nothing else */
    uint32_t number;              /* counts renders with maps, which may change in between */
    int width, height;            /* pixels of the whole photo */
    uint16_t least, most;         /* disparities are clamped to these */
    uint16_t limit;               /* |s| at most, as it is stored */
    int32_t share;                /* how much of depth counts, Q16 */
    int64_t tilt, tilt_x, tilt_y; /* at pixel (0, 0), and a pixel's step: Q24 */
    int bands;                    /* 1 or more when any is wider than nothing, else 0 */
    struct rf_band band[REFOCUS_MAX_BANDS];
    const struct refocus_disparity *surface, *sharp, *picture; /* each may be NULL */
    struct rf_field field;
};

/* df and K in fixed point. */
struct rf_focus rf_focus_of(float focus_disparity, float max_blur_radius);

/* Makes the plan of parameters that are in their ranges. */
void rf_focus_plan_make(struct rf_focus_plan *plan, const struct rf_settings *params,
                        struct rf_focus focus, int width, int height);

/* The largest blur that there can be, in pixels. With a plain lens the end that is farther from the
 * focus has it; else it may be all of max_blur_radius, K. */
float rf_focus_largest(const struct rf_focus_plan *plan, float max_blur_radius);

/* Signed blur of n pixels of disparities from (x, y) on, Q7.8 of 2^plan->focus.unit pixels. */
void rf_focus_row(const struct rf_focus_plan *plan, int16_t *blur, const uint16_t *disparity, int x,
                  int y, int n);

/* The e of a field, signed as s is: below 0 where the pixel is nearer than the centre. */
int32_t rf_field_at(const struct rf_focus_plan *plan, int x, int y, int d);

/* The value of a map at pixel (x, y) of a picture of width x height that it covers. It is
 * interpolated between samples, and the sample itself when the sizes are the same. */
int rf_map_at(const struct refocus_disparity *map, int width, int height, int x, int y);

#endif
