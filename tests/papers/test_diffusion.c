/* test_diffusion.c: Kosloff & Barsky 2007: figure 2, and the series against the paper's single
 * steps. */

#include "papers/diffusion.h"
#include "pictures.h"
#include "../clock.h"

/* A near disc, its edge sharp and its middle blurred, before a far wall: the field is a picture
 * that is white in the middle. Red before green: green in the middle means it leaks. */
TEST(figure_2)
{
    enum { SIDE = 120, RADIUS = 40, EDGE = 8 };
    struct picture p = picture_flat(SIDE, SIDE, (uint8_t[3]){0, 200, 0}, 0);
    static uint8_t field[SIDE * SIDE], out[3 * SIDE * SIDE];
    struct refocus_disparity map = refocus_disparity8(field, SIDE, SIDE, SIDE);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, SIDE, SIDE, 3 * SIDE);
    struct refocus_renderer *renderer;
    double naive_leak = 0;

    for (int i = 0; i < SIDE * SIDE; i++) {
        const double r = hypot(i % SIDE - SIDE / 2, i / SIDE - SIDE / 2);

        if (r < RADIUS) {
            p.disparity[i] = 65535;
            p.rgb[3 * i] = (uint8_t)(i / 4 % 2 ? 255 : 180);
            p.rgb[3 * i + 1] = 0;
        }
        field[i] = r < RADIUS - EDGE ? 255 : 0;
    }
    renderer = prepared(&p, 30, 2);
    for (uint32_t solver = 0; solver < 2; solver++) {
        struct refocus_settings params = refocus_settings_default(0, 30);

        params.render.method = REFOCUS_METHOD_DIFFUSION;
        params.diffusion.solver = solver;
        params.field.shape = REFOCUS_FIELD_PICTURE;
        params.field.map = &map;
        params.diffusion.layers = 2;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double r = hypot(i % SIDE - SIDE / 2, i / SIDE - SIDE / 2);

            if (r < RADIUS && out[3 * i + 1] > 1)
                fail_msg("%d of the wall shines through at radius %g", out[3 * i + 1], r);
            if (r >= RADIUS)
                assert_memory_equal(out + 3 * i, p.rgb + 3 * i, 3);
            if (r < RADIUS - 2 * EDGE && abs(out[3 * i] - 222) > 12)
                fail_msg("the middle is %d, its texture should be gone", out[3 * i]);
        }
    }
    /* The naive filter: alpha averaged over a disc of the pixel's own radius. */
    for (int y = -30; y <= 30; y++)
        for (int x = -30; x <= 30; x++) /* about a pixel near the edge, blurred by 30 */
            naive_leak += hypot(x, y) <= 30 && hypot(x + RADIUS - EDGE - 2, y) >= RADIUS;
    naive_leak /= 30 * 30 * 3.14159;
    assert_true(naive_leak > 0.1);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* The two solvers within a grey level; blur of the whole K in every field. The times are said,
 * not judged: papers.py measures them. */
TEST(solvers)
{
    enum { MOST = 96 * 64 };
    static const struct { /* steps grow with the square of the blur */
        float blur;
        uint32_t field;
        int width, height;
    } cases[] = {{20, REFOCUS_FIELD_LENS, 96, 64},   {40, REFOCUS_FIELD_LENS, 72, 48},
                 {80, REFOCUS_FIELD_LENS, 40, 28},   {20, REFOCUS_FIELD_CYLINDER, 96, 64},
                 {40, REFOCUS_FIELD_SPHERE, 64, 40}, {20, REFOCUS_FIELD_PLUS, 96, 64},
                 {20, REFOCUS_FIELD_PLANE, 96, 64}};
    static uint8_t out[2][3 * MOST];
    int bad = 0;

    for (uint32_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const int w = cases[i].width, h = cases[i].height;
        struct refocus_renderer *renderer;
        double seconds[2];
        struct picture p;
        int worst = 0;

        if (left_out((int)i, 3))
            continue;
        p = picture_make(w, h, 60u + i);
        renderer = prepared(&p, cases[i].blur, 1);
        for (uint32_t solver = 0; solver < 2; solver++) {
            struct refocus_settings params = refocus_settings_default(0, cases[i].blur);
            const struct refocus_image image =
                refocus_image_packed(REFOCUS_FORMAT_RGB8, out[solver], w, h, 3 * w);

            params.render.method = REFOCUS_METHOD_DIFFUSION;
            params.diffusion.solver = solver;
            params.field.shape = cases[i].field;
            params.field.disparity = 0.2f;
            seconds[solver] = -1e-3 * now_ms();
            assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
            seconds[solver] += 1e-3 * now_ms();
        }
        for (int k = 0; k < 3 * w * h; k++)
            worst = abs(out[0][k] - out[1][k]) > worst ? abs(out[0][k] - out[1][k]) : worst;
        printf("diffusion K = %g, field %u: %d grey levels apart, %.3f s by steps, %.3f s by "
               "series, %.1f times\n",
               (double)cases[i].blur, (unsigned)cases[i].field, worst, seconds[1], seconds[0],
               seconds[1] / seconds[0]);
        if (worst > 1)
            bad++;
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
    assert_int_equal(bad, 0);
}

TEST(terms)
{
    static const double radii[] = {5, 10, 20, 40, 80, 127};
    struct rf_series series;

    for (int i = 0; i < 6; i++) {
        const int steps = (int)ceil(radii[i] * radii[i] / (2 * 0.125));

        rf_series_make(&series, steps, 0.125);
        printf("diffusion r = %g: %d steps or a series of %d terms, %.1f times fewer\n", radii[i],
               steps, series.terms, (double)steps / series.terms);
        if (radii[i] >= 20)
            assert_true(steps >= 20 * series.terms);
    }
}

/* Eq. 3 of the paper, over every edge pixel. */
static double extrapolated(const struct rf_diffusion_layer *layer, int count, int x, int y)
{
    double sum = 0, weight = 0;

    for (int i = 0; i < count; i++) {
        const double dx = (double)layer->edge_x[i] - x, dy = (double)layer->edge_y[i] - y;
        const double g = 1 / (dx * dx + dy * dy);

        sum += g * (double)layer->edge_radius[i];
        weight += g;
    }
    return sum / weight;
}

/* Edge pixels farther than a tile count together, a tile of them at a time: how far that is from
 * eq. 3. Two objects, the one with blur that goes up and down along its edge. */
TEST(lumped_edges)
{
    enum { W = 150, H = 110, TILES_X = (W + 15) / 16, TILES_Y = (H + 15) / 16 };
    static uint8_t member[W * H];
    static uint16_t rings[W * H];
    static float radius[W * H], outside[W * H], x[W * H], y[W * H], blur[W * H];
    static struct rf_edge_tile tile[TILES_X * TILES_Y];
    static struct rf_span span[H];
    const struct rf_viewport view = {.width = W, .height = H, .stride = W};
    const struct rf_executor exec = {.run = NULL};
    const struct rf_frame f = {.exec = &exec, .view = &view};
    struct rf_diffusion_layer layer = {.f = &f,
                                       .member = member,
                                       .number = 1,
                                       .radius = radius,
                                       .outside = outside,
                                       .rings = rings,
                                       .span = span,
                                       .stride = W,
                                       .edge_x = x,
                                       .edge_y = y,
                                       .edge_radius = blur,
                                       .tile = tile,
                                       .tiles_x = TILES_X,
                                       .tiles_y = TILES_Y};
    double worst = 0, sum = 0;
    int count = 0, pixels = 0;

    for (int i = 0; i < W * H; i++) {
        const int px = i % W, py = i / W;

        member[i] = hypot(px - 40, py - 50) < 25 || (px > 95 && px < 130 && py > 30 && py < 80);
        radius[i] = px < 75 ? 10 + 8 * sinf((float)py / 6) : 25;
    }
    assert_true(rf_layer_grow(&layer));
    rf_layer_list_edge(&layer);
    for (int i = 0; i < TILES_X * TILES_Y; i++)
        count += tile[i].count;
    for (int i = 0; i < TILES_X * TILES_Y; i++)
        rf_layer_extrapolate_tile(&layer, i);
    for (int i = 0; i < W * H; i++) {
        if (rings[i] == 0 || rings[i] > layer.reach)
            continue;
        const double exact = extrapolated(&layer, count, i % W, i / W);
        const double error = fabs((double)outside[i] / exact - 1);

        worst = fmax(worst, error);
        sum += error;
        pixels++;
    }
    printf("diffusion, eq. 3 with lumped edges: %d pixels, %.3f %% off in the mean, %.2f %% at "
           "most\n",
           pixels, 100 * sum / pixels, 100 * worst);
    assert_true(pixels > W * H / 2);
    assert_true(worst > 0); /* far edge pixels are lumped: radii are not exact */
    assert_true(worst < 0.05 && sum / pixels < 0.006);
}

/* The layer that a blurred object uncovers counts as whole wherever there is any of it: a red strip
 * of 13 pixels before a green wall, both blurred, gives red of 13 pixels to a row, though the wall,
 * cut out behind the strip, flows into the gap and is thin there. */
TEST(under_layer)
{
    enum { SIDE = 96, STRIP = 13, RED = 240 };
    struct picture p = picture_flat(SIDE, SIDE, (uint8_t[3]){0, RED, 0}, 0);
    static uint8_t out[3 * SIDE * SIDE];
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, SIDE, SIDE, 3 * SIDE);
    struct refocus_settings params = refocus_settings_default(0.4f, 12);
    struct refocus_renderer *renderer;
    int red = 0, mixed = 0;

    for (int i = 0; i < SIDE * SIDE; i++) {
        if (abs(i % SIDE - SIDE / 2) > STRIP / 2)
            continue;
        p.disparity[i] = 65535;
        memcpy(p.rgb + 3 * i, (uint8_t[3]){RED, 0, 0}, 3);
    }
    renderer = prepared(&p, 12, 2);
    params.render.method = REFOCUS_METHOD_DIFFUSION;
    params.render.blend = REFOCUS_BLEND_STORED;
    params.diffusion.layers = 2;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
    for (int x = 0; x < SIDE; x++) {
        const uint8_t *at = out + 3 * (SIDE / 2 * SIDE + x);

        assert_true(abs(at[0] + at[1] - RED) <= 2); /* no black between them */
        red += at[0];
        mixed += at[0] > 30 && at[1] > 30;
    }
    printf("diffusion: red of %.2f pixels in a row, the strip has %d\n", (double)red / RED, STRIP);
    assert_true(mixed >= 12);
    assert_true(abs(red - STRIP * RED) < STRIP * RED * 3 / 100);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
