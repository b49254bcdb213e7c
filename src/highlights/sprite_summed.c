/* sprite_summed.c: draws sprites of apertures that are not evenly open, by their summed light. */
#include "highlights/sprite.h"

#include <math.h>

#include "aperture/aperture.h"
#include "kernels/kernels.h"
#include "support/compare.h"

/* How places of the tile become cells of the aperture: a pixel sees, of a run that is `away` from
 * it, what the cells let through from `cells away + middle` on. */
struct scale {
    double across, down, middle; /* cells a pixel, signed */
};

static struct scale scale_of(const struct rf_splat *splat, const struct rf_splat_run *run)
{
    const struct refocus_aperture *a = splat->aperture;
    const double side = a->summed->side;
    const double each = side * 128 / (run->blur < 0 ? -run->radius : run->radius);

    return (struct scale){each / a->squeeze_x, each / a->squeeze_y, side / 2};
}

static double clamp(double v, double most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* The rows of the aperture, in cells, that row y of the tile sees rows of a run through. */
struct rows {
    double from, to;
};

static struct rows rows_of(const struct scale *scale, const struct rf_splat_run *run, int y)
{
    const double middle = y - run->middle * 0.5, half = run->rows * 0.5;
    const double a = (middle - half) * scale->down + scale->middle;
    const double b = (middle + half) * scale->down + scale->middle;
    const double most = 2 * scale->middle;

    return a < b ? (struct rows){clamp(a, most), clamp(b, most)}
                 : (struct rows){clamp(b, most), clamp(a, most)};
}

void rf_sprite_set_extent(struct rf_sprite *sprite, const struct rf_splat *splat,
                          const struct rf_splat_run *run)
{
    const struct scale scale = scale_of(splat, run);
    const double unit = (RF_SPLAT_UNIT >> sprite->job.unit) / scale.across;

    for (int y = 0; y < RF_TILE; y++) {
        const struct rows rows = rows_of(&scale, run, y);
        int first = splat->aperture->summed->side, end = 0;
        double a, b;

        for (int row = (int)rows.from; row < rows.to; row++)
            if (sprite->summed->end[row]) {
                first = rf_smaller(first, sprite->summed->first[row]);
                end = rf_larger(end, sprite->summed->end[row]);
            }
        if (first >= end)
            first = end = (int)scale.middle;
        a = (scale.middle - first) * unit;
        b = (scale.middle - end) * unit;
        sprite->job.left[y] = first == end ? 0 : (int16_t)floor(a < b ? a : b);
        sprite->job.right[y] = first == end ? 0 : (int16_t)ceil(a < b ? b : a);
    }
}

/* A strip of the aperture: the sums above its upper and lower end, in the rows of cells there, and
 * how far down in them the ends are. */
struct strip {
    const uint32_t *top[2], *bottom[2];
    double top_part, bottom_part;
};

static struct strip strip_of(const struct rf_summed_side *sums, struct rows rows, int side)
{
    const int top = rf_smaller((int)rows.from, side - 1);
    const int bottom = rf_smaller((int)rows.to, side - 1);

    return (struct strip){{sums->before[top], sums->before[top + 1]},
                          {sums->before[bottom], sums->before[bottom + 1]},
                          rows.from - top,
                          rows.to - bottom};
}

/* The light of a strip in the cells before x. */
static double sum_at(const struct strip *s, int x)
{
    const int whole = (int)(s->bottom[0][x] - s->top[0][x]);
    const int top = (int)(s->top[1][x] - s->top[0][x]);
    const int bottom = (int)(s->bottom[1][x] - s->bottom[0][x]);

    return whole + (s->bottom_part * bottom - s->top_part * top);
}

static double light_before(const struct strip *strip, double x, int side)
{
    const int cell = x <= 0 ? 0 : x >= side ? side - 1 : (int)x;
    const double part = clamp(x - cell, 1), left = sum_at(strip, cell);

    return left + part * (sum_at(strip, cell + 1) - left);
}

/* The pixels of row y that see some of a run, first to end - 1. */
static void find_pixels(const struct rf_disc_job *job, int y, int *first, int *end)
{
    const int pixel = RF_SPLAT_UNIT >> job->unit;

    *first = 0;
    *end = RF_TILE;
    while (*first < RF_TILE && pixel * *first + job->right[y] <= job->from)
        ++*first;
    while (*end > *first && pixel * (*end - 1) + job->left[y] >= job->to)
        --*end;
}

/* The light of each pixel from `first` to `end` - 1 of a row that sees the run, between its ends.
 * Where the run is some whole pixels long, it ends for one pixel where it begins for another. */
static void lights_of(double light[RF_TILE], const struct strip *strip, const struct scale *scale,
                      int side, const struct rf_splat_run *run, int first, int end)
{
    const double from = run->from * (1.0 / RF_SPLAT_UNIT), to = run->to * (1.0 / RF_SPLAT_UNIT);
    const int length = (run->to - run->from) / RF_SPLAT_UNIT;
    double before[RF_TILE + RF_HIGHLIGHT_RUN];

    if (length > RF_TILE || length * RF_SPLAT_UNIT != run->to - run->from) {
        for (int x = first; x < end; x++)
            light[x] = fabs(light_before(strip, (x - from) * scale->across + scale->middle, side) -
                            light_before(strip, (x - to) * scale->across + scale->middle, side));
        return;
    }
    for (int x = first; x < end + length; x++)
        before[x] = light_before(strip, (x - to) * scale->across + scale->middle, side);
    for (int x = first; x < end; x++)
        light[x] = fabs(before[x + length] - before[x]);
}

/* Adds its share of a run to pixel i of a tile. */
static void add_light(uint16_t *const mean[3], const struct rf_sprite *sprite, int i, double share)
{
    const struct rf_disc_job *const job = &sprite->job;

    if (job->visible)
        share *= ((job->visible[i] & 1) + (job->visible[RF_TILE * RF_TILE + i] & 1)) * 0.5;
    for (int p = 0; p < job->planes; p++) {
        const double sum = mean[p][i] + (int)(sprite->whole[p] * share + 0.5);

        mean[p][i] = (uint16_t)(sum < UINT16_MAX ? sum : UINT16_MAX);
    }
}

void rf_sprite_draw_summed(uint16_t *const mean[3], const struct rf_sprite *sprite,
                           const struct rf_splat *splat, const struct rf_splat_run *run)
{
    const struct scale scale = scale_of(splat, run);
    const int side = splat->aperture->summed->side;
    const double each = RF_SPLAT_UNIT / ((double)sprite->summed->before[side][side] *
                                         (run->to - run->from) * run->rows);

    for (int y = sprite->job.first; y < sprite->job.end; y++) {
        const struct rows rows = rows_of(&scale, run, y);
        const struct strip strip = strip_of(sprite->summed, rows, side);
        double light[RF_TILE];
        int first, end;

        find_pixels(&sprite->job, y, &first, &end);
        lights_of(light, &strip, &scale, side, run, first, end);
        for (int x = first; x < end; x++)
            add_light(mean, sprite, y * RF_TILE + x, light[x] * each);
    }
}
