/* deep.h: pictures of more than 8 bits a channel: how their pixels are read and written as light.
 *
 * Light is 1 where a display shows white, and goes on above it. A photo of this kind is not copied:
 * it stays the caller's, and what is above white, or finer than the planes of light, is read there.
 */
#ifndef RF_DEEP_H
#define RF_DEEP_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include <refocus/image.h>

#include "colour/curve.h"

enum rf_sample { RF_SAMPLE_U16, RF_SAMPLE_HALF, RF_SAMPLE_FLOAT };

/* How Y, U and V stand for R, G and B, all of 0 to 1 but for what a format holds beyond:
 * a code is scale * value + zero, in steps. */
struct rf_deep_codes {
    int step; /* 64 of P010, whose lower bits are not used */
    float y_scale, y_zero, c_scale, c_zero;
    float kr, kg, kb; /* weights of R, G and B in Y */
};

struct rf_deep {
    bool on;      /* the picture is deep; else all other members are not valid */
    bool exceeds; /* the picture can hold light above white: nothing was clipped */
    bool linear;  /* there is no curve */
    struct refocus_image image;
    enum rf_sample sample;
    int bytes;                  /* bytes of a sample */
    int channels;               /* 3, or 4 with alpha */
    bool yuv;                   /* P010 or P016: 3 channels that are stored as Y, U and V */
    struct rf_deep_codes codes; /* Y, U and V as codes */
    float white;                /* light that is white, in the curve's unit */
    struct rf_curve *curve;     /* memory of the renderer; made for `transfer` and `gamma`: */
    uint32_t transfer;          /* 0: for none */
    float gamma;
    bool made_to_light;
};

/* Sets how a picture of P010 or P016 is coded. */
void rf_deep_set_codes(struct rf_deep_codes *codes, const struct refocus_image *image);

/* Takes over a picture of any format: one that light is read from or, not to_light, written to.
 * deep->curve is set. */
void rf_deep_begin(struct rf_deep *deep, const struct refocus_image *image, bool to_light);

/* Makes the curve of sRGB, for values of a picture of 8 bits; deep->on stays false. */
void rf_deep_begin_codes(struct rf_deep *deep);

/* Whether pixels of two pictures mean the same, byte by byte. */
bool rf_deep_is_alike(const struct rf_deep *a, const struct rf_deep *b);

float rf_half_to_float(uint16_t half);
/* Rounds to nearest, ties to even; beyond the largest half to that. NaN is 0. */
uint16_t rf_float_to_half(float value);

/* R, G and B of a pixel of Y, U and V, as values of the curve. */
void rf_deep_read_yuv(const struct rf_deep *deep, int x, int y, float value[3]);
/* Where its Y lies, and the U and V that it shares with its neighbours. */
uint8_t *rf_deep_luma(const struct rf_deep *deep, int x, int y);
uint8_t *rf_deep_chroma(const struct rf_deep *deep, int x, int y);
/* Write Y of a pixel; then U and V of the mean of those that share it. */
void rf_deep_store_luma(const struct rf_deep *deep, uint8_t *at, const float value[3]);
void rf_deep_store_chroma(const struct rf_deep *deep, uint8_t *at, const float value[3]);

/* A pixel of R, G and B. */
static inline uint8_t *rf_deep_pixel(const struct rf_deep *deep, int x, int y)
{
    return deep->image.plane[0] + y * deep->image.stride[0] +
           (ptrdiff_t)x * deep->channels * deep->bytes;
}

/* A stored value, at any address. */
static inline float rf_deep_value(const struct rf_deep *deep, const uint8_t *at)
{
    uint16_t bits;
    float value;

    if (deep->sample == RF_SAMPLE_FLOAT) {
        memcpy(&value, at, sizeof value);
        return value;
    }
    memcpy(&bits, at, sizeof bits);
    return deep->sample == RF_SAMPLE_HALF ? rf_half_to_float(bits) : (float)bits / 65535;
}

/* The light of a value: 0 of what is below, and of NaN; 1024 at most. */
static inline float rf_deep_light_of(const struct rf_deep *deep, float value)
{
    const float light = (deep->linear ? value : rf_curve_at(deep->curve, value)) / deep->white;

    return light > 0 ? light < 1024 ? light : 1024 : 0;
}

/* The value of light >= 0. */
static inline float rf_deep_value_of(const struct rf_deep *deep, float light)
{
    light *= deep->white;
    return deep->linear ? light : rf_curve_at(deep->curve, light);
}

/* The light of a pixel. */
static inline void rf_deep_light(const struct rf_deep *deep, int x, int y, float light[3])
{
    const uint8_t *at;
    float value[3];

    if (deep->yuv) {
        rf_deep_read_yuv(deep, x, y, value);
        for (int c = 0; c < 3; c++)
            light[c] = rf_deep_light_of(deep, value[c]);
        return;
    }
    at = rf_deep_pixel(deep, x, y);
    for (int c = 0; c < 3; c++)
        light[c] = rf_deep_light_of(deep, rf_deep_value(deep, at + c * deep->bytes));
}

static inline void rf_deep_store_value(const struct rf_deep *deep, uint8_t *at, float value)
{
    uint16_t bits;

    if (deep->sample == RF_SAMPLE_FLOAT) {
        memcpy(at, &value, sizeof value);
        return;
    }
    if (deep->sample == RF_SAMPLE_HALF)
        bits = rf_float_to_half(value);
    else
        bits = !(value > 0) ? 0 : value >= 1 ? 65535 : (uint16_t)(value * 65535 + 0.5f);
    memcpy(at, &bits, sizeof bits);
}

/* Stores light >= 0. */
static inline void rf_deep_store(const struct rf_deep *deep, uint8_t *at, float light)
{
    rf_deep_store_value(deep, at, rf_deep_value_of(deep, light));
}

#endif
