/* light.c: pictures by the curves of HDR become linear light, 1 = white, in the primaries of
 * BT.709. */
#include "light.h"

#include <math.h>
#include <stdlib.h>

#include "reason.h"

bool rf_curve_is_hdr(int curve)
{
    return curve == RF_CURVE_LINEAR || curve == RF_CURVE_PQ || curve == RF_CURVE_HLG;
}

/* ITU-R BT.2100: 1 is 10,000 cd/m2, here in units of white, 203. */
static float light_of_pq(float value)
{
    const float p = powf(value, 1 / 78.84375f);
    const float top = p > 0.8359375f ? p - 0.8359375f : 0;

    return powf(top / (18.8515625f - 18.6875f * p), 1 / 0.1593017578125f) * (10000.0f / 203);
}

/* ITU-R BT.2100: light of the scene, in units of that at 75 % of the signal. */
static float light_of_hlg(float value)
{
    const float a = 0.17883277f, b = 0.28466892f, c = 0.55991073f, white = 0.26496256f;

    return (value <= 0.5f ? value * value / 3 : (expf((value - c) / a) + b) / 12) / white;
}

static float light_of_srgb(float value)
{
    return value <= 0.04045f ? value / 12.92f : powf((value + 0.055f) / 1.055f, 2.4f);
}

static float light_of(float value, int curve)
{
    return curve == RF_CURVE_PQ     ? light_of_pq(value < 1 ? value : 1)
           : curve == RF_CURVE_HLG  ? light_of_hlg(value)
           : curve == RF_CURVE_SRGB ? light_of_srgb(value)
                                    : value;
}

/* Rows: R, G and B of BT.709 out of those of other primaries with the same white (ITU-R BT.2087,
 * and from the chromaticities of SMPTE EG 432-1). */
static const float from_2020[3][3] = {{1.660491f, -0.587641f, -0.072850f},
                                      {-0.124550f, 1.132900f, -0.008349f},
                                      {-0.018151f, -0.100579f, 1.118730f}};
static const float from_p3[3][3] = {
    {1.224940f, -0.224940f, 0}, {-0.042057f, 1.042057f, 0}, {-0.019638f, -0.078636f, 1.098274f}};

static void change_primaries(float *light, const float matrix[3][3])
{
    float out[3];

    for (int c = 0; c < 3; c++)
        out[c] = matrix[c][0] * light[0] + matrix[c][1] * light[1] + matrix[c][2] * light[2];
    for (int c = 0; c < 3; c++)
        light[c] = out[c] > 0 ? out[c] : 0;
}

static float float_at(const struct rf_raster *raster, size_t index)
{
    return ((const float *)(const void *)raster->pixels)[index];
}

int rf_raster_to_light(const struct rf_read *read, struct rf_raster *raster, int curve,
                       int primaries)
{
    const size_t samples = 3 * (size_t)raster->width * (size_t)raster->height;
    const bool floats = raster->sample == REFOCUS_SAMPLE_F32;
    const size_t codes = floats ? 0 : (size_t)raster->max_value + 1;
    struct rf_raster made = *raster;
    float *table, *light;
    int status;

    made.sample = REFOCUS_SAMPLE_F32;
    made.max_value = 0;
    status = rf_raster_alloc(read, &made);
    if (status != REFOCUS_OK)
        return status;
    table = malloc((codes + 1) * sizeof *table);
    if (!table) {
        rf_raster_free(&made);
        return rf_fail_memory(read->reason);
    }
    for (size_t i = 0; i < codes; i++)
        table[i] = light_of((float)i / (float)raster->max_value, curve);
    light = (float *)(void *)made.pixels;
    for (size_t i = 0; i < samples; i++) {
        const uint32_t code = floats ? 0 : rf_raster_sample(raster, i);

        light[i] = floats         ? light_of(float_at(raster, i), curve)
                   : code < codes ? table[code]
                                  : table[codes - 1];
    }
    for (size_t i = 0; i < samples && primaries == RF_PRIMARIES_BT2020; i += 3)
        change_primaries(light + i, from_2020);
    for (size_t i = 0; i < samples && primaries == RF_PRIMARIES_P3; i += 3)
        change_primaries(light + i, from_p3);
    free(table);
    rf_raster_free(raster);
    *raster = made;
    return REFOCUS_OK;
}

void rf_note_curve(const struct rf_read *read, int curve, int primaries)
{
    rf_note(read->info, "%s: the curve of %s%s, read as linear light", read->info->container,
            curve == RF_CURVE_PQ    ? "PQ"
            : curve == RF_CURVE_HLG ? "HLG"
                                    : "linear light",
            primaries == RF_PRIMARIES_BT2020 ? " with the primaries of BT.2020" : "");
}
