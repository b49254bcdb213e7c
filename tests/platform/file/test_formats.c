/* test_formats.c: formats that are modules: each reads a small file pixel by pixel, refuses one
 * that is cut short or too large, and what is written is read again. */
#include "check.h"
#include "format_checks.h"
#include "make_formats.h"

#include <math.h>
#include <unistd.h>
#ifdef RF_HAVE_HEIC
#include <libheif/heif.h>
#endif
#ifdef RF_HAVE_WEBP
#include <webp/encode.h>
#endif
#ifdef RF_HAVE_JXL
#include <jxl/encode.h>
#endif

#ifdef RF_HAVE_TIFF
static const struct tiff_kind rgb8 = {.bits = 8, .channels = 3, .photometric = 2, .orientation = 1};

TEST(tiff_kinds)
{
    for (int i = 0; i < 32; i++) {
        const bool deep = i & 1, planar = i & 4 && i & 8;
        const struct tiff_kind kind = {.bits = deep ? 16 : 8,
                                       .big_endian = i & 2,
                                       .channels = i & 4 ? 3 + (i >> 4) : 1,
                                       .photometric = i & 4 ? 2 : !(i & 8),
                                       .planar = planar,
                                       .orientation = 1};
        struct refocus_photo *photo = read_photo(make_tiff(W, H, kind), REFOCUS_OK);

        assert_string_equal(photo->info->container, "TIFF");
        assert_int_equal(photo->info->stored_bits, kind.bits);
        for (int j = 0; j < 3 * W * H; j++) {
            const int x = j / 3 % W, y = j / 3 / W, c = kind.channels == 1 ? 0 : j % 3;
            const unsigned most = deep ? 65535 : 255;
            unsigned wanted = pattern(x, y, c, most);

            wanted = kind.photometric == 0 ? most - wanted : wanted;
            assert_int_equal(deep ? deep_at(photo->deep, x, y, j % 3)
                                  : pixel_at(photo->image, x, y)[j % 3],
                             wanted);
        }
        refocus_photo_free(&photo);
    }
}

TEST(tiff_floats)
{
    struct tiff_kind kind = {.bits = 32, .floats = true, .channels = 3, .photometric = 2};
    struct refocus_photo *photo;

    kind.orientation = 6;
    photo = read_photo(make_tiff(W, H, kind), REFOCUS_OK);
    assert_int_equal(photo->info->orientation, 6);
    assert_int_equal(photo->deep->width, H);
    for (int i = 0; i < W * H; i++) {
        int x, y;

        upright_place(6, W, H, i % W, i / W, &x, &y);
        assert_true(light_at(photo->deep, x, y, 1) == (float)pattern(i % W, i / W, 1, 255) / 64);
    }
    refocus_photo_free(&photo);
    kind = (struct tiff_kind){.bits = 32, .floats = true, .channels = 1, .photometric = 1};
    photo = read_depth(make_tiff(W, H, kind), "m", REFOCUS_OK);
    assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_F32);
    assert_true(float_at(photo->depth, 2, 1) == (double)((float)pattern(2, 1, 0, 255) / 64));
    refocus_photo_free(&photo);
    photo = read_photo(make_tiff(W, H, kind), REFOCUS_OK);
    assert_true(light_at(photo->deep, 2, 1, 2) == (float)pattern(2, 1, 0, 255) / 64);
    refocus_photo_free(&photo);
}

TEST(tiff_transparent)
{
    struct tiff_kind kind = {.channels = 2, .photometric = 1, .orientation = 1, .alpha = true};
    struct refocus_photo *photo;

    for (kind.bits = 8; kind.bits <= 16; kind.bits += 8) {
        photo = read_depth(make_tiff(W, H, kind), NULL, REFOCUS_OK);
        for (int i = 0; i < W * H; i++) {
            const double v = float_at(photo->depth, i % W, i / W);

            assert_true(i == W + 1 ? isnan(v)
                                   : v == pattern(i % W, i / W, 0, kind.bits == 8 ? 255 : 65535));
        }
        assert_true(photo->depth->value_near == (kind.bits == 8 ? 255 : 65535));
        refocus_photo_free(&photo);
        photo = read_photo(make_tiff(W, H, kind), REFOCUS_OK);
        assert_true(has_evidence(photo, "dropped"));
        refocus_photo_free(&photo);
    }
}

/* CMYK goes by way of libtiff's RGB: it is turned once, as other pictures are. */
TEST(tiff_cmyk_is_turned)
{
    struct tiff_kind kind = {.bits = 8, .channels = 4, .photometric = 5, .orientation = 1};
    struct refocus_photo *const upright = read_photo(make_tiff(W, H, kind), REFOCUS_OK);

    for (kind.orientation = 2; kind.orientation <= 8; kind.orientation++) {
        struct refocus_photo *photo = read_photo(make_tiff(W, H, kind), REFOCUS_OK);

        for (int i = 0; i < W * H; i++) {
            int x, y;

            upright_place(kind.orientation, W, H, i % W, i / W, &x, &y);
            assert_memory_equal(pixel_at(photo->image, x, y),
                                pixel_at(upright->image, i % W, i / W), 3);
        }
        refocus_photo_free(&photo);
    }
    refocus_photo_free(&(struct refocus_photo *){upright});
}

TEST(tiff_refused)
{
    const struct tiff_kind odd = {.bits = 32, .channels = 3, .photometric = 2, .orientation = 1};
    struct bytes file = make_tiff(W, H, rgb8);

    refuse_cut(file, false);
    refuse_large(file);
    bytes_free(&file);
    read_photo(make_tiff(W, H, odd), REFOCUS_ERR_UNSUPPORTED);
    read_depth(make_tiff(W, H, rgb8), NULL, REFOCUS_ERR_NO_DEPTH);
}

/* A picture that is written is read again, sample by sample. */
TEST(tiff_written)
{
    uint16_t samples[3 * W * H];
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB16, samples, W, H, 6 * W);
    struct refocus_photo *photo = NULL;

    for (int i = 0; i < 3 * W * H; i++)
        samples[i] = (uint16_t)(i * 1091);
    assert_int_equal(refocus_image_write("formats.tif", &image, NULL, NULL), REFOCUS_OK);
    assert_int_equal(refocus_photo_read(&photo, "formats.tif", NULL, NULL), REFOCUS_OK);
    assert_memory_equal(photo->deep->plane[0], samples, sizeof samples);
    refocus_photo_free(&photo);
    image = refocus_image_packed(REFOCUS_FORMAT_BGRA8, samples, W, H, 4 * W);
    assert_int_equal(refocus_image_write("formats.tif", &image, NULL, NULL), REFOCUS_OK);
    assert_int_equal(refocus_photo_read(&photo, "formats.tif", NULL, NULL), REFOCUS_OK);
    for (int i = 0; i < W * H; i++) {
        const uint8_t *const p = (const uint8_t *)samples + 4 * i;

        assert_int_equal(pixel_at(photo->image, i % W, i / W)[0], p[2]);
        assert_int_equal(pixel_at(photo->image, i % W, i / W)[2], p[0]);
    }
    refocus_photo_free(&photo);
    assert_int_equal(refocus_gray16_write("formats.tif", samples, W, H, 2 * W, NULL), REFOCUS_OK);
    assert_int_equal(refocus_depth_read(&photo, "formats.tif", NULL, 0, 0, NULL, NULL), REFOCUS_OK);
    assert_int_equal(sample_at(photo->depth, 3, 2), samples[3 + 2 * W]);
    refocus_photo_free(&photo);
    unlink("formats.tif");
}

/* EXIF goes into a TIFF and out of it, in either order of bytes, with the picture's own sides. */
TEST(tiff_exif)
{
    static const uint8_t pixels[3 * W * H] = {1, 2, 3};
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, (uint8_t *)(uintptr_t)pixels, W, H, 3 * W);

    for (int big = 0; big < 2; big++) {
        struct refocus_write_options options = refocus_write_options_default();
        struct bytes exif = make_exif(big, 1);
        const struct refocus_blob block = {exif.data, exif.size};
        struct refocus_photo *photo = NULL;
        struct refocus_reason reason;

        options.exif = &block;
        assert_int_equal(refocus_image_write("formats.tif", &image, &options, &reason), REFOCUS_OK);
        assert_string_equal(reason.text, "");
        assert_int_equal(refocus_photo_read(&photo, "formats.tif", NULL, NULL), REFOCUS_OK);
        assert_memory_equal(photo->image->plane[0], pixels, sizeof pixels);
        assert_string_equal(photo->info->camera, "Maker Model X");
        assert_near(photo->info->focal_length_mm, 50.5);
        assert_near(photo->info->f_number, 1.8);
        assert_near(photo->info->focal_length_35mm, 75);
        assert_true(photo->exif.size > 60 && photo->exif.data[0] == (big ? 'M' : 'I'));
        refocus_photo_free(&photo);
        bytes_free(&exif);
    }
    unlink("formats.tif");
}
#endif

#ifdef RF_HAVE_WEBP
/* Grey of 40 with one pixel that is transparent. */
TEST(webp_transparent)
{
    uint8_t rgba[4 * W * H], *made = NULL;
    struct refocus_photo *photo;
    size_t size;

    for (int i = 0; i < W * H; i++) {
        memset(rgba + 4 * i, 40, 3);
        rgba[4 * i + 3] = i == 3 ? 0 : 255;
    }
    size = WebPEncodeLosslessRGBA(rgba, W, H, 4 * W, &made);
    photo = read_depth(bytes_copy(made, size), NULL, REFOCUS_OK);
    WebPFree(made);
    assert_true(isnan(float_at(photo->depth, 3, 0)));
    assert_true(float_at(photo->depth, 4, 0) == 40 && float_at(photo->depth, 3, 1) == 40);
    refocus_photo_free(&photo);
}

TEST(webp)
{
    uint8_t rgb[3 * W * H], *made = NULL;
    struct bytes file = {NULL, 0}, exif = make_exif(false, 3);
    struct refocus_photo *photo;
    size_t size;

    for (int i = 0; i < 3 * W * H; i++)
        rgb[i] = (uint8_t)pattern(i / 3 % W, i / 3 / W, i % 3, 255);
    size = WebPEncodeLosslessRGB(rgb, W, H, 3 * W, &made);
    assert_true(size > 20);
    photo = read_photo(bytes_copy(made, size), REFOCUS_OK);
    assert_memory_equal(photo->image->plane[0], rgb, sizeof rgb);
    assert_string_equal(photo->info->container, "WebP");
    refocus_photo_free(&photo);
    file = bytes_copy(made, size);
    refuse_cut(file, false);
    refuse_large(file);
    bytes_free(&file);
    /* The extended form: its header, the picture, EXIF. */
    bytes_text(&file, "RIFF");
    bytes_number(&file, 4 + 18 + (size - 12) + 8 + exif.size + (exif.size & 1), 4, false);
    bytes_add(&file, "WEBPVP8X\12\0\0\0\10\0\0\0", 16);
    bytes_number(&file, W - 1, 3, false);
    bytes_number(&file, H - 1, 3, false);
    bytes_add(&file, made + 12, size - 12);
    bytes_text(&file, "EXIF");
    bytes_number(&file, exif.size, 4, false);
    bytes_join(&file, exif);
    bytes_number(&file, 0, file.size & 1, false);
    photo = read_photo(file, REFOCUS_OK);
    assert_int_equal(photo->info->orientation, 3);
    assert_memory_equal(pixel_at(photo->image, W - 1, H - 1), rgb, 3);
    assert_string_equal(photo->info->camera, "Maker Model X");
    refocus_photo_free(&photo);
    WebPFree(made);
}
#endif

#ifdef RF_HAVE_JXL
/* Lossless, by a curve; three channels, or four with transparency; with a box of EXIF, packed by
 * Brotli, unless it is NULL. */
static struct bytes make_jxl_with(const struct bytes *exif, const void *samples, size_t size,
                                  JxlDataType type, uint32_t bits, JxlTransferFunction curve)
{
    const size_t sample_bytes = type == JXL_TYPE_FLOAT ? 4 : type == JXL_TYPE_UINT16 ? 2 : 1;
    const uint32_t channels = (uint32_t)(size / sample_bytes / (W * H));
    const JxlPixelFormat format = {channels, type, JXL_NATIVE_ENDIAN, 0};
    JxlEncoder *const encoder = JxlEncoderCreate(NULL);
    JxlEncoderFrameSettings *const settings = JxlEncoderFrameSettingsCreate(encoder, NULL);
    JxlColorEncoding colour;
    JxlBasicInfo about;
    struct bytes file = {NULL, 0};
    uint8_t out[4096], *next = out;
    size_t left = sizeof out;

    JxlEncoderInitBasicInfo(&about);
    about.xsize = W;
    about.ysize = H;
    about.bits_per_sample = bits;
    about.exponent_bits_per_sample = type == JXL_TYPE_FLOAT ? 5 : 0; /* half */
    about.uses_original_profile = JXL_TRUE;
    about.num_extra_channels = channels - 3;
    about.alpha_bits = channels > 3 ? bits : 0;
    JxlColorEncodingSetToSRGB(&colour, JXL_FALSE);
    colour.transfer_function = curve;
    JxlEncoderUseContainer(encoder, JXL_TRUE);
    if (exif) {
        JxlEncoderUseBoxes(encoder);
        assert_int_equal(JxlEncoderAddBox(encoder, "Exif", exif->data, exif->size, JXL_TRUE),
                         JXL_ENC_SUCCESS);
    }
    assert_int_equal(JxlEncoderSetBasicInfo(encoder, &about), JXL_ENC_SUCCESS);
    assert_int_equal(JxlEncoderSetColorEncoding(encoder, &colour), JXL_ENC_SUCCESS);
    JxlEncoderSetFrameLossless(settings, JXL_TRUE);
    assert_int_equal(JxlEncoderAddImageFrame(settings, &format, samples, size), JXL_ENC_SUCCESS);
    JxlEncoderCloseInput(encoder);
    assert_int_equal(JxlEncoderProcessOutput(encoder, &next, &left), JXL_ENC_SUCCESS);
    bytes_add(&file, out, sizeof out - left);
    JxlEncoderDestroy(encoder);
    return file;
}

static struct bytes make_jxl(const void *samples, size_t size, JxlDataType type, uint32_t bits,
                             JxlTransferFunction curve)
{
    return make_jxl_with(NULL, samples, size, type, bits, curve);
}

/* EXIF that is packed is read, however much larger it is unpacked, and passed over where it is
 * larger than the limit. */
TEST(jxl_packed_exif)
{
    const uint8_t offset[4] = {0}, room[100000] = {0};
    uint8_t codes[3 * W * H] = {0};
    struct refocus_read_limits limits = refocus_read_limits_default();
    struct bytes block = make_exif(true, 6), exif = {NULL, 0}, file;
    struct refocus_photo *photo;
    struct refocus_reason reason;

    bytes_add(&exif, offset, sizeof offset);
    bytes_add(&exif, block.data, block.size);
    bytes_add(&exif, room, sizeof room);
    file = make_jxl_with(&exif, codes, sizeof codes, JXL_TYPE_UINT8, 8, JXL_TRANSFER_FUNCTION_SRGB);
    assert_true(file.size < exif.size / 10);
    photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);
    assert_string_equal(photo->info->camera, "Maker Model X");
    assert_int_equal(photo->exif.size, exif.size - sizeof offset);
    assert_memory_equal(photo->exif.data + photo->exif.size - sizeof room, room, sizeof room);
    refocus_photo_free(&photo);
    limits.max_metadata = sizeof room / 2;
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &limits, &reason),
                     REFOCUS_OK);
    assert_string_equal(photo->info->camera, "");
    assert_true(photo->image->plane[0] && photo->exif.size == 0);
    refocus_photo_free(&photo);
    bytes_free(&file);
    bytes_free(&exif);
    bytes_free(&block);
}

TEST(jxl_transparent)
{
    uint8_t rgba[4 * W * H];
    struct refocus_photo *photo;

    for (int i = 0; i < W * H; i++) {
        memset(rgba + 4 * i, 40, 3);
        rgba[4 * i + 3] = i == 3 ? 0 : 255;
    }
    photo = read_depth(make_jxl(rgba, sizeof rgba, JXL_TYPE_UINT8, 8, JXL_TRANSFER_FUNCTION_SRGB),
                       NULL, REFOCUS_OK);
    assert_true(isnan(float_at(photo->depth, 3, 0)));
    assert_true(float_at(photo->depth, 4, 0) == 40 && float_at(photo->depth, 3, 1) == 40);
    refocus_photo_free(&photo);
}

TEST(jxl)
{
    uint8_t codes[3 * W * H];
    uint16_t deep[3 * W * H];
    float light[3 * W * H];
    struct refocus_photo *photo;
    struct bytes file;

    for (int i = 0; i < 3 * W * H; i++) {
        codes[i] = (uint8_t)pattern(i / 3 % W, i / 3 / W, i % 3, 255);
        deep[i] = (uint16_t)pattern(i / 3 % W, i / 3 / W, i % 3, 65535);
        light[i] = (float)codes[i] / 16;
    }
    file = make_jxl(codes, sizeof codes, JXL_TYPE_UINT8, 8, JXL_TRANSFER_FUNCTION_SRGB);
    photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);
    assert_string_equal(photo->info->container, "JPEG-XL");
    assert_memory_equal(photo->image->plane[0], codes, sizeof codes);
    refocus_photo_free(&photo);
    refuse_cut(file, false);
    refuse_large(file);
    bytes_free(&file);
    photo = read_photo(make_jxl(deep, sizeof deep, JXL_TYPE_UINT16, 16, JXL_TRANSFER_FUNCTION_SRGB),
                       REFOCUS_OK);
    assert_memory_equal(photo->deep->plane[0], deep, sizeof deep);
    refocus_photo_free(&photo);
    photo =
        read_photo(make_jxl(light, sizeof light, JXL_TYPE_FLOAT, 16, JXL_TRANSFER_FUNCTION_LINEAR),
                   REFOCUS_OK);
    assert_memory_equal(photo->deep->plane[0], light, sizeof light);
    refocus_photo_free(&photo);
    /* White of PQ, 203 cd/m2, is the code .580689 (ITU-R BT.2408), and 1000 cd/m2 are .751827. */
    for (int i = 0; i < 3 * W * H; i++)
        deep[i] = i % 2 ? 38055 : 49271;
    photo = read_photo(make_jxl(deep, sizeof deep, JXL_TYPE_UINT16, 16, JXL_TRANSFER_FUNCTION_PQ),
                       REFOCUS_OK);
    assert_true(fabs((double)light_at(photo->deep, 0, 0, 1) - 1) < 0.001);
    assert_true(fabs((double)light_at(photo->deep, 0, 0, 0) / (1000.0 / 203) - 1) < 0.001);
    refocus_photo_free(&photo);
}
#endif

#ifdef RF_HAVE_RAW
/* Grey of half the range is half the light. */
TEST(raw_developed)
{
    const struct bytes none = {NULL, 0};
    struct bytes file = make_dng(64, 48, 32768, none);
    struct refocus_photo *photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);

    assert_string_equal(photo->info->container, "raw");
    assert_int_equal(photo->image->width, 64);
    assert_int_equal(photo->image->height, 48);
    for (int c = 0; c < 3; c++) /* .735357 is the code of .5 */
        assert_true(abs((int)deep_at(photo->deep, 30, 20, c) - 48192) < 200);
    refocus_photo_free(&photo);
    refuse_large(file);
    bytes_free(&file);
}
#endif

#ifdef RF_HAVE_HEIC
static struct bytes load(const char *name)
{
    struct refocus_blob blob;
    struct bytes file;
    char path[1024];

    snprintf(path, sizeof path, "%s/tests/fuzz/file/corpus/photo/%s", REFOCUS_SOURCE, name);
    assert_int_equal(refocus_file_read(path, 1 << 20, &blob, NULL), REFOCUS_OK);
    file = bytes_copy(blob.data, blob.size);
    free(blob.data);
    return file;
}

/* A picture of 10 bits, one grey on the left and one on the right, by a curve and primaries. */
static struct heif_error add_bytes(struct heif_context *context, const void *data, size_t size,
                                   void *file)
{
    (void)context;
    bytes_add(file, data, size);
    return (struct heif_error){heif_error_Ok, heif_suberror_Unspecified, ""};
}

static void fill(struct heif_image *image, enum heif_channel channel, int side, int left, int right)
{
    uint8_t *plane;
    int stride;

    heif_image_add_plane(image, channel, side, side, 10);
    plane = heif_image_get_plane(image, channel, &stride);
    for (int y = 0; y < side; y++) {
        for (int x = 0; x < side; x++) {
            const uint16_t value = (uint16_t)(x < side / 2 ? left : right);

            memcpy(plane + y * stride + 2 * x, &value, 2);
        }
    }
}

static struct bytes make_heif(enum heif_compression_format compression, int left, int right,
                              enum heif_transfer_characteristics curve)
{
    enum { SIDE = 64 };
    struct heif_writer writer = {.writer_api_version = 1, .write = add_bytes};
    struct heif_color_profile_nclx *const nclx = heif_nclx_color_profile_alloc();
    struct heif_context *const context = heif_context_alloc();
    struct heif_encoding_options *const options = heif_encoding_options_alloc();
    struct heif_encoder *encoder = NULL;
    struct heif_image *image = NULL;
    struct bytes file = {NULL, 0};

    heif_image_create(SIDE, SIDE, heif_colorspace_YCbCr, heif_chroma_420, &image);
    fill(image, heif_channel_Y, SIDE, left, right);
    fill(image, heif_channel_Cb, SIDE / 2, 512, 512);
    fill(image, heif_channel_Cr, SIDE / 2, 512, 512);
    nclx->transfer_characteristics = curve;
    nclx->color_primaries = heif_color_primaries_ITU_R_BT_709_5;
    nclx->matrix_coefficients = heif_matrix_coefficients_ITU_R_BT_709_5;
    nclx->full_range_flag = 1;
    heif_image_set_nclx_color_profile(image, nclx);
    if (heif_context_get_encoder_for_format(context, compression, &encoder).code == heif_error_Ok) {
        options->output_nclx_profile = nclx;
        options->macOS_compatibility_workaround_no_nclx_profile = 0;
        heif_encoder_set_lossy_quality(encoder, 98);
        if (heif_context_encode_image(context, image, encoder, options, NULL).code == heif_error_Ok)
            heif_context_write(context, &writer, &file);
        heif_encoder_release(encoder);
    }
    heif_encoding_options_free(options);
    heif_nclx_color_profile_free(nclx);
    heif_image_release(image);
    heif_context_free(context);
    return file;
}

static void check_codes(struct bytes file, const char *name)
{
    struct refocus_photo *photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);

    assert_string_equal(photo->info->container, name);
    assert_int_equal(photo->info->stored_bits, 10);
    assert_true(abs((int)deep_at(photo->deep, 5, 5, 1) - 300 * 65535 / 1023) < 200);
    assert_true(abs((int)deep_at(photo->deep, 60, 60, 1) - 801 * 65535 / 1023) < 200);
    refocus_photo_free(&photo);
    refuse_cut(file, false);
    refuse_large(file);
    bytes_free(&file);
}

/* By PQ the code 594 is white and 769 are 1000 cd/m2; by HLG 767, 75 %, is white, and 1023 is all.
 */
static void check_light(struct bytes file, double right)
{
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);

    for (int c = 0; c < 3; c++) {
        assert_true(fabs((double)light_at(photo->deep, 5, 5, c) - 1) < 0.02);
        assert_true(fabs((double)light_at(photo->deep, 60, 60, c) / right - 1) < 0.02);
    }
    refocus_photo_free(&photo);
}

TEST(heic)
{
    const enum heif_compression_format hevc = heif_compression_HEVC;
    struct bytes file = make_heif(hevc, 300, 801, heif_transfer_characteristic_IEC_61966_2_1);

    if (file.size == 0) /* not each libheif writes them */
        skip();
    check_codes(file, "HEIC");
    check_light(make_heif(hevc, 594, 769, heif_transfer_characteristic_ITU_R_BT_2100_0_PQ),
                1000.0 / 203);
    check_light(make_heif(hevc, 767, 1023, heif_transfer_characteristic_ITU_R_BT_2100_0_HLG),
                1 / 0.26496);
}

/* Made by avifenc: libheif 1.15 does not write 10 bits. The second has primaries of BT.2020. */
TEST(avif)
{
    if (!heif_have_decoder_for_format(heif_compression_AV1))
        skip();
    check_codes(load("srgb10.avif"), "AVIF");
    check_light(load("pq10.avif"), 1000.0 / 203);
}
#endif
