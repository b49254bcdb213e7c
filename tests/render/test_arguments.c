/* test_arguments.c: each argument out of its documented range is refused, and nothing is
 * written. */
#include "gather/method.h"
#include "pictures.h"

enum { W = 20, H = 12 };

/* Sets one field to a bad value. */
#define BAD(type, field, value)                                                                    \
    {                                                                                              \
#field " = " #value, offsetof(struct type, field), sizeof((struct type *)0)->field,        \
            &(__typeof__(((struct type *)0)->field))                                               \
        {                                                                                          \
            value                                                                                  \
        }                                                                                          \
    }

struct bad {
    const char *what;
    size_t offset, size;
    const void *value;
};

static void *odd_address(void)
{
    static uint16_t samples[W * H + 2];
    return (uint8_t *)samples + 1;
}

static void *some_allocate(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void some_release(void *user, void *memory)
{
    (void)user;
    free(memory);
}

static void spoil(void *params, const struct bad *bad)
{
    memcpy((char *)params + bad->offset, bad->value, bad->size);
}

TEST(bad_limits)
{
    const struct bad bad[] = {
        BAD(refocus_renderer_params, struct_size, 0),
        BAD(refocus_renderer_params, struct_size, 4),
        BAD(refocus_renderer_params, max_width, 0),
        BAD(refocus_renderer_params, max_width, -1),
        BAD(refocus_renderer_params, max_width, 65536),
        BAD(refocus_renderer_params, max_height, 0),
        BAD(refocus_renderer_params, max_height, INT32_MIN),
        BAD(refocus_renderer_params, max_height, INT32_MAX),
        BAD(refocus_renderer_params, max_blur_radius, -0.001f),
        BAD(refocus_renderer_params, max_blur_radius, 944.1f),
        BAD(refocus_renderer_params, max_blur_radius, NAN),
        BAD(refocus_renderer_params, max_blur_radius, INFINITY),
        BAD(refocus_renderer_params, threads, -1),
        BAD(refocus_renderer_params, threads, 65),
        BAD(refocus_renderer_params, cpu, REFOCUS_CPU_COUNT),
        BAD(refocus_renderer_params, cpu, UINT32_MAX),
        BAD(refocus_renderer_params, methods, REFOCUS_METHOD_BIT(REFOCUS_METHOD_COUNT)),
        BAD(refocus_renderer_params, reserved, 1),
        BAD(refocus_renderer_params, allocator.allocate, some_allocate),
        BAD(refocus_renderer_params, thin, 2),
        BAD(refocus_renderer_params, behind, 2),
        BAD(refocus_renderer_params, textured, 2),
        BAD(refocus_renderer_params, allocator.release, some_release)};

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct refocus_renderer_params params = refocus_renderer_params_default(W, H, 5);
        struct refocus_renderer *renderer = (struct refocus_renderer *)&params;
        int status;

        params.threads = 1;
        spoil(&params, &bad[i]);
        status = refocus_renderer_create(&renderer, &params);
        if (status != REFOCUS_ERR_ARGUMENT || renderer)
            fail_msg("%s: %d", bad[i].what, status);
        if (refocus_renderer_memory(&params) != 0)
            fail_msg("memory of %s is not 0", bad[i].what);
    }
    struct refocus_renderer *renderer;
    assert_int_equal(refocus_renderer_create(&renderer, NULL), REFOCUS_ERR_ARGUMENT);
    assert_null(renderer);
    assert_int_equal(refocus_renderer_memory(NULL), 0);
    const struct refocus_renderer_params good = refocus_renderer_params_default(W, H, 5);
    assert_int_equal(refocus_renderer_create(NULL, &good), REFOCUS_ERR_ARGUMENT);
    refocus_renderer_destroy(NULL);
    refocus_renderer_destroy(&renderer);
    refocus_cancel(NULL);
}

/* The last line of the log. */
static char said[256];

static void hear(void *user, const char *text)
{
    (void)user;
    assert_true(strlen(text) < sizeof said && !strchr(text, '\n'));
    strcpy(said, text);
}

/* Whether the log names the function and the last part of a member such as "look.grain = 5". */
static bool is_named(const char *function, const char *what)
{
    char member[64] = "";
    const char *const dot = strchr(what, '.'), *const value = strstr(what, " = ");

    what = dot && dot < value ? dot + 1 : what;
    strncat(member, what, (size_t)(value - what));
    if (strncmp(member, "region", 6) == 0)
        member[6] = 0; /* four numbers that are one thing */
    return strncmp(said, function, strlen(function)) == 0 && strstr(said, member);
}

/* A renderer whose log is heard, with a picture prepared. */
static struct refocus_renderer *heard(const struct picture *p)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 5);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);
    struct refocus_renderer *renderer;

    limits.threads = 1;
    limits.log.message = hear;
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    return renderer;
}

/* Renders by settings that are to be refused, and leave the picture alone. */
static void refuse(struct refocus_renderer *renderer, const struct refocus_settings *settings,
                   const char *what)
{
    static uint8_t out[3 * W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    int status;

    memset(out, 0x5a, sizeof out);
    said[0] = 0;
    status = refocus_render_settings(renderer, settings, &image);
    if (status != REFOCUS_ERR_ARGUMENT)
        fail_msg("%s: %d, %s", what, status, said);
    for (size_t i = 0; i < sizeof out; i++)
        assert_int_equal(out[i], 0x5a);
}

static const struct bad out_of_range[] = {
    BAD(refocus_settings, render.struct_size, 0),
    BAD(refocus_settings, render.struct_size, 8),
    BAD(refocus_settings, render.method, REFOCUS_METHOD_COUNT),
    BAD(refocus_settings, render.method, UINT32_MAX),
    BAD(refocus_settings, render.dither, 2),
    BAD(refocus_settings, render.focus_disparity, -0.01f),
    BAD(refocus_settings, render.focus_disparity, 1.01f),
    BAD(refocus_settings, render.focus_disparity, NAN),
    BAD(refocus_settings, render.max_blur_radius, -1),
    BAD(refocus_settings, render.max_blur_radius, 5.01f),
    BAD(refocus_settings, render.max_blur_radius, NAN),
    BAD(refocus_settings, render.rays, 0),
    BAD(refocus_settings, render.rays, -2),
    BAD(refocus_settings, render.rays, 1025),
    BAD(refocus_settings, render.rays, INT32_MAX),
    BAD(refocus_settings, render.blend, 3),
    BAD(refocus_settings, render.sigma, 0.99f),
    BAD(refocus_settings, render.sigma, -1),
    BAD(refocus_settings, render.sigma, NAN),
    BAD(refocus_settings, highlights.gain, 0.99f),
    BAD(refocus_settings, highlights.gain, 16.01f),
    BAD(refocus_settings, highlights.gain, NAN),
    BAD(refocus_settings, highlights.estimate, -0.01f),
    BAD(refocus_settings, highlights.estimate, 4.01f),
    BAD(refocus_settings, highlights.estimate, NAN),
    BAD(refocus_settings, highlights.steady, -0.01f),
    BAD(refocus_settings, highlights.steady, 0.96f),
    BAD(refocus_settings, highlights.steady, NAN),
    BAD(refocus_settings, search.iterations, 0),
    BAD(refocus_settings, search.iterations, 65),
    BAD(refocus_settings, search.iterations, -1),
    BAD(refocus_settings, search.mirror, 2),
    BAD(refocus_settings, search.background, 2),
    BAD(refocus_settings, render.prefilter, 2),
    BAD(refocus_settings, render.inpaint, 2),
    BAD(refocus_settings, focus.reserved, 1),
    BAD(refocus_settings, render.region_x, -1),
    BAD(refocus_settings, render.region_x, 1),
    BAD(refocus_settings, render.region_y, 1),
    BAD(refocus_settings, render.region_width, W),
    BAD(refocus_settings, render.region_height, H),
    BAD(refocus_settings, render.region_width, -1),
    BAD(refocus_settings, jittered.cell, 0),
    BAD(refocus_settings, jittered.cell, 17),
    BAD(refocus_settings, scatter.spread, 2),
    BAD(refocus_settings, scatter.airy_radius, 0.2f),
    BAD(refocus_settings, scatter.airy_radius, 17),
    BAD(refocus_settings, scatter.airy_radius, NAN),
    BAD(refocus_settings, scatter.depth_ratio, 0.9f),
    BAD(refocus_settings, scatter.depth_ratio, INFINITY),
    BAD(refocus_settings, look.star_spikes, 1),
    BAD(refocus_settings, look.star_spikes, 17),
    BAD(refocus_settings, look.star_spikes, -2),
    BAD(refocus_settings, look.star_length, -1),
    BAD(refocus_settings, look.star_length, 128),
    BAD(refocus_settings, look.star_angle, NAN),
    BAD(refocus_settings, look.star_strength, 1.1f),
    BAD(refocus_settings, look.star_strength, NAN),
    BAD(refocus_settings, interpolated.sharp_radius, 0.4f),
    BAD(refocus_settings, interpolated.sharp_radius, NAN),
    BAD(refocus_settings, interpolated.middle_ratio, 1),
    BAD(refocus_settings, interpolated.middle_ratio, -2),
    BAD(refocus_settings, interpolated.last_ratio, 0.5f),
    BAD(refocus_settings, interpolated.last_ratio, NAN),
    BAD(refocus_settings, foveated.x, -0.1f),
    BAD(refocus_settings, foveated.y, 1.1f),
    BAD(refocus_settings, foveated.angle, -1),
    BAD(refocus_settings, foveated.angle, 171),
    BAD(refocus_settings, foveated.picture_angle, 0),
    BAD(refocus_settings, foveated.picture_angle, NAN),
    BAD(refocus_settings, foveated.depth, 1.5f),
    BAD(refocus_settings, field.shape, 6),
    BAD(refocus_settings, field.x, -1),
    BAD(refocus_settings, field.y, NAN),
    BAD(refocus_settings, field.disparity, 2),
    BAD(refocus_settings, field.radius, -1),
    BAD(refocus_settings, field.falloff, 0),
    BAD(refocus_settings, field.falloff, 5),
    BAD(refocus_settings, field.angle, INFINITY),
    BAD(refocus_settings, diffusion.layers, 0),
    BAD(refocus_settings, diffusion.layers, 9),
    BAD(refocus_settings, diffusion.solver, 2),
    BAD(refocus_settings, diffusion.conductivity, 0),
    BAD(refocus_settings, diffusion.conductivity, 1.1f),
    BAD(refocus_settings, field.map, &(struct refocus_disparity){0}),
    BAD(refocus_settings, field.shape, REFOCUS_FIELD_PICTURE), /* the picture is missing */
    BAD(refocus_settings, focus.tilt_x, -0.1f),
    BAD(refocus_settings, focus.tilt_y, 1.1f),
    BAD(refocus_settings, focus.tilt_across, 64.1f),
    BAD(refocus_settings, focus.tilt_across, NAN),
    BAD(refocus_settings, focus.tilt_down, -64.1f),
    BAD(refocus_settings, focus.depth_share, 1.01f),
    BAD(refocus_settings, focus.depth_share, -0.1f),
    BAD(refocus_settings, focus.depth_share, NAN),
    BAD(refocus_settings, focus.half_width, -0.1f),
    BAD(refocus_settings, focus.half_width, 1.1f),
    BAD(refocus_settings, focus.transition, NAN),
    BAD(refocus_settings, focus.transition, 2),
    BAD(refocus_settings, focus.bands, -1),
    BAD(refocus_settings, focus.bands, 16),
    BAD(refocus_settings, focus.bands, INT32_MAX),
    BAD(refocus_settings, focus.map, &(struct refocus_disparity){0}),
    BAD(refocus_settings, focus.sharp_map, &(struct refocus_disparity){0}),
    BAD(refocus_settings, focus.least_disparity, -0.1f),
    BAD(refocus_settings, focus.least_disparity, 1.1f),
    BAD(refocus_settings, focus.most_disparity, -0.1f),
    BAD(refocus_settings, focus.most_disparity, NAN),
    BAD(refocus_settings, look.cat_eye, -0.1f),
    BAD(refocus_settings, look.cat_eye, 0.91f),
    BAD(refocus_settings, look.cat_eye, NAN),
    BAD(refocus_settings, look.fringe, 0.51f),
    BAD(refocus_settings, look.fringe, -0.51f),
    BAD(refocus_settings, look.fringe, NAN),
    BAD(refocus_settings, look.grain, -0.1f),
    BAD(refocus_settings, look.grain, 4.1f),
    BAD(refocus_settings, look.grain, NAN),
    BAD(refocus_settings, thin.enabled, 2),
    BAD(refocus_settings, focus.blur_limit, -1),
    BAD(refocus_settings, focus.blur_limit, 944.1f),
};

TEST(bad_settings)
{
    struct picture p = picture_make(W, H, 1);
    struct refocus_renderer *renderer = heard(&p);
    const struct refocus_settings good = refocus_settings_default(0.5f, 5);

    for (size_t i = 0; i < sizeof out_of_range / sizeof *out_of_range; i++) {
        struct refocus_settings settings = good;

        spoil(&settings, &out_of_range[i]);
        refuse(renderer, &settings, out_of_range[i].what);
        if (!is_named("refocus_render: ", out_of_range[i].what))
            fail_msg("%s: %s", out_of_range[i].what, said);
    }
    refuse(renderer, NULL, "no settings");
    refuse(NULL, &good, "no renderer");
    assert_int_equal(refocus_render_settings(renderer, &good, NULL), REFOCUS_ERR_ARGUMENT);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Numbers that are within their ranges, but not together. */
TEST(settings_at_odds)
{
    struct picture p = picture_make(W, H, 1);
    struct refocus_renderer *renderer = heard(&p);
    const struct refocus_settings good = refocus_settings_default(0.5f, 5);
    struct refocus_settings settings = good;
    struct refocus_aperture *aperture;

    settings.interpolated.middle_ratio = settings.interpolated.last_ratio = 3;
    refuse(renderer, &settings, "ratios the wrong way round");
    settings = good;
    settings.render.method = REFOCUS_METHOD_DIFFUSION;
    settings.field.shape = REFOCUS_FIELD_PICTURE;
    refuse(renderer, &settings, "a picture that is missing");
    settings = good;
    settings.focus.least_disparity = 0.5f;
    settings.focus.most_disparity = 0.49f;
    refuse(renderer, &settings, "disparities the wrong way round");
    for (int i = 0; i < 3; i++) {
        settings = good;
        settings.focus.bands = 4;
        settings.focus.band[3] =
            (struct refocus_band){i == 0 ? 1.1f : 0.5f, i == 1 ? -1 : 0, i == 2 ? NAN : 0};
        refuse(renderer, &settings, "the fourth band");
    }
    assert_int_equal(refocus_aperture_create_polygon(&aperture, 6, 0), REFOCUS_OK);
    for (uint32_t m = REFOCUS_METHOD_SCATTER; m <= REFOCUS_METHOD_DIFFUSION; m++) {
        settings = good;
        settings.render.method = m;
        settings.render.aperture = aperture;
        refuse(renderer, &settings, "an aperture that is not round");
    }
    refocus_aperture_destroy(&aperture);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Methods of the papers, which a renderer was not given. */
TEST(methods_not_given)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 5);
    struct refocus_settings settings = refocus_settings_default(0.5f, 5);
    struct picture p = picture_make(W, H, 1);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    struct refocus_renderer *renderer;

    limits.threads = 1;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    for (uint32_t m = 0; m < REFOCUS_METHOD_COUNT; m++) {
        settings.render.method = m;
        if (m == REFOCUS_METHOD_LIGHTFIELD || m >= REFOCUS_METHOD_RAYTRACE)
            refuse(renderer, &settings, refocus_method_name(m));
    }
    refocus_renderer_destroy(&renderer);
    limits.methods = REFOCUS_METHOD_BIT(REFOCUS_METHOD_LIGHTFIELD);
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT);
    limits.papers = &(struct refocus_papers){.version = "0.0.1", .frame_size = 1};
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT);
    picture_free(&p);
}

/* Regions that reach over the side. */
TEST(bad_regions)
{
    static const int region[][4] = {{1, 0, W, H},     {0, 1, W, H},
                                    {W, 0, 1, 1},     {0, H, 1, 1},
                                    {0, 0, W + 1, H}, {0, 0, W, H + 1},
                                    {0, 0, 0, H},     {INT32_MAX, 0, W, H},
                                    {-1, 0, W, H},    {5, 5, INT32_MAX, INT32_MAX}};
    struct picture p = picture_make(W, H, 1);
    struct refocus_renderer *renderer = heard(&p);

    for (size_t i = 0; i < sizeof region / sizeof region[0]; i++) {
        struct refocus_settings settings = refocus_settings_default(0.5f, 5);
        char what[64];

        settings.render.region_x = region[i][0], settings.render.region_y = region[i][1];
        settings.render.region_width = region[i][2], settings.render.region_height = region[i][3];
        snprintf(what, sizeof what, "region %d %d %d %d", region[i][0], region[i][1], region[i][2],
                 region[i][3]);
        refuse(renderer, &settings, what);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Pictures in and out. */
TEST(bad_pictures)
{
    const struct bad bad[] = {BAD(refocus_image, format, 0),
                              BAD(refocus_image, format, 99),
                              BAD(refocus_image, width, 0),
                              BAD(refocus_image, width, -W),
                              BAD(refocus_image, height, 0),
                              BAD(refocus_image, height, INT32_MIN),
                              BAD(refocus_image, plane[0], NULL),
                              BAD(refocus_image, stride[0], 3 * W - 1),
                              BAD(refocus_image, stride[0], -(3 * W - 1)),
                              BAD(refocus_image, stride[0], 0)};
    struct picture p = picture_make(W, H, 1);
    struct refocus_renderer *renderer = heard(&p);
    const struct refocus_settings params = refocus_settings_default(0.5f, 5);
    const struct refocus_disparity disparity = picture_disparity(&p);

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct refocus_image image = picture_image(&p);

        spoil(&image, &bad[i]);
        if (refocus_render_settings(renderer, &params, &image) != REFOCUS_ERR_ARGUMENT ||
            !is_named("refocus_render: out->", bad[i].what))
            fail_msg("out: %s is not refused: %s", bad[i].what, said);
    }
    struct refocus_image other = picture_image(&p);
    other.width--;
    assert_int_equal(refocus_render_settings(renderer, &params, &other), REFOCUS_ERR_ARGUMENT);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct refocus_image image = picture_image(&p);

        assert_int_equal(refocus_prepare(renderer, &(struct refocus_image){0}, &disparity),
                         REFOCUS_ERR_ARGUMENT);
        spoil(&image, &bad[i]);
        if (refocus_prepare(renderer, &image, &disparity) != REFOCUS_ERR_ARGUMENT ||
            !is_named("refocus_prepare: photo->", bad[i].what))
            fail_msg("photo: %s is not refused: %s", bad[i].what, said);
        other = picture_image(&p);
        assert_int_equal(refocus_render_settings(renderer, &params, &other), REFOCUS_ERR_STATE);
    }
    assert_int_equal(refocus_prepare(NULL, &other, &disparity), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_prepare(renderer, NULL, &disparity), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_prepare(renderer, &other, NULL), REFOCUS_ERR_ARGUMENT);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

TEST(bad_disparities)
{
    const struct bad bad[] = {
        BAD(refocus_disparity, bits, 0),           BAD(refocus_disparity, bits, 32),
        BAD(refocus_disparity, bits, 12),          BAD(refocus_disparity, width, 0),
        BAD(refocus_disparity, height, -1),        BAD(refocus_disparity, width, 65536),
        BAD(refocus_disparity, samples, NULL),     BAD(refocus_disparity, samples, odd_address()),
        BAD(refocus_disparity, stride, 2 * W - 2), BAD(refocus_disparity, stride, 2 * W + 1)};
    struct picture p = picture_make(W, H, 1);
    const struct refocus_image photo = picture_image(&p);
    struct refocus_renderer *renderer = prepared(&p, 5, 1);

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct refocus_disparity disparity = picture_disparity(&p);

        spoil(&disparity, &bad[i]);
        if (refocus_prepare(renderer, &photo, &disparity) != REFOCUS_ERR_ARGUMENT)
            fail_msg("disparity: %s is not refused", bad[i].what);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Larger than the renderer was made for; nothing prepared yet; views. */
TEST(order_and_size)
{
    struct picture p = picture_make(W, H, 1);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    struct refocus_renderer_params limits = refocus_renderer_params_default(W - 1, H, 5);
    const struct refocus_settings params = refocus_settings_default(0.5f, 5);
    struct refocus_renderer *renderer;
    uint16_t view[W * H];

    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &photo), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, view, 2 * W),
                     REFOCUS_ERR_STATE);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_ERR_SIZE);
    assert_int_equal(refocus_render_settings(renderer, &params, &photo), REFOCUS_ERR_STATE);
    refocus_renderer_destroy(&renderer);

    renderer = prepared(&p, 5, 1);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_BLUR, view, 2 * W), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_get_view(renderer, 2, view, 2 * W), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, NULL, 2 * W),
                     REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, view, 2 * W - 2),
                     REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, view, 2 * W), 0);
    assert_memory_equal(view, p.disparity, sizeof view);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

TEST(bad_apertures)
{
    static const uint8_t closed[4], open[4] = {255, 255, 255, 255};
    struct refocus_aperture *a = (struct refocus_aperture *)closed;
    struct refocus_ray rays[8];

#define REFUSED(call)                                                                              \
    do {                                                                                           \
        assert_int_equal(call, REFOCUS_ERR_ARGUMENT);                                              \
    } while (0)
    REFUSED(refocus_aperture_create_disc(NULL));
    REFUSED(refocus_aperture_create_polygon(&a, 2, 0));
    assert_null(a);
    REFUSED(refocus_aperture_create_polygon(&a, 17, 0));
    REFUSED(refocus_aperture_create_polygon(&a, 6, (double)NAN));
    REFUSED(refocus_aperture_create_polygon(&a, 6, (double)INFINITY));
    REFUSED(refocus_aperture_create_mask(&a, closed, 2, 2, 2));
    REFUSED(refocus_aperture_create_mask(&a, NULL, 2, 2, 2));
    REFUSED(refocus_aperture_create_mask(&a, open, 0, 2, 2));
    REFUSED(refocus_aperture_create_mask(&a, open, 2, -1, 2));
    REFUSED(refocus_aperture_create_mask(&a, open, 256, 1, 256));
    REFUSED(refocus_aperture_create_mask(&a, open, 2, 2, 1));
    assert_null(a);
    assert_int_equal(refocus_aperture_create_disc(&a), REFOCUS_OK);
    REFUSED(refocus_aperture_rays(a, 0, rays));
    REFUSED(refocus_aperture_rays(a, REFOCUS_MAX_RAYS + 1, rays));
    REFUSED(refocus_aperture_rays(a, 8, NULL));
    REFUSED(refocus_aperture_full_rays(a, 0, 8, rays));
    REFUSED(refocus_aperture_full_rays(a, 127.5, 8, rays));
    REFUSED(refocus_aperture_full_rays(a, (double)NAN, 8, rays));
    REFUSED(refocus_aperture_full_rays(a, 5, -1, rays));
    refocus_aperture_destroy(&a);
    assert_null(a);
    refocus_aperture_destroy(&a);
    refocus_aperture_destroy(NULL);
}

/* The list of kernels ends, and nothing is measured for a processor that is none. */
TEST(kernels)
{
    struct refocus_kernel_time time = refocus_kernel_time_default();

    time.name = "untouched";
    assert_int_equal(refocus_measure_kernel(1000, REFOCUS_CPU_C, &time), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_measure_kernel(0, REFOCUS_CPU_COUNT, &time), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_measure_kernel(0, REFOCUS_CPU_C, NULL), REFOCUS_ERR_ARGUMENT);
    assert_string_equal(time.name, "untouched");
    assert_int_equal(refocus_measure_kernel(0, REFOCUS_CPU_C, &time), REFOCUS_OK);
    assert_string_equal(time.name, "sweep");
    assert_true(time.ns > 0 && time.ns_c > 0);
}
