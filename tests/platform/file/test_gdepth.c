/* test_gdepth.c: Google's depth in XMP, standard and extended. */
#include "check.h"

#include <math.h>

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

static void check_quarter(const struct refocus_image *image, int x, int y, const uint8_t *colour)
{
    for (int c = 0; c < 3; c++)
        assert_in_range(pixel_at(image, x, y)[c] + 10, colour[c], colour[c] + 20);
}

TEST(orientation_of_photo_and_depth)
{
    static const uint8_t colours[4][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};

    for (int orientation = 1; orientation <= 8; orientation++) {
        struct refocus_photo *photo =
            read_photo(make_gdepth(small_gdepth(), orientation), REFOCUS_OK);
        int x, y;

        assert_int_equal(photo->image->width, orientation < 5 ? 48 : 32);
        assert_int_equal(photo->depth->width, orientation < 5 ? 6 : 4);
        for (int i = 0; i < 24; i++) {
            upright_place(orientation, 6, 4, i % 6, i / 6, &x, &y);
            assert_int_equal(sample_at(photo->depth, x, y), pattern(i % 6, i / 6, 0, 255));
        }
        for (int i = 0; i < 4; i++) {
            upright_place(orientation, 48, 32, i % 2 ? 40 : 8, i / 2 ? 24 : 8, &x, &y);
            check_quarter(photo->image, x, y, colours[i]);
        }
        /* The focus point is in the middle of stored pixel (12, 4), near enough. */
        upright_place(orientation, 48, 32, 12, 4, &x, &y);
        assert_true(fabs(photo->info->focus_x * photo->image->width - x) <= 1);
        assert_true(fabs(photo->info->focus_y * photo->image->height - y) <= 1);
        refocus_photo_free(&photo);
    }
}

TEST(gdepth_range_inverse)
{
    struct refocus_photo *photo = read_photo(make_gdepth(small_gdepth(), 0), REFOCUS_OK);

    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_GDEPTH);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
    assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
    assert_true(photo->depth->near_m == 0.5 && photo->depth->far_m == 8);
    assert_true(photo->info->focus_distance == 1.5);
    assert_true(photo->info->blur_at_infinity == 0.01);
    assert_int_equal(photo->info->original_used, 0);
    assert_true(has_evidence(photo, "RangeInverse"));
    refocus_photo_free(&photo);
    photo = read_depth(make_gdepth(small_gdepth(), 6), NULL, REFOCUS_OK);
    assert_null(photo->image->plane[0]);
    assert_int_equal(photo->depth->width, 4);
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_GDEPTH);
    refocus_photo_free(&photo);
}

TEST(unit_overrules_the_file)
{
    struct refocus_photo *photo =
        read_depth(make_gdepth(small_gdepth(), 0), "disparity", REFOCUS_OK);

    /* Turned round, the range is the same. */
    assert_true(photo->depth->value_near == 255 && photo->depth->value_far == 0);
    assert_true(photo->depth->near_m == 0.5 && photo->depth->far_m == 8);
    refocus_photo_free(&photo);
    photo = read_depth(make_gdepth(small_gdepth(), 0), "mm", REFOCUS_OK);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    assert_true(photo->depth->near_m == 0 && photo->depth->far_m == 0);
    refocus_photo_free(&photo);
}

TEST(gdepth_range_linear)
{
    const struct gdepth gdepth = {.format = "RangeLinear",
                                  .extra = "GDepth:Near=\"500\" GDepth:Far=\"3500\" "
                                           "GDepth:Units=\"mm\"",
                                  .depth = make_png(6, 4, 0, 16)};
    const struct gdepth without = {.format = "RangeLinear", .depth = make_png(6, 4, 0, 8)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    assert_near(photo->depth->metres_at_zero, 0.5);
    assert_near(photo->depth->metres_per_unit, 3.0 / 65535);
    assert_near(photo->depth->near_m, 0.5);
    assert_near(photo->depth->far_m, 3.5);
    assert_int_equal(photo->depth->flags, 0);
    refocus_photo_free(&photo);
    read_photo(make_gdepth(without, 0), REFOCUS_ERR_FORMAT);
}

TEST(gdepth_payload_jpeg_without_range)
{
    const struct gdepth gdepth = {.format = "RangeInverse", .depth = make_jpeg(32, 16, true, true)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

    assert_in_range(sample_at(photo->depth, 4, 4), 28, 36);
    assert_in_range(sample_at(photo->depth, 30, 14), 220, 228);
    assert_true(photo->depth->near_m == 0 && photo->depth->far_m == 0);
    refocus_photo_free(&photo);
}

/* Phones write the map as RGB or RGBA with equal channels. */
TEST(gdepth_payload_in_colour_form)
{
    static const uint8_t rgb[12] = {9, 9, 9, 80, 80, 80, 7, 7, 7, 200, 200, 200};
    static const uint8_t rgba[16] = {9, 9, 9, 255, 80,  80,  80,  255,
                                     7, 7, 7, 255, 200, 200, 200, 255};

    for (int alpha = 0; alpha < 2; alpha++) {
        const struct gdepth gdepth = {
            .format = "RangeInverse",
            .depth = make_png_raw(2, 2, alpha ? 6 : 2, 8, alpha ? rgba : rgb, NULL)};
        struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

        assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_U8);
        assert_int_equal(sample_at(photo->depth, 1, 0), 80);
        assert_int_equal(sample_at(photo->depth, 1, 1), 200);
        refocus_photo_free(&photo);
    }
}

TEST(gdepth_units_absent_are_told)
{
    const struct gdepth gdepth = {.format = "RangeInverse",
                                  .extra = "GDepth:Near=\"2\" GDepth:Far=\"9\"",
                                  .depth = make_png(6, 4, 0, 8)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

    assert_true(has_evidence(photo, "without a unit: no metres"));
    assert_true(photo->depth->near_m == 0 && photo->depth->far_m == 0);
    assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
    refocus_photo_free(&photo);
}

/* Distances of no unit and of a strange one: disparities, and no metres. */
TEST(gdepth_linear_without_metres)
{
    static const char *const extra[] = {"GDepth:Near=\"2\" GDepth:Far=\"9\"",
                                        "GDepth:Near=\"0\" GDepth:Far=\"9\"",
                                        "GDepth:Near=\"2\" GDepth:Far=\"9\" GDepth:Units=\"feet\""};

    for (int i = 0; i < 6; i++) {
        const int bits = i % 2 ? 16 : 8, max = (1 << bits) - 1;
        const double near = i / 2 == 1 ? 0 : 2, step = (9 - near) / max;
        const double least = near > 0 ? near : step;
        const struct gdepth gdepth = {
            .format = "RangeLinear", .extra = extra[i / 2], .depth = make_png(6, 4, 0, bits)};
        struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);

        assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
        assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_U16);
        assert_true(photo->depth->value_near == 65535 && photo->depth->value_far == 0);
        assert_true(photo->depth->near_m == 0 && photo->depth->far_m == 0);
        for (int at = 0; at < 24; at++) {
            const double z = near + pattern(at % 6, at / 6, 0, max) * step;
            const double d = (1 / fmax(z, least) - 1.0 / 9) / (1 / least - 1.0 / 9);

            assert_true(fabs(sample_at(photo->depth, at % 6, at / 6) - 65535 * d) < 0.51);
        }
        refocus_photo_free(&photo);
    }
}

static double own_blur(const char *extra)
{
    const struct gdepth gdepth = {
        .format = "RangeInverse", .extra = extra, .depth = make_png(6, 4, 0, 8)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);
    const double blur = photo->info->own_blur;

    refocus_photo_free(&photo);
    return blur;
}

/* K = B (1/near - 1/far) zf, by hand; whatever the unit. Without zf that of the focus
 * point, and without a range disparity 0 is infinity. */
TEST(gdepth_own_blur)
{
    const double d = 1 - pattern(3, 2, 0, 255) / 255.0;

#define BLUR  "GFocus:BlurAtInfinity=\"0.01\" "
#define POINT "GFocus:FocalPointX=\"0.6\" GFocus:FocalPointY=\"0.6\" "
    assert_near(own_blur(BLUR "GDepth:Near=\"2\" GDepth:Far=\"10\" "
                              "GFocus:FocalDistance=\"5\""),
                0.02);
    assert_near(own_blur(BLUR "GDepth:Near=\"2\" GDepth:Far=\"10\" GDepth:Units=\"mm\" "
                              "GFocus:FocalDistance=\"5\""),
                0.02);
    assert_near(own_blur(BLUR POINT "GDepth:Near=\"2\" GDepth:Far=\"10\""),
                0.01 * 0.4 / (0.1 + 0.4 * d));
    assert_near(own_blur(BLUR POINT), 0.01 / d);
    assert_near(own_blur(BLUR), 0);
    assert_near(own_blur(POINT "GDepth:Near=\"2\" GDepth:Far=\"10\""), 0);
}

/* A focus point is both numbers, within the picture; else there is none. */
TEST(focus_point)
{
    static const char *const none[] = {
        "GFocus:FocalPointX=\"0.5\"",
        "GFocus:FocalPointY=\"0.5\"",
        "GFocus:FocalPointX=\"1.01\" GFocus:FocalPointY=\"0.5\"",
        "GFocus:FocalPointX=\"-0.01\" GFocus:FocalPointY=\"0.5\"",
        "GFocus:FocalPointX=\"0.5\" GFocus:FocalPointY=\"1.01\"",
        "GFocus:FocalPointX=\"0.5\" GFocus:FocalPointY=\"-0.01\"",
    };
    struct gdepth gdepth = {.format = "RangeInverse", .depth = make_png(6, 4, 0, 8)};
    struct refocus_photo *photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);
    const double x = photo->info->focus_x, y = photo->info->focus_y;

    refocus_photo_free(&photo);
    assert_false(x >= 0 && x <= 1);
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        gdepth.extra = none[i];
        gdepth.depth = make_png(6, 4, 0, 8);
        photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);
        assert_memory_equal(&photo->info->focus_x, &x, sizeof x);
        assert_memory_equal(&photo->info->focus_y, &y, sizeof y);
        refocus_photo_free(&photo);
    }
    gdepth.extra = "GFocus:FocalPointX=\"1\" GFocus:FocalPointY=\"0\"";
    gdepth.depth = make_png(6, 4, 0, 8);
    photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);
    assert_true(photo->info->focus_x == 1 && photo->info->focus_y == 0);
    refocus_photo_free(&photo);
}

TEST(gdepth_damaged)
{
    const struct gdepth bad[] = {
        {.format = "RangeInverse"},
        {.format = "RangeSquare", .depth = make_png(2, 2, 0, 8)},
        {.format = NULL, .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse", .extra = "GDepth:Data=\"@@@\""},
        {.format = "RangeInverse", .extra = "GDepth:Data=\"\""},
        {.format = "RangeInverse", .extra = "GDepth:Data=\"AAAA\""},
        {.format = "RangeInverse", .depth = make_png(2, 2, 2, 8)},
        {.format = "RangeInverse",
         .extra = "GDepth:Near=\"2\" GDepth:Far=\"1\"",
         .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse",
         .extra = "GDepth:Near=\"two\" GDepth:Far=\"3\"",
         .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse",
         .extra = "GFocus:FocalPointX=\"\"",
         .depth = make_png(2, 2, 0, 8)},
        {.format = "RangeInverse",
         .depth = make_png(2, 2, 0, 8),
         .original = bytes_copy("no picture", 10)},
    };

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        read_photo(make_gdepth(bad[i], 0), REFOCUS_ERR_FORMAT);
}

TEST(original_replaces_a_blurred_picture)
{
    struct gdepth gdepth = small_gdepth();
    struct refocus_photo *photo;

    gdepth.original = make_png(9, 7, 2, 8);
    photo = read_photo(make_gdepth(gdepth, 6), REFOCUS_OK);
    assert_int_equal(photo->info->original_used, 1);
    assert_int_equal(photo->image->width, 7);
    assert_int_equal(photo->image->height, 9);
    refocus_photo_free(&photo);
    gdepth = (struct gdepth){.format = "RangeInverse",
                             .extra = "GFocus:BlurAtInfinity=\"0\"",
                             .depth = make_png(2, 2, 0, 8),
                             .original = make_png(9, 7, 2, 8)};
    photo = read_photo(make_gdepth(gdepth, 0), REFOCUS_OK);
    assert_int_equal(photo->info->original_used, 0);
    assert_int_equal(photo->image->width, 48);
    assert_true(has_evidence(photo, "original passed over"));
    refocus_photo_free(&photo);
}

TEST(extended_in_any_order)
{
    static const size_t chunks[] = {64, 100, 1000, 60000};

    for (size_t i = 0; i < sizeof chunks / sizeof *chunks; i++) {
        /* 23 has no common divisor with any number of chunks here. */
        struct refocus_photo *photo = read_photo(
            make_gdepth_extended(small_gdepth(), chunks[i], i % 2 ? 23 : 1, -1), REFOCUS_OK);
        assert_int_equal(sample_at(photo->depth, 3, 2), pattern(3, 2, 0, 255));
        refocus_photo_free(&photo);
    }
}

TEST(extended_damaged)
{
    struct bytes jpeg;
    uint8_t *place;

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
    /* Two chunks at one place and none at another: the sizes still add up. */
    jpeg = make_gdepth_extended(small_gdepth(), 100, 1, -1);
    for (size_t i = 0; i + 80 < jpeg.size; i++)
        if (memcmp(jpeg.data + i, "http://ns.adobe.com/xmp/extension/", 34) == 0 &&
            memcmp(jpeg.data + i + 35 + 36, "\0\0\0\144", 4) == 0)
            jpeg.data[i + 35 + 39] = 0;
    read_photo(jpeg, REFOCUS_ERR_FORMAT);
    /* Another GUID, and a length that is not true. */
    for (int change = 0; change < 3; change++) {
        jpeg = make_gdepth_extended(small_gdepth(), 100, 1, -1);
        place = NULL;
        for (size_t i = 0; i + 80 < jpeg.size && !place; i++)
            if (memcmp(jpeg.data + i, "http://ns.adobe.com/xmp/extension/", 34) == 0)
                place = jpeg.data + i + 35;
        place[change == 0 ? 31 : change == 1 ? 35 : 39] ^= 1;
        read_photo(jpeg, REFOCUS_ERR_FORMAT);
    }
}
