/* chords.c: how wide an iris is at each height.
 *
 * Every row of an iris is one chord, as it is convex. Where they begin and end is kept
 * for heights 2 / RF_CHORDS of its radius apart.
 */
#include "aperture/aperture.h"

#include <math.h>

struct point {
    double x, y; /* y down, as the mask is seen */
};

static int corners(const struct refocus_aperture *a)
{
    return a->shape == RF_SHAPE_POLYGON ? a->blades : RF_OUTLINE;
}

static struct point corner(const struct refocus_aperture *a, int i)
{
    const int k = i % corners(a);

    if (a->shape == RF_SHAPE_POLYGON)
        return (struct point){a->corner_x[k], a->corner_y[k]};
    return (struct point){a->vertex_x[k] * a->squeeze_x,
                          -a->vertex_y[k] * a->squeeze_y};
}

static int16_t to_q14(double v)
{
    return (int16_t)floor(v * 16384 + 0.5);
}

/* The chord at a height; of none both its ends are 0. */
static void set_chord(struct refocus_aperture *a, int row)
{
    const double y = 2.0 * row / RF_CHORDS - 1;
    double least = 2, most = -2;

    for (int i = 0; i < corners(a); i++) {
        const struct point p = corner(a, i), q = corner(a, i + 1);
        double x;

        if ((p.y < y) == (q.y < y))
            continue;
        x = p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
        least = x < least ? x : least;
        most = x > most ? x : most;
    }
    a->chord[row][0] = to_q14(least < most ? least : 0);
    a->chord[row][1] = to_q14(least < most ? most : 0);
}

void rf_chords_make(struct refocus_aperture *a)
{
    double twice = 0;

    for (int i = 0; i < corners(a); i++) {
        const struct point p = corner(a, i), q = corner(a, i + 1);

        twice += p.x * q.y - p.y * q.x;
    }
    a->chord_area = fabs(twice) / 2;
    for (int row = 0; row <= RF_CHORDS; row++)
        set_chord(a, row);
}

bool rf_aperture_has_chords(const struct refocus_aperture *a)
{
    const bool shape =
        a->shape == RF_SHAPE_POLYGON || (a->shape == RF_SHAPE_OUTLINE && !a->figure);

    return shape && rf_profile_is_even(&a->behind) && rf_profile_is_even(&a->before);
}
