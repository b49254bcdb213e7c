/* test_methods.c: names and traits of methods and processors: what they say is so. */
#include "pictures.h"

enum { W = 20, H = 12 };

TEST(names)
{
    for (uint32_t i = 0; i < REFOCUS_METHOD_COUNT; i++) {
        assert_non_null(refocus_method_name(i));
        assert_non_null(refocus_method_summary(i));
    }
    assert_string_equal(refocus_method_name(REFOCUS_METHOD_SEARCH), "search");
    assert_null(refocus_method_name(REFOCUS_METHOD_COUNT));
    assert_null(refocus_method_summary(UINT32_MAX));
    assert_int_equal(refocus_method_traits(REFOCUS_METHOD_COUNT), 0);
    assert_string_equal(refocus_cpu_name(REFOCUS_CPU_AVX2), "avx2");
    assert_string_equal(refocus_cpu_name(REFOCUS_CPU_AVX512), "avx512");
    for (uint32_t i = 0; i < REFOCUS_CPU_COUNT; i++)
        assert_non_null(refocus_cpu_name(i));
    assert_null(refocus_cpu_name(REFOCUS_CPU_COUNT));
    assert_null(refocus_cpu_name(UINT32_MAX));
    assert_string_equal(refocus_version(), REFOCUS_VERSION_STRING);
    for (int i = -20; i < 3; i++)
        assert_true(strlen(refocus_strerror(i)) > 0);
    assert_int_equal(refocus_format_bytes(REFOCUS_FORMAT_BGR8), 3);
    assert_int_equal(refocus_format_bytes(REFOCUS_FORMAT_BGRA8), 4);
    assert_int_equal(refocus_format_bytes(77), 0);
}

static void render_rays(struct refocus_renderer *renderer, uint32_t method, int rays, uint8_t *to)
{
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, to, W, H, 3 * W);
    struct refocus_settings params = refocus_settings_default(0.5f, 5);

    params.render.method = method;
    params.render.rays = rays;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
}

/* A method does what its traits say; test_focus.c looks at those of focus. */
TEST(traits)
{
    struct picture p = picture_make(W, H, 3);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    uint8_t few[3 * W * H], many[3 * W * H];
    const struct refocus_image to = refocus_image_packed(REFOCUS_FORMAT_RGB8, few, W, H, 3 * W);
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 5);
    struct refocus_settings params = refocus_settings_default(0.5f, 5);
    struct refocus_renderer *renderer, *strips;
    struct refocus_aperture *polygon;
    uint64_t least;

    limits.papers = refocus_papers();
    limits.threads = 1;
    least = refocus_renderer_memory(&limits);
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    assert_int_equal(refocus_aperture_create_polygon(&polygon, 5, 0), REFOCUS_OK);
    for (uint32_t i = 0; i < REFOCUS_METHOD_COUNT; i++) {
        const uint32_t has = refocus_method_traits(i);
        const int no_whole = has & REFOCUS_METHOD_WHOLE_PHOTO ? REFOCUS_ERR_ARGUMENT : REFOCUS_OK;

        render_rays(renderer, i, 3, few);
        render_rays(renderer, i, 40, many);
        assert_int_equal(memcmp(few, many, sizeof few) != 0,
                         (has & REFOCUS_METHOD_TAKES_RAYS) != 0);
        params.render.method = i;
        params.render.aperture = polygon;
        assert_int_equal(refocus_render_settings(renderer, &params, &to),
                         has & REFOCUS_METHOD_DISC_ONLY ? REFOCUS_ERR_ARGUMENT : REFOCUS_OK);
        limits.methods = REFOCUS_METHOD_BIT(i);
        assert_int_equal(refocus_renderer_memory(&limits) > least, no_whole != REFOCUS_OK);
        limits.in_place = 1;
        assert_int_equal(refocus_renderer_create(&strips, &limits), no_whole);
        refocus_renderer_destroy(&strips);
        limits.in_place = 0;
    }
    refocus_aperture_destroy(&polygon);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
