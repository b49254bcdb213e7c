/* test_planes.c: one plane facing the camera: nothing hides anything, so every method that takes
 * all rays of the mask computes the same convolution. */
#include "pictures.h"

enum { W = 90, H = 60, K = 7 };

static struct refocus_aperture *aperture; /* NULL: the disc */

static void render(struct refocus_renderer *renderer, uint32_t method, uint8_t *out)
{
    struct refocus_settings params = refocus_settings_default(0, K);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);

    params.render.method = method;
    params.render.aperture = aperture;
    params.render.rays = REFOCUS_RAYS_FULL;
    params.jittered.cell = 1;
    params.foveated.angle = 170;
    params.render.blend = REFOCUS_BLEND_STORED;
    params.search.iterations = 1;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
}

/* Mean and largest difference to full tracing, away from the border. */
static void differences(const uint8_t *a, const uint8_t *b, double *mean, int *most)
{
    int count = 0;

    *mean = 0;
    *most = 0;
    for (int y = K + 1; y < H - K - 1; y++) {
        for (int i = 3 * (K + 1); i < 3 * (W - K - 1); i++) {
            const int apart = abs(a[3 * W * y + i] - b[3 * W * y + i]);

            *mean += apart;
            *most = apart > *most ? apart : *most;
            count++;
        }
    }
    *mean /= count;
}

TEST(one_plane)
{
    /* The methods count mask pixels at the edge differently, and Mulder's discs are 2 K +
     * 1 across. */
    static const struct {
        uint32_t method;
        int most;
    } same[] = {{REFOCUS_METHOD_SWEEP, 1},      {REFOCUS_METHOD_SEARCH, 1},
                {REFOCUS_METHOD_LIGHTFIELD, 1}, {REFOCUS_METHOD_BLUR, 1},
                {REFOCUS_METHOD_JITTERED, 4},   {REFOCUS_METHOD_SCATTER, 4},
                {REFOCUS_METHOD_FOVEATED, 8}};
    struct picture p = picture_make(W, H, 77);
    static uint8_t truth[3 * W * H], out[3 * W * H];
    struct refocus_renderer *renderer;
    double mean;
    int most;

    for (int i = 0; i < W * H; i++)
        p.disparity[i] = 65535;
    renderer = prepared(&p, K, 2);
    render(renderer, REFOCUS_METHOD_RAYTRACE, truth);
    differences(truth, p.rgb, &mean, &most);
    assert_true(mean > 8); /* it is blurred */
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        render(renderer, same[i].method, out);
        differences(out, truth, &mean, &most);
        printf("%-12s %d at most, %.3f in the mean\n", refocus_method_name(same[i].method), most,
               mean);
        if (most > same[i].most)
            fail_msg("%s: %d from full tracing", refocus_method_name(same[i].method), most);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* A triangle that points to the side: a lens that is turned about would be seen. */
TEST(triangle)
{
    static uint8_t truth[3 * W * H], out[3 * W * H];
    struct picture p = picture_make(W, H, 78);
    struct refocus_renderer *renderer;
    double mean;
    int most;

    for (int i = 0; i < W * H; i++)
        p.disparity[i] = 65535;
    renderer = prepared(&p, K, 2);
    assert_int_equal(refocus_aperture_create_polygon(&aperture, 3, 20), REFOCUS_OK);
    render(renderer, REFOCUS_METHOD_RAYTRACE, truth);
    render(renderer, REFOCUS_METHOD_BLUR, out);
    differences(out, truth, &mean, &most);
    assert_true(most <= 1);
    refocus_aperture_destroy(&aperture);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* A white half before a black one that is in focus. Light falls off beyond the edge as the share
 * of rays that the near half catches; on its own side too, by the views of the light field. */
TEST(falls_off)
{
    static const struct {
        uint32_t method;
        bool behind;
    } methods[] = {{REFOCUS_METHOD_LIGHTFIELD, true},
                   {REFOCUS_METHOD_SWEEP, false},
                   {REFOCUS_METHOD_RAYTRACE, false},
                   {REFOCUS_METHOD_JITTERED, false}};
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, 0);
    static uint8_t out[3 * W * H];
    struct refocus_renderer *renderer;

    for (int i = 0; i < W * H; i++) {
        if (i % W < W / 2) {
            memset(p.rgb + 3 * i, 200, 3);
            p.disparity[i] = 65535;
        }
    }
    renderer = prepared(&p, K, 2);
    for (int m = 0; m < 4; m++) {
        render(renderer, methods[m].method, out);
        for (int x = W / 2 - (methods[m].behind ? K + 2 : 0); x < W / 2 + K + 2; x++) {
            /* share of the disc that lies on the near side of an edge at distance e */
            const double e = (W / 2 - 0.5 - x) / K, c = e < -1 ? -1 : e > 1 ? 1 : e;
            const double share = 0.5 + (c * sqrt(1 - c * c) + asin(c)) / 3.14159265358979;
            const int value = out[3 * (H / 2 * W + x)];

            if (fabs(value - 200 * share) > 9)
                fail_msg("%s: %d at %d from the edge, %.1f by the disc's area",
                         refocus_method_name(methods[m].method), value, x - W / 2, 200 * share);
        }
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Outside of the centre of attention a near white half spreads over the black one in focus, about
 * as far as a disc does, and no seam is left on its own side. */
TEST(pyramids_fall_off)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, 0);
    struct refocus_settings params = refocus_settings_default(0, K);
    static uint8_t out[3 * W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_renderer *renderer;

    for (int i = 0; i < W * H; i++) {
        if (i % W < W / 2) {
            memset(p.rgb + 3 * i, 200, 3);
            p.disparity[i] = 65535;
        }
    }
    renderer = prepared(&p, K, 2);
    params.render.method = REFOCUS_METHOD_FOVEATED;
    params.render.blend = REFOCUS_BLEND_STORED;
    params.foveated.angle = 1;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
    for (int x = W / 2; x < W / 2 + 5; x++) {
        const double e = (W / 2 - 0.5 - x) / K;
        const double share = 0.5 + (e * sqrt(1 - e * e) + asin(e)) / 3.14159265358979;
        const int value = out[3 * (H / 4 * W + x)];

        printf("%d beyond the edge: %d, %.1f by the disc's area\n", x - W / 2, value, 200 * share);
        if (fabs(value - 200 * share) > 25)
            fail_msg("%d at %d from the edge, %.1f by the disc's area", value, x - W / 2,
                     200 * share);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* The light field takes what is hidden from both sides alike, where both are as far: a pole before
 * a wall that is red to its left and blue to its right leaves as much of either. */
TEST(both_sides)
{
    static const uint8_t black[3];
    static uint8_t out[3 * W * H];
    struct picture p = picture_flat(W, H, black, 0);
    struct refocus_renderer *renderer;
    double red = 0, blue = 0;

    for (int i = 0; i < W * H; i++) {
        if (abs(2 * (i % W) - (W - 1)) < 5) /* four pixels */
            p.disparity[i] = 65535;
        else
            p.rgb[3 * i + (i % W < W / 2 ? 0 : 2)] = 255;
    }
    renderer = prepared(&p, K, 1);
    render(renderer, REFOCUS_METHOD_LIGHTFIELD, out);
    for (int i = 0; i < W * H; i++) {
        red += out[3 * i];
        blue += out[3 * i + 2];
    }
    assert_true(fabs(red - blue) < 0.001 * red);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
