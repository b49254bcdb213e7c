/* thin_row.c: find_thin: finds the pixels of a row on thin structures or beside something near, and
 * the nearest background pixels in eight directions. */
#include "kernels/autovec/thin_parts.h"

static ptrdiff_t step_of(int i)
{
    return way[i][1] * ROW + way[i][0];
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

/* Finds which pixels are looked at, a bit each. */
static unsigned find_level(struct rf_thin_row *row, const struct rf_thin_window *w, int y,
                           int columns)
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

/* 0xffff: step k comes upon what is near. */
#define IS_NEAR(k) (uint16_t)(at[(k)*step + x] > l ? 0xffff : 0)

/* Steps before the first that is at most the level; the same but for the first step, up
 * to THIN + 1 of them. */
static void count_near(uint16_t *restrict near, uint16_t *restrict beside,
                       const uint16_t *restrict at, ptrdiff_t step, const uint16_t *restrict level)
{
#define COUNT(k) all &= IS_NEAR(k), n = (uint16_t)(n - all)
#define COUNT_BOTH(k)                                                                              \
    is = IS_NEAR(k), all &= is, later &= is, n = (uint16_t)(n - all), m = (uint16_t)(m - later)
    for (int x = 0; x < RF_TILE; x++) {
        const uint16_t l = level[x];
        uint16_t is, all = 0xffff, later = 0xffff, n = 0, m = 0;

        COUNT(1);
        COUNT_BOTH(2);
        COUNT_BOTH(3);
        COUNT_BOTH(4);
        COUNT_BOTH(5);
        COUNT_BOTH(6);
        COUNT_BOTH(7);
        COUNT_BOTH(8);
        COUNT_BOTH(9);
        COUNT(10);
        near[x] = n;
        beside[x] = m;
    }
}

static void count_unclean(uint16_t *restrict unclean, const uint16_t *restrict at, ptrdiff_t step,
                          const uint16_t *restrict level)
{
    for (int x = 0; x < RF_TILE; x++) {
        const uint16_t l = level[x];
        uint16_t all = 0xffff, n = 0;

        COUNT(1);
        COUNT(2);
        COUNT(3);
        COUNT(4);
        COUNT(5);
        COUNT(6);
        COUNT(7);
        COUNT(8);
        COUNT(9);
        COUNT(10);
        unclean[x] = n;
    }
}

/* Finds which pixels are thin or beside something near, a bit each. */
static unsigned find_width(struct rf_thin_row *row)
{
    for (int x = 0; x < RF_TILE; x++) {
        uint16_t own = WIDE, other = WIDE, width;

        for (int i = 0; i < WAYS; i += 2)
            own = rf_least16(own, (uint16_t)(row->near[i][x] + row->near[i + 1][x] + 1));
        for (int i = 0; i < WAYS; i++) {
            const uint16_t here = row->near[i][x] ? row->near[i][x] : row->beside[i][x];

            other = rf_least16(other, here ? here : WIDE);
        }
        width = row->kept[x] ? own : other;
        row->width[x] = width;
        row->thin[x] = width <= THIN ? 0xffff : 0;
        row->look[x] = (uint16_t)(row->thin[x] | ~row->kept[x]);
    }
    return bits_of(row->look);
}

/* Counts the steps to what is hit. A hair of one pixel has nothing clean beside it that is as like
 * what it hides. */
static void choose_steps(struct rf_thin_row *row)
{
    for (int x = 0; x < RF_TILE; x++) {
        uint16_t nearest = FAR, plain;

        for (int i = 0; i < WAYS; i++)
            nearest = rf_least16(nearest, row->hit[i][x]);
        plain = row->width[x] == 1 || nearest >= CLEAN ? 0xffff : 0;
        for (int i = 0; i < WAYS; i++)
            row->hit[i][x] = (uint16_t)((row->near[i][x] & plain) | (row->hit[i][x] & ~plain));
    }
}

unsigned RF_VEC(rf_thin_row)(struct rf_thin_row *row, const struct rf_thin_window *w, int y,
                             int columns)
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
        count_unclean(row->hit[i], &w->clean[y + MARGIN][MARGIN], step_of(i), row->level);
    choose_steps(row);
    return look;
}
