/* test_edge_wires.c: wires of a disparity map that is too fat are not cut up. */
#include "edge_drawings.h"

#include <math.h>
#include <stdlib.h>

enum { SPACING = 46, NEAR = 32768 };

/* How much wider a wire is on one side. */
typedef double width_fn(double along, int side);

static double exact(double along, int side)
{
    (void)along;
    (void)side;
    return 0;
}

static double even(double along, int side)
{
    (void)along;
    (void)side;
    return 2;
}

/* Between 0 and 7 pixels, of its own on either side. */
static double uneven(double along, int side)
{
    return 3.5 + 3.5 * sin(along / 5 + 2 * side);
}

/* A mesh of diagonal wires that are three pixels wide, and so much wider on either side. */
static struct seen wires(double x, double y, width_fn *wider)
{
    const double along[2] = {(x + y) / sqrt(2), (x - y) / sqrt(2)};

    for (int i = 0; i < 2; i++) {
        const double off = remainder(along[1 - i], SPACING);

        if (fabs(off) < 1.5 + wider(along[i], off > 0))
            return (struct seen){0.7, 1};
    }
    return (struct seen){0.2, 0};
}

static struct seen exact_wires(double x, double y)
{
    return wires(x, y, exact);
}

/* The share of the wires' pixels that the result holds. */
static double place_wires(width_fn *wider, struct refocus_depth_edges_report *report)
{
    struct picture p = make(WIDTH, HEIGHT);
    int of_wires = 0, kept = 0;

    draw(&p, exact_wires, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        p.map[i] =
            (uint16_t)lrint(65535 * wires(i % WIDTH + 0.5, i / WIDTH + 0.5, wider).disparity);
    *report = place(&p);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        of_wires += p.exact[i] >= NEAR;
        kept += p.exact[i] >= NEAR && p.out[i] >= NEAR;
    }
    end(&p);
    return (double)kept / of_wires;
}

/* Two pixels of all wires too many are taken away, and none of the wires themselves. */
TEST(even_growth)
{
    struct refocus_depth_edges_report report;

    assert_true(place_wires(even, &report) == 1);
    assert_true(report.grown == 2);
}

/* Where wires are too wide by different lengths no one length is taken away: they would have gaps.
 */
TEST(uneven_growth)
{
    struct refocus_depth_edges_report report;

    assert_true(place_wires(uneven, &report) == 1);
    assert_true(report.grown == 0);
}
