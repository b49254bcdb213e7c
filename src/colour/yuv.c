/* yuv.c: makes the tables between codes of Y, U, V and the values that are averaged. */
#include "colour/yuv.h"

#include <math.h>
#include <stdbool.h>

#include <refocus/render.h>

/* The nearest whole number. None of the values here is so near a half that it could go both ways.
 */
static int rounded(double v)
{
    return (int)floor(v + 0.5);
}

/* Interpolates the curve between the codes of the table by straight lines. */
static void set_light(struct rf_yuv_curve *curve, const uint16_t to_light[256])
{
    for (int tone = 0; tone < RF_TONES; tone++) {
        const int code = tone / 4, part = tone % 4;
        const int next = part ? to_light[code + 1] : 0;

        curve->light[tone] = (uint16_t)((to_light[code] * (4 - part) + next * part + 2) / 4);
    }
}

/* Finds for each mean the tone whose light is nearest; of several the middle one. */
static void set_tones(struct rf_yuv_curve *curve)
{
    int first = 0; /* the first tone of at least the light */

    for (int i = 0; i <= RF_MEAN_MAX >> 1; i++) {
        int end;

        while (first < RF_TONES - 1 && 2 * curve->light[first] < i)
            first++;
        if (2 * curve->light[first] > i && first > 0 &&
            i - 2 * curve->light[first - 1] <= 2 * curve->light[first] - i)
            first--;
        for (end = first; end < RF_TONES - 1 && curve->light[end + 1] == curve->light[first];)
            end++;
        curve->tone[i] = (int16_t)((first + end) / 2);
        while (first > 0 && curve->light[first - 1] == curve->light[first])
            first--;
    }
}

/* Finds for each mean the code of Y whose interval, half a code to both sides, holds the light. */
static void set_codes(struct rf_yuv_curve *curve, int black, double tones_per_code, int white)
{
    int code = black;

    for (int mean = 0; mean <= RF_MEAN_MAX; mean++) {
        while (code < white) {
            const double at = (code - black + 0.5) * tones_per_code;
            const int tone = (int)at;
            const int light =
                4 * curve->light[tone] +
                rounded(4 * (curve->light[tone + 1] - curve->light[tone]) * (at - tone));

            if (mean < light)
                break;
            code++;
        }
        curve->to_code[mean] = (uint8_t)code;
    }
}

void rf_yuv_curve_init(struct rf_yuv_curve *curve, uint32_t matrix, uint32_t range, uint32_t blend)
{
    const bool limited = range == REFOCUS_RANGE_LIMITED, hd = matrix == REFOCUS_MATRIX_BT709;
    const double per_luma = 4 * (limited ? 255.0 / 219 : 1); /* tones of a code */
    const double per_chroma = 4 * (limited ? 255.0 / 224 : 1);
    const double kr = hd ? 0.2126 : 0.299, kb = hd ? 0.0722 : 0.114, kg = 1 - kr - kb;
    const double range_of[2] = {2 * (1 - kb), 2 * (1 - kr)}, share[2] = {kb, kr};
    const int black = limited ? 16 : 0;

    set_light(curve, rf_light_of_codes(blend));
    set_tones(curve);
    set_codes(curve, black, per_luma, limited ? 235 : 255);
    curve->kr = rounded(RF_SHARE * kr);
    curve->kb = rounded(RF_SHARE * kb);
    curve->kg = RF_SHARE - curve->kr - curve->kb;
    curve->red = rounded(RF_SHARE * kr / kg);
    curve->blue = rounded(RF_SHARE * kb / kg);
    for (int code = 0; code < 256; code++) {
        const int tone = rf_clip_tone(rounded(per_luma * (code - black)));

        curve->luma[code] = (int16_t)tone;
        curve->light_of_luma[code] = curve->light[tone];
    }
    for (int i = 0; i < 2; i++) {
        const double tones = per_chroma * range_of[i];

        curve->tones_per_code[i] = rounded(4096 * tones);
        curve->green_per_code[i] = rounded(4096 * tones * share[i] / kg);
        curve->codes_per_tone[i] = rounded(65536 / tones);
    }
}
