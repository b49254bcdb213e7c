/* thin.c: which pixels of a tile are mixtures, and of what.
 *
 * Compiled once as plain C and once for each instruction set, with RF_VEC_SET as its name. What
 * all pixels are asked is asked 16 at a time, in a copy of what is around the tile; what is left
 * of them is looked at one by one, eight directions at a time.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

enum {
    JUMP = 65535 / 32, /* disparities this far apart are two surfaces */
    AROUND = 3,        /* what is thin has something far within 7 x 7 pixels */
    THIN = 2 * AROUND + 1,
    WIDE = 2 * THIN,         /* not thin */
    FAR = RF_THIN_REACH,     /* how far what is behind is looked for, */
    CLEAN = 4,               /* and how near it must be not to be taken from the edge itself */
    BEFORE = 2,              /* how far N is looked for */
    ACROSS = 2 * BEFORE + 1,
    FAINT = 12 * 12,         /* squared distance of light that is none */
    SHINES = 4000,           /* lamps, which highlights are for, and what is clipped */
    LEAST = 12,              /* alpha that a far pixel must have */
    WHITE = 4095,
    MARGIN = FAR + 1, /* around a tile */
    SPAN = RF_TILE + 2 * MARGIN,
    ROW = 40,         /* elements of a row of them */
    INNER = SPAN - 2, /* without the first and the last */
    WAYS = 8,
    BATCH = 32,         /* pixels that are looked at together */
    WIDER = RF_TILE + 8, /* compilers unroll loops of 16, and then do not vectorise them */
};

static inline uint16_t max16(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static inline uint16_t min16(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

static inline int clamp(int v, int least, int most)
{
    return v < least ? least : v > most ? most : v;
}

/* The tile and what is around it; pixel (x, y) at [y + MARGIN][x + MARGIN]. */
struct window {
    uint16_t map[SPAN][ROW];        /* 65535 beyond the photo, which is never far */
    uint16_t clean[SPAN][ROW];      /* 65535 of those that are not */
    uint16_t inside[SPAN][ROW];     /* 0 beyond the photo, which is never near */
    uint16_t (*before)[ROW];        /* that, or map */
    uint16_t most[RF_TILE][WIDER], least[RF_TILE][WIDER]; /* of 3 x 3, of 7 x 7 */
    bool bright, asked; /* something may shine; whether that is known */
};

/* Whether disparities of the tile and AROUND it differ by more than a jump; those a little
 * farther are looked at where that is simpler. */
static bool has_jump(const struct rf_thin_tile *t)
{
    const int x0 = -clamp(t->left, 0, AROUND), x1 = clamp(t->right, 0, RF_TILE + AROUND);
    const int y0 = -clamp(t->above, 0, AROUND), y1 = clamp(t->below, 0, RF_TILE + AROUND);
    enum { TWICE = 2 * RF_TILE };
    uint16_t least[TWICE], most[TWICE], low = 65535, high = 0;

    memset(least, 255, sizeof least);
    memset(most, 0, sizeof most);
    for (int y = y0; y < y1; y++) {
        const uint16_t *row = t->disparity + y * t->stride;

        if (x0 == -AROUND && t->right >= TWICE - AROUND) {
            for (int x = 0; x < TWICE; x++) {
                least[x] = min16(least[x], row[x - AROUND]);
                most[x] = max16(most[x], row[x - AROUND]);
            }
            continue;
        }
        for (int x = x0; x < x1; x++) {
            least[x + AROUND] = min16(least[x + AROUND], row[x]);
            most[x + AROUND] = max16(most[x + AROUND], row[x]);
        }
    }
    for (int x = 0; x < TWICE; x++) {
        low = min16(low, least[x]);
        high = max16(high, most[x]);
    }
    return high - low > JUMP;
}

/* Rows and columns beyond the photo repeat its last. */
static void copy_around(struct window *w, const struct rf_thin_tile *t, bool inside)
{
    for (int j = 0; j < SPAN; j++) {
        const int y = clamp(j - MARGIN, -t->above, t->below - 1);
        const uint16_t *row = t->disparity + y * t->stride;

        if (inside) {
            memcpy(w->map[j], row - MARGIN, sizeof w->map[j]);
            continue;
        }
        for (int i = 0; i < ROW; i++)
            w->map[j][i] = row[clamp(i - MARGIN, -t->left, t->right - 1)];
    }
}

/* Passes go over all of the window, so that no load has to wait for parts of what was just stored.
 * `clean`, and the greatest of 3 x 3 pixels. */
static void find_clean(struct window *w)
{
    uint16_t most[SPAN][ROW];

    for (int j = 1; j < SPAN - 1; j++)
        for (int i = 0; i < ROW; i++)
            most[j][i] = max16(w->map[j][i], max16(w->map[j - 1][i], w->map[j + 1][i]));
    for (int j = 1; j < SPAN - 1; j++) {
        const uint16_t *restrict here = most[j], *restrict map = w->map[j] + 1;
        uint16_t *restrict clean = w->clean[j] + 1;

        for (int i = 0; i < INNER; i++) {
            const uint16_t m = max16(here[i], max16(here[i + 1], here[i + 2]));

            clean[i] = (uint16_t)(m - map[i]) > JUMP ? 65535 : map[i];
        }
    }
    for (int y = 0; y < RF_TILE; y++) {
        const uint16_t *restrict here = &most[y + MARGIN][MARGIN];

        for (int x = 0; x < WIDER; x++)
            w->most[y][x] = max16(here[x], max16(here[x - 1], here[x + 1]));
    }
}

static void find_least(struct window *w)
{
    enum { FROM = MARGIN - AROUND, COLUMNS = 32 };
    uint16_t column[RF_TILE][COLUMNS];

    for (int y = 0; y < RF_TILE; y++) {
        for (int i = 0; i < COLUMNS; i++) {
            uint16_t least = w->map[FROM + y][FROM + i];

            for (int j = 1; j < THIN; j++)
                least = min16(least, w->map[FROM + y + j][FROM + i]);
            column[y][i] = least;
        }
    }
    for (int y = 0; y < RF_TILE; y++) {
        for (int x = 0; x < WIDER; x++) {
            uint16_t least = column[y][x];

            for (int k = 1; k < THIN; k++)
                least = min16(least, column[y][x + k]);
            w->least[y][x] = least;
        }
    }
}

static void mark_beyond(struct window *w, const struct rf_thin_tile *t)
{
    memcpy(w->inside, w->map, sizeof w->map);
    for (int j = 0; j < SPAN; j++) {
        for (int i = 0; i < ROW; i++) {
            const int x = i - MARGIN, y = j - MARGIN;

            if (x >= -t->left && x < t->right && y >= -t->above && y < t->below)
                continue;
            w->map[j][i] = w->clean[j][i] = 65535;
            w->inside[j][i] = 0;
        }
    }
}

static void open_window(struct window *w, const struct rf_thin_tile *t)
{
    const bool inside = t->left >= MARGIN && t->above >= MARGIN &&
                        t->right >= ROW - MARGIN && t->below >= SPAN - MARGIN;

    copy_around(w, t, inside);
    find_clean(w);
    find_least(w);
    if (!inside)
        mark_beyond(w, t);
    w->before = inside ? w->map : w->inside;
}

/* A row of a tile, pixel by pixel. */
struct row {
    uint16_t level[RF_TILE];
    uint16_t kept[RF_TILE], look[RF_TILE], thin[RF_TILE]; /* masks */
    uint16_t width[RF_TILE];
    uint16_t near[WAYS][RF_TILE];   /* steps to the first far pixel, less one; FAR: none */
    uint16_t beside[WAYS][RF_TILE]; /* the same from the first step on, up to THIN + 1 */
    uint16_t unclean[WAYS][RF_TILE]; /* as near[], to the first that is clean */
};

static const int8_t way[WAYS][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                    {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};

static ptrdiff_t step_of(int i)
{
    return way[i][1] * ROW + way[i][0];
}

static bool any_of(const uint16_t mask[BATCH])
{
    uint16_t any = 0;

    for (int x = 0; x < BATCH; x++)
        any |= mask[x];
    return any != 0;
}

/* A bit for each pixel of a row. */
static unsigned bits_of(const uint16_t mask[RF_TILE])
{
    static const uint16_t bit[RF_TILE] = {1,   2,   4,    8,    16,   32,   64,    128,
                                          256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
    uint16_t bits = 0;

    for (int x = 0; x < RF_TILE; x++)
        bits |= mask[x] & bit[x];
    return bits;
}

/* Which are looked at. */
static unsigned find_level(struct row *row, const struct window *w, int y, int columns)
{
    const uint16_t *restrict own = &w->map[y + MARGIN][MARGIN];

    for (int x = 0; x < RF_TILE; x++) {
        const uint16_t kept = (uint16_t)(w->most[y][x] - own[x]) <= JUMP ? 0xffff : 0;
        const uint16_t thin = (uint16_t)(own[x] - w->least[y][x]) > JUMP ? 0xffff : 0;

        row->kept[x] = kept;
        row->look[x] = (uint16_t)(~kept | thin);
        row->level[x] = (uint16_t)(kept ? own[x] - JUMP : own[x] + JUMP);
    }
    return bits_of(row->look) & ((1u << columns) - 1);
}

/* Steps before the first that is at most the level; the same but for the first step, up to
 * THIN + 1 of them. */
static inline void count_near(uint16_t *restrict near, uint16_t *restrict beside,
                              const uint16_t *restrict at, ptrdiff_t step,
                              const uint16_t *restrict level)
{
    for (int x = 0; x < RF_TILE; x++) {
        const uint16_t l = level[x];
        uint16_t all = 0xffff, later = 0xffff, n = 0, m = 0;

#define IS_NEAR(k) (uint16_t)(at[(k) * step + x] > l ? 0xffff : 0)
#define COUNT(k)                                                                         \
    do {                                                                                 \
        const uint16_t near_ = IS_NEAR(k);                                               \
        all &= near_;                                                                    \
        later &= near_;                                                                  \
        n = (uint16_t)(n - all);                                                         \
        m = (uint16_t)(m - later);                                                       \
    } while (0)
        all &= IS_NEAR(1);
        n = (uint16_t)(n - all);
        COUNT(2);
        COUNT(3);
        COUNT(4);
        COUNT(5);
        COUNT(6);
        COUNT(7);
        COUNT(8);
        COUNT(9);
        all &= IS_NEAR(10);
        n = (uint16_t)(n - all);
        near[x] = n;
        beside[x] = m;
    }
}

static inline void count_unclean(uint16_t *restrict unclean, const uint16_t *restrict at,
                                 ptrdiff_t step, const uint16_t *restrict level)
{
    for (int x = 0; x < RF_TILE; x++) {
        const uint16_t l = level[x];
        uint16_t all = 0xffff, n = 0;

#define COUNT_ONE(k)                                                                     \
    do {                                                                                 \
        all &= IS_NEAR(k);                                                               \
        n = (uint16_t)(n - all);                                                         \
    } while (0)
        COUNT_ONE(1);
        COUNT_ONE(2);
        COUNT_ONE(3);
        COUNT_ONE(4);
        COUNT_ONE(5);
        COUNT_ONE(6);
        COUNT_ONE(7);
        COUNT_ONE(8);
        COUNT_ONE(9);
        COUNT_ONE(10);
        unclean[x] = n;
    }
}

/* Which are thin, or beside what is. */
static unsigned find_width(struct row *row)
{
    for (int x = 0; x < RF_TILE; x++) {
        uint16_t own = WIDE, other = WIDE, width;

        for (int i = 0; i < WAYS; i += 2)
            own = min16(own, (uint16_t)(row->near[i][x] + row->near[i + 1][x] + 1));
        for (int i = 0; i < WAYS; i++) {
            const uint16_t here = row->near[i][x] ? row->near[i][x] : row->beside[i][x];

            other = min16(other, here ? here : WIDE);
        }
        width = row->kept[x] ? own : other;
        row->width[x] = width;
        row->thin[x] = width <= THIN ? 0xffff : 0;
    }
    return bits_of(row->thin);
}

/* Steps to what is met. A hair of one pixel has nothing clean beside it that is as like what it
 * hides. */
static void choose_steps(struct row *row)
{
    for (int x = 0; x < RF_TILE; x++) {
        uint16_t nearest = FAR, plain;

        for (int i = 0; i < WAYS; i++)
            nearest = min16(nearest, row->unclean[i][x]);
        plain = row->width[x] == 1 || nearest >= CLEAN ? 0xffff : 0;
        for (int i = 0; i < WAYS; i++)
            row->unclean[i][x] = (uint16_t)((row->near[i][x] & plain) |
                                            (row->unclean[i][x] & ~plain));
    }
}

/* A bit for each pixel that is to be looked at more closely. */
static unsigned look_at_row(struct row *row, const struct window *w, int y, int columns)
{
    unsigned look = find_level(row, w, y, columns);

    if (!look)
        return 0;
    for (int i = 0; i < WAYS; i++)
        count_near(row->near[i], row->beside[i], &w->map[y + MARGIN][MARGIN], step_of(i),
                   row->level);
    look &= find_width(row);
    if (!look)
        return 0;
    for (int i = 0; i < WAYS; i++)
        count_unclean(row->unclean[i], &w->clean[y + MARGIN][MARGIN], step_of(i), row->level);
    choose_steps(row);
    return look;
}

/* Pixels, and what is met in all directions, and how much each counts: by the inverse square of
 * its distance. Those beyond `count` meet nothing. */
struct batch {
    int count;
    uint8_t at[BATCH]; /* 16 y + x */
    uint16_t kept[BATCH], level[BATCH], own[BATCH]; /* disparity */
    uint16_t light[3][BATCH];                       /* C */
    uint16_t weight[WAYS][BATCH], disparity[WAYS][BATCH], met[3][WAYS][BATCH];
};

/* By steps less one of the two kinds of directions: weights, */
#define SQUARES(of) {of(1), of(4), of(9), of(16), of(25), of(36), of(49), of(64), of(81), of(100), 0}
#define STRAIGHT(square) 1440 / (square)
#define SLANTED(square)  1440 / (2 * (square))
static const uint16_t weight_of[2][FAR + 1] = {SQUARES(STRAIGHT), SQUARES(SLANTED)};

/* and where what is met lies in rows of some stride. */
static void find_places(int32_t place[WAYS][FAR + 1], ptrdiff_t stride)
{
    for (int i = 0; i < WAYS; i++) {
        for (int n = 0; n < FAR; n++)
            place[i][n] = (int32_t)((n + 1) * (way[i][1] * stride + way[i][0]));
        place[i][FAR] = 0;
    }
}

struct places {
    int32_t window[WAYS][FAR + 1], tile[WAYS][FAR + 1];
};

static void add_pixel(struct batch *b, const struct row *row, const struct rf_thin_tile *t,
                      const struct window *w, const struct places *places, int x, int y)
{
    const ptrdiff_t at = y * t->stride + x;
    const uint16_t *const map = &w->map[y + MARGIN][x + MARGIN];
    const uint16_t *const red = t->light[0] + at, *const green = t->light[1] + at,
                          *const blue = t->light[2] + at;
    const int k = b->count++;

    b->at[k] = (uint8_t)(y * RF_TILE + x);
    b->kept[k] = row->kept[x];
    b->level[k] = row->level[x];
    b->own[k] = *map;
    b->light[0][k] = *red;
    b->light[1][k] = *green;
    b->light[2][k] = *blue;
    for (int i = 0; i < WAYS; i++) {
        const unsigned n = row->unclean[i][x];
        const ptrdiff_t to = places->tile[i][n];

        b->weight[i][k] = weight_of[i >= 4][n];
        b->disparity[i][k] = map[places->window[i][n]];
        b->met[0][i][k] = red[to];
        b->met[1][i][k] = green[to];
        b->met[2][i][k] = blue[to];
    }
}

static inline uint16_t is_there(uint16_t weight)
{
    return (uint16_t)-(weight != 0);
}

/* 0xffff: of one surface. */
static inline uint16_t same_surface(uint16_t a, uint16_t b)
{
    return (uint16_t)(max16(a, b) - min16(a, b)) <= 2 * JUMP ? 0xffff : 0;
}

/* What was found of them. */
struct mixture {
    uint16_t far[BATCH];  /* disparity of F */
    uint16_t near[BATCH]; /* nearest of N, 0: there is none */
    int32_t mixed[BATCH]; /* C is not F's own */
    int32_t behind[3][BATCH], before[3][BATCH]; /* F, N */
    int32_t alpha[BATCH];
};

static void add_same(uint16_t *restrict sum, const uint16_t *restrict weight,
                     const uint16_t *restrict a, const uint16_t *restrict b)
{
    for (int x = 0; x < BATCH; x++)
        sum[x] = (uint16_t)(sum[x] + (weight[x] & same_surface(a[x], b[x])));
}

/* Disparities that have weight, and of whose surface the sum is. */
static void prefer(uint16_t *restrict best, uint16_t *restrict best_sum,
                   const uint16_t *restrict disparity, const uint16_t *restrict weight,
                   const uint16_t *restrict sum)
{
    for (int x = 0; x < BATCH; x++) {
        const uint16_t own = sum[x] & is_there(weight[x]);
        const uint16_t more = own > best_sum[x] ? 0xffff : 0;
        const uint16_t equal = own == best_sum[x] ? 0xffff : 0;
        const uint16_t farther = disparity[x] < best[x] ? 0xffff : 0;
        const uint16_t better = more | (equal & farther);

        best_sum[x] = max16(best_sum[x], own);
        best[x] = (uint16_t)((disparity[x] & better) | (best[x] & ~better));
    }
}

/* The disparity whose surface counts most, the farther of two equals. */
static void find_surface(struct mixture *m, const struct batch *b)
{
    uint16_t several[BATCH], best_sum[BATCH] = {0};

    for (int x = 0; x < BATCH; x++) {
        uint16_t least = 65535, most = 0;

        for (int i = 0; i < WAYS; i++) {
            const uint16_t there = is_there(b->weight[i][x]);

            least = min16(least, (uint16_t)(b->disparity[i][x] | ~there));
            most = max16(most, b->disparity[i][x] & there);
        }
        m->far[x] = least; /* where it is but one */
        several[x] = (uint16_t)(most > least ? ~same_surface(most, least) : 0);
    }
    if (!any_of(several))
        return;
    for (int i = 0; i < WAYS; i++) {
        uint16_t sum[BATCH] = {0};

        for (int k = 0; k < WAYS; k++)
            add_same(sum, b->weight[k], b->disparity[k], b->disparity[i]);
        prefer(m->far, best_sum, b->disparity[i], b->weight[i], sum);
    }
}

/* sum / by, rounded down, for what is below 2^13 and by < 2^30: `real` is sum, as it is in single
 * precision, which is off by so little that the quotient is by less than 1; so its sign and
 * size tell of a sum of 32 bits, whatever is above them, which one it is. */
static inline int32_t quotient(float real, uint32_t sum, uint32_t by)
{
    const int32_t q = (int32_t)(real / (float)(int32_t)by);
    const int32_t left = (int32_t)(sum - (uint32_t)q * by);

    return q + (left < 0 ? -1 : 0) + (left >= (int32_t)by ? 1 : 0);
}

static void add_product(uint32_t *restrict sum, const uint16_t *restrict weight,
                        const uint16_t *restrict light)
{
    for (int x = 0; x < BATCH; x++)
        sum[x] += (uint32_t)weight[x] * light[x];
}

static void add_square(int32_t *restrict sum, const uint16_t *restrict weight,
                       const uint16_t *restrict light, const int32_t *restrict from)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t away = (light[x] - from[x]) & -(weight[x] != 0);

        sum[x] += away * away;
    }
}

/* Weights of one surface, and how many there are. */
static void keep_surface(struct batch *restrict b, const uint16_t *restrict far,
                         uint16_t *restrict weights, uint16_t *restrict count)
{
    for (int i = 0; i < WAYS; i++) {
        uint16_t *restrict weight = b->weight[i];
        const uint16_t *restrict disparity = b->disparity[i];

        for (int x = 0; x < BATCH; x++) {
            const uint16_t w = weight[x] & same_surface(disparity[x], far[x]);

            weight[x] = w;
            weights[x] = (uint16_t)(weights[x] + w);
            count[x] = (uint16_t)(count[x] - is_there(w));
        }
    }
}

static void mean_by_weight(int32_t *restrict mean, const uint32_t *restrict sum,
                           const uint16_t *restrict weights)
{
    for (int x = 0; x < BATCH; x++) {
        const uint32_t by = weights[x] ? weights[x] : 1, all = sum[x] + by / 2;

        mean[x] = quotient((float)(int32_t)all, all, by);
    }
}

/* contrast >= 2 (squares / count) + FAINT */
static void compare(int32_t *restrict mixed, const int32_t *restrict contrast,
                    const int32_t *restrict squares, const uint16_t *restrict count)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t half = (contrast[x] - FAINT) >> 1;

        mixed[x] = squares[x] < (half + 1) * count[x] ? contrast[x] >= FAINT : 0;
    }
}

/* F from what is met, and whether C is so far from it that it is not F's own. */
static void set_far(struct mixture *m, struct batch *b)
{
    uint16_t weights[BATCH] = {0}, count[BATCH] = {0}, one[BATCH];
    int32_t squares[BATCH] = {0}, contrast[BATCH] = {0};

    memset(one, 255, sizeof one);
    keep_surface(b, m->far, weights, count);
    for (int c = 0; c < 3; c++) {
        uint32_t sum[BATCH] = {0};

        for (int i = 0; i < WAYS; i++)
            add_product(sum, b->weight[i], b->met[c][i]);
        mean_by_weight(m->behind[c], sum, weights);
        for (int i = 0; i < WAYS; i++)
            add_square(squares, b->weight[i], b->met[c][i], m->behind[c]);
        add_square(contrast, one, b->light[c], m->behind[c]);
    }
    compare(m->mixed, contrast, squares, count);
}

/* The near pixels around one, TAPS of them; others are 0. */
enum { TAPS = 32 };

struct taps {
    uint16_t near[TAPS], light[3][TAPS];
};

static void gather(struct taps *taps, const struct batch *b, int k,
                   const struct rf_thin_tile *t, const struct window *w)
{
    const int x = b->at[k] % RF_TILE, y = b->at[k] / RF_TILE;

    for (int j = 0; j < ACROSS; j++) { /* each a little longer than it is */
        const uint16_t *const map = &w->before[y + j - BEFORE + MARGIN][x - BEFORE + MARGIN];
        const ptrdiff_t at = (y + j - BEFORE) * t->stride + x - BEFORE;

        memcpy(taps->near + ACROSS * j, map, 16);
        for (int c = 0; c < 3; c++)
            memcpy(taps->light[c] + ACROSS * j, t->light[c] + at, 16);
    }
    memset(taps->near + ACROSS * ACROSS, 0, sizeof taps->near - ACROSS * ACROSS * 2);
    for (int c = 0; c < 3; c++)
        memset(taps->light[c] + ACROSS * ACROSS, 0,
               sizeof taps->light[c] - ACROSS * ACROSS * 2);
}

struct sums {
    uint16_t most[BATCH];
    uint32_t weights[BATCH], high[3][BATCH], low[3][BATCH];
};

static inline int32_t dot(const int16_t *restrict weight, const uint16_t *restrict light)
{
    int32_t sum = 0;

    for (int i = 0; i < TAPS; i++)
        sum += weight[i] * (int16_t)light[i];
    return sum;
}

static void add_taps(struct sums *restrict sums, int k, const struct taps *restrict taps,
                     uint16_t level, const uint16_t behind[3])
{
    const uint16_t red = behind[0], green = behind[1], blue = behind[2];
    int16_t high[TAPS], low[TAPS]; /* weights, 10 bits each */
    uint32_t weights = 0;
    uint16_t most = 0;

    for (int i = 0; i < TAPS; i++)
        most = max16(most, taps->near[i]);
    for (int i = 0; i < TAPS; i++) {
        const int16_t r = (int16_t)(taps->light[0][i] - red);
        const int16_t g = (int16_t)(taps->light[1][i] - green);
        const int16_t b = (int16_t)(taps->light[2][i] - blue);
        const uint32_t near = taps->near[i] > level ? UINT32_MAX : 0;
        const uint32_t weight = (((uint32_t)(r * r) >> 6) + ((uint32_t)(g * g) >> 6) +
                                 ((uint32_t)(b * b) >> 6) + 1) & near;

        weights += weight;
        high[i] = (int16_t)(weight >> 10);
        low[i] = (int16_t)(weight & 1023);
    }
    sums->most[k] = most > level ? most : 0;
    sums->weights[k] = weights;
    for (int c = 0; c < 3; c++) {
        sums->high[c][k] = (uint32_t)dot(high, taps->light[c]);
        sums->low[c][k] = (uint32_t)dot(low, taps->light[c]);
    }
}

/* Whether anything in a tile and around it shines, or may. */
static bool is_bright(const struct rf_thin_tile *t)
{
    uint16_t most[WIDER] = {0}, all = 0;

    if (t->left < BEFORE || t->right < WIDER - BEFORE)
        return true;
    for (int y = t->above < BEFORE ? 0 : -BEFORE; y < RF_TILE + BEFORE && y < t->below; y++) {
        for (int c = 0; c < 3; c++) {
            const uint16_t *restrict light = t->light[c] + y * t->stride - BEFORE;

            for (int x = 0; x < WIDER; x++)
                most[x] = max16(most[x], light[x]);
        }
    }
    for (int x = 0; x < WIDER; x++)
        all = max16(all, most[x]);
    return all > SHINES;
}

static bool may_shine(struct window *w, const struct rf_thin_tile *t)
{
    if (!w->asked)
        w->bright = is_bright(t);
    w->asked = true;
    return w->bright;
}

/* N, and the nearest disparity of it. What is kept and not mixed needs only the latter, and to
 * know whether N shines. */
static void set_near(struct mixture *m, const struct batch *b, const struct rf_thin_tile *t,
                     struct window *w)
{
    struct taps taps[BATCH];
    struct sums sums;
    uint8_t wanted[BATCH];
    int count = 0;

    memset(&sums, 0, sizeof sums);
    for (int k = 0; k < b->count; k++) {
        wanted[count] = (uint8_t)k;
        count += m->mixed[k] || (b->kept[k] && may_shine(w, t));
        sums.most[k] = b->kept[k] ? b->own[k] : 0;
    }
    for (int i = 0; i < count; i++)
        gather(&taps[i], b, wanted[i], t, w);
    for (int i = 0; i < count; i++) {
        const int k = wanted[i];

        add_taps(&sums, k, &taps[i], b->level[k],
                 (const uint16_t[3]){(uint16_t)m->behind[0][k], (uint16_t)m->behind[1][k],
                                     (uint16_t)m->behind[2][k]});
    }
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < BATCH; k++) {
            const uint32_t by = sums.weights[k] + (sums.weights[k] == 0);
            const uint32_t high = sums.high[c][k], low = sums.low[c][k];
            const float real = (float)(int32_t)high * 1024 + (float)(int32_t)low +
                               (float)(int32_t)(by / 2);

            m->before[c][k] = quotient(real, (high << 10) + low + by / 2, by);
        }
    }
    memcpy(m->near, sums.most, sizeof m->near);
}

static void add_share(int32_t *restrict along, int32_t *restrict square,
                      const uint16_t *restrict light, const int32_t *restrict behind,
                      const int32_t *restrict before)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t whole = before[x] - behind[x];

        along[x] += whole * (light[x] - behind[x]);
        square[x] += whole * whole;
    }
}

static void divide_share(int32_t *restrict alpha, const int32_t *restrict along,
                         const int32_t *restrict square)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t all = square[x], some = along[x] & ~(along[x] >> 31);
        const int32_t part = some < all ? some : all;

        alpha[x] = quotient(255 * (float)part, 255 * (uint32_t)part,
                            (uint32_t)(all + (all == 0)));
    }
}

/* No less than makes N black or white. */
static void keep_range(int32_t *restrict alpha, const uint16_t *restrict light,
                       const int32_t *restrict behind)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t off = light[x] - behind[x];
        const int32_t part = 255 * (off < 0 ? -off : off);
        const int32_t whole = off < 0 ? behind[x] : WHITE - behind[x];
        const int32_t room = whole > 0 ? whole : 1;
        const int32_t most = part + room - 1;
        const int32_t least = quotient((float)most, (uint32_t)most, (uint32_t)room);

        alpha[x] = least > alpha[x] ? least : alpha[x];
    }
}

/* alpha, Q8: the share of N - F. */
static void set_alpha(struct mixture *m, const struct batch *b)
{
    int32_t along[BATCH] = {0}, square[BATCH] = {0};

    for (int c = 0; c < 3; c++)
        add_share(along, square, b->light[c], m->behind[c], m->before[c]);
    divide_share(m->alpha, along, square);
    for (int c = 0; c < 3; c++)
        keep_range(m->alpha, b->light[c], m->behind[c]);
    for (int x = 0; x < BATCH; x++) {
        const int32_t alpha = m->alpha[x] < 255 ? m->alpha[x] : 255;

        m->alpha[x] = along[x] > 0 && square[x] >= FAINT * 16 ? alpha : 0;
    }
}

static bool shines(const struct batch *b, const struct mixture *m, int k)
{
    for (int c = 0; c < 3; c++)
        if (b->light[c][k] > SHINES || m->before[c][k] > SHINES)
            return true;
    return false;
}

/* Those that are of something thin, or beside it and a mixture. The batch is empty then. */
static int take_apart(struct rf_thin *out, int most, struct batch *b,
                      const struct rf_thin_tile *t, struct window *w)
{
    struct mixture m;
    int count = 0;

    if (b->count == 0)
        return 0;
    find_surface(&m, b);
    set_far(&m, b);
    set_near(&m, b, t, w);
    set_alpha(&m, b);
    for (int k = 0; k < b->count && count < most; k++) {
        const bool kept = b->kept[k], mixed = m.mixed[k];

        if (!m.near[k] || (!kept && (m.alpha[k] < LEAST || !mixed)) || shines(b, &m, k))
            continue;
        out[count++] = (struct rf_thin){
            .at = b->at[k],
            .alpha = (uint8_t)(mixed && m.alpha[k] ? m.alpha[k] : 255), /* it may be anything */
            .near_disparity = kept ? b->own[k] : m.near[k],
            .far_disparity = m.far[k],
            .light = {(uint16_t)m.behind[0][k], (uint16_t)m.behind[1][k],
                      (uint16_t)m.behind[2][k]}};
    }
    memset(b->weight, 0, sizeof b->weight);
    b->count = 0;
    return count;
}

static int RF_VEC(rf_find_thin)(struct rf_thin *out, const struct rf_thin_tile *tile, int most)
{
    const int rows = clamp(tile->below, 0, RF_TILE), columns = clamp(tile->right, 0, RF_TILE);
    struct window w;
    struct places places;
    struct batch batch;
    int count = 0;

    if (!has_jump(tile))
        return 0;
    open_window(&w, tile);
    find_places(places.window, ROW);
    find_places(places.tile, tile->stride);
    memset(&batch, 0, sizeof batch);
    w.asked = false;
    for (int y = 0; y < rows; y++) {
        struct row row;

        for (unsigned look = look_at_row(&row, &w, y, columns); look; look &= look - 1) {
            add_pixel(&batch, &row, tile, &w, &places, __builtin_ctz(look), y);
            if (batch.count == BATCH)
                count += take_apart(out + count, most - count, &batch, tile, &w);
        }
    }
    return count + take_apart(out + count, most - count, &batch, tile, &w);
}

void RF_VEC(rf_thin_use)(struct rf_kernels *kernels)
{
    kernels->find_thin = RF_VEC(rf_find_thin);
}
