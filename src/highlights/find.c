/* find.c: which clipped pixels hang together (highlights.h).
 *
 * Bits of cells with clipped pixels are kept for so many rows as a lamp is high at most, and some
 * before. A row after the other, what hangs together below its topmost row is filled in words of
 * 64 columns; it is looked at as a whole, and its bits are cleared, lamp or not. What is left
 * belongs to something larger, of which cells are looked at one by one.
 */
#include "highlights/highlights.h"

#include <stdbool.h>
#include <string.h>

#include "highlights/lamps.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "support/compare.h"

enum {
    MOST = RF_LAMP_SIDE,
    FULL = 12,                /* cells on each side that tell what is wide */
    BEFORE = 7,               /* rows; no tube is higher */
    ROWS = BEFORE + MOST + 1, /* of bits: 32, which fit the scratch of a worker */
    SEED = 28,                /* column of a word that the first cell of a shape is in */
    PAD = 4,                  /* words of 16 bits before and after a row */
};

struct search {
    struct rf_lamp_search lamps;
    uint16_t *bits;   /* ROWS rows of `words`: that of row y is y % ROWS */
    int words, ready; /* rows before that have their bits */
};

static uint16_t *bits_of(const struct search *s, int y)
{
    return s->bits + (ptrdiff_t)((y + ROWS) % ROWS) * s->words + PAD; /* y >= -BEFORE */
}

/* 64 cells of a row, which reaches 64 beyond the sides. */
static uint64_t word_at(const uint16_t *bits, int x)
{
    const int first = (x + 64) / 16 - PAD, off = x & 15;
    uint64_t word = (uint64_t)bits[first] >> off;

    for (int i = 1; i < 5; i++)
        word |= (off || i < 4) ? (uint64_t)bits[first + i] << (16 * i - off) : 0;
    return word;
}

/* Whether any of n pixels of a row may be clipped. */
static bool may_be_clipped(const struct search *s, int x, int y, int n)
{
    const struct rf_lamp_photo *p = &s->lamps.photo;
    const ptrdiff_t at = y * p->stride + x;

    return !p->light || s->lamps.r->exec.kernels->brightest(p->light[0] + at, p->light[1] + at,
                                                            p->light[2] + at, n) > RF_CLIPPED;
}

/* Which of n pixels of a row are, n at most 64: a bit each. */
static uint64_t clipped_in(const struct rf_lamp_photo *p, int x, int y, int n)
{
    uint8_t clipped[64];
    uint64_t bits = 0;

    if (p->light) {
        const ptrdiff_t at = y * p->stride + x;
        const uint16_t *r = p->light[0] + at, *g = p->light[1] + at, *b = p->light[2] + at;

        for (int i = 0; i < n; i++)
            clipped[i] = (r[i] > RF_CLIPPED) | (g[i] > RF_CLIPPED) | (b[i] > RF_CLIPPED);
    } else {
        for (int i = 0; i < n; i++)
            clipped[i] = rf_is_clipped(p, x + i, y);
    }
    for (int i = 0; i < n; i++)
        bits |= (uint64_t)clipped[i] << i;
    return bits;
}

/* Set those of a row of pixels. Few runs hold any; no cell is of two. */
static void add_bits(const struct search *s, uint16_t *bits, int y)
{
    enum { RUN = 64 };
    const struct rf_lamp_photo *p = &s->lamps.photo;
    const int cell = p->cell;
    const uint64_t first = UINT64_MAX >> (RUN - cell); /* of the pixels of a cell */

    if (!may_be_clipped(s, 0, y, p->width))
        return;
    for (int x = 0; x < p->width; x += RUN) {
        const int n = rf_smaller(p->width - x, RUN);
        uint64_t clipped = may_be_clipped(s, x, y, n) ? clipped_in(p, x, y, n) : 0;

        while (clipped) {
            const int i = __builtin_ctzll(clipped) / cell, at = x / cell + i;

            bits[at / 16] |= (uint16_t)(1 << at % 16);
            clipped &= ~(first << i * cell);
        }
    }
}

/* Bits of row y; beyond the picture nothing is clipped. */
static void make_bits(const struct search *s, int y)
{
    const struct rf_lamp_photo *p = &s->lamps.photo;
    uint16_t *bits = bits_of(s, y);

    memset(bits - PAD, 0, (size_t)s->words * sizeof *bits);
    for (int i = y * p->cell; y >= 0 && i < (y + 1) * p->cell && i < p->height; i++)
        add_bits(s, bits, i);
}

/* All of the runs of `among` that bits of `seeds` lie in, both of one row. */
static uint64_t fill(uint64_t seeds, uint64_t among)
{
    uint64_t right = among, left = among;

    seeds &= among;
    for (int step = 1; step < 64; step *= 2) {
        seeds |= (right & seeds << step) | (left & seeds >> step);
        right &= right << step;
        left &= left >> step;
    }
    return seeds;
}

/* With those on either side. */
static uint64_t grown(uint64_t row)
{
    return row | row << 1 | row >> 1;
}

/* What hangs together with the run that begins at (x, y), the topmost row of it. False: it is
 * higher or wider than lamps are, or has a part farther up. */
static bool take_shape(const struct search *s, int x, int y, struct rf_lamp_shape *shape)
{
    uint64_t among[MOST + 1], all = 0;
    bool changed = true;

    *shape = (struct rf_lamp_shape){.x = x - SEED, .y = y};
    for (int j = 0; j <= MOST; j++)
        among[j] = word_at(bits_of(s, y + j), shape->x);
    shape->row[0] = UINT64_C(1) << SEED;
    while (changed) {
        changed = false;
        for (int j = 0; j <= MOST; j++) {
            const uint64_t above = j > 0 ? shape->row[j - 1] : 0;
            const uint64_t below = j < MOST ? shape->row[j + 1] : 0;
            const uint64_t row = fill(shape->row[j] | grown(above | below), among[j]);

            changed = changed || row != shape->row[j];
            shape->row[j] = row;
        }
        if (shape->row[MOST])
            return false;
    }
    for (int j = 0; j < MOST && shape->row[j]; j++) {
        all |= shape->row[j];
        shape->rows++;
    }
    return 64 - __builtin_clzll(all) - __builtin_ctzll(all) <= MOST &&
           !(grown(shape->row[0]) & word_at(bits_of(s, y - 1), shape->x));
}

static void clear_shape(const struct search *s, const struct rf_lamp_shape *shape)
{
    for (int j = 0; j < shape->rows; j++) {
        uint16_t *bits = bits_of(s, shape->y + j);

        for (uint64_t row = shape->row[j]; row; row &= row - 1) {
            const int x = shape->x + __builtin_ctzll(row);

            bits[x / 16] &= (uint16_t) ~(1 << x % 16);
        }
    }
}

/* From the shapes that begin in a row on. */
static void take_row(struct search *s, int y)
{
    const uint16_t *const bits = bits_of(s, y), *const above = bits_of(s, y - 1);

    for (int x = 0; x < s->lamps.photo.across; x++) {
        const uint64_t word = word_at(bits, x);
        struct rf_lamp_shape shape;
        int length;

        if (!word) {
            x += 63;
            continue;
        }
        x += __builtin_ctzll(word);
        length = __builtin_ctzll(~word_at(bits, x) | UINT64_C(1) << 63);
        if (length <= MOST && !(word_at(above, x - 1) & ((UINT64_C(1) << (length + 2)) - 1)) &&
            take_shape(s, x, y, &shape)) {
            rf_list_shape(&s->lamps, &shape);
            clear_shape(s, &shape);
        }
        x += length; /* where nothing is clipped, or a run goes on */
    }
}

/* Whether most of the 25 cells around (x, y) of its row are clipped. */
static bool is_full(const struct search *s, int x, int y)
{
    const uint64_t around = word_at(bits_of(s, y), x - FULL) << (63 - 2 * FULL);

    return __builtin_popcountll(around) > FULL;
}

/* How many cells from x on are the middle of squares that are clipped wholly, or as good as that;
 * 0: look closer. */
static int inside(const struct search *s, int x, int y)
{
    const uint64_t all = UINT64_MAX;
    const int before = x - FULL;

    return word_at(bits_of(s, y), before) == all &&
                   (word_at(bits_of(s, y - BEFORE), before) == all ||
                    word_at(bits_of(s, y + BEFORE), before) == all)
               ? 64 - 2 * FULL
               : 0;
}

/* What the shapes that begin at a row, or before, have left, but for what is wide and high. */
static void take_rest(struct search *s, int y)
{
    const uint16_t *const bits = bits_of(s, y);

    for (int x = 0; x < s->lamps.photo.across; x++) {
        const uint64_t word = word_at(bits, x);
        int skipped;

        if (!word) {
            x += 63;
            continue;
        }
        x += __builtin_ctzll(word);
        if ((skipped = inside(s, x, y)))
            x += skipped - 1;
        else if (!(is_full(s, x, y) && (is_full(s, x, y - BEFORE) || is_full(s, x, y + BEFORE))))
            rf_list_cell(&s->lamps, x, y);
    }
}

/* In strip mode planes hold parts of it. */
static struct rf_lamp_photo photo_of(const struct refocus_renderer *r)
{
    const struct rf_photo *photo = &r->photo;
    struct rf_lamp_photo p = {
        .width = photo->width,
        .height = photo->height,
        .cell = rf_lamp_cell(photo->width, photo->height),
    };

    p.across = (p.width + p.cell - 1) / p.cell;
    p.down = (p.height + p.cell - 1) / p.cell;
    if (r->in_place.on) {
        p.code = r->in_place.photo.plane[0];
        p.stride = r->in_place.photo.stride[0];
        p.order = rf_order_of(r->in_place.photo.format);
        p.to_light = r->transfer[r->blend].to_light;
    } else {
        p.light = r->light.channel;
        p.stride = r->view.stride;
    }
    return p;
}

/* From where on shapes begin that a row of these, or one that is_full() asks for, is of: what is
 * cleared there is so whichever rows they are. */
void rf_find_highlights(struct refocus_renderer *r, int y0, int y1, uint16_t *scratch)
{
    struct search s = {
        .lamps = {.r = r, photo_of(r), r->photo.highlights, y0, y1, {.count = 0}},
        .bits = scratch,
    };
    const int cell = s.lamps.photo.cell, before = MOST + BEFORE - 1;
    const int first = y0 / cell > before ? y0 / cell - before : 0;

    s.words = s.lamps.photo.across / 16 + 2 * PAD + 2;
    s.ready = first - BEFORE;
    for (int y = first; y * cell < y1; y++) {
        if (rf_cancelled(&r->exec))
            return;
        for (; s.ready <= y + MOST; s.ready++)
            make_bits(&s, s.ready);
        take_row(&s, y);
        if ((y + 1) * cell > y0)
            take_rest(&s, y);
    }
    rf_end_list(&s.lamps);
}
