/* test_grain.c: the noise of a photo goes on into its blur, in strength and size. */
#include "pictures.h"
#include "things.h"

enum { W = 144, H = 112, TALL = 4 * H };

static uint8_t out[3 * W * H];
static const struct refocus_image image = {.struct_size = sizeof(struct refocus_image),
                                           .format = REFOCUS_FORMAT_RGB8,
                                           .width = W,
                                           .height = H,
                                           .plane = {out},
                                           .stride = {3 * W}};

static void about(const char *what, double is, double wanted, double part)
{
    if (!(fabs(is - wanted) <= part * fabs(wanted)))
        fail_msg("%s is %g, should be %g", what, is, wanted);
}

/* Noise of a part of the blurred half. */
static double noise_within(int x0, int x1, int y0, int y1)
{
    double sum = 0, squares = 0;
    int n = 0;

    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++, n++) {
            const double v = out[3 * (y * W + x) + 1];

            sum += v;
            squares += v * v;
        }
    }
    return sqrt(squares / n - sum / n * (sum / n));
}

static double noise_of(int x0, int x1)
{
    return noise_within(x0, x1, 4, H - 4);
}

/* A photo of this noise at 120, smoothed by (a, 1, a) each way, the nearer half of it in focus. */
static void draw_noise(struct picture *p, double sigma, double a)
{
    static double white[(TALL + 2) * (W + 2)];
    uint32_t seed = 5;

    for (int i = 0; i < (p->height + 2) * (W + 2); i++) {
        white[i] = 0;
        for (int k = 0; k < 12; k++)
            white[i] += ((int)(noise(&seed) % 1001) - 500) / 1000.0; /* 12 of variance 1/12 */
    }
    for (int i = 0; i < W * p->height; i++) {
        const double *at = white + (i / W + 1) * (W + 2) + i % W + 1;
        double v = 0;

        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
                v += at[y * (W + 2) + x] * (x ? a : 1) * (y ? a : 1);
        memset(p->rgb + 3 * i, (int)floor(120.5 + sigma * v / (1 + 2 * a * a)), 3);
        p->disparity[i] = i % W < W / 2 ? 60000 : 10000;
    }
}

/* Correlation of the blurred half with itself, a pixel on. */
static double correlation(void)
{
    double with = 0, own = 0, mean = 0;
    int n = 0;

    for (int y = 4; y < H - 4; y++)
        for (int x = W / 2 + 20; x < W; x++, n++)
            mean += out[3 * (y * W + x)];
    mean /= n;
    for (int y = 4; y < H - 4; y++) {
        for (int x = W / 2 + 20; x < W - 1; x++) {
            const double v = out[3 * (y * W + x)] - mean;

            with += v * (out[3 * (y * W + x + 1)] - mean);
            own += v * v;
        }
    }
    return with / own;
}

/* Grain is of the strength and the size of the photo's, and there is none where no noise is. */
TEST(grain_size)
{
    static const double sigmas[] = {2.5, 6, 0.6, 10, 20}, sides[] = {0, 0.2, 0.4};
    struct refocus_settings params = refocus_settings_default(60000 / 65535.0f, 20);

    params.render.prefilter = 0;
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 3; k++) {
            struct picture p = picture_flat(W, H, (uint8_t[3]){120, 120, 120}, 60000);
            const double a = sides[k];
            struct refocus_renderer *renderer;
            static uint8_t without[3 * W * H];

            draw_noise(&p, sigmas[i], a);
            renderer = prepared(&p, 20, 2);
            params.look.grain = 0;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
            memcpy(without, out, sizeof out);
            params.look.grain = 1;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
            if (i == 2) {
                assert_memory_equal(without, out, sizeof out);
            } else {
                about("grain", noise_of(W / 2 + 20, W), sigmas[i], 0.15);
                about("size", 1 + correlation(), 1 + 2 * a / (1 + 2 * a * a), 0.25);
            }
            refocus_renderer_destroy(&renderer);
            picture_free(&p);
        }
    }
}

/* Noise of this code above and of 208 below in the blurred half, where the photo has these. */
static void bands(int code, double dark, double bright, double noises[2])
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){120, 120, 120}, 60000);
    struct refocus_settings params = refocus_settings_default(60000 / 65535.0f, 12);
    struct refocus_renderer *renderer;
    static uint8_t above[3 * W * H / 2];

    draw_noise(&p, dark, 0);
    memcpy(above, p.rgb, sizeof above);
    draw_noise(&p, bright, 0);
    memcpy(p.rgb, above, sizeof above);
    for (int i = 0; i < 3 * W * H; i++)
        p.rgb[i] = (uint8_t)fmax(p.rgb[i] + (i < 3 * W * H / 2 ? code - 120 : 208 - 120), 0);
    renderer = prepared(&p, 12, 2);
    params.look.grain = 1;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    noises[0] = noise_within(W / 2 + 20, W, 4, H / 2 - 16);
    noises[1] = noise_within(W / 2 + 20, W, H / 2 + 16, H - 4);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Noise may rise towards the dark as a sensor's does, and little towards what is bright. */
TEST(noise_follows_brightness)
{
    double noises[2];

    bands(48, 5, 2, noises);
    about("dark", noises[0], 5, 0.12);
    about("bright", noises[1], 2, 0.12);
    bands(48, 9, 2, noises);
    about("dark, too much", noises[0], 2 * 1.25 * 2.56, 0.12);
    bands(48, 2.5, 8, noises);
    about("dark", noises[0], 2.5, 0.12);
    about("bright, too much", noises[1], 2.5 * 1.25, 0.12);
    bands(9, 9, 9, noises);
    about("cut off at black", noises[0], 9 / 3.0, 0.25);
}

/* Texture of one brightness is no noise where others are smooth. */
TEST(texture_is_no_grain)
{
    static uint8_t without[3 * W * H];
    struct picture p = picture_flat(W, H, (uint8_t[3]){120, 120, 120}, 60000);
    struct refocus_settings params = refocus_settings_default(60000 / 65535.0f, 20);
    struct refocus_renderer *renderer;

    draw_noise(&p, 6, 0.2);
    for (int y = 0; y < H / 2; y++)
        memset(p.rgb + 3 * y * W, 60 + 20 * (y / (H / 8)), 3 * W);
    renderer = prepared(&p, 20, 2);
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    memcpy(without, out, sizeof out);
    params.look.grain = 1;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    assert_memory_equal(without, out, sizeof out);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Texture is no noise where it fills all brightnesses either, as leaves do: it is finer here and
 * coarser there. The same photo with the noise of its smoothest blocks everywhere has grain. */
TEST(uneven_texture_is_no_grain)
{
    static const double strengths[] = {2.5, 7, 10, 12, 12, 10, 9, 11};
    static uint8_t without[3 * W * H], drawn[3 * W * H];
    struct refocus_settings params = refocus_settings_default(60000 / 65535.0f, 20);

    for (int kind = 0; kind < 4; kind++) {
        const bool even = kind % 2;
        struct picture p = picture_flat(W, H, (uint8_t[3]){120, 120, 120}, 60000);
        struct refocus_renderer *renderer;

        for (int k = even ? 0 : 7; k >= 0; k--) {
            draw_noise(&p, strengths[k] * (kind < 2 ? 1 : 2), 0.2);
            for (int i = 0; i < W * H; i++)
                if (even || (i % W / 8 + 3 * (i / W / 8)) % 8 == k)
                    memcpy(drawn + 3 * i, p.rgb + 3 * i, 3);
        }
        memcpy(p.rgb, drawn, sizeof drawn);
        renderer = prepared(&p, 20, 2);
        params.look.grain = 0;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        memcpy(without, out, sizeof out);
        params.look.grain = 1;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        assert_int_equal(memcmp(without, out, sizeof out) != 0, even);
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
}

/* Light and shade, in codes, of random values a grid apart and linear in between. */
static double shade_at(int x, int y, int grid)
{
    double v[4];

    for (int i = 0; i < 4; i++) {
        uint32_t seed = (uint32_t)((x / grid + i % 2) * 7919 + (y / grid + i / 2) * 104729 + grid);

        noise(&seed);
        v[i] = (int)(noise(&seed) >> 8) % 1001 / 500.0 - 1;
    }
    for (int i = 0; i < 2; i++)
        v[i] += (v[i + 2] - v[i]) * (y % grid) / grid;
    return v[0] + (v[1] - v[0]) * (x % grid) / grid;
}

/* Clouds of all sizes, strongest where they are large, and part / 128 noise of 8 codes in between.
 */
static void draw_clouds(struct picture *p, int part)
{
    draw_noise(p, 8, 0);
    for (int i = 0; i < W * p->height; i++) {
        double v = 120.5;

        for (int grid = 2; grid <= 16; grid *= 2)
            v += shade_at(i % W, i / W, grid) * 4 * grid;
        v = (fmin(fmax(v, 0), 255) * (128 - part) + p->rgb[3 * i] * part) / 128;
        memset(p->rgb + 3 * i, (int)floor(v), 3);
    }
}

/* The standard deviation of what grain changes, half of the photo being in focus. */
static double grain_of(const struct picture *p)
{
    static uint8_t with[3 * W * TALL], without[sizeof with];
    const struct refocus_image picture =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, with, p->width, p->height, 3 * p->width);
    struct refocus_settings params = refocus_settings_default(60000 / 65535.0f, 20);
    struct refocus_renderer *renderer = prepared(p, 20, 2);
    double squares = 0;

    assert_int_equal(refocus_render_settings(renderer, &params, &picture), REFOCUS_OK);
    memcpy(without, with, sizeof with);
    params.look.grain = 1;
    assert_int_equal(refocus_render_settings(renderer, &params, &picture), REFOCUS_OK);
    for (int i = 1; i < 3 * W * p->height; i += 3)
        squares += i / 3 % W < W / 2 + 20 ? 0 : pow(with[i] - without[i], 2);
    refocus_renderer_destroy(&renderer);
    return sqrt(squares / (p->height * (W / 2 - 20)));
}

/* Texture that is alike in all places of all brightnesses is told by its size, and a pattern by
 * being too much alike. */
TEST(even_texture_is_no_grain)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){120, 120, 120}, 60000);

    draw_clouds(&p, 0);
    assert_true(grain_of(&p) == 0);
    for (int i = 0; i < W * H; i++) /* stripes, six pixels wide */
        memset(p.rgb + 3 * i, (int)floor(120.5 + 8 * cos((i % W + i / W) * 3.14159265 / 3)), 3);
    assert_true(grain_of(&p) == 0);
    picture_free(&p);
}

/* A sky without noise does not make noise of the texture beside it. */
TEST(smooth_parts_tell_nothing)
{
    struct picture p = picture_flat(W, TALL, (uint8_t[3]){120, 120, 120}, 60000);
    struct picture sky = picture_flat(W, H, (uint8_t[3]){120, 120, 120}, 60000);

    draw_clouds(&p, 28);
    draw_noise(&sky, 0.5, 0);
    for (int i = 0; i < 3 * W * H; i++)
        p.rgb[i] = p.rgb[3 * W * H + i] = (uint8_t)(sky.rgb[i] - 100);
    assert_true(grain_of(&p) == 0);
    picture_free(&p);
    picture_free(&sky);
}

/* From texture to noise grain grows by steps smaller than it is, 5 codes where noise is half. */
TEST(grain_grows_with_noise)
{
    double is = 0;

    for (int part = 0; part <= 128; part += part < 64 ? 1 : 8) {
        struct picture p = picture_flat(W, TALL, (uint8_t[3]){120, 120, 120}, 60000);
        const double last = is;

        draw_clouds(&p, part);
        is = grain_of(&p);
        assert_true(fabs(is - last) < 2.5);
        picture_free(&p);
    }
    about("noise alone", is, 8, 0.12);
}

/* A number that hangs on every code of the picture. */
static uint64_t weigh_codes(void)
{
    uint64_t sum = 0;

    for (uint64_t i = 0; i < sizeof out; i++)
        sum += out[i] * (i % 251 + 1);
    return sum;
}

TEST(grain)
{
    static uint8_t first[3 * W * H];
    struct picture p = picture_flat(W, H, (uint8_t[3]){120, 120, 120}, 60000);
    struct refocus_settings params = refocus_settings_default(60000 / 65535.0f, 20);
    struct refocus_renderer *renderer;
    uint32_t seed = 5;

    for (int i = 0; i < W * H; i++) {
        int v = 120;

        for (int k = 0; k < 12; k++)
            v += (int)(noise(&seed) % 5) - 2; /* 12 of variance 2: about 4.9 */
        memset(p.rgb + 3 * i, v, 3);
        p.disparity[i] = i % W < W / 2 ? 60000 : 10000;
    }
    renderer = prepared(&p, 20, 2);
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    assert_true(noise_of(W / 2 + 20, W) < 1.5);
    params.look.grain_seed = 1;
    for (int amount = 1; amount <= 2; amount++) {
        params.look.grain = (float)amount;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        about("grain", noise_of(W / 2 + 20, W), 4.9 * amount, 0.12);
        for (int y = 0; y < H; y++) /* a sharp pixel has its own grain */
            assert_memory_equal(out + 3 * y * W, p.rgb + 3 * y * W, 3 * (W / 2 - 16));
    }
    assert_int_equal(weigh_codes(), 0x2b88799e); /* on every processor */
    memcpy(first, out, sizeof out);
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    assert_memory_equal(first, out, sizeof out);
    params.look.grain_seed = 2;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    assert_true(memcmp(first, out, sizeof out) != 0);
    /* a method that renders the frame as a whole: grain is in each of its tiles */
    params.render.method = REFOCUS_METHOD_SCATTER;
    params.look.grain = 0;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    memcpy(first, out, sizeof out);
    params.look.grain = 2;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    for (int y = 0; y < H; y += 16)
        for (int x = W - 48; x < W; x += 16) {
            int changed = 0;

            for (int i = 0; i < 256; i++) {
                const int at = 3 * ((y + i / 16) * W + x + i % 16);

                changed += out[at] != first[at];
            }
            assert_in_range(changed, 128, 256);
        }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
