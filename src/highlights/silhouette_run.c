/* silhouette_run.c: copies a run of pixels with those around it, and tells noise of the map from
 * silhouettes. */
#include "highlights/silhouette_run.h"

#include <stdbool.h>
#include <string.h>

#include "support/compare.h"

enum {
    OFF_LINE = 262, /* 0.4 %: noise lies farther off the lines through its neighbours */
    NOISY = 90,     /* so many of 11 x 11 pixels: the map is noise */
    MOST_OFF = 4095,
};

/* How far a value is from the middle of two others, twice. */
static inline int16_t off_middle(int16_t value, int16_t before, int16_t after)
{
    const int16_t off = (int16_t)(2 * value - before - after);

    return rf_max16(off, (int16_t)-off);
}

/* Finds how far the pixels of a row lie off both lines through their neighbours, across and down:
 * in noise nearly all do, at silhouettes and wires few. */
static void find_off_lines(struct rf_silhouette_run *run, int y)
{
    const int16_t *const above = run->disparity[rf_run_row(y - 1)],
                         *const row = run->disparity[rf_run_row(y)];
    const int16_t *const below = run->disparity[rf_run_row(y + 1)];
    int16_t *const off_line = run->off_line[rf_run_row(y)];

    for (int i = 1; i <= RF_RUN_COLUMNS;
         i++) { /* a quarter of disparities, whose differences fit */
        const int16_t own = (int16_t)(row[i] >> 2);
        const int16_t across =
            off_middle(own, (int16_t)(row[i - 1] >> 2), (int16_t)(row[i + 1] >> 2));
        const int16_t down = off_middle(own, (int16_t)(above[i] >> 2), (int16_t)(below[i] >> 2));

        off_line[i] = rf_min16(rf_min16(across, down), MOST_OFF);
    }
}

static void add_row(struct rf_silhouette_run *run, int y)
{
    const int16_t *const off_line = run->off_line[rf_run_row(y)];

    for (int i = 1; i <= RF_RUN_COLUMNS; i++) {
        run->noisy[i] = (int16_t)(run->noisy[i] + (off_line[i] > OFF_LINE / 4));
        run->off[i] = (uint16_t)(run->off[i] + off_line[i]);
    }
}

static void subtract_row(struct rf_silhouette_run *run, int y)
{
    const int16_t *const off_line = run->off_line[rf_run_row(y)];

    for (int i = 1; i <= RF_RUN_COLUMNS; i++) {
        run->noisy[i] = (int16_t)(run->noisy[i] - (off_line[i] > OFF_LINE / 4));
        run->off[i] = (uint16_t)(run->off[i] - off_line[i]);
    }
}

/* Whether what is much farther beside a pixel of the run is noise of the map, which is all around:
 * that is off the lines through its neighbours by 1.3 standard deviations in the mean, and the
 * least of nine pixels is hardly ever four times as far below one of them. Where it is a quarter of
 * all disparities or more, nothing stands out of it. */
static bool is_noise(const struct rf_silhouette_run *run, int at, int y)
{
    enum { INNER = RF_RUN_SIDE - 2, PIXELS = INNER * INNER };
    const int16_t own = run->disparity[rf_run_row(y)][at + RF_RUN_AROUND];
    int16_t least = own;
    int noisy = 0, off = 0;

    for (int i = 1; i <= INNER; i++) {
        noisy += run->noisy[at + i];
        off += run->off[at + i];
    }
    if (noisy < NOISY)
        return false;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = RF_RUN_AROUND - 1; i <= RF_RUN_AROUND + 1; i++)
            least = rf_min16(least, run->disparity[rf_run_row(j)][at + i]);
    return 2 * off > PIXELS * MOST_OFF || own - least <= 4 * 4 * off / PIXELS;
}

uint32_t rf_run_without_noise(const struct rf_silhouette_run *run, int y, uint32_t pixels)
{
    uint32_t left = pixels;

    for (; pixels; pixels &= pixels - 1)
        if (is_noise(run, __builtin_ctz(pixels), y))
            left &= ~(pixels & -pixels);
    return left;
}

/* The part of a run that lies in the window is its rows y0 to y1 - 1 and, from its column `first`
 * on, columns `from` to `end` - 1 of the window. */
struct part {
    int y0, y1, from, end, first;
};

static struct part part_of(const struct rf_silhouette_window *w, int x0, int y)
{
    const int from = rf_larger(x0 - RF_RUN_AROUND, 0);

    return (struct part){rf_larger(RF_RUN_AROUND - y, 0),
                         rf_smaller(w->view->height - y + RF_RUN_AROUND, RF_RUN_SIDE), from,
                         rf_smaller(x0 + RF_RUN + RF_RUN_AROUND, w->view->width),
                         from - (x0 - RF_RUN_AROUND)};
}

/* Copies disparities of a row of a run and beside it. */
static void copy_disparity(const struct rf_silhouette_window *w, int y,
                           struct rf_silhouette_run *run)
{
    const struct part part = part_of(w, run->x0, y);
    int16_t *const row = run->disparity[rf_run_row(y)];

    if (y < 0 || y >= w->view->height || part.end - part.from < RF_RUN + 2 * RF_RUN_AROUND)
        memset(row, 0, sizeof run->disparity[0]);
    if (y >= 0 && y < w->view->height) {
        const uint16_t *const d = w->disparity.at + y * w->light.stride + part.from;

        for (int i = 0; i < part.end - part.from; i++)
            row[part.first + i] = rf_signed16(d[i]);
    }
}

void rf_run_go_to(const struct rf_silhouette_window *w, int y, struct rf_silhouette_run *run)
{
    if (y - RF_RUN_AROUND + 2 >= run->next) { /* nothing of what is there is wanted */
        run->first = run->next = y - RF_RUN_AROUND;
        memset(run->noisy, 0, sizeof run->noisy);
        memset(run->off, 0, sizeof run->off);
    }
    for (; run->first < y - RF_RUN_AROUND; run->first++)
        subtract_row(run, run->first + 1);
    for (; run->next <= y + RF_RUN_AROUND; run->next++) {
        copy_disparity(w, run->next, run);
        if (run->next >= run->first + 2) {
            find_off_lines(run, run->next - 1);
            add_row(run, run->next - 1);
        }
    }
}

void rf_run_take_light(const struct rf_silhouette_window *w, int y, struct rf_silhouette_run *run)
{
    const struct part part = part_of(w, run->x0, y);

    for (int j = 0; j < RF_RUN_SIDE; j++)
        for (int i = 0; i < RF_RUN_COLUMNS; i++)
            run->light[j][i] = RF_RUN_DARK;
    for (int j = part.y0; j < part.y1; j++) {
        const ptrdiff_t at = (y + j - RF_RUN_AROUND) * w->light.stride + part.from;
        const uint16_t *const r = w->light.channel[0] + at, *const g = w->light.channel[1] + at;
        const uint16_t *const b = w->light.channel[2] + at;

        for (int i = 0; i < part.end - part.from; i++)
            run->light[j][part.first + i] =
                rf_max16(rf_max16((int16_t)r[i], (int16_t)g[i]), (int16_t)b[i]);
    }
}
