/* JPEG photos: orientation, EXIF, ICC, depth in XMP and behind the main picture. */
#include "check.h"

#include <math.h>

/* EXIF 2.3, tag 274: which side of the upright picture row 0 and column 0 lie on. */
static const struct {
    char row, column; /* t, b, l, r */
} sides[9] = {{0, 0},     {'t', 'l'}, {'t', 'r'}, {'b', 'r'}, {'b', 'l'},
              {'l', 't'}, {'r', 't'}, {'r', 'b'}, {'l', 'b'}};

/* Where the stored pixel (column, row) of a w x h picture lies in the upright one. */
static void upright_place(int orientation, int w, int h, int column, int row, int *x,
                          int *y)
{
    const char r = sides[orientation].row, c = sides[orientation].column;

    *x = c == 'l' ? column : c == 'r' ? w - 1 - column : r == 'l' ? row : h - 1 - row;
    *y = r == 't' ? row : r == 'b' ? h - 1 - row : c == 't' ? column : w - 1 - column;
}

#ifdef RF_HAVE_PNG
static void orientation_of_png(void **state)
{
    (void)state;
    for (int orientation = 1; orientation <= 8; orientation++) {
        for (int big_endian = 0; big_endian < 2; big_endian++) {
            struct bytes exif = make_exif(big_endian, orientation);
            uint8_t samples[5 * 3 * 3];
            struct refocus_photo *photo;

            for (int i = 0; i < 45; i++) {
                samples[i] = (uint8_t)pattern(i / 3 % 5, i / 15, i % 3, 255);
            }
            photo = read_photo(make_png_raw(5, 3, 2, 8, samples, &exif), REFOCUS_OK);
            bytes_free(&exif);
            assert_int_equal(photo->info.orientation, orientation);
            assert_int_equal(photo->info.stored_width, 5);
            assert_int_equal(photo->info.stored_height, 3);
            assert_int_equal(photo->image.width, orientation < 5 ? 5 : 3);
            for (int i = 0; i < 15; i++) {
                int x, y;
                upright_place(orientation, 5, 3, i % 5, i / 5, &x, &y);
                assert_memory_equal(pixel_at(&photo->image, x, y), samples + 3 * i, 3);
            }
            refocus_photo_free(&photo);
        }
    }
}

static struct gdepth small_gdepth(void)
{
    const struct gdepth gdepth = {
        .format = "RangeInverse",
        .extra = "GDepth:Near=\"0.5\" GDepth:Far=\"8\" GDepth:Units=\"m\" "
                 "GDepth:Mime=\"image/png\" GFocus:FocalPointX=\"0.25\" "
                 "GFocus:FocalPointY=\"0.125\" GFocus:FocalDistance=\"1.5\" "
                 "GFocus:BlurAtInfinity=\"0.01\"",
        .depth = make_png(6, 4, 0, 8),
    };
    return gdepth;
}

static void check_quarter(const struct refocus_image *image, int x, int y,
                          const uint8_t *colour)
{
    for (int c = 0; c < 3; c++) {
        assert_in_range(pixel_at(image, x, y)[c] + 10, colour[c], colour[c] + 20);
    }
}

static void orientation_of_photo_and_depth(void **state)
{
    static const uint8_t colours[4][3] = {
        {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};

    (void)state;
    for (int orientation = 1; orientation <= 8; orientation++) {
        struct refocus_photo *photo =
            read_photo(make_gdepth(small_gdepth(), orientation), REFOCUS_OK);
        int x, y;

        assert_int_equal(photo->image.width, orientation < 5 ? 48 : 32);
        assert_int_equal(photo->depth.width, orientation < 5 ? 6 : 4);
        for (int i = 0; i < 24; i++) {
            upright_place(orientation, 6, 4, i % 6, i / 6, &x, &y);
            assert_int_equal(sample_at(&photo->depth, x, y),
                             pattern(i % 6, i / 6, 0, 255));
        }
        for (int i = 0; i < 4; i++) {
            upright_place(orientation, 48, 32, i % 2 ? 40 : 8, i / 2 ? 24 : 8, &x, &y);
            check_quarter(&photo->image, x, y, colours[i]);
        }
        /* The focus point is in the middle of stored pixel (12, 4), near enough. */
        upright_place(orientation, 48, 32, 12, 4, &x, &y);
        assert_true(fabs(photo->info.focus_x * photo->image.width - x) <= 1);
        assert_true(fabs(photo->info.focus_y * photo->image.height - y) <= 1);
        refocus_photo_free(&photo);
    }
}

static void gdepth_range_inverse(void **state)
{
    struct refocus_photo *photo = read_photo(make_gdepth(small_gdepth(), 0), REFOCUS_OK);

    (void)state;
    assert_int_equal(photo->info.depth_source, REFOCUS_DEPTH_SOURCE_GDEPTH);
    assert_int_equal(photo->depth.meaning, REFOCUS_DEPTH_DISPARITY);
    assert_true(photo->depth.value_near == 0 && photo->depth.value_far == 255);
    assert_true(photo->depth.near_m == 0.5 && photo->depth.far_m == 8);
    assert_true(photo->info.focus_distance == 1.5);
    assert_true(photo->info.blur_at_infinity == 0.01);
    assert_int_equal(photo->info.original_used, 0);
    assert_true(has_evidence(photo, "RangeInverse"));
    refocus_photo_free(&photo);
    photo = read_depth(make_gdepth(small_gdepth(), 6), NULL, REFOCUS_OK);
    assert_null(photo->image.plane[0]);
    assert_int_equal(photo->depth.width, 4);
    assert_int_equal(photo->info.depth_source, REFOCUS_DEPTH_SOURCE_GDEPTH);
    refocus_photo_free(&photo);
}

static void gdepth_range_linear(void **state)
{
    const struct gdepth gdepth = {.format = "RangeLinear",
                                  .extra = "GDepth:Near=\"500\" GDepth:Far=\"3500\" "
                                           "GDepth:Units=\"mm\"",
                                  .depth = make_png(6, 4, 0, 16)};
    const struct gdepth without = {.format = "RangeLinear", .depth = make_png(6, 4, 0, 8)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

    (void)state;
    assert_int_equal(photo->depth.meaning, REFOCUS_DEPTH_DISTANCE);
    assert_near(photo->depth.metres_at_zero, 0.5);
    assert_near(photo->depth.metres_per_unit, 3.0 / 65535);
    assert_near(photo->depth.near_m, 0.5);
    assert_near(photo->depth.far_m, 3.5);
    assert_int_equal(photo->depth.flags, 0);
    refocus_photo_free(&photo);
    read_photo(make_gdepth(without, 0), REFOCUS_ERR_FORMAT);
}

static void gdepth_payload_jpeg_without_range(void **state)
{
    const struct gdepth gdepth = {.format = "RangeInverse",
                                  .depth = make_jpeg(32, 16, true, true)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

    (void)state;
    assert_in_range(sample_at(&photo->depth, 4, 4), 28, 36);
    assert_in_range(sample_at(&photo->depth, 30, 14), 220, 228);
    assert_true(photo->depth.near_m == 0 && photo->depth.far_m == 0);
    refocus_photo_free(&photo);
}

static void gdepth_units_absent_are_told(void **state)
{
    const struct gdepth gdepth = {.format = "RangeInverse",
                                  .extra = "GDepth:Near=\"2\" GDepth:Far=\"9\"",
                                  .depth = make_png(6, 4, 0, 8)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

    (void)state;
    assert_true(has_evidence(photo, "without a unit"));
    refocus_photo_free(&photo);
}

static void gdepth_damaged(void **state)
{
    const struct gdepth bad[] = {
        {.format = "RangeInverse"},
        {.format = "RangeSquare", .depth = make_png(2, 2, 0, 8)},
        {.format = NULL, .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse", .extra = "GDepth:Data=\"@@@\""},
        {.format = "RangeInverse", .extra = "GDepth:Data=\"\""},
        {.format = "RangeInverse", .extra = "GDepth:Data=\"AAAA\""},
        {.format = "RangeInverse", .depth = make_png(2, 2, 2, 8)},
        {.format = "RangeInverse", .extra = "GDepth:Near=\"2\" GDepth:Far=\"1\"",
         .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse", .extra = "GDepth:Near=\"two\" GDepth:Far=\"3\"",
         .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse", .extra = "GFocus:FocalPointX=\"\"",
         .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse", .depth = make_png(2, 2, 0, 8),
         .original = bytes_copy("no picture", 10)},
    };

    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        read_photo(make_gdepth(bad[i], 0), REFOCUS_ERR_FORMAT);
    }
}

static void original_replaces_a_blurred_picture(void **state)
{
    struct gdepth gdepth = small_gdepth();
    struct refocus_photo *photo;

    (void)state;
    gdepth.original = make_png(9, 7, 2, 8);
    photo = read_photo(make_gdepth(gdepth, 6), REFOCUS_OK);
    assert_int_equal(photo->info.original_used, 1);
    assert_int_equal(photo->image.width, 7);
    assert_int_equal(photo->image.height, 9);
    refocus_photo_free(&photo);
    gdepth = (struct gdepth){.format = "RangeInverse",
                             .extra = "GFocus:BlurAtInfinity=\"0\"",
                             .depth = make_png(2, 2, 0, 8),
                             .original = make_png(9, 7, 2, 8)};
    photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);
    assert_int_equal(photo->info.original_used, 0);
    assert_int_equal(photo->image.width, 48);
    refocus_photo_free(&photo);
}

static void extended_in_any_order(void **state)
{
    static const size_t chunks[] = {64, 100, 1000, 60000};

    (void)state;
    for (size_t i = 0; i < sizeof chunks / sizeof *chunks; i++) {
        /* 23 has no common divisor with any number of chunks here. */
        struct refocus_photo *photo = read_photo(
            make_gdepth_extended(small_gdepth(), chunks[i], i % 2 ? 23 : 1, -1),
            REFOCUS_OK);
        assert_int_equal(sample_at(&photo->depth, 3, 2), pattern(3, 2, 0, 255));
        refocus_photo_free(&photo);
    }
}

static void extended_damaged(void **state)
{
    struct bytes jpeg;
    uint8_t *place;

    (void)state;
    read_photo(make_gdepth_extended(small_gdepth(), 64, 1, 0), REFOCUS_ERR_FORMAT);
    read_photo(make_gdepth_extended(small_gdepth(), 64, 1, 3), REFOCUS_ERR_FORMAT);
    read_photo(make_gdepth_extended(small_gdepth(), 60000, 1, 0), REFOCUS_ERR_FORMAT);
    /* A chunk twice. */
    jpeg = make_gdepth_extended(small_gdepth(), 60000, 1, -1);
    for (size_t i = 0; i + 35 < jpeg.size; i++) {
        if (memcmp(jpeg.data + i, "http://ns.adobe.com/xmp/extension/", 34) == 0) {
            const size_t size = (size_t)jpeg.data[i - 2] << 8 | jpeg.data[i - 1];
            struct bytes copy = bytes_copy(jpeg.data + i, size - 2);
            jpeg_insert(&jpeg, 0xe1, "", 0, copy.data, copy.size);
            bytes_free(&copy);
            break;
        }
    }
    read_photo(jpeg, REFOCUS_ERR_FORMAT);
    /* Another GUID, and a length that is not true. */
    for (int change = 0; change < 3; change++) {
        jpeg = make_gdepth_extended(small_gdepth(), 100, 1, -1);
        place = NULL;
        for (size_t i = 0; i + 80 < jpeg.size && !place; i++) {
            if (memcmp(jpeg.data + i, "http://ns.adobe.com/xmp/extension/", 34) == 0) {
                place = jpeg.data + i + 35;
            }
        }
        place[change == 0 ? 31 : change == 1 ? 35 : 39] ^= 1;
        read_photo(jpeg, REFOCUS_ERR_FORMAT);
    }
}
#endif

static struct bytes plain_with_icc(struct bytes profile, size_t chunk, int skip)
{
    struct bytes jpeg = make_jpeg(16, 16, false, false);
    const int count = (int)((profile.size + chunk - 1) / chunk);

    for (int i = 0; i < count; i++) {
        const size_t from = (size_t)i * chunk;
        const size_t size = profile.size - from < chunk ? profile.size - from : chunk;
        char signature[14] = "ICC_PROFILE";
        signature[12] = (char)(i + 1);
        signature[13] = (char)count;
        if (i != skip) {
            jpeg_insert(&jpeg, 0xe2, signature, 14, profile.data + from, size);
        }
    }
    return jpeg;
}

static void icc_in_chunks(void **state)
{
    uint8_t profile[300];
    struct refocus_photo *photo;

    (void)state;
    for (int i = 0; i < 300; i++) {
        profile[i] = (uint8_t)i;
    }
    memcpy(profile + 16, "RGB ", 4);
    memcpy(profile + 36, "acsp", 4);
    /* jpeg_insert() puts each before the last: they come in reverse order. */
    photo = read_photo(plain_with_icc((struct bytes){profile, 300}, 70, -1), REFOCUS_OK);
    assert_int_equal(photo->icc.size, 300);
    assert_memory_equal(photo->icc.data, profile, 300);
    refocus_photo_free(&photo);
    photo = read_photo(plain_with_icc((struct bytes){profile, 300}, 70, 2), REFOCUS_OK);
    assert_null(photo->icc.data);
    assert_true(has_evidence(photo, "ICC"));
    refocus_photo_free(&photo);
    memcpy(profile + 16, "GRAY", 4);
    photo = read_photo(plain_with_icc((struct bytes){profile, 300}, 300, -1), REFOCUS_OK);
    assert_null(photo->icc.data);
    refocus_photo_free(&photo);
}

static void exif_facts(void **state)
{
    (void)state;
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct bytes jpeg = make_jpeg(32, 16, false, false);
        struct bytes expected = make_exif(big_endian, 1);
        struct refocus_photo *photo;

        jpeg_insert_exif(&jpeg, make_exif(big_endian, 8));
        photo = read_photo(jpeg, REFOCUS_OK);
        assert_string_equal(photo->info.camera, "Maker Model X");
        assert_true(photo->info.focal_length_mm == 50.5);
        assert_true(photo->info.focal_length_35mm == 75);
        assert_true(photo->info.f_number == 1.8);
        assert_int_equal(photo->exif.size, expected.size);
        /* Orientation 1; width and height, 640 and 480, have changed places. */
        assert_memory_equal(photo->exif.data, expected.data, 58);
        assert_int_equal(photo->exif.data[62 + 2 + 24 + 2 + (big_endian ? 1 : 0)], 4);
        assert_int_equal(photo->exif.data[62 + 2 + 36 + 2 + (big_endian ? 1 : 0)], 3);
        /* No way leads to the old thumbnail. */
        assert_memory_equal(photo->exif.data + 58, "\0\0\0\0", 4);
        refocus_photo_free(&photo);
        bytes_free(&expected);
    }
}

static void exif_without_sense(void **state)
{
    struct bytes jpeg = make_jpeg(32, 16, false, false);
    struct refocus_photo *photo;

    (void)state;
    jpeg_insert_exif(&jpeg, make_exif(true, 9));
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_int_equal(photo->info.orientation, 1);
    refocus_photo_free(&photo);
    jpeg = make_jpeg(32, 16, false, false);
    jpeg_insert_exif(&jpeg, bytes_copy("MM\0*\377\377\377\377", 8));
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_null(photo->exif.data);
    assert_true(has_evidence(photo, "EXIF: damaged"));
    refocus_photo_free(&photo);
}

#define APPLE_RANGE \
    "apdi:FloatMinValue=\"0.25\" apdi:FloatMaxValue=\"4\" apdi:IntMinValue=\"0\" " \
    "apdi:IntMaxValue=\"255\" depthData:Accuracy=\"relative\""

static void apple_disparity(void **state)
{
    (void)state;
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct bytes main_jpeg = make_jpeg(64, 32, false, false);
        struct bytes parts[3] = {
            make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", NULL),
            make_auxiliary("urn:com:apple:photo:2018:aux:portraiteffectsmatte", NULL),
            make_auxiliary("disparity", APPLE_RANGE)};
        struct refocus_photo *photo;

        jpeg_insert_exif(&main_jpeg, make_exif(true, 6));
        photo = read_photo(make_mpf(main_jpeg, parts, 3, big_endian), REFOCUS_OK);
        assert_int_equal(photo->info.depth_source, REFOCUS_DEPTH_SOURCE_APPLE_MPF);
        assert_int_equal(photo->depth.width, 16);
        assert_int_equal(photo->depth.height, 32);
        assert_in_range(sample_at(&photo->depth, 15, 0), 28, 36);
        assert_in_range(sample_at(&photo->depth, 0, 31), 220, 228);
        assert_true(photo->depth.value_near == 255 && photo->depth.value_far == 0);
        assert_near(photo->depth.near_m, 0.25);
        assert_near(photo->depth.far_m, 4.0);
        assert_true(has_evidence(photo, "hdrgainmap"));
        assert_true(has_evidence(photo, "portraiteffectsmatte"));
        refocus_photo_free(&photo);
    }
}

static void apple_gain_map_is_no_depth(void **state)
{
    struct bytes part = make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", NULL);
    struct bytes file = make_mpf(make_jpeg(32, 32, false, false), &part, 1, true);
    struct refocus_photo *photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);

    (void)state;
    assert_null(photo->depth.samples);
    assert_int_equal(photo->info.depth_source, REFOCUS_DEPTH_SOURCE_NONE);
    assert_true(has_evidence(photo, "it is no depth"));
    refocus_photo_free(&photo);
    read_depth(file, NULL, REFOCUS_ERR_NO_DEPTH);
}

static struct refocus_photo *apple_with(const char *type, const char *extra, int expected)
{
    struct bytes part = make_auxiliary(type, extra);

    return read_photo(make_mpf(make_jpeg(32, 32, false, false), &part, 1, true), expected);
}

static void apple_ranges(void **state)
{
    struct refocus_photo *photo;

    (void)state;
    photo = apple_with("disparity", "apdi:FloatMinValue=\"-1\" apdi:FloatMaxValue=\"4\"",
                       REFOCUS_OK);
    assert_near(photo->depth.value_far, 51); /* where disparity is 0 */
    assert_true(isinf(photo->depth.far_m) && photo->depth.near_m == 0.25);
    refocus_photo_free(&photo);
    photo = apple_with("disparity", NULL, REFOCUS_OK);
    assert_true(photo->depth.near_m == 0 && photo->depth.value_near == 255);
    refocus_photo_free(&photo);
    photo = apple_with("depth", APPLE_RANGE, REFOCUS_OK);
    assert_int_equal(photo->depth.meaning, REFOCUS_DEPTH_DISTANCE);
    assert_near(photo->depth.metres_at_zero, 0.25);
    assert_near(photo->depth.metres_per_unit, 3.75 / 255);
    refocus_photo_free(&photo);
    apple_with("depth", NULL, REFOCUS_ERR_FORMAT);
    apple_with("disparity", "apdi:FloatMinValue=\"4\" apdi:FloatMaxValue=\"4\"",
               REFOCUS_ERR_FORMAT);
    apple_with("disparity", "apdi:IntMinValue=\"9\" apdi:IntMaxValue=\"9\"",
               REFOCUS_ERR_FORMAT);
    apple_with("disparity", "apdi:FloatMinValue=\"x\"", REFOCUS_ERR_FORMAT);
}

static void mpf_index_of_another_file(void **state)
{
    struct bytes part = make_auxiliary("disparity", APPLE_RANGE);
    struct bytes file = make_mpf(make_jpeg(32, 32, false, false), &part, 1, true);
    const size_t main_size = file.size - part.size;
    struct refocus_photo *photo;

    (void)state;
    /* An editor dropped the image and left the index. */
    photo = read_photo(bytes_copy(file.data, main_size), REFOCUS_OK);
    assert_null(photo->depth.samples);
    assert_true(has_evidence(photo, "not where the index says"));
    refocus_photo_free(&photo);
    /* The file was cut. */
    read_photo(bytes_copy(file.data, main_size + 1), REFOCUS_ERR_FORMAT);
    file.size--;
    read_photo(file, REFOCUS_ERR_FORMAT);
}

static void xmp_hostile(void **state)
{
    static const char *const entities =
        "<?xml version=\"1.0\"?><!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b "
        "\"&a;&a;&a;&a;&a;&a;&a;&a;\"><!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;\">]>"
        "<x xmlns:GDepth=\"http://ns.google.com/photos/1.0/depthmap/\">&c;</x>";
    struct bytes jpeg = make_jpeg(16, 16, false, false);
    struct refocus_photo *photo;

    (void)state;
    jpeg_insert_xmp(&jpeg, entities);
    read_photo(jpeg, REFOCUS_ERR_FORMAT);
    jpeg = make_jpeg(16, 16, false, false);
    jpeg_insert_xmp(&jpeg, "<x><broken");
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_true(has_evidence(photo, "XMP: damaged"));
    refocus_photo_free(&photo);
}

static void grey_jpeg_is_depth(void **state)
{
    struct refocus_photo *photo =
        read_depth(make_jpeg(32, 16, true, false), "inverse", REFOCUS_OK);

    (void)state;
    assert_true(photo->depth.value_near == 0 && photo->depth.value_far == 255);
    assert_in_range(sample_at(&photo->depth, 2, 2), 28, 36);
    refocus_photo_free(&photo);
    read_depth(make_jpeg(32, 16, false, false), NULL, REFOCUS_ERR_NO_DEPTH);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef RF_HAVE_PNG
        cmocka_unit_test(orientation_of_png),
#ifdef RF_HAVE_XMP
        cmocka_unit_test(orientation_of_photo_and_depth),
        cmocka_unit_test(gdepth_range_inverse),
        cmocka_unit_test(gdepth_range_linear),
        cmocka_unit_test(gdepth_payload_jpeg_without_range),
        cmocka_unit_test(gdepth_units_absent_are_told),
        cmocka_unit_test(gdepth_damaged),
        cmocka_unit_test(original_replaces_a_blurred_picture),
        cmocka_unit_test(extended_in_any_order),
        cmocka_unit_test(extended_damaged),
#endif
#endif
        cmocka_unit_test(icc_in_chunks),
        cmocka_unit_test(exif_facts),
        cmocka_unit_test(exif_without_sense),
#ifdef RF_HAVE_XMP
        cmocka_unit_test(apple_disparity),
        cmocka_unit_test(apple_gain_map_is_no_depth),
        cmocka_unit_test(apple_ranges),
        cmocka_unit_test(mpf_index_of_another_file),
        cmocka_unit_test(xmp_hostile),
#endif
        cmocka_unit_test(grey_jpeg_is_depth),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
