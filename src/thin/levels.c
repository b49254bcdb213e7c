/* levels.c: tells which mixtures are far enough before the focus to be splatted, or in focus and
 * matted. */
#include <math.h>
#include <stdlib.h>

#include "thin/mixture.h"

/* 255 = 1 */
enum {
    MOST_FAR_ALPHA = 160,
    SIDE = 32,       /* a pixel that N covers less stays as it is */
    THIN_SIDE = 128, /* the least that a thin N covers of a pixel it is given */
};

/* Signed circle of confusion of one disparity, 1/256 pixel, as the kernel signed_blur rounds it. */
static int plain_blur(struct rf_focus focus, uint16_t disparity)
{
    const int away = disparity - focus.disparity;
    const uint32_t blur = (uint32_t)(away < 0 ? -away : away) * focus.radius + 0x8000;

    return rf_in_pixels(away > 0 ? -(int)(blur >> 16) : (int)(blur >> 16), focus.unit);
}

int rf_thin_blur(const struct rf_thin_pass *t, uint16_t disparity, int x, int y)
{
    int16_t blur;

    if (t->plan->plain)
        return plain_blur(t->plan->focus, disparity);
    rf_focus_row(t->plan, &blur, &disparity, t->view->x0 + x, t->view->y0 + y, 1);
    return rf_in_pixels(blur, t->plan->focus.unit);
}

int rf_near_blur(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty)
{
    return rf_thin_blur(t, thin->near_disparity, tx * RF_TILE, ty * RF_TILE);
}

/* The level of a pixel of a tile. Cells beside each other, and those on a line, differ much; levels
 * that differ from pixel to pixel would show as a weave. */
static int level_of(int at)
{
    static const uint8_t level[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

    return level[at / RF_TILE / RF_CELL][at % RF_TILE / RF_CELL];
}

static int splat_blur_of(const struct rf_thin_pass *t, int level)
{
    return t->splat_blur + t->splat_blur * level / 64;
}

/* Q7.8: how much a matted structure may be blurred, and how much its background must. All levels
 * are below half a pixel: beyond, what is near casts rays, which pass through the matted pixels
 * beside it, as these have the blur of the far surface. */
static int matte_blur(int level)
{
    return 64 + 4 * level;
}

static int far_blur(int level)
{
    return 384 + 32 * level;
}

/* Whether the map has what was found on a surface between F and N, whose light it may have. */
static bool is_third(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty)
{
    const int x = tx * RF_TILE + thin->at % RF_TILE, y = ty * RF_TILE + thin->at / RF_TILE;
    const int own = t->disparity.at[y * t->view->stride + x];

    return !rf_thin_run_of(t, tx, ty)->given && own > thin->far_disparity + RF_SURFACE_JUMP &&
           own < thin->near_disparity - RF_SURFACE_JUMP;
}

/* Beside thin structures in focus a pixel that the map has far can hardly be covered by more than
 * half: with a greater alpha, its own texture was mistaken for N. Beside what is thick, maps are
 * often a pixel inside of the silhouette. */
static bool is_mistaken(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty)
{
    const int x = tx * RF_TILE + thin->at % RF_TILE, y = ty * RF_TILE + thin->at / RF_TILE;

    return !thin->thick && thin->alpha > MOST_FAR_ALPHA &&
           t->disparity.at[y * t->view->stride + x] != thin->near_disparity;
}

bool rf_is_matted(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty)
{
    const int level = level_of(thin->at);

    if (is_mistaken(t, thin, tx, ty) || is_third(t, thin, tx, ty))
        return false;
    return abs(rf_near_blur(t, thin, tx, ty)) <= matte_blur(level) &&
           rf_thin_blur(t, thin->far_disparity, tx * RF_TILE, ty * RF_TILE) >= far_blur(level);
}

/* Whether the caller knows what N hides at a mixture. It is put only where it is farther than the
 * map, which has F here: that would be inpainted. */
static bool is_known(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty)
{
    const int x = t->view->x0 + tx * RF_TILE + thin->at % RF_TILE;
    const int y = t->view->y0 + ty * RF_TILE + thin->at / RF_TILE;

    return t->behind && rf_is_behind(t->behind, x, y, thin->near_disparity);
}

/* Pixels of N that the map has far would be a line of dots on a background in focus. Texture of F
 * that was mistaken for N lies where the blur of N hides half of what is behind. */
void rf_choose_near(const struct rf_thin_pass *t, int tx, int ty, struct rf_thin_choice *choice)
{
    const bool given = rf_thin_run_of(t, tx, ty)->given;
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);

    for (uint32_t i = 0; i < count; i++, thin++) {
        const int level = level_of(thin->at);
        int near, far;

        if (rf_has_bit(choice->splat, i) || thin->alpha < (thin->thick ? SIDE : THIN_SIDE))
            continue;
        near = rf_near_blur(t, thin, tx, ty);
        far = rf_thin_blur(t, thin->far_disparity, tx * RF_TILE, ty * RF_TILE);
        if (abs(near) <= matte_blur(level) || far - near < far_blur(level) ||
            is_third(t, thin, tx, ty) || (!given && is_known(t, thin, tx, ty)))
            continue;
        choice->nears = true;
        choice->near[i / 64] |= UINT64_C(1) << i % 64;
    }
}

bool rf_is_splatted(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty)
{
    return !thin->thick && rf_near_blur(t, thin, tx, ty) <= -splat_blur_of(t, level_of(thin->at));
}

/* Rays hit thin structures often enough where they lie closer than 1.8 pixels, and miss many from
 * 2.25 on. A full mask splats what 64 rays splat, as it is there to show what so few rays change.
 */
static int splat_blur(int rays)
{
    const double blur =
        256 * 1.8 * sqrt((rays == REFOCUS_RAYS_FULL ? 64 : rays) / 3.14159265358979);

    return blur > INT16_MAX ? INT16_MAX : blur < RF_COVERAGE_BLUR ? RF_COVERAGE_BLUR : (int)blur;
}

/* Discs are as large as the rays of the aperture lie from its middle on the average: the mean
 * square of the radius of a disc's points is 1/2. */
static int disc_scale(const struct rf_ray_set *set)
{
    int64_t sum = 0;

    for (int n = 0; n < set->count; n++)
        sum += set->ray[n].u * set->ray[n].u + set->ray[n].v * set->ray[n].v;
    return (int)(sqrt(2.0 * (double)(sum / set->count)) / 128 + 0.5);
}

void rf_thin_set_up(struct rf_thin_pass *t, const struct rf_thin_settings *settings)
{
    t->splat_blur = splat_blur(settings->rays);
    t->finds = settings->on && settings->finds;
    t->mattes = t->finds || (settings->on && t->list->has_matte);
    t->disc_scale =
        t->finds && settings->splats &&
                !(t->plan->plain && plain_blur(t->plan->focus, 65535) > -splat_blur_of(t, 0))
            ? disc_scale(settings->set)
            : 0;
}
