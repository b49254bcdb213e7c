/* test_upsample_strips.c: refocus_upsample() goes through a photo in strips of 64 rows of samples,
 * and refocus_prepare() at once: the bits are the same. */
#include <stdint.h>
#include <stdlib.h>
#include "unit_test.h"
#include <refocus/refocus.h>

enum { MOST = 70 * 700 };
static uint8_t rgb[3 * MOST];
static uint16_t samples[MOST], out[MOST], expected[MOST];

static const struct size {
    int width, height, columns, rows;
    int codes; /* the map has so many; 0: any number */
} sizes[] = {{60, 300, 20, 150, 0},  {50, 333, 9, 64, 0},    {40, 700, 12, 65, 0},
             {64, 200, 64, 199, 40}, {30, 500, 30, 66, 0},   {70, 400, 35, 400, 40},
             {70, 690, 70, 340, 30}, {23, 130, 11, 128, 30}, {1, 700, 1, 300, 0}};

/* Surfaces with edges, beside those of the photo here and there. */
static void draw(const struct size *s)
{
    uint32_t state = 1;

    for (int i = 0; i < s->width * s->height; i++) {
        const int x = i % s->width, y = i / s->width, near = (x / 9 + y / 23) % 3;

        state = state * 1664525 + 1013904223;
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = (uint8_t)(60 * near + 20 * c + (int)(state >> 27));
    }
    for (int i = 0; i < s->columns * s->rows; i++) {
        const int x = i % s->columns * s->width / s->columns;
        const int y = i / s->columns * s->height / s->rows;

        samples[i] = s->codes ? (uint16_t)((y / 8 + x / 30) % s->codes * 1500)
                              : (uint16_t)((x / 9 + (y + 1) / 23) % 3 * 20000 + y);
    }
}

static void prepare(const struct size *s, const struct refocus_image *photo,
                    const struct refocus_disparity *map)
{
    const struct refocus_renderer_params params =
        refocus_renderer_params_default(s->width, s->height, 3);
    struct refocus_renderer *renderer = NULL;

    assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, photo, map), REFOCUS_OK);
    assert_int_equal(
        refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, expected, 2 * (ptrdiff_t)s->width),
        REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
}

TEST(same_in_strips)
{
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const struct size *const s = &sizes[i];
        const struct refocus_image photo =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, s->width, s->height, 3 * s->width);
        const struct refocus_disparity map =
            refocus_disparity16(samples, s->columns, s->rows, 2 * s->columns);
        struct refocus_upsample_params params = refocus_upsample_params_default();

        draw(s);
        prepare(s, &photo, &map);
        for (params.threads = 1; params.threads <= 3; params.threads += 2) {
            memset(out, 0, sizeof out);
            assert_int_equal(refocus_upsample(&photo, &map, &params, out, 2 * s->width),
                             REFOCUS_OK);
            assert_memory_equal(out, expected, 2 * (size_t)s->width * (size_t)s->height);
        }
    }
}
