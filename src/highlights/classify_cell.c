/* classify_cell.c: tells highlights from what is merely white where a clipped component is too
 * large to be classified as a whole, as tubes and rows of lights are.
 *
 * Each of its cells is classified by the 25 x 25 and 7 x 7 cells around it: by how much brighter it
 * is than the former, from 3 times on and wholly from 4.5, and by how few half lit cells there are
 * to the clipped ones among the latter. The hue is that of the edge there.
 */
#include "highlights/classify.h"

#include <string.h>

enum {
    AROUND = 12, /* surroundings: so many cells on each side, */
    GRID = 3,    /* every third of them */
    NEAR = 3,    /* cells on each side that tell of the edge */
    HALF_LIT = RF_LIGHT_MAX * 40 / 100,
    LARGE = 6, /* halves of its surroundings that a cell has to exceed */
};

/* The square around a cell: which cells are clipped, with a border of none, and their colours. */
struct square {
    bool clipped[2 * NEAR + 3][2 * NEAR + 3];
    int colour[2 * NEAR + 1][2 * NEAR + 1][3];
};

static void take_square(const struct rf_cell_photo *p, int x, int y, struct square *square)
{
    memset(square->clipped, 0, sizeof square->clipped);
    for (int j = 0; j <= 2 * NEAR; j++)
        for (int i = 0; i <= 2 * NEAR; i++) {
            int *colour = square->colour[j][i];

            rf_sample_cell(p, rf_within(x + i - NEAR, p->across - 1),
                           rf_within(y + j - NEAR, p->down - 1), colour);
            square->clipped[j + 1][i + 1] = rf_level_of(p, colour) > RF_CLIPPED;
        }
}

/* Whether a cell beside it is clipped, and it is not. */
static bool is_edge(const struct square *square, int i, int j)
{
    int count = 0;

    for (int k = 0; k < 9; k++)
        count += square->clipped[j + k / 3][i + k % 3];
    return count > 0 && !square->clipped[j + 1][i + 1];
}

/* Measures the near square around a cell; returns how many of its cells are clipped. */
static int look_near(const struct rf_cell_photo *p, int x, int y, struct rf_measured *m)
{
    struct square square;
    int clipped = 0, beyond = 0;

    take_square(p, x, y, &square);
    for (int j = 0; j <= 2 * NEAR; j++)
        for (int i = 0; i <= 2 * NEAR; i++) {
            const int *colour = square.colour[j][i], most = rf_level_of(p, colour);

            clipped += most > RF_CLIPPED;
            m->half_lit += most <= RF_CLIPPED && most >= HALF_LIT;
            if (most > RF_CLIPPED || is_edge(&square, i, j))
                continue;
            for (int c = 0; c < 3; c++)
                m->beyond[c] += colour[c];
            beyond++;
        }
    for (int c = 0; c < 3; c++)
        m->beyond[c] = beyond ? m->beyond[c] / beyond : m->around[c];
    for (int j = 0; j <= 2 * NEAR; j++)
        for (int i = 0; i <= 2 * NEAR; i++) {
            const int *colour = square.colour[j][i], most = rf_level_of(p, colour);

            for (int c = 0; c < 3 && is_edge(&square, i, j); c++)
                m->edge_light[c] += (colour[c] - m->beyond[c]) * most / RF_LIGHT_MAX;
        }
    return clipped;
}

static void list_pixels(struct rf_detection *d, struct rf_rect in,
                        const struct rf_lost_light *light)
{
    for (int y = in.y0 > d->y0 ? in.y0 : d->y0; y < in.y1 && y < d->y1; y++)
        for (int x = in.x0; x < in.x1; x++)
            if (rf_is_clipped(&d->photo, x, y))
                rf_list_pixel(d, x, y, light);
}

/* Measures the mean colour of a sparse grid around a cell. False: `own` does not stand out from it;
 * where much is white, the rows beside it tell, as they come first. */
static bool look_at_square(const struct rf_cell_photo *p, int x, int y, struct rf_measured *m)
{
    enum { ACROSS = 2 * AROUND / GRID + 1, ALL = ACROSS * ACROSS };
    const int own = rf_mean_luminance(m->own);
    int sum[3] = {0, 0, 0}, column[ACROSS];

    for (int i = 0; i < ACROSS; i++)
        column[i] = rf_middle_of(p, rf_within(x + i * GRID - AROUND, p->across - 1), p->width);
    for (int k = 0; k < ACROSS; k++) {
        const int j = GRID * (k % 2 ? -(k + 1) / 2 : k / 2); /* from the middle on */
        const int row = rf_middle_of(p, rf_within(y + j, p->down - 1), p->height);

        for (int i = 0; i < ACROSS; i++) {
            int colour[3];

            rf_colour_at(p, column[i], row, colour);
            for (int c = 0; c < 3; c++)
                sum[c] += colour[c];
        }
        /* rf_isolation() will find the same; cells are many, and 32 bits are enough */
        if (2 * own <= LARGE * rf_luminance_q12(sum[0] / ALL, sum[1] / ALL, sum[2] / ALL))
            return false;
    }
    for (int c = 0; c < 3; c++)
        m->around[c] = sum[c] / ALL;
    return true;
}

void rf_classify_cell(struct rf_detection *d, int x, int y)
{
    const struct rf_cell_photo *p = &d->photo;
    struct rf_measured m = {0};
    struct rf_lost_light light = {.size = 1};
    const int own = rf_add_clipped(p, x, y, m.own);
    int clipped;

    for (int c = 0; c < 3; c++)
        m.own[c] /= own;
    if (!look_at_square(p, x, y, &m))
        return;
    light.strength = rf_isolation(&m, LARGE);
    if (!light.strength)
        return;
    clipped = look_near(p, x, y, &m);
    light.strength = light.strength * rf_ramp(clipped, 2 * m.half_lit, 4 * m.half_lit) / 256;
    if (!light.strength)
        return;
    rf_boost_of(m.edge_light, light.boost);
    list_pixels(d, rf_pixels_of(p, x, y), &light);
}
