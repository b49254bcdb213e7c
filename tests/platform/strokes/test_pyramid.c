/* test_pyramid.c: the photo at half its size, and half of that, down to one pixel, whatever its
 * sides. */
#include <stdlib.h>
#include "unit_test.h"
#include "pyramid.h"

/* Each level has half of each side of the one before, up; the last one is a pixel. */
TEST(test_sides)
{
    static const int32_t sides[] = {1, 2, 3, 4, 5, 16, 17, 100};
    enum { SIDES = sizeof sides / sizeof *sides };
    static uint8_t pixels[3 * 100 * 100];

    for (int i = 0; i < SIDES * SIDES; i++) {
        int32_t w = sides[i % SIDES], h = sides[i / SIDES];
        const struct refocus_image photo =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, w, h, 3 * (ptrdiff_t)w);
        struct rf_pyramid pyramid;
        int levels = 1;

        assert_int_equal(rf_pyramid_create(&pyramid, &photo), REFOCUS_OK);
        assert_null(pyramid.level[0]);
        for (; w > 1 || h > 1; levels++) {
            w = (w + 1) / 2;
            h = (h + 1) / 2;
            assert_true(levels < pyramid.levels);
            assert_int_equal(pyramid.width[levels], w);
            assert_int_equal(pyramid.height[levels], h);
            assert_non_null(pyramid.level[levels]);
        }
        assert_int_equal(pyramid.levels, levels);
        rf_pyramid_free(&pyramid);
        assert_int_equal(pyramid.levels, 0);
    }
}

/* Means of squares of grey pixels, of those at the border of what there is. */
TEST(test_means)
{
    enum { W = 5, H = 3 };
    uint8_t pixels[3 * W * H];
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, (ptrdiff_t)3 * W);
    struct rf_pyramid pyramid;
    struct rf_colour row[3];

    for (int i = 0; i < 3 * W * H; i++)
        pixels[i] = (uint8_t)(i / 3 % W * 40 + i / 3 / W * 20);
    assert_int_equal(rf_pyramid_create(&pyramid, &photo), REFOCUS_OK);
    for (int y = 0; y < 2; y++) {
        rf_pyramid_row(&pyramid, 1, 0, y, 3, row);
        for (int x = 0; x < 3; x++) {
            const int across = x < 2 ? 80 * x + 20 : 160, down = y < 1 ? 10 : 40;

            assert_true(abs(row[x].y - (across + down)) <= 1);
            assert_true(abs(row[x].u - 128) <= 1 && abs(row[x].v - 128) <= 1);
        }
    }
    rf_pyramid_free(&pyramid);
}
