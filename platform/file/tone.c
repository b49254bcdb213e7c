/* tone.c: the curve from true light to that of a base rendition is measured in the photo itself,
 * where both are known, and applied to light that was refocused. */
#include "tone.h"

#include <math.h>
#include <stdlib.h>

#include <refocus/status.h>

enum {
    STEP = 64, /* halves to a bin: 16 bins an octave */
    BINS = (RF_HALF_MOST + STEP) / STEP,
};

/* The codes that the pixels of a bin have, and where in the bin they lie. */
struct bin {
    uint32_t codes[256];
    uint64_t count;
    double halves;
};

/* A point of the curve, and how many samples say so. */
struct knot {
    double half, light, count;
};

float rf_tone_light(int code)
{
    const double v = code / 255.0;

    return (float)(v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
}

static int brightest(const uint16_t *light)
{
    const int c = light[1] > light[0] ? 1 : 0;

    return light[2] > light[c] ? 2 : c;
}

static void count(struct bin *bins, const struct refocus_image *base,
                  const struct refocus_image *light, bool by_brightest)
{
    for (int y = 0; y < base->height; y++) {
        const uint8_t *code = base->plane[0] + y * base->stride[0];
        const uint16_t *own =
            (const uint16_t *)(const void *)(light->plane[0] + y * light->stride[0]);

        for (int x = 0; x < base->width; x++, code += 3, own += 3) {
            const int only = by_brightest ? brightest(own) : -1;

            for (int c = 0; c < 3; c++) {
                if (only < 0 || c == only) {
                    struct bin *const bin = &bins[own[c] / STEP];

                    bin->codes[code[c]]++;
                    bin->count++;
                    bin->halves += own[c];
                }
            }
        }
    }
}

/* The mean light of the middle half of a bin's codes: pixels beside a highlight, to which the
 * samples of a map that is smaller than the photo give a part of its gain, do not count. */
static double middle(const struct bin *bin)
{
    const double low = (double)bin->count / 4, high = 3 * low;
    double before = 0, sum = 0;

    for (int i = 0; i < 256; i++) {
        const double after = before + bin->codes[i];
        const double from = fmax(before, low), to = fmin(after, high);

        sum += to > from ? (to - from) * (double)rf_tone_light(i) : 0;
        before = after;
    }
    return sum / (high - low);
}

/* Make the light of knots grow: neighbours that do not are put together (pool adjacent violators).
 */
static int add_knot(struct knot *knots, int n, struct knot knot)
{
    while (n > 0 && knots[n - 1].light >= knot.light) {
        const struct knot *const last = &knots[--n];
        const double all = last->count + knot.count;

        knot.light = (last->light * last->count + knot.light * knot.count) / all;
        knot.half = (last->half * last->count + knot.half * knot.count) / all;
        knot.count = all;
    }
    knots[n] = knot;
    return n + 1;
}

/* Straight between knots, on from 0, and level behind the last. */
static void draw(struct rf_tone *tone, const struct knot *knots, int n)
{
    struct knot a = {0, 0, 0};
    int next = 0;

    for (int half = 0; half <= RF_HALF_MOST; half++) {
        while (next < n && knots[next].half <= half) {
            a = knots[next++];
        }
        tone->shown[half] =
            (float)(next < n ? a.light + (half - a.half) * (knots[next].light - a.light) /
                                             (knots[next].half - a.half)
                             : a.light);
    }
}

int rf_tone_fit(struct rf_tone *tone, const struct refocus_image *base,
                const struct refocus_image *light, bool by_brightest)
{
    struct bin *const bins = calloc(BINS, sizeof *bins);
    struct knot knots[BINS];
    int n = 0;

    if (!bins) {
        return REFOCUS_ERR_MEMORY;
    }
    count(bins, base, light, by_brightest);
    for (int i = 0; i < BINS; i++) {
        if (bins[i].count) {
            const double of = (double)bins[i].count;

            n = add_knot(knots, n, (struct knot){bins[i].halves / of, middle(&bins[i]), of});
        }
    }
    free(bins);
    tone->by_brightest = by_brightest;
    for (int i = 0; i < 256; i++) {
        tone->light[i] = rf_tone_light(i);
    }
    draw(tone, knots, n);
    for (int i = 0; i <= 4096; i++) {
        const double v = i / 4096.0 * (i / 4096.0);

        tone->code[i] =
            (float)(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055));
    }
    return REFOCUS_OK;
}

static void show(const struct rf_tone *tone, const uint16_t *light, float shown[3])
{
    const int most = light[brightest(light)];
    const float scale = most ? tone->shown[most] / rf_half_value((uint16_t)most) : 0;

    for (int c = 0; c < 3; c++) {
        shown[c] = tone->by_brightest ? scale * rf_half_value(light[c]) : tone->shown[light[c]];
    }
}

/* How far light is still the pixel's own: 1 where it is, 0 from a change by a quarter on. */
static float likeness(const uint16_t *own, const uint16_t *light)
{
    float most = 0;

    for (int c = 0; c < 3; c++) {
        const float a = rf_half_value(own[c]), b = rf_half_value(light[c]);
        const float change = fabsf(a - b) / (fmaxf(a, b) + 0.01f);

        most = change > most ? change : most;
    }
    return most < 0.25f ? 1 - 4 * most : 0;
}

static uint8_t code_of(const struct rf_tone *tone, float shown, int threshold)
{
    const float root = 4096 * sqrtf(shown > 0 ? shown < 1 ? shown : 1 : 0);
    const int i = root < 4095 ? (int)root : 4095;
    const float code = tone->code[i] + (root - (float)i) * (tone->code[i + 1] - tone->code[i]);
    const int rounded = (int)(code + ((float)threshold + 0.5f) / 64);

    return (uint8_t)(rounded < 255 ? rounded : 255);
}

/* Tones that were chosen place by place are not in the curve. A pixel keeps them as far as its
 * light is still its own: nothing shows where blur sets in. */
void rf_tone_encode(const struct rf_tone *tone, const struct rf_tone_row *row)
{
    for (int x = 0; x < row->width; x++) {
        const uint16_t *const own = row->own + 3 * x;
        const uint8_t *const base = row->base + 3 * x;
        uint8_t *const out = row->out + 3 * x;
        float shown[3], own_shown[3], like;
        uint16_t light[3];

        memcpy(light, row->light + 6 * (ptrdiff_t)x, sizeof light);
        if (memcmp(light, own, sizeof light) == 0) {
            memcpy(out, base, 3);
            continue;
        }
        for (int c = 0; c < 3; c++) {
            light[c] = light[c] > RF_HALF_MOST ? 0 : light[c]; /* negative light and NaN, too */
        }
        show(tone, light, shown);
        show(tone, own, own_shown);
        like = likeness(own, light);
        for (int c = 0; c < 3; c++) {
            out[c] = code_of(tone, shown[c] + like * (tone->light[base[c]] - own_shown[c]),
                             row->thresholds[(row->x + x) & 7]);
        }
    }
}
