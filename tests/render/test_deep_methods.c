/* test_deep_methods.c: what the methods beside the sweep write to deep pictures. */
#include "deep_pictures.h"

enum { SIDE = 40 };

static struct refocus_renderer *renderer_of_all(int threads)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(SIDE, SIDE, 8);
    struct refocus_renderer *renderer;

    limits.deep = 1;
    limits.threads = threads;
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    return renderer;
}

static void render(struct refocus_renderer *renderer, uint32_t method, float focus, float blur,
                   const struct refocus_image *out)
{
    struct refocus_render_params params = refocus_render_params_default(focus, blur);

    params.method = method;
    assert_int_equal(refocus_render(renderer, &params, out), REFOCUS_OK);
}

/* A sample of chroma is that of the mean of its pixels, whatever method and threads: rows are red
 * and blue by turns, and nothing is blurred. */
TEST(chroma)
{
    static uint16_t disparity[SIDE * SIDE];
    static uint8_t expected[3 * SIDE * SIDE], memory[3 * SIDE * SIDE];
    const struct refocus_disparity map = refocus_disparity16(disparity, SIDE, SIDE, 2 * SIDE);
    const struct refocus_image truth =
        refocus_image_planar(REFOCUS_FORMAT_P016, expected, SIDE, SIDE);
    const struct refocus_image out = refocus_image_planar(REFOCUS_FORMAT_P016, memory, SIDE, SIDE);
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB16, SIDE, SIDE);

    for (int i = 0; i < SIDE * SIDE; i++)
        deep_put(&photo, i % SIDE, i / SIDE, i / SIDE % 2 ? 2 : 0, 0.6f);
    for (int threads = 1; threads <= 4; threads += 3) {
        struct refocus_renderer *renderer = renderer_of_all(threads);

        assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
        render(renderer, REFOCUS_METHOD_SWEEP, 0, 8, &truth);
        for (uint32_t m = 0; m < REFOCUS_METHOD_COUNT; m++)
            if (refocus_method_traits(m) & REFOCUS_METHOD_TAKES_DEEP) {
                memset(memory, 0, sizeof memory);
                render(renderer, m, 0, 8, &out);
                assert_memory_equal(memory, expected, sizeof memory);
            }
        refocus_renderer_destroy(&renderer);
    }
    free(photo.memory);
}

/* The search makes the same of a photo whatever the renderer showed before, also where that was
 * just what the search makes of it. */
TEST(search_again)
{
    static uint16_t disparity[SIDE * SIDE];
    const struct refocus_disparity map = refocus_disparity16(disparity, SIDE, SIDE, 2 * SIDE);
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB16, SIDE, SIDE);
    struct deep first = deep_make(REFOCUS_FORMAT_RGB16, SIDE, SIDE);
    struct deep again = deep_make(REFOCUS_FORMAT_RGB16, SIDE, SIDE);
    struct refocus_renderer *renderer = renderer_of_all(1);
    uint32_t seed = 5;

    for (int i = 0; i < SIDE * SIDE; i++) {
        const float grey = (float)((seed = seed * 1664525 + 1013904223) >> 16) / 65535;

        disparity[i] = i % SIDE < SIDE / 2 ? 65535 : 30000;
        for (int c = 0; c < 3; c++)
            deep_put(&photo, i % SIDE, i / SIDE, c, grey);
    }
    assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
    render(renderer, REFOCUS_METHOD_SEARCH, 0.45f, 8, &first.image);
    assert_int_equal(refocus_prepare(renderer, &first.image, &map), REFOCUS_OK);
    render(renderer, REFOCUS_METHOD_SWEEP, 0.45f, 1, &again.image);
    assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
    render(renderer, REFOCUS_METHOD_SEARCH, 0.45f, 8, &again.image);
    assert_memory_equal(again.memory, first.memory, first.size);
    refocus_renderer_destroy(&renderer);
    free(photo.memory);
    free(first.memory);
    free(again.memory);
}
