/* twin_slabs.c: which blurs reach a tile, and slabs over them, in double precision. See
 * src/tiles/tiles.h. */
#include "twin_surfaces.h"

enum { BINS = TWIN_BINS, FOCUS_BIN = 127 };
static const double overlap = 0.125;

/* Blurs of a tile: which bins are occupied, and the extremes. Bin i begins at
 * (i - 127) width - 1/2. Of many tiles, which are occupied in those without noise, the sum of the
 * noise of the others, and their number. */
struct bins {
    bool has[BINS], sure[BINS];
    bool steep, has_steep[BINS]; /* a surface is; bins of the tiles in which one is */
    double least, most, noise;
    int noisy;
    bool level; /* a tile is, with this mean: */
    double middle;
};

/* Returns the width of a bin, by the largest blur and what rounding may add to it; 0: they are a
 * pixel wide up to 31.5 pixels of blur, then a sixteenth of the octave. */
static double bin_width(const struct twin *t)
{
    const double largest = t->K * fmax(t->df, 1 - t->df) + t->unit / 256.0;
    double width = 1;

    while (width > 0.0625 && largest <= 64 * width - 0.5)
        width /= 2;
    return t->unit > 1 ? 0 : width;
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

int twin_bin_of(double width, double s)
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
    bins->has[twin_bin_of(width, s)] = true;
    bins->least = fmin(bins->least, s);
    bins->most = fmax(bins->most, s);
}

/* How far the blurs of all four cells of a block overlap, where every second bin of that occurs;
 * negative where they lie apart. */
static double overlap_of_cells(const struct twin *t, const struct bins *bins, double width, int x,
                               int y)
{
    double low = -1e9, high = 1e9;
    int first, last, found = 0;

    for (int i = 0; i < 4; i++) {
        double least = 1e9, most = -1e9;

        for (int j = 0; j < TWIN_CELL * TWIN_CELL; j++) {
            const double s = t->map_blur[twin_at(t, x + i % 2 * TWIN_CELL + j % TWIN_CELL,
                                                 y + i / 2 * TWIN_CELL + j / TWIN_CELL)];

            least = fmin(least, s);
            most = fmax(most, s);
        }
        low = fmax(low, least);
        high = fmin(high, most);
    }
    first = twin_bin_of(width, low);
    last = twin_bin_of(width, high);
    low = floor(256 * low + 0.5) / 256;
    high = floor(256 * high + 0.5) / 256;
    for (int bin = first; bin <= last; bin++)
        found += bins->has[bin];
    if (high < low)
        return high - low;
    return high - low > 0.25 && 2 * found > last - first ? high - low : 0;
}

/* The noise of a tile, by the second of its four blocks of cells, or by the one that edges leave
 * whole; see src/tiles/tiles.c. */
static double noise_of_tile(const struct twin *t, const struct bins *bins, double width, int tx,
                            int ty)
{
    double noise[4], largest = 0, second = 0;
    int cut = 0;

    for (int i = 0; i < 4; i++) {
        noise[i] = overlap_of_cells(t, bins, width, tx * TWIN_TILE + i % 2 * 2 * TWIN_CELL,
                                    ty * TWIN_TILE + i / 2 * 2 * TWIN_CELL);

        second = fmax(second, fmin(largest, noise[i]));
        largest = fmax(largest, noise[i]);
    }
    for (int i = 0; i < 4; i++)
        cut += noise[i] < -largest;
    return cut >= 2 ? largest : second;
}

/* Whether a cell is of one surface, which slopes by more than half a pixel a pixel along a row or a
 * column; see src/tiles/tiles.c. */
static bool is_steep_cell(const struct twin *t, int x, int y)
{
    bool slopes = false;

    for (int i = 0; i < 2 * TWIN_CELL; i++) {
        double blur[TWIN_CELL];

        for (int k = 0; k < TWIN_CELL; k++)
            blur[k] = t->map_blur[i < TWIN_CELL ? twin_at(t, x + k, y + i)
                                                : twin_at(t, x + i - TWIN_CELL, y + k)];
        for (int k = 1; k < TWIN_CELL; k++)
            if (fabs(blur[k] - blur[k - 1]) > 1)
                return false;
        slopes = slopes || fabs(blur[TWIN_CELL - 1] - blur[0]) > 1.5;
    }
    return slopes;
}

static bool is_steep_tile(const struct twin *t, int tx, int ty)
{
    for (int y = 0; y < TWIN_TILE; y += TWIN_CELL)
        for (int x = 0; x < TWIN_TILE; x += TWIN_CELL)
            if (is_steep_cell(t, tx * TWIN_TILE + x, ty * TWIN_TILE + y))
                return true;
    return false;
}

static void note_tile(const struct twin *t, struct bins *bins, double width, const double *blur,
                      int tx, int ty)
{
    for (int y = ty * TWIN_TILE; y < (ty + 1) * TWIN_TILE && y < t->height; y++)
        for (int x = tx * TWIN_TILE; x < (tx + 1) * TWIN_TILE && x < t->width; x++)
            note(bins, width, blur[y * t->width + x]);
}

static struct bins bins_of_tile(const struct twin *t, double width, int tx, int ty)
{
    struct bins bins = {.least = 1e9, .most = -1e9};

    note_tile(t, &bins, width, t->map_blur, tx, ty); /* silhouettes as they were, too */
    bins.noise = noise_of_tile(t, &bins, width, tx, ty);
    bins.noisy = bins.noise > 0;
    bins.steep = is_steep_tile(t, tx, ty);
    bins.level = twin_is_level(t, tx, ty, bins.noise, bins.most - bins.least, &bins.middle);
    note_tile(t, &bins, width, t->blur, tx, ty);
    return bins;
}

/* Leave out the bins that lie below a blur of s pixels as a whole. */
static void drop_short(struct bins *bins, double width, double s)
{
    const int first = twin_bin_of(width, -s) + 1, end = twin_bin_of(width, s);
    const double low = edge_of(width, first), high = edge_of(width, end);

    for (int i = first > 0 ? first : 0; i < end && i < BINS; i++)
        bins->has[i] = false;
    if (bins->least >= low && bins->least < high)
        bins->least = high;
    if (bins->most >= low && bins->most < high)
        bins->most = low;
}

static void add(struct bins *reach, const struct bins *bins)
{
    if (bins->least > bins->most)
        return;
    for (int i = 0; i < BINS; i++) {
        reach->has[i] |= bins->has[i];
        reach->sure[i] |= bins->has[i] && !bins->noisy;
        reach->has_steep[i] |= bins->has[i] && bins->steep;
    }
    reach->least = fmin(reach->least, bins->least);
    reach->most = fmax(reach->most, bins->most);
    reach->noise += bins->noise;
    reach->noisy += bins->noisy;
    reach->steep |= bins->steep;
}

/* A block of tiles is as noisy as they are on the average, if all are. */
static void average_noise(struct bins *block)
{
    bool clean = !block->noisy;

    for (int i = 0; i < BINS; i++)
        clean = clean || block->sure[i];
    block->noise = clean ? 0 : block->noise / block->noisy;
    block->noisy = !clean;
}

/* The blurs that can be hit from tile (tx, ty): those of a tile g pixels away that are g - 1
 * pixels or more. */
static struct bins reach_of_tile(const struct twin *t, const struct bins *tiles, int across,
                                 int down, double width, int tx, int ty)
{
    struct bins reach = {.least = 1e9, .most = -1e9};

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
            add(&reach, &bins);
        }
    }
    return reach;
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
    struct bins reach = {.least = 1e9, .most = -1e9};

    for (int y = 0; y < down; y += BLOCK)
        for (int x = 0; x < across; x += BLOCK) {
            const int dx = between_tiles(tx, x, BLOCK), dy = between_tiles(ty, y, BLOCK);
            const bool near = dx < BLOCK && dy < BLOCK;
            struct bins block = {.least = 1e9, .most = -1e9};

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
                add(near ? &reach : &block, &bins);
            }
            if (near)
                continue;
            average_noise(&block);
            drop_short(&block, 0, floor(hypot(dx, dy)) * TWIN_TILE - 1);
            add(&reach, &block);
        }
    return reach;
}

/* A slab over bins [bin, last], nothing of it in focus. */
static struct twin_slab slab_over(const struct bins *bins, double width, int bin, int last)
{
    struct twin_slab slab = {fmax(edge_of(width, bin), bins->least),
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
    int end = twin_bin_of(0, until);

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

/* How slabs are merged; see src/tiles/slabs.c. */
struct merging {
    double noise, ratio;
    struct twin_surfaces surfaces;
};

/* Where a slab ends that begins with that bin and would end with `end`, if what follows is noise:
 * no wider than that, no more than 1 + ratio times as far out of focus on one side as on the other,
 * and at a gap as wide as it would be. */
static int end_of_noise(const struct bins *bins, double width, const struct merging *merging,
                        int bin, int end)
{
    const double low = edge_of(width, bin), ratio = merging->ratio;
    const double farthest = low < 0 ? -low / (1 + ratio) * ratio : low * ratio;
    int until = twin_bin_of(width, low + fmin(merging->noise, farthest)), gap = 0;

    if (bin < FOCUS_BIN && until > FOCUS_BIN)
        until = FOCUS_BIN;
    for (int b = bin; b < until && b < BINS; b++) {
        gap = bins->has[b] ? 0 : gap + 1;
        if (bins->sure[b] || gap >= end - bin)
            return b > end ? b : end;
    }
    return until > end ? until : end;
}

/* The slab of a surface, seen in its middle, which reaches into what is nearer by half of its noise
 * at least; ends are whole 1/256 of a unit. */
static struct twin_slab slab_of_surface(const struct twin_surface *surface, double width,
                                        double unit)
{
    const double low = edge_of(width, surface->first);
    const double high = edge_of(width, surface->end) - unit / 256;
    const double wide = fmax(overlap, (high - low) / 8);
    const double centre = fabs(surface->middle) < 0.5 ? 0 : surface->middle;

    return (struct twin_slab){low - fmax(wide, surface->noise / 2), high + wide, centre, centre,
                              centre};
}

/* How far a slab reaches into the nearer one: farther where surfaces are steep. */
static double overlap_of(const struct bins *bins, double width, int first, int end)
{
    for (int i = first; i < end && i < BINS; i++)
        if (bins->has_steep[i] && fabs(edge_of(width, first)) <= 16)
            return 6 * overlap;
    return overlap;
}

/* Slabs a pixel wide from the near side on, half as wide below 3 pixels of blur, an eighth of the
 * blur less a pixel from 16 on, where they end as those do that cover all bins; one for all that is
 * in focus. */
static struct twin_plan cover(const struct bins *bins, double width, double unit,
                              const struct merging *merging, int *noisy)
{
    const int pixel = width > 0 ? (int)(1 / width) : 1;
    struct twin_plan plan = {.sharp = true};
    int next = 0;

    *noisy = 0;
    for (int bin = 0; bin < BINS;) {
        int end, last = bin, cell = 0;
        struct twin_slab slab;
        double wide, nearer;
        bool sure = false;

        if (!bins->has[bin]) {
            bin++;
            continue;
        }
        while (next < merging->surfaces.count && bin >= merging->surfaces.at[next].end)
            next++;
        if (next < merging->surfaces.count && bin >= merging->surfaces.at[next].first) {
            slab = slab_of_surface(&merging->surfaces.at[next], width, unit);
            plan.sharp = plan.sharp && fabs(slab.centre) < 0.5;
            plan.reach = fmax(plan.reach, fabs(slab.centre));
            plan.slab[plan.slabs++] = slab;
            bin = merging->surfaces.at[next].end;
            continue;
        }
        if (bin >= FOCUS_BIN && bin < FOCUS_BIN + pixel) {
            nearer = overlap_of(bins, width, bin, FOCUS_BIN + pixel);
            plan.slab[plan.slabs++] =
                (struct twin_slab){-0.5 - overlap - nearer, nextafter(0.5, 0), 0, 0, 0};
            bin = FOCUS_BIN + pixel;
            continue;
        }
        while ((end = end_of(cell, width)) <= bin)
            cell = end;
        if (width > 0 && fabs(edge_of(width, bin)) < 16)
            end = end_of(bin, width);
        if (merging->noise > 0)
            end = end_of_noise(bins, width, merging, bin, end);
        if (next < merging->surfaces.count && end > merging->surfaces.at[next].first)
            end = merging->surfaces.at[next].first;
        for (int i = bin; i < end && i < BINS; i++) {
            last = bins->has[i] ? i : last;
            sure = sure || bins->sure[i];
        }
        *noisy += !sure;
        slab = slab_over(bins, width, bin, last);
        plan.sharp = false;
        plan.reach = fmax(plan.reach, fmax(-slab.low, slab.high));
        wide = fmax(overlap, (slab.high - slab.low) / 8);
        nearer = overlap_of(bins, width, bin, last + 1);
        slab.low -= fmax(nearer, wide);
        slab.high += wide;
        if (slab.centre < 0 && slab.high >= -0.5)
            slab.high = nextafter(-0.5, -1);
        if (slab.centre > 0 && slab.low < 0.5 && nearer == overlap)
            slab.low = 0.5 - 2 * overlap;
        plan.slab[plan.slabs++] = slab;
        bin = last + 1;
    }
    return plan;
}

/* Near the focus the crack between two slabs is closed by one of both, behind them, if another
 * follows. Ends are whole 1/256 of a unit. */
static struct twin_plan with_closed_cracks(const struct twin_plan *open, double noise, double unit)
{
    struct twin_plan plan = *open;
    const double more = fmin(floor(64 * noise / unit), 8 * 256) * unit / 256;

    plan.slabs = 0;
    for (int k = 0; k < open->slabs; k++) {
        const struct twin_slab *const slab = &open->slab[k];
        struct twin_slab both = *slab;

        plan.slab[plan.slabs++] = *slab;
        if (k == 0 || k == open->slabs - 1 || fabs(slab->centre) > 2 ||
            slab->low >= slab[-1].high || slab->high - slab[-1].low > 12 * unit)
            continue;
        both.centre = ceil(256 / unit * slab[-1].high) - 1 + 256 / unit * slab->low;
        both.centre = floor(both.centre / 2) * unit / 256;
        both.low = slab[-1].low - more;
        plan.slab[plan.slabs++] = both;
    }
    return plan;
}

/* Slabs of noise get wider until there are at most 8 of them. */
static struct twin_plan bounded_plan(const struct bins *bins, const struct twin_surfaces *surfaces,
                                     double width, double unit)
{
    /* in whole 1/256 pixels, as the end of a slab may lie on an edge of a bin */
    const double noise = bins->noisy ? floor(256 * bins->noise / bins->noisy) / 256 : 0;
    struct merging merging = {3 * noise, 1, *surfaces};
    int noisy;
    struct twin_plan plan;

    twin_settle_surfaces(
        &merging.surfaces,
        &(struct twin_reach){bins->has, bins->sure, width,
                             (256 * unit - (bins->most - bins->least)) * 4 / 5 - unit / 4});
    plan = cover(bins, width, unit, &merging, &noisy);

    while (noisy > 8 && merging.ratio < 8) {
        merging.ratio *= 2;
        plan = cover(bins, width, unit, &merging, &noisy);
    }
    return noise > 0 && bins->most - bins->least < 236 * unit
               ? with_closed_cracks(&plan, noise, unit)
               : plan;
}

/* The surfaces of a tile and of those around it. */
static struct twin_surfaces surfaces_at(const struct bins *tiles, int across, int down, int tx,
                                        int ty)
{
    struct twin_surfaces surfaces = {.count = 0};

    for (int y = ty - 1; y <= ty + 1; y++)
        for (int x = tx - 1; x <= tx + 1; x++) {
            const bool inside = x >= 0 && x < across && y >= 0 && y < down;
            const struct bins *const tile = &tiles[inside ? y * across + x : 0];

            if (inside && tile->level)
                twin_insert_surface(&surfaces, &(struct twin_surface){.middle = tile->middle,
                                                                      .noise = tile->noise,
                                                                      .own = x == tx && y == ty});
        }
    return surfaces;
}

struct twin_plan *twin_plans(const struct twin *t, int across, int down)
{
    const double width = bin_width(t);
    struct bins *tiles = calloc((size_t)(across * down), sizeof *tiles);
    struct twin_plan *plans = calloc((size_t)(across * down), sizeof *plans);

    assert_true(tiles && plans);
    for (int i = 0; i < across * down; i++)
        tiles[i] = bins_of_tile(t, width, i % across, i / across);
    for (int i = 0; i < across * down; i++) {
        const struct bins reach =
            t->unit > 1 ? reach_from_blocks(tiles, across, down, i % across, i / across)
                        : reach_of_tile(t, tiles, across, down, width, i % across, i / across);
        const struct twin_surfaces surfaces =
            surfaces_at(tiles, across, down, i % across, i / across);

        plans[i] = bounded_plan(&reach, &surfaces, width, t->unit);
    }
    free(tiles);
    return plans;
}
