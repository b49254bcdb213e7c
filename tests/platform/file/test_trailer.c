/* test_trailer.c: depth in the trailers of Samsung and Huawei, whole, cut and wrong. */
#include "check.h"

static void check_map(struct bytes file, bool original)
{
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);

    assert_non_null(photo->depth->samples);
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_TRAILER);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
    assert_true(photo->depth->value_near == 255 && photo->depth->value_far == 0);
    assert_true(photo->depth->near_m == 0 && photo->depth->far_m == 0);
    assert_int_equal(photo->depth->width, 6);
    assert_int_equal(photo->depth->height, 4);
    for (int i = 0; i < 24; i++)
        assert_int_equal(sample_at(photo->depth, i % 6, i / 6), 10 * i);
    assert_int_equal(photo->info->original_used, original);
    assert_int_equal(photo->image->width, original ? 60 : 64);
    refocus_photo_free(&photo);
}

TEST(whole)
{
    for (int original = 0; original < 2; original++) {
        check_map(make_samsung(32, 6, 4, original, false), original);
        check_map(make_samsung(68, 6, 4, original, true), original);
        check_map(make_huawei(6, 4, original), original);
    }
}

/* The map is turned with its photo. */
TEST(turned)
{
    struct bytes file = make_huawei(6, 4, false);
    struct refocus_photo *photo;

    jpeg_insert_exif(&file, make_exif(true, 6));
    photo = read_photo(file, REFOCUS_OK);
    assert_int_equal(photo->depth->width, 4);
    assert_int_equal(photo->depth->height, 6);
    assert_int_equal(sample_at(photo->depth, 3, 0), 0);
    assert_int_equal(sample_at(photo->depth, 0, 0), 180);
    refocus_photo_free(&photo);
}

static void expect_none(struct bytes file)
{
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);

    assert_null(photo->depth->samples);
    refocus_photo_free(&photo);
}

/* Sides that do not fit, and numbers of any size anywhere in the directory, are passed over. */
TEST(wrong)
{
    struct bytes file = make_samsung(32, 6, 4, false, false);
    const size_t entries = file.size - 8 - 24;

    expect_none(make_samsung(32, 6, 5, false, false));
    expect_none(make_samsung(32, 0, 4, false, false));
    expect_none(make_samsung(32, 1 << 16, 1 << 16, false, false));
    expect_none(make_samsung(96, 6, 4, false, false)); /* the mark is beyond its place */
    expect_none(make_huawei(6, 5, false));
    expect_none(make_huawei(0, 4, false));
    expect_none(make_huawei(65535, 65535, false));
    for (size_t at = entries - 12; at + 4 <= file.size; at++) {
        static const uint32_t values[] = {0, 1, 7, 0x7fffffff, 0xffffffff, 0xfffffff8};

        for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
            struct bytes copy = bytes_copy(file.data, file.size);
            struct refocus_photo *photo;

            memcpy(copy.data + at, &values[i], 4);
            photo = read_photo(copy, REFOCUS_OK);
            refocus_photo_free(&photo);
        }
    }
    bytes_free(&file);
}

/* Cut anywhere behind the main picture, a file is a photo without depth. */
TEST(cut)
{
    struct bytes main_picture = make_jpeg(64, 32, false, false);

    for (int maker = 0; maker < 2; maker++) {
        struct bytes file = maker ? make_huawei(6, 4, false) : make_samsung(32, 6, 4, false, false);

        for (size_t size = main_picture.size; size < file.size; size++)
            expect_none(bytes_copy(file.data, size));
        bytes_free(&file);
    }
    bytes_free(&main_picture);
}
