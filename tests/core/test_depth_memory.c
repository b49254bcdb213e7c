/* test_depth_memory.c: depth with every allocation failing once: a documented error, and nothing
 * is left.
 *
 * This program is linked with --wrap=malloc and so on. */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/refocus.h>

#include "failing.h"

enum { W = 61, H = 43, CW = 17, CH = 11, UNTOUCHED = 0xa5a5 };
static uint8_t rgb[3 * W * H], confidence[W * H];
static uint16_t fine[W * H], coarse[CW * CH], out[W * H];

/* A near square before a far wall, and a hole. */
static void draw(void)
{
    for (int i = 0; i < W * H; i++) {
        const int inside = i % W >= 20 && i % W < 40 && i / W >= 12 && i / W < 30;

        memset(rgb + 3 * i, inside ? 200 : 40 + i % 7, 3);
        fine[i] = i % 97 == 0 ? 0 : inside ? 45000 : 12000;
    }
    for (int i = 0; i < CW * CH; i++)
        coarse[i] = fine[i / CW * H / CH * W + i % CW * W / CW];
}

static struct refocus_image photo(void)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, W, H, 3 * W);
}

static int upsample(int threads, int with_confidence)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    const struct refocus_disparity map = refocus_disparity16(coarse, CW, CH, 2 * CW);
    const struct refocus_image image = photo();

    params.threads = threads;
    params.confidence = with_confidence ? confidence : NULL;
    params.confidence_stride = CW;
    return refocus_upsample(&image, &map, &params, out, 2 * W);
}

static int upsample_alone(void)
{
    return upsample(1, 0);
}

static int upsample_in_threads(void)
{
    return upsample(3, 1);
}

/* No plane but the result has the photo's size. */
TEST(stated_upsample)
{
    enum { WIDTH = 300, HEIGHT = 1200, COLUMNS = 75, ROWS = 300, SHARE = 40000 };
    const size_t most = 8 * COLUMNS * ROWS + 330 * WIDTH * (HEIGHT / ROWS + 1) + SHARE;
    uint8_t *const pixels = calloc(WIDTH * HEIGHT, 3);
    uint16_t *const samples = calloc(COLUMNS * ROWS, 2), *const result = calloc(WIDTH * HEIGHT, 2);
    struct refocus_upsample_params params = refocus_upsample_params_default();
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, WIDTH, HEIGHT, 3 * WIDTH);
    const struct refocus_disparity map = refocus_disparity16(samples, COLUMNS, ROWS, 2 * COLUMNS);

    assert_true(pixels && samples && result);
    params.threads = 1;
    failing.held = failing.peak = 0;
    assert_int_equal(refocus_upsample(&image, &map, &params, result, 2 * WIDTH), REFOCUS_OK);
    assert_in_range(failing.peak, 1, most);
    free(pixels);
    free(samples);
    free(result);
}

enum edges { SHARP, SOFT, COARSE };

/* A map this coarse is worked on at a size between it and the photo's. */
static int place_edges(enum edges kind, int threads)
{
    static uint16_t samples[W * H];
    struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();
    const struct refocus_depth_edges_report before = report;
    const struct refocus_disparity map = kind == COARSE
                                             ? refocus_disparity16(coarse, CW - 2, CH - 1, 2 * CW)
                                             : refocus_disparity16(samples, W, H, 2 * W);
    const struct refocus_image image = photo();
    int status;

    for (int i = 0; i < W * H; i++) {
        const int x = i % W - 16, ramp = x < 0 ? 0 : x < 8 ? x : 8;

        samples[i] = (uint16_t)(12000 + 4000 * (kind == SOFT ? ramp : ramp / 4 * 4));
    }
    params.threads = threads;
    status = refocus_depth_edges(&image, &map, &params, out, 2 * W, &report);
    if (status != REFOCUS_OK)
        assert_memory_equal(&report, &before, sizeof report);
    return status;
}

static int place_sharp_edges(void)
{
    return place_edges(SHARP, 1);
}

static int place_soft_edges(void)
{
    return place_edges(SOFT, 3);
}

static int place_coarse_edges(void)
{
    return place_edges(COARSE, 2);
}

static int repair(void)
{
    struct refocus_repair_params params = refocus_repair_params_default();
    const struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                          .samples = fine,
                                          .width = W,
                                          .height = H,
                                          .stride = 2 * W,
                                          .sample = REFOCUS_SAMPLE_U16,
                                          .meaning = REFOCUS_DEPTH_DISPARITY,
                                          .flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN};

    const struct refocus_image image = photo();

    params.speckle = 4;
    params.photo = &image;
    params.confidence = confidence;
    params.confidence_stride = W;
    return refocus_depth_repair(&map, &params, out, 2 * W, NULL);
}

/* Large maps have tables. */
static int repair_in(void *work)
{
    enum { SIDE = 260 };
    static uint16_t large[SIDE * SIDE], to[SIDE * SIDE];
    struct refocus_repair_params params = refocus_repair_params_default();
    const struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                          .samples = large,
                                          .width = SIDE,
                                          .height = SIDE,
                                          .stride = 2 * SIDE,
                                          .sample = REFOCUS_SAMPLE_U16,
                                          .meaning = REFOCUS_DEPTH_DISPARITY,
                                          .flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN};
    int status;

    for (int i = 0; i < SIDE * SIDE; i++)
        large[i] = (uint16_t)(i % 97 * 300);
    params.speckle = 4;
    params.memory = work;
    params.memory_bytes = work ? (size_t)refocus_repair_memory(SIDE, SIDE, 4) : 0;
    status = refocus_depth_repair(&map, &params, to, 2 * SIDE, NULL);
    memcpy(out, to, sizeof out);
    return status;
}

static int repair_large(void)
{
    return repair_in(NULL);
}

/* In memory that is given nothing is allocated, the result is the same, and no byte behind it is
 * touched; with less, or beside its alignment, it is refused. */
TEST(repairs_in_memory_given)
{
    static uint16_t allocated[W * H];
    const size_t bytes = (size_t)refocus_repair_memory(260, 260, 4);
    uint8_t *work = malloc(bytes + 4);
    struct refocus_repair_params params = refocus_repair_params_default();
    struct refocus_depth_map map = refocus_depth_map_default();
    const struct refocus_image image = photo();

    assert_non_null(work);
    assert_int_equal(bytes, 458752 + 5 * 260 * 260);
    assert_int_equal(refocus_repair_memory(260, 260, 0), 458752 + 260 * 260);
    assert_int_equal(repair_in(NULL), REFOCUS_OK);
    memcpy(allocated, out, sizeof out);
    memset(work, 0xa5, bytes + 4);
    failing.calls = 0;
    assert_int_equal(repair_in(work), REFOCUS_OK);
    assert_int_equal(failing.calls, 0);
    assert_memory_equal(out, allocated, sizeof out);
    for (int i = 0; i < 4; i++)
        assert_int_equal(work[bytes + (size_t)i], 0xa5);
    map.samples = fine;
    map.width = W;
    map.height = H;
    map.stride = 2 * W;
    map.sample = REFOCUS_SAMPLE_U16;
    params.memory = work;
    params.memory_bytes = (size_t)refocus_repair_memory(W, H, 0) - 1;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, NULL), REFOCUS_ERR_ARGUMENT);
    params.memory_bytes++;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, NULL), REFOCUS_OK);
    params.photo = &image;
    params.memory_bytes += 6 * W * H - 1;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, NULL), REFOCUS_ERR_ARGUMENT);
    params.memory_bytes++;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, NULL), REFOCUS_OK);
    params.memory = work + 1;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, NULL), REFOCUS_ERR_ARGUMENT);
    free(work);
}

static int filter(void)
{
    const struct refocus_temporal_params params = refocus_temporal_params_default(W, H);
    const struct refocus_disparity map = refocus_disparity16(fine, W, H, 2 * W);
    struct refocus_temporal *made = (struct refocus_temporal *)out;
    const struct refocus_image image = photo();
    int status = refocus_temporal_create(&made, &params);

    assert_int_equal(made == NULL, status != REFOCUS_OK);
    for (int i = 0; i < 3 && status == REFOCUS_OK; i++) {
        const long before = failing.calls;

        status = refocus_temporal_run(made, i ? &image : NULL, &map, out, 2 * W);
        assert_int_equal(failing.calls, before); /* all memory is taken at creation */
    }
    refocus_temporal_destroy(&made);
    assert_null(made);
    return status;
}

static int make_of_kind(uint32_t kind, bool with_light)
{
    static float light[3 * W * H];
    static uint8_t made_photo[3 * W * H];
    const struct refocus_image into =
        refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, light, W, H, 12 * W);
    struct refocus_stack_params params = refocus_stack_params_default(W, H, 3);
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_stack *made = (struct refocus_stack *)out;
    const struct refocus_image image = photo();
    int status;

    params.kind = kind;
    status = refocus_stack_create(&made, &params);
    assert_int_equal(made == NULL, status != REFOCUS_OK);
    result.disparity = out;
    result.disparity_stride = 2 * W;
    result.photo = with_light ? made_photo : NULL;
    result.photo_stride = 3 * W;
    result.light = with_light ? &into : NULL;
    for (int i = 0; i < 3 && status == REFOCUS_OK; i++) {
        const long before = failing.calls;

        status = refocus_stack_add(made, &image, i + 1);
        if (status == REFOCUS_OK && i == 2)
            status = refocus_stack_finish(made, &result);
        /* All memory is taken at creation, but for that of light. */
        assert_int_equal(failing.calls, before + (with_light && i == 2));
    }
    refocus_stack_destroy(&made);
    assert_null(made);
    return status;
}

static int make_of_stack(void)
{
    return make_of_kind(REFOCUS_STACK_FOCUS, false);
}

static int make_of_light(void)
{
    return make_of_kind(REFOCUS_STACK_FOCUS, true);
}

static int make_of_apertures(void)
{
    return make_of_kind(REFOCUS_STACK_APERTURE_NEAREST, false);
}

static int is_untouched(void)
{
    for (int i = 0; i < W * H; i++)
        if (out[i] != UNTOUCHED)
            return 0;
    return 1;
}

/* @p least: allocations at the fewest; @p whole: a failed call leaves the output as it
 * was. */
static void fail_each(int (*run)(void), int least, int whole)
{
    static uint16_t expected[W * H];
    long all;

    draw();
    memset(confidence, 255, sizeof confidence);
    failing.calls = failing.live = failing.fail_at = 0;
    assert_int_equal(run(), REFOCUS_OK);
    assert_int_equal(failing.live, 0);
    memcpy(expected, out, sizeof out);
    all = failing.calls;
    assert_true(all >= least);
    for (long i = 1; i <= all; i++) {
        memset(out, UNTOUCHED & 255, sizeof out);
        memset(confidence, 255, sizeof confidence);
        failing.calls = 0;
        failing.fail_at = i;
        assert_int_equal(run(), REFOCUS_ERR_MEMORY);
        failing.fail_at = 0;
        assert_int_equal(failing.live, 0);
        if (whole)
            assert_true(is_untouched());
    }
    assert_int_equal(run(), REFOCUS_OK); /* nothing is remembered of the failure */
    assert_memory_equal(out, expected, sizeof out);
    assert_int_equal(failing.live, 0);
}

TEST(failing_upsample)
{
    fail_each(upsample_alone, 1, 1);
    fail_each(upsample_in_threads, 1, 1);
}

TEST(failing_edges)
{
    fail_each(place_sharp_edges, 1, 0);
    fail_each(place_soft_edges, 1, 0);
    fail_each(place_coarse_edges, 1, 0);
}

/* The memory for the largest picture that there can be is counted in 64 bits, and nothing is read
 * before it is there. */
TEST(largest_edges)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const int64_t side = REFOCUS_MAX_SIDE;
    const int32_t n = (int32_t)side;
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, n, n, (ptrdiff_t)(3 * side));
    const struct refocus_disparity map = refocus_disparity16(fine, n, n, (ptrdiff_t)(2 * side));

    memset(out, UNTOUCHED & 255, sizeof out);
    failing.calls = failing.live = 0;
    failing.fail_at = 1;
    assert_int_equal(refocus_depth_edges(&image, &map, &params, out, (ptrdiff_t)(2 * side), NULL),
                     3 * side * side > PTRDIFF_MAX ? REFOCUS_ERR_ARGUMENT : REFOCUS_ERR_MEMORY);
    failing.fail_at = 0;
    assert_int_equal(failing.live, 0);
    assert_true(is_untouched());
}

TEST(failing_repair)
{
    fail_each(repair, 2, 0);
    fail_each(repair_large, 3, 0);
}

TEST(failing_filter)
{
    fail_each(filter, 2, 1);
}

TEST(failing_stack)
{
    fail_each(make_of_stack, 2, 1);
    fail_each(make_of_light, 3, 1);
    fail_each(make_of_apertures, 2, 1);
}
