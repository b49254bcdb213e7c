/* tone.c: light that was refocused is shown in the tones of the photo's base rendition.
 *
 * Programs and phones choose tones place by place: a bright sky and a bright wall of the same light
 * have other codes. So each cell of the photo has curves of its own, one for each channel, read
 * between the cells in proportion (a bilateral grid: Chen, Paris, Durand 2007).
 */
#include "tone.h"

#include <math.h>

enum { FULL = 0x43ff /* the last half before 4 */ };

float rf_tone_light(int code)
{
    const double v = code / 255.0;

    return (float)(v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
}

/* Where something lies among cells or knots: before which, and how far on to the next. */
struct place {
    int before, after;
    float part;
};

static struct place place_of(int at, int size, int cells)
{
    const float u = ((float)at + 0.5f) * (float)cells / (float)size - 0.5f;
    const int before = u > 0 ? (int)u : 0;

    return (struct place){before, before + 1 < cells ? before + 1 : before,
                          u > 0 ? u - (float)before : 0};
}

/* The curves of a row of pixels, read between those of two rows of cells. */
static void blend_curves(const struct rf_tone *tone, int y, struct rf_tone_curves *row)
{
    const struct place v = place_of(y, tone->height, tone->down);

    for (int x = 0; x < tone->across; x++) {
        const struct rf_tone_curves *a = &tone->curves[v.before * tone->across + x];
        const struct rf_tone_curves *b = &tone->curves[v.after * tone->across + x];

        for (int c = 0; c < rf_tone_channels(tone); c++) {
            for (int i = 0; i < RF_TONE_KNOTS; i++) {
                row[x].shown[c][i] = a->shown[c][i] + v.part * (b->shown[c][i] - a->shown[c][i]);
            }
        }
    }
}

static float read_curve(const float *shown, uint16_t light)
{
    const uint16_t half = rf_tone_saturated(light);
    const float part = (float)(half % RF_TONE_STEP) / RF_TONE_STEP;

    shown += half / RF_TONE_STEP;
    return shown[0] + part * (shown[1] - shown[0]);
}

static float shown_of(const struct rf_tone_curves *row, const struct place *u, int c, uint16_t half)
{
    const float a = read_curve(row[u->before].shown[c], half);
    const float b = read_curve(row[u->after].shown[c], half);

    return a + u->part * (b - a);
}

static void show(const struct rf_tone *tone, const struct rf_tone_curves *row,
                 const struct place *u, const uint16_t *light, float shown[3])
{
    float scale = 0;

    if (tone->by_brightest) {
        const uint16_t most = light[rf_tone_brightest(light)];

        scale = most ? shown_of(row, u, 0, most) / rf_half_value(most) : 0;
    }
    for (int c = 0; c < 3; c++) {
        shown[c] =
            tone->by_brightest ? scale * rf_half_value(light[c]) : shown_of(row, u, c, light[c]);
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

/* Light that was refocused saturates at 4 times white, wide areas that are brighter, too: these are
 * shown as bright as they are in the photo.
 *
 * Tones that were chosen pixel by pixel are not in the curves. A pixel keeps them as far as its
 * light is still its own: nothing shows where blur sets in. */
void rf_tone_encode(const struct rf_tone *tone, const struct rf_tone_row *row)
{
    struct rf_tone_curves curves[RF_TONE_CELLS];

    blend_curves(tone, row->y, curves);
    for (int x = 0; x < row->width; x++) {
        const uint16_t *const own = row->own + 3 * x;
        const uint8_t *const base = row->base + 3 * x;
        uint8_t *const out = row->out + 3 * x;
        const struct place u = place_of(row->x + x, tone->width, tone->across);
        float shown[3], own_shown[3], like;
        uint16_t light[3];

        memcpy(light, row->light + 6 * (ptrdiff_t)x, sizeof light);
        if (memcmp(light, own, sizeof light) == 0) {
            memcpy(out, base, 3);
            continue;
        }
        for (int c = 0; c < 3; c++) {
            light[c] = light[c] > RF_HALF_MOST ? 0 : light[c]; /* negative light and NaN, too */
            if (light[c] >= FULL && own[c] > light[c]) {
                light[c] = own[c];
            }
        }
        show(tone, curves, &u, light, shown);
        show(tone, curves, &u, own, own_shown);
        like = likeness(own, light);
        for (int c = 0; c < 3; c++) {
            out[c] = code_of(tone, shown[c] + like * (tone->light[base[c]] - own_shown[c]),
                             row->thresholds[(row->x + x) & 7]);
        }
    }
}
