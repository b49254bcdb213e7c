/* test_edge_coverage.c: a disparity map whose pixels are means over their areas is parted. */
#include "edge_drawings.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 8 }; /* across a pixel */

static struct seen square(double x, double y)
{
    const double u = x - 120 + 0.12 * (y - 90), v = y - 90 - 0.12 * (x - 120);

    return fabs(u) < 60 && fabs(v) < 60 ? (struct seen){0.8, 1} : (struct seen){0.2, 0};
}

static struct seen half(double x, double y)
{
    return 0.5 * x + 0.866 * y < 130 ? (struct seen){0.8, 1} : (struct seen){0.2, 0};
}

/* With wires of half a pixel to two. */
static struct seen square_and_wires(double x, double y)
{
    const double off = remainder(x + 0.3 * y, 24), wire = floor((x + 0.3 * y) / 24 + 0.5);

    return square(x, y).surface == 0 && fabs(off) < 0.25 + 0.25 * fmod(wire, 4)
               ? (struct seen){0.7, 2}
               : square(x, y);
}

/* The map becomes the mean over each pixel. */
static void cover(struct picture *p, scene_fn *scene)
{
    for (int i = 0; i < p->width * p->height; i++) {
        double sum = 0;

        for (int k = 0; k < SAMPLES * SAMPLES; k++)
            sum += scene(i % p->width + (k % SAMPLES + 0.5) / SAMPLES,
                         i / p->width + (k / SAMPLES + 0.5) / SAMPLES)
                       .disparity;
        p->map[i] = (uint16_t)lrint(65535 * sum / (SAMPLES * SAMPLES));
    }
}

/* A mean of two disparities would be blurred whether the one or the other is in focus: 0.6 to 1.0 %
 * of the pixels are such. Afterwards all but 0.02 % are within 0.02 of the exact map. */
TEST(silhouettes)
{
    scene_fn *const scenes[] = {disc, square, half};
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < 3; i++) {
        struct refocus_depth_edges_report report;

        draw(&p, scenes[i], 1);
        cover(&p, scenes[i]);
        assert_true(share_within(&p, p.map, 0.02) < 0.994);
        report = place(&p);
        assert_true(share_within(&p, p.out, 0.02) >= 0.9995);
        assert_true(report.parted == 1 && report.grown == 0 && !report.bent);
    }
    end(&p);
}

/* Means spread what is thin over a pixel and no farther. The square is at 0.8, and wires that are
 * nearer than 0.7 were taken for softer ones. */
TEST(thin_wires)
{
    struct picture p = make(WIDTH, HEIGHT);
    int most = 0;

    draw(&p, square_and_wires, 1);
    cover(&p, square_and_wires);
    assert_true(place(&p).parted == 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        most = p.out[i] > most ? p.out[i] : most;
    assert_in_range(most, 65535 * 7 / 10, 65535 * 81 / 100);
    end(&p);
}
