/* twin_sweep.c: the sweep in double precision: rays, slab by slab. See src/gather/sweep.c. */
#include "twin_slabs.h"

enum { SETS = 4 };

/* Ray sets from the coarsest to the preset's own. */
struct sets {
    struct refocus_ray *ray[SETS + 1];
    int count[SETS + 1], sets;
};

static struct sets make_sets(const struct twin *t)
{
    static const int sizes[SETS] = {48, 64, 96, 128};
    struct sets sets = {{0}, {0}, 0};

    for (int i = 0; i < SETS && sizes[i] < t->params->render.rays; i++)
        sets.ray[sets.sets++] =
            twin_rays(t->params->render.aperture, sizes[i], t->K, &sets.count[i]);
    sets.ray[sets.sets] =
        twin_rays(t->params->render.aperture, t->params->render.rays, t->K, &sets.count[sets.sets]);
    sets.sets++;
    return sets;
}

static int set_for(const struct sets *sets, double reach)
{
    for (int i = 0; i < sets->sets - 1; i++)
        if (sets->count[i] >= 4.084 * reach * reach)
            return i;
    return sets->sets - 1;
}

/* Slab for which a strip's ray takes the background, or their number. */
static int deepest_of(const struct twin *t, const struct twin_cells *cells,
                      const struct twin_plan *plan, struct twin_strip strip, struct refocus_ray ray)
{
    int i = 0;

    while (i < plan->slabs) {
        const struct twin_slab *slab = &plan->slab[i];
        const int dx = (int)floor(ray.u / 32768.0 * slab->centre + 0.5);
        const int dy = (int)floor(ray.v / 32768.0 * slab->centre + 0.5);

        if (t->params->render.rays != REFOCUS_RAYS_FULL && t->params->render.rays <= 64 &&
            twin_is_deepest(t, cells, strip, dx, dy, slab->low, slab->high))
            break;
        i++;
    }
    return i;
}

static void trace(const struct twin *t, const struct twin_plan *plan, int deepest, int x, int y,
                  struct refocus_ray ray, double background_blur, struct twin_sum *sum)
{
    for (int i = 0; i < deepest; i++) {
        const int q = twin_hit(t, x, y, ray, plan->slab[i].centre);

        if (t->blur[q] >= plan->slab[i].low && t->blur[q] <= plan->slab[i].high) {
            twin_add(t, sum, t->smooth, q, ray.weight);
            return;
        }
    }
    if (deepest < plan->slabs)
        background_blur = plan->slab[deepest].centre;
    twin_add(t, sum, t->background, twin_hit(t, x, y, ray, background_blur), ray.weight);
}

/* Rows that are computed: see src/gather/tile_rows.h. */
struct rows {
    int count, at[TWIN_TILE];
};

/* Returns the least blur of all that is visible from a tile, pixels. */
static double least_blur(const struct twin_plan *plan, double background_blur)
{
    double least = fabs(background_blur);

    for (int i = 0; i < plan->slabs; i++) {
        const struct twin_slab *slab = &plan->slab[i];

        if (slab->centre == 0)
            return 0;
        least = fmin(least, slab->centre > 0 ? slab->least : -slab->most);
    }
    return least;
}

static struct rows rows_of(const struct twin *t, const struct sets *sets, double least)
{
    static const struct rows sparse[] = {
        {4, {0, 5, 10, 15}}, {6, {0, 3, 6, 9, 12, 15}}, {8, {0, 2, 4, 6, 9, 11, 13, 15}}};
    static const int step[] = {5, 3, 2};
    const int gap = (int)fmax(40 * sqrt(t->params->render.rays), 256);
    struct rows all = {TWIN_TILE, {0}};
    int tallest = 1; /* Q15 */

    for (int y = 0; y < TWIN_TILE; y++)
        all.at[y] = y;
    if (t->params->render.rays == REFOCUS_RAYS_FULL || t->params->render.rays > 64)
        return all;
    for (int n = 0; n < sets->count[sets->sets - 1]; n++)
        if (abs(sets->ray[sets->sets - 1][n].v) > tallest)
            tallest = abs(sets->ray[sets->sets - 1][n].v);
    for (int i = 0; i < 3; i++)
        /* whole numbers here, as flat things may lie on the bound */
        if ((int)(least * 256 + 0.5) / step[i] >= (gap << 15) / tallest)
            return sparse[i];
    return all;
}

/* 1 from where rays lie 5/4 of 1.5 pixels apart on, if nothing is as fine; 0 from 1.5 down. */
static double softness(const struct twin *t, const struct twin_plan *plan, double least)
{
    const double gap = sqrt(3.14159265358979 / t->params->render.rays);
    const double far_apart = 4 * (plan->reach * gap / 1.5 - 1), blurred = 4 * (least / 2.5 - 1);

    if (!t->params->render.prefilter || t->params->render.rays == REFOCUS_RAYS_FULL ||
        t->K * gap <= 1.5)
        return 0;
    return fmin(fmax(fmin(far_apart, blurred), 0), 1);
}

/* Lagrange's share of row k in the cubic through rows first to first + 3. */
static double share_of(const struct rows *rows, int first, int k, int y)
{
    double share = 1;

    for (int j = first; j < first + 4; j++)
        if (j != k)
            share *= (double)(y - rows->at[j]) / (rows->at[k] - rows->at[j]);
    return share;
}

/* The cubic through four rows, not beyond the rows before and after. */
static void between(const struct rows *rows, const struct twin_sum row[TWIN_TILE], int y,
                    struct twin_sum *sum)
{
    int first = 0, before = 0;

    while (first + 4 < rows->count && rows->at[first + 2] <= y)
        first++;
    while (before + 2 < rows->count && rows->at[before + 1] <= y)
        before++;
    sum->weight = 1;
    for (int c = 0; c < 3; c++) {
        const double a = row[before].light[c] / row[before].weight;
        const double b = row[before + 1].light[c] / row[before + 1].weight;
        double light = 0;

        for (int k = first; k < first + 4; k++)
            light += share_of(rows, first, k, y) * row[k].light[c] / row[k].weight;
        sum->light[c] = fmin(fmax(light, fmin(a, b)), fmax(a, b));
    }
}

/* sums[0], half moved to the average of those beside it, or a part of that. */
static struct twin_sum moved(const struct twin_sum *sums, ptrdiff_t beside, double part)
{
    struct twin_sum sum = {{0}, 1};

    for (int c = 0; c < 3; c++) {
        const double own = sums[0].light[c] / sums[0].weight;
        const double average = (sums[-beside].light[c] / sums[-beside].weight +
                                sums[beside].light[c] / sums[beside].weight) /
                               2;

        sum.light[c] = own + part / 2 * (average - own);
    }
    return sum;
}

/* Rows of a tile one after the other: across, and down if all rows are there. */
static void soften(struct twin_sum sums[TWIN_TILE * TWIN_TILE], int rows, double part)
{
    struct twin_sum own[TWIN_TILE * TWIN_TILE];

    memcpy(own, sums, sizeof own);
    for (int i = 0; i < rows * TWIN_TILE; i++)
        if (i % TWIN_TILE > 0 && i % TWIN_TILE < TWIN_TILE - 1)
            sums[i] = moved(own + i, 1, part);
    memcpy(own, sums, sizeof own);
    for (int i = TWIN_TILE; rows == TWIN_TILE && i < (TWIN_TILE - 1) * TWIN_TILE; i++)
        sums[i] = moved(own + i, TWIN_TILE, part);
}

static void sharp_tile(const struct twin *t, int tx, int ty, uint8_t *rgb)
{
    for (int y = ty * TWIN_TILE; y < (ty + 1) * TWIN_TILE && y < t->height; y++)
        for (int x = tx * TWIN_TILE; x < (tx + 1) * TWIN_TILE && x < t->width; x++) {
            struct twin_sum sum = {{0}, 0};

            twin_add(t, &sum, t->light, y * t->width + x, 1);
            twin_encode(t, &sum, rgb + 3 * (y * t->width + x));
        }
}

/* Rows first to end - 1 of those that are computed. */
static void sweep_strip(const struct twin *t, const struct twin_cells *cells,
                        const struct twin_plan *plan, const struct rows *rows, int first, int end,
                        struct twin_strip strip, const struct refocus_ray *ray, int rays,
                        double background_blur, struct twin_sum sums[TWIN_TILE * TWIN_TILE])
{
    const int y0 = strip.y / TWIN_TILE * TWIN_TILE;

    for (int n = 0; n < rays; n++) {
        const int deepest = deepest_of(t, cells, plan, strip, ray[n]);

        for (int i = first * TWIN_TILE; i < end * TWIN_TILE; i++)
            trace(t, plan, deepest, strip.x + i % TWIN_TILE, y0 + rows->at[i / TWIN_TILE], ray[n],
                  background_blur, &sums[i]);
    }
}

/* Sums of all pixels of a tile, for a blur of the hidden background. */
static void sweep_for(const struct twin *t, const struct twin_cells *cells,
                      const struct twin_plan *plan, const struct sets *sets, int x0, int y0,
                      double background_blur, struct twin_sum out[TWIN_TILE * TWIN_TILE])
{
    const int set = set_for(sets, plan->reach);
    const double least = least_blur(plan, background_blur);
    const struct rows rows = rows_of(t, sets, least);
    const int strips = rows.count < TWIN_TILE / 2 ? 1 : 2;
    struct twin_sum sums[TWIN_TILE * TWIN_TILE] = {{{0}, 0}};

    for (int i = 0; i < strips; i++)
        sweep_strip(t, cells, plan, &rows, i * rows.count / strips, (i + 1) * rows.count / strips,
                    (struct twin_strip){x0, y0 + i * TWIN_TILE / 2, TWIN_TILE / strips},
                    sets->ray[set], sets->count[set], background_blur, sums);
    soften(sums, rows.count, softness(t, plan, least));
    for (int i = 0; i < TWIN_TILE * TWIN_TILE; i++) {
        struct twin_sum column[TWIN_TILE];

        for (int k = 0; k < rows.count; k++)
            column[k] = sums[k * TWIN_TILE + i % TWIN_TILE];
        out[i] = sums[i];
        if (rows.count < TWIN_TILE)
            between(&rows, column, i / TWIN_TILE, &out[i]);
    }
}

/* The blur of the hidden background at a corner of tiles: the mean of the four around, without
 * those a quarter of the largest blur in front of the deepest. */
static double corner_blur(const struct twin *t, int x, int y)
{
    const int last_x = (t->width - 1) / TWIN_TILE, last_y = (t->height - 1) / TWIN_TILE;
    double blur[4], deepest, sum = 0;
    int count = 0;

    for (int k = 0; k < 4; k++) {
        const int tx = (int)fmin(fmax(x - 1 + k % 2, 0), last_x);
        const int ty = (int)fmin(fmax(y - 1 + k / 2, 0), last_y);

        blur[k] = t->background_blur[twin_at(t, tx * TWIN_TILE + TWIN_TILE / 2,
                                             ty * TWIN_TILE + TWIN_TILE / 2)];
    }
    /* GCC 12 for AArch64 fails to compile this as a loop. */
    deepest = fmax(fmax(blur[0], blur[1]), fmax(blur[2], blur[3]));
    for (int k = 0; k < 4; k++)
        if (deepest - blur[k] <= t->K / 4) {
            sum += blur[k];
            count++;
        }
    return sum / count;
}

/* Whether two blurs differ by more than a pixel and an eighth of the lesser. */
static bool differ(double a, double b)
{
    return fabs(a - b) > 1 + fmin(fabs(a), fabs(b)) / 8;
}

/* Adds the means of one corner with its weights, bilinear. */
static void add_corner(struct twin_sum *total, const struct twin_sum *sum, int corner)
{
    for (int i = 0; i < TWIN_TILE * TWIN_TILE; i++) {
        const double right = (i % TWIN_TILE + 0.5) / TWIN_TILE;
        const double below = (i / TWIN_TILE + 0.5) / TWIN_TILE;
        const double weight = (corner % 2 ? right : 1 - right) * (corner / 2 ? below : 1 - below);

        for (int c = 0; c < 3; c++)
            total[i].light[c] += weight * sum[i].light[c] / sum[i].weight;
        total[i].weight += weight;
    }
}

static void sweep_tile(const struct twin *t, const struct twin_cells *cells,
                       const struct twin_plan *plan, const struct sets *sets, int tx, int ty,
                       uint8_t *rgb)
{
    const int x0 = tx * TWIN_TILE, y0 = ty * TWIN_TILE;
    struct twin_sum sums[TWIN_TILE * TWIN_TILE], total[TWIN_TILE * TWIN_TILE] = {{{0}, 0}};
    bool across, down;
    double blur[4];

    for (int k = 0; k < 4; k++)
        blur[k] = corner_blur(t, tx + k % 2, ty + k / 2);
    across = differ(blur[0], blur[1]) || differ(blur[2], blur[3]);
    down = differ(blur[0], blur[2]) || differ(blur[1], blur[3]);
    for (int i = 0; i < 2 && !across; i++)
        blur[2 * i] = blur[2 * i + 1] = (blur[2 * i] + blur[2 * i + 1]) / 2;
    for (int i = 0; i < 2 && !down; i++)
        blur[i] = blur[i + 2] = (blur[i] + blur[i + 2]) / 2;
    if (!across && !down)
        sweep_for(t, cells, plan, sets, x0, y0, blur[0], total);
    for (int k = 0; k < 4 && (across || down); k++) {
        sweep_for(t, cells, plan, sets, x0, y0, blur[k], sums);
        add_corner(total, sums, k);
    }
    for (int y = 0; y < TWIN_TILE && y0 + y < t->height; y++)
        for (int x = 0; x < TWIN_TILE && x0 + x < t->width; x++)
            twin_encode(t, &total[y * TWIN_TILE + x], rgb + 3 * ((y0 + y) * t->width + x0 + x));
}

void twin_sweep(struct twin *t, uint8_t *rgb)
{
    const int across = (t->width + TWIN_TILE - 1) / TWIN_TILE;
    const int down = (t->height + TWIN_TILE - 1) / TWIN_TILE;
    struct sets sets = make_sets(t);
    struct twin_plan *plans;
    struct twin_cells cells;

    twin_prefilter(t);
    twin_background(t);
    plans = twin_plans(t, across, down);
    twin_cells(t, &cells);
    for (int i = 0; i < across * down; i++)
        if (plans[i].sharp)
            sharp_tile(t, i % across, i / across, rgb);
        else
            sweep_tile(t, &cells, &plans[i], &sets, i % across, i / across, rgb);
    for (int i = 0; i < sets.sets; i++)
        free(sets.ray[i]);
    free(plans);
    free(cells.cell);
}
