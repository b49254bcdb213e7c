/* samples.c: makes one small file of every kind that the readers tell apart. */
#include "samples.h"

#include <string.h>

#include "make_formats.h"

static void put(struct sample *samples, int *count, const char *name, struct bytes bytes,
                bool photo, bool depth)
{
    const struct sample sample = {name, bytes, photo, depth, 0, false};

    samples[(*count)++] = sample;
}

static struct bytes text_with(const char *head, const void *body, size_t size)
{
    struct bytes file = {NULL, 0};

    bytes_text(&file, head);
    bytes_add(&file, body, size);
    return file;
}

static void put_plain(struct sample *samples, int *count)
{
    put(samples, count, "p5.pgm", text_with("P5\n3 2\n255\n", "\1\2\3\4\5\6", 6), true, true);
    put(samples, count, "p5-16.pgm", text_with("P5\n# 16 bits\n2 1\n65535\n", "\1\2\3\4", 4), true,
        true);
    put(samples, count, "p6.ppm", text_with("P6\n2 1\n255\n", "\1\2\3\4\5\6", 6), true, false);
    put(samples, count, "p2.pgm", text_with("P2 3 1 10\n", "1 2 10", 6), true, true);
    samples[*count - 1].loose_end = true;
    put(samples, count, "p3.ppm", text_with("P3 1 1 10\n", "7 7 7", 5), true, true);
    put(samples, count, "pf-low.pfm", text_with("Pf\n2 1\n-1.0\n", "\0\0\200\77\0\0\0\100", 8),
        false, true);
    put(samples, count, "pf-high.pfm", text_with("Pf\n1 2\n1.0\n", "\77\200\0\0\177\300\0\0", 8),
        false, true);
}

#ifdef RF_HAVE_PNG
static void put_png(struct sample *samples, int *count)
{
    struct bytes exif = make_exif(false, 6);
    uint8_t rgb[27];

    put(samples, count, "grey16.png", make_png(4, 3, 0, 16), true, true);
    put(samples, count, "palette.png", make_png(4, 3, 3, 8), true, true);
    put(samples, count, "rgba.png", make_png(3, 2, 6, 8), true, false);
    memset(rgb, 9, sizeof rgb);
    put(samples, count, "exif.png", make_png_raw(3, 3, 2, 8, rgb, &exif), true, true);
    bytes_free(&exif);
}
#endif

#ifdef RF_HAVE_JPEG
static void put_jpeg(struct sample *samples, int *count)
{
    struct bytes jpeg = make_jpeg(16, 16, false, true);

    jpeg_insert_exif(&jpeg, make_exif(true, 6));
    put(samples, count, "progressive.jpg", jpeg, true, false);
    put(samples, count, "samsung.jpg", make_samsung(32, 6, 4, false, true), true, true);
    samples[*count - 1].loose_end = true;
    put(samples, count, "huawei.jpg", make_huawei(6, 4, false), true, true);
    samples[*count - 1].loose_end = true;
    put(samples, count, "grey.jpg", make_jpeg(16, 16, true, false), true, true);
}
#endif

#if defined(RF_HAVE_JPEG) && defined(RF_HAVE_XMP)
static void put_phone(struct sample *samples, int *count)
{
    const struct gdepth jpeg_depth = {.format = "RangeLinear",
                                      .extra = "GDepth:Near=\"1\" GDepth:Far=\"9\"",
                                      .depth = make_jpeg(16, 16, true, false)};
    struct bytes parts[2] = {
        make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", NULL),
        make_auxiliary("disparity", "apdi:FloatMinValue=\"0.25\" apdi:FloatMaxValue=\"4\"")};
    const size_t last = parts[0].size + parts[1].size;

    struct bytes map = make_jpeg(16, 16, false, false);
    struct bytes xmp = make_gain_xmp("<hdrgm:GainMapMax>3</hdrgm:GainMapMax>"
                                     "<hdrgm:HDRCapacityMax>3</hdrgm:HDRCapacityMax>");
    struct bytes turned = make_jpeg(16, 16, false, false);
    size_t map_size;

    jpeg_insert_xmp(&map, (const char *)xmp.data);
    bytes_free(&xmp);
    map_size = map.size;
    jpeg_insert_exif(&turned, make_exif(true, 6));
    put(samples, count, "gain.jpg", make_mpf(turned, &map, 1, true), true, false);
    samples[*count - 1].whole_at = samples[*count - 1].bytes.size - map_size;
    put(samples, count, "linear.jpg", make_gdepth(jpeg_depth, 8), true, true);
    put(samples, count, "apple.jpg", make_mpf(make_jpeg(16, 16, false, false), parts, 2, true),
        true, true);
    samples[*count - 1].whole_at = samples[*count - 1].bytes.size - last;
#ifdef RF_HAVE_PNG
    const struct gdepth png_depth = {
        .format = "RangeInverse",
        .extra = "GDepth:Near=\"0.5\" GDepth:Far=\"8\" GFocus:BlurAtInfinity=\"0.01\" "
                 "GFocus:FocalPointX=\"0.5\" GFocus:FocalPointY=\"0.25\" ",
        .depth = make_png(4, 3, 0, 8),
        .original = make_png(3, 2, 2, 8)};
    const struct dynamic dynamic = {.map = "DepthMap:Format=\"RangeInverse\" "
                                           "DepthMap:DepthURI=\"android/depthmap\" "
                                           "DepthMap:ConfidenceURI=\"android/confidencemap\"",
                                    .depth = make_png(4, 3, 0, 8),
                                    .confidence = make_png(4, 3, 0, 8)};
    const size_t behind = dynamic.depth.size + dynamic.confidence.size;

    put(samples, count, "extended.jpg", make_gdepth_extended(png_depth, 100, 23, -1), true, true);
    put(samples, count, "dynamic.jpg", make_dynamic(dynamic, 6), true, true);
    samples[*count - 1].whole_at = samples[*count - 1].bytes.size - behind;
#endif
}
#endif

static void put_npy(struct sample *samples, int *count)
{
    put(samples, count, "f2.npy",
        make_npy(1, "{'descr': '<f2', 'fortran_order': False, 'shape': (1, 2), }", "\0\74\0\74", 4),
        false, true);
    put(samples, count, "u2.npy",
        make_npy(2, "{'descr': '>u2', 'fortran_order': True, 'shape': (2, 1), }", "\0\1\0\2", 4),
        false, true);
}

int make_samples(struct sample *samples)
{
    int count = 0;

    put_plain(samples, &count);
#ifdef RF_HAVE_PNG
    put_png(samples, &count);
#endif
#ifdef RF_HAVE_JPEG
    put_jpeg(samples, &count);
#endif
#if defined(RF_HAVE_JPEG) && defined(RF_HAVE_XMP)
    put_phone(samples, &count);
#endif
    put_npy(samples, &count);
    return count;
}

void free_samples(struct sample *samples, int count)
{
    for (int i = 0; i < count; i++)
        bytes_free(&samples[i].bytes);
}
