/* test_upsample.c: OpenCV's ways to bring a small map to the photo's size. */
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/platform/opencv.h>

enum { W = 320, H = 200 };

static uint32_t state_of = 1;

static uint8_t noise(void)
{
    state_of = state_of * 1664525u + 1013904223u;
    return (uint8_t)(state_of >> 24);
}

static struct refocus_image picture(uint8_t *pixels)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
}

/* OpenCV takes the memory of its matrices by this function, and so gets it from here, where
 * $OPENCV_ENABLE_MEMALIGN is set; else it would be malloc(). */
static int memory_left = INT_MAX;

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    if (memory_left-- <= 0)
        return ENOMEM;
    *memory = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    return *memory ? 0 : ENOMEM;
}

TEST(upsample)
{
    static uint8_t pixels[3 * W * H];
    static uint16_t map[40 * 25], out[W * H];
    const struct refocus_image photo = picture(pixels);
    const struct refocus_disparity coarse = refocus_disparity16(map, 40, 25, 80);

    for (int i = 0; i < W * H; i++) /* sample k is at pixel 8 k + 3.5 */
        memset(pixels + 3 * i, i % W < 150 ? 220 : 30, 3);
    for (int i = 0; i < 40 * 25; i++)
        map[i] = i % 40 * 8 + 4 < 150 ? 50000 : 10000;
    assert_int_equal(refocus_cv_upsample(&photo, &coarse, 20, out, NULL), REFOCUS_OK);
    for (int i = 0; i < W * H; i++)
        assert_in_range(out[i], i % W < 150 ? 49990 : 9990, i % W < 150 ? 50010 : 10010);
    assert_int_equal(refocus_cv_upsample(&photo, &coarse, 0, out, NULL), REFOCUS_ERR_ARGUMENT);
}

/* A pixel of the joint bilateral mean, in double precision. */
static double mean_of_samples(const struct refocus_image *photo,
                              const struct refocus_disparity *map, double sigma, int x, int y)
{
    const uint8_t *const rgb = photo->plane[0], *const pixel = rgb + y * photo->stride[0] + 3 * x;
    const double u = (x + 0.5) * map->width / photo->width - 0.5;
    const double v = (y + 0.5) * map->height / photo->height - 0.5;
    double total = 0, sum = 0;

    for (int j = -2; j <= 2; j++) {
        for (int i = -2; i <= 2; i++) {
            const double at_x = floor(u + 0.5) + i, at_y = floor(v + 0.5) + j;
            const int sx = (int)fmin(fmax(at_x, 0), map->width - 1);
            const int sy = (int)fmin(fmax(at_y, 0), map->height - 1);
            const uint8_t *const row = (const uint8_t *)map->samples + sy * map->stride;
            const uint8_t *const like =
                rgb + (2 * sy + 1) * photo->height / (2 * map->height) * photo->stride[0] +
                3 * ((2 * sx + 1) * photo->width / (2 * map->width));
            double squares = 0, weight;

            for (int c = 0; c < 3; c++)
                squares += (pixel[c] - like[c]) * (pixel[c] - like[c]);
            weight = exp(-((u - at_x) * (u - at_x) + (v - at_y) * (v - at_y)) / 2) *
                     (exp(-squares / (2 * sigma * sigma)) + 1e-9);
            total += weight;
            sum += weight *
                   (map->bits == 16 ? ((const uint16_t *)(const void *)row)[sx] : 257 * row[sx]);
        }
    }
    return sum / total;
}

/* Photos and maps of any size, of noise in blocks with rows farther apart than needed. */
TEST(upsample_is_the_mean)
{
    static const struct {
        int width, height, map_width, map_height, bits;
        float sigma;
    } cases[] = {
        {96, 64, 24, 16, 16, 25.5f}, {97, 61, 24, 16, 8, 25.5f},  {101, 67, 13, 29, 16, 5},
        {1, 1, 1, 1, 16, 25.5f},     {90, 3, 1, 1, 8, 25.5f},     {1, 70, 1, 9, 16, 25.5f},
        {70, 1, 9, 1, 8, 25.5f},     {40, 30, 40, 30, 16, 25.5f}, {17, 11, 64, 48, 16, 100},
        {96, 64, 24, 16, 16, 1e-6f}, {96, 64, 24, 16, 16, 1e9f},  {3, 2, 99, 98, 8, 25.5f}};
    static uint8_t pixels[130 * 3 * 100], samples[130 * 2 * 100];
    static uint16_t out[130 * 100 + 1];

    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        const int w = cases[n].width, h = cases[n].height, stride = 3 * w + 5;
        const struct refocus_image photo =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, w, h, stride);
        struct refocus_disparity map = refocus_disparity16(
            (const uint16_t *)(const void *)samples, cases[n].map_width, cases[n].map_height, 260);

        map.bits = cases[n].bits;
        state_of = 3 + (uint32_t)n;
        for (size_t i = 0; i < sizeof samples; i++)
            samples[i] = noise();
        for (size_t i = 0; i < sizeof pixels; i++)
            pixels[i] = i % 12 < 9 || i < 12 ? noise() : pixels[i - 9];
        out[w * h] = 0xa5a5;
        assert_int_equal(refocus_cv_upsample(&photo, &map, cases[n].sigma, out, NULL), REFOCUS_OK);
        for (int i = 0; i < w * h; i++) {
            const double exact =
                mean_of_samples(&photo, &map, (double)cases[n].sigma, i % w, i / w);

            if (fabs(out[i] - exact) > 1)
                fail_msg("case %d, pixel %d: %d, should be %.2f", (int)n, i, out[i], exact);
        }
        assert_int_equal(out[w * h], 0xa5a5);
    }
}

/* Each piece of memory that OpenCV asks for fails once: that is the answer, and no exception. */
TEST(upsample_without_memory)
{
    static uint8_t pixels[3 * W * H];
    static uint16_t map[40 * 25], out[W * H];
    const struct refocus_image photo = picture(pixels);
    const struct refocus_disparity coarse = refocus_disparity16(map, 40, 25, 80);
    int status, failed = 0;

    if (!getenv("OPENCV_ENABLE_MEMALIGN"))
        skip();
    for (;; failed++) {
        struct refocus_cv_reason reason;

        memory_left = failed;
        status = refocus_cv_upsample(&photo, &coarse, 25, out, &reason);
        if (memory_left >= 0)
            break;
        memory_left = INT_MAX;
        assert_int_equal(status, REFOCUS_ERR_MEMORY);
        assert_string_equal(reason.text, "not enough memory");
    }
    memory_left = INT_MAX;
    assert_int_equal(status, REFOCUS_OK);
    assert_in_range(failed, 10, 40);
}

/* Every filter keeps a plane; those of contrib are there, or say what is missing. */
TEST(upsample_by)
{
    static uint8_t pixels[3 * W * H];
    static uint16_t map[40 * 25], out[W * H];
    const struct refocus_image photo = picture(pixels);
    struct refocus_disparity coarse = refocus_disparity16(map, 40, 25, 80);
    struct refocus_cv_reason reason;
    uint32_t filter;

    for (int i = 0; i < 40 * 25; i++)
        map[i] = 30000;
    for (filter = 0; refocus_cv_filter_name(filter); filter++) {
        const int status = refocus_cv_upsample_by(filter, &photo, &coarse, out, &reason);

#ifndef WITH_XIMGPROC
        if (status == REFOCUS_ERR_UNSUPPORTED && filter >= REFOCUS_CV_GUIDED) {
            assert_non_null(strstr(reason.text, "-Dximgproc=enabled"));
            continue;
        }
#endif
        assert_int_equal(status, REFOCUS_OK);
        for (int i = 0; i < W * H; i++)
            assert_in_range(out[i], 29998, 30002);
    }
    assert_int_equal(filter, 5);
    assert_int_equal(refocus_cv_upsample_by(filter, &photo, &coarse, out, &reason),
                     REFOCUS_ERR_ARGUMENT);
    coarse.bits = 12;
    assert_int_equal(refocus_cv_upsample_by(0, &photo, &coarse, out, &reason),
                     REFOCUS_ERR_ARGUMENT);
}
