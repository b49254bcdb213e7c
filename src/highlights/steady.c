/* steady.c: keeps the light of a video's highlights from flickering.
 *
 * A highlight has lost an unknown amount of light, and few pixels tell of it: as it moves by a part
 * of a pixel, or noise changes these, the estimate changes by some percent, and all of its disc
 * with it. So the light of the highlights around a place follows that of the last frame: with e
 * now, p before and t = smoothstep(|e - p| / max(e, p), 0.3, 0.6), it becomes
 *
 *     p + (1 - keep + keep t) (e - p).
 *
 * What is switched on, off or covered changes by more than that, and is followed at once. The n-th
 * frame keeps (n - 1) / n at the most, so that the first ones are averaged. Light is
 * summed up over cells that are wide enough for it not to matter where in them a highlight is, or
 * that it moves by a pixel a frame.
 */
#include "highlights/steady.h"

#include <string.h>

#include "highlights/light_pyramid.h"
#include "support/compare.h"

enum { SIDE = 128 /* cells along the longer side, at most */ };
#define MOST_TIMES  2.0f /* light is changed by this factor at most */
#define FOLLOW_FROM 0.3f
#define FOLLOW_ALL  0.6f

/* Sums in cells of so many pixels. */
struct cells {
    int across, down, step;
    float *at;
};

static struct cells cells_of(int width, int height, float *at)
{
    const int step = (rf_larger(width, height) + SIDE - 1) / SIDE;

    return (struct cells){(width + step - 1) / step, (height + step - 1) / step, step, at};
}

uint64_t rf_steady_cells(int max_width, int max_height)
{
    return (uint64_t)rf_smaller(max_width, SIDE) * (uint64_t)rf_smaller(max_height, SIDE);
}

/* The four cells around the middle of a pixel, and their weights. */
struct place {
    float *at[4];
    float weight[4];
};

static struct place place_of(const struct cells *cells, int x, int y)
{
    const float each = 1 / (float)cells->step;
    const float u = ((float)x + 0.5f) * each - 0.5f, v = ((float)y + 0.5f) * each - 0.5f;
    const int x0 = u < 0 ? -1 : (int)u, y0 = v < 0 ? -1 : (int)v;
    const float right = u - (float)x0, low = v - (float)y0;
    struct place place;

    for (int i = 0; i < 4; i++) {
        const int cx = rf_larger(rf_smaller(x0 + (i & 1), cells->across - 1), 0);
        const int cy = rf_larger(rf_smaller(y0 + (i >> 1), cells->down - 1), 0);

        place.at[i] = cells->at + (ptrdiff_t)cy * cells->across + cx;
        place.weight[i] = (i & 1 ? right : 1 - right) * (i >> 1 ? low : 1 - low);
    }
    return place;
}

static void add_up(const struct rf_highlights *highlights, const struct cells *cells)
{
    memset(cells->at, 0, (size_t)cells->across * (size_t)cells->down * sizeof *cells->at);
    for (int part = 0; part < RF_HIGHLIGHT_PARTS; part++) {
        const struct rf_highlight_list *list = &highlights->part[part];

        for (uint32_t n = 0; n < list->count; n++) {
            const struct rf_highlight *run = &list->run[n];
            const float light =
                (float)(218 * run->boost[0] + 732 * run->boost[1] + 74 * run->boost[2]);

            for (int i = 0; i < run->count; i++) {
                const struct place place = place_of(cells, run->x + i, run->y);

                for (int k = 0; k < 4; k++)
                    *place.at[k] += place.weight[k] * light;
            }
        }
    }
}

/* Replaces the sums by how many times as much light there should be; remembers how much that is. */
static void follow(const struct cells *cells, float *last, float keep)
{
    for (int i = 0; i < cells->across * cells->down; i++) {
        const float now = cells->at[i], was = last[i];
        const float most = now > was ? now : was, difference = now > was ? now - was : was - now;
        float t = 1, times = 1;

        if (most > 0)
            t = (difference / most - FOLLOW_FROM) * (1 / (FOLLOW_ALL - FOLLOW_FROM));
        t = t < 0 ? 0 : t > 1 ? 1 : t * t * (3 - 2 * t);
        last[i] = was + (1 - keep + keep * t) * (now - was);
        if (now > 0)
            times = last[i] / now;
        cells->at[i] = times > MOST_TIMES ? MOST_TIMES : times;
    }
}

static void change(struct rf_highlights *highlights, const struct cells *cells)
{
    for (int part = 0; part < RF_HIGHLIGHT_PARTS; part++) {
        const struct rf_highlight_list *list = &highlights->part[part];

        for (uint32_t n = 0; n < list->count; n++) {
            struct rf_highlight *run = &list->run[n];
            const struct place place = place_of(cells, run->x + run->count / 2, run->y);
            float times = 0;

            for (int k = 0; k < 4; k++)
                times += place.weight[k] * *place.at[k];
            for (int c = 0; c < 3; c++) {
                const float light = times * run->boost[c] + 0.5f;

                run->boost[c] = (uint16_t)(light < 3 * RF_LIGHT_MAX ? light : 3.0f * RF_LIGHT_MAX);
            }
        }
    }
}

void rf_steady_highlights(struct rf_highlights *highlights, struct rf_last_light *last,
                          const struct rf_frame_of_light *frame, float keep, float *scratch)
{
    const struct cells cells = cells_of(frame->width, frame->height, scratch);
    float beginning;
    const size_t bytes = (size_t)cells.across * (size_t)cells.down * sizeof *scratch;

    add_up(highlights, &cells);
    for (int times = 0; times < 2; times++)
        rf_pyramid_smooth(cells.at, cells.across, cells.down);
    if (memcmp(&last->of, frame, sizeof *frame) != 0) {
        last->of = *frame;
        last->frames = 1;
        memcpy(last->light, cells.at, bytes);
        return;
    }
    if (last->frames < UINT16_MAX)
        last->frames++;
    beginning = 1 - 1 / (float)last->frames;
    follow(&cells, last->light, keep < beginning ? keep : beginning);
    change(highlights, &cells);
}
