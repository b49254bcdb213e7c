/* deep_yuv.c: pixels of P010 and P016, of Y, U and V of 16 bits, 4:2:0, are read and written as R,
 * G and B. A sample of chroma is that of 2 x 2 pixels, as in pictures of 8 bits. */
#include "image/deep.h"

void rf_deep_set_codes(struct rf_deep_codes *codes, const struct refocus_image *image)
{
    static const float kr[] = {0.299f, 0.2126f, 0.2627f}, kb[] = {0.114f, 0.0722f, 0.0593f};
    const bool full = image->range == REFOCUS_RANGE_FULL,
               ten = image->format == REFOCUS_FORMAT_P010;
    const float most = ten ? 65472 : 65535; /* the largest code */

    codes->step = ten ? 64 : 1;
    codes->y_scale = full ? most : 219 * 256;
    codes->y_zero = full ? 0 : 16 * 256;
    codes->c_scale = full ? most : 224 * 256;
    codes->c_zero = 128 * 256;
    codes->kr = kr[image->matrix];
    codes->kb = kb[image->matrix];
    codes->kg = 1 - codes->kr - codes->kb;
}

uint8_t *rf_deep_luma(const struct rf_deep *deep, int x, int y)
{
    return deep->image.plane[0] + y * deep->image.stride[0] + 2 * (ptrdiff_t)x;
}

uint8_t *rf_deep_chroma(const struct rf_deep *deep, int x, int y)
{
    return deep->image.plane[1] + y / 2 * deep->image.stride[1] + 4 * (ptrdiff_t)(x / 2);
}

static float read_code(const struct rf_deep_codes *codes, const uint8_t *at)
{
    uint16_t bits;

    memcpy(&bits, at, sizeof bits);
    return (float)(bits / codes->step * codes->step);
}

static void write_code(const struct rf_deep_codes *codes, uint8_t *at, float code)
{
    const float steps = code / (float)codes->step;
    const int most = 65535 / codes->step;
    const int n = !(steps > 0) ? 0 : steps >= (float)most ? most : (int)(steps + 0.5f);
    const uint16_t bits = (uint16_t)(n * codes->step);

    memcpy(at, &bits, sizeof bits);
}

void rf_deep_read_yuv(const struct rf_deep *deep, int x, int y, float value[3])
{
    const struct rf_deep_codes *codes = &deep->codes;
    const uint8_t *chroma = rf_deep_chroma(deep, x, y);
    const float luma =
        (read_code(codes, rf_deep_luma(deep, x, y)) - codes->y_zero) / codes->y_scale;
    const float u = (read_code(codes, chroma) - codes->c_zero) / codes->c_scale;
    const float v = (read_code(codes, chroma + 2) - codes->c_zero) / codes->c_scale;

    value[0] = luma + 2 * (1 - codes->kr) * v;
    value[2] = luma + 2 * (1 - codes->kb) * u;
    value[1] = (luma - codes->kr * value[0] - codes->kb * value[2]) / codes->kg;
}

static float luma_of(const struct rf_deep_codes *codes, const float value[3])
{
    return codes->kr * value[0] + codes->kg * value[1] + codes->kb * value[2];
}

void rf_deep_store_luma(const struct rf_deep *deep, uint8_t *at, const float value[3])
{
    const struct rf_deep_codes *codes = &deep->codes;

    write_code(codes, at, luma_of(codes, value) * codes->y_scale + codes->y_zero);
}

void rf_deep_store_chroma(const struct rf_deep *deep, uint8_t *at, const float value[3])
{
    const struct rf_deep_codes *codes = &deep->codes;
    const float luma = luma_of(codes, value);
    const float u = (value[2] - luma) / (2 * (1 - codes->kb));
    const float v = (value[0] - luma) / (2 * (1 - codes->kr));

    write_code(codes, at, u * codes->c_scale + codes->c_zero);
    write_code(codes, at + 2, v * codes->c_scale + codes->c_zero);
}
