/* test_keep.c: what a PNG holds beside its pixels is in the picture that is made from it: each
 * chunk as it was, and of XMP what still holds. */
#include "check.h"
#include "png_chunks.h"
#include "read.h"

#include <math.h>
#include <unistd.h>

/* A PNG with chunks between its header and its pixels; the packet is freed. */
static struct bytes png_with(struct bytes packet, bool has_text)
{
    struct bytes plain = make_png(8, 4, 2, 8), png = bytes_copy(plain.data, 33);
    struct bytes xmp = bytes_copy(rf_png_xmp_head, RF_PNG_XMP_HEAD);

    if (has_text)
        png_chunk(&png, "tEXt", "Author\0somebody", 15);
    if (packet.data) {
        bytes_join(&xmp, packet);
        png_chunk(&png, "iTXt", xmp.data, xmp.size);
    }
    bytes_free(&xmp);
    if (has_text)
        png_chunk(&png, "pHYs", "\0\0\1\0\0\0\2\0\1", 9);
    bytes_add(&png, plain.data + 33, plain.size - 33);
    bytes_free(&plain);
    return png;
}

/* The upper rows of the photo of a file, so many columns. */
static struct bytes rewritten(struct bytes file, int32_t width, int32_t height)
{
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);
    struct bytes out = {NULL, 0};
    struct refocus_image image = *photo->image;
    char path[64];
    int byte;
    FILE *in;

    snprintf(path, sizeof path, "/tmp/refocus-keep-%ld.png", (long)getpid());
    options.keep = photo;
    image.width = width;
    image.height = height;
    assert_int_equal(refocus_image_write(path, &image, &options, NULL), REFOCUS_OK);
    refocus_photo_free(&photo);
    in = fopen(path, "rb");
    assert_non_null(in);
    while ((byte = fgetc(in)) != EOF)
        bytes_number(&out, (uint64_t)byte, 1, false);
    fclose(in);
    assert_int_equal(unlink(path), 0);
    return out;
}

/* Chunks of a type; the last one's content is *found. */
static int count(const struct bytes *png, const char *type, struct rf_png_chunk *found)
{
    struct rf_bytes rest = {png->data + 8, png->size - 8};
    struct rf_png_chunk chunk;
    int n = 0;

    while (rf_png_next_chunk(&rest, &chunk)) {
        if (memcmp(chunk.type, type, 4) == 0) {
            *found = chunk;
            n++;
        }
    }
    return n;
}

TEST(chunks)
{
    for (int has_xmp = 0; has_xmp < 2; has_xmp++) {
        struct bytes packet = {NULL, 0}, png;
        struct rf_png_chunk chunk = {0};

        if (has_xmp)
            packet = make_xmp("xmlns:q=\"q:\" q:a=\"kept\" GDepth:Near=\"1\"");
        png = rewritten(png_with(packet, true), 8, 4);
        assert_int_equal(count(&png, "tEXt", &chunk), 1);
        assert_int_equal(chunk.content.size, 15);
        assert_memory_equal(chunk.content.data, "Author\0somebody", 15);
        assert_int_equal(count(&png, "pHYs", &chunk), 1);
        assert_memory_equal(chunk.content.data, "\0\0\1\0\0\0\2\0\1", 9);
        assert_int_equal(count(&png, "iTXt", &chunk), has_xmp);
        if (has_xmp) {
            struct bytes text = bytes_copy(chunk.content.data, chunk.content.size);

            bytes_add(&text, "", 1);
            assert_non_null(strstr((char *)text.data + RF_PNG_XMP_HEAD, "kept"));
            assert_null(strstr((char *)text.data + RF_PNG_XMP_HEAD, "Near"));
            bytes_free(&text);
        }
        bytes_free(&png);
    }
}

/* A checksum that belongs to the chunk, and no chunk where there was none. */
TEST(nothing_is_made_up)
{
    struct bytes png = rewritten(png_with((struct bytes){NULL, 0}, false), 8, 4);
    struct rf_png_chunk chunk;
    struct refocus_photo *photo;

    assert_int_equal(count(&png, "tEXt", &chunk), 0);
    assert_int_equal(count(&png, "iTXt", &chunk), 0);
    assert_int_equal(count(&png, "IHDR", &chunk), 1);
    photo = read_photo(png, REFOCUS_OK);
    assert_int_equal(photo->image->width, 8);
    refocus_photo_free(&photo);
}

/* Depth that is written into a photo does not make its main picture blurred: the original of the
 * packet before is used where that says that it is, and only there. */
TEST(depth_beside_an_original)
{
    static const uint16_t disparity[4] = {0, 1000, 40000, 65535};
    struct refocus_depth_write depth = refocus_depth_write_default();
    char path[64];

    depth.disparity = disparity;
    depth.width = depth.height = 2;
    depth.stride = 4;
    snprintf(path, sizeof path, "/tmp/refocus-keep-%ld.jpg", (long)getpid());
    for (int blurred = 0; blurred < 2; blurred++) {
        struct bytes file =
            make_gdepth((struct gdepth){.format = "RangeInverse",
                                        .extra = blurred ? "GFocus:BlurAtInfinity=\"0.01\""
                                                         : "GFocus:BlurAtInfinity=\"0\"",
                                        .depth = make_png(2, 2, 0, 8),
                                        .original = make_png(9, 7, 2, 8)},
                        0);
        struct refocus_photo *photo;
        FILE *const out = fopen(path, "wb");

        assert_non_null(out);
        assert_int_equal(fwrite(file.data, 1, file.size, out), file.size);
        assert_int_equal(fclose(out), 0);
        bytes_free(&file);
        assert_int_equal(refocus_photo_write_depth(path, path, &depth, NULL), REFOCUS_OK);
        assert_int_equal(refocus_photo_read(&photo, path, NULL, NULL), REFOCUS_OK);
        assert_int_equal(photo->info->original_used, blurred);
        assert_int_equal(photo->image->width, blurred ? 9 : 48);
        assert_int_equal(photo->depth->width, 2);
        assert_int_equal(sample_at(photo->depth, 0, 0), photo->depth->value_far);
        refocus_photo_free(&photo);
        assert_int_equal(unlink(path), 0);
    }
}

/* Whatever is said of a depth is read again, beside a picture that lies on its side, too. */
TEST(all_of_a_depth)
{
    static const uint16_t disparity[6] = {0, 1000, 2000, 40000, 50000, 65535};
    static const uint8_t confidence[6] = {0, 50, 100, 150, 200, 255};
    struct refocus_depth_write depth = refocus_depth_write_default();
    char path[64];

    depth.disparity = disparity;
    depth.width = 3;
    depth.height = 2;
    depth.stride = 6;
    depth.confidence = confidence;
    depth.confidence_stride = 3;
    depth.near_m = 0.5;
    depth.far_m = 8;
    depth.focus_x = 0.25;
    depth.focus_y = 0.75;
    depth.focus_distance = 2.5;
    depth.blur_at_infinity = 0.02;
    snprintf(path, sizeof path, "/tmp/refocus-keep-%ld.jpg", (long)getpid());
    for (int orientation = 1; orientation <= 8; orientation++) {
        struct bytes file = make_jpeg(48, 32, false, false);
        struct refocus_photo *photo;
        FILE *const out = fopen(path, "wb");

        jpeg_insert_exif(&file, make_exif(true, orientation));
        assert_non_null(out);
        assert_int_equal(fwrite(file.data, 1, file.size, out), file.size);
        assert_int_equal(fclose(out), 0);
        bytes_free(&file);
        assert_int_equal(refocus_photo_write_depth(path, path, &depth, NULL), REFOCUS_OK);
        assert_int_equal(refocus_photo_read(&photo, path, NULL, NULL), REFOCUS_OK);
        assert_int_equal(photo->depth->width, 3);
        assert_non_null(photo->confidence);
        for (int i = 0; i < 6; i++) {
            assert_int_equal(sample_at(photo->depth, i % 3, i / 3), 65535 - disparity[i]);
            assert_int_equal(photo->confidence[i], confidence[i]);
        }
        assert_near(photo->depth->near_m, 0.5);
        assert_near(photo->depth->far_m, 8);
        assert_near(photo->info->focus_x, 0.25);
        assert_near(photo->info->focus_y, 0.75);
        assert_near(photo->info->focus_distance, 2.5);
        assert_near(photo->info->blur_at_infinity, 0.02);
        refocus_photo_free(&photo);
        assert_int_equal(unlink(path), 0);
    }
}

/* A picture with transparency, of its own or of its palette, says that it is dropped, another does
 * not. */
TEST(transparency)
{
    static const int types[] = {0, 2, 3, 4, 6};

    for (int i = 0; i < 5; i++) {
        struct refocus_photo *photo = read_photo(make_png(6, 4, types[i], 8), REFOCUS_OK);
        bool told = false;

        for (int k = 0; k < photo->info->evidence_count; k++)
            told |= strstr(photo->info->evidence[k], "transparency") != NULL;
        assert_int_equal(told, types[i] >= 3);
        refocus_photo_free(&photo);
    }
}

/* Sides that XMP says are kept where they are still those of the picture. */
TEST(sides)
{
    static const int32_t sizes[][2] = {{8, 4}, {7, 4}, {8, 3}, {7, 3}};

    for (int i = 0; i < 4; i++) {
        struct bytes png =
            rewritten(png_with(make_xmp("xmlns:q=\"q:\" q:a=\"kept\" "
                                        "xmlns:tiff=\"http://ns.adobe.com/tiff/1.0/\" "
                                        "tiff:ImageWidth=\"8\" tiff:ImageLength=\"4\""),
                               false),
                      sizes[i][0], sizes[i][1]);
        struct rf_png_chunk chunk = {0};
        struct bytes text;

        assert_int_equal(count(&png, "iTXt", &chunk), 1);
        text =
            bytes_copy(chunk.content.data + RF_PNG_XMP_HEAD, chunk.content.size - RF_PNG_XMP_HEAD);
        bytes_add(&text, "", 1);
        assert_non_null(strstr((char *)text.data, "kept"));
        assert_int_equal(strstr((char *)text.data, "tiff:ImageWidth") != NULL, i == 0);
        assert_int_equal(strstr((char *)text.data, "tiff:ImageLength") != NULL, i == 0);
        bytes_free(&text);
        bytes_free(&png);
    }
}

static int write_editable(const char *name, const struct refocus_photo *photo,
                          const struct refocus_editable *editable)
{
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_reason reason;
    char path[64];
    int status;

    options.keep = photo;
    options.editable = editable;
    snprintf(path, sizeof path, "/tmp/refocus-keep-%ld.%s", (long)getpid(), name);
    status = refocus_image_write(path, photo ? photo->image : NULL, &options, &reason);
    check_status(status, status, reason.text, __FILE__, __LINE__);
    assert_int_equal(access(path, F_OK) == 0, status == REFOCUS_OK);
    unlink(path);
    return status;
}

/* One thing of an editable picture is wrong at a time: an error, and no file. */
TEST(editables_refused)
{
    static uint16_t samples[8 * 4];
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_editable good = refocus_editable_default(), bad;
    struct refocus_photo *photo = read_photo(make_png(8, 4, 2, 8), REFOCUS_OK);
    double *const lens[] = {&bad.focus_disparity, &bad.max_blur_radius, &bad.simulated_f_number};

    depth.disparity = samples;
    depth.width = 8;
    depth.height = 4;
    depth.stride = 16;
    good.depth = &depth;
    good.matte = samples;
    good.matte_width = 8;
    good.matte_height = 4;
    good.matte_stride = 16;
    assert_int_equal(write_editable("jpg", photo, &good), REFOCUS_OK);
    assert_int_equal(write_editable("png", photo, &good), REFOCUS_ERR_UNSUPPORTED);
    for (int i = 0; i < 6; i++) {
        bad = good;
        *lens[i % 3] = i < 3 ? NAN : -INFINITY;
        assert_int_equal(write_editable("jpg", photo, &bad), REFOCUS_ERR_ARGUMENT);
    }
    for (int i = 0; i < 8; i++) {
        bad = good;
        bad.matte_width = i == 0 ? 0 : i == 1 ? 9 : i == 2 ? REFOCUS_MAX_SIDE + 1 : 8;
        bad.matte_height = i == 3 ? 0 : i == 4 ? -4 : 4;
        bad.matte_stride = i == 5 ? 17 : i == 6 ? 0 : i == 7 ? PTRDIFF_MIN : 16;
        assert_int_equal(write_editable("jpg", photo, &bad), REFOCUS_ERR_ARGUMENT);
    }
    for (int i = 0; i < 3; i++) {
        bad = good;
        bad.struct_size = i == 0 ? 4 : sizeof bad;
        bad.depth = i == 1 ? NULL : &depth;
        depth.struct_size = i == 2 ? 4 : sizeof depth;
        assert_int_equal(write_editable("jpg", photo, &bad), REFOCUS_ERR_ARGUMENT);
    }
    depth.struct_size = sizeof depth;
    for (int i = 0; i < 9; i++) {
        const struct refocus_depth_write whole = depth;

        depth.disparity = i == 0 ? NULL : samples;
        depth.width = i == 1 ? 0 : 8;
        depth.height = i == 2 ? 0 : 4;
        depth.stride = i == 3 ? 15 : 16;
        depth.focus_x = i == 4 ? 1.1 : whole.focus_x;
        depth.near_m = i == 5 ? INFINITY : whole.near_m;
        depth.far_m = i == 6 ? NAN : whole.far_m;
        depth.focus_distance = i == 7 ? NAN : whole.focus_distance;
        depth.blur_at_infinity = i == 8 ? NAN : whole.blur_at_infinity;
        assert_int_equal(write_editable("jpg", photo, &good), REFOCUS_ERR_ARGUMENT);
        depth = whole;
    }
    assert_int_equal(write_editable("jpg", photo, &good), REFOCUS_OK);
    refocus_photo_free(&photo);
}
