/* deep.c: takes over pictures of more than 8 bits a channel, and converts half floats. */
#include "image/deep.h"

#include "image/format.h"

/* The curve a picture is stored by, and its light that is white. */
static void set_light(struct rf_deep *deep, bool to_light)
{
    const struct refocus_image *image = &deep->image;
    const float gamma = image->gamma > 0 ? image->gamma : 2.2f;
    uint32_t transfer = image->transfer;

    if (transfer == REFOCUS_TRANSFER_DEFAULT)
        transfer = deep->sample == RF_SAMPLE_U16 ? REFOCUS_TRANSFER_SRGB : REFOCUS_TRANSFER_LINEAR;
    deep->linear = transfer == REFOCUS_TRANSFER_LINEAR;
    deep->white = image->white > 0                   ? image->white
                  : transfer == REFOCUS_TRANSFER_PQ  ? 203
                  : transfer == REFOCUS_TRANSFER_HLG ? 0.26496256f
                                                     : 1;
    if (transfer == REFOCUS_TRANSFER_PQ)
        deep->white /= 100;
    if (!deep->linear &&
        (deep->transfer != transfer || deep->gamma != gamma || deep->made_to_light != to_light))
        rf_curve_make(deep->curve, transfer, gamma, to_light);
    deep->transfer = deep->linear ? deep->transfer : transfer;
    deep->gamma = deep->linear ? deep->gamma : gamma;
    deep->made_to_light = to_light;
}

void rf_deep_begin(struct rf_deep *deep, const struct refocus_image *image, bool to_light)
{
    deep->on = rf_is_deep(image->format);
    deep->exceeds = false;
    if (!deep->on)
        return;
    deep->image = *image;
    deep->yuv = refocus_format_is_yuv(image->format);
    deep->sample =
        deep->yuv ? RF_SAMPLE_U16 : (enum rf_sample)((image->format - REFOCUS_FORMAT_RGB16) / 2);
    deep->channels = deep->yuv ? 3 : 3 + (int)((image->format - REFOCUS_FORMAT_RGB16) % 2);
    deep->bytes = deep->yuv ? 2 : refocus_format_bytes(image->format) / deep->channels;
    if (deep->yuv)
        rf_deep_set_codes(&deep->codes, image);
    set_light(deep, to_light);
    deep->exceeds =
        deep->sample != RF_SAMPLE_U16 || (to_light && rf_deep_light_of(deep, 1) > 1.001f);
}

void rf_deep_begin_codes(struct rf_deep *deep)
{
    deep->image.transfer = REFOCUS_TRANSFER_SRGB;
    deep->image.gamma = deep->image.white = 0;
    set_light(deep, false);
}

bool rf_deep_is_alike(const struct rf_deep *a, const struct rf_deep *b)
{
    return a->on && b->on && a->image.format == b->image.format && a->linear == b->linear &&
           a->white == b->white &&
           (!a->yuv || (a->image.matrix == b->image.matrix && a->image.range == b->image.range)) &&
           (a->linear || (a->transfer == b->transfer && a->gamma == b->gamma));
}

float rf_half_to_float(uint16_t half)
{
    const uint32_t sign = (uint32_t)(half >> 15) << 31, rest = half & 0x7fff;
    uint32_t bits;
    float value;

    if (rest < 0x400) /* zero and what is below the normal numbers: exact */
        return (sign ? -1.0f : 1.0f) * ((float)rest * (1.0f / (1 << 24)));
    bits =
        sign | (rest >= 0x7c00 ? 0x7f800000 | (rest & 0x3ff) << 13 : (rest << 13) + (112u << 23));
    memcpy(&value, &bits, sizeof value);
    return value;
}

uint16_t rf_float_to_half(float value)
{
    uint16_t sign = 0;
    uint32_t bits;

    if (value < 0) {
        sign = 0x8000;
        value = -value;
    }
    if (!(value > 0))
        return sign;
    if (value >= 65504)
        return sign | 0x7bff;
    if (value < 1.0f / (1 << 14)) { /* in steps of 2^-24; adding 1/2 rounds to them as IEEE does */
        value += 0.5f;
        memcpy(&bits, &value, sizeof bits);
        return (uint16_t)(sign | (bits - 0x3f000000));
    }
    memcpy(&bits, &value, sizeof bits);
    bits += 0xfff + (bits >> 13 & 1);
    return (uint16_t)(sign | ((bits >> 13) - (112 << 10)));
}
