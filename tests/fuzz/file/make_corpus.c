/* make_corpus.c: writes the seeds: make_corpus tests/fuzz/file/corpus. Run it after a change of
 * make.c; it needs a build with all formats. */
#include "make_formats.h"
#include "kept.h"
#include "samples.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char *root;

static void seed(const char *target, const char *name, const void *data, size_t size)
{
    char path[1024];
    FILE *file;

    snprintf(path, sizeof path, "%s/%s", root, target);
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/%s/%s", root, target, name);
    file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

static void seed_text(const char *target, const char *name, const char *text)
{
    seed(target, name, text, strlen(text));
}

static void seed_samples(void)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);

    for (int i = 0; i < count; i++) {
        const struct bytes *const b = &samples[i].bytes;
        struct bytes depth = {NULL, 0};

        seed("photo", samples[i].name, b->data, b->size);
        bytes_number(&depth, (uint64_t)i * 43 % 256, 1, true);
        bytes_add(&depth, b->data, b->size);
        seed("depth", samples[i].name, depth.data, depth.size);
        bytes_free(&depth);
        if (strncmp(b->data ? (const char *)b->data : "", "Pf", 2) == 0)
            seed("pfm", samples[i].name, b->data, b->size);
        else if (strstr(samples[i].name, ".npy"))
            seed("npy", samples[i].name, b->data, b->size);
        else if (b->data[0] == 'P')
            seed("pnm", samples[i].name, b->data, b->size);
        else if (strcmp(samples[i].name, "extended.jpg") == 0)
            seed("xmp_extended", samples[i].name, b->data, b->size);
    }
    free_samples(samples, count);
}

static void seed_exif(void)
{
    struct bytes low = make_exif(false, 6), high = make_exif(true, 3);

    seed("exif", "low", low.data, low.size);
    seed("exif", "high", high.data, high.size);
    bytes_free(&low);
    bytes_free(&high);
}

/* The MPF directory of a JPEG begins 10 bytes behind its begin, see make_mpf(). */
static void seed_mpf(void)
{
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct bytes part = make_auxiliary("disparity", NULL);
        struct bytes file = make_mpf(make_jpeg(16, 16, false, false), &part, 1, big_endian);

        seed("mpf", big_endian ? "high" : "low", file.data + 10, 82);
        bytes_free(&file);
    }
}

static void seed_gain_map(void)
{
    static const int32_t values[] = {0,    3000, -1000, 1000, 1000, 16,   16, 0, 2000,
                                     1000, 16,   16,    0,    3000, 1000, 16, 16};

    for (int channels = 1; channels <= 3; channels += 2) {
        struct bytes iso = make_gain_iso(channels, values);

        seed("gain_map", channels == 1 ? "grey" : "colour", iso.data, iso.size);
        bytes_free(&iso);
    }
}

static void seed_heif_boxes(void)
{
    static const struct heif_property both[] = {{"irot", 1}, {"imir", 0}};

    for (int large = 0; large < 2; large++) {
        struct bytes file = make_heif_boxes(both, 2, large);
        seed("heif_boxes", large ? "large" : "small", file.data, file.size);
        bytes_free(&file);
    }
}

static void seed_xmp(void)
{
    static const char apple[] =
        "<x xmlns:a=\"http://ns.apple.com/pixeldatainfo/1.0/\"><a:AuxiliaryImageType>"
        "disparity</a:AuxiliaryImageType><a:FloatMinValue>0.25</a:FloatMinValue></x>";
    const char *const formats[] = {"RangeInverse", "RangeLinear"};

    for (int i = 0; i < 2; i++) {
        struct bytes png = make_png(2, 2, 0, 8), data = base64(png.data, png.size);
        struct bytes text = {NULL, 0}, xmp;

        bytes_text(&text, "GDepth:Format=\"");
        bytes_text(&text, formats[i]);
        bytes_text(&text, "\" GDepth:Near=\"1\" GDepth:Far=\"5e1\" GDepth:Units=\"mm\" "
                          "GFocus:FocalPointX=\".5\" GFocus:FocalPointY=\"1\" "
                          "GDepth:Data=\"");
        bytes_text(&text, (const char *)data.data);
        bytes_text(&text, "\"");
        xmp = make_xmp((const char *)text.data);
        seed("xmp", formats[i], xmp.data, xmp.size);
        bytes_free(&png);
        bytes_free(&data);
        bytes_free(&text);
        bytes_free(&xmp);
    }
    seed("xmp", "elements", apple, sizeof apple - 1);
}

/* A packet, a zero, and the pictures that it names. */
static void seed_dynamic(void)
{
    for (int plain = 0; plain < 2; plain++) {
        struct dynamic dynamic = {.plain = plain,
                                  .map = "DepthMap:Format=\"RangeLinear\" DepthMap:Near=\"1\" "
                                         "DepthMap:Far=\"4\" DepthMap:Units=\"Meters\"",
                                  .depth = make_png(2, 2, 0, 8),
                                  .confidence = make_png(2, 2, 0, 16),
                                  .original = make_png(2, 2, 2, 8)};
        struct bytes file = make_dynamic_xmp(&dynamic);

        bytes_add(&file, "", 1);
        bytes_join(&file, dynamic.original);
        bytes_join(&file, dynamic.depth);
        bytes_join(&file, dynamic.confidence);
        seed("dynamic", plain ? "plain" : "cameras", file.data, file.size);
        bytes_free(&file);
    }
}

/* Seeds of WebP and JPEG XL were made by libwebp and libjxl in test_formats.c. */
static void seed_formats(void)
{
    static const struct {
        const char *name;
        struct tiff_kind kind;
    } kinds[] = {{"rgb8", {.bits = 8, .channels = 3, .photometric = 2, .orientation = 6}},
                 {"planar16", {.bits = 16, .channels = 3, .photometric = 2, .planar = true}},
                 {"float", {.bits = 32, .channels = 1, .photometric = 1, .floats = true}},
                 {"palette", {.bits = 8, .channels = 1, .photometric = 3}},
                 {"ycbcr", {.bits = 8, .channels = 3, .photometric = 6, .big_endian = true}}};
    const struct bytes none = {NULL, 0};

    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct bytes file = make_tiff(5, 4, kinds[i].kind);

        seed("tiff", kinds[i].name, file.data, file.size);
        bytes_free(&file);
    }
    for (int layers = 0; layers < 2; layers++) {
        struct bytes file = make_exr(5, 4, layers ? "a.B a.G a.R depth.Z" : "Y", -2, layers);

        seed("openexr", layers ? "layers" : "grey", file.data, file.size);
        bytes_free(&file);
    }
    for (int preview = 0; preview < 2; preview++) {
        struct bytes file =
            make_dng(32, 24, 20000, preview ? make_jpeg(16, 16, false, false) : none);

        seed("raw", preview ? "preview" : "plain", file.data, file.size);
        if (preview)
            seed("photo", "preview.dng", file.data, file.size);
        bytes_free(&file);
    }
}

static void seed_trailer(void)
{
    for (int i = 0; i < 2; i++) {
        struct bytes file = i ? make_huawei(6, 4, false) : make_samsung(32, 6, 4, false, true);
        struct bytes main_picture = make_jpeg(64, 32, false, false);

        seed("trailer", i ? "huawei" : "samsung", file.data + main_picture.size,
             file.size - main_picture.size);
        bytes_free(&main_picture);
        bytes_free(&file);
    }
}

/* A result that holds its original and depth in one packet of XMP. */
static void write_editable(const char *path, const struct refocus_photo *photo)
{
    uint8_t pixels[3 * 16 * 16] = {0};
    const uint16_t samples[6] = {1, 2, 3, 4, 5, 6};
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 16, 16, 48);
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_editable editable = refocus_editable_default();
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_reason reason;

    depth.disparity = samples;
    depth.width = 3;
    depth.height = 2;
    depth.stride = 6;
    editable.depth = &depth;
    options.keep = photo;
    options.editable = &editable;
    if (refocus_image_write(path, &image, &options, &reason) != REFOCUS_OK) {
        fprintf(stderr, "%s: %s\n", path, reason.text);
        exit(1);
    }
}

static void seed_editable_heic(void)
{
    struct bytes jpeg = make_jpeg(16, 16, false, false);
    struct refocus_photo *photo = NULL, *result = NULL;
    struct refocus_blob heic = {NULL, 0};
    char path[1024];

    snprintf(path, sizeof path, "%s/photo/editable.heic", root);
    if (refocus_photo_read_memory(&photo, jpeg.data, jpeg.size, NULL, NULL) != REFOCUS_OK)
        exit(1);
    write_editable(path, photo);
    if (refocus_file_read(path, UINT64_MAX, &heic, NULL) != REFOCUS_OK ||
        refocus_photo_read(&result, path, NULL, NULL) != REFOCUS_OK)
        exit(1);
    seed("heif_boxes", "editable", heic.data, heic.size);
    seed("xmp", "editable", rf_kept_of(result)->bytes.data, rf_kept_of(result)->bytes.size);
    free(heic.data);
    refocus_photo_free(&result);
    refocus_photo_free(&photo);
    bytes_free(&jpeg);
}

int main(int count, char **arguments)
{
    if (count != 2) {
        fprintf(stderr, "usage: make_corpus FOLDER\n");
        return 2;
    }
    root = arguments[1];
    mkdir(root, 0777);
    seed_samples();
    seed_exif();
    seed_mpf();
    seed_gain_map();
    seed_heif_boxes();
    seed_xmp();
    seed_dynamic();
    seed_formats();
    seed_trailer();
    seed_editable_heic();
    seed_text("number", "decimal", " -12.5e-3 ");
    seed_text("number", "long", "123456789012345678901234567890.000000000000000000001");
    seed_text("number", "base64", "QUJD RA==");
    return 0;
}
