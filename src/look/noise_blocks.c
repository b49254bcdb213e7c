/* noise_blocks.c: counts the blocks of a photo by their brightness, and by how much their pixels
 * differ.
 *
 * What is measured in blocks of 8 x 8 pixels of luma is the mean square of second differences
 * along rows and columns, between neighbours and between every other pixel, which is 6 sigma^2 of
 * white noise.
 *
 * Texture is told from noise by distance: noise does not differ more between pixels that are
 * farther apart, beyond its own size, and texture does, as light and shade of cloth, bricks or
 * grass are larger than a pixel. So a block is one of texture where the variance between every
 * fourth pixel, which reaches out of the block, is four times that between every other one, as that
 * of slopes is, and of noise up to twice, as chance alone has it. The side of a block that differs
 * most does not count, as it may be an edge.
 *
 * Noise that demosaicking, JPEG or a change of size made coarse grows from 2 to 4 pixels as much as
 * texture that a lens made smooth, but hardly from 4 to 8: smoothed by a Gaussian of 1.2 pixels it
 * grows 2.6 and 1.1 times, which is 1.4 and 0.1 octaves. Texture that looks alike at all sizes
 * grows by as many octaves each time. So the bend, the octaves from 2 to 4 less twice those from 4
 * to 8, is summed up as well: 1.4 - 2 x 0.1 = 1.2 of that noise, 1.4 - 2 x 1.4 = -1.4 of such
 * texture.
 */
#include "look/noise_blocks.h"

#include <assert.h>
#include <limits.h>
#include <string.h>

#include "image/format.h"
#include "support/compare.h"

enum {
    BLOCK = 8,
    MOST_BLOCKS = 8192, /* larger photos are measured in every second, third... block each way */
    REACH = 8,          /* pixels around a block that are looked at, too */
    SIDE = BLOCK + 2 * REACH,
    MOST_SAMPLES = 2 * BLOCK * BLOCK,    /* second differences of a block */
    MOST_SQUARE = (2 * 251) * (2 * 251), /* second differences of codes from 2 to 253 */
    MOST_NEAR = 1 << 17,                 /* larger variances between neighbours count as this */
    OCTAVE = RF_NOISE_OCTAVE,
    MOST_BEND = 2 * OCTAVE, /* as do steeper bends, so that an edge does not outvote all others */
};
static_assert(16 * MOST_SAMPLES <= INT32_MAX / MOST_SQUARE, "sums of squares");
static_assert(16 * MOST_SQUARE / 6 < 2 * OCTAVE << (RF_NOISE_BINS / OCTAVE - 2), "a bin for each");
static_assert(MOST_NEAR <= UINT32_MAX / 2 / MOST_BLOCKS, "sums of variances");
static_assert(16 * MOST_SQUARE / 6 <= INT32_MAX / RF_NOISE_ROUGH, "products of variances");
static_assert(16 * MOST_SQUARE / 6 <= INT32_MAX / (2 * OCTAVE), "logarithms of variances");
static_assert(MOST_BEND <= INT32_MAX / 2 / MOST_BLOCKS, "sums of bends");

/* The variance between every fourth pixel, as times that between every other one, up to which a
 * block is one of noise, and from which on of texture. */
static const int noise_growth = 2, texture_growth = 4;

/* Luma, or -1 of a pixel that touches black or white in a channel, where noise is cut off. */
static int luma_at(const struct rf_photo_source *photo, int x, int y)
{
    const uint8_t *to_code = photo->transfer->to_code;
    int code[3];

    if (rf_has_planes(photo)) {
        for (int c = 0; c < 3; c++)
            code[c] = to_code[4 * photo->light.channel[c][y * photo->light.stride + x]];
    } else {
        const struct refocus_image *image = photo->image;
        const struct rf_order o = rf_order_of(image->format);
        const uint8_t *at = image->plane[0] + y * image->stride[0] + (ptrdiff_t)x * o.bytes;

        code[0] = at[o.r], code[1] = at[o.g], code[2] = at[o.b];
    }
    for (int c = 0; c < 3; c++)
        if (code[c] < 2 || code[c] > 253)
            return -1;
    return rf_luma(code[0], code[1], code[2]);
}

/* Second differences between three pixels a step apart: their squares, and how many. */
struct differences {
    int squares, count;
};

/* Adds one; lumas below 0 are not known. */
static void add_difference(struct differences *to, int before, int middle, int after)
{
    const int difference = before - 2 * middle + after;

    if (before >= 0 && after >= 0) {
        to->squares += difference * difference;
        to->count++;
    }
}

/* The variance that makes them, in 1/16 code^2. */
static int variance_of_differences(struct differences d)
{
    return 16 * d.squares / (6 * d.count);
}

/* Variance of a block between pixels step apart along rows and columns. */
static int variance_within(int v[SIDE][SIDE], int step)
{
    struct differences all = {0, 0};

    for (int i = REACH; i < REACH + BLOCK; i++) {
        for (int k = REACH + step; k < REACH + BLOCK - step; k++) {
            add_difference(&all, v[i][k - step], v[i][k], v[i][k + step]);
            add_difference(&all, v[k - step][i], v[k][i], v[k + step][i]);
        }
    }
    return variance_of_differences(all);
}

/* Variance between the pixels of a block and those around it, which are step away, -1 if these are
 * not known. Of the four sides that have some the one with most is left out: there may be an edge.
 */
static int variance_beyond(int v[SIDE][SIDE], int step)
{
    struct differences side[4] = {{0, 0}};
    int sum = 0, most = 0, sides = 0;

    for (int i = REACH; i < REACH + BLOCK; i++) {
        for (int k = REACH; k < REACH + BLOCK; k++) {
            const int after = k >= REACH + BLOCK / 2;

            add_difference(&side[after], v[i][k - step], v[i][k], v[i][k + step]);
            add_difference(&side[2 + after], v[k - step][i], v[k][i], v[k + step][i]);
        }
    }
    for (int i = 0; i < 4; i++) {
        if (side[i].count > 0) {
            const int variance = variance_of_differences(side[i]);

            sum += variance;
            most = rf_larger(most, variance);
            sides++;
        }
    }
    return sides > 1 ? (sum - most) / (sides - 1) : -1;
}

/* The bin of a variance in 1/16 code^2: below 128 each has its own, then OCTAVE share an octave. */
static int bin_of(int variance)
{
    int octave = 0;

    while (variance >> octave >= 2 * OCTAVE)
        octave++;
    return OCTAVE * octave + (variance >> octave);
}

double rf_noise_bin_middle(int bin)
{
    const int octave = rf_larger(bin / OCTAVE - 1, 0);

    return (bin - OCTAVE * octave + 0.5) * (1 << octave) / 16;
}

/* Reads a block; of no use are those that touch black or white. */
static bool read_block(int v[SIDE][SIDE], const struct rf_photo_source *photo, int x0, int y0)
{
    for (int y = 0; y < BLOCK; y++)
        for (int x = 0; x < BLOCK; x++)
            if ((v[REACH + y][REACH + x] = luma_at(photo, x0 + x, y0 + y)) < 0)
                return false;
    return true;
}

/* Reads what is beside a block and above and below it, -1 beyond the photo. */
static void read_around(int v[SIDE][SIDE], const struct rf_photo_source *photo, int x0, int y0)
{
    for (int i = 0; i < BLOCK; i++) {
        for (int k = 0; k < 2 * REACH; k++) {
            const int at = k < REACH ? k : BLOCK + k; /* before and after the block */
            const int x = x0 - REACH + at, y = y0 - REACH + at;

            v[REACH + i][at] = x >= 0 && x < photo->width ? luma_at(photo, x, y0 + i) : -1;
            v[at][REACH + i] = y >= 0 && y < photo->height ? luma_at(photo, x0 + i, y) : -1;
        }
    }
}

/* How much a block is one of texture, by its variances between every other and every fourth pixel:
 * 0 to RF_NOISE_ROUGH. */
static int roughness_of(int variance, int farther)
{
    const int from = noise_growth * rf_larger(variance, 1);
    const int range = (texture_growth - noise_growth) * rf_larger(variance, 1);

    if (farther < 0)
        return RF_NOISE_ROUGH;
    return RF_NOISE_ROUGH * rf_smaller(rf_larger(farther - from, 0), range) / range;
}

/* The logarithm of a variance, in 1/OCTAVE octave from a constant on. */
static int octaves_of(int variance)
{
    return bin_of(2 * OCTAVE * rf_larger(variance, 1));
}

/* By how many octaves a block's variance grows from 2 pixels to 4, less twice those from 4 to 8, in
 * 1/OCTAVE octave; 0 if not known. */
static int bend_of(int variance, int farther, int farthest)
{
    const int grows = octaves_of(farther) - octaves_of(variance);
    const int goes_on = octaves_of(farthest) - octaves_of(farther);

    if (farther < 0 || farthest < 0)
        return 0;
    return rf_smaller(rf_larger(grows - 2 * goes_on, -MOST_BEND), MOST_BEND);
}

static void count_block(struct rf_grain *grain, const struct rf_photo_source *photo, int x0, int y0)
{
    int v[SIDE][SIDE], sum = 0;

    if (!read_block(v, photo, x0, y0))
        return;
    read_around(v, photo, x0, y0);
    for (int y = 0; y < BLOCK; y++)
        for (int x = 0; x < BLOCK; x++)
            sum += v[REACH + y][REACH + x];
    {
        const int level = sum / (BLOCK * BLOCK) / RF_NOISE_WIDTH;
        const int variance = variance_within(v, 2), bin = bin_of(variance);
        const int near = variance_within(v, 1), farther = variance_beyond(v, 4);

        grain->blocks[level][bin]++;
        grain->near[level][bin] += (uint32_t)rf_smaller(near, MOST_NEAR);
        grain->rough[level][bin] += (uint32_t)roughness_of(variance, farther);
        grain->bend[level][bin] += bend_of(variance, farther, variance_beyond(v, 8));
    }
}

void rf_count_noise_blocks(const struct rf_look *look)
{
    const struct rf_photo_source *photo = &look->photo;
    const int64_t blocks = (int64_t)(photo->width / BLOCK) * (photo->height / BLOCK);
    int step = BLOCK;

    memset(look->grain->blocks, 0, sizeof look->grain->blocks);
    memset(look->grain->near, 0, sizeof look->grain->near);
    memset(look->grain->rough, 0, sizeof look->grain->rough);
    memset(look->grain->bend, 0, sizeof look->grain->bend);
    while (blocks > (int64_t)MOST_BLOCKS * (step / BLOCK) * (step / BLOCK))
        step += BLOCK;
    for (int y = 0; y + BLOCK <= photo->height && !rf_cancelled(look->exec); y += step)
        for (int x = 0; x + BLOCK <= photo->width; x += step)
            count_block(look->grain, photo, x, y);
}
