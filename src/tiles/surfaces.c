/* surfaces.c: finds the level surfaces of a noisy depth map. */
#include "tiles/surfaces.h"

#include <stdlib.h>

#include "support/compare.h"

enum { EACH = RF_TILE / RF_CELL }; /* cells of a tile, across and down */

/* How many pixels within a tile lie off both lines through their neighbours, across and down, by
 * more than `least`. */
static int off_lines(const int16_t *s, ptrdiff_t stride, int least)
{
    int count = 0;

    for (int y = 1; y < RF_TILE - 1; y++) {
        const int16_t *const row = s + y * stride, *const above = row - stride;
        const int16_t *const below = row + stride;

        for (int x = 1; x < RF_TILE - 1; x++)
            count += (abs(2 * row[x] - row[x - 1] - row[x + 1]) > least) &
                     (abs(2 * row[x] - above[x] - below[x]) > least);
    }
    return count;
}

/* The mean of the blurs of a tile, and how far those of its cells lie from each other. */
static int mean_of_tile(const int16_t *s, ptrdiff_t stride, int *apart)
{
    int least = INT16_MAX, most = INT16_MIN, sum = 0;

    for (int cell = 0; cell < EACH * EACH; cell++) {
        const int16_t *const at = s + RF_CELL * (cell / EACH * stride + cell % EACH);
        int mean = 0;

        for (int y = 0; y < RF_CELL; y++)
            for (int x = 0; x < RF_CELL; x++)
                mean += at[y * stride + x];
        mean /= RF_CELL * RF_CELL;
        sum += mean;
        least = rf_smaller(least, mean);
        most = rf_larger(most, mean);
    }
    *apart = most - least;
    return sum / (EACH * EACH);
}

/* Noise differs from pixel to pixel. If it is Gaussian, nine of ten pixels lie off their lines by a
 * sixteenth of what `noise` says, nearly all lie within three times of it, and the means of cells
 * lie within 5/8. */
void rf_find_flat(struct rf_bins *bins, struct rf_bin_scale scale, const int16_t *s,
                  ptrdiff_t stride)
{
    enum { INNER = (RF_TILE - 2) * (RF_TILE - 2) };
    const int noise = bins->noise;
    int apart, middle, most;

    if (bins->most - bins->least > 3 * noise || 4 * off_lines(s, stride, noise / 16) < 3 * INNER)
        return;
    middle = mean_of_tile(s, stride, &apart);
    most = rf_larger(rf_larger(256 >> scale.unit, 5 * noise / 8), abs(middle) / 8);
    bins->flat = apart <= most;
    bins->middle = (int16_t)middle;
}

/* The bin of a blur, or the one at an end. */
static int bin_of(struct rf_bin_scale scale, int blur)
{
    const int bin = rf_bin_of(scale, rf_clamp(blur, INT16_MIN, INT16_MAX));

    return rf_clamp(bin, 0, RF_BINS);
}

static bool has_any(const uint64_t word[RF_BINS / 64], int first, int end)
{
    for (int k = first / 64; 64 * k < end; k++) {
        const uint64_t from = k == first / 64 ? UINT64_MAX << first % 64 : UINT64_MAX;
        const uint64_t to = 64 * (k + 1) > end ? UINT64_MAX >> (64 * (k + 1) - end) : UINT64_MAX;

        if (word[k] & from & to)
            return true;
    }
    return false;
}

/* Sets the bins of a surface: those that are wholly within its noise. Where there is nothing from 2
 * to 2 1/2 times of it, what is nearer is the last of this noise. */
static void set_bins(struct rf_level_surface *surface, struct rf_bin_scale scale,
                     const uint64_t occupied[RF_BINS / 64], int widest)
{
    const int middle = surface->middle, noise = rf_smaller(surface->noise, widest / 4);
    const int near = bin_of(scale, middle - 2 * noise), far = bin_of(scale, middle + 2 * noise);
    const int nearer = bin_of(scale, middle - 5 * noise / 2);
    const int farther = bin_of(scale, middle + 5 * noise / 2);

    surface->noise = noise;
    surface->first =
        has_any(occupied, nearer, near) ? bin_of(scale, middle - 3 * noise / 2) + 1 : near + 1;
    surface->end = has_any(occupied, far, farther) ? bin_of(scale, middle + 3 * noise / 2) : far;
}

/* Inserts the surface of a tile, nearest first. */
static void insert(struct rf_level_surfaces *surfaces, const struct rf_bins *tile, bool own)
{
    int k = surfaces->count++;

    for (; k > 0 && surfaces->at[k - 1].middle > tile->middle; k--)
        surfaces->at[k] = surfaces->at[k - 1];
    surfaces->at[k] =
        (struct rf_level_surface){.middle = tile->middle, .noise = tile->noise, .own = own};
}

/* Makes one of those that are less than half of their noise apart: the tile's own, or else the
 * nearest. */
static void join(struct rf_level_surfaces *surfaces)
{
    int count = 0;

    for (int k = 0; k < surfaces->count; k++) {
        const struct rf_level_surface next = surfaces->at[k];
        struct rf_level_surface *const last = &surfaces->at[count ? count - 1 : 0];

        if (!count || next.middle - last->middle > rf_larger(next.noise, last->noise) / 2)
            surfaces->at[count++] = next;
        else if (next.own)
            *last = next;
    }
    surfaces->count = count;
}

/* Leaves out those without bins, and those that have bins of tiles without noise. */
static void leave_out(struct rf_level_surfaces *surfaces, const uint64_t sure[RF_BINS / 64])
{
    int count = 0;

    for (int k = 0; k < surfaces->count; k++) {
        const struct rf_level_surface surface = surfaces->at[k];

        if (surface.first < surface.end && !has_any(sure, surface.first, surface.end))
            surfaces->at[count++] = surface;
    }
    surfaces->count = count;
}

void rf_find_surfaces(const struct rf_viewport *view, const struct rf_bins *bins,
                      const struct rf_bins_in_reach *in_reach, struct rf_bin_scale scale, int tx,
                      int ty, int widest, struct rf_level_surfaces *surfaces)
{
    surfaces->count = 0;
    if (!in_reach->noisy)
        return;
    for (int y = rf_larger(ty - 1, 0); y <= rf_smaller(ty + 1, view->tiles_y - 1); y++)
        for (int x = rf_larger(tx - 1, 0); x <= rf_smaller(tx + 1, view->tiles_x - 1); x++) {
            const struct rf_bins *const tile = &bins[(size_t)y * view->tiles_x + x];

            if (tile->flat)
                insert(surfaces, tile, x == tx && y == ty);
        }
    join(surfaces);
    for (int k = 0; k < surfaces->count; k++) {
        struct rf_level_surface *const surface = &surfaces->at[k];
        struct rf_level_surface *const before = &surfaces->at[k ? k - 1 : 0];

        set_bins(surface, scale, in_reach->all.word, widest);
        if (k > 0 && before->end > surface->first)
            before->end = surface->first = rf_bin_of(scale, (before->middle + surface->middle) / 2);
    }
    leave_out(surfaces, in_reach->sure);
}
