/* scatter.c: spreads every sample over its circle of confusion, Potmesil & Chakravarty 1981.
 *
 * The picture is a grid of samples. Each spreads its light over its circle of confusion by an
 * intensity distribution whose integral is 1: lookup tables for equally spaced blur radii
 * (spread.c), the two nearest interpolated. Four sums a pixel hold numerator and denominator
 * of eq. 20; the picture is their quotient. The distribution is attenuated by 1 / z^2, where
 * 1 / z = (1 + d (z1/z0 - 1)) / z1.
 *
 * A star filter spreads part of the light again along spikes. It is applied to the four
 * sums, so that it is one more factor of each sample's distribution.
 *
 * Visibility is ignored: a blurred background washes over a sharp foreground.
 */
#include "papers/papers.h"
#include "papers/scatter.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    BAND = 16,
    AT_ONCE = 32, /* pixels between two looks for a cancelled run */
    MOST_SPIKES = 16,
};

struct work {
    /* The tables, and the settings that they are for: */
    uint64_t tag;
    double radius, airy_radius;
    uint32_t spread;
    int tables;
    struct rf_spread_table *table;
    uint32_t *shares;
    uint32_t *attenuation; /* 1 / z^2 for d >> 8, in Q12 of the nearest plane's */
    uint64_t *sum[4];      /* numerators R, G, B and the denominator; row after row */
    /* The frame: */
    struct rf_frame *f;
    int spike_count, spike_length;
    double spike_x[MOST_SPIKES], spike_y[MOST_SPIKES];
};

/* Lays out the memory of the arena; without any it fills *counted and only counts the bytes. */
static struct work *lay_out(const struct rf_limits *limits, struct rf_arena *arena,
                            struct work *counted)
{
    const int tables = rf_spread_tables(limits->max_blur_radius);
    struct work *work = rf_arena_take(arena, 1, sizeof *work);
    uint64_t shares = 0;

    if (!work)
        work = counted;
    for (int i = 0; i < tables; i++) {
        const uint64_t reach = (uint64_t)rf_spread_reach(limits->max_blur_radius, i);

        shares += (2 * reach + 1) * (reach + 1);
    }
    work->table = rf_arena_take(arena, (uint64_t)tables, sizeof *work->table);
    work->shares = rf_arena_take(arena, shares, sizeof *work->shares);
    work->attenuation = rf_arena_take(arena, 256, sizeof *work->attenuation);
    for (int i = 0; i < 4; i++)
        work->sum[i] = rf_arena_take(arena, (uint64_t)limits->width * (uint64_t)limits->height,
                                     sizeof(uint64_t));
    return work;
}

static uint64_t work_bytes(const struct rf_limits *limits)
{
    struct rf_arena arena = {NULL, 0};
    struct work counted;

    lay_out(limits, &arena, &counted);
    return arena.used;
}

static void fill_table(void *context, int item, int worker)
{
    struct work *work = context;

    (void)worker;
    /* The largest tables come first, as they take longest. */
    rf_spread_fill(&work->table[work->tables - 1 - item], work->spread, work->airy_radius,
                   work->f->exec->run);
}

/* Makes the tables for this K, unless they are there already. */
static bool make_tables(struct work *work, struct rf_frame *f)
{
    const struct rf_settings *p = f->params;
    uint32_t *share = work->shares;

    if (f->work->owner == REFOCUS_METHOD_SCATTER && work->tables &&
        work->radius == p->max_blur_radius && work->spread == p->spread &&
        (p->spread == REFOCUS_SPREAD_UNIFORM || work->airy_radius == p->airy_radius))
        return true;
    f->work->owner = RF_NO_METHOD;
    work->radius = p->max_blur_radius;
    work->spread = p->spread;
    work->airy_radius = p->airy_radius;
    work->tables = rf_spread_tables(work->radius);
    for (int i = 0; i < work->tables; i++) {
        struct rf_spread_table *table = &work->table[i];

        table->radius = work->radius * i / (work->tables - 1);
        table->reach = rf_spread_reach(work->radius, i);
        table->share = share;
        share += (2 * table->reach + 1) * (table->reach + 1);
    }
    rf_pool_run(f->exec->pool, fill_table, work, work->tables);
    if (rf_cancelled(f->exec))
        return false;
    f->work->owner = REFOCUS_METHOD_SCATTER;
    return true;
}

/* Makes the table of 1 / z^2 for disparities d = i / 255, relative to the nearest plane:
 * ((1 + d (ratio - 1)) / ratio)^2. */
static void make_attenuation(struct work *work, double ratio)
{
    for (int i = 0; i < 256; i++) {
        const double inverse = (1 + i / 255.0 * (ratio - 1)) / ratio;
        const double q12 = inverse * inverse * 4096 + 0.5;

        work->attenuation[i] = q12 < 1 ? 1 : (uint32_t)q12;
    }
}

/* The weight of the sample at (x, y): eq. 5 times 1 / z^2, at most 2^16. */
static uint32_t weight_of(const struct work *work, int x, int y)
{
    const struct rf_frame *f = work->f;
    const uint32_t w = rf_weight_of(f, y * f->view->stride + x);
    const uint32_t z = work->attenuation[f->disparity.at[y * f->view->stride + x] >> 8];

    if (!f->weighted)
        return z;
    return (w * z >> 12) + !(w * z >> 12);
}

/* Adds a row of the circle of a sample to a row of sums. */
static_assert((uint64_t)RF_SPREAD_ONE * 128 <= UINT32_MAX, "a share between two in Q7");
static_assert((uint64_t)RF_WEIGHT_MAX * RF_LIGHT_MAX <= UINT32_MAX, "light times weight");
static void add_row(struct work *work, const uint32_t *restrict a, const uint32_t *restrict b,
                    uint32_t t, int count, size_t at, const uint32_t value[4])
{
    uint64_t *restrict s0 = work->sum[0] + at, *restrict s1 = work->sum[1] + at;
    uint64_t *restrict s2 = work->sum[2] + at, *restrict s3 = work->sum[3] + at;

    for (int i = 0; i < count; i++) {
        const uint64_t share = (a[i] * (128 - t) + b[i] * t) >> 7;

        s0[i] += share * value[0];
        s1[i] += share * value[1];
        s2[i] += share * value[2];
        s3[i] += share * value[3];
    }
}

/* Spreads the sample at (x, y) over rows y0 .. y1 - 1. */
static void spread_sample(struct work *work, int x, int y, int y0, int y1)
{
    const ptrdiff_t q = y * work->f->view->stride + x;
    const int blur = work->f->blur.at[q] < 0 ? -work->f->blur.at[q] : work->f->blur.at[q];
    const uint32_t w = weight_of(work, x, y);
    const uint32_t value[4] = {w * work->f->light.channel[0][q], w * work->f->light.channel[1][q],
                               w * work->f->light.channel[2][q], w};
    /* The place among the tables is Q7. */
    const int largest = work->radius * 256 < 1 ? 1 : (int)(work->radius * 256 + 0.5);
    const int place = (int)((int64_t)blur * (work->tables - 1) * 128 / largest);
    const int i = place >> 7 < work->tables - 1 ? place >> 7 : work->tables - 2;
    const struct rf_spread_table *a = &work->table[blur < 128 ? 0 : i], *b = a + 1;
    const uint32_t t = blur < 128 ? 0 : place - i * 128 > 128 ? 128 : (uint32_t)(place - i * 128);
    const int reach = blur < 128 ? 0 : a->reach;
    const int x0 = x - reach < 0 ? 0 : x - reach;
    const int x1 = x + reach >= work->f->view->width ? work->f->view->width : x + reach + 1;

    for (int row = y - reach < y0 ? y0 : y - reach; row < y1 && row <= y + reach; row++) {
        const int dy = row < y ? y - row : row - y;

        add_row(work, a->share + dy * (2 * a->reach + 1) + a->reach + x0 - x,
                b->share + dy * (2 * b->reach + 1) + b->reach + x0 - x, t, x1 - x0,
                (size_t)row * (size_t)work->f->view->width + (size_t)x0, value);
    }
}

/* Spreads all samples over a band of rows. Sums are whole numbers and a band belongs to one thread,
 * so their order does not matter. */
static void spread_band(void *context, int item, int worker)
{
    struct work *work = context;
    const int y0 = item * BAND,
              y1 = y0 + BAND < work->f->view->height ? y0 + BAND : work->f->view->height;
    const int reach = work->table[work->tables - 1].reach;

    (void)worker;
    for (int i = 0; i < 4; i++)
        memset(work->sum[i] + (size_t)y0 * (size_t)work->f->view->width, 0,
               sizeof(uint64_t) * (size_t)(y1 - y0) * (size_t)work->f->view->width);
    for (int y = y0 - reach < 0 ? 0 : y0 - reach; y < y1 + reach && y < work->f->view->height; y++)
        for (int x = 0; x < work->f->view->width; x++) {
            if (x % AT_ONCE == 0 && rf_cancelled(work->f->exec))
                return;
            spread_sample(work, x, y, y0, y1);
        }
}

/* Makes the spikes of the star, whose strength falls linearly to their end. */
static void make_star(struct work *work)
{
    const struct rf_settings *p = work->f->params;

    work->spike_count = p->star_spikes;
    work->spike_length = (int)p->star_length;
    if (work->spike_length == 0 || p->star_strength <= 0)
        work->spike_count = 0;
    for (int i = 0; i < work->spike_count; i++) {
        double s, c;

        rf_sincos_turns(p->star_angle / 360.0 + (double)i / work->spike_count, &s, &c);
        work->spike_x[i] = c;
        work->spike_y[i] = -s; /* y down */
    }
}

static void add_sums(const struct work *work, int x, int y, double weight, double sum[4])
{
    const int cx = x < 0 ? 0 : x >= work->f->view->width ? work->f->view->width - 1 : x;
    const int cy = y < 0 ? 0 : y >= work->f->view->height ? work->f->view->height - 1 : y;

    for (int i = 0; i < 4; i++)
        sum[i] +=
            weight * (double)work->sum[i][(size_t)cy * (size_t)work->f->view->width + (size_t)cx];
}

/* Writes a pixel with the light that the spikes of other pixels bring to (x, y). */
static void write_star(const struct work *work, int x, int y)
{
    const double strength = work->f->params->star_strength;
    const int n = work->spike_length;
    const double each = strength / work->spike_count / (n * (n + 1) / 2.0);
    double sum[4] = {0, 0, 0, 0};

    add_sums(work, x, y, 1 - strength, sum);
    for (int i = 0; i < work->spike_count; i++)
        for (int k = 1; k <= n; k++)
            add_sums(work, x - (int)floor(work->spike_x[i] * k + 0.5),
                     y - (int)floor(work->spike_y[i] * k + 0.5), each * (n + 1 - k), sum);
    if (sum[3] > 0)
        rf_write_real(work->f, x, y, sum, sum[3]);
    else
        rf_copy_tile(work->f, (struct rf_rect){x, y, x + 1, y + 1});
}

static void write_row(void *context, int item, int worker)
{
    const struct work *work = context;
    const struct rf_frame *f = work->f;
    const int y = f->region.y0 + item;

    (void)worker;
    for (int x = f->region.x0; x < f->region.x1; x++) {
        const size_t at = (size_t)y * (size_t)f->view->width + (size_t)x;
        const uint64_t light[3] = {work->sum[0][at], work->sum[1][at], work->sum[2][at]};

        if (x % AT_ONCE == 0 && rf_cancelled(f->exec))
            return;
        if (work->spike_count)
            write_star(work, x, y);
        else
            rf_write_mean(f, x, y, light, work->sum[3][at]);
    }
}

static void render_frame(struct rf_frame *f)
{
    const struct rf_limits limits = f->limits;
    struct rf_arena arena = {f->work->at, 0};
    struct work *work = lay_out(&limits, &arena, NULL);

    work->f = f;
    if (!make_tables(work, f))
        return;
    make_attenuation(work, f->params->depth_ratio);
    make_star(work);
    rf_pool_run(f->exec->pool, spread_band, work, (f->view->height + BAND - 1) / BAND);
    rf_pool_run(f->exec->pool, write_row, work, f->region.y1 - f->region.y0);
}

const struct rf_method rf_scatter_method = {.frame = render_frame, .work_bytes = work_bytes};
