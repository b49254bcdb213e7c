/* summed_light.c: measures how light is spread over masks, rings and discs with bright edges. */
#include "aperture/aperture.h"
#include "aperture/shape.h"

enum { STEP = 32 /* light of a cell differs by more from that beside it: it is measured finely */ };

/* The light of a row of cells in their middles. */
static void sample_row(const struct refocus_aperture *a, int side, int y, int light[])
{
    for (int x = 0; x < side; x++)
        light[x] = y < 0 || y >= side
                       ? 0
                       : a->shape->open(a, (2 * x + 1.0) / side - 1, (2 * y + 1.0) / side - 1);
}

/* The light of a cell at RF_SUMMED_POINTS^2 points. */
static int measure(const struct refocus_aperture *a, int side, int x, int y)
{
    int sum = 0;

    for (int j = 0; j < RF_SUMMED_POINTS; j++)
        for (int i = 0; i < RF_SUMMED_POINTS; i++)
            sum += a->shape->open(a, (2 * x + (2 * i + 1.0) / RF_SUMMED_POINTS) / side - 1,
                                  (2 * y + (2 * j + 1.0) / RF_SUMMED_POINTS) / side - 1);
    return sum;
}

static bool differs(int light, int other)
{
    return light - other > STEP || other - light > STEP;
}

/* Sums up the light of an aperture that is not squeezed. */
static void sum_up(struct rf_summed_side *sums, const struct refocus_aperture *a, int side)
{
    int rows[3][RF_SUMMED_SIDE + 2] = {{0}}; /* with a cell on either side */

    sample_row(a, side, 0, rows[0] + 1);
    for (int y = 0; y < side; y++) {
        const int *const above = rows[(y + 2) % 3] + 1, *const own = rows[y % 3] + 1,
                         *const below = rows[(y + 1) % 3] + 1;
        uint32_t sum = 0;

        sample_row(a, side, y + 1, rows[(y + 1) % 3] + 1);
        sums->first[y] = sums->end[y] = 0;
        for (int x = 0; x < side; x++) {
            const bool edge = differs(own[x], own[x - 1]) || differs(own[x], own[x + 1]) ||
                              differs(own[x], above[x]) || differs(own[x], below[x]);
            const int light =
                edge ? measure(a, side, x, y) : RF_SUMMED_POINTS * RF_SUMMED_POINTS * own[x];

            if (light > 0) {
                sums->first[y] = sums->end[y] ? sums->first[y] : (uint8_t)x;
                sums->end[y] = (uint8_t)(x + 1);
            }
            sums->most = light > sums->most ? light : sums->most;
            sum += (uint32_t)light;
            sums->before[y + 1][x + 1] = sums->before[y][x + 1] + sum;
        }
    }
}

void rf_summed_light_make(struct refocus_aperture *a)
{
    struct rf_summed_light *const light = &a->tables->light;
    struct refocus_aperture whole = *a;

    a->summed = NULL;
    if (a->chord_sets || rf_aperture_is_disc(a))
        return;
    light->side = a->width > a->height ? a->width : a->height;
    light->side = light->side ? light->side : RF_SUMMED_SIDE;
    light->behind.most = light->in_front.most = 0;
    whole.squeeze_x = whole.squeeze_y = 1;
    sum_up(&light->behind, &whole, light->side);
    whole.behind = a->before;
    if (rf_aperture_has_sides(a))
        sum_up(&light->in_front, &whole, light->side);
    /* All of a mask may lie in the hole, which its rays take no notice of. */
    if (light->behind.most && (light->in_front.most || !rf_aperture_has_sides(a)))
        a->summed = light;
}
