/* find.c: which clipped pixels are lamps (highlights.h).
 *
 * Bits of clipped pixels are kept for so many rows as a lamp is high at most, and some before. A
 * row after the other, what hangs together below its topmost row is filled in words of 64 columns;
 * it is looked at as a whole, and its bits are cleared, lamp or not. What is left belongs to
 * something larger, of which pixels are looked at one by one.
 */
#include "highlights/highlights.h"

#include <stdbool.h>
#include <string.h>

#include "highlights/clipped.h"
#include "renderer/bands.h"

enum {
    MOST = RF_LAMP_SIDE,
    AROUND = 12,              /* surroundings: so many pixels on each side, */
    GRID = 3,                 /* every third of them */
    NEAR = 3,                 /* the same of a pixel's rim */
    HALF_LIT = RF_LIGHT_MAX * 40 / 100,
    GAIN = 3,                 /* full gain of 4 adds three times white */
    BEFORE = 7,               /* rows; no tube is higher */
    ROWS = BEFORE + MOST + 1, /* of bits: 32, which fit the scratch of a worker */
    SEED = 28,                /* column of a word that the first pixel of a shape is in */
    PAD = 4,                  /* words of 16 bits before and after a row */
};

struct search {
    const struct refocus_renderer *r;
    struct rf_photo *photo;
    struct rf_rect rect;
    uint16_t *bits; /* ROWS rows of `words`: that of row y is y % ROWS */
    int words, ready; /* rows before that have their bits */
};

/* What hangs together: bit i of row[j] is pixel (x + i, y + j). */
struct shape {
    int x, y, rows;
    uint64_t row[MOST + 1];
};

/* What the lamp may be, and what is around it. */
struct lit {
    int64_t own[3], around[3]; /* mean colours */
    int64_t rim[3];            /* that of its rim beyond its surroundings, added up */
    int edge, half_lit;        /* pixels of its edge, and half lit ones beside it */
};

/* Rec. 709. */
static int64_t luminance(const int64_t colour[3])
{
    return (218 * colour[0] + 732 * colour[1] + 74 * colour[2]) / 1024;
}

static uint16_t *bits_of(const struct search *s, int y)
{
    return s->bits + (ptrdiff_t)((y + ROWS) % ROWS) * s->words + PAD; /* y >= -BEFORE */
}

/* 64 pixels of a row, which reaches 64 beyond the sides. */
static uint64_t word_at(const uint16_t *bits, int x)
{
    const int first = (x + 64) / 16 - PAD, off = x & 15;
    uint64_t word = (uint64_t)bits[first] >> off;

    for (int i = 1; i < 5; i++)
        word |= (off || i < 4) ? (uint64_t)bits[first + i] << (16 * i - off) : 0;
    return word;
}

/* Bits of row y; beyond the picture nothing is clipped. */
static void make_bits(const struct search *s, int y)
{
    const struct refocus_renderer *r = s->r;
    const ptrdiff_t at = y * r->stride;
    uint16_t *bits = bits_of(s, y);

    memset(bits - PAD, 0, (size_t)s->words * sizeof *bits);
    if (y < 0 || y >= r->height ||
        r->kernels.brightest(r->front.light[0] + at, r->front.light[1] + at,
                             r->front.light[2] + at, r->width) <= RF_CLIPPED)
        return;
    for (int x = 0; x < r->width; x++)
        if (rf_brightest_at(r, at + x) > RF_CLIPPED)
            bits[x / 16] |= (uint16_t)(1 << x % 16);
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
static bool take_shape(const struct search *s, int x, int y, struct shape *shape)
{
    uint64_t among[MOST + 1], all = 0;
    bool changed = true;

    *shape = (struct shape){.x = x - SEED, .y = y};
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

static void clear_shape(const struct search *s, const struct shape *shape)
{
    for (int j = 0; j < shape->rows; j++) {
        uint16_t *bits = bits_of(s, shape->y + j);

        for (uint64_t row = shape->row[j]; row; row &= row - 1) {
            const int x = shape->x + __builtin_ctzll(row);

            bits[x / 16] &= (uint16_t)~(1 << x % 16);
        }
    }
}

static bool is_in(const struct shape *shape, int x, int y)
{
    const int i = x - shape->x, j = y - shape->y;

    return i >= 0 && i < 64 && j >= 0 && j < shape->rows && (shape->row[j] >> i & 1);
}

/* Mean colours of a shape and of a sparse grid around it. False: there is nothing around. */
static bool look_around(const struct refocus_renderer *r, const struct shape *shape,
                        struct lit *lit)
{
    uint64_t all = 0;
    int n = 0, count = 0, x0, x1;

    for (int j = 0; j < shape->rows; j++) {
        all |= shape->row[j];
        for (uint64_t row = shape->row[j]; row; row &= row - 1, n++)
            for (int c = 0; c < 3; c++)
                lit->own[c] += r->front.light[c][(shape->y + j) * r->stride + shape->x +
                                                 __builtin_ctzll(row)];
    }
    x0 = shape->x + __builtin_ctzll(all) - AROUND;
    x1 = shape->x + 63 - __builtin_clzll(all) + AROUND;
    for (int y = shape->y - AROUND; y < shape->y + shape->rows + AROUND; y += GRID)
        for (int x = x0; x <= x1; x += GRID) {
            if (x < 0 || y < 0 || x >= r->width || y >= r->height || is_in(shape, x, y))
                continue;
            for (int c = 0; c < 3; c++)
                lit->around[c] += r->front.light[c][y * r->stride + x];
            count++;
        }
    for (int c = 0; c < 3 && count; c++) {
        lit->own[c] /= n;
        lit->around[c] /= count;
    }
    return count > 0;
}

/* Its edge, and the pixels beside it, none of which is clipped. */
static void look_at_rim(const struct refocus_renderer *r, const struct shape *shape,
                        struct lit *lit)
{
    uint64_t wide[MOST + 2] = {0}; /* from a row before it on */

    for (int j = 0; j < shape->rows; j++) {
        const uint64_t own = shape->row[j], above = j > 0 ? shape->row[j - 1] : 0;
        const uint64_t inner = own << 1 & own >> 1 & above & shape->row[j + 1];

        lit->edge += __builtin_popcountll(own & ~inner);
        for (int i = 0; i < 3; i++)
            wide[j + i] |= grown(own);
    }
    for (int j = 0; j < shape->rows + 2; j++) {
        const int y = shape->y + j - 1;
        const uint64_t own = j > 0 ? shape->row[j - 1] : 0;

        for (uint64_t row = wide[j] & ~own; row; row &= row - 1) {
            const int x = shape->x + __builtin_ctzll(row);
            const ptrdiff_t at = y * r->stride + x;

            if (x < 0 || y < 0 || x >= r->width || y >= r->height)
                continue;
            lit->half_lit += rf_brightest_at(r, at) >= HALF_LIT;
            for (int c = 0; c < 3; c++)
                if (r->front.light[c][at] > lit->around[c])
                    lit->rim[c] += r->front.light[c][at] - lit->around[c];
        }
    }
}

/* Q12 light of full strength: the colour of the rim, white if it has none. */
static void added_of(const int64_t rim[3], int added[3])
{
    int64_t most = rim[0] > rim[1] ? rim[0] : rim[1];

    most = rim[2] > most ? rim[2] : most;
    for (int c = 0; c < 3; c++)
        added[c] = GAIN * (int)(most < RF_LIGHT_MAX / 4 ? RF_LIGHT_MAX
                                                        : rim[c] * RF_LIGHT_MAX / most);
}

/*
 * A pixel that is lit in part by a lamp of L times white still clips down to a share of 0.94 / L,
 * and is half lit only from there to 0.4 / L: the brighter, the fewer of the pixels beside the edge
 * are half lit. At L = 1 it is 0.54 of those that are lit in part, of which there are somewhat more
 * than the edge has: never less than 0.6 of the edge. White paint and the shine of rounded things
 * fade out over many.
 */
static int steepness(int edge, int half_lit)
{
    return rf_ramp(100 * edge, 167 * half_lit, 250 * half_lit);
}

/* A channel that is not clipped has lost nothing. */
static void list(const struct search *s, int x, int y, const int added[3], int strength)
{
    const struct refocus_renderer *r = s->r;
    struct rf_highlight lamp = {(uint16_t)(x + r->origin_x), (uint16_t)(y + r->origin_y), {0}, 0};

    for (int c = 0; c < 3; c++)
        lamp.added[c] = (uint16_t)(
            added[c] * strength / 256 *
            rf_ramp(r->front.light[c][y * r->stride + x], RF_CLIPPED, RF_LIGHT_MAX) / 256);
    rf_list_highlight(&s->photo->highlights[lamp.y / RF_LAMP_ROWS], lamp);
}

/* The pixels of a shape that are in the rectangle, if it is a lamp. */
static void list_shape(const struct search *s, const struct shape *shape)
{
    struct lit lit = {0};
    int added[3], strength;

    if (!look_around(s->r, shape, &lit))
        return;
    strength = rf_ramp(luminance(lit.own), 3 * luminance(lit.around), 6 * luminance(lit.around));
    if (!strength)
        return;
    look_at_rim(s->r, shape, &lit);
    strength = strength * steepness(lit.edge, lit.half_lit) / 256;
    if (!strength)
        return;
    added_of(lit.rim, added);
    for (int j = 0; j < shape->rows; j++)
        for (uint64_t row = shape->row[j]; row; row &= row - 1) {
            const int x = shape->x + __builtin_ctzll(row), y = shape->y + j;

            if (x >= s->rect.x0 && x < s->rect.x1 && y >= s->rect.y0 && y < s->rect.y1)
                list(s, x, y, added, strength);
        }
}

/* A pixel of something larger, a tube or a row of lamps: by the squares around it. */
static void list_pixel(const struct search *s, int x, int y)
{
    const struct refocus_renderer *r = s->r;
    struct lit lit = {0};
    int n = 0, clipped = 0, added[3], strength;

    for (int j = -AROUND; j <= AROUND; j += GRID)
        for (int i = -AROUND; i <= AROUND; i += GRID, n++)
            for (int c = 0; c < 3; c++)
                lit.around[c] += r->front.light[c][rf_within(y + j, r->height - 1) * r->stride +
                                                   rf_within(x + i, r->width - 1)];
    for (int c = 0; c < 3; c++) {
        lit.own[c] = r->front.light[c][y * r->stride + x];
        lit.around[c] /= n;
    }
    strength = rf_ramp(luminance(lit.own), 3 * luminance(lit.around), 6 * luminance(lit.around));
    for (int j = -NEAR; strength && j <= NEAR; j++)
        for (int i = -NEAR; i <= NEAR; i++) {
            const ptrdiff_t at =
                rf_within(y + j, r->height - 1) * r->stride + rf_within(x + i, r->width - 1);
            const int b = rf_brightest_at(r, at);

            clipped += b > RF_CLIPPED;
            lit.half_lit += b <= RF_CLIPPED && b >= HALF_LIT;
            for (int c = 0; c < 3; c++)
                if (b <= RF_CLIPPED && r->front.light[c][at] > lit.around[c])
                    lit.rim[c] += r->front.light[c][at] - lit.around[c];
        }
    strength = strength * rf_ramp(clipped, 2 * lit.half_lit, 4 * lit.half_lit) / 256;
    if (!strength)
        return;
    added_of(lit.rim, added);
    list(s, x, y, added, strength);
}

/* From the shapes that begin in a row on. */
static void take_row(const struct search *s, int y)
{
    const uint16_t *const bits = bits_of(s, y), *const above = bits_of(s, y - 1);

    for (int x = 0; x < s->r->width; x++) {
        const uint64_t word = word_at(bits, x);
        struct shape shape;
        int length;

        if (!word) {
            x += 63;
            continue;
        }
        x += __builtin_ctzll(word);
        length = __builtin_ctzll(~word_at(bits, x) | UINT64_C(1) << 63);
        if (length <= MOST && !(word_at(above, x - 1) & ((UINT64_C(1) << (length + 2)) - 1)) &&
            take_shape(s, x, y, &shape)) {
            list_shape(s, &shape);
            clear_shape(s, &shape);
        }
        x += length; /* where nothing is clipped, or a run goes on */
    }
}

/* Whether most of the 25 pixels around (x, y) of its row are clipped. */
static bool is_full(const struct search *s, int x, int y)
{
    const uint64_t around = word_at(bits_of(s, y), x - AROUND) << (63 - 2 * AROUND);

    return __builtin_popcountll(around) > AROUND;
}

/* What the shapes that begin at a row, or before, have left, but for what is wide and high. */
static void take_rest(const struct search *s, int y)
{
    const uint16_t *const bits = bits_of(s, y);

    for (int x = s->rect.x0; x < s->rect.x1; x++) {
        const uint64_t word = word_at(bits, x);

        if (!word) {
            x += 63;
            continue;
        }
        x += __builtin_ctzll(word);
        if (x < s->rect.x1 &&
            !(is_full(s, x, y) && (is_full(s, x, y - BEFORE) || is_full(s, x, y + BEFORE))))
            list_pixel(s, x, y);
    }
}

/* From where on shapes begin that a row of the rectangle, or one that is_full() asks for, is of:
 * what is cleared there is so whichever rectangle it is. */
void rf_find_highlights(struct refocus_renderer *r, struct rf_rect rect, uint16_t *scratch)
{
    const int before = MOST + BEFORE - 1, first = rect.y0 > before ? rect.y0 - before : 0;
    struct search s = {r,       &r->photo[r->used],           rect,
                       scratch, r->width / 16 + 2 * PAD + 2, first - BEFORE};

    for (int y = first; y < rect.y1; y++) {
        if (rf_cancelled(r))
            return;
        for (; s.ready <= y + MOST; s.ready++)
            make_bits(&s, s.ready);
        take_row(&s, y);
        if (y >= rect.y0)
            take_rest(&s, y);
    }
}
