/* tone_fit.c: the curves from true light to that of a base rendition are measured in the photo
 * itself, where both are known.
 *
 * Where a cell of the photo has few pixels of a light, those of the four cells around count, of the
 * sixteen, and so on up to the whole photo.
 */
#include "tone.h"

#include <math.h>
#include <stdlib.h>

#include <refocus/status.h>

enum {
    MOST_LEVELS = 5,   /* cells, two by two of them, ... the photo */
    COUNTED = 1 << 21, /* pixels that are looked at, or so */
    FEW = 100,         /* one pixel in so many of a cell is as much as what is around counts */
};

#define WHITE 0.97f /* Noise and JPEG leave what clips above this. */

/* Sums over the pixels of a cell with the light of a knot, or nearly so: their number, their true
 * light and that of the base rendition. */
struct knot {
    float count, light;
    union {
        float base;  /* a sum; then */
        float shown; /* the curve of the cell */
    };
};

struct level {
    int across, down;
    struct knot *knots; /* curves of a cell, of its channels, one after the other */
};

/* The curve of a channel in a cell. */
static struct knot *curve_of(const struct rf_tone *tone, const struct level *level, int cx, int cy,
                             int c)
{
    const int curve = (cy * level->across + cx) * rf_tone_channels(tone) + c;

    return level->knots + (ptrdiff_t)curve * RF_TONE_KNOTS;
}

static void count_sample(struct knot *curve, uint16_t half, float base)
{
    const int below = half / RF_TONE_STEP;
    const float part = (float)(half % RF_TONE_STEP) / RF_TONE_STEP, light = rf_half_value(half);

    for (int i = 0; i < 2; i++) {
        struct knot *const knot = curve + below + i;
        const float own = i ? part : 1 - part;

        knot->count += own;
        knot->light += own * light;
        knot->base += own * base;
    }
}

static void count(const struct rf_tone *tone, const struct level *level,
                  const struct refocus_image *base, const struct refocus_image *light)
{
    const double pixels = (double)base->width * base->height;
    const int step = (int)ceil(sqrt(pixels / COUNTED));

    for (int y = step / 2; y < base->height; y += step) {
        const int cy = (int)((int64_t)y * level->down / base->height);
        const uint8_t *codes = base->plane[0] + y * base->stride[0];
        const uint16_t *row =
            (const uint16_t *)(const void *)(light->plane[0] + y * light->stride[0]);

        for (int x = step / 2; x < base->width; x += step) {
            const int cx = (int)((int64_t)x * level->across / base->width);
            const uint16_t *own = row + 3 * (ptrdiff_t)x;
            const uint8_t *code = codes + 3 * (ptrdiff_t)x;

            if (tone->by_brightest) {
                const int c = rf_tone_brightest(own);

                count_sample(curve_of(tone, level, cx, cy, 0), rf_tone_saturated(own[c]),
                             tone->light[code[c]]);
                continue;
            }
            for (int c = 0; c < 3; c++) {
                count_sample(curve_of(tone, level, cx, cy, c), rf_tone_saturated(own[c]),
                             tone->light[code[c]]);
            }
        }
    }
}

/* The mean light of the pixels of a block, or of some of them. */
static void measure_block(const struct rf_tone *tone, const struct refocus_image *light, int bx,
                          int by, float mean[3])
{
    const double pixels = (double)light->width * light->height;
    const int step = (int)ceil(sqrt(pixels / COUNTED));
    const int x0 = (int)((int64_t)bx * light->width / tone->blocks_across);
    const int x1 = (int)((int64_t)(bx + 1) * light->width / tone->blocks_across);
    const int y0 = (int)((int64_t)by * light->height / tone->blocks_down);
    const int y1 = (int)((int64_t)(by + 1) * light->height / tone->blocks_down);
    int count = 0;

    mean[0] = mean[1] = mean[2] = 0;
    for (int y = y0; y < y1; y += step) {
        const uint16_t *row =
            (const uint16_t *)(const void *)(light->plane[0] + y * light->stride[0]);

        for (int x = x0; x < x1; x += step, count++)
            for (int c = 0; c < 3; c++)
                mean[c] += rf_half_value(row[3 * (ptrdiff_t)x + c]);
    }
    for (int c = 0; c < 3; c++)
        mean[c] /= (float)count;
}

/* The sums of a level are those of four cells of the finer one. */
static void add_up(const struct rf_tone *tone, const struct level *fine, const struct level *coarse)
{
    for (int y = 0; y < fine->down; y++) {
        for (int x = 0; x < fine->across; x++) {
            const struct knot *from = curve_of(tone, fine, x, y, 0);
            struct knot *to = curve_of(tone, coarse, x / 2, y / 2, 0);

            for (int i = 0; i < rf_tone_channels(tone) * RF_TONE_KNOTS; i++) {
                to[i].count += from[i].count;
                to[i].light += from[i].light;
                to[i].base += from[i].base;
            }
        }
    }
}

static bool is_white(const struct knot *knot)
{
    return knot->base > WHITE * knot->count;
}

/* Light of the base rendition at a knot: the mean of its pixels, brought in proportion from their
 * mean light to that of the knot. Where the photo clips, the curve does not go on like that: it
 * comes up to white on the line through the knot below, and is level from there: a knot whose
 * pixels have more light than it has is on that line. `below` has the sums of the knot below, or
 * none. */
static float shown_at(const struct knot *below, const struct knot *own, int i)
{
    const float light = rf_half_value((uint16_t)(i * RF_TONE_STEP));
    const float mean = own->base / own->count;
    const bool has_more = own->light > light * own->count;

    if (is_white(own) && !has_more)
        return mean;
    if ((is_white(own) || (i + 1 < RF_TONE_KNOTS && is_white(own + 1))) && has_more &&
        below->light > 0)
        return fminf(below->base * light / below->light, mean);
    return i && own->light > 0 ? own->base * light / own->light : mean;
}

/* The whole photo's curve: straight between the knots that have pixels, on from 0, and level behind
 * the last. */
static void draw_whole(struct knot *curve)
{
    struct knot below = {0}, own;
    int last = -1;

    for (int i = 0; i < RF_TONE_KNOTS; i++, below = own) {
        own = curve[i];
        if (own.count <= 0)
            continue;
        curve[i].shown = shown_at(&below, &curve[i], i);
        for (int k = last + 1; k < i; k++) {
            const int from = last < 0 ? 0 : last;
            const float before = last < 0 ? 0 : curve[last].shown;

            curve[k].shown =
                before + (curve[i].shown - before) * (float)(k - from) / (float)(i - from);
        }
        last = i;
    }
    for (int k = last + 1; k < RF_TONE_KNOTS; k++)
        curve[k].shown = last < 0 ? 0 : curve[last].shown;
}

static void draw(struct knot *curve, const struct knot *around)
{
    struct knot below = {0}, knot;
    float pixels = 0;

    for (int i = 0; i < RF_TONE_KNOTS; i++)
        pixels += curve[i].count;
    for (int i = 0; i < RF_TONE_KNOTS; i++, below = knot) {
        const float own = curve[i].count, other = pixels / FEW + 1e-3f;

        knot = curve[i];
        curve[i].shown =
            ((own > 0 ? own * shown_at(&below, &curve[i], i) : 0) + other * around[i].shown) /
            (own + other);
    }
}

/* Makes a curve grow: neighbours that do not become their mean (pool adjacent violators). */
static void make_grow(const struct knot *curve, float *shown)
{
    struct {
        float sum, count;
        int end;
    } pool[RF_TONE_KNOTS];
    int n = 0;

    for (int i = 0; i < RF_TONE_KNOTS; i++) {
        const float count = curve[i].count + 1e-3f;

        pool[n].sum = curve[i].shown * count;
        pool[n].count = count;
        pool[n++].end = i + 1;
        while (n > 1 &&
               pool[n - 2].sum * pool[n - 1].count >= pool[n - 1].sum * pool[n - 2].count) {
            n--;
            pool[n - 1].sum += pool[n].sum;
            pool[n - 1].count += pool[n].count;
            pool[n - 1].end = pool[n].end;
        }
    }
    for (int i = 0, k = 0; k < n; k++)
        for (; i < pool[k].end; i++)
            shown[i] = pool[k].sum / pool[k].count;
}

static void draw_level(const struct rf_tone *tone, const struct level *level,
                       const struct level *coarse)
{
    for (int y = 0; y < level->down; y++) {
        for (int x = 0; x < level->across; x++) {
            for (int c = 0; c < rf_tone_channels(tone); c++) {
                struct knot *const curve = curve_of(tone, level, x, y, c);

                if (coarse)
                    draw(curve, curve_of(tone, coarse, x / 2, y / 2, c));
                else
                    draw_whole(curve);
            }
        }
    }
}

static void set_curves(struct rf_tone *tone, const struct level *cells)
{
    for (int y = 0; y < cells->down; y++) {
        for (int x = 0; x < cells->across; x++) {
            for (int c = 0; c < rf_tone_channels(tone); c++) {
                make_grow(curve_of(tone, cells, x, y, c),
                          tone->curves[y * tone->across + x].shown[c]);
            }
        }
    }
}

static void set_tables(struct rf_tone *tone)
{
    for (int i = 0; i < 256; i++)
        tone->light[i] = rf_tone_light(i);
    for (int i = 0; i <= 4096; i++) {
        const double v = i / 4096.0 * (i / 4096.0);

        tone->code[i] =
            (float)(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055));
    }
}

static int cells_along(int side, int longer, int most)
{
    const int cells = (int)(((int64_t)side * most + longer / 2) / longer);

    return cells > 1 ? cells < side ? cells : side : 1;
}

/* Sets the sizes of levels down to one cell, and lays them out in `knots`, or counts these where it
 * is NULL. */
static size_t lay_out(const struct rf_tone *tone, struct level *level, int *levels,
                      struct knot *knots)
{
    int across = tone->across, down = tone->down;
    size_t all = 0;

    for (*levels = 0; *levels < MOST_LEVELS; across = (across + 1) / 2, down = (down + 1) / 2) {
        level[(*levels)++] = (struct level){across, down, knots ? knots + all : NULL};
        all += (size_t)across * (size_t)down * (size_t)rf_tone_channels(tone) * RF_TONE_KNOTS;
        if (across == 1 && down == 1)
            break;
    }
    return all;
}

int rf_tone_fit(struct rf_tone *tone, const struct refocus_image *base,
                const struct refocus_image *light, bool by_brightest)
{
    const int longer = base->width > base->height ? base->width : base->height;
    struct level level[MOST_LEVELS];
    struct knot *knots;
    int levels;

    tone->by_brightest = by_brightest;
    tone->width = base->width;
    tone->height = base->height;
    tone->across = cells_along(base->width, longer, RF_TONE_CELLS);
    tone->down = cells_along(base->height, longer, RF_TONE_CELLS);
    tone->blocks_across = cells_along(base->width, longer, RF_TONE_BLOCKS);
    tone->blocks_down = cells_along(base->height, longer, RF_TONE_BLOCKS);
    knots = calloc(lay_out(tone, level, &levels, NULL), sizeof *knots);
    if (!knots)
        return REFOCUS_ERR_MEMORY;
    lay_out(tone, level, &levels, knots);
    set_tables(tone);
    for (int i = 0; i < tone->blocks_across * tone->blocks_down; i++)
        measure_block(tone, light, i % tone->blocks_across, i / tone->blocks_across, tone->mean[i]);
    count(tone, &level[0], base, light);
    for (int i = 1; i < levels; i++)
        add_up(tone, &level[i - 1], &level[i]);
    for (int i = levels - 1; i >= 0; i--)
        draw_level(tone, &level[i], i + 1 < levels ? &level[i + 1] : NULL);
    set_curves(tone, &level[0]);
    free(knots);
    return REFOCUS_OK;
}
