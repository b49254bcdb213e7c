/* thin_window.c: what is around a tile. */
#include "kernels/thin_parts.h"

#include <string.h>

/* Whether disparities of the tile and AROUND it differ by more than a jump; those a
 * little farther are looked at where that is simpler. */
static bool has_jump(const struct rf_thin_tile *t)
{
    const int x0 = -clamp(t->left, 0, AROUND),
              x1 = clamp(t->right, 0, RF_TILE + AROUND);
    const int y0 = -clamp(t->above, 0, AROUND),
              y1 = clamp(t->below, 0, RF_TILE + AROUND);
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
static void copy_around(struct rf_thin_window *w, const struct rf_thin_tile *t,
                        bool inside)
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

/* Passes go over all of the window, so that no load has to wait for parts of what was
 * just stored. `clean`, and the greatest of 3 x 3 pixels. */
static void find_clean(struct rf_thin_window *w)
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

static void find_least(struct rf_thin_window *w)
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

static void mark_beyond(struct rf_thin_window *w, const struct rf_thin_tile *t)
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

bool RF_VEC(rf_thin_window)(struct rf_thin_window *w, const struct rf_thin_tile *t)
{
    const bool inside = t->left >= MARGIN && t->above >= MARGIN &&
                        t->right >= ROW - MARGIN && t->below >= SPAN - MARGIN;

    if (!has_jump(t))
        return false;
    copy_around(w, t, inside);
    find_clean(w);
    find_least(w);
    if (!inside)
        mark_beyond(w, t);
    w->before = inside ? w->map : w->inside;
    w->asked = false;
    return true;
}
