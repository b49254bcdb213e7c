/* picture.h: a picture for tests: a disc of one colour before another, with noise. */
#ifndef RF_TEST_STROKES_PICTURE_H
#define RF_TEST_STROKES_PICTURE_H

#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/platform/strokes.h>

static inline int in_disc(int x, int y, int width, int height)
{
    const int dx = x - width / 2, dy = y - height / 2, radius = height / 3;

    return dx * dx + dy * dy <= radius * radius;
}

static inline struct refocus_image make_picture(int width, int height)
{
    uint8_t *const pixels = malloc(3 * (size_t)width * (size_t)height);
    uint32_t state = 1;

    assert_non_null(pixels);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            uint8_t *const p = pixels + 3 * ((size_t)y * (size_t)width + (size_t)x);
            const int disc = in_disc(x, y, width, height);

            for (int i = 0; i < 3; i++) {
                state = state * 1664525 + 1013904223;
                p[i] = (uint8_t)((disc ? 60 + 40 * i : 180 - 30 * i) + (int)(state >> 28));
            }
        }
    }
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, width, height, 3 * width);
}

static inline struct refocus_stroke make_stroke(uint32_t kind, float radius, float disparity)
{
    struct refocus_stroke stroke = refocus_stroke_default(kind, radius);

    stroke.fill.kind = disparity >= 0 ? REFOCUS_FILL_SOLID : REFOCUS_FILL_NONE;
    stroke.fill.d0 = disparity >= 0 ? disparity : 0;
    return stroke;
}

static inline void paint(struct refocus_strokes *strokes, uint32_t kind, float radius,
                         float disparity, const float *points, int count)
{
    const struct refocus_stroke stroke = make_stroke(kind, radius, disparity);

    assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_OK);
    if (count > 0)
        assert_int_equal(refocus_strokes_extend(strokes, points, count, NULL), REFOCUS_OK);
}

#endif
