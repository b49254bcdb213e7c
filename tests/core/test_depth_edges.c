/* test_depth_edges.c: edges of disparity maps on those of photos, through the public function. */
#include "edge_drawings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CODE = 257 }; /* one of 8 bits */

static scene_fn *const scenes[] = {disc, disc_and_wire, planes, sphere, paraboloid, stairs};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* ----- maps that need nothing ----- */

/* Whatever the contrast of the edges, and so whatever K the map is rendered with. */
TEST(exact_stays)
{
    static const double contrasts[] = {1, 0.5, 0.125};
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < SCENES; i++)
        for (int k = 0; k < 3; k++) {
            struct refocus_depth_edges_report report;

            draw(&p, scenes[i], contrasts[k]);
            report = place(&p);
            assert_same(&p, p.exact, "scene", i);
            assert_true(report.softness < 0.5F && report.on_photo >= 0.75F);
            assert_true(report.changed == 0 && !report.bent && !report.parted);
            assert_true(report.grown == 0 && report.shift_x == 0 && report.shift_y == 0);
        }
    end(&p);
}

TEST(exact_codes_stay)
{
    struct picture p = make(WIDTH, HEIGHT);
    uint8_t *codes = malloc(WIDTH * HEIGHT);
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_image photo = photo_of(&p);
    struct refocus_disparity map = refocus_disparity16(p.map, WIDTH, HEIGHT, WIDTH);

    assert_non_null(codes);
    map.samples = codes;
    map.bits = 8;
    for (int i = 0; i < SCENES; i++) {
        draw(&p, scenes[i], 1);
        for (int k = 0; k < WIDTH * HEIGHT; k++) {
            codes[k] = (uint8_t)(p.exact[k] >> 8);
            p.exact[k] = (uint16_t)(codes[k] * CODE);
        }
        assert_int_equal(refocus_depth_edges(&photo, &map, &params, p.out, 2 * WIDTH, NULL),
                         REFOCUS_OK);
        assert_same(&p, p.exact, "codes of scene", i);
    }
    free(codes);
    end(&p);
}

/* A photo that shows nothing tells nothing: a map that is off stays as it is. */
TEST(grey_photo)
{
    struct picture p = make(WIDTH, HEIGHT);
    struct refocus_depth_edges_report report;

    for (int i = 0; i < SCENES; i++) {
        draw(&p, scenes[i], 1);
        memset(p.rgb, 128, 3 * WIDTH * HEIGHT);
        displace(&p, scenes[i], 3, -2);
        report = place(&p);
        assert_same(&p, p.map, "grey", i);
        assert_true(report.changed == 0);
    }
    end(&p);
}

/* ----- soft maps ----- */

/* Whether no pixel within `reach` in the scene is of another surface. */
static bool far_from_edges(scene_fn *scene, int x, int y, int reach)
{
    const int own = scene(x + 0.5, y + 0.5).surface;

    for (int v = -reach; v <= reach; v += 2)
        for (int u = -reach; u <= reach; u += 2)
            if (scene(x + u + 0.5, y + v + 0.5).surface != own)
                return false;
    return true;
}

/* Slopes that are longer than a ramp can be stay, and so do round things. */
TEST(slopes_stay)
{
    static scene_fn *const sloping[] = {planes, sphere, paraboloid};
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < 3; i++) {
        int looked_at = 0, most = 0;

        draw(&p, sloping[i], 1);
        soften(&p, 2, 0);
        assert_true(place(&p).parted == 1);
        for (int k = 0; k < WIDTH * HEIGHT; k++) {
            const int x = k % WIDTH, y = k / WIDTH, off = abs(p.out[k] - p.map[k]);

            if (!far_from_edges(sloping[i], x, y, 10))
                continue;
            looked_at++;
            most = off > most ? off : most;
        }
        assert_true(looked_at > WIDTH * HEIGHT / 2);
        assert_int_equal(most, 0);
    }
    end(&p);
}

/* Blurred by a Gaussian of 2 pixels, 91.3 % of the pixels are within 0.02 of the exact map; all of
 * them are afterwards. A wire of 0.7 before 0.2, of which the map makes 0.39, is within 0.018. */
TEST(soft_is_parted)
{
    struct picture p = make(WIDTH, HEIGHT);
    struct refocus_depth_edges_report report;
    int most = 0;

    draw(&p, disc_and_wire, 1);
    soften(&p, 2, 0);
    assert_true(share_within(&p, p.map, 0.02) < 0.92);
    report = place(&p);
    assert_true(share_within(&p, p.out, 0.02) >= 0.995);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (on_wire(i % WIDTH + 0.5, i / WIDTH + 0.5)) {
            const int off = abs(p.out[i] - p.exact[i]);

            most = off > most ? off : most;
        }
    assert_in_range(most, 0, 65535 * 3 / 100);
    assert_true(report.softness > 1.25F && report.softness < 2.5F);
    assert_true(report.parted == 1 && !report.bent && report.grown == 0);
    assert_true(report.changed > 0.08F && report.changed < 0.16F); /* 0.116 */
    end(&p);
}

/* A map that is smoothed by less than a pixel has mixtures of two surfaces along its edges, be they
 * one pixel wide: 1.3 to 2.8 % of the pixels. All are given to one or the other. */
TEST(antialiased_is_parted)
{
    static const double sigmas[] = {0.5, 0.7, 1};
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < 3; i++) {
        struct refocus_depth_edges_report report;

        draw(&p, disc, 1);
        soften(&p, sigmas[i], 0);
        assert_true(share_within(&p, p.map, 0.02) < 0.99);
        report = place(&p);
        assert_true(share_within(&p, p.out, 0.02) >= 0.999);
        assert_true(report.parted == 1 && report.softness >= 0.5F && report.softness < 1.25F);
    }
    end(&p);
}

/* Lossy compression adds waves beside the edges of an exact map, so that most of its ramps look
 * soft. It stays as it is. */
TEST(compressed_stays)
{
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < 2; i++) {
        struct refocus_depth_edges_report report;

        draw(&p, i ? disc_and_wire : disc, 1);
        for (int k = 0; k < WIDTH * HEIGHT; k++) {
            const int x = k % WIDTH, y = k / WIDTH;
            const int wave = far_from_edges(i ? disc_and_wire : disc, x, y, 4) ? 0 : 16 * CODE;

            p.map[k] = (uint16_t)(p.map[k] + (x % 4 < 2 ? wave : 0) - (y % 4 < 2 ? wave : 0));
        }
        memcpy(p.exact, p.map, WIDTH * HEIGHT * sizeof *p.map);
        report = place(&p);
        assert_true(report.softness >= 0.5F);
        assert_true(report.parted == 0);
        assert_same(&p, p.exact, "compressed", i);
    }
    end(&p);
}

/* A strip at the side, where few vote for what is near. */
static struct seen strip(double x, double y)
{
    (void)y;
    return x < 6 ? (struct seen){0.8, 1} : (struct seen){0.2, 0};
}

/* Edges everywhere, and none that has to do with the map. */
TEST(unrelated_photo)
{
    struct picture p = make(WIDTH, HEIGHT);
    int bent = 0;

    random_state = 23;
    for (int i = 0; i < 8 * SCENES; i++) {
        draw(&p, scenes[i % SCENES], 1);
        for (int at = 0; at < WIDTH * HEIGHT; at++)
            memset(p.rgb + 3 * at, (int)(random_bits() % 256), 3);
        bent += place(&p).bent != 0;
    }
    assert_int_equal(bent, 0); /* without the least support 32 of 48 */
    end(&p);
}

/* Where the photo shows nothing the map itself decides: at the middle of each ramp. Of the disc
 * 99.94 % of the pixels are right, of the strip all; by votes alone its edge would be a pixel off.
 */
TEST(soft_before_grey)
{
    scene_fn *const scene[] = {disc, strip};
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < 2; i++) {
        draw(&p, scene[i], 1);
        memset(p.rgb, 128, 3 * WIDTH * HEIGHT);
        soften(&p, 2, 0);
        assert_true(share_within(&p, p.map, 0.02) < 0.97);
        assert_true(place(&p).parted == 1);
        assert_true(share_within(&p, p.out, 0.02) >= 0.999);
    }
    end(&p);
}

/* One pixel of ten has a colour of the other surface. Those beside the edge that are given to it
 * are put right by their neighbours: 99.87 % of the pixels are right, without that 99.74 %. */
TEST(specks_of_photo)
{
    struct picture p = make(WIDTH, HEIGHT);

    draw(&p, disc, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (random_bits() % 10 == 0)
            paint(p.rgb + (ptrdiff_t)3 * i, p.exact[i] < 32768 ? 1 : 0, i % WIDTH, i / WIDTH);
    soften(&p, 2, 0);
    place(&p);
    assert_true(share_within(&p, p.out, 0.02) >= 0.998);
    end(&p);
}

/* Overshoot of 0.022 on either side of an edge: 96.1 % of the pixels are within 0.02 of the exact
 * map before, 99.8 % afterwards. */
TEST(overshoot_goes)
{
    struct picture p = make(WIDTH, HEIGHT);
    int most = 0;

    draw(&p, disc, 1);
    soften(&p, 2, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        most = p.map[i] > most ? p.map[i] : most;
    assert_in_range(most, 65535 * 82 / 100, 65535 * 83 / 100);
    assert_true(share_within(&p, p.map, 0.02) < 0.965);
    place(&p);
    assert_true(share_within(&p, p.out, 0.02) >= 0.995);
    end(&p);
}

/* A disc, and a part of what is behind it that is 0.07 nearer. */
static bool in_part(double x, double y)
{
    return x > 180 && x < 220 && y > 60 && y < 120;
}

static struct seen unseen_part(double x, double y)
{
    return in_part(x, y) ? (struct seen){0.27, 0} : disc(x, y);
}

static struct seen seen_part(double x, double y)
{
    return in_part(x, y) ? (struct seen){0.27, 2} : disc(x, y);
}

/* Neighbours in a row, right of the disc, that are more than 0.016 apart. */
static int steps(const uint16_t *map)
{
    int found = 0;

    for (int y = 0; y < HEIGHT; y++)
        for (int x = 170; x < WIDTH - 1; x++)
            found += abs(map[y * WIDTH + x + 1] - map[y * WIDTH + x]) > 65535 * 16 / 1000;
    return found;
}

/* A ramp of little contrast is parted where the photo has an edge, too: 99.9 % of the pixels are
 * within 0.01 of the exact map. Where the photo has none it stays smooth, but near corners, where
 * most of what is around a pixel is on one side: 41 steps, parted 120. */
TEST(weak_ramps)
{
    struct picture p = make(WIDTH, HEIGHT);

    draw(&p, unseen_part, 1);
    soften(&p, 2, 0);
    assert_true(place(&p).parted == 1);
    assert_int_equal(steps(p.map), 0);
    assert_in_range(steps(p.out), 0, 45);
    draw(&p, seen_part, 1);
    soften(&p, 2, 0);
    assert_true(place(&p).parted == 1);
    assert_true(share_within(&p, p.out, 0.01) >= 0.995);
    end(&p);
}

/* ----- small maps ----- */

/* Means over squares of `side` pixels, or what is at their middles, packed. */
static void reduce(struct picture *p, int side, bool mean)
{
    const int columns = p->width / side, rows = p->height / side;

    for (int i = 0; i < columns * rows; i++) {
        const uint16_t *first = p->exact + i / columns * side * p->width + i % columns * side;
        uint32_t sum = 0;

        for (int k = 0; k < side * side; k++)
            sum += first[k / side * p->width + k % side];
        p->map[i] = mean ? (uint16_t)(sum / (uint32_t)(side * side))
                         : first[side / 2 * p->width + side / 2];
    }
}

static struct refocus_depth_edges_report place_small(const struct picture *p, int side)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_image photo = photo_of(p);
    const struct refocus_disparity map =
        refocus_disparity16(p->map, p->width / side, p->height / side, 2 * (p->width / side));
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();

    assert_int_equal(
        refocus_depth_edges(&photo, &map, &params, p->out, 2 * (ptrdiff_t)p->width, &report),
        REFOCUS_OK);
    return report;
}

/* Samples that are means over areas mix the two surfaces along edges. */
TEST(small_means)
{
    static const int sides[] = {2, 3, 4, 6};
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < 4; i++) {
        struct refocus_depth_edges_report report;

        draw(&p, disc, 1);
        reduce(&p, sides[i], true);
        report = place_small(&p, sides[i]);
        assert_true(report.parted == 1);
        if (share_within(&p, p.out, 0.02) < 0.995)
            fail_msg("means of %d x %d: %f", sides[i], sides[i], share_within(&p, p.out, 0.02));
    }
    end(&p);
}

/* Samples at points go through refocus_upsample() as they are, where the map lies on the photo. */
TEST(small_points)
{
    enum { SIDE = 5 };
    struct picture p = make(WIDTH, HEIGHT);
    const struct refocus_upsample_params params = refocus_upsample_params_default();
    const struct refocus_image photo = photo_of(&p);
    const struct refocus_disparity map =
        refocus_disparity16(p.map, WIDTH / SIDE, HEIGHT / SIDE, 2 * (WIDTH / SIDE));
    struct refocus_depth_edges_report report;

    draw(&p, disc, 1);
    reduce(&p, SIDE, false);
    report = place_small(&p, SIDE);
    assert_true(report.on_photo > 0.75F && report.changed == 0 && report.parted == 1);
    assert_int_equal(refocus_upsample(&photo, &map, &params, p.exact, 2 * WIDTH), REFOCUS_OK);
    assert_same(&p, p.exact, "points", SIDE);
    end(&p);
}

/* ----- maps beside the photo ----- */

static void assert_near(float is, double should)
{
    if (fabs(is - should) > 0.01)
        fail_msg("%f, should be %f", (double)is, should);
}

static struct seen twice_the_disc(double x, double y)
{
    return disc(x / 2, y / 2);
}

/* As of a sensor beside the camera: of samples at points that are 4 pixels off; and of twice the
 * size, where the photo is reduced to half its own. */
TEST(displaced_points_return)
{
    for (int times = 1; times <= 2; times++) {
        scene_fn *const scene = times == 1 ? disc : twice_the_disc;
        struct picture p = make(times * WIDTH, times * HEIGHT);
        const size_t size = (size_t)(p.width * p.height) * sizeof *p.exact;
        uint16_t *exact = malloc(size);
        struct refocus_depth_edges_report report;

        assert_non_null(exact);
        draw(&p, scene, 1);
        memcpy(exact, p.exact, size);
        displace(&p, scene, 4 * times, times == 1 ? 0 : -8);
        memcpy(p.exact, p.map, size);
        reduce(&p, 4 * times, false);
        report = place_small(&p, 4 * times);
        memcpy(p.exact, exact, size);
        assert_true(report.on_photo > 0.75F && report.changed > 0.01F);
        assert_true(report.shift_x == -3 * times && report.shift_y == (times == 1 ? 0 : 8));
        assert_true(share_within(&p, p.out, 0.02) >= 0.998);
        free(exact);
        end(&p);
    }
}

static struct seen larger_disc(double x, double y)
{
    return in_disc(x, y, 54) ? (struct seen){0.8, 1} : (struct seen){0.2, 0};
}

static struct seen smaller_disc(double x, double y)
{
    return in_disc(x, y, 46) ? (struct seen){0.8, 1} : (struct seen){0.2, 0};
}

/* A disc that was too large or too small by four pixels leaves 0.1 % of the pixels at its outline
 * wrong, where a digital disc of that radius is no circle; one that was shifted leaves none. */
TEST(displaced_returns)
{
    static const struct {
        scene_fn *map;
        double right, down, grown;
    } cases[] = {{larger_disc, 0, 0, 4}, {smaller_disc, 0, 0, -4}, {disc, 3, -2, 0}};
    struct picture p = make(WIDTH, HEIGHT);

    for (int i = 0; i < 3; i++) {
        struct refocus_depth_edges_report report;
        double share;

        draw(&p, disc, 1);
        displace(&p, cases[i].map, cases[i].right, cases[i].down);
        assert_true(share_within(&p, p.map, 0) < 0.985);
        report = place(&p);
        share = share_within(&p, p.out, 0);
        if (share < (cases[i].grown ? 0.998 : 1))
            fail_msg("case %d: %f of the pixels are exact", i, share);
        assert_near(report.grown, cases[i].grown);
        assert_near(report.shift_x, -cases[i].right);
        assert_near(report.shift_y, -cases[i].down);
        assert_true(report.changed > 0.01F && report.on_photo >= 0.75F && !report.bent);
    }
    end(&p);
}

/* Twelve discs of 36 pixels before a wall. */
static struct seen discs(double x, double y)
{
    const double u = fmod(x, 60) - 30, v = fmod(y, 60) - 30;

    return x >= 0 && y >= 0 && hypot(u, v) < 18 ? (struct seen){0.8, 1} : (struct seen){0.2, 0};
}

/* The discs of the left half are 3 pixels too far left, the others too far right. */
static struct seen parted_discs(double x, double y)
{
    return discs(x < WIDTH / 2 ? x + 3 : x - 3, y);
}

/* Nothing is common to all edges, but much to those near by: 94.0 % of the pixels are exact before,
 * 99.9 % after. */
TEST(bent_returns)
{
    struct picture p = make(WIDTH, HEIGHT);
    struct refocus_depth_edges_report report;

    draw(&p, discs, 1);
    displace(&p, parted_discs, 0, 0);
    assert_true(share_within(&p, p.map, 0) < 0.95);
    report = place(&p);
    assert_true(share_within(&p, p.out, 0) >= 0.995);
    assert_true(report.bent == 1 && report.grown == 0 && !report.parted);
    assert_true(report.changed > 0.05F && report.changed < 0.07F);
    end(&p);
}

/* One in 30 samples of the map is anything: 96.9 % are exact before, 99.9 % after. Of noise the
 * report says how strong it was. */
TEST(specks_of_map)
{
    struct picture p = make(WIDTH, HEIGHT);
    struct refocus_depth_edges_report report;

    draw(&p, disc, 1);
    report = place(&p);
    assert_true(report.specks == 0 && report.noise == 0);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (random_bits() % 30 == 0)
            p.map[i] = (uint16_t)random_bits();
    assert_true(share_within(&p, p.map, 0.03) < 0.98);
    report = place(&p);
    assert_true(report.specks > 0.01F && report.specks < 0.04F && report.changed > 0.01F);
    assert_true(share_within(&p, p.out, 0.03) >= 0.999);
    draw(&p, disc, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++) /* almost a Gaussian of 0.02 */
        for (int k = 0; k < 6; k++)
            p.map[i] = (uint16_t)(p.map[i] + random_bits() % 1857) - 928;
    assert_true(fabs(place(&p).noise - 0.02) < 0.003);
    end(&p);
}
