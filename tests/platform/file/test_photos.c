/* test_photos.c: photos that nobody of this project made. They are not part of it: the
 * environment variable REFOCUS_PHOTOS names their folder, else it is sought beside the source. */
#include "photos.h"

#include <math.h>

#ifdef RF_HAVE_JPEG
#if defined(RF_HAVE_PNG) && defined(RF_HAVE_XMP)
TEST(lens_blur_photo)
{
    struct refocus_photo *photo = photo_of("phone/gdepth-dahlia.jpg");

    assert_sizes(photo, 1536, 2048, 1536, 2048);
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_GDEPTH);
    assert_int_equal(photo->info->original_used, 1);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
    assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
    /* 18.85 and 633.3 of an unknown unit are no metres; the blur needs none. */
    assert_true(photo->depth->near_m == 0 && photo->depth->far_m == 0);
    assert_true(fabs(photo->info->own_blur * 2048 - 22.27) < 0.01);
    assert_samples(photo->depth, 63, 248);
    assert_true(fabs(photo->info->focus_x - 0.29814816) < 1e-9);
    assert_true(fabs(photo->info->focus_y - 0.53194445) < 1e-9);
    assert_true(fabs(photo->info->focus_distance - 26.517597) < 1e-9);
    assert_true(fabs(photo->info->blur_at_infinity - 0.00796752) < 1e-9);
    assert_string_equal(photo->info->camera, "Motorola XT912");
    /* The focus point lies on the flower, nearer than the map's middle: polarity holds.
     */
    assert_true(sample_at(photo->depth, (int)(photo->info->focus_x * 1536),
                          (int)(photo->info->focus_y * 2048)) < 155);
    refocus_photo_free(&photo);
}
#endif

#ifdef RF_HAVE_XMP
TEST(apple_jpeg)
{
    struct refocus_photo *photo = photo_of("phone/apple-jpeg-cup.jpg");

    assert_sizes(photo, 4032, 3024, 768, 576);
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_APPLE_MPF);
    assert_true(photo->depth->value_near == 255 && photo->depth->value_far == 0);
    assert_true(fabs(photo->depth->near_m - 1 / 4.835938) < 1e-9);
    assert_true(photo->info->simulated_f_number == 2.8);
    assert_true(fabs(photo->depth->far_m - 1 / 0.229614) < 1e-9);
    assert_true(has_evidence(photo, "gain map: passed over, the photo does not say its headroom"));
    assert_true(has_evidence(photo, "relative"));
    assert_int_equal(photo->icc.size, 548);
    assert_true(photo->info->focal_length_35mm == 26);
    refocus_photo_free(&photo);
}
#endif

TEST(triples)
{
    struct refocus_photo *depth = depth_of("lens-blur-triples/hut-depth.jpg", "inverse");
    struct refocus_photo *photo = photo_of("lens-blur-triples/hut-alternative.jpg");

    assert_int_equal(depth->depth->width, 580);
    assert_int_equal(depth->depth->height, 1024);
    assert_true(depth->depth->value_near == 0 && depth->depth->value_far == 255);
    assert_null(photo->depth->samples);
    refocus_photo_free(&photo);
    refocus_photo_free(&depth);
    depth = depth_of("lens-blur-triples/flowers-depth.jpg", "inverse");
    assert_int_equal(depth->depth->width, 680);
    refocus_photo_free(&depth);
}

TEST(network_depth)
{
    struct refocus_photo *depth = depth_of("mono/street_8_disparity.jpg", NULL);

    assert_int_equal(depth->depth->width, 2000);
    assert_true(depth->depth->value_near == 255);
    assert_samples(depth->depth, 0, 255);
    refocus_photo_free(&depth);
}
#endif

#ifdef RF_HAVE_PNG
static double part_of_zeros(const char *name)
{
    struct refocus_photo *depth = depth_of(name, "5000/m");
    int zeros = 0;

    assert_int_equal(depth->depth->sample, REFOCUS_SAMPLE_U16);
    assert_int_equal(depth->depth->flags, REFOCUS_DEPTH_ZERO_IS_UNKNOWN);
    assert_near(depth->depth->metres_per_unit, 1 / 5000.0);
    for (int i = 0; i < 640 * 480; i++)
        zeros += sample_at(depth->depth, i % 640, i / 640) == 0;
    refocus_photo_free(&depth);
    return zeros / (640 * 480.0);
}

TEST(kinect)
{
    assert_true(fabs(part_of_zeros("rgbd/tum-office-depth.png") - 0.192) < 0.001);
    assert_true(fabs(part_of_zeros("rgbd/tum-fr2-desk-depth.png") - 0.333) < 0.001);
}

TEST(stereo_truth)
{
    struct refocus_photo *depth = depth_of("stereo-gt/aloeGT.png", NULL);

    assert_int_equal(depth->depth->width, 1282);
    assert_samples(depth->depth, 0, 211);
    refocus_photo_free(&depth);
}
#endif

TEST(light_field_truth)
{
    struct refocus_photo *depth = depth_of("light-field/antinous/gt_disp_lowres.pfm", NULL);
    double low = INFINITY, high = -INFINITY;

    assert_int_equal(depth->depth->width, 512);
    for (int i = 0; i < 512 * 512; i++) {
        const double v = float_at(depth->depth, i % 512, i / 512);
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
    assert_true(fabs(low + 3.1308) < 1e-4 && fabs(high - 2.6887) < 1e-4);
    /* "Larger is nearer, measured": see value_near in depth.h. */
    assert_true(depth->depth->value_near == depth->depth->value_far);
    refocus_photo_free(&depth);
}

#ifdef RF_HAVE_HEIC
TEST(heic_depth)
{
    struct refocus_photo *photo = photo_of("phone/apple-heic-pug.heic");

    assert_string_equal(photo->info->container, "HEIC");
    assert_sizes(photo, 4032, 3024, 768, 576);
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_HEIF);
    assert_true(photo->depth->value_near == 255 && photo->depth->value_far == 0);
    assert_true(fabs(photo->depth->near_m - 1 / 4.382812) < 1e-6);
    assert_true(fabs(photo->depth->far_m - 1 / 1.498047) < 1e-6);
#ifdef RF_HAVE_XMP
    assert_true(photo->info->simulated_f_number == 2.8);
#endif
    assert_true(has_evidence(photo, "gain map: passed over, the photo does not say its headroom"));
    assert_string_equal(photo->info->camera, "Apple iPhone 13 Pro");
    assert_int_equal(photo->info->orientation, 1);
    refocus_photo_free(&photo);
}

/* EXIF begins so many bytes behind its first four as those say: six, and where there are
 * none any more. */
TEST(heic_exif_lies_within)
{
    static const uint8_t skips[][4] = {
        {0, 0, 0, 6}, {0, 1, 0, 0}, {0x7f, 0xff, 0xff, 0xff}, {0xff, 0xff, 0xff, 0xff}};

    for (size_t i = 0; i < sizeof skips / sizeof *skips; i++) {
        struct bytes file = load("phone/apple-heic-pug.heic");
        struct refocus_photo *photo;
        size_t at = 10;

        while (at + 8 < file.size && memcmp(file.data + at, "MM\0*\0\0\0\10", 8) != 0)
            at++;
        assert_true(at + 8 < file.size);
        memcpy(file.data + at - 10, skips[i], 4);
        photo = read_depth(file, NULL, REFOCUS_OK);
        assert_true(fabs(photo->info->f_number - (i == 0 ? 1.5 : 0)) < 0.01);
        refocus_photo_free(&photo);
    }
}

/* The container's rotation by 90 degrees anticlockwise: photo and depth follow, once.
 */
TEST(heic_turned)
{
    struct refocus_photo *straight = photo_of("phone/apple-heic-pug.heic"), *turned;
    struct bytes file = load("phone/apple-heic-pug.heic");

    for (size_t i = 0; i + 8 < file.size; i++)
        if (memcmp(file.data + i, "irot", 4) == 0)
            file.data[i + 4] = 1;
    turned = read_photo(file, REFOCUS_OK);
    assert_sizes(turned, 3024, 4032, 576, 768);
    assert_int_equal(turned->info->stored_width, 4032);
    assert_int_equal(turned->info->orientation, 8);
    for (int i = 0; i < 768 * 576; i += 101) {
        const int x = i % 768, y = i / 768;
        assert_int_equal(sample_at(turned->depth, y, 767 - x), sample_at(straight->depth, x, y));
    }
    for (int i = 0; i < 4032 * 3024; i += 10007) {
        const int x = i % 4032, y = i / 4032;
        for (int c = 0; c < 3; c++) {
            assert_true(abs(pixel_at(turned->image, y, 4031 - x)[c] -
                            pixel_at(straight->image, x, y)[c]) <= 24);
        }
    }
    refocus_photo_free(&turned);
    refocus_photo_free(&straight);
}

/* A depth image without a rotation of its own lies as the stored main picture does. */
TEST(heic_depth_without_rotation)
{
    struct refocus_photo *straight = photo_of("phone/apple-heic-pug.heic"), *turned;
    struct bytes file = load("phone/apple-heic-pug.heic");
    int changed = 0;

    for (size_t i = 0; i + 8 < file.size; i++) {
        /* Item 54, five properties, among them 5, the rotation; 2 is a size. */
        static const uint8_t association[] = {0, 54, 5};
        if (memcmp(file.data + i, "irot", 4) == 0)
            file.data[i + 4] = 3;
        if (changed == 0 && memcmp(file.data + i, association, 3) == 0 &&
            (file.data[i + 5] & 127) == 5) {
            file.data[i + 5] = 13;
            changed = 1;
        }
    }
    assert_int_equal(changed, 1);
    turned = read_photo(file, REFOCUS_OK);
    assert_sizes(turned, 3024, 4032, 576, 768);
    assert_int_equal(turned->info->orientation, 6);
    for (int i = 0; i < 768 * 576; i += 101) {
        const int x = i % 768, y = i / 768;
        assert_int_equal(sample_at(turned->depth, 575 - y, x), sample_at(straight->depth, x, y));
    }
    refocus_photo_free(&turned);
    refocus_photo_free(&straight);
}

TEST(heic_cut_and_limited)
{
    struct bytes file = load("phone/apple-heic-pug.heic");
    const struct refocus_read_limits limits = {.struct_size = sizeof(struct refocus_read_limits),
                                               .max_pixels = 4032 * 3024 - 1};
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;

    for (size_t k = 0; k < 40; k++) {
        /* The boxes closely, the picture data in steps. */
        const size_t size = k < 24 ? k * k * 7 : file.size / 16 * (k - 24) + 5;
        uint8_t *const copy = malloc(size ? size : 1);
        int status;

        memcpy(copy, file.data, size);
        status = refocus_photo_read_memory(&photo, copy, size, NULL, &reason);
        free(copy);
        if (status == REFOCUS_OK)
            fail_msg("cut at %zu of %zu is read as if whole", size, file.size);
    }
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &limits, &reason),
                     REFOCUS_ERR_SIZE);
    bytes_free(&file);
}

TEST(heic_without_depth)
{
    struct refocus_photo *photo = photo_of("stereo/spatial-photo.heic");

    assert_int_equal(photo->image->width, 2560);
    assert_null(photo->depth->samples);
    refocus_photo_free(&photo);
}
#endif

int main(void)
{
    if (!find_photos()) {
        printf("SKIPPED: no photos in %s; set REFOCUS_PHOTOS to their folder\n", photos_folder);
        return 77;
    }
    return unit_test_run(NULL, NULL);
}
