/* test_png.c: photos and depth maps of PNG, of all kinds of samples. */
#include "check.h"
#include "make_formats.h"

#include <math.h>

TEST(png_kinds)
{
    static const int kinds[][2] = {{0, 8}, {0, 16}, {2, 8}, {2, 16}, {3, 8},
                                   {4, 8}, {4, 16}, {6, 8}, {6, 16}};

    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const int type = kinds[i][0], bits = kinds[i][1];
        struct refocus_photo *photo = read_photo(make_png(7, 5, type, bits), REFOCUS_OK);

        assert_string_equal(photo->info->container, "PNG");
        assert_int_equal(photo->info->stored_bits, bits);
        assert_int_equal(photo->image->width, 7);
        assert_true(!photo->deep->plane[0] == (bits == 8));
        for (int y = 0; y < 5; y++) {
            for (int x = 0; x < 7; x++) {
                for (int c = 0; c < 3; c++) {
                    const unsigned max = bits == 16 ? 65535 : 255;
                    const unsigned v = pattern(x, y, type & 2 && type != 3 ? c : 0, max);
                    const int code = pixel_at(photo->image, x, y)[c];
                    uint16_t all;

                    if (bits == 16) { /* dithered: one of the two beside it */
                        assert_true(fabs(code - v * 255.0 / max) < 1);
                        memcpy(&all,
                               photo->deep->plane[0] + y * photo->deep->stride[0] + 2 * (3 * x + c),
                               2);
                        assert_int_equal(all, v);
                    } else {
                        assert_int_equal(code, (v * 255 + max / 2) / max);
                    }
                }
            }
        }
        refocus_photo_free(&photo);
    }
}

enum { DITHER_WIDE = 128, DITHER_HIGH = 64 };

/* 16 bits of a gradient that climbs a code from left to right, and grey on its right. */
static unsigned shallow(int x, int y, int channel)
{
    const int across = x < 96 ? x : 2 * (x - 96);

    return (unsigned)(25700 + 3 * across + (x < 96 ? 31 * channel : 0) + y % 2);
}

/* Means over 8 x 8 pixels are kept, wherever they lie; white, black and the codes that 8
 * bits have stay what they are; grey stays grey; and twice is the same. */
TEST(more_than_8_bits_are_dithered)
{
    static uint8_t samples[DITHER_WIDE * DITHER_HIGH * 6];
    struct refocus_photo *photo, *again;
    int rounded = 0;

    for (int i = 0; i < DITHER_WIDE * DITHER_HIGH * 3; i++) {
        const unsigned v = shallow(i / 3 % DITHER_WIDE, i / 3 / DITHER_WIDE, i % 3);

        samples[2 * i] = (uint8_t)(v >> 8);
        samples[2 * i + 1] = (uint8_t)v;
    }
    photo = read_photo(make_png_raw(DITHER_WIDE, DITHER_HIGH, 2, 16, samples, NULL), REFOCUS_OK);
    again = read_photo(make_png_raw(DITHER_WIDE, DITHER_HIGH, 2, 16, samples, NULL), REFOCUS_OK);
    assert_memory_equal(photo->image->plane[0], again->image->plane[0], sizeof samples / 2);
    refocus_photo_free(&again);
    for (int top = 0; top <= DITHER_HIGH - 8; top += 3) {
        for (int left = 0; left <= DITHER_WIDE - 8; left++) {
            for (int c = 0; c < 3; c++) {
                double code = 0, wanted = 0, nearest = 0;

                for (int i = 0; i < 64; i++) {
                    const int x = left + i % 8, y = top + i / 8;
                    const double v = shallow(x, y, c) / 257.0;

                    code += pixel_at(photo->image, x, y)[c] / 64.0;
                    wanted += v / 64.0;
                    nearest += floor(v + 0.5) / 64.0;
                    assert_true(fabs(pixel_at(photo->image, x, y)[c] - v) < 1);
                }
                assert_true(fabs(code - wanted) < 0.06);
                rounded += fabs(nearest - wanted) > 0.4;
            }
        }
    }
    assert_true(rounded > 100); /* a place where codes rounded to nearest are far off */
    for (int x = 96; x < DITHER_WIDE; x++) {
        const uint8_t *const pixel = pixel_at(photo->image, x, 5);

        assert_true(pixel[0] == pixel[1] && pixel[1] == pixel[2]);
    }
    refocus_photo_free(&photo);
    for (int code = 0; code < 256; code++) {
        memset(samples, code, sizeof samples); /* 257 code */
        photo = read_photo(make_png_raw(9, 9, 0, 16, samples, NULL), REFOCUS_OK);
        for (int i = 0; i < 9 * 9; i++)
            assert_int_equal(pixel_at(photo->image, i % 9, i / 9)[0], code);
        refocus_photo_free(&photo);
    }
}

TEST(png_small_samples)
{
    /* 5 pixels of 2 bits: 0 1 2 3 0 */
    struct refocus_photo *photo =
        read_photo(make_png_raw(5, 1, 0, 2, (const uint8_t *)"\x1b\x00", NULL), REFOCUS_OK);

    assert_int_equal(pixel_at(photo->image, 1, 0)[0], 85);
    assert_int_equal(pixel_at(photo->image, 3, 0)[0], 255);
    refocus_photo_free(&photo);
}

TEST(png_depth)
{
    struct refocus_photo *photo = read_depth(make_png(6, 4, 0, 16), "5000/m", REFOCUS_OK);
    uint8_t grey_rgb[2 * 3 * 2];

    assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_U16);
    assert_int_equal(sample_at(photo->depth, 5, 3), pattern(5, 3, 0, 65535));
    assert_near(photo->depth->metres_per_unit, 1 / 5000.0);
    refocus_photo_free(&photo);
    read_depth(make_png(6, 4, 2, 8), NULL, REFOCUS_ERR_NO_DEPTH);
    for (int i = 0; i < 12; i++)
        grey_rgb[i] = (uint8_t)(i / 3 * 20);
    photo = read_depth(make_png_raw(2, 2, 2, 8, grey_rgb, NULL), NULL, REFOCUS_OK);
    assert_int_equal(sample_at(photo->depth, 1, 1), 60);
    assert_true(photo->depth->value_near == 255);
    refocus_photo_free(&photo);
    grey_rgb[11] ^= 1;
    read_depth(make_png_raw(2, 2, 2, 8, grey_rgb, NULL), NULL, REFOCUS_ERR_NO_DEPTH);
}

/* A sample without opacity is no distance; the others keep their codes and the ends of the codes.
 */
TEST(transparent_samples_are_unknown)
{
    static const uint8_t grey8[] = {0, 255, 7, 0, 255, 1, 255, 255};
    static const uint8_t rgb16[] = {1, 2, 1, 2, 1, 2, 255, 255, 9, 9, 9, 9, 9, 9, 0, 0};
    struct refocus_photo *photo =
        read_depth(make_png_raw(2, 2, 4, 8, grey8, NULL), "inverse", REFOCUS_OK);

    assert_true(float_at(photo->depth, 0, 0) == 0);
    assert_true(isnan(float_at(photo->depth, 1, 0)));
    assert_true(float_at(photo->depth, 0, 1) == 255);
    assert_true(float_at(photo->depth, 1, 1) == 255);
    assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
    assert_int_equal(photo->info->stored_bits, 8);
    assert_true(has_evidence(photo, "1 samples are transparent"));
    assert_true(has_evidence(photo, "8-bit"));
    assert_false(has_evidence(photo, "dropped"));
    refocus_photo_free(&photo);
    photo = read_depth(make_png_raw(2, 1, 6, 16, rgb16, NULL), "mm", REFOCUS_OK);
    assert_true(float_at(photo->depth, 0, 0) == 0x102);
    assert_true(isnan(float_at(photo->depth, 1, 0)));
    refocus_photo_free(&photo);
    /* Indices 0 and 1 of the palette have an opacity of 0 and 128. */
    photo = read_depth(make_png_raw(2, 1, 3, 8, (const uint8_t *)"\0\1", NULL), NULL, REFOCUS_OK);
    assert_true(isnan(float_at(photo->depth, 0, 0)));
    assert_true(float_at(photo->depth, 1, 0) == 1);
    refocus_photo_free(&photo);
    /* None is transparent: codes stay codes. */
    photo = read_depth(make_png_raw(2, 1, 4, 8, grey8 + 4, NULL), NULL, REFOCUS_OK);
    assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_U8);
    assert_int_equal(sample_at(photo->depth, 1, 0), 255);
    assert_true(has_evidence(photo, "dropped"));
    refocus_photo_free(&photo);
}

/* Only the header's size is changed, its checksum mended. */
static struct bytes png_of_size(uint64_t width, uint64_t height)
{
    struct bytes png = {NULL, 0}, header = {NULL, 0};

    bytes_add(&png, "\x89PNG\r\n\x1a\n", 8);
    bytes_number(&header, width, 4, true);
    bytes_number(&header, height, 4, true);
    bytes_add(&header, "\10\2\0\0\0", 5);
    png_chunk(&png, "IHDR", header.data, header.size);
    png_chunk(&png, "IDAT", "x", 1);
    png_chunk(&png, "IEND", "", 0);
    bytes_free(&header);
    return png;
}

TEST(png_absurd)
{
    read_photo(png_of_size(0x7fffffff, 0x7fffffff), REFOCUS_ERR_SIZE);
    read_photo(png_of_size(65535, 65535), REFOCUS_ERR_SIZE);
    read_photo(png_of_size(65536, 1), REFOCUS_ERR_SIZE);
    read_photo(png_of_size(0x80000000u, 1), REFOCUS_ERR_FORMAT);
    read_photo(png_of_size(0, 1), REFOCUS_ERR_FORMAT);
    read_photo(png_of_size(8, 8), REFOCUS_ERR_FORMAT);
}

/* A PNG with a chunk behind its header. */
static struct bytes with_chunk(struct bytes png, const char *type, const void *data, size_t size)
{
    enum { HEADER = 33 };
    struct bytes whole = bytes_copy(png.data, HEADER);

    png_chunk(&whole, type, data, size);
    bytes_add(&whole, png.data + HEADER, png.size - HEADER);
    bytes_free(&png);
    return whole;
}

static bool tells(const struct refocus_photo *photo, const char *words)
{
    for (int i = 0; i < photo->info->evidence_count; i++)
        if (strstr(photo->info->evidence[i], words))
            return true;
    return false;
}

/* White of PQ, 203 cd/m2, is the code .580689 (ITU-R BT.2408), and 1000 cd/m2 are .751827; white of
 * HLG is .75; a linear code is light. */
TEST(code_points_of_hdr_are_light)
{
    static const struct {
        uint8_t curve;
        uint16_t code;
        double light;
    } kinds[] = {{16, 38055, 1}, {16, 49271, 1000.0 / 203}, {18, 49151, 1}, {8, 16384, 0.25}};

    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const uint8_t code_points[4] = {9, kinds[i].curve, 0, 1};
        uint8_t samples[6];
        struct refocus_photo *photo;

        for (int c = 0; c < 3; c++) {
            samples[2 * c] = (uint8_t)(kinds[i].code >> 8);
            samples[2 * c + 1] = (uint8_t)kinds[i].code;
        }
        photo =
            read_photo(with_chunk(make_png_raw(1, 1, 2, 16, samples, NULL), "cICP", code_points, 4),
                       REFOCUS_OK);
        assert_int_equal(photo->info->stored_bits, 16);
        assert_true(tells(photo, "read as linear light"));
        assert_int_equal(photo->deep->format, REFOCUS_FORMAT_RGB_FLOAT);
        for (int c = 0; c < 3; c++) {
            float light;

            memcpy(&light, photo->deep->plane[0] + 4 * c, 4);
            assert_true(fabs((double)light / kinds[i].light - 1) < 0.001);
        }
        refocus_photo_free(&photo);
    }
}

/* All other colours are codes as before, and told; a depth map has no colours. */
TEST(other_colours_are_told)
{
    static const struct {
        int type, bits;
        const char *chunk;
        const char *content;
        size_t size;
        bool told;
    } kinds[] = {{2, 8, "cICP", "\x09\x10\0\1", 4, true},
                 {0, 16, "cICP", "\x09\x10\0\1", 4, true},
                 {2, 16, "cICP", "\x09\x10\0\0", 4, true},
                 {2, 16, "cICP", "\x0c\x0d\0\1", 4, true},
                 {2, 16, "cICP", "\1\x0d\0\1", 4, false},
                 {2, 16, "cICP", "\x09\x10\0", 3, false},
                 {2, 8, "gAMA", "\0\1\x86\xa0", 4, true},
                 {2, 8, "gAMA", "\0\0\xb1\x8e", 4, false},
                 {2, 8, "cHRM",
                  "\0\0\x7a\x26\0\0\x80\x84\0\0\xfa\0\0\0\x80\xe8"
                  "\0\0\x52\x08\0\1\x15\x58\0\0\x3a\x98\0\0\x17\x70",
                  32, true},
                 {2, 8, "cHRM",
                  "\0\0\x7a\x26\0\0\x80\x84\0\0\xfa\0\0\0\x80\xe8"
                  "\0\0\x75\x30\0\0\xea\x60\0\0\x3a\x98\0\0\x17\x70",
                  32, false}};

    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const int type = kinds[i].type, bits = kinds[i].bits;
        struct refocus_photo *photo =
                                 read_photo(with_chunk(make_png(7, 5, type, bits), kinds[i].chunk,
                                                       kinds[i].content, kinds[i].size),
                                            REFOCUS_OK),
                             *plain = read_photo(make_png(7, 5, type, bits), REFOCUS_OK);

        assert_int_equal(tells(photo, "other colours than sRGB"), kinds[i].told);
        assert_int_equal(photo->deep->format, plain->deep->format);
        assert_memory_equal(photo->image->plane[0], plain->image->plane[0], 3 * 7 * 5);
        refocus_photo_free(&plain);
        refocus_photo_free(&photo);
    }
    {
        struct refocus_photo *map = read_depth(
            with_chunk(make_png(7, 5, 0, 16), "cICP", "\x09\x10\0\1", 4), NULL, REFOCUS_OK);

        assert_int_equal(map->depth->sample, REFOCUS_SAMPLE_U16);
        assert_int_equal(sample_at(map->depth, 3, 2), pattern(3, 2, 0, 65535));
        refocus_photo_free(&map);
    }
}
