/* misuse_files.c: misuse of files. Nothing that is refused leaves one behind. */
#include "misuse.h"

#include <unistd.h>

#include <refocus/platform/file.h>

#define NAME     "misuse-of-files.ppm"
#define MAP_NAME "misuse-of-files.pgm"

static void write_image(const struct refocus_image *image)
{
    REFUSED(refocus_image_write, NAME, image, NULL, NULL);
}

static void write_gray(ptrdiff_t stride)
{
    static const uint16_t samples[W * H];

    REFUSED(refocus_gray16_write, MAP_NAME, samples, W, H, stride, NULL);
}

static void reading(void)
{
    static const uint8_t bytes[4] = {'P', '6', ' ', '1'};
    const struct refocus_read_limits tiny = {
        .struct_size = sizeof tiny, .max_pixels = 1, .max_bytes = 1};
    const struct refocus_read_limits sizeless = {.max_pixels = 1};
    const struct refocus_read_limits any = TAKES_NOTHING(refocus_read_limits_default);
    struct refocus_photo *photo = NULL;
    struct refocus_light *light = NULL;
    struct refocus_blob blob;
    struct refocus_reason reason;

    REFUSED(refocus_photo_read, NULL, NAME, NULL, NULL);
    REFUSED(refocus_photo_read, &photo, NULL, NULL, &reason);
    REFUSED(refocus_photo_read_first, NULL, NAME, NULL, NULL);
    REFUSED(refocus_photo_read_first, &photo, NULL, NULL, NULL);
    REFUSED(refocus_photo_read_second, NULL, NAME, NULL, NULL);
    REFUSED(refocus_photo_read_second, &photo, NULL, NULL, NULL);
    REFUSED(refocus_photo_read_memory, NULL, bytes, sizeof bytes, NULL, NULL);
    REFUSED(refocus_photo_read_memory, &photo, NULL, 4, NULL, NULL);
    REFUSED(refocus_photo_read_memory, &photo, NULL, SIZE_MAX, NULL, NULL);
    REFUSED(refocus_photo_read, &photo, NAME, &sizeless, NULL);
    REFUSED(refocus_photo_read_memory, &photo, bytes, sizeof bytes, &sizeless, NULL);
    ANSWERS(REFOCUS_ERR_FORMAT, refocus_photo_read_memory, &photo, NULL, 0, NULL, NULL);
    ANSWERS(REFOCUS_ERR_FORMAT, refocus_photo_read_memory, &photo, bytes, sizeof bytes, NULL, NULL);
    ANSWERS(REFOCUS_ERR_FORMAT, refocus_photo_read_memory, &photo, bytes, sizeof bytes, &any, NULL);
    ANSWERS(REFOCUS_ERR_IO, refocus_photo_read, &photo, "", NULL, NULL);
    ANSWERS(REFOCUS_ERR_SIZE, refocus_photo_read, &photo, "/proc/self/maps", &tiny, NULL);
    assert_null(photo);
    RETURNS(refocus_photo_free, NULL);
    RETURNS(refocus_photo_free, &photo);
    REFUSED(refocus_light_create, NULL, NULL);
    REFUSED(refocus_light_create, &light, NULL);
    assert_null(light);
    GIVES_NULL(refocus_light_image, NULL);
    REFUSED(refocus_light_to_base, NULL, NULL, 0, 0, 0, NULL);
    RETURNS(refocus_light_destroy, NULL);
    RETURNS(refocus_light_destroy, &light);

    REFUSED(refocus_depth_read, NULL, MAP_NAME, NULL, 0, 0, NULL, NULL);
    REFUSED(refocus_depth_read, &photo, NULL, NULL, 0, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, NULL, bytes, sizeof bytes, NULL, 0, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, &photo, NULL, 4, NULL, 0, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, &photo, bytes, 4, "", 0, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, &photo, bytes, 4, "/m", 0, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, &photo, bytes, 4, NULL, -1, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, &photo, bytes, 4, NULL, (double)NAN, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, &photo, bytes, 4, NULL, (double)INFINITY, 0, NULL, NULL);
    REFUSED(refocus_depth_read_memory, &photo, bytes, 4, NULL, 2, 1, NULL, NULL);
    assert_null(photo);

    REFUSED(refocus_file_read, NULL, 10, &blob, NULL);
    REFUSED(refocus_file_read, NAME, 10, NULL, NULL);
    ANSWERS(REFOCUS_ERR_SIZE, refocus_file_read, "/proc/self/maps", 0, &blob, NULL);
    assert_non_null(TAKES_NOTHING(refocus_file_formats));
    GIVES_NULL(refocus_file_ending, 0, -1);
    GIVES_NULL(refocus_file_ending, 1, INT32_MAX);
}

static void units(void)
{
    const struct misuse bad[] = {
        BAD(refocus_depth_map, struct_size, 0),      BAD(refocus_depth_map, width, 0),
        BAD(refocus_depth_map, width, INT32_MAX),    BAD(refocus_depth_map, height, INT32_MIN),
        BAD(refocus_depth_map, height, INT32_MAX),   BAD(refocus_depth_map, stride, 0),
        BAD(refocus_depth_map, stride, PTRDIFF_MIN), BAD(refocus_depth_map, stride, PTRDIFF_MAX)};
    static const float samples[W * H];
    struct refocus_depth_map map = refocus_depth_map_default();

    REFUSED(refocus_depth_set_unit, NULL, "mm");
    REFUSED(refocus_depth_set_unit, &map, NULL);
    REFUSED(refocus_depth_set_unit, &map, "");
    REFUSED(refocus_depth_set_unit, &map, "-1/m");
    REFUSED(refocus_depth_set_invalid, NULL, "max");
    REFUSED(refocus_depth_set_invalid, &map, "zero,x");
    assert_int_equal(map.flags, 0);
    for (size_t i = 0; i < COUNT(bad); i++) {
        map.samples = samples;
        map.width = W;
        map.height = H;
        map.stride = 4 * W;
        map.sample = REFOCUS_SAMPLE_F32;
        misuse_spoil(&map, &bad[i]);
        REFUSED(refocus_depth_set_unit, &map, "inverse");
    }
    misuse_spoil(NULL, NULL);
}

static void writing(void)
{
    static const int sides[] = {0, -1, INT32_MIN, INT32_MAX, REFOCUS_MAX_SIDE + 1};
    static const uint16_t samples[W * H];
    const struct refocus_image photo = misuse_photo();
    const struct refocus_blob nothing = {NULL, 100};
    const struct refocus_write_options bad[] = {
        {.struct_size = sizeof bad[0], .quality = -1},
        {.struct_size = sizeof bad[0], .quality = 101},
        {.struct_size = sizeof bad[0], .quality = INT32_MIN},
        {.struct_size = 0},
        {.struct_size = 3}};
    const struct refocus_image light[] = {
        photo,
        {.struct_size = 3},
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, NULL, W, H, 6 * W)};
    struct refocus_write_options empty = TAKES_NOTHING(refocus_write_options_default);
    struct refocus_editable editable = TAKES_NOTHING(refocus_editable_default);
    char *name = NULL;
    const int has_jpeg = strstr(refocus_file_formats(), "JPEG") != NULL;

    empty.exif = empty.icc = &nothing;
    misuse_images(write_image);
    misuse_strides(write_gray, 2 * W);
    REFUSED(refocus_image_write, NULL, &photo, NULL, NULL);
    for (size_t i = 0; i < COUNT(bad); i++)
        REFUSED(refocus_image_write, NAME, &photo, &bad[i], NULL);
    ANSWERS(has_jpeg ? REFOCUS_OK : REFOCUS_ERR_UNSUPPORTED, refocus_image_write,
            "misuse-of-files.jpg", &photo, &empty, NULL);
    remove("misuse-of-files.jpg");
    for (size_t i = 0; i < COUNT(light); i++) {
        empty.light = &light[i];
        REFUSED(refocus_image_write, "misuse-of-files.jpg", &photo, &empty, NULL);
    }
    empty.light = NULL;
    empty.editable = &editable; /* without a photo that is kept */
    editable.own_depth = 1;
    REFUSED(refocus_image_write, "misuse-of-files.jpg", &photo, &empty, NULL);
    editable.struct_size = 3;
    REFUSED(refocus_image_write, "misuse-of-files.jpg", &photo, &empty, NULL);
    ANSWERS(REFOCUS_ERR_UNSUPPORTED, refocus_image_write, "", &photo, NULL, NULL);
    for (size_t i = 0; i < COUNT(sides); i++) {
        REFUSED(refocus_gray16_write, MAP_NAME, samples, sides[i], H, 2 * W, NULL);
        REFUSED(refocus_gray16_write, MAP_NAME, samples, W, sides[i], 2 * W, NULL);
    }
    REFUSED(refocus_gray16_write, NULL, samples, W, H, 2 * W, NULL);
    REFUSED(refocus_gray16_write, MAP_NAME, NULL, W, H, 2 * W, NULL);
    REFUSED(refocus_gray16_write, MAP_NAME, samples, W, H, 2 * W + 1, NULL);
    REFUSED(refocus_file_write, NULL, samples, 4, NULL);
    REFUSED(refocus_file_write, NAME, NULL, 4, NULL);
    ANSWERS(REFOCUS_ERR_IO, refocus_file_write, "", samples, 4, NULL);
    REFUSED(refocus_file_temporary, NULL, &name, NULL);
    REFUSED(refocus_file_temporary, "", &name, NULL);
    REFUSED(refocus_file_temporary, NAME, NULL, NULL);
    ANSWERS(REFOCUS_ERR_IO, refocus_file_temporary, "no-such-folder/" NAME, &name, NULL);
    assert_null(name);
    REFUSED(refocus_file_move, NULL, NAME, NULL);
    REFUSED(refocus_file_move, NAME, NULL, NULL);
    ANSWERS(REFOCUS_ERR_IO, refocus_file_move, "", "", NULL);
    GIVES_NULL(refocus_file_place, NULL);
}

static void saving_depth(void)
{
    const struct misuse bad[] = {BAD(refocus_depth_write, struct_size, 0),
                                 BAD(refocus_depth_write, width, 0),
                                 BAD(refocus_depth_write, width, INT32_MAX),
                                 BAD(refocus_depth_write, height, INT32_MIN),
                                 BAD(refocus_depth_write, height, REFOCUS_MAX_SIDE + 1),
                                 BAD(refocus_depth_write, disparity, NULL),
                                 BAD(refocus_depth_write, stride, 0),
                                 BAD(refocus_depth_write, stride, 2 * W + 1),
                                 BAD(refocus_depth_write, stride, PTRDIFF_MIN),
                                 BAD(refocus_depth_write, stride, PTRDIFF_MAX - 1),
                                 BAD(refocus_depth_write, focus_x, (double)NAN),
                                 BAD(refocus_depth_write, focus_y, 2),
                                 BAD(refocus_depth_write, near_m, (double)NAN),
                                 BAD(refocus_depth_write, near_m, (double)INFINITY),
                                 BAD(refocus_depth_write, far_m, (double)NAN),
                                 BAD(refocus_depth_write, focus_distance, (double)NAN),
                                 BAD(refocus_depth_write, blur_at_infinity, (double)INFINITY)};
    static const uint16_t samples[W * H];
    struct refocus_depth_write good = TAKES_NOTHING(refocus_depth_write_default);

    good.width = W;
    good.height = H;
    good.disparity = samples;
    good.stride = 2 * W;
    REFUSED(refocus_photo_write_depth, NULL, NAME, &good, NULL);
    REFUSED(refocus_photo_write_depth, NAME, NULL, &good, NULL);
    REFUSED(refocus_photo_write_depth, NAME, NAME, NULL, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_depth_write depth = good;

        misuse_spoil(&depth, &bad[i]);
        REFUSED(refocus_photo_write_depth, NAME, NAME, &depth, NULL);
    }
    misuse_spoil(NULL, NULL);
}

void misuse_files(void **state)
{
    (void)state;
    reading();
    units();
    writing();
    saving_depth();
    assert_int_not_equal(access(NAME, F_OK), 0);
    assert_int_not_equal(access(MAP_NAME, F_OK), 0);
    misuse_done();
}
