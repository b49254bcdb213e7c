/* light_spread.c: spreads cells of light over circles of confusion, and sums up what frames have
 * there. */
#include "focus_stack/light.h"

#include <math.h>
#include <string.h>

enum {
    LANES = RF_LIGHT_LANES,
    BEHIND = 65536 / 16, /* a cell is nearer than another one from this difference on */
};

static void make_disc(struct rf_light_disc *disc, double radius)
{
    float sum = 0;

    disc->reach = (int)ceil(radius + 0.5) - 1;
    disc->reach = disc->reach > 0 ? disc->reach : 0;
    for (int j = -disc->reach; j <= disc->reach; j++)
        for (int i = -disc->reach; i <= disc->reach; i++) {
            const float inside = (float)(radius + 0.5 - sqrt((double)(i * i + j * j)));
            const float weight = inside < 0 ? 0 : inside < 1 ? inside : 1;

            disc->weight[j + RF_LIGHT_MOST + 1][i + RF_LIGHT_MOST + 1] = weight;
            sum += weight;
        }
    disc->square = sum * sum;
    for (int j = 0; j < RF_LIGHT_SIDE; j++)
        for (int i = 0; i < RF_LIGHT_SIDE; i++)
            disc->weight[j][i] /= sum;
}

static const struct rf_light_disc *disc_of(const struct rf_lights *l, size_t at)
{
    const int away = abs(l->disparity[at] - l->focus);
    const int radius = (int)(RF_LIGHT_FINE * l->radius * away / 65535 + 0.5);

    return &l->disc[radius < RF_LIGHT_RADII ? radius : RF_LIGHT_RADII - 1];
}

/* The part of a disc's rows or columns that is inside. */
struct range {
    int first, last;
};

static struct range range_of(int middle, int reach, int begin, int end)
{
    return (struct range){middle - reach < begin ? begin : middle - reach,
                          middle + reach >= end ? end - 1 : middle + reach};
}

/* Along rows half of the mark is set, then along columns all of it. */
void rf_light_mark_around(const struct rf_lights *l, int of, int mark)
{
    const int reach = (int)ceil(l->radius) + 1;

    for (int way = 0; way < 2; way++) {
        const size_t apart = way ? (size_t)l->columns : 1, line = way ? 1 : (size_t)l->columns;
        const int lines = way ? l->columns : l->rows, count = way ? l->rows : l->columns;
        const int from = way ? mark / 2 : of, set = way ? mark : mark / 2;

        for (int i = 0; i < lines; i++) {
            uint8_t *at = l->near + (size_t)i * line;
            int last = -1; /* the cell up to which the mark goes */

            for (int k = 0; k < reach && k < count; k++)
                last = at[(size_t)k * apart] & from ? k + reach : last;
            for (int k = 0; k < count; k++) {
                if (k + reach < count && at[(size_t)(k + reach) * apart] & from)
                    last = k + 2 * reach;
                at[(size_t)k * apart] |= (uint8_t)(k <= last ? set : 0);
            }
        }
    }
}

/* Adds a cell, spread over its disc, to rows from `begin` to before `end`. The number of planes is
 * known to the compiler. */
static inline void spread_cell(const struct rf_lights *l, int planes, int x, int y, int begin,
                               int end)
{
    const size_t at = rf_light_cell(l, x, y);
    const struct rf_light_disc *disc = disc_of(l, at);
    const struct range down = range_of(y, disc->reach, begin, end);
    const struct range across = range_of(x, disc->reach, 0, l->columns);
    const int nearer = l->disparity[at] + BEHIND;
    float value[2][LANES];

    for (int i = 0; i < planes; i++)
        memcpy(value[i], l->from[i] + LANES * at, sizeof value[i]);
    for (int v = down.first; v <= down.last; v++) {
        const float *weight = disc->weight[v - y + RF_LIGHT_MOST + 1];
        const size_t row = rf_light_cell(l, 0, v);
        const uint16_t *disparity = l->disparity + row;
        float *const out[2] = {l->to[0] + LANES * row, l->to[planes - 1] + LANES * row};

        for (int u = across.first; u <= across.last; u++) {
            const float w = disparity[u] < nearer ? weight[u - x + RF_LIGHT_MOST + 1] : 0;

            for (int i = 0; i < planes; i++)
                for (int c = 0; c < LANES; c++)
                    out[i][LANES * u + c] += w * value[i][c];
        }
    }
}

/* Rows of A_k of what is to be spread. */
static inline void spread_rows(const struct rf_lights *l, int planes, int band)
{
    const int begin = band * RF_LIGHT_BAND,
              end = begin + RF_LIGHT_BAND < l->rows ? begin + RF_LIGHT_BAND : l->rows;
    const struct range rows = range_of(begin, RF_LIGHT_MOST + 1, 0, l->rows);

    for (int i = 0; i < planes; i++)
        memset(l->to[i] + LANES * rf_light_cell(l, 0, begin), 0,
               LANES * sizeof(float) * (size_t)(end - begin) * (size_t)l->columns);
    for (int y = rows.first; y < end + RF_LIGHT_MOST + 1 && y < l->rows; y++)
        for (int x = 0; x < l->columns; x++)
            if (l->near[rf_light_cell(l, x, y)] & l->sources)
                spread_cell(l, planes, x, y, begin, end);
}

static void spread_band(void *context, int band, int worker)
{
    (void)worker;
    spread_rows(context, 1, band);
}

static void spread_both_band(void *context, int band, int worker)
{
    (void)worker;
    spread_rows(context, 2, band);
}

void rf_light_spread(struct rf_lights *l, int sources, const float *from, float *to)
{
    l->from[0] = from;
    l->sources = sources;
    l->to[0] = to;
    rf_pool_run(l->stack->pool, spread_band, l, (l->rows + RF_LIGHT_BAND - 1) / RF_LIGHT_BAND);
}

void rf_light_spread_excess(struct rf_lights *l, const float *excess)
{
    l->from[0] = excess;
    l->from[1] = l->clipped;
    l->sources = RF_LIGHT_WHITE;
    l->to[0] = l->spread;
    l->to[1] = l->ones;
    rf_pool_run(l->stack->pool, spread_both_band, l, (l->rows + RF_LIGHT_BAND - 1) / RF_LIGHT_BAND);
}

/* Adds A_k' of `spread` and of `ones` to `change` and `norm`, where something is clipped. */
static void gather_row(void *context, int y, int worker)
{
    const struct rf_lights *l = context;

    (void)worker;
    for (int x = 0; x < l->columns; x++) {
        const size_t at = rf_light_cell(l, x, y);
        const struct rf_light_disc *disc = disc_of(l, at);
        const struct range down = range_of(y, disc->reach, 0, l->rows);
        const struct range across = range_of(x, disc->reach, 0, l->columns);
        const int nearer = l->disparity[at] + BEHIND;
        float sum[LANES] = {0}, norm[LANES] = {0};

        if (!(l->near[at] & RF_LIGHT_WHITE))
            continue;
        for (int v = down.first; v <= down.last; v++) {
            const float *weight = disc->weight[v - y + RF_LIGHT_MOST + 1];
            const uint16_t *disparity = l->disparity + rf_light_cell(l, 0, v);
            const float *in = l->spread + LANES * rf_light_cell(l, 0, v);
            const float *ones = l->ones + LANES * rf_light_cell(l, 0, v);

            for (int u = across.first; u <= across.last; u++) {
                const float w = disparity[u] < nearer ? weight[u - x + RF_LIGHT_MOST + 1] : 0;

                for (int c = 0; c < LANES; c++) {
                    sum[c] += w * in[LANES * u + c];
                    norm[c] += w * ones[LANES * u + c];
                }
            }
        }
        for (int c = 0; c < LANES; c++) {
            const float weight = disc->square * l->clipped[LANES * at + c];

            l->change[LANES * at + c] += weight * sum[c];
            l->norm[LANES * at + c] += weight * norm[c];
        }
    }
}

void rf_light_gather(struct rf_lights *l)
{
    rf_pool_run(l->stack->pool, gather_row, l, l->rows);
}

void rf_light_make_discs(struct rf_lights *l)
{
    for (int i = 0; i < RF_LIGHT_RADII; i++)
        make_disc(&l->disc[i], (double)i / RF_LIGHT_FINE);
}
