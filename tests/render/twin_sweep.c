/* twin_sweep.c: the sweep in double precision: which blurs reach a tile, slabs over them, rays.
 * See src/tiles/tiles.h and src/gather/sweep.c. */
#include "twin.h"

enum { BINS = 256, FOCUS_BIN = 127, SETS = 6 };
static const double overlap = 0.125;

/* Blurs of a tile: which bins are occupied, and the extremes. Bin i begins at
 * (i - 127) width - 1/2. */
struct bins {
    bool has[BINS];
    double least, most;
};

struct slab {
    double low, high, centre; /* hit if low <= s <= high */
    double least, most;       /* extremes of the blurs that the slab is for */
};

struct plan {
    int slabs;
    struct slab slab[BINS];
    double reach;
    bool sharp;
};

/* Returns the width of a bin, by the largest blur; 0: they are a pixel wide up to 31.5 pixels of
 * blur, then a sixteenth of the octave. */
static double bin_width(const struct twin *t)
{
    const double largest = t->K * fmax(t->df, 1 - t->df);

    return t->unit > 1 ? 0 : largest <= 31.5 ? 0.25 : largest <= 63.5 ? 0.5 : 1;
}

/* Whole pixels to bins, and back to the least of a bin. */
static int place_of(int p)
{
    const int octave = p < 32 ? 0 : (int)floor(log2(p / 16.0));

    return 16 * octave + (p >> octave);
}

static int pixels_of(int place)
{
    const int octave = place < 32 ? 0 : place / 16 - 1;

    return (place - 16 * octave) << octave;
}

static int bin_of(double width, double s)
{
    const int p = (int)floor(s + 0.5);

    if (width <= 0)
        return FOCUS_BIN + (p < 0 ? -place_of(-p) : place_of(p));
    return (int)floor((s + 0.5) / width) + FOCUS_BIN;
}

static double edge_of(double width, int bin)
{
    const int place = bin - FOCUS_BIN;

    if (width <= 0)
        return (place < 0 ? 1 - pixels_of(1 - place) : pixels_of(place)) - 0.5;
    return (bin - FOCUS_BIN) * width - 0.5;
}

static void note(struct bins *bins, double width, double s)
{
    bins->has[bin_of(width, s)] = true;
    bins->least = fmin(bins->least, s);
    bins->most = fmax(bins->most, s);
}

static struct bins bins_of_tile(const struct twin *t, double width, int tx, int ty)
{
    struct bins bins = {{false}, 1e9, -1e9};

    for (int y = ty * TWIN_TILE; y < (ty + 1) * TWIN_TILE && y < t->height; y++) {
        for (int x = tx * TWIN_TILE; x < (tx + 1) * TWIN_TILE && x < t->width; x++) {
            note(&bins, width, t->map_blur[y * t->width + x]); /* silhouettes as they were, too */
            note(&bins, width, t->blur[y * t->width + x]);
        }
    }
    return bins;
}

/* Leave out the bins that lie below a blur of s pixels as a whole. */
static void drop_short(struct bins *bins, double width, double s)
{
    const int first = bin_of(width, -s) + 1, end = bin_of(width, s);
    const double low = edge_of(width, first), high = edge_of(width, end);

    for (int i = first; i < end; i++)
        bins->has[i] = false;
    if (bins->least >= low && bins->least < high)
        bins->least = high;
    if (bins->most >= low && bins->most < high)
        bins->most = low;
}

/* The blurs that can be hit from tile (tx, ty): those of a tile g pixels away that are g - 1
 * pixels or more. */
static struct bins reach_of_tile(const struct twin *t, const struct bins *tiles, int across,
                                 int down, double width, int tx, int ty)
{
    struct bins reach = {{false}, 1e9, -1e9};

    (void)t;
    for (int y = 0; y < down; y++) {
        for (int x = 0; x < across; x++) {
            const int dx = abs(x - tx), dy = abs(y - ty);
            const double gap =
                ceil(hypot(dx ? (dx - 1) * TWIN_TILE + 1 : 0, dy ? (dy - 1) * TWIN_TILE + 1 : 0));
            struct bins bins = tiles[y * across + x];

            if (gap > ceil(t->K) + 1)
                continue;
            if (gap > 1)
                drop_short(&bins, width, gap - 1);
            for (int i = 0; i < BINS; i++)
                reach.has[i] |= bins.has[i];
            reach.least = fmin(reach.least, bins.least);
            reach.most = fmax(reach.most, bins.most);
        }
    }
    return reach;
}

static void add(struct bins *reach, const struct bins *bins)
{
    if (bins->least > bins->most)
        return;
    for (int i = 0; i < BINS; i++)
        reach->has[i] |= bins->has[i];
    reach->least = fmin(reach->least, bins->least);
    reach->most = fmax(reach->most, bins->most);
}

/* Whole tiles between one and those from `from` to from + count - 1. */
static int between_tiles(int tile, int from, int count)
{
    const int n = tile < from ? from - tile : tile - from - count + 1;

    return n > 1 ? n - 1 : 0;
}

/* Blurs of large units are collected from blocks of 4 x 4 tiles, but where these are less than four
 * tiles away from single ones; by whole tiles in between. */
static struct bins reach_from_blocks(const struct bins *tiles, int across, int down, int tx, int ty)
{
    enum { BLOCK = 4 };
    struct bins reach = {{false}, 1e9, -1e9};

    for (int y = 0; y < down; y += BLOCK)
        for (int x = 0; x < across; x += BLOCK) {
            const int dx = between_tiles(tx, x, BLOCK), dy = between_tiles(ty, y, BLOCK);
            const bool near = dx < BLOCK && dy < BLOCK;
            struct bins block = {{false}, 1e9, -1e9};

            for (int i = 0; i < BLOCK * BLOCK; i++) {
                const int u = x + i % BLOCK, v = y + i / BLOCK;
                struct bins bins;

                if (u >= across || v >= down)
                    continue;
                bins = tiles[v * across + u];
                if (near)
                    drop_short(&bins, 0,
                               floor(hypot(between_tiles(tx, u, 1), between_tiles(ty, v, 1))) *
                                       TWIN_TILE -
                                   1);
                add(&block, &bins);
            }
            if (!near)
                drop_short(&block, 0, floor(hypot(dx, dy)) * TWIN_TILE - 1);
            add(&reach, &block);
        }
    return reach;
}

/* A slab over bins [bin, last], nothing of it in focus. */
static struct slab slab_over(const struct bins *bins, double width, int bin, int last)
{
    struct slab slab = {fmax(edge_of(width, bin), bins->least),
                        fmin(edge_of(width, last + 1), bins->most), 0, 0, 0};

    slab.centre = (slab.low + slab.high) / 2;
    slab.least = slab.low;
    slab.most = slab.high;
    return slab;
}

/* Where a slab of blurs of large units ends: at that edge of a bin which is nearest to an eighth of
 * the blur, less a pixel. */
static int end_of_units(int bin)
{
    const double low = edge_of(0, bin), until = low + fabs(low) / 8 - 1;
    int end = bin_of(0, until);

    if (2 * until > edge_of(0, end) + edge_of(0, end + 1))
        end++;
    return end > bin ? end : bin + 1;
}

/* Where a slab ends that begins with that bin. */
static int end_of(int bin, double width)
{
    const int pixel = width > 0 ? (int)(1 / width) : 1;
    const double low = edge_of(width, bin);
    int end = bin + pixel;

    if (bin >= FOCUS_BIN && bin < FOCUS_BIN + pixel)
        return FOCUS_BIN + pixel;
    if (pixel > 1 && low > -3 && low < 3)
        end = bin + pixel / 2;
    if (width <= 0)
        end = end_of_units(bin);
    else if (fabs(low) >= 16)
        end = bin + (int)floor(pixel * (fabs(low) / 8 - 1));
    return bin < FOCUS_BIN && end > FOCUS_BIN ? FOCUS_BIN : end;
}

/* Slabs a pixel wide from the near side on, half as wide below 3 pixels of blur, an eighth of the
 * blur less a pixel from 16 on, where they end as those do that cover all bins; one for all that is
 * in focus. */
static struct plan cover(const struct bins *bins, double width)
{
    const int pixel = width > 0 ? (int)(1 / width) : 1;
    struct plan plan = {.sharp = true};

    for (int bin = 0; bin < BINS;) {
        int end, last = bin, cell = 0;
        struct slab slab;
        double wide;

        if (!bins->has[bin]) {
            bin++;
            continue;
        }
        if (bin >= FOCUS_BIN && bin < FOCUS_BIN + pixel) {
            plan.slab[plan.slabs++] = (struct slab){-0.5 - 2 * overlap, nextafter(0.5, 0), 0, 0, 0};
            bin = FOCUS_BIN + pixel;
            continue;
        }
        while ((end = end_of(cell, width)) <= bin)
            cell = end;
        if (width > 0 && fabs(edge_of(width, bin)) < 16)
            end = end_of(bin, width);
        for (int i = bin; i < end && i < BINS; i++)
            last = bins->has[i] ? i : last;
        slab = slab_over(bins, width, bin, last);
        plan.sharp = false;
        plan.reach = fmax(plan.reach, fmax(-slab.low, slab.high));
        wide = fmax(overlap, (slab.high - slab.low) / 8);
        slab.low -= wide;
        slab.high += wide;
        if (slab.centre < 0 && slab.high >= -0.5)
            slab.high = nextafter(-0.5, -1);
        if (slab.centre > 0 && slab.low < 0.5)
            slab.low = 0.5 - 2 * overlap;
        plan.slab[plan.slabs++] = slab;
        bin = last + 1;
    }
    return plan;
}

/* Ray sets from the coarsest to the preset's own. */
struct sets {
    struct refocus_ray *ray[SETS + 1];
    int count[SETS + 1], sets;
};

static struct sets make_sets(const struct twin *t)
{
    static const int sizes[SETS] = {24, 32, 48, 64, 96, 128};
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
static int deepest_of(const struct twin *t, const struct twin_cells *cells, const struct plan *plan,
                      struct twin_strip strip, struct refocus_ray ray)
{
    int i = 0;

    while (i < plan->slabs) {
        const struct slab *slab = &plan->slab[i];
        const int dx = (int)floor(ray.u / 32768.0 * slab->centre + 0.5);
        const int dy = (int)floor(ray.v / 32768.0 * slab->centre + 0.5);

        if (t->params->render.rays != REFOCUS_RAYS_FULL && t->params->render.rays <= 64 &&
            twin_is_deepest(t, cells, strip, dx, dy, slab->low, slab->high))
            break;
        i++;
    }
    return i;
}

static void trace(const struct twin *t, const struct plan *plan, int deepest, int x, int y,
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
static double least_blur(const struct plan *plan, double background_blur)
{
    double least = fabs(background_blur);

    for (int i = 0; i < plan->slabs; i++) {
        const struct slab *slab = &plan->slab[i];

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
static double softness(const struct twin *t, const struct plan *plan, double least)
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
                        const struct plan *plan, const struct rows *rows, int first, int end,
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

static void sweep_tile(const struct twin *t, const struct twin_cells *cells,
                       const struct plan *plan, const struct sets *sets, int tx, int ty,
                       uint8_t *rgb)
{
    const int x0 = tx * TWIN_TILE, y0 = ty * TWIN_TILE, set = set_for(sets, plan->reach);
    const double background_blur =
        t->background_blur[twin_at(t, x0 + TWIN_TILE / 2, y0 + TWIN_TILE / 2)];
    const double least = least_blur(plan, background_blur);
    const struct rows rows = rows_of(t, sets, least);
    const int strips = rows.count < TWIN_TILE / 2 ? 1 : 2;
    struct twin_sum sums[TWIN_TILE * TWIN_TILE] = {{{0}, 0}};

    for (int i = 0; i < strips; i++)
        sweep_strip(t, cells, plan, &rows, i * rows.count / strips, (i + 1) * rows.count / strips,
                    (struct twin_strip){x0, y0 + i * TWIN_TILE / 2, TWIN_TILE / strips},
                    sets->ray[set], sets->count[set], background_blur, sums);
    soften(sums, rows.count, softness(t, plan, least));
    for (int y = 0; y < TWIN_TILE && y0 + y < t->height; y++) {
        for (int x = 0; x < TWIN_TILE && x0 + x < t->width; x++) {
            struct twin_sum column[TWIN_TILE], own = sums[y * TWIN_TILE + x];

            for (int k = 0; k < rows.count; k++)
                column[k] = sums[k * TWIN_TILE + x];
            if (rows.count < TWIN_TILE)
                between(&rows, column, y, &own);
            twin_encode(t, &own, rgb + 3 * ((y0 + y) * t->width + x0 + x));
        }
    }
}

void twin_sweep(struct twin *t, uint8_t *rgb)
{
    const int across = (t->width + TWIN_TILE - 1) / TWIN_TILE;
    const int down = (t->height + TWIN_TILE - 1) / TWIN_TILE;
    const double width = bin_width(t);
    struct bins *tiles = calloc((size_t)(across * down), sizeof *tiles);
    struct sets sets = make_sets(t);
    struct twin_cells cells;

    assert_non_null(tiles);
    twin_prefilter(t);
    twin_background(t);
    twin_cells(t, &cells);
    for (int i = 0; i < across * down; i++)
        tiles[i] = bins_of_tile(t, width, i % across, i / across);
    for (int i = 0; i < across * down; i++) {
        const struct bins reach =
            t->unit > 1 ? reach_from_blocks(tiles, across, down, i % across, i / across)
                        : reach_of_tile(t, tiles, across, down, width, i % across, i / across);
        const struct plan plan = cover(&reach, width);

        if (plan.sharp)
            sharp_tile(t, i % across, i / across, rgb);
        else
            sweep_tile(t, &cells, &plan, &sets, i % across, i / across, rgb);
    }
    for (int i = 0; i < sets.sets; i++)
        free(sets.ray[i]);
    free(tiles);
    free(cells.cell);
}
