/* test_thin.c: thin structures far before the focus, and in it: src/thin. */
#include "pictures.h"

#include "canceller.h"

enum { WIDTH = 339, HEIGHT = 251, MOST = 3 * WIDTH * HEIGHT, FAR = FENCE_FAR, NEAR = FENCE_NEAR };
static const float K = 15;

static struct refocus_renderer *create(const struct picture *p, uint32_t cpu, int threads,
                                       bool thin)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(p->width, p->height, K);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);
    struct refocus_renderer *renderer;
    int status;

    limits.cpu = cpu;
    limits.threads = threads;
    limits.thin = thin;
    status = refocus_renderer_create(&renderer, &limits);
    if (status == REFOCUS_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(status, REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    return renderer;
}

struct setting {
    float focus, blur, gain, sigma;
    uint32_t thin, blend, method;
    int rays, blades, x, y, width, height;
};

static const struct setting plain = {
    .focus = FAR / 65535.0f, .blur = 15, .gain = 1, .sigma = 400, .thin = 1, .rays = 64};

static int render(struct refocus_renderer *renderer, const struct setting *s, uint8_t *out)
{
    struct refocus_settings params = refocus_settings_default(s->focus, s->blur);
    const int w = s->width ? s->width : WIDTH;
    const int h = s->height ? s->height : HEIGHT;
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, w, h, 3 * w);
    struct refocus_aperture *aperture = NULL;
    int status;

    if (s->blades)
        assert_int_equal(refocus_aperture_create_polygon(&aperture, s->blades, 10), REFOCUS_OK);
    params.render.aperture = aperture;
    params.render.rays = s->rays;
    params.thin.enabled = s->thin;
    params.highlights.gain = s->gain;
    params.render.sigma = s->sigma;
    params.render.blend = s->blend;
    params.render.method = s->method;
    params.render.region_x = s->x;
    params.render.region_y = s->y;
    params.render.region_width = s->width;
    params.render.region_height = s->height;
    memset(out, 0x5a, MOST);
    status = refocus_render_settings(renderer, &params, &image);
    refocus_aperture_destroy(&aperture);
    return status;
}

/* Renders by a renderer of its own. */
static void render_fresh(const struct picture *p, bool memory, const struct setting *s,
                         uint8_t *out)
{
    struct refocus_renderer *renderer = create(p, REFOCUS_CPU_AUTO, 1, memory);

    assert_non_null(renderer);
    assert_int_equal(render(renderer, s, out), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
}

/* A wire of width w before black is the chord of a disc: L w 2 sqrt(s^2 - t^2) / pi s^2
 * at t from its middle, from end to end. */
TEST(wire)
{
    static uint8_t out[MOST];
    const double s = (double)K * (NEAR - FAR) / 65535, wide = 1, pi = 3.14159265358979;
    struct picture p = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){0, 0, 0}, FAR);
    double sum = 0, moment = 0, worst = 0, worst_rays = 0;
    struct setting rays = plain;

    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 169; x <= 169; x++) {
            memset(p.rgb + 3 * (y * WIDTH + x), 220, 3);
            p.disparity[y * WIDTH + x] = NEAR;
        }
    }
    for (int pass = 0; pass < 2; pass++) {
        rays.thin = !pass;
        render_fresh(&p, true, &rays, out);
        for (int x = 150; x < 190; x++) {
            const double t = fabs(x - 169.0);
            const double should =
                t < s ? picture_light(220) * wide * 2 * sqrt(s * s - t * t) / (pi * s * s) : 0;
            const double is = picture_light(out[3 * (HEIGHT / 2 * WIDTH + x)]);
            double *most = pass ? &worst_rays : &worst;

            sum += pass ? 0 : is;
            moment += pass ? 0 : is * (x - 169);
            if (t < s - 5) /* cells blur the edge */
                *most = fmax(*most, fabs(is - should));
        }
        for (int y = 1; y < HEIGHT && !pass; y++) /* to both ends */
            if (abs(out[3 * (y * WIDTH + 169)] - out[3 * 169]) > 4)
                fail_msg("row %d is %d, the first %d", y, out[3 * (y * WIDTH + 169)], out[3 * 169]);
    }
    printf("wire: %.4f off where it is %.4f; by rays %.4f; middle %.2f px beside\n", worst,
           picture_light(220) * wide * 2 / (pi * s), worst_rays, moment / sum);
    assert_true(fabs(moment / sum) < 0.2); /* not at the middle of its cell, half a pixel beside */
    assert_true(fabs(sum - picture_light(220) * wide) < 0.03 * picture_light(220) * wide);
    assert_true(worst < 0.13 * picture_light(220) * wide * 2 / (pi * s));
    assert_true(worst < worst_rays / 3);
    picture_free(&p);
}

/* A hair in focus, a fifth of a pixel wide, before stripes. */
TEST(strands)
{
    static uint8_t out[MOST], background[MOST];
    struct picture p = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){60, 70, 50}, FAR), far;
    struct setting s = plain;
    double off[2] = {0, 0};
    int pixels = 0;

    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (i % WIDTH % 7 < 3)
            memset(p.rgb + 3 * i, 230, 3);
    far = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){0, 0, 0}, FAR);
    memcpy(far.rgb, p.rgb, MOST);
    for (int x = 30; x < WIDTH - 30; x++) {
        const int i = HEIGHT / 2 * WIDTH + x;

        for (int c = 0; c < 3; c++)
            p.rgb[3 * i + c] =
                picture_code(0.2 * picture_light(200) + 0.8 * picture_light(p.rgb[3 * i + c]));
        p.disparity[i] = NEAR;
    }
    s.focus = NEAR / 65535.0f;
    render_fresh(&far, false, &s, background);
    for (int pass = 0; pass < 2; pass++) {
        s.thin = !pass;
        render_fresh(&p, true, &s, out);
        for (int x = 40; x < WIDTH - 40; x++) {
            const int i = 3 * (HEIGHT / 2 * WIDTH + x);
            const double should =
                picture_code(0.2 * picture_light(200) + 0.8 * picture_light(background[i]));

            off[pass] += fabs(out[i] - should);
            pixels += !pass;
        }
    }
    printf("strands: %.2f codes off, by rays %.2f\n", off[0] / pixels, off[1] / pixels);
    assert_true(off[0] < 8 * pixels);
    assert_true(off[0] < off[1] / 4);
    picture_free(&p);
    picture_free(&far);
}

/* Two lines in focus, so many times as wide as wires: the background is blurred, their edges are
 * not, and their light stays off the background. */
static void check_matted(const char *what, double times)
{
    static uint8_t out[MOST], background[MOST];
    struct picture p = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){30, 60, 50}, FAR), far, share;
    struct setting s = plain;
    double off[2] = {0, 0}, beside[2] = {0, 0};
    int pixels = 0;

    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (i % WIDTH > 170)
            memset(p.rgb + 3 * i, 130, 3);
    far = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){0, 0, 0}, FAR);
    memcpy(far.rgb, p.rgb, MOST);
    share = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){0, 0, 0}, FAR);
    picture_line(&p, 100, 0, 0.4, 1, 3 * times, 220);
    picture_line(&p, 0, 60, 1, 0.15, 2 * times, 220);
    picture_line(&share, 100, 0, 0.4, 1, 3 * times, 255);
    picture_line(&share, 0, 60, 1, 0.15, 2 * times, 255);
    s.focus = NEAR / 65535.0f;
    render_fresh(&far, false, &s, background);
    for (int pass = 0; pass < 2; pass++) {
        s.thin = !pass;
        render_fresh(&p, true, &s, out);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const double alpha = share.rgb[3 * i] / 255.0;
            const double should = alpha * 220 + (1 - alpha) * background[3 * i];

            if (alpha > 0 && alpha < 1) {
                off[pass] += fabs(out[3 * i] - should);
                pixels += !pass;
            } else {
                beside[pass] += fabs(out[3 * i] - should);
            }
        }
    }
    printf("%s: %.2f codes off, by rays %.2f; beside it %.0f, %.0f\n", what, off[0] / pixels,
           off[1] / pixels, beside[0], beside[1]);
    assert_true(off[0] < 6 * pixels);
    assert_true(off[0] < off[1] / 3);
    assert_true(beside[0] < beside[1] / 2);
    picture_free(&p);
    picture_free(&far);
    picture_free(&share);
}

TEST(matted)
{
    check_matted("wires", 1);
    check_matted("beams", 12);
}

/* A bright beam a pixel out of focus, either way, has no halo on the wall behind it: what is
 * farther from it than that blur stays as dark. */
TEST(halo)
{
    static uint8_t out[MOST], wall[3] = {30, 60, 50};

    for (int side = -1; side <= 1; side += 2) {
        struct picture p = picture_flat(WIDTH, HEIGHT, wall, FAR), share;
        struct setting s = plain;
        double sum[2] = {0, 0};

        share = picture_flat(WIDTH, HEIGHT, wall, FAR);
        picture_line(&p, 100, 0, 0.4, 1, 40, 220);
        picture_line(&share, 100, 0, 0.4, 1, 48, 220);
        s.focus = NEAR / 65535.0f + (float)side / K;
        for (s.thin = 0; s.thin < 2; s.thin++) {
            render_fresh(&p, true, &s, out);
            for (int i = 0; i < WIDTH * HEIGHT; i++)
                sum[s.thin] += share.rgb[3 * i] == wall[0] ? abs(out[3 * i] - wall[0]) : 0;
        }
        printf("halo: %.0f, by rays %.0f\n", sum[1], sum[0]);
        assert_true(sum[1] < sum[0] / 2);
        picture_free(&p);
        picture_free(&share);
    }
}

/* A beam that is blurred before a wall in focus, or in focus before a blurred wall, looks nearly as
 * with the right map if the map is a pixel too small on both sides: what is left of it is no
 * outline. A blur of 6 pixels is too little for thin beams to be splatted. */
TEST(outline)
{
    static const struct {
        int width;
        uint16_t focus;
        float blur;
    } beams[] = {{5, FAR, 6}, {12, FAR, 15}, {40, FAR, 15}, {40, NEAR, 15}};
    static uint8_t right[MOST], out[MOST], wall[3] = {170, 190, 210};

    for (size_t b = 0; b < sizeof beams / sizeof *beams; b++) {
        struct picture p = picture_flat(WIDTH, HEIGHT, wall, FAR), small;
        struct setting s = plain;
        double off[2] = {0, 0};

        small = picture_flat(WIDTH, HEIGHT, wall, FAR);
        picture_line(&p, 100, 0, 0.4, 1, beams[b].width, 100);
        picture_line(&small, 100, 0, 0.4, 1, beams[b].width - 2, 100);
        s.focus = beams[b].focus / 65535.0f;
        s.blur = beams[b].blur;
        render_fresh(&p, true, &s, right);
        memcpy(p.disparity, small.disparity, sizeof *p.disparity * WIDTH * HEIGHT);
        for (s.thin = 0; s.thin < 2; s.thin++) {
            render_fresh(&p, true, &s, out);
            for (int i = 0; i < WIDTH * HEIGHT; i++)
                off[s.thin] += abs(out[3 * i] - right[3 * i]);
        }
        printf("beam of %d: off by %.0f, by rays %.0f\n", beams[b].width, off[1], off[0]);
        assert_true(off[1] < off[0] / 4);
        picture_free(&p);
        picture_free(&small);
    }
}

/* A stem a little out of focus is as dense with its rims matted as without: rays of what is inside
 * do not pass through the matted pixels beside it. */
TEST(dense)
{
    static uint8_t matted[MOST], rays[MOST];
    struct picture p = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){235, 235, 235}, FAR), share;
    struct setting s = plain;
    int worst = 0;

    share = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){0, 0, 0}, FAR);
    picture_line(&p, 60, 0, 0.7, 1, 7, 70);
    picture_line(&share, 60, 0, 0.7, 1, 7, 255);
    for (int step = -10; step <= 10; step++) {
        s.focus = NEAR / 65535.0f + (float)step / 10 / K;
        s.thin = 1;
        render_fresh(&p, true, &s, matted);
        s.thin = 0;
        render_fresh(&p, true, &s, rays);
        for (int i = 2 * WIDTH + 2; i < WIDTH * (HEIGHT - 2) - 2; i++) {
            bool inside = true;

            for (int y = -1; y <= 1; y++)
                for (int x = -1; x <= 1; x++)
                    inside &= share.rgb[3 * (i + y * WIDTH + x)] == 255;
            for (int c = 0; c < 3 && inside; c++)
                worst = abs(matted[3 * i + c] - rays[3 * i + c]) > worst
                            ? abs(matted[3 * i + c] - rays[3 * i + c])
                            : worst;
        }
    }
    printf("dense: %d codes from what rays make of it\n", worst);
    assert_true(worst <= 8);
    picture_free(&p);
    picture_free(&share);
}

/* Where it has nothing to do, or may not, nothing changes. */
TEST(elsewhere)
{
    static uint8_t out[MOST], expected[MOST];
    struct picture p = picture_fence(WIDTH, HEIGHT, 1),
                   wire = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){9, 80, 7}, FAR),
                   thick = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){9, 80, 7}, FAR);
    struct setting on = plain, off = plain;

    off.thin = 0;
    render_fresh(&p, false, &on, out); /* no memory for it */
    render_fresh(&p, true, &off, expected);
    assert_same_pixels(out, expected, WIDTH, HEIGHT, "a renderer without");
    render_fresh(&p, true, &on, out);
    assert_true(memcmp(out, expected, MOST));
    on.blur = off.blur = 8; /* too little for splatted coverage, too much for what is in focus */
    picture_line(&wire, 160, 0, 0.1, 1, 3, 200); /* where wires of a fence cross it is thick */
    render_fresh(&wire, true, &on, out);
    render_fresh(&wire, true, &off, expected);
    assert_same_pixels(out, expected, WIDTH, HEIGHT, "a wire a little blurred");
    on = off = plain;
    off.thin = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (i % WIDTH >= 160 && i % WIDTH < 190) { /* no pixel is a mixture */
            memset(thick.rgb + 3 * i, 200, 3);
            thick.disparity[i] = NEAR;
        }
    render_fresh(&thick, true, &on, out);
    render_fresh(&thick, true, &off, expected);
    assert_same_pixels(out, expected, WIDTH, HEIGHT, "a beam");
    picture_free(&p);
    picture_free(&wire);
    picture_free(&thick);
}

TEST(same_everywhere)
{
    static uint8_t out[MOST], expected[MOST];
    static const int threads[] = {2, 3, 8};
    struct picture p = picture_fence(WIDTH, HEIGHT, 2);
    struct setting s = plain;

    for (int pass = 0; pass < 2; pass++) {
        struct refocus_renderer *renderer = create(&p, REFOCUS_CPU_C, 1, true);

        s.focus = (pass ? NEAR : FAR) / 65535.0f;
        assert_int_equal(render(renderer, &s, expected), REFOCUS_OK);
        refocus_renderer_destroy(&renderer);
        for (uint32_t cpu = 0; refocus_cpu_name(cpu); cpu++) {
            for (int i = 0; i < 3; i++) {
                if (cpu != REFOCUS_CPU_AUTO && i > 0)
                    continue;
                renderer = create(&p, cpu, threads[i], true);
                if (!renderer)
                    continue;
                assert_int_equal(render(renderer, &s, out), REFOCUS_OK);
                assert_same_pixels(out, expected, WIDTH, HEIGHT, refocus_cpu_name(cpu));
                refocus_renderer_destroy(&renderer);
            }
        }
    }
    picture_free(&p);
}

/* A part of the picture is that of the whole. */
TEST(regions)
{
    static uint8_t whole[MOST], out[MOST];
    struct picture p = picture_fence(WIDTH, HEIGHT, 3);
    uint32_t seed = 5;

    for (int blur = 9; blur <= 15; blur += 3) {
        struct setting s = plain;

        s.focus = (blur == 9 ? NEAR : FAR) / 65535.0f;
        s.blur = (float)blur;
        render_fresh(&p, true, &s, whole);
        for (int i = 0; i < (left_out(1, 2) ? 6 : 16); i++) {
            s.width = 1 + (int)(noise(&seed) >> 8) % 50;
            s.height = 1 + (int)(noise(&seed) >> 8) % 50;
            s.x = (int)((noise(&seed) >> 8) % (uint32_t)(WIDTH - s.width + 1));
            s.y = (int)((noise(&seed) >> 8) % (uint32_t)(HEIGHT - s.height + 1));
            render_fresh(&p, true, &s, out);
            for (int y = 0; y < s.height; y++)
                if (memcmp(out + 3 * y * s.width, whole + 3 * ((s.y + y) * WIDTH + s.x),
                           3 * (size_t)s.width))
                    fail_msg("K = %d, %dx%d at %d,%d: row %d differs", blur, s.width, s.height, s.x,
                             s.y, y);
        }
    }
    picture_free(&p);
}

static void change(struct setting *s, uint32_t *seed)
{
    static const float focuses[] = {FAR / 65535.0f, 0.3f, NEAR / 65535.0f};
    const uint32_t what = noise(seed) >> 8;

    if (what & 1)
        s->thin = !s->thin;
    if (what & 2)
        s->focus = focuses[what / 1024 % 3];
    if (what & 4)
        s->blend = what / 1024 % RF_BLEND_COUNT;
    if (what & 8)
        s->gain = what & 2048 ? 1 : 4;
    if (what & 16)
        s->method = what & 1024 ? REFOCUS_METHOD_SEARCH : REFOCUS_METHOD_SWEEP;
    if (what & 32)
        s->blades = what & 2048 ? 0 : 5;
    if (what & 128)
        s->sigma = what & 2048 ? 400 : INFINITY;
    if (what & 512)
        s->rays = what & 2048 ? 64 : what & 4096 ? 32 : 100;
    s->x = s->y = s->width = s->height = 0;
    if (what & 256) {
        s->x = 40;
        s->y = 30;
        s->width = 60;
        s->height = 20;
    }
}

/* Whatever was rendered or cancelled before, a picture is that of a new renderer. */
TEST(sequence)
{
    static uint8_t out[MOST], expected[MOST];
    struct picture p = picture_fence(WIDTH, HEIGHT, 4);
    struct refocus_renderer *renderer = create(&p, REFOCUS_CPU_AUTO, 2, true);
    struct canceller canceller = {renderer, 0, 0};
    struct setting s = plain;
    uint32_t seed = 6;
    int cancelled = 0;

    renderer->run.user = &canceller;
    for (int i = 0; i < (left_out(1, 2) ? 20 : 80); i++) {
        change(&s, &seed);
        if (i % 3 == 1) {
            struct setting other = s;

            change(&other, &seed);
            atomic_store(&canceller.left, 1 + (int)(noise(&seed) >> 8) % 150);
            renderer->run.looked_at = cancel_later;
            cancelled += render(renderer, &other, out) == REFOCUS_ERR_CANCELLED;
            renderer->run.looked_at = NULL;
            s = i % 2 ? other : s;
        }
        assert_int_equal(render(renderer, &s, out), REFOCUS_OK);
        render_fresh(&p, true, &s, expected);
        for (int k = 0; k < MOST; k++)
            if (out[k] != expected[k])
                fail_msg("step %d: byte %d is %d, should be %d", i, k, out[k], expected[k]);
    }
    assert_true(cancelled > 0);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* The text of render.h. */
TEST(memory)
{
    static const int sides[][2] = {{1, 1},     {65535, 1}, {17, 33},
                                   {720, 540}, {2, 40000}, {1921, 1087}};

    for (int i = 0; i < 6; i++) {
        const int w = sides[i][0], h = sides[i][1];
        struct refocus_renderer_params params = refocus_renderer_params_default(w, h, 20);
        double bytes;

        bytes = -(double)refocus_renderer_memory(&params);
        params.thin = 1;
        bytes += (double)refocus_renderer_memory(&params);
        if (bytes < 0 || bytes > (8.0 * (w + 16) * (h + 16) + 4096))
            fail_msg("%d x %d: %.0f bytes", w, h, bytes);
    }
}
