/* test_matte.c: a matte of the caller's: src/thin/given.c and settle.c. */
#include "pictures.h"

#include "canceller.h"

enum { WIDTH = 151, HEIGHT = 118, PIXELS = WIDTH * HEIGHT, NEAR = 50000, FAR = 12000 };
static const float K = 20;

/* A disc and a comb of teeth, some thinner than a pixel, before a wall: with the true layers. */
struct layers {
    double near[PIXELS][3], far[PIXELS][3], alpha[PIXELS]; /* linear light */
    uint8_t rgb[3 * PIXELS], matte[PIXELS];
    uint16_t disparity[PIXELS];
};

static double hue(uint32_t *seed, double least, double most)
{
    return least + (most - least) * (noise(seed) >> 8) / (1 << 24);
}

static bool is_subject(double x, double y)
{
    const double tooth = fmod(y - 12, 9), wide = 0.7 + 0.5 * (int)((y - 12) / 9);

    return (x - 45) * (x - 45) + (y - 60) * (y - 60) < 30 * 30 || (x > 66 && x < 80) ||
           (x >= 80 && x < 135 && y > 12 && y < 60 && tooth < wide);
}

static double coverage(int x, int y)
{
    enum { PARTS = 16 };
    int inside = 0;

    for (int j = 0; j < PARTS; j++)
        for (int i = 0; i < PARTS; i++)
            inside += is_subject(x + (i + 0.5) / PARTS, y + (j + 0.5) / PARTS);
    return (double)inside / (PARTS * PARTS);
}

/* Patches of 4 x 4 pixels, red before and blue behind. */
static void draw(struct layers *l)
{
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        uint32_t seed = (uint32_t)(1 + y / 4 * WIDTH + x / 4) * 2654435761u;

        l->alpha[i] = coverage(x, y);
        l->matte[i] = (uint8_t)(255 * l->alpha[i] + 0.5);
        l->disparity[i] = l->alpha[i] >= 0.5 ? NEAR : FAR;
        for (int c = 0; c < 3; c++) {
            l->near[i][c] = c == 0 ? hue(&seed, 0.4, 0.9) : hue(&seed, 0.02, 0.2);
            l->far[i][c] = c == 2 ? hue(&seed, 0.4, 0.9) : hue(&seed, 0.02, 0.3);
            l->rgb[3 * i + c] =
                picture_code(l->alpha[i] * l->near[i][c] + (1 - l->alpha[i]) * l->far[i][c]);
        }
    }
}

/* The map as a network makes it: soft, and without what is thin. */
static void soften(const struct layers *l, uint16_t *out)
{
    enum { SOFT = 3, SIDE = 2 * SOFT + 1 };

    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            int sum = 0;

            for (int j = -SOFT; j <= SOFT; j++)
                for (int i = -SOFT; i <= SOFT; i++) {
                    const int u = x + i < 0 ? 0 : x + i >= WIDTH ? WIDTH - 1 : x + i;
                    const int v = y + j < 0 ? 0 : y + j >= HEIGHT ? HEIGHT - 1 : y + j;

                    sum += u >= 80 ? FAR : l->disparity[v * WIDTH + u];
                }
            out[y * WIDTH + x] = (uint16_t)(sum / (SIDE * SIDE));
        }
}

/* The mean of a layer's value over a disc, by the parts of pixels that it covers. */
static double blurred(const double *layer, int step, int x, int y, double radius)
{
    enum { PARTS = 4 };
    const int reach = (int)radius + 1;
    double sum = 0;
    int count = 0;

    for (int j = -reach * PARTS; j < (reach + 1) * PARTS; j++)
        for (int i = -reach * PARTS; i < (reach + 1) * PARTS; i++) {
            const double dx = (i + 0.5) / PARTS - 0.5, dy = (j + 0.5) / PARTS - 0.5;
            int u = x + (int)floor(dx + 0.5), v = y + (int)floor(dy + 0.5);

            if (dx * dx + dy * dy > radius * radius && (radius > 0.5 || u != x || v != y))
                continue;
            u = u < 0 ? 0 : u >= WIDTH ? WIDTH - 1 : u;
            v = v < 0 ? 0 : v >= HEIGHT ? HEIGHT - 1 : v;
            sum += layer[(v * WIDTH + u) * step];
            count++;
        }
    return sum / count;
}

/* PSNR against the layers, each blurred, of a third of the mixtures and of what is beside them. */
static double band_psnr(const struct layers *l, float focus, const uint8_t *out)
{
    const double near = K * fabs(NEAR / 65535.0 - focus), far = K * fabs(FAR / 65535.0 - focus);
    static double lit[PIXELS];
    double error = 0;
    int count = 0;

    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < PIXELS; i++)
            lit[i] = l->alpha[i] * l->near[i][c];
        for (int y = 1; y < HEIGHT - 1; y++)
            for (int x = 1; x < WIDTH - 1; x++) {
                const int i = y * WIDTH + x;
                double light, off;

                if (i % 3 != 0 ||
                    (l->matte[i] == l->matte[i - 1] && l->matte[i] == l->matte[i + 1] &&
                     l->matte[i] == l->matte[i - WIDTH] && l->matte[i] == l->matte[i + WIDTH]))
                    continue;
                light = blurred(lit, 1, x, y, near) + (1 - blurred(l->alpha, 1, x, y, near)) *
                                                          blurred(&l->far[0][c], 3, x, y, far);
                off = out[3 * i + c] - picture_code(light);
                error += off * off;
                count++;
            }
    }
    return 10 * log10(255.0 * 255 * count / error);
}

/* A scene of a photo, and how it is to be rendered. */
struct job {
    const uint8_t *rgb;
    const uint16_t *disparity;
    const struct refocus_disparity *matte;
    float focus;
    uint32_t cpu, blend;
    int threads, thin, width, height;
};

static struct job job_of(const struct layers *l, const struct refocus_disparity *matte)
{
    return (struct job){l->rgb, l->disparity, matte, 0.7f, REFOCUS_CPU_AUTO, 0, 1,
                        0,      WIDTH,        HEIGHT};
}

static int prepare(struct refocus_renderer *renderer, const struct job *job)
{
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, (uint8_t *)job->rgb, job->width, job->height, 3 * job->width);
    const struct refocus_disparity map =
        refocus_disparity16(job->disparity, job->width, job->height, 2 * job->width);
    struct refocus_scene scene = refocus_scene_default(&photo, &map);

    scene.matte = job->matte;
    return refocus_prepare_scene(renderer, &scene);
}

static struct refocus_renderer *create(const struct job *job)
{
    struct refocus_renderer_params params =
        refocus_renderer_params_default(job->width, job->height, K);
    struct refocus_renderer *renderer;
    int status;

    params.cpu = job->cpu;
    params.threads = job->threads;
    params.thin = 1;
    status = refocus_renderer_create(&renderer, &params);
    if (status == REFOCUS_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(status, REFOCUS_OK);
    return renderer;
}

static int render(struct refocus_renderer *renderer, const struct job *job, uint8_t *out)
{
    struct refocus_settings params = refocus_settings_default(job->focus, K);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, job->width, job->height, 3 * job->width);

    params.render.rays = 64;
    params.render.blend = job->blend;
    params.highlights.gain = 1;
    params.thin.enabled = (uint32_t)job->thin;
    return refocus_render_settings(renderer, &params, &image);
}

static bool render_fresh(const struct job *job, uint8_t *out)
{
    struct refocus_renderer *renderer = create(job);

    if (!renderer)
        return false;
    assert_int_equal(prepare(renderer, job), REFOCUS_OK);
    assert_int_equal(render(renderer, job, out), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    return true;
}

static struct layers layers;
static uint8_t out[3 * PIXELS], expected[3 * PIXELS];

/* Figures of one focus: what the matte gains of PSNR in the band, and what it reaches, by its
 * photo's map and by a soft one. */
TEST(true_layers)
{
    static const struct {
        float focus;
        double gain, soft_gain, least, soft_least;
    } cases[] = {
        {NEAR / 65535.0f, 6, 22, 55, 55}, /* on the subject */
        {NEAR / 65535.0f - 0.05f, 2, 12, 37, 33},
        {NEAR / 65535.0f - 0.15f, 0, 13, 44, 43},
        {0.47f, 1, 15, 47, 46},              /* The exact map alone reaches 46. */
        {FAR / 65535.0f, 9.5, 25, 47.5, 46}, /* on the wall: the exact map alone reaches 38 */
        {0, 1, 12, 44, 44}};
    static uint16_t soft[PIXELS];
    const struct refocus_disparity matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);

    soften(&layers, soft);
    for (int i = 0; i < 6; i++)
        for (int pass = 0; pass < 2; pass++) {
            struct job job = job_of(&layers, NULL);
            double without, with;

            job.disparity = pass ? soft : layers.disparity;
            job.focus = cases[i].focus;
            job.thin = 1;
            assert_true(render_fresh(&job, out));
            without = band_psnr(&layers, job.focus, out);
            job.matte = &matte;
            assert_true(render_fresh(&job, out));
            with = band_psnr(&layers, job.focus, out);
            print_message("focus %.3f, %s map: %.2f dB, with the matte %.2f\n", (double)job.focus,
                          pass ? "soft" : "exact", without, with);
            if (with - without < (pass ? cases[i].soft_gain : cases[i].gain))
                fail_msg("it gains %.2f dB", with - without);
            assert_true(with >= (pass ? cases[i].soft_least : cases[i].least));
        }
}

/* A dark subject before a light wall, and a matte that takes a part of it for half of the wall. */
static void draw_dark(uint16_t *disparity, uint8_t *matte)
{
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH;

        memset(layers.rgb + (ptrdiff_t)3 * i, x < 90 ? 20 : 200, 3);
        disparity[i] = x < 90 ? NEAR : FAR;
        matte[i] = x < 60 ? 255 : x < 90 ? 160 : 0;
    }
}

/* A subject that the matte takes for half of the wall stays dark, in focus and out of it. */
TEST(dark_subject)
{
    static uint16_t disparity[PIXELS];
    static uint8_t matte[PIXELS];
    const struct refocus_disparity of_matte = refocus_disparity8(matte, WIDTH, HEIGHT, WIDTH);
    struct job job = job_of(&layers, &of_matte);

    draw_dark(disparity, matte);
    job.disparity = disparity;
    job.thin = 1;
    for (int pass = 0; pass < 2; pass++) {
        job.focus = NEAR / 65535.0f - 0.1f * (float)pass;
        assert_true(render_fresh(&job, out));
        for (int i = 0; i < PIXELS; i++)
            if (i % WIDTH < 85)
                assert_in_range(out[3 * i], 16, 24);
    }
    draw(&layers);
}

/* Disparities of mixtures go over between those that are sure, from the nearest of which none
 * spreads: steps would show as lines. */
TEST(no_steps)
{
    enum { NEARER = NEAR + 4000, MOST = 300 };
    static uint16_t disparity[PIXELS];
    static uint8_t matte[PIXELS];
    const struct refocus_disparity of_matte = refocus_disparity8(matte, WIDTH, HEIGHT, WIDTH);
    struct job job = job_of(&layers, &of_matte);
    struct refocus_renderer *renderer = create(&job);

    draw_dark(disparity, matte);
    for (int y = 40; y < 45; y++)
        for (int x = 40; x < 45; x++)
            disparity[y * WIDTH + x] = NEARER;
    job.disparity = disparity;
    assert_int_equal(prepare(renderer, &job), REFOCUS_OK);
    for (int y = 1; y < HEIGHT; y++)
        for (int x = 60; x < 90; x++) {
            const uint16_t *at = renderer->disparity.at + y * renderer->disparity.stride + x;

            assert_in_range(*at, NEAR - 4, NEAR + MOST);
            assert_in_range(abs(*at - at[-renderer->disparity.stride]), 0, MOST);
        }
    refocus_renderer_destroy(&renderer);
    draw(&layers);
}

/* A matte without a silhouette, or one with nothing between 0 and 1 where the map has it, changes
 * nothing. */
TEST(no_change)
{
    static uint8_t plain[PIXELS], sharp[PIXELS];
    struct job job = job_of(&layers, NULL);
    struct refocus_disparity matte = refocus_disparity8(plain, WIDTH, HEIGHT, WIDTH);

    for (int thin = 0; thin < 2; thin++) {
        job.thin = thin;
        job.matte = NULL;
        assert_true(render_fresh(&job, expected));
        job.matte = &matte;
        for (int code = 0; code < 256; code += 51) { /* alpha is the same everywhere */
            memset(plain, code, sizeof plain);
            matte.samples = plain;
            assert_true(render_fresh(&job, out));
            assert_same_pixels(out, expected, WIDTH, HEIGHT, "a plain matte");
        }
        for (int i = 0; i < PIXELS; i++)
            sharp[i] = layers.alpha[i] >= 0.5 ? 255 : 0;
        matte.samples = sharp;
        assert_true(render_fresh(&job, out));
        assert_same_pixels(out, expected, WIDTH, HEIGHT, "the map's matte");
    }
}

/* Neither the threads nor the instruction set, the depth of its samples nor their order in memory
 * make a difference. */
TEST(same_everywhere)
{
    static uint16_t deep[HEIGHT][WIDTH + 3];
    struct refocus_disparity matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);
    struct job job = job_of(&layers, &matte);

    for (int i = 0; i < PIXELS; i++) /* bottom-up */
        deep[HEIGHT - 1 - i / WIDTH][i % WIDTH] = (uint16_t)(257 * layers.matte[i]);
    for (int focus = 0; focus < 2; focus++) {
        job.focus = focus ? 0.7f : 0.2f;
        job.cpu = REFOCUS_CPU_C;
        job.threads = 1;
        matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);
        assert_true(render_fresh(&job, expected));
        matte = refocus_disparity16(deep[HEIGHT - 1], WIDTH, HEIGHT, -(ptrdiff_t)sizeof *deep);
        for (job.cpu = REFOCUS_CPU_C; job.cpu < REFOCUS_CPU_COUNT; job.cpu++) {
            job.threads = 1 + (int)job.cpu % 3;
            if (render_fresh(&job, out))
                assert_same_pixels(out, expected, WIDTH, HEIGHT, refocus_cpu_name(job.cpu));
        }
    }
}

/* Whatever was rendered before, with or without the matte, cancelled or not. */
TEST(sequence)
{
    struct refocus_disparity matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);
    struct job job = job_of(&layers, &matte);
    struct refocus_renderer *renderer = create(&job);
    uint32_t seed = 5;

    for (int i = 0; i < (left_out(1, 2) ? 10 : 40); i++) {
        const uint32_t what = noise(&seed) >> 8;

        job.focus = (float)(what & 7) / 8;
        job.blend = (what >> 3) % 3;
        job.thin = what >> 5 & 1;
        if (what & 64 || i == 0) {
            job.matte = what & 128 ? NULL : &matte;
            assert_int_equal(prepare(renderer, &job), REFOCUS_OK);
        }
        assert_int_equal(render(renderer, &job, out), REFOCUS_OK);
        assert_true(render_fresh(&job, expected));
        assert_same_pixels(out, expected, WIDTH, HEIGHT, "a renderer that was used before");
    }
    refocus_renderer_destroy(&renderer);
}

/* A region is that part of the whole. */
TEST(region)
{
    const struct refocus_disparity matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);
    const struct job job = job_of(&layers, &matte);
    struct refocus_render_params params = refocus_render_params_default(0.2f, K);
    struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, expected, WIDTH, HEIGHT, 3 * WIDTH);
    struct refocus_renderer *renderer;

    for (int i = 0; i < 2; i++) {
        renderer = create(&job);
        assert_int_equal(prepare(renderer, &job), REFOCUS_OK);
        if (i) {
            params.region_x = 70;
            params.region_y = 20;
            params.region_width = image.width = 33;
            params.region_height = image.height = 9;
            image.plane[0] = out;
            image.stride[0] = 3 * 33;
        }
        assert_int_equal(refocus_render(renderer, &params, &image), REFOCUS_OK);
        refocus_renderer_destroy(&renderer);
    }
    for (int y = 0; y < 9; y++)
        assert_memory_equal(out + (ptrdiff_t)3 * 33 * y,
                            expected + (ptrdiff_t)3 * ((20 + y) * WIDTH + 70), 3 * 33);
}

/* Photos and mattes of any size; more mixtures than there is room for. */
TEST(sizes)
{
    static const int side[][2] = {{1, 1}, {1, 70}, {70, 1}, {17, 33}, {WIDTH, HEIGHT}};
    static uint8_t random[PIXELS];
    uint32_t seed = 9;

    for (int i = 0; i < PIXELS; i++)
        random[i] = (uint8_t)(i % 16 ? noise(&seed) >> 24 : 255u * (i / 16 % 2));
    for (int i = 0; i < 25; i++) {
        const int w = side[i / 5][0], h = side[i / 5][1];
        const struct refocus_disparity matte =
            refocus_disparity8(w < 17 ? layers.matte : random, w, h, w);
        struct job job = job_of(&layers, &matte);

        job.width = side[i % 5][0];
        job.height = side[i % 5][1];
        assert_true(render_fresh(&job, expected));
        job.threads = 3;
        assert_true(render_fresh(&job, out));
        assert_memory_equal(out, expected, 3 * (size_t)job.width * (size_t)job.height);
    }
}

TEST(refused)
{
    struct refocus_disparity matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);
    const struct job job = job_of(&layers, &matte);
    struct refocus_renderer *renderer = create(&job);
    struct refocus_image photo =
        refocus_image_planar(REFOCUS_FORMAT_I420, layers.rgb, WIDTH, HEIGHT);
    const struct refocus_disparity map =
        refocus_disparity16(layers.disparity, WIDTH, HEIGHT, 2 * WIDTH);
    struct refocus_scene scene = refocus_scene_default(&photo, &map);

    scene.matte = &matte;
    assert_int_equal(prepare(renderer, &job), REFOCUS_OK);
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(render(renderer, &job, out), REFOCUS_ERR_STATE);
    matte.stride = 1;
    assert_int_equal(prepare(renderer, &job), REFOCUS_ERR_ARGUMENT);
    matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);
    refocus_renderer_destroy(&renderer);
    for (uint32_t in_place = 0; in_place < 2; in_place++) {
        struct refocus_renderer_params params = refocus_renderer_params_default(WIDTH, HEIGHT, K);

        params.in_place = params.thin = in_place;
        assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_OK);
        assert_int_equal(prepare(renderer, &job), REFOCUS_ERR_UNSUPPORTED);
        refocus_renderer_destroy(&renderer);
    }
}

/* After a cancelled prepare nothing is prepared, and the next one is as good as the first. */
TEST(cancelled)
{
    const struct refocus_disparity matte = refocus_disparity8(layers.matte, WIDTH, HEIGHT, WIDTH);
    const struct job job = job_of(&layers, &matte);
    struct refocus_renderer *renderer = create(&job);
    struct canceller canceller = {renderer, 0, 0};
    int status = REFOCUS_ERR_CANCELLED, count = 0;

    assert_true(render_fresh(&job, expected));
    renderer->run.user = &canceller;
    while (status != REFOCUS_OK) {
        atomic_store(&canceller.left, ++count);
        renderer->run.looked_at = cancel_later;
        status = prepare(renderer, &job);
        renderer->run.looked_at = NULL;
        if (status != REFOCUS_OK)
            assert_int_equal(render(renderer, &job, out), REFOCUS_ERR_STATE);
        if (status != REFOCUS_OK && count % 7 == 0) {
            assert_int_equal(prepare(renderer, &job), REFOCUS_OK);
            assert_int_equal(render(renderer, &job, out), REFOCUS_OK);
            assert_same_pixels(out, expected, WIDTH, HEIGHT, "after it was cancelled");
        }
    }
    assert_true(count > 50);
    assert_int_equal(render(renderer, &job, out), REFOCUS_OK);
    assert_same_pixels(out, expected, WIDTH, HEIGHT, "after it was cancelled");
    refocus_renderer_destroy(&renderer);
}

int main(void)
{
    draw(&layers);
    return unit_test_run(NULL, NULL);
}
