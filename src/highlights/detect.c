/* detect.c: finds connected clipped pixels, the components that may be highlights.
 *
 * Bits of cells with clipped pixels are kept for as many rows as a component is high at most, and
 * some before. One row after the other, the component below each topmost run of bits is
 * flood-filled in words of 64 columns; it is classified as a whole, and its bits are cleared,
 * highlight or not. What is left belongs to something larger, whose cells are classified one by
 * one.
 */
#include "highlights/highlights.h"

#include <stdbool.h>
#include <string.h>

#include "highlights/detect.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum {
    MOST = RF_COMPONENT_SIDE,
    FULL = 12,                /* cells on each side that tell what is wide */
    BEFORE = 7,               /* rows; no tube is higher */
    ROWS = BEFORE + MOST + 1, /* rows of bits, 32, which fit the scratch of a worker */
    SEED = 28,                /* column of a word that the first cell of a component is in */
    PAD = 4,                  /* words of 16 bits before and after a row */
};

struct search {
    const struct rf_executor *exec;
    struct rf_detection found;
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
    const struct rf_cell_photo *p = &s->found.photo;
    const ptrdiff_t at = y * p->stride + x;

    return !p->light || s->exec->kernels->brightest(p->light[0] + at, p->light[1] + at,
                                                    p->light[2] + at, n) > RF_CLIPPED;
}

/* Returns a bit for each of n pixels of a row, n at most 64: whether it is clipped. */
static uint64_t clipped_in(const struct rf_cell_photo *p, int x, int y, int n)
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

/* Sets the bits of cells that a row of pixels has clipped ones of. Few runs hold any; no cell is in
 * two runs. */
static void add_bits(const struct search *s, uint16_t *bits, int y)
{
    enum { RUN = 64 };
    const struct rf_cell_photo *p = &s->found.photo;
    const int cell = p->cell;
    const uint64_t first = UINT64_MAX >> (RUN - cell); /* bits of the pixels of one cell */

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

/* Makes the bits of row y of cells; beyond the picture nothing is clipped. */
static void make_bits(const struct search *s, int y)
{
    const struct rf_cell_photo *p = &s->found.photo;
    uint16_t *bits = bits_of(s, y);

    memset(bits - PAD, 0, (size_t)s->words * sizeof *bits);
    for (int i = y * p->cell; y >= 0 && i < (y + 1) * p->cell && i < p->height; i++)
        add_bits(s, bits, i);
}

/* Returns all of the runs of `among` that bits of `seeds` lie in, both of one row. */
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

/* The bits of a row with those on either side. */
static uint64_t grown(uint64_t row)
{
    return row | row << 1 | row >> 1;
}

/* The component of the run that begins at (x, y), in its topmost row. False: it is higher or wider
 * than what is classified as a whole, or has a part farther up. */
static bool take_component(const struct search *s, int x, int y, struct rf_component *component)
{
    uint64_t among[MOST + 1], all = 0;
    bool changed = true;

    *component = (struct rf_component){.x = x - SEED, .y = y};
    for (int j = 0; j <= MOST; j++)
        among[j] = word_at(bits_of(s, y + j), component->x);
    component->row[0] = UINT64_C(1) << SEED;
    while (changed) {
        changed = false;
        for (int j = 0; j <= MOST; j++) {
            const uint64_t above = j > 0 ? component->row[j - 1] : 0;
            const uint64_t below = j < MOST ? component->row[j + 1] : 0;
            const uint64_t row = fill(component->row[j] | grown(above | below), among[j]);

            changed = changed || row != component->row[j];
            component->row[j] = row;
        }
        if (component->row[MOST])
            return false;
    }
    for (int j = 0; j < MOST && component->row[j]; j++) {
        all |= component->row[j];
        component->rows++;
    }
    return 64 - __builtin_clzll(all) - __builtin_ctzll(all) <= MOST &&
           !(grown(component->row[0]) & word_at(bits_of(s, y - 1), component->x));
}

static void clear_component(const struct search *s, const struct rf_component *component)
{
    for (int j = 0; j < component->rows; j++) {
        uint16_t *bits = bits_of(s, component->y + j);

        for (uint64_t row = component->row[j]; row; row &= row - 1) {
            const int x = component->x + __builtin_ctzll(row);

            bits[x / 16] &= (uint16_t) ~(1 << x % 16);
        }
    }
}

/* The components whose topmost row this is. */
static void take_row(struct search *s, int y)
{
    const uint16_t *const bits = bits_of(s, y), *const above = bits_of(s, y - 1);

    for (int x = 0; x < s->found.photo.across; x++) {
        const uint64_t word = word_at(bits, x);
        struct rf_component component;
        int length;

        if (!word) {
            x += 63;
            continue;
        }
        x += __builtin_ctzll(word);
        length = __builtin_ctzll(~word_at(bits, x) | UINT64_C(1) << 63);
        if (length <= MOST && !(word_at(above, x - 1) & ((UINT64_C(1) << (length + 2)) - 1)) &&
            take_component(s, x, y, &component)) {
            rf_classify_component(&s->found, &component);
            clear_component(s, &component);
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

/* Cells of a row that no component took, as it belongs to something larger; but not of what is wide
 * and high. */
static void take_rest(struct search *s, int y)
{
    const uint16_t *const bits = bits_of(s, y);

    for (int x = 0; x < s->found.photo.across; x++) {
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
            rf_classify_cell(&s->found, x, y);
    }
}

/* Pixels that a cell is wide and high: 1 in photos up to 1,439 pixels wide or high, 2 up to 2,879,
 * 4 up to 5,759. A power of two, at most 64. */
static int cell_side(int width, int height)
{
    const int longer = rf_larger(width, height);
    int cell = 1;

    while (cell < RF_HIGHLIGHT_ROWS && longer >= 2 * 720 * cell)
        cell *= 2;
    return cell;
}

static struct rf_cell_photo cells_of(const struct rf_photo_source *photo)
{
    struct rf_cell_photo p = {
        .width = photo->width,
        .height = photo->height,
        .cell = cell_side(photo->width, photo->height),
    };

    p.across = (p.width + p.cell - 1) / p.cell;
    p.down = (p.height + p.cell - 1) / p.cell;
    if (rf_has_planes(photo)) {
        p.light = photo->light.channel;
        p.stride = photo->light.stride;
    } else {
        p.code = photo->image->plane[0];
        p.stride = photo->image->stride[0];
        p.order = rf_order_of(photo->image->format);
        p.to_light = photo->transfer->to_light;
    }
    return p;
}

/* Lists the highlights of some rows. A component is cleared, and so removed from the rest,
 * whichever rows are asked for: so it starts where components begin that one of these rows, or one
 * that is_full() asks about, may be part of. */
static void detect_rows(struct search *s)
{
    const int cell = s->found.photo.cell, before = MOST + BEFORE - 1;
    const int y0 = s->found.y0, first = rf_larger(y0 / cell - before, 0);

    s->words = s->found.photo.across / 16 + 2 * PAD + 2;
    s->ready = first - BEFORE;
    for (int y = first; y * cell < s->found.y1; y++) {
        if (rf_cancelled(s->exec))
            return;
        for (; s->ready <= y + MOST; s->ready++)
            make_bits(s, s->ready);
        take_row(s, y);
        if ((y + 1) * cell > y0)
            take_rest(s, y);
    }
    rf_end_run(&s->found);
}

/* All that the threads share. */
struct detect {
    const struct rf_executor *exec;
    struct rf_cell_photo photo;
    struct rf_highlights *highlights;
    int rows; /* rows of a work item */
};

static void detect_item(void *context, int item, int worker)
{
    const struct detect *detect = context;
    const int y0 = item * detect->rows;
    struct search search = {
        .exec = detect->exec,
        .found = {.photo = detect->photo,
                  .highlights = detect->highlights,
                  .y0 = y0,
                  .y1 = rf_smaller(y0 + detect->rows, detect->photo.height)},
        .bits = rf_scratch(detect->exec, worker),
    };

    detect_rows(&search);
}

/* Rows of an item: of whole parts of the lists, and more than a component is high; or, as each item
 * looks at as many again around them, many times that, for a few items to each thread. */
static int rows_of_item(const struct rf_cell_photo *photo, int threads)
{
    enum { EACH = 3 }; /* items for each thread */
    const int rows = RF_HIGHLIGHT_ROWS * photo->cell;
    const int items = threads > 1 ? EACH * threads : 1;

    return rows * ((photo->height + rows * items - 1) / (rows * items));
}

void rf_detect_highlights(const struct rf_executor *exec, const struct rf_photo_source *photo,
                          struct rf_highlights *highlights)
{
    struct detect detect = {.exec = exec, .photo = cells_of(photo), .highlights = highlights};

    detect.rows = rows_of_item(&detect.photo, exec->pool->threads);
    rf_clear_highlights(highlights);
    rf_pool_run(exec->pool, detect_item, &detect, (photo->height + detect.rows - 1) / detect.rows);
    rf_sort_highlights(exec, highlights);
}
