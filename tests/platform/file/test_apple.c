/* test_apple.c: Apple's depth after the main picture, and XMP that means harm. */
#include "check.h"

#include <unistd.h>

#include <math.h>

#define APPLE_RANGE                                                                                \
    "apdi:FloatMinValue=\"0.25\" apdi:FloatMaxValue=\"4\" apdi:IntMinValue=\"0\" "                 \
    "apdi:IntMaxValue=\"255\" depthData:Accuracy=\"relative\""

TEST(apple_disparity)
{
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct bytes main_jpeg = make_jpeg(64, 32, false, false);
        struct bytes parts[3] = {
            make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", NULL),
            make_auxiliary("urn:com:apple:photo:2018:aux:portraiteffectsmatte", NULL),
            make_auxiliary("disparity", APPLE_RANGE)};
        struct refocus_photo *photo;

        jpeg_insert_exif(&main_jpeg, make_exif(true, 6));
        photo = read_photo(make_mpf(main_jpeg, parts, 3, big_endian), REFOCUS_OK);
        assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_APPLE_MPF);
        assert_int_equal(photo->depth->width, 16);
        assert_int_equal(photo->depth->height, 32);
        assert_in_range(sample_at(photo->depth, 15, 0), 28, 36);
        assert_in_range(sample_at(photo->depth, 0, 31), 220, 228);
        assert_true(photo->depth->value_near == 255 && photo->depth->value_far == 0);
        assert_near(photo->depth->near_m, 0.25);
        assert_near(photo->depth->far_m, 4.0);
        assert_true(has_evidence(photo, "hdrgainmap"));
        assert_true(has_evidence(photo, "image 3 is the portrait matte"));
        /* 32 x 16 of the quarters 32, 96 / 160, 224, turned as the photo is. */
        assert_int_equal(photo->matte->width, 16);
        assert_int_equal(photo->matte->height, 32);
        assert_true(photo->matte->value_near == 255 && photo->matte->value_far == 0);
        assert_in_range(sample_at(photo->matte, 15, 0), 28, 36);
        assert_in_range(sample_at(photo->matte, 0, 31), 220, 228);
        refocus_photo_free(&photo);
    }
}

/* A matte of no picture is damage; a second one, those of hair and skin, and that of a depth file
 * alone are passed over. */
TEST(apple_mattes)
{
    static const char matte[] = "urn:com:apple:photo:2018:aux:portraiteffectsmatte";
    struct bytes parts[3] = {
        make_auxiliary(matte, NULL), make_auxiliary(matte, NULL),
        make_auxiliary("urn:com:apple:photo:2019:aux:semantichairmatte", NULL)};
    struct bytes file = make_mpf(make_jpeg(32, 16, false, false), parts, 3, true), depth;
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);

    assert_non_null(photo->matte->samples);
    assert_null(photo->depth->samples);
    assert_true(has_evidence(photo, "image 3 passed over, it is no depth but"));
    assert_true(has_evidence(photo, "semantichairmatte"));
    refocus_photo_free(&photo);
    parts[0] = make_auxiliary(matte, NULL);
    parts[0].size -= 40; /* a JPEG without its end */
    read_photo(make_mpf(make_jpeg(32, 16, false, false), parts, 1, true), REFOCUS_ERR_FORMAT);
    parts[0] = make_auxiliary(matte, NULL);
    depth = make_auxiliary("disparity", APPLE_RANGE);
    parts[1] = depth;
    photo = read_depth(make_mpf(make_jpeg(32, 16, false, false), parts, 2, true), NULL, REFOCUS_OK);
    assert_null(photo->matte->samples);
    refocus_photo_free(&photo);
}

TEST(apple_gain_map_is_no_depth)
{
    struct bytes part = make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", NULL);
    struct bytes file = make_mpf(make_jpeg(32, 32, false, false), &part, 1, true);
    struct refocus_photo *photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);

    assert_null(photo->depth->samples);
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_NONE);
    assert_true(has_evidence(photo, "it is no depth"));
    refocus_photo_free(&photo);
    read_depth(file, NULL, REFOCUS_ERR_NO_DEPTH);
}

/* An MPO: the other view behind the main one. Anything else is refused. */
TEST(mpo_second_view)
{
    char path[] = "/tmp/refocus-mpo-XXXXXX";
    const int file = mkstemp(path);
    struct refocus_reason reason;
    struct refocus_photo *photo;

    assert_true(file >= 0);
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct bytes part = make_jpeg(48, 24, true, false);
        struct bytes mpo = make_mpf(make_jpeg(64, 32, false, false), &part, 1, big_endian);

        assert_int_equal(ftruncate(file, 0), 0);
        assert_int_equal(pwrite(file, mpo.data, mpo.size, 0), (ssize_t)mpo.size);
        assert_int_equal(refocus_photo_read_second(&photo, path, NULL, &reason), REFOCUS_OK);
        assert_int_equal(photo->image->width, 48);
        assert_int_equal(photo->image->height, 24);
        refocus_photo_free(&photo);
        assert_int_equal(refocus_photo_read(&photo, path, NULL, &reason), REFOCUS_OK);
        assert_int_equal(photo->image->width, 64);
        refocus_photo_free(&photo);
        for (size_t size = 0; size < mpo.size; size += 97) { /* cut off anywhere */
            assert_int_equal(ftruncate(file, (off_t)(mpo.size - size - 1)), 0);
            const int status = refocus_photo_read_second(&photo, path, NULL, &reason);
            assert_true((status == REFOCUS_OK) == (photo != NULL));
            assert_true(status == REFOCUS_OK || reason.text[0]);
            refocus_photo_free(&photo);
        }
        bytes_free(&mpo);
    }
    close(file);
    unlink(path);
    assert_int_equal(refocus_photo_read_second(&photo, path, NULL, &reason), REFOCUS_ERR_IO);
    assert_null(photo);
}

/* Another JPEG behind the main one without MPF, after a few bytes or none. */
TEST(second_view_behind)
{
    static const struct {
        size_t between;
        int status;
    } behind[] = {{0, REFOCUS_OK},
                  {8, REFOCUS_OK},
                  {34, REFOCUS_OK},
                  {64, REFOCUS_OK},
                  {65, REFOCUS_ERR_UNSUPPORTED}};
    char path[] = "/tmp/refocus-lif-XXXXXX";
    const int file = mkstemp(path);
    struct refocus_reason reason;
    struct refocus_photo *photo;

    assert_true(file >= 0);
    for (size_t i = 0; i < sizeof behind / sizeof *behind; i++) {
        static const uint8_t numbers[65];
        struct bytes first = make_jpeg(64, 32, false, false);
        struct bytes second = make_jpeg(48, 24, true, false);
        const off_t at = (off_t)(first.size + behind[i].between);

        assert_int_equal(ftruncate(file, 0), 0);
        assert_int_equal(pwrite(file, first.data, first.size, 0), (ssize_t)first.size);
        assert_int_equal(pwrite(file, numbers, behind[i].between, (off_t)first.size),
                         (ssize_t)behind[i].between);
        assert_int_equal(pwrite(file, second.data, second.size, at), (ssize_t)second.size);
        assert_int_equal(pwrite(file, "{}", 2, at + (off_t)second.size), 2);
        assert_int_equal(refocus_photo_read_second(&photo, path, NULL, &reason), behind[i].status);
        assert_true(!photo || (photo->image->width == 48 && photo->image->height == 24));
        refocus_photo_free(&photo);
        for (size_t size = 1; size < second.size; size += 97) { /* cut off anywhere */
            assert_int_equal(ftruncate(file, at + (off_t)size), 0);
            const int status = refocus_photo_read_second(&photo, path, NULL, &reason);
            assert_true((status == REFOCUS_OK) == (photo != NULL));
            refocus_photo_free(&photo);
        }
        bytes_free(&first);
        bytes_free(&second);
    }
    close(file);
    unlink(path);
}

/* MPF tells views for stereo from previews, and which of them there are is told. */
TEST(mpo_views)
{
    const size_t attributes = 10 + 50 + 16; /* the second picture has them there, see make_mpf() */

    for (int view = 0; view < 2; view++) {
        struct bytes part = make_jpeg(48, 24, true, false);
        struct bytes mpo = make_mpf(make_jpeg(48, 32, false, false), &part, 1, true);
        struct refocus_photo *photo;

        if (view)
            memcpy(mpo.data + attributes, "\0\2\0\2", 4);
        photo = read_photo(mpo, REFOCUS_OK);
        assert_int_equal(photo->info->views, view);
        assert_true(has_evidence(photo, "another view, for stereo") == view);
        refocus_photo_free(&photo);
    }
}

static struct refocus_photo *apple_with(const char *type, const char *extra, int expected)
{
    struct bytes part = make_auxiliary(type, extra);

    return read_photo(make_mpf(make_jpeg(32, 32, false, false), &part, 1, true), expected);
}

/* Type and subtype as iOS 12 wrote them, the matte before the depth. */
TEST(apple_subtypes)
{
    struct bytes parts[2] = {
        make_auxiliary("depth", "apdi:AuxiliaryImageSubType=\"portraiteffectsmatte\""),
        make_auxiliary("disparity", APPLE_RANGE)};
    struct bytes file = make_mpf(make_jpeg(32, 16, false, false), parts, 2, true);
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);

    assert_non_null(photo->matte->samples);
    assert_true(has_evidence(photo, "image 2 is the portrait matte"));
    assert_true(has_evidence(photo, "image 3 is disparity"));
    refocus_photo_free(&photo);
    photo = apple_with("depth", "apdi:AuxiliaryImageSubType=\"skymatte\"", REFOCUS_OK);
    assert_null(photo->depth->samples);
    assert_true(has_evidence(photo, "it is no depth but \"skymatte\""));
    refocus_photo_free(&photo);
}

TEST(apple_ranges)
{
    struct refocus_photo *photo;

    photo =
        apple_with("disparity", "apdi:FloatMinValue=\"-1\" apdi:FloatMaxValue=\"4\"", REFOCUS_OK);
    assert_near(photo->depth->value_far, 51); /* code where disparity is 0 */
    assert_true(isinf(photo->depth->far_m) && photo->depth->near_m == 0.25);
    refocus_photo_free(&photo);
    photo = apple_with("disparity", NULL, REFOCUS_OK);
    assert_true(photo->depth->near_m == 0 && photo->depth->value_near == 255);
    refocus_photo_free(&photo);
    photo = apple_with("depth", APPLE_RANGE, REFOCUS_OK);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    assert_near(photo->depth->metres_at_zero, 0.25);
    assert_near(photo->depth->metres_per_unit, 3.75 / 255);
    refocus_photo_free(&photo);
    apple_with("depth", NULL, REFOCUS_ERR_FORMAT);
#define APPLE_BLUR "xmlns:blur=\"http://ns.apple.com/depthBlurEffect/1.0/\" "
    photo = apple_with("disparity", APPLE_BLUR "blur:SimulatedAperture=\"4.5\"", REFOCUS_OK);
    assert_true(photo->info->simulated_f_number == 4.5);
    refocus_photo_free(&photo);
    photo = apple_with("disparity", APPLE_BLUR "blur:SimulatedAperture=\"-wide\"", REFOCUS_OK);
    assert_true(photo->info->simulated_f_number == 0);
    refocus_photo_free(&photo);
    apple_with("disparity", "apdi:FloatMinValue=\"4\" apdi:FloatMaxValue=\"4\"",
               REFOCUS_ERR_FORMAT);
    apple_with("disparity", "apdi:IntMinValue=\"9\" apdi:IntMaxValue=\"9\"", REFOCUS_ERR_FORMAT);
    apple_with("disparity", "apdi:FloatMinValue=\"x\"", REFOCUS_ERR_FORMAT);
}

TEST(mpf_index_of_another_file)
{
    struct bytes part = make_auxiliary("disparity", APPLE_RANGE);
    struct bytes file = make_mpf(make_jpeg(32, 32, false, false), &part, 1, true);
    const size_t main_size = file.size - part.size;
    struct refocus_photo *photo;

    /* An editor dropped the image and left the index. */
    photo = read_photo(bytes_copy(file.data, main_size), REFOCUS_OK);
    assert_null(photo->depth->samples);
    assert_true(has_evidence(photo, "not where the index says"));
    refocus_photo_free(&photo);
    /* The file was cut. */
    read_photo(bytes_copy(file.data, main_size + 1), REFOCUS_ERR_FORMAT);
    file.size--;
    read_photo(file, REFOCUS_ERR_FORMAT);
}

TEST(xmp_hostile)
{
    static const char *const entities =
        "<?xml version=\"1.0\"?><!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b "
        "\"&a;&a;&a;&a;&a;&a;&a;&a;\"><!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;\">]>"
        "<x xmlns:GDepth=\"http://ns.google.com/photos/1.0/depthmap/\">&c;</x>";
    struct bytes jpeg = make_jpeg(16, 16, false, false);
    struct refocus_photo *photo;

    jpeg_insert_xmp(&jpeg, entities);
    read_photo(jpeg, REFOCUS_ERR_FORMAT);
    jpeg = make_jpeg(16, 16, false, false);
    jpeg_insert_xmp(&jpeg, "<x><broken");
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_true(has_evidence(photo, "XMP: damaged"));
    refocus_photo_free(&photo);
}
