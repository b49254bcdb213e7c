/* misuse_depth.c: misuse of depth maps: reading, repair, upsampling, edges, focus stacks, and the
 * filter over video. */
#include "misuse.h"

static uint16_t out[W * H];

static struct refocus_depth_map depth_map(void)
{
    static uint8_t samples[W * H];
    struct refocus_depth_map map = TAKES_NOTHING(refocus_depth_map_default);

    for (size_t i = 0; i < sizeof samples; i++)
        samples[i] = (uint8_t)(1 + i % 200);
    map.samples = samples;
    map.width = W;
    map.height = H;
    map.stride = W;
    map.sample = REFOCUS_SAMPLE_U8;
    map.meaning = REFOCUS_DEPTH_DISPARITY;
    map.value_near = 255;
    return map;
}

static void use_out_stride(ptrdiff_t stride)
{
    const struct refocus_repair_params repair = refocus_repair_params_default();
    const struct refocus_depth_map map = depth_map();

    REFUSED(refocus_depth_to_disparity, &map, out, stride, NULL);
    REFUSED(refocus_depth_repair, &map, &repair, out, stride, NULL);
}

static void use_confidence_stride(ptrdiff_t stride)
{
    struct refocus_repair_params repair = refocus_repair_params_default();
    struct refocus_upsample_params upsample = refocus_upsample_params_default();
    const struct refocus_depth_map map = depth_map();
    const struct refocus_disparity disparity = misuse_map();
    const struct refocus_image photo = misuse_photo();
    static uint8_t confidence[W * H];

    repair.confidence = confidence;
    repair.confidence_stride = stride;
    REFUSED(refocus_depth_repair, &map, &repair, out, 2 * W, NULL);
    upsample.confidence = confidence;
    upsample.confidence_stride = stride;
    REFUSED(refocus_upsample, &photo, &disparity, &upsample, out, 2 * W);
}

static void bad_depth_maps(void)
{
    const struct misuse bad[] = {BAD(refocus_depth_map, struct_size, 0),
                                 BAD(refocus_depth_map, struct_size, 8),
                                 BAD(refocus_depth_map, struct_size, UINT32_MAX),
                                 BAD(refocus_depth_map, samples, NULL),
                                 BAD(refocus_depth_map, width, 0),
                                 BAD(refocus_depth_map, width, -1),
                                 BAD(refocus_depth_map, width, INT32_MIN),
                                 BAD(refocus_depth_map, width, INT32_MAX),
                                 BAD(refocus_depth_map, height, 0),
                                 BAD(refocus_depth_map, height, INT32_MIN),
                                 BAD(refocus_depth_map, height, INT32_MAX),
                                 BAD(refocus_depth_map, stride, 0),
                                 BAD(refocus_depth_map, stride, 1 - W),
                                 BAD(refocus_depth_map, stride, PTRDIFF_MIN),
                                 BAD(refocus_depth_map, stride, PTRDIFF_MAX),
                                 BAD(refocus_depth_map, stride, PTRDIFF_MIN + 1),
                                 BAD(refocus_depth_map, stride, PTRDIFF_MAX / H + 1),
                                 BAD(refocus_depth_map, sample, 0),
                                 BAD(refocus_depth_map, sample, UINT32_MAX),
                                 BAD(refocus_depth_map, meaning, 0),
                                 BAD(refocus_depth_map, meaning, UINT32_MAX),
                                 BAD(refocus_depth_map, flags, UINT32_MAX),
                                 BAD(refocus_depth_map, value_near, (double)NAN),
                                 BAD(refocus_depth_map, value_far, (double)-INFINITY),
                                 BAD(refocus_depth_map, near_m, -1),
                                 BAD(refocus_depth_map, near_m, (double)NAN),
                                 BAD(refocus_depth_map, far_m, (double)NAN),
                                 BAD(refocus_depth_map, unknown_count, -1),
                                 BAD(refocus_depth_map, unknown_count, INT32_MAX)};
    const struct refocus_repair_params repair = refocus_repair_params_default();
    const struct refocus_depth_map good = depth_map();
    uint32_t flags = REFOCUS_DEPTH_MAX_IS_UNKNOWN;

    REFUSED(refocus_depth_to_disparity, NULL, out, 2 * W, NULL);
    REFUSED(refocus_depth_repair, NULL, &repair, out, 2 * W, NULL);
    REFUSED(refocus_depth_follow_flags, NULL, &flags);
    REFUSED(refocus_depth_follow_flags, &good, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_depth_map map = depth_map();

        misuse_spoil(&map, &bad[i]);
        REFUSED(refocus_depth_to_disparity, &map, out, 2 * W, NULL);
        REFUSED(refocus_depth_repair, &map, &repair, out, 2 * W, NULL);
        REFUSED(refocus_depth_follow_flags, &map, &flags);
        assert_int_equal(flags, REFOCUS_DEPTH_MAX_IS_UNKNOWN);
        map.flags = 0;
        GIVES(0, refocus_depth_is_code, &map, -16);
        GIVES(0, refocus_depth_is_code, &map, (double)NAN);
    }
    misuse_spoil(NULL, NULL);
}

static void repairing(void)
{
    static const uint32_t no_sizes[] = {0, 4, REFOCUS_MAX_STRUCT_SIZE + 1, UINT32_MAX};
    const struct misuse bad[] = {BAD(refocus_repair_params, struct_size, 0),
                                 BAD(refocus_repair_params, speckle, -1),
                                 BAD(refocus_repair_params, speckle, INT32_MIN),
                                 BAD(refocus_repair_params, speckle, INT32_MAX),
                                 BAD(refocus_repair_params, memory, (void *)out)};
    const struct refocus_repair_params good = TAKES_NOTHING(refocus_repair_params_default);
    uint16_t *const odd = (uint16_t *)(void *)((uint8_t *)out + 1);
    const struct refocus_depth_map map = depth_map();
    struct refocus_depth_report report = TAKES_NOTHING(refocus_depth_report_default);

    bad_depth_maps();
    for (size_t i = 0; i < COUNT(no_sizes); i++) {
        report.struct_size = no_sizes[i];
        REFUSED(refocus_depth_to_disparity, &map, out, 2 * W, &report);
        REFUSED(refocus_depth_repair, &map, &good, out, 2 * W, &report);
    }
    GIVES(0, refocus_repair_memory, 0, 1, 0);
    GIVES(0, refocus_repair_memory, 1, INT32_MIN, 0);
    GIVES(0, refocus_repair_memory, REFOCUS_MAX_SIDE + 1, 1, 0);
    GIVES(0, refocus_repair_memory, 1, 1, -1);
    GIVES(0, refocus_repair_memory, 1, 1, REFOCUS_MAX_SPECKLE + 1);
    misuse_strides(use_out_stride, 2 * W);
    misuse_strides(use_confidence_stride, W);
    REFUSED(refocus_depth_to_disparity, &map, NULL, 2 * W, NULL);
    REFUSED(refocus_depth_to_disparity, &map, odd, 2 * W, NULL);
    REFUSED(refocus_depth_to_disparity, &map, out, 2 * W + 1, NULL);
    REFUSED(refocus_depth_repair, &map, &good, NULL, 2 * W, NULL);
    REFUSED(refocus_depth_repair, &map, NULL, out, 2 * W, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_repair_params repair = refocus_repair_params_default();

        misuse_spoil(&repair, &bad[i]);
        REFUSED(refocus_depth_repair, &map, &repair, out, 2 * W, NULL);
    }
    misuse_spoil(NULL, NULL);
}

static void use_photo(const struct refocus_image *photo)
{
    const struct refocus_upsample_params upsample = refocus_upsample_params_default();
    const struct refocus_disparity map = misuse_map();
    struct refocus_repair_params repair = refocus_repair_params_default();
    const struct refocus_depth_map depth = depth_map();

    REFUSED(refocus_upsample, photo, &map, &upsample, out, 2 * W);
    repair.photo = photo;
    if (photo)
        REFUSED(refocus_depth_repair, &depth, &repair, out, 2 * W, NULL);
}

/* Pictures that are good, but not to fill holes by: of Y, U and V, and of 16 bits. */
static void other_photos(void)
{
    static uint8_t pixels[W * H * 6];
    struct refocus_repair_params repair = refocus_repair_params_default();
    const struct refocus_depth_map depth = depth_map();
    struct refocus_image photo = refocus_image_planar(REFOCUS_FORMAT_I420, pixels, W, H);

    repair.photo = &photo;
    REFUSED(refocus_depth_repair, &depth, &repair, out, 2 * W, NULL);
    photo = refocus_image_packed(REFOCUS_FORMAT_RGB16, pixels, W, H, W * 6);
    ANSWERS(REFOCUS_ERR_UNSUPPORTED, refocus_depth_repair, &depth, &repair, out, 2 * W, NULL);
}

static void use_map(const struct refocus_disparity *map)
{
    const struct refocus_upsample_params upsample = refocus_upsample_params_default();
    const struct refocus_image photo = misuse_photo();

    REFUSED(refocus_upsample, &photo, map, &upsample, out, 2 * W);
}

static void use_stride(ptrdiff_t stride)
{
    const struct refocus_upsample_params upsample = refocus_upsample_params_default();
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();

    REFUSED(refocus_upsample, &photo, &map, &upsample, out, stride);
}

static void upsampling(void)
{
    const struct misuse bad_upsample[] = {BAD(refocus_upsample_params, struct_size, 0),
                                          BAD(refocus_upsample_params, threads, -1),
                                          BAD(refocus_upsample_params, threads, INT32_MAX),
                                          BAD(refocus_upsample_params, cpu, UINT32_MAX)};
    const struct refocus_upsample_params upsample = TAKES_NOTHING(refocus_upsample_params_default);
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();

    misuse_images(use_photo);
    other_photos();
    misuse_maps(use_map);
    misuse_strides(use_stride, 2 * W);
    REFUSED(refocus_upsample, &photo, &map, NULL, out, 2 * W);
    REFUSED(refocus_upsample, &photo, &map, &upsample, NULL, 2 * W);
    for (size_t i = 0; i < COUNT(bad_upsample); i++) {
        struct refocus_upsample_params params = upsample;

        misuse_spoil(&params, &bad_upsample[i]);
        REFUSED(refocus_upsample, &photo, &map, &params, out, 2 * W);
    }
    misuse_spoil(NULL, NULL);
}

static struct refocus_depth_edges_report findings;

static void edges_photo(const struct refocus_image *photo)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_disparity map = misuse_map();

    REFUSED(refocus_depth_edges, photo, &map, &params, out, 2 * W, &findings);
}

static void edges_map(const struct refocus_disparity *map)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_image photo = misuse_photo();

    REFUSED(refocus_depth_edges, &photo, map, &params, out, 2 * W, &findings);
}

static void edges_stride(ptrdiff_t stride)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();

    REFUSED(refocus_depth_edges, &photo, &map, &params, out, stride, &findings);
}

/* A field that this library does not know has to be 0. */
static void edges_later_params(void)
{
    struct {
        struct refocus_depth_edges_params params;
        uint32_t later;
    } larger = {.params = refocus_depth_edges_params_default(), .later = 1};
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();

    larger.params.struct_size = sizeof larger;
    ANSWERS(REFOCUS_ERR_UNSUPPORTED, refocus_depth_edges, &photo, &map, &larger.params, out, 2 * W,
            &findings);
}

static void edges_arguments(void)
{
    const struct refocus_depth_edges_params params =
        TAKES_NOTHING(refocus_depth_edges_params_default);
    uint16_t *const odd = (uint16_t *)(void *)((uint8_t *)out + 1);
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();

    misuse_images(edges_photo);
    misuse_maps(edges_map);
    misuse_strides(edges_stride, 2 * W);
    edges_later_params();
    REFUSED(refocus_depth_edges, &photo, &map, NULL, out, 2 * W, &findings);
    REFUSED(refocus_depth_edges, &photo, &map, &params, NULL, 2 * W, &findings);
    REFUSED(refocus_depth_edges, &photo, &map, &params, odd, 2 * W, &findings);
    REFUSED(refocus_depth_edges, &photo, &map, &params, out, 2 * W + 1, &findings);
}

static void placing_edges(void)
{
    static const uint32_t no_sizes[] = {0, 4, offsetof(struct refocus_depth_edges_report, changed),
                                        REFOCUS_MAX_STRUCT_SIZE + 1, UINT32_MAX};
    const struct misuse bad[] = {
        BAD(refocus_depth_edges_params, struct_size, 0),
        BAD(refocus_depth_edges_params, struct_size, sizeof(struct refocus_depth_edges_params) - 4),
        BAD(refocus_depth_edges_params, struct_size, REFOCUS_MAX_STRUCT_SIZE + 1),
        BAD(refocus_depth_edges_params, threads, -1),
        BAD(refocus_depth_edges_params, threads, 65),
        BAD(refocus_depth_edges_params, threads, INT32_MIN),
        BAD(refocus_depth_edges_params, threads, INT32_MAX),
        BAD(refocus_depth_edges_params, cpu, 99),
        BAD(refocus_depth_edges_params, cpu, UINT32_MAX),
        BAD(refocus_depth_edges_params, reserved, 1),
        BAD(refocus_depth_edges_params, reserved, UINT32_MAX)};
    const struct refocus_depth_edges_params good = refocus_depth_edges_params_default();
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();
    struct refocus_depth_edges_report before;

    findings = TAKES_NOTHING(refocus_depth_edges_report_default);
    findings.softness = findings.changed = 77;
    before = findings;
    edges_arguments();
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_depth_edges_params params = good;

        misuse_spoil(&params, &bad[i]);
        REFUSED(refocus_depth_edges, &photo, &map, &params, out, 2 * W, &findings);
    }
    misuse_spoil(NULL, NULL);
    assert_memory_equal(&findings, &before, sizeof before);
    for (size_t i = 0; i < COUNT(no_sizes); i++) {
        findings.struct_size = before.struct_size = no_sizes[i];
        REFUSED(refocus_depth_edges, &photo, &map, &good, out, 2 * W, &findings);
        assert_memory_equal(&findings, &before, sizeof before);
    }
}

static struct refocus_temporal *filter;

static void filter_photo(const struct refocus_image *photo)
{
    const struct refocus_disparity map = misuse_map();

    if (photo) /* there may be none */
        REFUSED(refocus_temporal_run, filter, photo, &map, out, 2 * W);
}

static void filter_map(const struct refocus_disparity *map)
{
    REFUSED(refocus_temporal_run, filter, NULL, map, out, 2 * W);
}

static void filter_stride(ptrdiff_t stride)
{
    const struct refocus_disparity map = misuse_map();

    REFUSED(refocus_temporal_run, filter, NULL, &map, out, stride);
}

static void filtering(void)
{
    const struct misuse bad[] = {BAD(refocus_temporal_params, struct_size, 0),
                                 BAD(refocus_temporal_params, width, 0),
                                 BAD(refocus_temporal_params, width, INT32_MIN),
                                 BAD(refocus_temporal_params, height, INT32_MAX),
                                 BAD(refocus_temporal_params, height, -1),
                                 BAD(refocus_temporal_params, strength, NAN),
                                 BAD(refocus_temporal_params, strength, 1),
                                 BAD(refocus_temporal_params, noise, -1)};
    static const double scales[] = {0, -1, NAN, INFINITY};
    const struct refocus_temporal_params good = RETURNS(refocus_temporal_params_default, W, H);
    const struct refocus_disparity map = misuse_map();

    REFUSED(refocus_temporal_create, NULL, &good);
    REFUSED(refocus_temporal_create, &filter, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_temporal_params params = good;

        misuse_spoil(&params, &bad[i]);
        REFUSED(refocus_temporal_create, &filter, &params);
        assert_null(filter);
    }
    misuse_spoil(NULL, NULL);
    RETURNS(refocus_temporal_reset, NULL);
    RETURNS(refocus_temporal_cancel, NULL);
    RETURNS(refocus_temporal_destroy, NULL);
    RETURNS(refocus_temporal_destroy, &filter);
    REFUSED(refocus_temporal_run, NULL, NULL, &map, out, 2 * W);
    ANSWERS(REFOCUS_OK, refocus_temporal_create, &filter, &good);
    misuse_images(filter_photo);
    misuse_maps(filter_map);
    misuse_strides(filter_stride, 2 * W);
    REFUSED(refocus_temporal_rescale, NULL, 1, 0);
    for (size_t i = 0; i < COUNT(scales); i++)
        REFUSED(refocus_temporal_rescale, filter, scales[i], 0);
    REFUSED(refocus_temporal_rescale, filter, 1, (double)NAN);
    REFUSED(refocus_temporal_rescale, filter, 1, -(double)INFINITY);
    REFUSED(refocus_temporal_run, filter, NULL, &map, NULL, 2 * W);
    REFUSED(refocus_temporal_run, filter, NULL, &map, out, 2 * W + 1);
    refocus_temporal_destroy(&filter);
}

static struct refocus_stack *stack;

static void stack_photo(const struct refocus_image *photo)
{
    REFUSED(refocus_stack_add, stack, photo, 1);
}

/* The stride of one picture of a result. */
static void stack_stride(ptrdiff_t stride)
{
    struct refocus_stack_result result = refocus_stack_result_default();

    result.disparity = out;
    result.disparity_stride = stride;
    REFUSED(refocus_stack_finish, stack, &result);
}

/* The light of a result, which has a photo. */
static void stack_light(const struct refocus_image *light)
{
    static uint8_t rgb[3 * W * 16];
    struct refocus_stack_result result = refocus_stack_result_default();

    result.photo = light ? rgb : NULL;
    result.photo_stride = 3 * W;
    result.light = light;
    if (light)
        REFUSED(refocus_stack_finish, stack, &result);
}

static void stacking(void)
{
    const struct misuse bad[] = {BAD(refocus_stack_params, struct_size, 0),
                                 BAD(refocus_stack_params, width, 15),
                                 BAD(refocus_stack_params, width, INT32_MIN),
                                 BAD(refocus_stack_params, height, INT32_MAX),
                                 BAD(refocus_stack_params, frames, 1),
                                 BAD(refocus_stack_params, frames, 33),
                                 BAD(refocus_stack_params, reference, -1),
                                 BAD(refocus_stack_params, reference, 3),
                                 BAD(refocus_stack_params, align, REFOCUS_STACK_ALIGN_COUNT),
                                 BAD(refocus_stack_params, order, REFOCUS_STACK_ORDER_COUNT),
                                 BAD(refocus_stack_params, threads, -1),
                                 BAD(refocus_stack_params, threads, 65),
                                 BAD(refocus_stack_params, kind, REFOCUS_STACK_KIND_COUNT)};
    const struct refocus_stack_params good = RETURNS(refocus_stack_params_default, W, 16, 2);
    struct refocus_stack_result result = RETURNS(refocus_stack_result_default, );
    static uint8_t pixels[3 * W * 16];
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, 16, 3 * W);

    REFUSED(refocus_stack_create, NULL, &good);
    REFUSED(refocus_stack_create, &stack, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_stack_params params = good;

        misuse_spoil(&params, &bad[i]);
        REFUSED(refocus_stack_create, &stack, &params);
        assert_null(stack);
    }
    misuse_spoil(NULL, NULL);
    RETURNS(refocus_stack_destroy, NULL);
    RETURNS(refocus_stack_destroy, &stack);
    REFUSED(refocus_stack_add, NULL, &photo, 1);
    REFUSED(refocus_stack_finish, NULL, &result);
    ANSWERS(REFOCUS_OK, refocus_stack_create, &stack, &good);
    misuse_images(stack_photo);
    REFUSED(refocus_stack_add, stack, &photo, (double)INFINITY);
    ANSWERS(REFOCUS_ERR_STATE, refocus_stack_finish, stack, &result);
    ANSWERS(REFOCUS_OK, refocus_stack_add, stack, &photo, 1);
    REFUSED(refocus_stack_add, stack, &photo, 1);
    REFUSED(refocus_stack_add, stack, &photo, (double)NAN);
    ANSWERS(REFOCUS_OK, refocus_stack_add, stack, &photo, 2);
    REFUSED(refocus_stack_finish, stack, NULL);
    misuse_strides(stack_stride, 2 * W);
    misuse_images(stack_light);
    stack_light(&photo);
    stack_stride(2 * W + 1);
    result.reserved = 1;
    REFUSED(refocus_stack_finish, stack, &result);
    refocus_stack_destroy(&stack);
}

void misuse_depth(void **state)
{
    (void)state;
    memset(out, 0x5a, sizeof out);
    repairing();
    upsampling();
    placing_edges();
    filtering();
    stacking();
    for (size_t i = 0; i < COUNT(out); i++)
        assert_int_equal(out[i], 0x5a5a);
    misuse_done();
}
