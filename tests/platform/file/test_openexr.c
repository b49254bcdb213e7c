/* test_openexr.c: OpenEXR is read channel by channel, as a photo and as depth, and written. */
#include "format_checks.h"
#include "make_formats.h"

#include <float.h>
#include <math.h>
#include <unistd.h>

TEST(exr_colour_and_depth)
{
    struct bytes file = make_exr(W, H, "B G R Z", -3, 7);
    struct refocus_photo *photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);

    assert_string_equal(photo->info->container, "OpenEXR");
    assert_int_equal(photo->info->stored_bits, 0);
    for (int i = 0; i < 3 * W * H; i++) {
        const int x = i / 3 % W, y = i / 3 / W, c = i % 3;

        assert_true(light_at(photo->deep, x, y, c) == (float)pattern(x, y, 2 - c, 255) / 64);
    }
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    assert_true(float_at(photo->depth, 1, 3) == (double)((float)pattern(1, 3, 3, 255) / 64));
    refocus_photo_free(&photo);
    photo = read_depth(bytes_copy(file.data, file.size), NULL, REFOCUS_OK);
    assert_null(photo->image->plane[0]);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    refocus_photo_free(&photo);
    refuse_cut(file, false);
    refuse_large(file);
    bytes_free(&file);
}

TEST(exr_layers)
{
    struct refocus_photo *photo =
        read_photo(make_exr(W, H, "beauty.B beauty.G beauty.R depth.Z normal.X", 0, 0), REFOCUS_OK);

    assert_true(light_at(photo->deep, 2, 1, 0) == (float)pattern(2, 1, 2, 255) / 64);
    assert_true(float_at(photo->depth, 2, 1) == (double)((float)pattern(2, 1, 3, 255) / 64));
    assert_true(has_evidence(photo, "beauty.R"));
    refocus_photo_free(&photo);
    photo = read_photo(make_exr(W, H, "Y", 0, 0), REFOCUS_OK);
    assert_true(light_at(photo->deep, 2, 1, 2) == (float)pattern(2, 1, 0, 255) / 64);
    refocus_photo_free(&photo);
    photo = read_depth(make_exr(W, H, "disparity", 0, 0), NULL, REFOCUS_OK);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
    refocus_photo_free(&photo);
    read_photo(make_exr(W, H, "Z", 0, 0), REFOCUS_ERR_UNSUPPORTED);
    read_depth(make_exr(W, H, "B G R", 0, 0), NULL, REFOCUS_ERR_NO_DEPTH);
    read_depth(make_exr(W, H, "P Q", 0, 0), NULL, REFOCUS_ERR_NO_DEPTH);
}

/* The picture and its depth are found among the many layers that renderers write. Channels are
 * counted in the order of their names. */
TEST(exr_many_layers)
{
    static const struct {
        const char *channels;
        int red, green, blue, depth;
        const char *taken;
    } cases[] = {
        {"Combined.B Combined.G Combined.R Depth.V Normal.X Normal.Y Normal.Z", 2, 1, 0, 3,
         "taken Combined.R G B Depth.V"},
        {"B Camera.Normal.X Camera.Normal.Y Camera.Normal.Z Depth.Z G R", 6, 5, 0, 4,
         "taken R G B Depth.Z"},
        {"AO.B AO.G AO.R Combined.B Combined.G Combined.R Depth.Z", 5, 4, 3, 6,
         "taken Combined.R G B Depth.Z"},
        {"AO.R V.Beauty.B V.Beauty.G V.Beauty.R V.Depth.Z", 3, 2, 1, 4,
         "taken V.Beauty.R G B V.Depth.Z"},
        {"Col.B Col.G Col.R V.DenoisingDepth.Z V.Depth.Z V.Mist.Z", 2, 1, 0, 4,
         "taken Col.R G B V.Depth.Z"},
        {"A.Mist.Z B Combined.B Combined.G Combined.R Depth.Z G R Z", 7, 6, 1, 8, "taken R G B Z"},
        {"B G Mist.Z N.Y N.Z R zDepth.Z", 5, 1, 0, 6, "taken R G B zDepth.Z"},
        {"Normal.X Normal.Y Normal.Z Y a.Z", 3, 3, 3, 4, "taken Y a.Z"},
        {"A.X A.Y B G R X Y Z", 4, 3, 2, -1, "taken R G B"},
    };

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct refocus_photo *photo =
            read_photo(make_exr(W, H, cases[i].channels, 0, 0), REFOCUS_OK);
        const int colours[3] = {cases[i].red, cases[i].green, cases[i].blue};

        for (int c = 0; c < 3; c++)
            assert_true(light_at(photo->deep, 2, 1, c) ==
                        (float)pattern(2, 1, colours[c], 255) / 64);
        if (cases[i].depth < 0)
            assert_null(photo->depth->samples);
        else
            assert_true(float_at(photo->depth, 2, 1) ==
                        (double)((float)pattern(2, 1, cases[i].depth, 255) / 64));
        assert_true(has_evidence(photo, cases[i].taken));
        refocus_photo_free(&photo);
    }
    read_depth(make_exr(W, H, "N.X N.Y N.Z", 0, 0), NULL, REFOCUS_ERR_NO_DEPTH);
    read_photo(make_exr(W, H, "N.X N.Y N.Z Z", 0, 0), REFOCUS_ERR_UNSUPPORTED);
}

/* Changes the first sample of a channel in row y of make_exr(). */
static void set_sample(struct bytes *file, int channels, int channel, int y, float value)
{
    const size_t row = 8 + (size_t)(4 * W * channels);

    memcpy(file->data + file->size - row * (size_t)(H - y) + 8 + (size_t)(4 * W * channel), &value,
           sizeof value);
}

/* Depth by other names, in pictures of one colour, and of nothing at all. */
TEST(exr_other_depth)
{
    static const char *const names[] = {"ViewLayer.Depth.Z", "Depth.V", "Depth", "z.depth"};
    struct refocus_photo *photo;
    struct bytes file;

    for (int i = 0; i < 4; i++) {
        file = make_exr(W, H, names[i], 0, 0);
        set_sample(&file, 1, 0, 2, INFINITY);
        set_sample(&file, 1, 0, 3, NAN);
        photo = read_depth(file, NULL, REFOCUS_OK);
        assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
        assert_true(has_evidence(photo, names[i]));
        assert_true(float_at(photo->depth, 2, 1) == (double)((float)pattern(2, 1, 0, 255) / 64));
        assert_true(float_at(photo->depth, 0, 2) == (double)FLT_MAX);
        assert_true(isnan(float_at(photo->depth, 0, 3)));
        refocus_photo_free(&photo);
    }
    for (int kind = 0; kind < 4; kind++) {
        file = make_exr(W, H, "B G R", 0, 0);
        for (int i = 0; i < W * H; i++) {
            const size_t row = file.size - (size_t)(8 + 12 * W) * (size_t)(H - i / W) + 8;
            uint8_t *const blue = file.data + row + 4 * (size_t)(i % W);

            for (int c = 0; c < 2; c++) { /* blue and green */
                memcpy(blue + 4 * W * c, blue + 8 * W, kind != 1 ? 4 : 0);
                memset(blue + 4 * W * c, 0, kind == 1 ? 4 : 0);
            }
        }
        if (kind >= 2)
            set_sample(&file, 3, 3 - kind, H - 1, 0.25f);
        photo = read_depth(file, "m", kind < 2 ? REFOCUS_OK : REFOCUS_ERR_NO_DEPTH);
        if (photo) {
            assert_true(float_at(photo->depth, 2, 1) ==
                        (double)((float)pattern(2, 1, 2, 255) / 64));
            assert_null(photo->image->plane[0]);
            refocus_photo_free(&photo);
        }
    }
}

/* Colour and depth in parts of their own: depth is that of the same pixels and the same view. */
TEST(exr_parts)
{
    static const struct exr_part parts[] = {
        {"normals", "N.X N.Y", NULL, W, 2, 1, false},
        {"right.beauty", "B G R", "right", W, 2, 1, false},
        {"left.depth", "Z", "left", W, 2, 1, false},
        {"crop.depth", "Z", "right", W - 1, 2, 1, false},
        {"right.depth", "Z", "right", W, 2, 1, false},
        {"left.beauty", "B G R", "left", W, 2, 1, false},
    };
    struct bytes file = make_exr_parts(H, parts, 6);
    struct refocus_photo *photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);

    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W;

        for (int c = 0; c < 3; c++)
            assert_true(light_at(photo->deep, x, y, c) == (float)pattern(x, y, 4 - c, 255) / 64);
        assert_true(float_at(photo->depth, x, y) == (double)((float)pattern(x, y, 7, 255) / 64));
    }
    refocus_photo_free(&photo);
    photo = read_depth(bytes_copy(file.data, file.size), NULL, REFOCUS_OK);
    assert_true(float_at(photo->depth, 1, 2) == (double)((float)pattern(1, 2, 5, 255) / 64));
    refocus_photo_free(&photo);
    refuse_cut(file, false);
    refuse_large(file);
    bytes_free(&file);
    {
        static const struct exr_part named[] = {
            {"AO", "B G R", NULL, W, 0, 0, false},   {"N", "X Y Z", NULL, W, 0, 0, false},
            {"V.Mist", "a.Z", NULL, W, 0, 0, false}, {"V.Combined", "B G R", NULL, W, 0, 0, false},
            {"V.Depth", "Z", NULL, W, 0, 0, false},
        };

        photo = read_photo(make_exr_parts(H, named, 5), REFOCUS_OK);
        assert_true(light_at(photo->deep, 2, 1, 0) == (float)pattern(2, 1, 9, 255) / 64);
        assert_true(float_at(photo->depth, 2, 1) == (double)((float)pattern(2, 1, 10, 255) / 64));
        refocus_photo_free(&photo);
    }
    /* The picture alone; a part of the other view, or of other pixels, is not its depth. */
    photo = read_photo(make_exr_parts(H, parts, 4), REFOCUS_OK);
    assert_null(photo->depth->samples);
    refocus_photo_free(&photo);
}

TEST(exr_deep_parts)
{
    static const struct exr_part parts[] = {
        {"deep", "B G R Z", NULL, W, 0, 0, true},
        {"flat", "B G R Z", NULL, W, 0, 0, false},
        {"deeper", "B G R Z", NULL, W, 0, 0, true},
    };
    struct refocus_reason reason;
    struct refocus_photo *photo = read_photo(make_exr_parts(H, parts, 2), REFOCUS_OK);
    struct bytes file;

    assert_true(light_at(photo->deep, 2, 1, 0) == (float)pattern(2, 1, 6, 255) / 64);
    assert_true(float_at(photo->depth, 2, 1) == (double)((float)pattern(2, 1, 7, 255) / 64));
    refocus_photo_free(&photo);
    file = make_exr_parts(H, (const struct exr_part[]){parts[0], parts[2]}, 2);
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, NULL, &reason),
                     REFOCUS_ERR_UNSUPPORTED);
    assert_non_null(strstr(reason.text, "deep"));
    bytes_free(&file);
}

TEST(exr_written)
{
    static const float values[4] = {1, 0x1p-24f, 65504, 100};
    float samples[3 * W * H];
    struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, samples, W, H, 12 * W);
    struct refocus_photo *photo = NULL;

    for (int i = 0; i < 3 * W * H; i++)
        samples[i] = values[i % 4];
    assert_int_equal(refocus_image_write("formats.exr", &image, NULL, NULL), REFOCUS_OK);
    assert_int_equal(refocus_photo_read(&photo, "formats.exr", NULL, NULL), REFOCUS_OK);
    assert_true(light_at(photo->deep, 0, 0, 0) == 1 && light_at(photo->deep, 1, 0, 0) == 100);
    assert_true(light_at(photo->deep, 0, 0, 1) == 0x1p-24f);
    assert_true(light_at(photo->deep, 0, 0, 2) == 65504);
    refocus_photo_free(&photo);
    unlink("formats.exr");
}
