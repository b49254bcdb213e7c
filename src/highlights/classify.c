/* classify.c: tells clipped components that are highlights from those that are merely white, and
 * estimates the light that clipping cost them.
 *
 * Connected clipped pixels are a highlight when there are few of them, many times brighter than
 * what is around them, with a steep edge. Large clipped areas never are: a white wall is just
 * white. Each pixel gets, of each channel,
 *
 *     boost = (gain - 1) level isolation steepness hue
 *
 * whose factors are ramps from 0 to 1:
 *
 * level, from 0.94 to 1 of the channel's white: a channel that is not clipped lost nothing; nor did
 * a pixel with one clipped channel alone: hair, leaves, petals;
 *
 * isolation, from 2.5 to 3.75 of the mean luminance over that of all else up to 12 cells away, and
 * of the bright channel that stands out most: what is blue among blue is a petal;
 *
 * steepness, from 1.67 to 2.25 of the pixels of the edge over half lit ones beside them, those 2/5
 * of the way and more from what is 2 or 3 cells away to white, so that what a highlight lights
 * around it is not its edge; steepness() has the soft edges of large photos;
 *
 * and hue, a colour: what the pixels beside the highlight have more than those 2 or 3 cells away,
 * the brighter ones for more; of a core inside a glow that is clipped, the glow's.
 *
 * A highlight and what it lights may be connected, a flame and its candle, a tail light and its
 * glow: where a component has limbs, parts that are thinner than half of it, its body may be taken
 * alone, and where it has pixels with two clipped channels, these as its core (trim.c), whichever
 * makes more light. classify_cell.c has what is higher or wider than RF_COMPONENT_SIDE. Cells are
 * pixels, and squares of them in large photos (detect.c).
 *
 * The light acts on pixels that are blurred; the sharp ones stay as they are.
 */
#include "highlights/classify.h"

#include <stdlib.h>
#include <string.h>

enum {
    GAIN = 3,   /* a gain of 4 adds three times white */
    SMALL = 5,  /* halves of its surroundings that a component has to exceed */
    ALIKE = 16, /* colours of a run differ by at most that part of the light, in each channel */
};

static int64_t most_of(const int64_t colour[3])
{
    const int64_t most = colour[0] > colour[1] ? colour[0] : colour[1];

    return colour[2] > most ? colour[2] : most;
}

void rf_boost_of(const int64_t edge_light[3], int boost[3])
{
    const int64_t most = most_of(edge_light);

    for (int c = 0; c < 3; c++)
        boost[c] = GAIN * (int)(most < RF_LIGHT_MAX / 4 ? RF_LIGHT_MAX
                                : edge_light[c] < 0     ? 0
                                                        : edge_light[c] * RF_LIGHT_MAX / most);
}

/*
 * How steep the edge is, 0 to 256. A pixel that is lit in part by a highlight of L times white
 * still clips down to a share of 0.94 / L, and is half lit only from there to 0.4 / L: the
 * brighter, the fewer of the pixels beside the edge are half lit. At L = 1 it is 0.54 of those that
 * are lit in part, of which there are somewhat more than the edge has: never less than 0.6 of the
 * edge. White paint and glossy reflections fade out over many.
 *
 * Large photos are softer, pixel by pixel. An edge blurred by a Gaussian of s pixels goes from 0.94
 * to 0.4 over 1.8 s at L = 1, over 0.77 s at 2 and over 0.56 s at 4, and from 0.4 to 0.1 over
 * 1.0 s, 0.8 s and 0.7 s: however soft, the upper part is the longer one only of what is white.
 * What fades out over a cell and more is not soft, but shining; and between the strokes of a sign
 * there is no telling.
 */
static int steepness(const struct rf_cell_photo *p, const struct rf_measured *m)
{
    const int64_t edge = 100 * m->edge, upper = m->fade[0], lower = m->fade[1];
    const int64_t square = (int64_t)m->edge * m->edge; /* 10 times the pixels of a disc */
    const int sharp = rf_ramp(edge, 167 * m->half_lit, 225 * m->half_lit);
    int soft;

    if (4 * square < 10 * m->pixels) /* limbs on most sides */
        return 0;
    if (p->cell == 1)
        return sharp;
    soft = rf_ramp(edge * p->cell, 100 * upper, 160 * upper) *
           rf_ramp(100 * lower, 71 * upper, 91 * upper) / 256 *
           rf_ramp(40 * m->pixels - square, 0, 15 * m->pixels) / 256;
    return sharp > soft ? sharp : soft;
}

void rf_end_run(struct rf_detection *d)
{
    struct rf_highlight *run = &d->run;

    if (!run->count)
        return;
    for (int c = 0; c < 3; c++)
        run->boost[c] = (uint16_t)((d->lost[c] + run->count / 2) / run->count);
    rf_list_highlight(d->highlights, run);
    run->count = 0;
}

/* Whether two lights are of about one colour. */
static bool are_alike(const int a[3], const int b[3])
{
    const int of_a = a[0] + a[1] + a[2], of_b = b[0] + b[1] + b[2];

    for (int c = 0; c < 3; c++)
        if (ALIKE * llabs((long long)a[c] * of_b - (long long)b[c] * of_a) > (long long)of_a * of_b)
            return false;
    return true;
}

/* Whether a pixel is the next one of the run, of a highlight of the same colour. */
static bool goes_on(const struct rf_detection *d, int x, int y, const int full[3])
{
    const struct rf_highlight *run = &d->run;

    return run->count && run->count < RF_HIGHLIGHT_RUN && run->y == y && run->x + run->count == x &&
           are_alike(full, d->full);
}

static int second_brightest(const int colour[3])
{
    const struct rf_cell_photo core = {.core = true};

    return rf_level_of(&core, colour);
}

/* A channel that is not clipped has lost nothing; and where one channel alone is clipped there is a
 * colour, red hair or a petal, and no light. */
void rf_list_pixel(struct rf_detection *d, int x, int y, const struct rf_lost_light *light)
{
    int colour[3], full[3], lost[3];

    rf_colour_at(&d->photo, x, y, colour);
    if (second_brightest(colour) <= RF_CLIPPED)
        return;
    for (int c = 0; c < 3; c++) {
        full[c] = light->boost[c] * light->strength / 256;
        lost[c] = full[c] * rf_ramp(colour[c], RF_CLIPPED, RF_LIGHT_MAX) / 256;
    }
    if (!(lost[0] | lost[1] | lost[2]))
        return;
    if (!goes_on(d, x, y, full)) {
        rf_end_run(d);
        d->run = (struct rf_highlight){
            .x = (uint16_t)x,
            .y = (uint16_t)y,
            .size = (uint8_t)(light->size < UINT8_MAX ? light->size : UINT8_MAX)};
        memset(d->lost, 0, sizeof d->lost);
        memcpy(d->full, full, sizeof d->full);
    }
    d->run.count++;
    for (int c = 0; c < 3; c++)
        d->lost[c] += lost[c];
}

/* The part of a component that is a highlight; clipped as in `photo`. */
struct candidate {
    const struct rf_cell_photo *photo;
    struct rf_component part;
    struct rf_lost_light light;
};

/* Lists its pixels in row y of the photo. */
static void list_row(struct rf_detection *d, const struct candidate *candidate, int y)
{
    const struct rf_component *part = &candidate->part;
    const int cell = d->photo.cell;

    for (uint64_t row = part->row[y / cell - part->y]; row; row &= row - 1) {
        const int x = (part->x + __builtin_ctzll(row)) * cell;

        for (int i = 0; i < cell; i++)
            if (rf_is_clipped(candidate->photo, x + i, y))
                rf_list_pixel(d, x + i, y, &candidate->light);
    }
}

static int ramp_above(int64_t own, int64_t around, int halves)
{
    return rf_ramp(4 * own, 2 * halves * around, 3 * halves * around);
}

int rf_isolation(const struct rf_measured *m, int halves)
{
    const int all = ramp_above(rf_mean_luminance(m->own), rf_mean_luminance(m->around), halves);
    const int64_t bright = 7 * most_of(m->own) / 8;
    int most = 0;

    for (int c = 0; c < 3; c++)
        if (m->own[c] >= bright) {
            const int own = ramp_above(m->own[c], m->around[c], halves);

            most = own > most ? own : most;
        }
    return all < most ? all : most;
}

/* Classifies the body of a component. */
static struct rf_lost_light classify(const struct rf_cell_photo *p, const struct rf_component *body,
                                     const struct rf_component *component)
{
    struct rf_measured m = {0};
    struct rf_lost_light light = {.strength = 0};

    if (!rf_measure_colours(p, body, component, &m))
        return light;
    light.strength = rf_isolation(&m, SMALL);
    if (!light.strength)
        return light;
    rf_measure_edge(p, body, component, &m);
    light.strength = light.strength * steepness(p, &m) / 256;
    if (!light.strength)
        return light;
    if (p->core)
        rf_measure_glow(p, body, &m);
    rf_boost_of(m.edge_light, light.boost);
    light.pixels = m.pixels;
    light.size = 3 * m.pixels / m.edge; /* 5/6 of a disc's diameter, 3/2 of a stroke's width */
    return light;
}

/* Keeps what makes more light. */
static void prefer(struct candidate *best, const struct rf_cell_photo *p,
                   const struct rf_component *part, const struct rf_component *component)
{
    const struct rf_lost_light light = classify(p, part, component);

    if (light.strength * light.pixels > best->light.strength * best->light.pixels)
        *best = (struct candidate){p, *part, light};
}

/* The whole component may be one highlight, or some together, or a highlight with what it lights.
 */
void rf_classify_component(struct rf_detection *d, const struct rf_component *component)
{
    const struct rf_cell_photo *p = &d->photo;
    const int first = component->y * p->cell, end = (component->y + component->rows) * p->cell;
    struct rf_cell_photo cores = *p;
    struct rf_component part;
    struct candidate best = {.light = {.strength = 0}};

    cores.core = true;
    prefer(&best, p, component, component);
    if (best.light.strength < 256 && rf_trim_limbs(&part, component))
        prefer(&best, p, &part, component);
    if (best.light.strength < 256 && rf_trim_glow(&part, &cores, component))
        prefer(&best, &cores, &part, component);
    for (int y = first > d->y0 ? first : d->y0; best.light.strength && y < end && y < d->y1; y++)
        list_row(d, &best, y);
}
