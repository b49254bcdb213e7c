/* test_jpeg.c: JPEG photos: orientation, EXIF, ICC. */
#include <stdlib.h>
#include <turbojpeg.h>

#include "check.h"
#include "original.h"

#ifdef RF_HAVE_PNG
TEST(orientation_of_png)
{
    for (int orientation = 1; orientation <= 8; orientation++) {
        for (int big_endian = 0; big_endian < 2; big_endian++) {
            struct bytes exif = make_exif(big_endian, orientation);
            uint8_t samples[5 * 3 * 3];
            struct refocus_photo *photo;

            for (int i = 0; i < 45; i++)
                samples[i] = (uint8_t)pattern(i / 3 % 5, i / 15, i % 3, 255);
            photo = read_photo(make_png_raw(5, 3, 2, 8, samples, &exif), REFOCUS_OK);
            bytes_free(&exif);
            assert_int_equal(photo->info->orientation, orientation);
            assert_int_equal(photo->info->stored_width, 5);
            assert_int_equal(photo->info->stored_height, 3);
            assert_int_equal(photo->image->width, orientation < 5 ? 5 : 3);
            for (int i = 0; i < 15; i++) {
                int x, y;
                upright_place(orientation, 5, 3, i % 5, i / 5, &x, &y);
                assert_memory_equal(pixel_at(photo->image, x, y), samples + 3 * i, 3);
            }
            refocus_photo_free(&photo);
        }
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
        if (i != skip)
            jpeg_insert(&jpeg, 0xe2, signature, 14, profile.data + from, size);
    }
    return jpeg;
}

TEST(icc_in_chunks)
{
    uint8_t profile[300];
    struct refocus_photo *photo;

    for (int i = 0; i < 300; i++)
        profile[i] = (uint8_t)i;
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

/* One part of no bytes. */
TEST(icc_of_nothing)
{
    struct bytes jpeg = make_jpeg(32, 16, false, false);
    struct refocus_photo *photo;

    jpeg_insert(&jpeg, 0xe2, "ICC_PROFILE\0\1\1", 14, "", 0);
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_null(photo->icc.data);
    assert_true(has_evidence(photo, "ICC profile: damaged"));
    refocus_photo_free(&photo);
}

TEST(exif_facts)
{
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct bytes jpeg = make_jpeg(32, 16, false, false);
        struct bytes expected = make_exif(big_endian, 1);
        struct refocus_photo *photo;

        jpeg_insert_exif(&jpeg, make_exif(big_endian, 8));
        photo = read_photo(jpeg, REFOCUS_OK);
        assert_string_equal(photo->info->camera, "Maker Model X");
        assert_true(photo->info->focal_length_mm == 50.5);
        assert_true(photo->info->focal_length_35mm == 75);
        assert_true(photo->info->f_number == 1.8);
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

TEST(exif_without_sense)
{
    struct bytes jpeg = make_jpeg(32, 16, false, false);
    struct refocus_photo *photo;

    jpeg_insert_exif(&jpeg, make_exif(true, 9));
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_int_equal(photo->info->orientation, 1);
    refocus_photo_free(&photo);
    jpeg = make_jpeg(32, 16, false, false);
    jpeg_insert_exif(&jpeg, bytes_copy("MM\0*\377\377\377\377", 8));
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_null(photo->exif.data);
    assert_true(has_evidence(photo, "EXIF: damaged"));
    refocus_photo_free(&photo);
}

/* Some cameras leave a byte or two before the end; damage inside is an error. */
TEST(bytes_too_many)
{
    struct bytes jpeg = make_jpeg(64, 64, false, false);
    struct refocus_photo *photo;

    jpeg.size -= 2;
    bytes_add(&jpeg, "UUUUUUUUUUUU\xff\xd9", 14);
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_in_range(pixel_at(photo->image, 5, 5)[0], 245, 255);
    refocus_photo_free(&photo);
    jpeg = make_jpeg(64, 64, false, false);
    jpeg.size -= 2;
    for (int i = 0; i < 120; i++)
        bytes_add(&jpeg, "U", 1);
    bytes_add(&jpeg, "\xff\xd9", 2);
    read_photo(jpeg, REFOCUS_ERR_FORMAT);
    jpeg = make_jpeg(64, 64, false, false);
    memset(jpeg.data + jpeg.size - 40, 0, 20);
    read_photo(jpeg, REFOCUS_ERR_FORMAT);
}

TEST(grey_jpeg_is_depth)
{
    struct refocus_photo *photo = read_depth(make_jpeg(32, 16, true, false), "inverse", REFOCUS_OK);

    assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
    assert_in_range(sample_at(photo->depth, 2, 2), 28, 36);
    refocus_photo_free(&photo);
    read_depth(make_jpeg(32, 16, false, false), NULL, REFOCUS_ERR_NO_DEPTH);
}

/* The original of an editable result says how its pixels lie, as the photo did. */
TEST(original_says_how_it_lies)
{
    for (int orientation = 1; orientation <= 8; orientation++) {
        struct bytes file = make_jpeg(32, 16, false, false);
        struct rf_text out = {NULL, 0, 0, false};
        struct refocus_photo *photo;
        bool is_png = true;

        jpeg_insert_exif(&file, make_exif(true, orientation));
        photo = read_photo(file, REFOCUS_OK);
        assert_int_equal(rf_original_put(&out, photo, &is_png, NULL), REFOCUS_OK);
        refocus_photo_free(&photo);
        assert_false(is_png || out.failed);
        photo = read_photo(bytes_copy(out.data, out.size), REFOCUS_OK);
        assert_int_equal(photo->info->orientation, orientation);
        assert_int_equal(photo->image->width, orientation < 5 ? 32 : 16);
        refocus_photo_free(&photo);
        free(out.data);
    }
}

enum { HALF_W = 33, HALF_H = 17 }; /* odd: the last samples of colour are of fewer pixels */

/* Pixels as a JPEG with colour of half the size. */
static struct bytes with_half_colour(const uint8_t *rgb, int quality)
{
    struct bytes jpeg = {NULL, 0};
    unsigned char *data = NULL;
    unsigned long size = 0;
    tjhandle encoder = tjInitCompress();

    assert_non_null(encoder);
    assert_int_equal(tjCompress2(encoder, rgb, HALF_W, 0, HALF_H, TJPF_RGB, &data, &size,
                                 TJSAMP_420, quality, TJFLAG_ACCURATEDCT),
                     0);
    tjDestroy(encoder);
    bytes_add(&jpeg, data, size);
    tjFree(data);
    return jpeg;
}

/* As TurboJPEG enlarges the colour, by interpolation. */
static void interpolated(uint8_t *rgb, struct bytes jpeg)
{
    tjhandle decoder = tjInitDecompress();

    assert_non_null(decoder);
    assert_int_equal(tjDecompress2(decoder, jpeg.data, (unsigned long)jpeg.size, rgb, HALF_W, 0,
                                   HALF_H, TJPF_RGB, TJFLAG_ACCURATEDCT),
                     0);
    tjDestroy(decoder);
}

static long difference_of(const uint8_t *a, const uint8_t *b, int *most)
{
    long sum = 0;

    *most = 0;
    for (int i = 0; i < 3 * HALF_W * HALF_H; i++) {
        const int d = abs(a[i] - b[i]);

        *most = d > *most ? d : *most;
        sum += d * d;
    }
    return sum;
}

/* Two colours of luma 90. */
static const uint8_t warm[3] = {150, 73, 27}, cold[3] = {30, 106, 168};

/* An edge between samples of colour is sharp where luma has it, in columns and in rows: less than a
 * quarter of the squared error that interpolation leaves. Where colour alone changes, and less than
 * was quantised away, it is interpolated as TurboJPEG does it, but for rounding. */
TEST(colour_follows_luma)
{
    static const uint8_t bright[3] = {210, 90, 60}, dark[3] = {30, 60, 110};
    uint8_t rgb[3 * HALF_W * HALF_H], plain[sizeof rgb];

    for (int kind = 0; kind < 3; kind++) {
        struct refocus_photo *photo;
        struct bytes jpeg;
        int most, most_plain;

        for (int i = 0; i < HALF_W * HALF_H; i++) {
            const bool here = kind == 1 ? i / HALF_W < 7 : i % HALF_W < 15;

            memcpy(rgb + 3 * i, here ? bright : dark, 3);
        }
        for (int i = 0; kind == 2 && i < HALF_W * HALF_H; i++)
            memcpy(rgb + 3 * i, i % HALF_W < 15 ? warm : cold, 3);
        jpeg = with_half_colour(rgb, kind == 2 ? 25 : 100);
        interpolated(plain, jpeg);
        photo = read_photo(jpeg, REFOCUS_OK);
        assert_int_equal(photo->image->width, HALF_W);
        assert_int_equal(photo->image->stride[0], 3 * HALF_W);
        if (kind < 2) {
            const long left = difference_of(plain, rgb, &most_plain);

            assert_true(left > 50000);
            assert_true(4 * difference_of(photo->image->plane[0], rgb, &most) < left);
            assert_true(2 * most < most_plain);
        } else {
            difference_of(photo->image->plane[0], plain, &most);
            assert_in_range(most, 0, 4);
        }
        refocus_photo_free(&photo);
    }
}

/* Stripes of colours that are three pixels wide keep the means that the file has: a
 * quarter of the squared error that interpolation leaves is gone, and more. */
TEST(colour_keeps_its_means)
{
    for (int by_rows = 0; by_rows < 2; by_rows++) {
        uint8_t rgb[3 * HALF_W * HALF_H], plain[sizeof rgb];
        struct refocus_photo *photo;
        struct bytes jpeg;
        int most;

        for (int i = 0; i < HALF_W * HALF_H; i++)
            memcpy(rgb + 3 * i, (by_rows ? i / HALF_W : i % HALF_W) / 3 % 2 ? warm : cold, 3);
        jpeg = with_half_colour(rgb, 95);
        interpolated(plain, jpeg);
        photo = read_photo(jpeg, REFOCUS_OK);
        assert_true(4 * difference_of(photo->image->plane[0], rgb, &most) <
                    3 * difference_of(plain, rgb, &most));
        refocus_photo_free(&photo);
    }
}

/* Whole files of kinds that TurboJPEG does not decode are not called damaged. */
TEST(rare_kinds_are_told)
{
    static const struct {
        uint8_t marker, bits;
    } kinds[] = {{0xc1, 12}, {0xc3, 8}, {0xc3, 16}, {0xc5, 8}, {0xcb, 8}};

    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct bytes jpeg = make_jpeg(16, 16, false, false);

        for (size_t k = 2; k + 4 < jpeg.size; k++) {
            if (memcmp(jpeg.data + k, "\xff\xc0\0\x11", 4) == 0) {
                jpeg.data[k + 1] = kinds[i].marker;
                jpeg.data[k + 4] = kinds[i].bits;
            }
        }
        assert_null(read_photo(jpeg, REFOCUS_ERR_UNSUPPORTED));
    }
}
