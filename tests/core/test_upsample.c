/* test_upsample.c: the depth upsampler through its public face. */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/refocus.h>

static uint32_t random_state;

static uint32_t random_bits(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return random_state >> 8;
}

struct scene {
    int width, height, columns, rows;
    uint8_t *rgb;
    uint16_t *map, *out, *other;
    uint8_t *confidence;
};

/* Patches of colour, and a map with steps that mostly follow them. */
static struct scene make(int width, int height, int columns, int rows)
{
    struct scene s = {width, height, columns, rows, NULL, NULL, NULL, NULL, NULL};

    s.rgb = malloc(3 * (size_t)width * (size_t)height);
    s.map = malloc(2 * (size_t)columns * (size_t)rows);
    s.out = malloc(2 * (size_t)width * (size_t)height);
    s.other = malloc(2 * (size_t)width * (size_t)height);
    s.confidence = malloc((size_t)columns * (size_t)rows);
    assert_true(s.rgb && s.map && s.out && s.other && s.confidence);
    random_state = (uint32_t)(width * 7919 + height * 31 + columns);
    for (int i = 0; i < 3 * width * height; i++) {
        const int x = i / 3 % width, y = i / 3 / width;

        s.rgb[i] = (uint8_t)((x / 5 * 61 + y / 7 * 97 + i % 3 * 50) % 200 + random_bits() % 20);
    }
    for (int i = 0; i < columns * rows; i++) {
        const int x = i % columns * width / columns, y = i / columns * height / rows;

        s.map[i] = (uint16_t)((x / 5 * 12345 + y / 7 * 23456 + random_bits() % 900) % 65536);
        s.confidence[i] = random_bits() % 5 ? 255 : (uint8_t)(random_bits() % 200);
    }
    return s;
}

static void end(struct scene *s)
{
    free(s->rgb);
    free(s->map);
    free(s->out);
    free(s->other);
    free(s->confidence);
}

static int run(const struct scene *s, const struct refocus_upsample_params *params, uint16_t *out)
{
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, s->rgb, s->width, s->height, 3 * s->width);
    const struct refocus_disparity map =
        refocus_disparity16(s->map, s->columns, s->rows, 2 * s->columns);

    return refocus_upsample(&photo, &map, params, out, 2 * (ptrdiff_t)s->width);
}

static const int sizes[][4] = {{64, 48, 16, 12}, {97, 61, 13, 29}, {40, 31, 1, 1},
                               {33, 5, 32, 2},   {5, 64, 2, 63},   {1, 1, 3, 3},
                               {300, 20, 3, 20}, {16, 16, 40, 9},  {129, 70, 2, 3}};
enum { SIZES = sizeof sizes / sizeof *sizes };

/* Every instruction set and any number of threads give equal bits. */
TEST(same_everywhere)
{
    for (int i = 0; i < 2 * SIZES; i++) {
        const int *size = sizes[i / 2];
        struct scene s = make(size[0], size[1], size[2], size[3]);
        struct refocus_upsample_params params = refocus_upsample_params_default();
        const size_t bytes = 2 * (size_t)s.width * (size_t)s.height;

        if (i % 2) {
            params.confidence = s.confidence;
            params.confidence_stride = s.columns;
        }
        params.cpu = REFOCUS_CPU_C;
        params.threads = 1;
        assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
        for (uint32_t cpu = REFOCUS_CPU_AUTO; refocus_cpu_name(cpu); cpu++) {
            for (int threads = 1; threads <= 5; threads += 2) {
                params.cpu = cpu;
                params.threads = threads;
                memset(s.other, 0xa5, bytes);
                const int status = run(&s, &params, s.other);
                if (status == REFOCUS_ERR_UNSUPPORTED)
                    continue;
                assert_int_equal(status, REFOCUS_OK);
                if (memcmp(s.out, s.other, bytes))
                    fail_msg("%s, %d threads, %dx%d from %dx%d", refocus_cpu_name(cpu), threads,
                             s.width, s.height, s.columns, s.rows);
            }
        }
        end(&s);
    }
}

/* No disparity that no sample is near: means are of one surface only. */
TEST(invents_nothing)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();

    for (int i = 0; i < SIZES; i++) {
        struct scene s = make(sizes[i][0], sizes[i][1], sizes[i][2], sizes[i][3]);

        for (int k = 0; k < s.columns * s.rows; k++)
            s.map[k] = (uint16_t)(random_bits() % 4 * 20000 + random_bits() % 500);
        assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
        for (int k = 0; k < s.width * s.height; k++)
            if (s.out[k] % 20000 >= 500 || s.out[k] >= 60500)
                fail_msg("%dx%d: pixel %d is %d", s.width, s.height, k, s.out[k]);
        end(&s);
    }
}

/* One disparity stays what it is, to the bit; a ramp stays a ramp. */
TEST(keeps_planes)
{
    static const uint16_t values[] = {0, 1, 77, 32768, 65534, 65535};
    struct refocus_upsample_params params = refocus_upsample_params_default();

    for (int i = 0; i < SIZES; i++) {
        struct scene s = make(sizes[i][0], sizes[i][1], sizes[i][2], sizes[i][3]);

        for (int v = 0; v < 6; v++) {
            for (int k = 0; k < s.columns * s.rows; k++)
                s.map[k] = values[v];
            params.confidence = v % 2 ? s.confidence : NULL;
            params.confidence_stride = s.columns;
            assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
            for (int k = 0; k < s.width * s.height; k++)
                assert_int_equal(s.out[k], values[v]);
        }
        end(&s);
    }
    struct scene s = make(240, 60, 60, 15);
    params.confidence = NULL;
    for (int k = 0; k < s.columns * s.rows; k++)
        s.map[k] = (uint16_t)(k % s.columns * 1000 + 1000);
    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    for (int x = 12; x < 228; x++)
        assert_in_range(s.out[30 * 240 + x] + 2, (int)((x + 0.5) / 4 * 1000 + 500),
                        (int)((x + 0.5) / 4 * 1000 + 504));
    end(&s);
}

/* An edge of the photo between two samples is where the step comes to lie, to the pixel, with
 * samples that are all sure, too. */
static void follows_the_photo_to(uint16_t far, bool sure)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();

    for (int edge = 40; edge < 60; edge++) {
        struct scene s = make(96, 64, 16, 10);

        memset(s.confidence, 255, 160);
        params.confidence = sure ? s.confidence : NULL;
        params.confidence_stride = 16;

        for (int k = 0; k < 96 * 64; k++)
            memset(s.rgb + 3 * k, k % 96 < edge ? 200 : 40, 3);
        for (int k = 0; k < 160; k++) /* sample i is at pixel 6 i + 3 */
            s.map[k] = k % 16 * 6 + 3 < edge ? 60000 : far;
        assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
        for (int k = 0; k < 96 * 64; k++)
            assert_int_equal(s.out[k], k % 96 < edge ? 60000 : far);
        end(&s);
    }
}

TEST(follows_the_photo)
{
    follows_the_photo_to(8000, false);
    follows_the_photo_to(8000, true);
    follows_the_photo_to(0, true);
}

/* A wrong sample that is not to be trusted does not show; a trusted one does. */
static void weighs_confidence_at(int u, int v)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    struct scene s = make(96, 96, 12, 12);

    memset(s.rgb, 100, 3 * 96 * 96);
    for (int y = 8 * v + 1; y < 8 * v + 8; y++)
        memset(s.rgb + 3 * (96 * y + 8 * u + 1), 180, 3 * 7);
    memset(s.confidence, 255, 144);
    for (int k = 0; k < 144; k++)
        s.map[k] = 10000;
    s.map[v * 12 + u] = 50000;
    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    assert_int_equal(s.out[(8 * v + 4) * 96 + 8 * u + 4], 50000);
    params.confidence = s.confidence;
    params.confidence_stride = 12;
    s.confidence[v * 12 + u] = 0;
    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    for (int k = 0; k < 96 * 96; k++)
        assert_int_equal(s.out[k], 10000);
    end(&s);
}

/* A sample that is off by less than a step does not show, either, unless it is trusted. The photo
 * is white in blue: 255 as a confidence. */
static void weighs_small_errors_at(int u, int v)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    struct scene s = make(96, 96, 12, 12);

    for (int k = 0; k < 3 * 96 * 96; k++)
        s.rgb[k] = k % 3 == 2 ? 255 : 100;
    memset(s.confidence, 255, 144);
    for (int k = 0; k < 144; k++)
        s.map[k] = 10000;
    s.map[v * 12 + u] = 10400;
    params.confidence = s.confidence;
    params.confidence_stride = 12;
    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    assert_true(s.out[(8 * v + 4) * 96 + 8 * u + 4] > 10100);
    s.confidence[v * 12 + u] = 0;
    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    for (int k = 0; k < 96 * 96; k++)
        assert_int_equal(s.out[k], 10000);
    end(&s);
}

TEST(weighs_confidence)
{
    weighs_confidence_at(6, 6);
    weighs_confidence_at(2, 9);
    weighs_confidence_at(9, 3);
    weighs_small_errors_at(6, 6);
    weighs_small_errors_at(3, 9);
}

/* A map that has the photo's size comes out as it is, of 8 and 16 bits and bottom-up. */
TEST(same_size)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    struct scene s = make(31, 22, 31, 22);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, s.rgb, 31, 22, 3 * 31);
    uint8_t bytes[31 * 22];
    struct refocus_disparity map = refocus_disparity16(s.map + 31 * 21, 31, 22, -2 * 31);

    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    assert_memory_equal(s.out, s.map, 2 * 31 * 22);
    assert_int_equal(refocus_upsample(&photo, &map, &params, s.out, 2 * 31), REFOCUS_OK);
    for (int y = 0; y < 22; y++)
        assert_memory_equal(s.out + 31 * y, s.map + 31 * (21 - y), 2 * 31);
    for (int k = 0; k < 31 * 22; k++)
        bytes[k] = (uint8_t)(s.map[k] >> 8);
    map = refocus_disparity8(bytes, 31, 22, 31);
    assert_int_equal(refocus_upsample(&photo, &map, &params, s.out, 2 * 31), REFOCUS_OK);
    for (int k = 0; k < 31 * 22; k++)
        assert_int_equal(s.out[k], bytes[k] * 257);
    end(&s);
}

/* refocus_prepare() and formats, strides and 8 bits come to the same. */
TEST(same_by_other_ways)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    struct scene s = make(75, 50, 20, 17);
    struct refocus_renderer_params limits = refocus_renderer_params_default(90, 60, 7);
    struct refocus_renderer *renderer = NULL;
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, s.rgb, 75, 50, 225);
    struct refocus_disparity map = refocus_disparity16(s.map, 20, 17, 40);
    uint8_t *bgra = malloc(4 * 75 * 50), bytes[20 * 17];

    assert_non_null(bgra);
    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &map), REFOCUS_OK);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, s.other, 150), REFOCUS_OK);
    assert_memory_equal(s.out, s.other, 2 * 75 * 50);
    refocus_renderer_destroy(&renderer);

    for (int k = 0; k < 75 * 50; k++) { /* bottom-up, another order */
        uint8_t *p = bgra + 4 * ((49 - k / 75) * 75 + k % 75);

        p[0] = s.rgb[3 * k + 2];
        p[1] = s.rgb[3 * k + 1];
        p[2] = s.rgb[3 * k];
    }
    const struct refocus_image turned =
        refocus_image_packed(REFOCUS_FORMAT_BGRA8, bgra + 4 * 75 * 49, 75, 50, -300);
    assert_int_equal(refocus_upsample(&turned, &map, &params, s.other + 75 * 49, -150), REFOCUS_OK);
    for (int y = 0; y < 50; y++)
        assert_memory_equal(s.out + 75 * y, s.other + 75 * (49 - y), 150);

    for (int k = 0; k < 20 * 17; k++) {
        bytes[k] = (uint8_t)(s.map[k] >> 8);
        s.map[k] = (uint16_t)(bytes[k] * 257);
    }
    assert_int_equal(run(&s, &params, s.out), REFOCUS_OK);
    map.bits = 8;
    map.samples = bytes;
    map.stride = 20;
    assert_int_equal(refocus_upsample(&photo, &map, &params, s.other, 150), REFOCUS_OK);
    assert_memory_equal(s.out, s.other, 2 * 75 * 50);
    free(bgra);
    end(&s);
}

TEST(bad_arguments)
{
    struct scene s = make(20, 20, 5, 5);
    struct refocus_upsample_params params = refocus_upsample_params_default(), bad[5];
    const struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, s.rgb, 20, 20, 60);
    const struct refocus_disparity map = refocus_disparity16(s.map, 5, 5, 10);

    for (int i = 0; i < 5; i++)
        bad[i] = params;
    bad[0].struct_size = 4;
    bad[1].threads = -1;
    bad[2].threads = 65;
    bad[3].cpu = 99;
    bad[4].confidence = s.confidence;
    bad[4].confidence_stride = 4;
    memset(s.out, 1, 800);
    for (int i = 0; i < 5; i++)
        assert_int_equal(run(&s, &bad[i], s.out), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_upsample(NULL, &map, &params, s.out, 40), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_upsample(&photo, NULL, &params, s.out, 40), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_upsample(&photo, &map, NULL, s.out, 40), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_upsample(&photo, &map, &params, NULL, 40), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_upsample(&photo, &map, &params, s.out, 41), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_upsample(&photo, &map, &params, s.out, 38), REFOCUS_ERR_ARGUMENT);
    for (int k = 0; k < 400; k++)
        assert_int_equal(s.out[k], 0x0101);
    end(&s);
}

/* Specks go, thin lines and large patches stay; codes and confidence. */
TEST(repair)
{
    enum { W = 40, H = 30 };
    static uint16_t in[W * H], out[W * H];
    static uint8_t confidence[W * H];
    struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                    .samples = in,
                                    .width = W,
                                    .height = H,
                                    .stride = 2 * W,
                                    .sample = REFOCUS_SAMPLE_U16,
                                    .meaning = REFOCUS_DEPTH_DISPARITY,
                                    .value_near = 65535,
                                    .flags = REFOCUS_DEPTH_MAX_IS_UNKNOWN |
                                             REFOCUS_DEPTH_2047_IS_UNKNOWN};
    struct refocus_repair_params params = refocus_repair_params_default();
    struct refocus_depth_report report = refocus_depth_report_default();

    for (int i = 0; i < W * H; i++)
        in[i] = 20000;
    for (int i = 0; i < 20; i++)
        in[(5 + i) * W + 5 + i] = 60000; /* a line of one pixel, touching at corners */
    in[3 * W + 20] = in[3 * W + 21] = 50000;
    in[10] = 65535;
    in[11] = 2047;
    in[12] = 0;
    params.speckle = 3;
    params.confidence = confidence;
    params.confidence_stride = W;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, &report), REFOCUS_OK);
    assert_int_equal(report.unknown, 2);
    assert_int_equal(report.specks, 3); /* the pair, and the 0 */
    for (int i = 0; i < W * H; i++) {
        const int filled = i == 10 || i == 11 || i == 12 || i == 3 * W + 20 || i == 3 * W + 21;

        assert_int_equal(confidence[i], filled ? 0 : 255);
        assert_int_equal(out[i], in[i] == 60000 ? 60000 : 20000);
    }
    /* Nothing but specks: they are what there is. */
    for (int i = 0; i < W * H; i++)
        in[i] = (uint16_t)((i * 7 + i / W * 13) % 16 * 4096);
    params.speckle = REFOCUS_MAX_SPECKLE;
    map.width = map.height = 8;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, &report), REFOCUS_OK);
    assert_int_equal(report.specks, 0);
    assert_int_equal(out[1], in[1]);
    params.speckle = 256;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, &report),
                     REFOCUS_ERR_ARGUMENT);
}
