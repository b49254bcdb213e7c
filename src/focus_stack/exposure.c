/* exposure.c: frames get the exposure of the reference, where they have another one.
 *
 * A camera that measures the light and its white for each picture, and a lamp that flickers, make
 * frames of 5 to 20 % more or less light: parts of the photo that are of different frames would
 * have other tones, and what is brighter would be taken for moving. Blur spreads light, but leaves
 * its mean: so a channel's exposure is the median, over blocks of the picture, of the ratio of both
 * means, in linear light of sRGB. Blocks tell nothing if they are dark or clipped in part, and if
 * their light varies by more than 3/10 of its mean: cameras have other tone curves, by which the
 * mean of what is sharp is not that of what is blurred, by up to 6 % in high contrast. The median
 * counts where the blocks agree, the fewer the more. Where those do not, all that are neither dark
 * nor clipped are asked, for a difference that is no such mean's.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/transfer.h"

enum {
    ACROSS = 24, /* blocks across and down at the most */
    BLOCKS = ACROSS * ACROSS,
    LEAST_BLOCKS = 4, /* fewer have no quartiles */
    /* The quartiles, divided by the root of the number of blocks, are apart by this part of the
     * median at the most: 24 blocks by a quarter. */
    ERROR = 20,
    LEAST_SIDE = 16,   /* pixels of a block that are looked at, across and down, or more */
    CLIPPED = 243,     /* codes from here on count as clipped, 1 / FEW of a block at the most */
    DARK = 4096 / 100, /* light below which a block tells nothing, Q12 */
    FEW = 50,
    FLAT = 9,          /* hundredths: squared deviation of light in parts of its squared mean */
    SAME = 4096 / 50,  /* exposures that differ by less are the same: blur alone changes 1 % */
    ALIKE = 4096 / 10, /* likewise where light varies: tone curves change 6 % */
    BRIGHTEST = 2,     /* times the light of the reference: beyond, too much is clipped */
    DARKEST = 4,       /* parts of the light of the reference: too little is left of less */
    FADES = 240,       /* from this code on less is changed; white stays white */
    ONE = 4096,        /* the exposure of the reference */
};

/* Sums over the pixels of a block, below 2^14 of them: all have 2^18 at the most. */
struct block {
    int32_t here[3], there[3];           /* light of the frame and of the reference, Q12 */
    int64_t here_squared, there_squared; /* green alone, Q24 */
    int32_t count, clipped;
};

/* They lie in the memory of `sum`, which has 16 bytes a sample and more: 256 samples to a block. */
struct blocks {
    struct block *block;
    int across, down;
};

static void count_pixel(struct block *block, const uint16_t *light, const uint8_t *here,
                        const uint8_t *there)
{
    bool clipped = false;

    for (int c = 0; c < 3; c++) {
        clipped |= here[c] >= CLIPPED || there[c] >= CLIPPED;
        block->here[c] += light[here[c]];
        block->there[c] += light[there[c]];
    }
    block->here_squared += light[here[1]] * light[here[1]];
    block->there_squared += light[there[1]] * light[there[1]];
    block->clipped += clipped;
    block->count++;
}

/* Adds up what frame and reference show of the same places: one pixel in each square of the finest
 * picture that frames are aligned by. */
static void add_up(const struct refocus_stack *s, const struct rf_stack_frame *frame,
                   const struct blocks *blocks)
{
    const int64_t half = INT64_C(1) << 31;
    const int64_t width = s->width, height = s->height;
    const int step = s->small_by;

    memset(blocks->block, 0, (size_t)(blocks->across * blocks->down) * sizeof *blocks->block);
    for (int y = 0; y < s->height; y += step) {
        const struct rf_stack_line line = rf_stack_line(s, frame, 0, y, step);
        const uint8_t *there = s->frame[s->still].rgb + 3 * y * width;
        struct block *row = blocks->block + y * blocks->down / height * blocks->across;

        for (int i = 0, x = 0; x < s->width; i++, x += step) {
            const int64_t u = (line.x + i * line.dx + half) >> 32;
            const int64_t v = (line.y + i * line.dy + half) >> 32;

            if (rf_stack_reaches(s, &line, i))
                count_pixel(row + x * blocks->across / width, s->transfer->to_light,
                            frame->rgb + 3 * (v * width + u), there + 3 * (ptrdiff_t)x);
        }
    }
}

/* Whether light varies by little: 2^14 (2^14 2^24) 109 < 2^59. */
static bool is_flat(int64_t squared, int64_t sum, int64_t count)
{
    return 100 * count * squared <= (100 + FLAT) * sum * sum;
}

static bool tells(const struct block *block, int c, bool flat)
{
    return block->clipped <= block->count / FEW && block->there[c] > (int64_t)DARK * block->count &&
           (!flat || (is_flat(block->here_squared, block->here[1], block->count) &&
                      is_flat(block->there_squared, block->there[1], block->count)));
}

/* Finds the exposure of a channel by the blocks that tell it, or by flat ones of these; 0: there
 * are none. Returns whether they agree. */
static bool find_channel(const struct blocks *blocks, int c, bool flat, int *exposure)
{
    int ratio[BLOCKS], n = 0; /* in their order */

    for (int b = 0; b < blocks->across * blocks->down; b++) {
        const struct block *block = &blocks->block[b];

        if (!tells(block, c, flat))
            continue;

        const int64_t exact = (int64_t)block->here[c] * ONE / block->there[c];
        const int now = (int)(exact < BRIGHTEST * ONE ? exact : BRIGHTEST * ONE);
        int i = n++;

        for (; i > 0 && ratio[i - 1] > now; i--)
            ratio[i] = ratio[i - 1];
        ratio[i] = now;
    }
    *exposure = 0;
    if (n < LEAST_BLOCKS)
        return true;

    const int64_t median = ratio[n / 2], spread = ratio[3 * n / 4] - ratio[n / 4];

    *exposure = (int)median;
    return ERROR * ERROR * spread * spread <= n * median * median && median > ONE / DARKEST &&
           median < BRIGHTEST * ONE;
}

/* Finds the exposure of each channel; one that is dark everywhere gets the greatest of the others.
 * Returns whether all channels agree, so that none gets a tint of its own. */
static bool find_exposure(const struct blocks *blocks, bool flat, int exposure[3])
{
    int most = 0;

    for (int c = 0; c < 3; c++) {
        if (!find_channel(blocks, c, flat, &exposure[c]))
            return false;
        most = exposure[c] > most ? exposure[c] : most;
    }
    for (int c = 0; c < 3; c++)
        exposure[c] = exposure[c] ? exposure[c] : most;
    return most > 0;
}

/* The exposure of the channel that differs most from that of the reference. */
static int farthest_of(const int exposure[3])
{
    int most = exposure[0];

    for (int c = 1; c < 3; c++)
        most = abs(exposure[c] - ONE) > abs(most - ONE) ? exposure[c] : most;
    return most;
}

/* A table of the codes that those of a channel become. */
static void make_table(const struct rf_transfer *transfer, uint8_t table[256], int exposure)
{
    for (int code = 0; code < 256; code++) {
        const int light = transfer->to_light[code] * 4 * ONE / exposure;
        const int matched = transfer->to_code[light < RF_MEAN_MAX ? light : RF_MEAN_MAX];
        const int share = code < FADES ? 255 - FADES : 255 - code;

        table[code] = (uint8_t)(code + (matched - code) * share / (255 - FADES));
    }
}

struct change {
    size_t width;
    uint8_t *rgb;
    uint8_t table[3][256];
};

static void change_row(void *context, int y, int worker)
{
    const struct change *change = context;
    uint8_t *at = change->rgb + 3 * change->width * (size_t)y;

    (void)worker;
    for (size_t x = 0; x < change->width; x++, at += 3)
        for (int c = 0; c < 3; c++)
            at[c] = change->table[c][at[c]];
}

/* A frame gets another exposure. */
static void set_exposure(struct refocus_stack *s, struct rf_stack_frame *frame,
                         const int exposure[3])
{
    struct change change = {.width = (size_t)s->width, .rgb = frame->rgb};
    const double most = (double)farthest_of(exposure) / ONE;

    for (int c = 0; c < 3; c++)
        make_table(s->transfer, change.table[c], exposure[c]);
    rf_pool_run(s->pool, change_row, &change, s->height);
    rf_stack_measure(s, frame);
    s->matched++;
    if (fabs(most - 1) > fabs(s->exposure - 1))
        s->exposure = most;
}

static void match(struct refocus_stack *s, struct rf_stack_frame *frame,
                  const struct blocks *blocks)
{
    int exposure[3], same = SAME;

    add_up(s, frame, blocks);
    if (!find_exposure(blocks, true, exposure)) {
        same = ALIKE;
        if (!find_exposure(blocks, false, exposure))
            return;
    }
    if (abs(farthest_of(exposure) - ONE) >= same)
        set_exposure(s, frame, exposure);
}

void rf_stack_match_exposure(struct refocus_stack *s)
{
    const int across = s->width / s->small_by / LEAST_SIDE;
    const int down = s->height / s->small_by / LEAST_SIDE;
    const struct blocks blocks = {.block = (struct block *)(void *)s->sum,
                                  .across = across < ACROSS ? across : ACROSS,
                                  .down = down < ACROSS ? down : ACROSS};

    s->matched = 0;
    s->exposure = 1;
    if (blocks.across * blocks.down < LEAST_BLOCKS)
        return;
    rf_transfer_init(s->transfer, REFOCUS_BLEND_LINEAR);
    for (int k = 0; k < s->count; k++)
        if (k != s->still)
            match(s, &s->frame[k], &blocks);
}
