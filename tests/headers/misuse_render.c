/* misuse_render.c: misuse of the renderer. tests/render/test_arguments.c has the ranges of all
 * its parameters. */
#include "misuse.h"

static struct refocus_renderer *renderer;

static void prepare_photo(const struct refocus_image *photo)
{
    const struct refocus_disparity map = misuse_map();

    const struct refocus_scene scene = refocus_scene_default(photo, &map);

    REFUSED(refocus_prepare, renderer, photo, &map);
    REFUSED(refocus_prepare_scene, renderer, &scene);
}

static void prepare_map(const struct refocus_disparity *map)
{
    const struct refocus_image photo = misuse_photo();

    const struct refocus_disparity good = misuse_map();
    struct refocus_scene scene = refocus_scene_default(&photo, map);

    REFUSED(refocus_prepare, renderer, &photo, map);
    REFUSED(refocus_prepare_scene, renderer, &scene);
    scene.disparity = &good;
    scene.matte = map; /* NULL is none */
    if (map)
        REFUSED(refocus_prepare_scene, renderer, &scene);
}

static void prepare_scene(void)
{
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();
    const struct misuse bad[] = {BAD(refocus_scene, struct_size, 0),
                                 BAD(refocus_scene, struct_size, UINT32_MAX),
                                 BAD(refocus_scene, depth_edges, 1),
                                 BAD(refocus_scene, depth_edges, UINT32_MAX),
                                 BAD(refocus_scene, confidence_stride, W - 1),
                                 BAD(refocus_scene, confidence_stride, PTRDIFF_MIN),
                                 BAD(refocus_scene, confidence_stride, PTRDIFF_MAX)};
    static const uint8_t confidence[W * H];
    const struct refocus_render_params params = refocus_render_params_default(0.5f, 5);
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();
    struct refocus_scene good = RETURNS(refocus_scene_default, &photo, &map);

    good.confidence = confidence;
    good.confidence_stride = -W;
    good.confidence += (H - 1) * W;
    REFUSED(refocus_prepare_scene, NULL, &good);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_scene scene = good;

        ANSWERS(REFOCUS_OK, refocus_prepare_scene, renderer, &good);
        misuse_spoil(&scene, &bad[i]);
        REFUSED(refocus_prepare_scene, renderer, &scene);
        ANSWERS(REFOCUS_ERR_STATE, refocus_render, renderer, &params, &photo);
    }
    misuse_spoil(NULL, NULL);
    REFUSED(refocus_prepare_scene, renderer, NULL);
    ANSWERS(REFOCUS_ERR_STATE, refocus_get_depth_edges, renderer, &report);
    ANSWERS(REFOCUS_OK, refocus_prepare_scene, renderer, &good);
    ANSWERS(REFOCUS_OK, refocus_get_depth_edges, renderer, &report);
    REFUSED(refocus_get_depth_edges, renderer, NULL);
    REFUSED(refocus_get_depth_edges, NULL, &report);
    report.struct_size = 0;
    REFUSED(refocus_get_depth_edges, renderer, &report);
}

static void prepare_behind(const struct refocus_image *behind)
{
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();
    struct refocus_scene scene = refocus_scene_default(&photo, &map);

    scene.behind = behind;
    scene.behind_disparity = &map;
    REFUSED(refocus_prepare_scene, renderer, &scene);
}

static void prepare_behind_map(const struct refocus_disparity *map)
{
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity own = misuse_map();
    struct refocus_scene scene = refocus_scene_default(&photo, &own);

    scene.behind = &photo;
    scene.behind_disparity = map;
    REFUSED(refocus_prepare_scene, renderer, &scene);
}

static void render_out(const struct refocus_image *out)
{
    const struct refocus_render_params params = refocus_render_params_default(0.5f, 5);

    REFUSED(refocus_render, renderer, &params, out);
}

static void render_map(const struct refocus_disparity *map)
{
    const struct refocus_image out = misuse_photo();

    for (int i = 0; map && i < 3; i++) {
        struct refocus_render_params params = refocus_render_params_default(0.5f, 5);

        struct refocus_focus_params focus = refocus_focus_params_default();
        struct refocus_field_params field = refocus_field_params_default(0.5f);

        *(i == 0 ? &field.map : i == 1 ? &focus.map : &focus.sharp_map) = map;
        params.focus = &focus;
        params.field = &field;
        REFUSED(refocus_render, renderer, &params, &out);
    }
}

static void view_stride(ptrdiff_t stride)
{
    static uint16_t view[W * H];

    REFUSED(refocus_get_view, renderer, REFOCUS_VIEW_DISPARITY, view, stride);
}

/* Pictures of Y, U and V: each plane counts. */
static void bad_planes(void)
{
    const struct misuse bad[] = {
        BAD(refocus_image, plane[0], NULL),         BAD(refocus_image, plane[1], NULL),
        BAD(refocus_image, plane[2], NULL),         BAD(refocus_image, stride[0], PTRDIFF_MIN),
        BAD(refocus_image, stride[1], PTRDIFF_MIN), BAD(refocus_image, stride[2], PTRDIFF_MIN),
        BAD(refocus_image, stride[0], PTRDIFF_MAX), BAD(refocus_image, stride[1], PTRDIFF_MAX),
        BAD(refocus_image, stride[2], PTRDIFF_MAX), BAD(refocus_image, stride[1], 0),
        BAD(refocus_image, matrix, UINT32_MAX),     BAD(refocus_image, range, UINT32_MAX),
        BAD(refocus_image, width, INT32_MAX),       BAD(refocus_image, height, INT32_MIN),
        BAD(refocus_image, transfer, UINT32_MAX),   BAD(refocus_image, gamma, NAN),
        BAD(refocus_image, white, -INFINITY),       BAD(refocus_image, reserved, 1)};
    static uint8_t memory[2 * W * H];

    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_image image = refocus_image_planar(REFOCUS_FORMAT_I420, memory, W, H);

        misuse_spoil(&image, &bad[i]);
        prepare_photo(&image);
    }
    misuse_spoil(NULL, NULL);
}

static void creating(void)
{
    const struct misuse bad[] = {BAD(refocus_renderer_params, struct_size, 0),
                                 BAD(refocus_renderer_params, max_width, 0),
                                 BAD(refocus_renderer_params, max_width, INT32_MIN),
                                 BAD(refocus_renderer_params, max_height, -1),
                                 BAD(refocus_renderer_params, max_height, INT32_MAX),
                                 BAD(refocus_renderer_params, max_blur_radius, NAN),
                                 BAD(refocus_renderer_params, max_blur_radius, -INFINITY),
                                 BAD(refocus_renderer_params, threads, INT32_MIN),
                                 BAD(refocus_renderer_params, threads, INT32_MAX),
                                 BAD(refocus_renderer_params, cpu, UINT32_MAX),
                                 BAD(refocus_renderer_params, depth_edges, 3),
                                 BAD(refocus_renderer_params, behind, 2),
                                 BAD(refocus_renderer_params, textured, 2),
                                 BAD(refocus_renderer_params, highlights, 2),
                                 BAD(refocus_renderer_params, deep, 2),
                                 BAD(refocus_renderer_params, reserved2, 1),
                                 BAD(refocus_renderer_params, methods, UINT32_MAX)};
    const struct refocus_renderer_params good = RETURNS(refocus_renderer_params_default, W, H, 5);
    struct refocus_renderer_params most = refocus_renderer_params_default(
        REFOCUS_MAX_SIDE, REFOCUS_MAX_SIDE, REFOCUS_MAX_BLUR_RADIUS);

    GIVES(0, refocus_renderer_memory, NULL);
    REFUSED(refocus_renderer_create, NULL, &good);
    REFUSED(refocus_renderer_create, &renderer, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_renderer_params params = good;

        misuse_spoil(&params, &bad[i]);
        GIVES(0, refocus_renderer_memory, &params);
        REFUSED(refocus_renderer_create, &renderer, &params);
        assert_null(renderer);
    }
    misuse_spoil(NULL, NULL);
    most.papers = refocus_papers();
    most.methods = REFOCUS_METHODS_ALL;
    most.max_memory = 1;
    ANSWERS(REFOCUS_ERR_SIZE, refocus_renderer_create, &renderer, &most);
}

static void without_renderer(void)
{
    const struct refocus_render_params params = RETURNS(refocus_render_params_default, 0.5f, 5);
    const struct refocus_settings settings = RETURNS(refocus_settings_default, 0.5f, 5);
    static const float blurs[] = {NAN, -INFINITY, 0, 20, 30, 40, INFINITY};
    static const int32_t rays[] = {64, 256, 64, 64, 144, 256, 256};
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();
    struct refocus_renderer_info info = TAKES_NOTHING(refocus_renderer_info_default);
    uint16_t view[W * H];

    REFUSED(refocus_prepare, NULL, &photo, &map);
    for (size_t i = 0; i < sizeof blurs / sizeof *blurs; i++)
        assert_int_equal(RETURNS(refocus_still_rays, blurs[i]), rays[i]);
    TAKES_NOTHING(refocus_highlight_params_default);
    TAKES_NOTHING(refocus_thin_params_default);
    TAKES_NOTHING(refocus_look_params_default);
    TAKES_NOTHING(refocus_focus_params_default);
    RETURNS(refocus_field_params_default, NAN);
    TAKES_NOTHING(refocus_search_params_default);
    TAKES_NOTHING(refocus_jittered_params_default);
    TAKES_NOTHING(refocus_scatter_params_default);
    TAKES_NOTHING(refocus_interpolated_params_default);
    TAKES_NOTHING(refocus_foveated_params_default);
    TAKES_NOTHING(refocus_diffusion_params_default);
    REFUSED(refocus_render, NULL, &params, &photo);
    REFUSED(refocus_render_settings, NULL, &settings, &photo);
    REFUSED(refocus_render_settings, NULL, NULL, &photo);
    REFUSED(refocus_get_view, NULL, REFOCUS_VIEW_DISPARITY, view, 2 * W);
    RETURNS(refocus_cancel, NULL);
    info.threads = 7;
    info.struct_size = 0; /* out of its range: it is left alone */
    RETURNS(refocus_renderer_get_info, NULL, &info);
    assert_int_equal(info.threads, 7);
    info.struct_size = sizeof info;
    RETURNS(refocus_renderer_get_info, NULL, &info);
    assert_int_equal(info.threads, 0);
    assert_int_equal(info.cpu, 0);
    assert_int_equal(info.memory, 0);
    RETURNS(refocus_renderer_get_info, NULL, NULL);
    RETURNS(refocus_renderer_destroy, NULL);
    renderer = NULL;
    RETURNS(refocus_renderer_destroy, &renderer);
}

/* A single row is one whatever its stride, but for what has no opposite. */
static void one_row(void)
{
    struct refocus_image photo = misuse_photo();
    struct refocus_disparity map = misuse_map();
    const struct refocus_render_params params = refocus_render_params_default(0.5f, 5);

    photo.height = map.height = 1;
    photo.stride[0] = PTRDIFF_MIN;
    REFUSED(refocus_prepare, renderer, &photo, &map);
    photo.stride[0] = PTRDIFF_MAX;
    map.stride = PTRDIFF_MAX - 1;
    ANSWERS(REFOCUS_OK, refocus_prepare, renderer, &photo, &map);
    ANSWERS(REFOCUS_OK, refocus_render, renderer, &params, &photo);
    map.stride = -PTRDIFF_MAX + 1;
    photo.stride[0] = -PTRDIFF_MAX;
    ANSWERS(REFOCUS_OK, refocus_prepare, renderer, &photo, &map);
    ANSWERS(REFOCUS_OK, refocus_render, renderer, &params, &photo);
}

void misuse_render(void **state)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 5);
    const struct refocus_render_params params = refocus_render_params_default(0.5f, 5);
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();
    uint16_t view[W * H + 1];

    (void)state;
    creating();
    without_renderer();
    limits.threads = limits.thin = 1;
    ANSWERS(REFOCUS_OK, refocus_renderer_create, &renderer, &limits);
    RETURNS(refocus_renderer_get_info, renderer, NULL);
    ANSWERS(REFOCUS_ERR_STATE, refocus_render, renderer, &params, &photo);
    ANSWERS(REFOCUS_ERR_STATE, refocus_get_view, renderer, REFOCUS_VIEW_DISPARITY, view, 2 * W);
    misuse_images(prepare_photo);
    misuse_maps(prepare_map);
    prepare_scene();
    misuse_images(prepare_behind);
    misuse_maps(prepare_behind_map);
    bad_planes();
    one_row();
    ANSWERS(REFOCUS_OK, refocus_prepare, renderer, &photo, &map);
    misuse_images(render_out);
    misuse_maps(render_map);
    REFUSED(refocus_render, renderer, NULL, &photo);
    misuse_strides(view_stride, 2 * W);
    REFUSED(refocus_get_view, renderer, UINT32_MAX, view, 2 * W);
    REFUSED(refocus_get_view, renderer, REFOCUS_VIEW_DISPARITY, NULL, 2 * W);
    REFUSED(refocus_get_view, renderer, REFOCUS_VIEW_DISPARITY,
            (uint16_t *)(void *)((uint8_t *)view + 1), 2 * W);
    ANSWERS(REFOCUS_ERR_STATE, refocus_get_view, renderer, REFOCUS_VIEW_BLUR, view, 2 * W);
    refocus_renderer_destroy(&renderer);
    misuse_done();
}
