/* test_preview.c: the two quick methods: NVIDIA's table against its formula, and the volume of
 * attention of Mulder & van Liere. */
#include "papers/blurriness.h"
#include "pictures.h"

static const double pi = 3.14159265358979323846;

/* Equation 1 of the white paper, D the camera distance, F the focus distance, all in metres. */
static double white_paper(double D, double F, double f, double N)
{
    return fabs((F / D - 1) * f * f / (N * (F - f)));
}

/* 0 at c0 and below, 1/2 at r1 c0, 1 at r2 c0 and above. */
static double interpolator(double circle, double c0, double r1, double r2)
{
    if (circle <= c0)
        return 0;
    if (circle <= r1 * c0)
        return 0.5 * (circle - c0) / (r1 * c0 - c0);
    return fmin(1, 0.5 + 0.5 * (circle - r1 * c0) / (r2 * c0 - r1 * c0));
}

TEST(table)
{
    static const struct {
        double f, N, focus, near, far;
    } lens[] = {{0.05, 1.8, 2, 0.8, 1e9}, {0.085, 1.4, 3, 1, 40}, {0.028, 2.8, 0.6, 0.4, 9}};
    const double pixels_per_metre = 720 / 0.036, c0 = 0.7, r1 = 3, r2 = 9;

    for (int i = 0; i < 3; i++) {
        const double a = 1 / lens[i].near, b = 1 / lens[i].far;
        const double df = (1 / lens[i].focus - b) / (a - b);
        /* radius at d = 1 for a focus at d = 0: any two points give K */
        const double K = white_paper(lens[i].near, lens[i].focus, lens[i].f, lens[i].N) / 2 *
                         pixels_per_metre / (1 - df);
        uint8_t entry[RF_BLURRINESS_SIZE];

        rf_blurriness_table(entry, df, K, c0, r1 * c0, r2 * c0);
        for (int k = 0; k < RF_BLURRINESS_SIZE; k++) {
            const double D = 1 / (b + k / (RF_BLURRINESS_SIZE - 1.0) * (a - b));
            const double circle =
                white_paper(D, lens[i].focus, lens[i].f, lens[i].N) / 2 * pixels_per_metre;
            const double expected = 255 * interpolator(circle, c0, r1, r2);

            if (fabs(entry[k] - expected) > 0.51)
                fail_msg("lens %d, %g m: %d, the formula gives %g", i, D, entry[k], expected);
        }
    }
}

static void render(struct refocus_renderer *renderer, const struct picture *p, float angle,
                   float depth, uint8_t *out)
{
    struct refocus_settings params = refocus_settings_default(0.4f, 9);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, p->width, p->height, 3 * p->width);

    params.render.method = REFOCUS_METHOD_FOVEATED;
    params.foveated.x = 0.25f;
    params.foveated.angle = angle;
    params.foveated.depth = depth;
    params.foveated.picture_angle = 60;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
}

/* Inside the cone the bytes are those of the exact technique, outside of its fading side those
 * of the fast one. */
TEST(volume)
{
    enum { W = 160, H = 90 };
    struct picture p = picture_make(W, H, 17);
    struct refocus_renderer *renderer = prepared(&p, 9, 2);
    static uint8_t all[3 * W * H], none[3 * W * H], some[3 * W * H], flat[3 * W * H];
    const double radius = W / 2.0 * tan(10 * pi / 180) / tan(30 * pi / 180);
    int in = 0, out = 0, differ = 0;

    render(renderer, &p, 165, 1, all);
    render(renderer, &p, 0, 1, none);
    render(renderer, &p, 20, 1, some);
    render(renderer, &p, 165, 0.1f, flat); /* attention by depth */
    for (int i = 0; i < W * H; i++) {
        const double r = hypot(i % W - 0.25 * (W - 1), i / W - 0.5 * (H - 1));
        const double d = fabs(p.disparity[i] / 65535.0 - (double)0.4f);

        differ += memcmp(all + 3 * i, none + 3 * i, 3) != 0;
        if (r < radius - 0.01) {
            assert_memory_equal(some + 3 * i, all + 3 * i, 3);
            in++;
        } else if (r > 1.25 * radius + 0.01) {
            assert_memory_equal(some + 3 * i, none + 3 * i, 3);
            out++;
        }
        if (d < 0.099)
            assert_memory_equal(flat + 3 * i, all + 3 * i, 3);
        if (d > 0.201)
            assert_memory_equal(flat + 3 * i, none + 3 * i, 3);
    }
    assert_true(in > 1500 && out > 5000 && differ > W * H / 4);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Renders a photo all of which is behind the focus, blurred by a radius. */
static void render_far(const struct picture *far, float blur, float angle, uint8_t *out)
{
    struct refocus_renderer *renderer = prepared(far, blur, 1);
    struct refocus_settings params = refocus_settings_default(1, blur);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, far->width, far->height, 3 * far->width);

    params.render.method = REFOCUS_METHOD_FOVEATED;
    params.foveated.angle = angle;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
    refocus_renderer_destroy(&renderer);
}

/* The fast technique treats all borders alike: a photo turned upside down becomes the picture
 * upside down, to within what the places of samples do, whatever the size. */
TEST(turned)
{
    enum { MOST = 97 };
    static const float blurs[] = {5, 20, 60};
    static const uint8_t black[3];
    static uint8_t out[3 * MOST * MOST], back[3 * MOST * MOST];

    for (int k = 0; k < 12; k++) {
        const int side = MOST - k / 3, last = side * side - 1;
        struct picture p = picture_flat(side, side, black, 0);
        struct picture other = picture_flat(side, side, black, 0);

        for (int i = 0; i < 3 * side * side; i++) {
            const int x = i / 3 % side, y = i / 3 / side;

            p.rgb[i] = (uint8_t)(128 + 100 * sin(x * 0.11 + i % 3) * cos(y * 0.07));
            other.rgb[3 * (last - i / 3) + i % 3] = p.rgb[i];
        }
        render_far(&p, blurs[k % 3], 0, out);
        render_far(&other, blurs[k % 3], 0, back);
        for (int i = 0; i < 3 * side * side; i++)
            assert_in_range(out[i] + 20 - back[3 * (last - i / 3) + i % 3], 0, 40);
        picture_free(&p);
        picture_free(&other);
    }
}

/* The exact technique spreads a point of light over the pixels whose middles are in a disc of an
 * odd diameter, that which is nearest to the circle of confusion's. */
TEST(diameters)
{
    enum { SIDE = 41, MIDDLE = SIDE / 2 };
    static const uint8_t black[3];
    static uint8_t out[3 * SIDE * SIDE];

    for (float r = 0.25f; r < 12; r += 0.25f) {
        struct picture p = picture_flat(SIDE, SIDE, black, 0);
        int widest = 0;

        memset(p.rgb + 3 * (MIDDLE * SIDE + MIDDLE), 255, 3);
        render_far(&p, r, 165, out);
        while (out[3 * (MIDDLE * SIDE + MIDDLE + widest + 1)])
            widest++;
        assert_true(fabsf((float)(2 * widest + 1) - 2 * r) <= 1);
        for (int i = 0; i < SIDE * SIDE; i++)
            assert_int_equal(out[3 * i] > 0,
                             hypot(i % SIDE - MIDDLE, i / SIDE - MIDDLE) < widest + 0.5);
        picture_free(&p);
    }
}
