/* test_jittered.c: jittered sampling: repeatable by its seed, the mean of many is full tracing. */
#include "pictures.h"

enum { W = 40, H = 30 };

static void render(struct refocus_renderer *renderer, uint32_t method, int cell, uint32_t seed,
                   uint8_t *out)
{
    struct refocus_settings params = refocus_settings_default(0.3f, 6);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);

    params.render.method = method;
    params.render.rays = REFOCUS_RAYS_FULL;
    params.render.blend = REFOCUS_BLEND_STORED;
    params.jittered.cell = cell;
    params.jittered.seed = seed;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
}

TEST(seeds)
{
    struct picture p = picture_make(W, H, 5);
    struct refocus_renderer *one = prepared(&p, 6, 1), *three = prepared(&p, 6, 3);
    uint8_t a[3 * W * H], b[3 * W * H];

    for (int cell = 2; cell <= 4; cell++) {
        render(one, REFOCUS_METHOD_JITTERED, cell, 9, a);
        render(three, REFOCUS_METHOD_JITTERED, cell, 9, b);
        assert_same_pixels(b, a, W, H, "the same seed");
        render(one, REFOCUS_METHOD_JITTERED, cell, 10, b);
        assert_true(memcmp(a, b, sizeof a) != 0);
    }
    refocus_renderer_destroy(&one);
    refocus_renderer_destroy(&three);
    picture_free(&p);
}

/* Cells of one pixel leave nothing to chance: full tracing, but for how mask pixels at the edge
 * count. Larger cells scatter about it without a bias. */
TEST(mean_of_many)
{
    enum { MANY = 40 };
    struct picture p = picture_make(W, H, 6);
    struct refocus_renderer *renderer = prepared(&p, 6, 2);
    static uint8_t full[3 * W * H], exact[3 * W * H], out[3 * W * H];
    static double sum[3 * W * H];
    double bias = 0, scatter = 0, edge = 0;

    render(renderer, REFOCUS_METHOD_RAYTRACE, 2, 0, full);
    render(renderer, REFOCUS_METHOD_JITTERED, 1, 0, exact);
    for (uint32_t seed = 0; seed < MANY; seed++) {
        render(renderer, REFOCUS_METHOD_JITTERED, 3, seed, out);
        for (int i = 0; i < 3 * W * H; i++) {
            sum[i] += out[i] / (double)MANY;
            scatter += pow(out[i] - exact[i], 2) / (3.0 * W * H * MANY);
        }
    }
    for (int i = 0; i < 3 * W * H; i++) {
        bias += pow(sum[i] - exact[i], 2) / (3.0 * W * H);
        edge += pow((double)full[i] - exact[i], 2) / (3.0 * W * H);
    }
    if (sqrt(edge) > 2.5 || sqrt(scatter) < 3 || bias > scatter / 8)
        fail_msg("rms %g at the edge, %g of one, %g of the mean", sqrt(edge), sqrt(scatter),
                 sqrt(bias));
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
