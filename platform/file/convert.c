/* convert.c: samples as they are stored become RGB8 photos or one channel of depth. */
#include "convert.h"

#include <math.h>

#include "reason.h"

/* Bayer's matrix holds each of 0 to 63 once, and near values lie far apart in it. */
void rf_dither_thresholds(uint8_t thresholds[64])
{
    for (int y = 0; y < 8; y++) {
        for (int x = 0; x < 8; x++) {
            int value = 0;

            for (int bit = 0; bit < 3; bit++)
                value |= ((x ^ y) >> bit & 1) << (5 - 2 * bit) | (y >> bit & 1) << (4 - 2 * bit);
            thresholds[8 * y + x] = (uint8_t)value;
        }
    }
}

/* More than 8 bits are dithered: a code is rounded up in as many of 8 x 8 pixels as the
 * value lies above it, so that the mean over them keeps within 1/128 of a code, and
 * shallow gradients have no steps. Codes that 8 bits have stay what they are, and so
 * does grey, as all channels share one threshold. With a maximum of 65535, 25957 is 101
 * everywhere; 26000 is 101.17, that is 102 in 11 of 64 pixels. The products fit:
 * 65535 * 255 * 128 < 2^31. */
static void dither(const struct rf_raster *from, struct rf_raster *to)
{
    const uint32_t max = from->max_value;
    const size_t width = (size_t)from->width, channels = (size_t)from->channels;
    uint8_t thresholds[64];

    rf_dither_thresholds(thresholds);
    for (size_t y = 0; y < (size_t)from->height; y++) {
        for (size_t x = 0; x < width; x++) {
            const uint32_t threshold = 2u * thresholds[8 * (y & 7) + (x & 7)] + 1;

            for (size_t c = 0; c < 3; c++) {
                const uint32_t v =
                    rf_raster_sample(from, (y * width + x) * channels + (channels == 3 ? c : 0));
                to->pixels[3 * (y * width + x) + c] =
                    (uint8_t)((v * (255u * 128) + threshold * max) / (max * 128));
            }
        }
    }
}

/* Linear light to codes of sRGB; what is above white is white. */
static void encode_floats(const struct rf_raster *from, struct rf_raster *to)
{
    const float *const light = (const float *)(const void *)from->pixels;
    const size_t count = 3 * (size_t)from->width * (size_t)from->height;

    for (size_t i = 0; i < count; i++) {
        const float v = light[i] >= 1 ? 1 : light[i] > 0 ? light[i] : 0;
        const float code = v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1 / 2.4f) - 0.055f;

        to->pixels[i] = (uint8_t)(255 * code + 0.5f);
    }
}

/* All 16 bits of a raster of fewer or of one channel. */
static int spread_to_16(const struct rf_read *read, struct rf_raster *raster)
{
    struct rf_raster all = *raster;
    const uint32_t max = raster->max_value;
    const size_t channels = (size_t)raster->channels;
    uint16_t *to;
    int status;

    if (max == 65535 && channels == 3)
        return REFOCUS_OK;
    all.channels = 3;
    all.max_value = 65535;
    status = rf_raster_alloc(read, &all);
    if (status != REFOCUS_OK)
        return status;
    to = (uint16_t *)(void *)all.pixels;
    for (size_t i = 0; i < 3 * (size_t)all.width * (size_t)all.height; i++) {
        const uint64_t v = rf_raster_sample(raster, channels == 3 ? i : i / 3);
        to[i] = (uint16_t)((v * 65535 + max / 2) / max);
    }
    rf_raster_free(raster);
    *raster = all;
    return REFOCUS_OK;
}

int rf_image_to_rgb8(struct rf_read *read)
{
    struct rf_raster *const raster = &read->image;
    struct rf_raster rgb = *raster;
    const size_t count = (size_t)raster->width * (size_t)raster->height;
    const int channels = raster->channels;
    const uint32_t max = raster->max_value;
    const bool floats = raster->sample == REFOCUS_SAMPLE_F32;
    int status;

    if (raster->sample == REFOCUS_SAMPLE_U8 && channels == 3 && max == 255)
        return REFOCUS_OK;
    rgb.channels = 3;
    rgb.sample = REFOCUS_SAMPLE_U8;
    rgb.max_value = 255;
    status = rf_raster_alloc(read, &rgb);
    if (status != REFOCUS_OK)
        return status;
    if (floats)
        encode_floats(raster, &rgb);
    else if (max > 255)
        dither(raster, &rgb);
    for (size_t i = 0; !floats && max <= 255 && i < count; i++) {
        for (int c = 0; c < 3; c++) {
            const size_t from = i * (size_t)channels + (size_t)(channels == 3 ? c : 0);
            const uint32_t v = rf_raster_sample(raster, from);
            rgb.pixels[3 * i + (size_t)c] = (uint8_t)((v * 255u + max / 2) / max);
        }
    }
    if (floats || max > 255)
        read->deep = *raster;
    else
        rf_raster_free(raster);
    *raster = rgb;
    return floats || max <= 255 ? REFOCUS_OK : spread_to_16(read, &read->deep);
}

/* JPEG stores brightness and colour apart: grey that went through colour differs by a
 * few levels between its channels (11 at most in the files at hand). */
enum { LOSSY_GREY = 24 };

int rf_raster_to_grey(const struct rf_read *read, struct rf_raster *raster)
{
    struct rf_raster grey = *raster;
    const size_t count = (size_t)raster->width * (size_t)raster->height;
    const uint32_t tolerance = raster->lossy ? LOSSY_GREY : 0;
    int status;

    if (raster->channels == 1)
        return REFOCUS_OK;
    grey.channels = 1;
    status = rf_raster_alloc(read, &grey);
    if (status != REFOCUS_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        const uint32_t r = rf_raster_sample(raster, 3 * i);
        const uint32_t g = rf_raster_sample(raster, 3 * i + 1);
        const uint32_t b = rf_raster_sample(raster, 3 * i + 2);
        const uint32_t low = r < g ? (r < b ? r : b) : (g < b ? g : b);
        const uint32_t high = r > g ? (r > b ? r : b) : (g > b ? g : b);
        const uint32_t v = (r + 2 * g + b + 2) / 4;

        if (high - low > tolerance) {
            rf_raster_free(&grey);
            return rf_fail(read->reason, REFOCUS_ERR_NO_DEPTH,
                           "it is a colour picture, not a depth map; give one in grey");
        }
        if (grey.sample == REFOCUS_SAMPLE_U8)
            grey.pixels[i] = (uint8_t)v;
        else
            ((uint16_t *)(void *)grey.pixels)[i] = (uint16_t)v;
    }
    rf_raster_free(raster);
    *raster = grey;
    return REFOCUS_OK;
}
