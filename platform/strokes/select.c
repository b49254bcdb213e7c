/* select.c: the object that strokes are painted over is found, from a coarse level of the photo to
 * the finest. */
#include <math.h>
#include <string.h>
#include "brush.h"
#include "grid.h"
#include "select.h"

/* Pixels of the level at which a selection begins: enough for thin parts, few enough
 * for a cut of all of them in some milliseconds. */
enum { FIRST_PIXELS = 12000, ROUNDS = 3 };

/* The finest levels are not worth an exact cut: a coarser one has found the edge to a pixel or
 * two. */
enum { SETTLED_LEVELS = 2 };

/* Scores for the place of a pixel. */
enum { UNDER_BRUSH = RF_BIT, FARTHEST = -3 * RF_BIT, OUT_OF_REACH = -1000 };

enum { PLACE, DISTANCE, STACK, STATES }; /* numbers of scratch memory; STATES is the first of two */

/* Find the area that the strokes can reach, in whole pixels of the coarsest level that is needed.
 */
static int choose_area(const struct rf_pyramid *pyramid, const struct rf_stroke *strokes, int count,
                       struct rf_area *area)
{
    const int32_t w = pyramid->width[0], h = pyramid->height[0];
    int32_t x0 = w, y0 = h, x1 = 0, y1 = 0;
    int level = 0;

    for (int i = 0; i < count; i++) {
        const struct refocus_stroke *const s = &strokes[i].stroke;
        struct rf_area one;

        if (s->kind == REFOCUS_STROKE_LESS || strokes[i].count == 0)
            continue;
        /* A quarter more, to see what lies around. */
        one = rf_brush_area(&strokes[i], (double)s->radius * (double)s->reach * 1.25, w, h);
        x0 = one.x < x0 ? one.x : x0;
        y0 = one.y < y0 ? one.y : y0;
        x1 = one.x + one.width > x1 ? one.x + one.width : x1;
        y1 = one.y + one.height > y1 ? one.y + one.height : y1;
    }
    while (level + 1 < pyramid->levels &&
           (int64_t)((x1 - x0) >> level) * ((y1 - y0) >> level) > FIRST_PIXELS)
        level++;
    area->x = x0 >> level;
    area->y = y0 >> level;
    area->width = ((x1 - 1) >> level) + 1 - area->x;
    area->height = ((y1 - 1) >> level) + 1 - area->y;
    return level;
}

/* Strokes make some pixels certain, and give the others scores by their distance. Where two strokes
 * are certain of a pixel the later one is right. */
static void read_stroke(const struct rf_stroke *stroke, struct rf_grid *grid, int16_t *place,
                        uint16_t *distance)
{
    const int64_t pixels = rf_area_pixels(grid->area);
    const bool less = stroke->stroke.kind == REFOCUS_STROKE_LESS;
    const int32_t reach = (int32_t)(RF_RADIUS * (double)stroke->stroke.reach);

    rf_brush_distance(stroke, grid->level, grid->area, distance);
    for (int64_t i = 0; i < pixels; i++) {
        const int32_t d = distance[i];

        if (d <= RF_RADIUS / 2)
            grid->state[i] = less ? RF_SEED : RF_SEED | RF_INSIDE;
        if (!less && d < reach) {
            const int32_t score =
                d <= RF_RADIUS ? UNDER_BRUSH : FARTHEST * (d - RF_RADIUS) / (reach - RF_RADIUS + 1);
            if (score > place[i])
                place[i] = (int16_t)score;
        }
    }
}

/* Count colours of both sides. At first: what is under the brush, and what is far from
 * it; then what was selected, and what was not. */
static int count_colours(const struct rf_grid *grid, const int16_t *place, bool first,
                         struct rf_selector *selector, const struct rf_pyramid *pyramid)
{
    enum { SURE = 4 };
    struct rf_likeness *const likeness = &selector->likeness;
    struct rf_colour *const row = rf_selector_scratch(selector, 6, grid->area.width, sizeof *row);

    if (!row)
        return REFOCUS_ERR_MEMORY;
    rf_likeness_clear(likeness);
    for (int32_t y = 0; y < grid->area.height; y++) {
        const size_t at = (size_t)y * (size_t)grid->area.width;

        rf_pyramid_row(pyramid, grid->level, grid->area.x, grid->area.y + y, grid->area.width, row);
        for (int32_t x = 0; x < grid->area.width; x++) {
            const uint8_t state = grid->state[at + (size_t)x];
            const int16_t score = place[at + (size_t)x];
            const int bin = rf_bin(row[x]);

            if (state & RF_SEED)
                *(state & RF_INSIDE ? &likeness->object[bin] : &likeness->outside[bin]) += SURE;
            else if (first ? score == UNDER_BRUSH : state & RF_INSIDE)
                likeness->object[bin]++;
            else if (!first || score < FARTHEST / 2)
                likeness->outside[bin]++;
        }
    }
    rf_likeness_settle(likeness);
    return REFOCUS_OK;
}

/* Open all that is in reach and not certain; what is out of reach is outside. */
static void open_reach(struct rf_grid *grid, const int16_t *place)
{
    const int64_t pixels = rf_area_pixels(grid->area);

    for (int64_t i = 0; i < pixels; i++)
        if (!(grid->state[i] & RF_SEED))
            grid->state[i] = place[i] == OUT_OF_REACH ? 0 : RF_OPEN;
}

/* A region out of reach that is closed in by others within reach, as the middle of a large object
 * that was painted along its border, is in reach after all. */
static void close_reach(struct rf_area area, int16_t *place, int32_t *stack)
{
    enum { AROUND = OUT_OF_REACH - 1 };
    const int32_t w = area.width, h = area.height, pixels = w * h;
    int32_t depth = 0;

    for (int32_t i = 0; i < pixels; i++) {
        const int32_t x = i % w, y = i / w;

        if (place[i] == OUT_OF_REACH && (x == 0 || y == 0 || x == w - 1 || y == h - 1)) {
            place[i] = AROUND;
            stack[depth++] = i;
        }
    }
    while (depth > 0) {
        const int32_t at = stack[--depth], x = at % w, y = at / w;
        const int32_t next[4] = {x > 0 ? at - 1 : at, x + 1 < w ? at + 1 : at, y > 0 ? at - w : at,
                                 y + 1 < h ? at + w : at};

        for (int i = 0; i < 4; i++) {
            if (place[next[i]] == OUT_OF_REACH) {
                place[next[i]] = AROUND;
                stack[depth++] = next[i];
            }
        }
    }
    for (int32_t i = 0; i < pixels; i++)
        place[i] = place[i] == OUT_OF_REACH ? FARTHEST
                   : place[i] == AROUND     ? OUT_OF_REACH
                                            : place[i];
}

static int select_coarse(struct rf_grid *grid, struct rf_selector *selector,
                         const struct rf_pyramid *pyramid, const struct rf_stroke *strokes,
                         int count)
{
    const int64_t pixels = rf_area_pixels(grid->area);
    int16_t *const place = rf_selector_scratch(selector, PLACE, pixels, sizeof *place);
    uint16_t *const distance = rf_selector_scratch(selector, DISTANCE, pixels, sizeof *distance);
    int32_t *const stack = rf_selector_scratch(selector, STACK, pixels, sizeof *stack);
    int status = REFOCUS_OK;

    grid->state = rf_selector_scratch(selector, STATES, pixels, 1);
    if (!place || !distance || !stack || !grid->state)
        return REFOCUS_ERR_MEMORY;
    memset(grid->state, 0, (size_t)pixels);
    for (int64_t i = 0; i < pixels; i++)
        place[i] = OUT_OF_REACH;
    for (int i = 0; i < count; i++)
        if (strokes[i].count > 0)
            read_stroke(&strokes[i], grid, place, distance);
    close_reach(grid->area, place, stack);
    grid->place = place;
    grid->place_area = grid->area;
    grid->place_shift = 0;
    for (int i = 0; i < ROUNDS && status == REFOCUS_OK; i++) {
        status = count_colours(grid, place, i == 0, selector, pyramid);
        open_reach(grid, place);
        if (status == REFOCUS_OK)
            status = rf_grid_cut(grid, selector, pyramid, false);
        rf_grid_connect(grid, stack);
    }
    return status;
}

int64_t rf_select_work(const struct rf_pyramid *pyramid, const struct rf_stroke *strokes, int count)
{
    enum { PER_CUT = 100 }; /* a pixel of the coarsest level takes a microsecond in all rounds */
    struct rf_area area;
    const int level = choose_area(pyramid, strokes, count, &area);

    return (rf_area_pixels(area) << (2 * level)) + PER_CUT * rf_area_pixels(area);
}

int rf_select(struct rf_selector *selector, const struct rf_pyramid *pyramid,
              const struct rf_stroke *strokes, int count, struct rf_spans *spans)
{
    struct rf_grid grid = {0}, fine;
    int status, side = 0;

    grid.level = choose_area(pyramid, strokes, count, &grid.area);
    status = select_coarse(&grid, selector, pyramid, strokes, count);
    if (status == REFOCUS_OK)
        rf_grid_shrink(&grid, 2);
    while (status == REFOCUS_OK && grid.level > 0) {
        const int64_t pixels = rf_area_pixels(rf_grid_finer_area(&grid, pyramid));

        side = !side;
        fine.state = rf_selector_scratch(selector, STATES + side, pixels, 1);
        if (!fine.state)
            return REFOCUS_ERR_MEMORY;
        rf_grid_refine(&fine, &grid, pyramid);
        grid = fine;
        status = rf_grid_cut(&grid, selector, pyramid, grid.level < SETTLED_LEVELS);
    }
    if (status != REFOCUS_OK)
        return status;
    for (int64_t i = 0; i < rf_area_pixels(grid.area); i++)
        grid.state[i] &= RF_INSIDE;
    return rf_spans_of_mask(spans, grid.state, grid.area);
}
