/* chords.c: where an iris or a figure is open at each height.
 *
 * Every row of an iris is one chord, as it is convex; a row of a heart or a star may have two,
 * however it is turned. Their ends are kept for heights that lie 2 / RF_CHORDS of the radius
 * apart, and ends between two heights lie on a straight line. Where a row has one chord, the
 * second one has the length 0 and lies at the end of the first.
 */
#include "aperture/aperture.h"
#include "aperture/shape.h"

#include <math.h>

static struct rf_corner corner(const struct refocus_aperture *a, int i)
{
    return a->shape->corner(a, i % a->shape->corners(a));
}

static int16_t to_q14(double v)
{
    return (int16_t)floor(v * 16384 + 0.5);
}

/* Finds where the outline crosses a height, from left to right. Returns the number of crossings, or
 * one more than there is room for. */
static int crossings(const struct refocus_aperture *a, double y, double x[2 * RF_CHORD_SETS])
{
    int count = 0;

    for (int i = 0; i < a->shape->corners(a); i++) {
        const struct rf_corner p = corner(a, i), q = corner(a, i + 1);
        double at;
        int k;

        if ((p.y < y) == (q.y < y))
            continue;
        if (count == 2 * RF_CHORD_SETS)
            return count + 1;
        at = p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
        for (k = count++; k > 0 && at < x[k - 1]; k--)
            x[k] = x[k - 1];
        x[k] = at;
    }
    return count;
}

/* Sets the chords at a height; both ends of a row without any are 0. Returns false if there are too
 * many. */
static bool set_chords(struct refocus_aperture *a, int row)
{
    double x[2 * RF_CHORD_SETS];
    const int count = crossings(a, 2.0 * row / RF_CHORDS - 1, x), sets = count / 2;

    if (count > 2 * RF_CHORD_SETS)
        return false;
    a->chord_sets = sets > a->chord_sets ? sets : a->chord_sets;
    for (int set = 0; set < RF_CHORD_SETS; set++)
        for (int k = 0; k < 2; k++)
            a->tables->chord[set][row][k] = to_q14(count == 0   ? 0
                                                   : set < sets ? x[2 * set + k]
                                                                : x[count - 1]);
    return true;
}

void rf_chords_make(struct refocus_aperture *a)
{
    double twice = 0;

    a->chord_sets = 0;
    if (!a->shape->corner || !rf_profile_is_even(&a->behind) || !rf_profile_is_even(&a->before))
        return;
    for (int i = 0; i < a->shape->corners(a); i++) {
        const struct rf_corner p = corner(a, i), q = corner(a, i + 1);

        twice += p.x * q.y - p.y * q.x;
    }
    a->chord_area = fabs(twice) / 2;
    for (int row = 0; row <= RF_CHORDS; row++)
        if (!set_chords(a, row)) {
            a->chord_sets = 0;
            return;
        }
}
