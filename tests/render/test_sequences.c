/* test_sequences.c: whatever was rendered or cancelled before, a picture is that of a new
 * renderer; and a region that of the whole. */
#include "pictures.h"

#include "canceller.h"

enum { WIDTH = 403, HEIGHT = 299, MOST = 3 * WIDTH * HEIGHT };

enum mode { PLAIN, IN_PLACE };

static const float blurs[] = {0, 1.5f, 3, 6};

/* A style, a lens and a part of the picture. */
struct setting {
    const struct style *style;
    float focus, blur, gain;
    int x, y, width, height; /* all 0: the whole */
};

/* Not in strip mode. */
static const uint32_t OF_FRAMES =
    REFOCUS_METHOD_BIT(REFOCUS_METHOD_LIGHTFIELD) | REFOCUS_METHOD_BIT(REFOCUS_METHOD_SCATTER) |
    REFOCUS_METHOD_BIT(REFOCUS_METHOD_FOVEATED) | REFOCUS_METHOD_BIT(REFOCUS_METHOD_INTERPOLATED) |
    REFOCUS_METHOD_BIT(REFOCUS_METHOD_DIFFUSION);

static uint32_t pick(uint32_t *state, uint32_t n)
{
    return (noise(state) >> 8) % n;
}

/* Styles that take little time. */
static const struct style *pick_style(uint32_t *state, int in_place)
{
    const struct style *style;

    do {
        style = &styles[pick(state, (uint32_t)style_count)];
    } while (style->method == REFOCUS_METHOD_RAYTRACE || style->rays == REFOCUS_RAYS_FULL ||
             style->rays > 128 || style->method == REFOCUS_METHOD_DIFFUSION ||
             (in_place && (OF_FRAMES & REFOCUS_METHOD_BIT(style->method))));
    return style;
}

/* Changes some of a setting, so that much of the last one can be used again. */
static void change(struct setting *s, uint32_t *state, enum mode mode)
{
    const uint32_t what = pick(state, 64);

    if (what & 1)
        s->focus = (float)pick(state, 4) / 3;
    if (what & 2)
        s->blur = blurs[pick(state, 4)];
    if (what & 4)
        s->style = pick_style(state, mode == IN_PLACE);
    if (what & 8)
        s->gain = pick(state, 2) ? 1 : 4;
    if (what & 48) {
        s->x = s->y = s->width = s->height = 0;
        if (pick(state, 3)) {
            s->width = 1 + (int)pick(state, 60);
            s->height = 1 + (int)pick(state, 60);
            s->x = (int)pick(state, (uint32_t)(WIDTH - s->width + 1));
            s->y = (int)pick(state, (uint32_t)(HEIGHT - s->height + 1));
        }
    }
}

static int render(struct refocus_renderer *renderer, const struct setting *s, uint8_t *out)
{
    struct refocus_settings params = style_params(s->style, s->focus, s->blur);
    struct refocus_aperture *aperture = style_aperture(s->style);
    const int w = s->width ? s->width : WIDTH;
    const int h = s->height ? s->height : HEIGHT;
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, w, h, 3 * (ptrdiff_t)w);
    int status;

    params.render.aperture = aperture;
    params.highlights.gain = s->gain;
    params.render.region_x = s->x;
    params.render.region_y = s->y;
    params.render.region_width = s->width;
    params.render.region_height = s->height;
    memset(out, 0x5a, MOST);
    status = refocus_render_settings(renderer, &params, &image);
    refocus_aperture_destroy(&aperture);
    return status;
}

static struct refocus_renderer *create(int threads, enum mode mode)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(WIDTH, HEIGHT, 6);
    struct refocus_renderer *renderer;

    limits.threads = threads;
    limits.papers = refocus_papers();
    limits.methods = mode == IN_PLACE ? 0 : REFOCUS_METHODS_ALL;
    limits.in_place = limits.highlights = mode == IN_PLACE;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    return renderer;
}

static void prepare(struct refocus_renderer *renderer, const struct picture *p)
{
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);

    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
}

static void assert_same(const uint8_t *is, const uint8_t *should, const struct setting *s,
                        uint32_t seed, int step)
{
    for (size_t i = 0; i < MOST; i++)
        if (is[i] != should[i])
            fail_msg("seed %u, step %d, %s, focus %g, blur %g, gain %g, region %d,%d "
                     "%dx%d: byte %zu is %d, should be %d",
                     seed, step, s->style->name, (double)s->focus, (double)s->blur, (double)s->gain,
                     s->x, s->y, s->width, s->height, i, is[i], should[i]);
}

static void sequence(uint32_t seed, int steps, enum mode mode)
{
    struct picture p[2] = {picture_make(WIDTH, HEIGHT, seed),
                           picture_make(WIDTH, HEIGHT, seed + 1)};
    struct setting s = {&styles[0], 0.5f, 6, 1, 0, 0, 0, 0};
    uint8_t *out = malloc(MOST), *expected = malloc(MOST);
    struct refocus_renderer *renderer = create(2, mode);
    struct canceller canceller = {renderer, 0, 0};
    uint32_t state = seed;
    int shown = 0, cancelled = 0;

    assert_true(out && expected);
    renderer->run.user = &canceller;
    prepare(renderer, &p[0]);
    for (int i = 0; i < steps; i++) {
        struct refocus_renderer *fresh;

        change(&s, &state, mode);
        if (pick(&state, 12) == 0)
            prepare(renderer, &p[shown = !shown]);
        if (pick(&state, 4) == 0) { /* this one is cancelled, or so it is meant */
            struct setting other = s;

            change(&other, &state, mode);
            atomic_store(&canceller.left, 1 + (int)pick(&state, 200));
            renderer->run.looked_at = cancel_later;
            cancelled += render(renderer, &other, out) == REFOCUS_ERR_CANCELLED;
            renderer->run.looked_at = NULL;
            if (pick(&state, 2))
                s = other; /* this time the frame is rendered to its end */
        }
        assert_int_equal(render(renderer, &s, out), REFOCUS_OK);
        fresh = create(1, PLAIN);
        prepare(fresh, &p[shown]);
        assert_int_equal(render(fresh, &s, expected), REFOCUS_OK);
        refocus_renderer_destroy(&fresh);
        assert_same(out, expected, &s, seed, i);
    }
    assert_true(cancelled > 0);
    refocus_renderer_destroy(&renderer);
    free(out);
    free(expected);
    for (int i = 0; i < 2; i++)
        picture_free(&p[i]);
}

TEST(sequences)
{
    for (uint32_t seed = 1; seed <= (left_out(1, 2) ? 3 : 6); seed++)
        sequence(seed, left_out(1, 2) ? 14 : 40, seed % 3);
}

/* Before what is far, bars wide enough for whole blocks of several levels of the
 * background's pyramid to be unknown. */
static struct picture wide_bars(void)
{
    struct picture p = picture_make(WIDTH, HEIGHT, 9);

    for (int i = 0; i < WIDTH * HEIGHT; i++)
        p.disparity[i] = i % WIDTH / 19 % 2 ? 65000 : 2000;
    return p;
}

/* The background layer of a window, where it says that it is that of the whole photo.
 */
static void assert_same_background(const struct refocus_renderer *part,
                                   const struct refocus_renderer *whole)
{
    const struct rf_rect e = part->cache.exact;
    const ptrdiff_t at = -part->view.y0 * part->view.stride - part->view.x0;

    if (!part->cache.background)
        return;
    assert_true(whole->cache.background && part->view.stride == whole->view.stride);
    for (int y = e.y0; y < e.y1; y++) {
        for (int x = e.x0; x < e.x1; x++) {
            const ptrdiff_t p = y * part->view.stride + x;
            int differ = part->background.blur.at[at + p] != whole->background.blur.at[p];

            for (int c = 0; c < 3; c++)
                differ |= part->background.light.channel[c][at + p] !=
                          whole->background.light.channel[c][p];
            if (differ)
                fail_msg("window %d,%d..%d,%d: the background at %d,%d is another",
                         part->cache.window.x0, part->cache.window.y0, part->cache.window.x1,
                         part->cache.window.y1, x, y);
        }
    }
}

static void regions_of(struct picture p)
{
    uint8_t *whole = malloc(MOST), *out = malloc(MOST);
    struct refocus_renderer *part;
    uint32_t random = 5;
    const int parts = left_out(1, 2) ? 12 : 60;
    int windows = 0;

    assert_true(whole && out);
    for (int i = 0; i < parts; i++) {
        struct refocus_renderer *renderer = create(1 + i % 3, PLAIN);
        struct setting s = {pick_style(&random, 0),
                            (float)pick(&random, 5) / 4,
                            blurs[1 + pick(&random, 3)],
                            i % 5 ? 1 : 4,
                            0,
                            0,
                            0,
                            0};
        int x, y, w = 1 + (int)pick(&random, 40), h = 1 + (int)pick(&random, 40);

        if (i % 2)
            s.style = &styles[0];
        prepare(renderer, &p);
        assert_int_equal(render(renderer, &s, whole), REFOCUS_OK);
        x = i % 6 == 1 ? 0 : i % 6 == 2 ? WIDTH - w : (int)pick(&random, (uint32_t)(WIDTH - w));
        y = i % 7 == 1 ? 0 : i % 7 == 2 ? HEIGHT - h : (int)pick(&random, (uint32_t)(HEIGHT - h));
        s.x = x, s.y = y, s.width = w, s.height = h;
        part = create(1, PLAIN);
        prepare(part, &p);
        assert_int_equal(render(part, &s, out), REFOCUS_OK);
        windows += part->cache.window.x1 - part->cache.window.x0 < WIDTH;
        assert_same_background(part, renderer);
        refocus_renderer_destroy(&renderer);
        refocus_renderer_destroy(&part);
        for (int row = 0; row < h; row++)
            if (memcmp(out + 3 * row * w, whole + 3 * ((y + row) * WIDTH + x), 3 * (size_t)w))
                fail_msg("%s, focus %g, blur %g: %dx%d at %d,%d, row %d differs", s.style->name,
                         (double)s.focus, (double)s.blur, w, h, x, y, row);
    }
    assert_true(windows > parts / 6);
    free(whole);
    free(out);
    picture_free(&p);
}

TEST(regions)
{
    regions_of(picture_make(WIDTH, HEIGHT, 9));
    regions_of(wide_bars());
}

/* A dark picture with small highlights all over, before and behind. */
static struct picture make_highlights(uint32_t seed)
{
    struct picture p = picture_make(97, 83, seed);

    for (int i = 0; i < 3 * p.width * p.height; i++)
        p.rgb[i] /= 5;
    for (int y = 6; y < p.height - 3; y += 15)
        for (int x = 5 + (int)seed % 7; x < p.width - 3; x += 13)
            for (int k = 0; k < 9; k++)
                memset(p.rgb + 3 * ((y + k / 3) * p.width + x + k % 3), 255, 3);
    return p;
}

/* How often prepare and render look whether to go on. */
static int looks_of(struct refocus_renderer *renderer, struct canceller *canceller,
                    const struct picture *p, const struct refocus_settings *params,
                    const struct refocus_image *image)
{
    atomic_store(&canceller->left, 0); /* counts down from there, and cancels nothing */
    atomic_store(&canceller->looks, 0);
    renderer->run.looked_at = cancel_later;
    prepare(renderer, p);
    assert_int_equal(refocus_render_settings(renderer, params, image), REFOCUS_OK);
    renderer->run.looked_at = NULL;
    return atomic_load(&canceller->looks);
}

/* Cancelled at moments all along, some of those at which it looks whether to go on, a render with
 * these settings leaves nothing half made. */
static void cancel_at_every_moment(struct refocus_settings params)
{
    struct picture p[2] = {make_highlights(31), make_highlights(32)};
    const struct refocus_image photo[2] = {picture_image(&p[0]), picture_image(&p[1])};
    const struct refocus_disparity disparity[2] = {picture_disparity(&p[0]),
                                                   picture_disparity(&p[1])};
    static uint8_t expected[3 * 97 * 83], out[3 * 97 * 83];
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 97, 83, 3 * 97);
    struct refocus_renderer *renderer = prepared(&p[0], 12, 1);
    struct canceller canceller = {renderer, 0, 0};
    int status = REFOCUS_ERR_CANCELLED, cancelled = 0;
    int each;

    params.render.blend = REFOCUS_BLEND_GAMMA;
    renderer->run.user = &canceller;
    each = 1 + looks_of(renderer, &canceller, &p[0], &params, &image) / (left_out(1, 2) ? 30 : 150);
    memcpy(expected, out, sizeof out);
    assert_true(renderer->photo.highlights.part[0].count > 40); /* rows of highlights */
    for (int n = 1; status != REFOCUS_OK; n += each) {
        /* another photo and another lens before */
        params.render.focus_disparity = 0.8f;
        params.render.blend = REFOCUS_BLEND_LINEAR;
        assert_int_equal(refocus_prepare(renderer, &photo[1], &disparity[1]), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        params.render.focus_disparity = 0.3f;
        params.render.blend = REFOCUS_BLEND_GAMMA;
        atomic_store(&canceller.left, n);
        renderer->run.looked_at = cancel_later;
        status = refocus_prepare(renderer, &photo[0], &disparity[0]);
        if (status == REFOCUS_OK)
            status = refocus_render_settings(renderer, &params, &image);
        else
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_ERR_STATE);
        renderer->run.looked_at = NULL;
        cancelled += status == REFOCUS_ERR_CANCELLED;
        if (!renderer->prepared)
            assert_int_equal(refocus_prepare(renderer, &photo[0], &disparity[0]), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        assert_same_pixels(out, expected, 97, 83, "after a cancelled one");
    }
    assert_true(cancelled >= (left_out(1, 2) ? 15 : 75));
    refocus_renderer_destroy(&renderer);
    for (int i = 0; i < 2; i++)
        picture_free(&p[i]);
}

/* Highlights splatted; highlights gathered, grain and stars. */
TEST(every_moment)
{
    struct refocus_settings params = refocus_settings_default(0.3f, 12);

    params.render.rays = 16;
    params.highlights.gain = 3;
    cancel_at_every_moment(params);
    params.render.rays = REFOCUS_RAYS_FULL;
    params.render.max_blur_radius = 5;
    params.highlights.gain = 4;
    params.look.grain = 1;
    params.look.star_spikes = 6;
    params.look.star_length = 20;
    params.look.star_strength = 0.5f;
    cancel_at_every_moment(params);
}
