/* deviation.c: how much the light of each side of the caller's matte varies from pixel to pixel.
 *
 * Of tiles with enough pixels of a side it is the standard deviation of their luminance; the others
 * take it from those around, by a push-pull of the tiles (background/inpaint.h).
 */
#include <math.h>

#include "background/inpaint.h"
#include "support/compare.h"
#include "thin/mixture.h"

enum {
    FEWEST = 16, /* pixels of a side that a tile needs */
    SHIFT = 3,   /* deviations are kept in 8 bits: Q9 of light in Q12 */
    ONES = 255,
};

struct deviations {
    const struct rf_matte_pass *pass;
    const struct rf_level *level; /* the level with a pixel for each tile, or the last */
    bool is_near;
};

static const struct rf_level *level_of_tiles(const struct rf_pyramid *pyramid)
{
    return &pyramid->level[rf_smaller(pyramid->levels, RF_BAND_LEVELS)];
}

/* The deviation of luminance, Q12, of a tile's pixels that are sure to be on a side; -1: they are
 * too few. */
static int deviation_of(const struct deviations *d, int tx, int ty)
{
    const struct rf_matte_pass *pass = d->pass;
    const int right = rf_smaller((tx + 1) * RF_TILE, pass->view->width);
    const int bottom = rf_smaller((ty + 1) * RF_TILE, pass->view->height);
    int64_t count = 0, sum = 0, squares = 0;

    for (int y = ty * RF_TILE; y < bottom; y++)
        for (int x = tx * RF_TILE; x < right; x++) {
            const ptrdiff_t at = y * pass->light.stride + x;
            int luminance;

            if (!rf_is_sure(pass->alpha.at[y * pass->alpha.stride + x], d->is_near))
                continue;
            luminance = (218 * pass->light.channel[0][at] + 732 * pass->light.channel[1][at] +
                         74 * pass->light.channel[2][at]) >>
                        10;
            count++;
            sum += luminance;
            squares += luminance * luminance;
        }
    return count < FEWEST ? -1 : (int)sqrt((double)(squares * count - sum * sum)) / (int)count;
}

static void measure_band(void *context, int band, int worker)
{
    const struct deviations *d = context;
    const struct rf_level *level = d->level;
    const ptrdiff_t at = band * level->light.stride, at_blur = band * level->blur.stride;

    (void)worker;
    for (int tx = 0; tx < level->width; tx++) {
        const int deviation = deviation_of(d, tx, band);

        for (int c = 0; c < 3; c++)
            level->light.channel[c][at + tx] = (uint16_t)rf_larger(deviation, 0);
        level->blur.at[at_blur + tx] = deviation < 0 ? RF_NO_BLUR : 0;
    }
    if (level->width % 2)
        level->blur.at[at_blur + level->width] = RF_NO_BLUR;
}

/* Measures one side, and keeps it at the first pixels of `lost`, in one half of their bits. A side
 * that no tile has enough pixels of does not vary. */
static void measure_side(struct deviations *d, bool is_near)
{
    const struct rf_matte_pass *pass = d->pass;
    const struct rf_pyramid *pyramid = pass->pyramid;
    const int first = (int)(d->level - pyramid->level);
    bool known;

    d->is_near = is_near;
    rf_pool_run(pass->exec->pool, measure_band, d, d->level->height);
    rf_background_push(pass->exec, pyramid, first, pyramid->levels);
    known = !rf_cancelled(pass->exec) && pyramid->level[pyramid->levels].blur.at[0] != RF_NO_BLUR;
    if (known)
        rf_background_pull(pass->exec, pass->view, pyramid, first, pyramid->levels);
    for (int y = 0; y < d->level->height; y++)
        for (int x = 0; x < d->level->width; x++) {
            const int deviation =
                d->level->light.channel[0][y * d->level->light.stride + x] >> SHIFT;
            const int kept = known ? rf_smaller(deviation, ONES) : 0;
            uint16_t *const to = pass->lost.at + y * pass->lost.stride + x;

            *to = (uint16_t)(is_near ? kept << 8 | (*to & ONES) : kept | (*to & ~ONES));
        }
}

void rf_measure_deviations(const struct rf_matte_pass *pass)
{
    struct deviations d = {.pass = pass, .level = level_of_tiles(pass->pyramid)};

    measure_side(&d, true);
    measure_side(&d, false);
}

void rf_deviations_at(const struct rf_matte_pass *pass, int x, int y, int *near, int *far)
{
    const struct rf_level *level = level_of_tiles(pass->pyramid);
    const int half = RF_TILE / 2;
    const int u = rf_within(x - half, (level->width - 1) * RF_TILE);
    const int v = rf_within(y - half, (level->height - 1) * RF_TILE);
    int sum_near = 0, sum_far = 0;

    for (int i = 0; i < 4; i++) {
        const int tx = u / RF_TILE + (i & 1), ty = v / RF_TILE + (i >> 1);
        const int across = i & 1 ? u % RF_TILE : RF_TILE - u % RF_TILE;
        const int down = i >> 1 ? v % RF_TILE : RF_TILE - v % RF_TILE;
        const int both = pass->lost.at[rf_smaller(ty, level->height - 1) * pass->lost.stride +
                                       rf_smaller(tx, level->width - 1)];

        sum_near += across * down * (both >> 8);
        sum_far += across * down * (both & ONES);
    }
    *near = (sum_near << SHIFT) / (RF_TILE * RF_TILE);
    *far = (sum_far << SHIFT) / (RF_TILE * RF_TILE);
}
