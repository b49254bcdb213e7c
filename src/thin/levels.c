/* levels.c: which of what is thin is far before the focus, and which is in it (thin.h). */
#include <stdlib.h>

#include "focus/focus.h"
#include "gather/frame.h"
#include "thin/thin.h"

enum { MOST_FAR_ALPHA = 160 }; /* 255 = 1 */

/* signed_blur of one. */
static int plain_blur(struct rf_focus focus, uint16_t disparity)
{
    const int away = disparity - focus.disparity;
    const uint32_t blur = (uint32_t)(away < 0 ? -away : away) * focus.radius + 0x8000;

    return away > 0 ? -(int)(blur >> 16) : (int)(blur >> 16);
}

int rf_thin_blur(const struct rf_frame *f, uint16_t disparity, int x, int y)
{
    int16_t blur;

    if (f->plan.plain)
        return plain_blur(f->plan.focus, disparity);
    rf_focus_row(&f->plan, &blur, &disparity, f->r->view.x0 + x, f->r->view.y0 + y, 1);
    return blur;
}

int rf_near_blur(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty)
{
    return rf_thin_blur(f, thin->near_disparity, tx * RF_TILE, ty * RF_TILE);
}

/* Of a pixel of a tile. Cells beside each other, and those on a line, differ much; single pixels
 * would show as a weave. */
static int level_of(int at)
{
    static const uint8_t level[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

    return level[at / RF_TILE / RF_CELL][at % RF_TILE / RF_CELL];
}

static int veil_blur_of(const struct rf_frame *f, int level)
{
    return f->veil_blur + f->veil_blur * level / 64;
}

/* Q7.8: how much what is held may be blurred, and what is behind it must. */
static int held_blur(int level)
{
    return 112 + 9 * level;
}

static int far_blur(int level)
{
    return 384 + 32 * level;
}

/* Whether the map has it near. */
static bool is_near(const struct refocus_renderer *r, const struct rf_thin *thin, int tx, int ty)
{
    const int x = tx * RF_TILE + thin->at % RF_TILE, y = ty * RF_TILE + thin->at / RF_TILE;

    return r->disparity.at[y * r->view.stride + x] == thin->near_disparity;
}

/* What the map has far can hardly be covered by more than half: else its own texture was taken for
 * what is near. */
bool rf_is_held(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty)
{
    const int level = level_of(thin->at);
    const struct rf_thin_bounds *b = &f->thin_bounds[level];

    if (thin->alpha > MOST_FAR_ALPHA && !is_near(f->r, thin, tx, ty))
        return false;
    if (f->plan.plain)
        return thin->near_disparity >= b->held_from && thin->near_disparity <= b->held_to &&
               thin->far_disparity <= b->held_far;
    return abs(rf_near_blur(f, thin, tx, ty)) <= held_blur(level) &&
           rf_thin_blur(f, thin->far_disparity, tx * RF_TILE, ty * RF_TILE) >= far_blur(level);
}

bool rf_is_veil(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty)
{
    const int level = level_of(thin->at);

    return f->plan.plain ? thin->near_disparity >= f->thin_bounds[level].veil_from
                         : rf_near_blur(f, thin, tx, ty) <= -veil_blur_of(f, level);
}

/* The least disparity with at most a blur; 65536: none. */
static int disparity_from(const struct rf_frame *f, int blur)
{
    int low = 0, high = 65536;

    while (low < high) {
        const int middle = (low + high) / 2;

        if (plain_blur(f->plan.focus, (uint16_t)middle) <= blur)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

void rf_set_thin_bounds(struct rf_frame *f)
{
    for (int k = 0; k < RF_THIN_LEVELS && f->plan.plain; k++)
        f->thin_bounds[k] = (struct rf_thin_bounds){
            .veil_from = disparity_from(f, -veil_blur_of(f, k)),
            .held_from = disparity_from(f, held_blur(k)),
            .held_to = disparity_from(f, -held_blur(k) - 1) - 1,
            .held_far = disparity_from(f, far_blur(k) - 1) - 1,
        };
}
