/* misuse_core.c: misuse of pictures, lenses, apertures, focus and the rest that needs no
 * renderer. */
#include "misuse.h"

static void pictures(void)
{
    static const int32_t sides[] = {0, -1, INT32_MIN, INT32_MAX, REFOCUS_MAX_SIDE + 1};
    static uint8_t memory[4];

    GIVES(0, refocus_format_bytes, 0);
    GIVES(0, refocus_format_bytes, UINT32_MAX);
    GIVES(0, refocus_format_is_yuv, UINT32_MAX);
    GIVES(0, refocus_format_planes, UINT32_MAX);
    GIVES(0, refocus_plane_row_bytes, UINT32_MAX, 0, W);
    GIVES(0, refocus_plane_row_bytes, REFOCUS_FORMAT_RGB8, -1, W);
    GIVES(0, refocus_plane_row_bytes, REFOCUS_FORMAT_RGB8, INT32_MAX, W);
    GIVES(0, refocus_plane_rows, UINT32_MAX, 0, H);
    GIVES(0, refocus_plane_rows, REFOCUS_FORMAT_RGB8, INT32_MIN, H);
    GIVES(0, refocus_image_bytes, UINT32_MAX, W, H);
    for (size_t i = 0; i < COUNT(sides); i++) {
        for (uint32_t format = REFOCUS_FORMAT_RGB8; format <= REFOCUS_FORMAT_P016; format++) {
            struct refocus_image image;

            GIVES(0, refocus_plane_row_bytes, format, 0, sides[i]);
            GIVES(0, refocus_plane_rows, format, 0, sides[i]);
            GIVES(0, refocus_image_bytes, format, sides[i], H);
            GIVES(0, refocus_image_bytes, format, sides[i], sides[i]);
            image = RETURNS(refocus_image_planar, format, memory, sides[i], sides[i]);
            assert_int_equal(image.width, sides[i]);
            image = refocus_image_planar(format, NULL, W, H);
            assert_null(image.plane[0]);
            assert_null(image.plane[1]);
            assert_true(image.stride[0] >= W);
        }
    }
    assert_null(RETURNS(refocus_image_packed, 0, NULL, -1, -1, PTRDIFF_MIN).plane[0]);
    assert_null(RETURNS(refocus_disparity16, NULL, -1, -1, PTRDIFF_MIN).samples);
    assert_null(RETURNS(refocus_disparity8, NULL, -1, -1, PTRDIFF_MIN).samples);
}

static void sizes(void)
{
    uint32_t own[2] = {7, 7}, given[3] = {sizeof given, 1, 0};

    REFUSED(refocus_image_read, NULL, NULL);
    REFUSED(refocus_disparity_read, NULL, NULL);
    REFUSED(refocus_struct_read, NULL, sizeof own, sizeof own, given);
    REFUSED(refocus_struct_read, own, sizeof own, sizeof own, NULL);
    REFUSED(refocus_struct_read, own, 4, 8, given);
    REFUSED(refocus_struct_read, own, sizeof own, 0, given);
    REFUSED(refocus_struct_write, NULL, 4, own, sizeof own);
    REFUSED(refocus_struct_write, given, 4, NULL, sizeof own);
    REFUSED(refocus_struct_write, given, 8, own, 4);
    given[2] = 1;
    ANSWERS(REFOCUS_ERR_UNSUPPORTED, refocus_struct_read, own, sizeof own, sizeof own, given);
    given[0] = 4;
    REFUSED(refocus_struct_read, own, sizeof own, sizeof own, given);
    REFUSED(refocus_struct_write, given, sizeof own, own, sizeof own);
    given[0] = REFOCUS_MAX_STRUCT_SIZE + 1;
    REFUSED(refocus_struct_read, own, sizeof own, sizeof own, given);
    assert_true(own[0] == 7 && own[1] == 7);
}

static void words(void)
{
    assert_non_null(TAKES_NOTHING(refocus_version));
    assert_non_null(TAKES_NOTHING(refocus_papers));
    GIVES_POINTER(refocus_strerror, INT32_MIN);
    GIVES_POINTER(refocus_strerror, INT32_MAX);
    GIVES_NULL(refocus_method_name, REFOCUS_METHOD_COUNT);
    GIVES_NULL(refocus_method_name, UINT32_MAX);
    GIVES_NULL(refocus_method_summary, REFOCUS_METHOD_COUNT);
    GIVES_NULL(refocus_method_summary, UINT32_MAX);
    GIVES(0, refocus_method_traits, REFOCUS_METHOD_COUNT);
    GIVES(0, refocus_method_traits, UINT32_MAX);
    GIVES_NULL(refocus_cpu_name, UINT32_MAX);
}

static void lenses(void)
{
    static const double bad[] = {0, -1, (double)NAN, (double)INFINITY, (double)-INFINITY};
    const struct refocus_depth_range range = {1, 9};
    const struct refocus_lens lens = {50, 2, 36};

    GIVES((double)NAN, refocus_aperture_radius_m, NULL);
    GIVES((double)NAN, refocus_focal_length_px, NULL, 100);
    GIVES((double)NAN, refocus_disparity_of_depth, NULL, 2);
    GIVES((double)NAN, refocus_depth_of_disparity, NULL, 0.5);
    GIVES((double)NAN, refocus_max_blur_radius, NULL, &range, 100);
    GIVES((double)NAN, refocus_max_blur_radius, &lens, NULL, 100);
    GIVES((double)NAN, refocus_f_number_of_blur, NULL, &range, 100, 5);
    GIVES((double)NAN, refocus_f_number_of_blur, &lens, NULL, 100, 5);
    GIVES((double)NAN, refocus_circle_of_confusion_m, NULL, 2, 3);
    GIVES((double)NAN, refocus_hyperfocal_m, NULL, 1000);
    for (size_t i = 0; i < COUNT(bad); i++) {
        const struct refocus_lens bad_lens = {50, bad[i], 36};
        const struct refocus_depth_range bad_range = {bad[i], 9};

        GIVES((double)NAN, refocus_aperture_radius_m, &bad_lens);
        GIVES((double)NAN, refocus_focal_length_px, &lens, bad[i]);
        GIVES((double)NAN, refocus_disparity_of_depth, &bad_range, 2);
        GIVES((double)NAN, refocus_depth_of_disparity, &bad_range, 0.5);
        GIVES((double)NAN, refocus_max_blur_radius, &bad_lens, &range, 100);
        GIVES((double)NAN, refocus_f_number_of_blur, &lens, &range, 100, bad[i]);
        GIVES((double)NAN, refocus_circle_of_confusion_m, &bad_lens, 2, 3);
        GIVES((double)NAN, refocus_hyperfocal_m, &lens, bad[i]);
        assert_true(isnan(RETURNS(refocus_depth_of_field_m, 2, bad[i]).near_m));
    }
    GIVES((double)NAN, refocus_blur_radius, -1, 0, 1);
    GIVES((double)NAN, refocus_blur_radius, 5, (double)NAN, 1);
}

static void use_mask_stride(ptrdiff_t stride)
{
    static const uint8_t mask[W * H] = {255};
    struct refocus_aperture_params params = refocus_aperture_params_default();
    struct refocus_aperture *aperture;

    REFUSED(refocus_aperture_create_mask, &aperture, mask, W, H, stride);
    params.mask = mask;
    params.mask_width = W;
    params.mask_height = H;
    params.mask_stride = stride;
    REFUSED(refocus_aperture_create, &aperture, &params);
}

static void apertures(void)
{
    static const int sides[] = {0, -1, INT32_MIN, INT32_MAX, REFOCUS_MAX_APERTURE_SIDE + 1};
    static const double bad[] = {(double)NAN, (double)INFINITY, -1, 0, 128};
    static const uint8_t mask[W * H] = {255}, shut[W * H];
    const struct misuse spoiled[] = {
        BAD(refocus_aperture_params, struct_size, 0),
        BAD(refocus_aperture_params, blades, -1),
        BAD(refocus_aperture_params, blades, INT32_MAX),
        BAD(refocus_aperture_params, rotation_deg, (double)NAN),
        BAD(refocus_aperture_params, squeeze, 0),
        BAD(refocus_aperture_params, hole, 1),
        BAD(refocus_aperture_params, figure, UINT32_MAX),
        BAD(refocus_aperture_params, mask, mask)}; /* a mask of no size */
    const struct refocus_aperture_params good = refocus_aperture_params_default();
    struct refocus_aperture *aperture = NULL;
    struct refocus_ray ray[1];

    REFUSED(refocus_aperture_create_disc, NULL);
    REFUSED(refocus_aperture_create_polygon, NULL, 6, 0);
    REFUSED(refocus_aperture_create_polygon, &aperture, 2, 0);
    REFUSED(refocus_aperture_create_polygon, &aperture, INT32_MIN, 0);
    REFUSED(refocus_aperture_create_polygon, &aperture, INT32_MAX, 0);
    REFUSED(refocus_aperture_create_polygon, &aperture, 6, (double)NAN);
    REFUSED(refocus_aperture_create_mask, NULL, mask, W, H, W);
    REFUSED(refocus_aperture_create_mask, &aperture, NULL, W, H, W);
    REFUSED(refocus_aperture_create_mask, &aperture, shut, W, H, W);
    REFUSED(refocus_aperture_create, NULL, &good);
    REFUSED(refocus_aperture_create, &aperture, NULL);
    for (size_t i = 0; i < COUNT(sides); i++) {
        REFUSED(refocus_aperture_create_mask, &aperture, mask, sides[i], H, W);
        REFUSED(refocus_aperture_create_mask, &aperture, mask, W, sides[i], W);
    }
    misuse_strides(use_mask_stride, W);
    for (size_t i = 0; i < COUNT(spoiled); i++) {
        struct refocus_aperture_params params = TAKES_NOTHING(refocus_aperture_params_default);

        misuse_spoil(&params, &spoiled[i]);
        REFUSED(refocus_aperture_create, &aperture, &params);
        assert_null(aperture);
    }
    misuse_spoil(NULL, NULL);
    RETURNS(refocus_aperture_destroy, NULL);
    RETURNS(refocus_aperture_destroy, &aperture);
    REFUSED(refocus_aperture_rays, NULL, 1, NULL);
    REFUSED(refocus_aperture_rays, NULL, 0, ray);
    REFUSED(refocus_aperture_rays, NULL, INT32_MIN, ray);
    REFUSED(refocus_aperture_rays, NULL, INT32_MAX, ray);
    REFUSED(refocus_aperture_full_rays, NULL, 5, 1, NULL);
    REFUSED(refocus_aperture_full_rays, NULL, 5, INT32_MIN, ray);
    for (size_t i = 0; i < COUNT(bad); i++)
        REFUSED(refocus_aperture_full_rays, NULL, bad[i], 1, ray);
}

static float focus;

static void use_focus_map(const struct refocus_disparity *map)
{
    REFUSED(refocus_focus_at_point, map, 0, 0, 0, &focus);
    REFUSED(refocus_focus_in_rectangle, map, 0, 0, 1, 1, &focus);
}

static void focussing(void)
{
    static const int places[][2] = {
        {-1, 0}, {0, -1}, {W, 0}, {0, H}, {INT32_MIN, INT32_MIN}, {INT32_MAX, INT32_MAX}};
    static const int sizes[][2] = {{0, 1},
                                   {1, 0},
                                   {-1, 1},
                                   {W + 1, 1},
                                   {1, H + 1},
                                   {INT32_MIN, INT32_MIN},
                                   {INT32_MAX, INT32_MAX}};
    const struct refocus_focus_point line[3] = {{0, 0, 0}, {0.5f, 0.5f, 0}, {1, 1, 0}};
    const struct refocus_focus_point bad[3] = {{0, 0, 0}, {NAN, 1, 0}, {1, 0, INFINITY}};
    const struct refocus_disparity map = misuse_map();
    struct refocus_focus_plane plane;

    misuse_maps(use_focus_map);
    for (size_t i = 0; i < COUNT(places); i++) {
        REFUSED(refocus_focus_at_point, &map, places[i][0], places[i][1], 0, &focus);
        REFUSED(refocus_focus_in_rectangle, &map, places[i][0], places[i][1], 1, 1, &focus);
    }
    for (size_t i = 0; i < COUNT(sizes); i++)
        REFUSED(refocus_focus_in_rectangle, &map, 0, 0, sizes[i][0], sizes[i][1], &focus);
    REFUSED(refocus_focus_in_rectangle, &map, W - 1, H - 1, INT32_MAX, INT32_MAX, &focus);
    REFUSED(refocus_focus_in_rectangle, &map, 0, 0, 1, 1, NULL);
    REFUSED(refocus_focus_at_point, &map, 0, 0, 0, NULL);
    REFUSED(refocus_focus_at_point, &map, 0, 0, -1, &focus);
    REFUSED(refocus_focus_at_point, &map, 0, 0, INT32_MIN, &focus);
    REFUSED(refocus_focus_at_point, &map, 0, 0, INT32_MAX, &focus);
    REFUSED(refocus_focus_plane_of_points, NULL, line);
    REFUSED(refocus_focus_plane_of_points, &plane, NULL);
    REFUSED(refocus_focus_plane_of_points, &plane, line);
    REFUSED(refocus_focus_plane_of_points, &plane, bad);
    REFUSED(refocus_focus_plane_of_line, NULL, &line[0], &line[1], 1, 0);
    REFUSED(refocus_focus_plane_of_line, &plane, NULL, &line[1], 1, 0);
    REFUSED(refocus_focus_plane_of_line, &plane, &line[0], NULL, 1, 0);
    REFUSED(refocus_focus_plane_of_line, &plane, &line[0], &line[0], 1, 0);
    REFUSED(refocus_focus_plane_of_line, &plane, &line[0], &bad[1], 1, 0);
    REFUSED(refocus_focus_plane_of_line, &plane, &line[0], &line[1], 0, 0);
    REFUSED(refocus_focus_plane_of_line, &plane, &line[0], &line[1], (double)NAN, 0);
    REFUSED(refocus_focus_plane_of_line, &plane, &line[0], &line[1], 1, 90);
}

static void measuring(void)
{
    struct refocus_kernel_time time = TAKES_NOTHING(refocus_kernel_time_default);

    REFUSED(refocus_measure_kernel, UINT32_MAX, REFOCUS_CPU_C, &time);
    REFUSED(refocus_measure_kernel, 0, UINT32_MAX, &time);
    REFUSED(refocus_measure_kernel, 0, REFOCUS_CPU_C, NULL);
    time.struct_size = 4;
    REFUSED(refocus_measure_kernel, 0, REFOCUS_CPU_C, &time);
    time.struct_size = UINT32_MAX;
    REFUSED(refocus_measure_kernel, 0, REFOCUS_CPU_C, &time);
}

void misuse_core(void **state)
{
    (void)state;
    pictures();
    sizes();
    words();
    lenses();
    apertures();
    focussing();
    measuring();
    misuse_done();
}
