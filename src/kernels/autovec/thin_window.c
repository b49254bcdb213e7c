/* thin_window.c: find_thin: copies the disparities of a tile and of the pixels around it. */
#include "kernels/autovec/thin_parts.h"

#include <string.h>

/* Whether disparities of the tile and AROUND it differ by more than a jump; those a
 * little farther are looked at where that is simpler. */
static bool has_jump(const struct rf_thin_tile *t)
{
    const int x0 = -rf_clamp(t->left, 0, AROUND), x1 = rf_clamp(t->right, 0, RF_TILE + AROUND);
    const int y0 = -rf_clamp(t->above, 0, AROUND), y1 = rf_clamp(t->below, 0, RF_TILE + AROUND);
    enum { TWICE = 2 * RF_TILE };
    uint16_t least[TWICE], most[TWICE], low = 65535, high = 0;

    memset(least, 255, sizeof least);
    memset(most, 0, sizeof most);
    for (int y = y0; y < y1; y++) {
        const uint16_t *row = t->disparity + y * t->stride;

        if (x0 == -AROUND && t->right >= TWICE - AROUND) {
            for (int x = 0; x < TWICE; x++) {
                least[x] = rf_least16(least[x], row[x - AROUND]);
                most[x] = rf_most16(most[x], row[x - AROUND]);
            }
            continue;
        }
        for (int x = x0; x < x1; x++) {
            least[x + AROUND] = rf_least16(least[x + AROUND], row[x]);
            most[x + AROUND] = rf_most16(most[x + AROUND], row[x]);
        }
    }
    for (int x = 0; x < TWICE; x++) {
        low = rf_least16(low, least[x]);
        high = rf_most16(high, most[x]);
    }
    return high - low > JUMP;
}

/* Elements of a window that are of the photo. */
struct part {
    int x0, x1, y0, y1;
};

static struct part part_of(const struct rf_thin_tile *t)
{
    return (struct part){rf_clamp(MARGIN - t->left, 0, MARGIN), rf_clamp(MARGIN + t->right, 0, ROW),
                         rf_clamp(MARGIN - t->above, 0, MARGIN),
                         rf_clamp(MARGIN + t->below, 0, SPAN)};
}

static void fill(uint16_t *row, uint16_t with, int first, int end)
{
    for (int i = first; i < end; i++)
        row[i] = with;
}

/* Repeats the last row or column of the photo beyond its sides. */
static void copy_around(struct rf_thin_window *w, const struct rf_thin_tile *t, struct part p)
{
    for (int j = p.y0; j < p.y1; j++) {
        uint16_t *const row = w->map[j];
        const uint16_t *const from = t->disparity + (j - MARGIN) * t->stride - MARGIN;

        if (p.x1 - p.x0 == ROW) {
            memcpy(row, from, ROW * sizeof *row);
            continue;
        }
        memcpy(row + p.x0, from + p.x0, (size_t)(p.x1 - p.x0) * sizeof *row);
        fill(row, row[p.x0], 0, p.x0);
        fill(row, row[p.x1 - 1], p.x1, ROW);
    }
    for (int j = 0; j < p.y0; j++)
        memcpy(w->map[j], w->map[p.y0], sizeof w->map[j]);
    for (int j = p.y1; j < SPAN; j++)
        memcpy(w->map[j], w->map[p.y1 - 1], sizeof w->map[j]);
}

/* Passes go over all of the window, so that no load has to wait for parts of what was
 * just stored. `clean`, and the greatest of 3 x 3 pixels. */
static void find_clean(struct rf_thin_window *w)
{
    uint16_t most[SPAN][ROW];

    for (int j = 1; j < SPAN - 1; j++)
        for (int i = 0; i < ROW; i++)
            most[j][i] = rf_most16(w->map[j][i], rf_most16(w->map[j - 1][i], w->map[j + 1][i]));
    for (int j = 1; j < SPAN - 1; j++) {
        const uint16_t *restrict here = most[j], *restrict map = w->map[j] + 1;
        uint16_t *restrict clean = w->clean[j] + 1;

        for (int i = 0; i < INNER; i++) {
            const uint16_t m = rf_most16(here[i], rf_most16(here[i + 1], here[i + 2]));

            clean[i] = (uint16_t)(m - map[i]) > JUMP ? 65535 : map[i];
        }
    }
    for (int y = 0; y < RF_TILE; y++) {
        const uint16_t *restrict here = &most[y + MARGIN][MARGIN];

        for (int x = 0; x < WIDER; x++)
            w->most[y][x] = rf_most16(here[x], rf_most16(here[x - 1], here[x + 1]));
    }
}

static void find_least(struct rf_thin_window *w)
{
    enum { FROM = MARGIN - AROUND, COLUMNS = 32 };
    uint16_t column[RF_TILE][COLUMNS];

    for (int y = 0; y < RF_TILE; y++) {
        for (int i = 0; i < COLUMNS; i++) {
            uint16_t least = w->map[FROM + y][FROM + i];

            for (int j = 1; j < THIN; j++)
                least = rf_least16(least, w->map[FROM + y + j][FROM + i]);
            column[y][i] = least;
        }
    }
    for (int y = 0; y < RF_TILE; y++) {
        for (int x = 0; x < WIDER; x++) {
            uint16_t least = column[y][x];

            for (int k = 1; k < THIN; k++)
                least = rf_least16(least, column[y][x + k]);
            w->least[y][x] = least;
        }
    }
}

static void mark_beyond(struct rf_thin_window *w, struct part p)
{
    memcpy(w->inside, w->map, sizeof w->map);
    for (int j = 0; j < SPAN; j++) {
        const bool beyond = j < p.y0 || j >= p.y1;
        const int x0 = beyond ? ROW : p.x0, x1 = beyond ? ROW : p.x1;

        fill(w->map[j], 65535, 0, x0);
        fill(w->map[j], 65535, x1, ROW);
        fill(w->clean[j], 65535, 0, x0);
        fill(w->clean[j], 65535, x1, ROW);
        fill(w->inside[j], 0, 0, x0);
        fill(w->inside[j], 0, x1, ROW);
    }
}

bool RF_VEC(rf_thin_window)(struct rf_thin_window *w, const struct rf_thin_tile *t)
{
    const struct part part = part_of(t);
    const bool inside = part.x1 - part.x0 == ROW && part.y1 - part.y0 == SPAN;

    if (!has_jump(t))
        return false;
    copy_around(w, t, part);
    find_clean(w);
    find_least(w);
    if (!inside)
        mark_beyond(w, part);
    w->before = inside ? w->map : w->inside;
    return true;
}
