/* tone.c: light that was refocused is shown in the tones of the photo's base rendition.
 *
 * Programs and phones choose tones place by place: a bright sky and a bright wall of the same light
 * have other codes. So each cell of the photo has curves of its own, one for each channel, read
 * between the cells in proportion (a bilateral grid: Chen, Paris, Durand 2007).
 */
#include "tone.h"

#include <math.h>

/* Times white: light that was refocused saturates at FULL, and is near that from NEARLY on. */
static const float NEARLY = 3, FULL = 4;

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

static float read_curve(const float *shown, uint16_t light)
{
    const uint16_t half = rf_tone_saturated(light);
    const float part = (float)(half % RF_TONE_STEP) / RF_TONE_STEP;

    shown += half / RF_TONE_STEP;
    return shown[0] + part * (shown[1] - shown[0]);
}

static float between(float a, float b, float part)
{
    return a + part * (b - a);
}

/* The place of a pixel between four cells. */
struct cells {
    const struct rf_tone_curves *above, *below; /* rows of them */
    struct place u, v;
};

static float shown_of(const struct cells *at, int c, uint16_t half)
{
    const int left = at->u.before, right = at->u.after;

    return between(between(read_curve(at->above[left].shown[c], half),
                           read_curve(at->above[right].shown[c], half), at->u.part),
                   between(read_curve(at->below[left].shown[c], half),
                           read_curve(at->below[right].shown[c], half), at->u.part),
                   at->v.part);
}

static void show(const struct rf_tone *tone, int x, int y, const uint16_t *light, float shown[3])
{
    const struct place v = place_of(y, tone->height, tone->down);
    const struct cells at = {&tone->curves[v.before * tone->across],
                             &tone->curves[v.after * tone->across],
                             place_of(x, tone->width, tone->across), v};
    float scale = 0;

    if (tone->by_brightest) {
        const uint16_t most = light[rf_tone_brightest(light)];

        scale = most ? shown_of(&at, 0, most) / rf_half_value(most) : 0;
    }
    for (int c = 0; c < 3; c++) {
        shown[c] =
            tone->by_brightest ? scale * rf_half_value(light[c]) : shown_of(&at, c, light[c]);
    }
}

static const uint16_t *own_at(const struct rf_tone_part *part, int x, int y)
{
    const struct refocus_image *own = part->own;

    return (const uint16_t *)(const void *)(own->plane[0] + (part->y + y) * own->stride[0]) +
           3 * (ptrdiff_t)(part->x + x);
}

static const uint8_t *base_at(const struct rf_tone_part *part, int x, int y)
{
    return part->base->plane[0] + (part->y + y) * part->base->stride[0] +
           3 * (ptrdiff_t)(part->x + x);
}

/* Light that was refocused may be at any address. */
static void read_light(const struct rf_tone_part *part, int x, int y, uint16_t light[3])
{
    memcpy(light, part->light->plane[0] + y * part->light->stride[0] + 6 * (ptrdiff_t)x, 6);
}

/* By which part of it light is not the pixel's own, in the channel where it is the most. */
static float change_of(const uint16_t *own, const uint16_t *light)
{
    float most = 0;

    for (int c = 0; c < 3; c++) {
        const float a = rf_half_value(own[c]), b = rf_half_value(light[c]);

        most = fmaxf(most, fabsf(a - b) / (fmaxf(a, b) + 0.01f));
    }
    return most;
}

static uint8_t code_of(const struct rf_tone *tone, float shown, int threshold)
{
    const float root = 4096 * sqrtf(shown > 0 ? shown < 1 ? shown : 1 : 0);
    const int i = root < 4095 ? (int)root : 4095;
    const float code = tone->code[i] + (root - (float)i) * (tone->code[i + 1] - tone->code[i]);
    const int rounded = (int)(code + ((float)threshold + 0.5f) / 64);

    return (uint8_t)(rounded < 255 ? rounded : 255);
}

/* The pixels that are worked on at once. Changes are averaged over 5 x 5 pixels, what is kept over
 * 17 x 17 of them, of which every second one is looked at, each way. */
enum { WIDE = 64, HIGH = 32 };
enum { NEAR = 2, STRIDE = WIDE + 2 * NEAR, ROWS = HIGH + 2 * NEAR };
enum { FAR = 4, COARSE_STRIDE = WIDE / 2 + 1 + 2 * FAR, COARSE_ROWS = HIGH / 2 + 1 + 2 * FAR };

struct patch {
    int odd_x, odd_y; /* 1: its first pixel is an odd one of the photo; even ones are looked at */
    float change[ROWS * STRIDE];
    float kept[3][COARSE_ROWS * COARSE_STRIDE]; /* see local_of() */
};

static int clamp(int value, int most)
{
    return value < 0 ? 0 : value > most ? most : value;
}

/* Light that a pixel is shown with beyond the curves. */
static void local_of(const struct rf_tone *tone, const struct rf_tone_part *part, int x, int y,
                     float local[3])
{
    const uint8_t *const base = base_at(part, x, y);
    float shown[3];

    show(tone, part->x + x, part->y + y, own_at(part, x, y), shown);
    for (int c = 0; c < 3; c++)
        local[c] = tone->light[base[c]] - shown[c];
}

static float change_at(const struct rf_tone_part *part, int x, int y)
{
    uint16_t light[3];

    read_light(part, x, y, light);
    return change_of(own_at(part, x, y), light);
}

/* Reads the pixels of a part around those from (x0, y0) on; beyond the part those at its sides. */
static void read_patch(const struct rf_tone *tone, const struct rf_tone_part *part, int x0, int y0,
                       struct patch *patch)
{
    const int right = part->light->width - 1, bottom = part->light->height - 1;

    patch->odd_x = (part->x + x0) & 1;
    patch->odd_y = (part->y + y0) & 1;
    for (int i = 0; i < ROWS * STRIDE; i++) {
        patch->change[i] = change_at(part, clamp(x0 + i % STRIDE - NEAR, right),
                                     clamp(y0 + i / STRIDE - NEAR, bottom));
    }
    for (int i = 0; i < COARSE_ROWS * COARSE_STRIDE; i++) {
        const int x = clamp(x0 - patch->odd_x + 2 * (i % COARSE_STRIDE - FAR), right);
        const int y = clamp(y0 - patch->odd_y + 2 * (i / COARSE_STRIDE - FAR), bottom);
        const float like = fmaxf(1 - 4 * change_at(part, x, y), 0);
        float local[3] = {0, 0, 0};

        if (like > 0)
            local_of(tone, part, x, y, local);
        for (int c = 0; c < 3; c++)
            patch->kept[c][i] = like * local[c];
    }
}

/* Makes values means of those around, up to `reach` away, from the first on: the mean around (x, y)
 * comes to where the first of them was. */
static void average(float *values, int stride, int rows, int reach)
{
    const int side = 2 * reach + 1;

    for (int i = 0; i < rows * stride - 2 * reach; i++)
        for (int k = 1; k < side; k++)
            values[i] += values[i + k];
    for (int i = 0; i < (rows - 2 * reach) * stride; i++) {
        for (int k = 1; k < side; k++)
            values[i] += values[i + k * stride];
        values[i] /= (float)(side * side);
    }
}

/* The mean that a pixel takes, between the pixels that were looked at. */
static float kept_at(const struct patch *patch, int x, int y, int c)
{
    const int u = x + patch->odd_x, v = y + patch->odd_y;
    const float *const above = patch->kept[c] + v / 2 * COARSE_STRIDE;
    const float *const below = patch->kept[c] + (v + 1) / 2 * COARSE_STRIDE;

    return (above[u / 2] + above[(u + 1) / 2] + below[u / 2] + below[(u + 1) / 2]) / 4;
}

/* Light that a pixel is shown with beyond the curves: its own by a part `own`, else what pixels
 * around keep, but no more than a quarter of what it is shown with: a dark pixel beside a bright
 * line would have its haze. */
struct beyond {
    float own, local[3], kept[3];
};
enum { MOST_KEPT = 4 };

/* The mean light of the photo around a pixel, between blocks. */
static float mean_around(const struct rf_tone *tone, int x, int y, int c)
{
    const struct place u = place_of(x, tone->width, tone->blocks_across);
    const struct place v = place_of(y, tone->height, tone->blocks_down);
    const float(*above)[3] = tone->mean + v.before * tone->blocks_across;
    const float(*below)[3] = tone->mean + v.after * tone->blocks_across;

    return between(between(above[u.before][c], above[u.after][c], u.part),
                   between(below[u.before][c], below[u.after][c], u.part), v.part);
}

/* Light that was refocused saturates, wide areas that are brighter, too: these are shown as bright
 * as the photo is around. */
static uint16_t beyond_full(const struct rf_tone *tone, int x, int y, int c, uint16_t half)
{
    const float light = rf_half_value(half), more = mean_around(tone, x, y, c) - light;
    const float part = fminf((light - NEARLY) / (FULL - NEARLY), 1);

    return more > 0 ? rf_half_of(light + part * more) : half;
}

static void show_pixel(const struct rf_tone *tone, const struct rf_tone_part *part, int x, int y,
                       const struct beyond *beyond)
{
    const uint16_t *const own = own_at(part, x, y);
    uint8_t *const out = part->out->plane[0] + y * part->out->stride[0] + 3 * (ptrdiff_t)x;
    float shown[3];
    uint16_t light[3];

    read_light(part, x, y, light);
    if (memcmp(light, own, sizeof light) == 0) {
        memcpy(out, base_at(part, x, y), 3);
        return;
    }
    for (int c = 0; c < 3; c++) {
        light[c] = light[c] > RF_HALF_MOST ? 0 : light[c]; /* negative light and NaN, too */
        if (rf_half_value(light[c]) > NEARLY)
            light[c] = beyond_full(tone, part->x + x, part->y + y, c, light[c]);
    }
    show(tone, part->x + x, part->y + y, light, shown);
    for (int c = 0; c < 3; c++) {
        const float most = shown[c] / MOST_KEPT;
        const float kept = fmaxf(-most, fminf(beyond->kept[c], most));

        out[c] = code_of(tone, shown[c] + between(kept, beyond->local[c], beyond->own),
                         part->thresholds[((part->y + y) & 7) * 8 + ((part->x + x) & 7)]);
    }
}

/* Tones that were chosen pixel by pixel are not in the curves. What a pixel is shown with beyond
 * them, it keeps where its light and that around it is its own, so that nothing shows where blur
 * sets in; where it is nearly that, it takes the mean of what pixels around keep: light that is
 * blurred is a pixel's own by chance along lines, at edges and in clouds, which must not show, nor
 * must what is coarse in the gain map. */
static void show_patch(const struct rf_tone *tone, const struct rf_tone_part *part, int x0, int y0)
{
    struct patch patch;

    read_patch(tone, part, x0, y0, &patch);
    for (int c = 0; c < 3; c++)
        average(patch.kept[c], COARSE_STRIDE, COARSE_ROWS, FAR);
    average(patch.change, STRIDE, ROWS, NEAR);
    for (int y = 0; y < HIGH && y0 + y < part->light->height; y++) {
        for (int x = 0; x < WIDE && x0 + x < part->light->width; x++) {
            struct beyond beyond = {.own = fmaxf(1 - 16 * patch.change[y * STRIDE + x], 0)};

            if (beyond.own > 0)
                local_of(tone, part, x0 + x, y0 + y, beyond.local);
            for (int c = 0; c < 3; c++)
                beyond.kept[c] = kept_at(&patch, x, y, c);
            show_pixel(tone, part, x0 + x, y0 + y, &beyond);
        }
    }
}

void rf_tone_encode(const struct rf_tone *tone, const struct rf_tone_part *part)
{
    for (int y = 0; y < part->light->height; y += HIGH)
        for (int x = 0; x < part->light->width; x += WIDE)
            show_patch(tone, part, x, y);
}
