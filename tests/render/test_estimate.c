/* test_estimate.c: the estimate of the light that clipping took: lamps by night get theirs back,
 * what is white by day stays as it is, and nothing else changes it. */
#include "pictures.h"
#include "things.h"

enum { W = 320, H = 240, CX = W / 2, CY = H / 2, BEHIND = 6554, K = 24 };

/* A flat picture with a thing in the middle, whose lens leaves a skirt of light around it: a share
 * of it falls off with the square of the distance, and light above white is cut off. */
static struct picture with_skirt(const double surround[3], const struct thing *t, double dx,
                                 double share)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, BEHIND);
    const double area = t->wide * t->high * (t->kind == ELLIPSE ? 0.785 : 1);

    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            const double away = hypot(x + 0.5 - CX - dx, y + 0.5 - CY) / 2;
            const double own = share_of_thing(t, x - CX - dx, y - CY);
            const double skirt = share * area / (12 * pow(1 + away * away, 1.5));

            for (int c = 0; c < 3; c++)
                p.rgb[3 * (y * W + x) + c] = picture_code(
                    surround[c] + own * (t->light[c] - surround[c]) + skirt * t->light[c]);
        }
    }
    return p;
}

static void render(const struct picture *p, const struct refocus_highlight_params *highlights,
                   uint32_t in_place, int threads, float most, uint8_t *out)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, most);
    struct refocus_settings settings = refocus_settings_default(0.5f, K);

    limits.threads = threads;
    limits.in_place = limits.highlights = in_place;
    settings.highlights = *highlights;
    render_once(&limits, p, &settings, out);
}

static struct refocus_highlight_params estimated(float estimate)
{
    struct refocus_highlight_params params = refocus_highlight_params_default();

    params.estimate = estimate;
    return params;
}

/* Light of each channel in all of a picture as it is rendered. */
static void light_of(const struct picture *p, float estimate, double light[3])
{
    const struct refocus_highlight_params highlights = estimated(estimate);
    uint8_t *out = malloc(3 * (size_t)p->width * (size_t)p->height);

    assert_non_null(out);
    render(p, &highlights, 0, 2, K, out);
    for (int c = 0; c < 3; c++) {
        light[c] = 0;
        for (int i = c; i < 3 * p->width * p->height; i += 3)
            light[c] += picture_light(out[i]);
    }
    free(out);
}

/* The light that the estimate adds, as a part of what the thing has when it is cut off at white. */
static void added(const double surround[3], const struct thing *t, double dx, double share,
                  float estimate, double part[3])
{
    struct picture p = with_skirt(surround, t, dx, share);
    const double area = t->wide * t->high * (t->kind == ELLIPSE ? 0.785 : 1);
    double with[3], without[3];

    light_of(&p, 0, without);
    light_of(&p, estimate, with);
    for (int c = 0; c < 3; c++)
        part[c] = (with[c] - without[c]) / (area * fmin(t->light[c], 1));
    picture_free(&p);
}

static const double black[3] = {0.004, 0.004, 0.005}, dull[3] = {0.35, 0.35, 0.35};

/* A lamp of eight times white has lost seven times what is left of it. */
TEST(lamps)
{
    for (int wide = 4; wide <= 12; wide += 4) {
        const struct thing lamp = {ELLIPSE, wide, wide, {8, 8, 8}};
        double part[3];

        added(black, &lamp, 0, 0.05, 1, part);
        if (part[1] < 1 || part[1] > 14)
            fail_msg("a lamp of %d pixels gets %.2f of its light, not about 7", wide, part[1]);
    }
}

/* A lamp by night gets more the more glare it has; on a lit wall that counts for little. */
TEST(glare)
{
    static const double wall[3] = {0.3, 0.3, 0.3};
    const struct thing lamp = {ELLIPSE, 8, 8, {24, 24, 24}};
    double faint[3], strong[3], by_day[3];

    added(black, &lamp, 0, 0.002, 1, faint);
    added(black, &lamp, 0, 0.05, 1, strong);
    added(wall, &lamp, 0, 0.05, 1, by_day);
    if (strong[1] < 1.3 * faint[1] || by_day[1] > 0.3)
        fail_msg("a lamp with hardly any glare gets %.2f of its light, with much of it %.2f, by "
                 "day %.2f",
                 faint[1], strong[1], by_day[1]);
}

TEST(day)
{
    static const struct thing thing[] = {
        {BOX, 60, 40, {1.02, 1.02, 1.02}},
        {BOX, 9, 7, {1.05, 1.05, 1}},
        {ELLIPSE, 200, 150, {1.3, 1.3, 1.5}},
        {ELLIPSE, 5, 5, {1.1, 0.3, 0.3}},
    };

    for (size_t i = 0; i < sizeof thing / sizeof *thing; i++) {
        double part[3];

        added(dull, &thing[i], 0, 0.002, 1, part);
        for (int c = 0; c < 3; c++)
            if (part[c] > 0.15 || part[c] < -0.01)
                fail_msg("thing %zu by day gets %.3f of its light in channel %d", i, part[c], c);
    }
}

/* Where one channel alone is clipped, hardly anything is lost, as far as is known. */
TEST(petals)
{
    const struct thing petal = {ELLIPSE, 9, 9, {3, 0.1, 0.3}};
    double part[3];

    added(black, &petal, 0, 0.05, 1, part);
    for (int c = 0; c < 3; c++)
        if (fabs(part[c]) > 0.01)
            fail_msg("a petal gets %.3f of its light in channel %d", part[c], c);
}

/* An orange lamp stays orange. */
TEST(colours)
{
    const struct thing lamp = {ELLIPSE, 8, 8, {8, 3, 0.4}};
    double part[3];

    added(black, &lamp, 0, 0.05, 1, part);
    assert_true(part[0] > 0.3);
    assert_true(part[0] > 0.9 * part[1]);
    assert_true(part[1] > 2 * 0.4 * part[2]);
}

/* A warm lamp that is clipped to white has lost half a white of blue and seven of red: its disc
 * does not become as white as what is left of it. */
TEST(colours_of_white)
{
    const struct thing lamp = {ELLIPSE, 8, 8, {8, 4, 1.5}};
    double part[3];

    added(black, &lamp, 0, 0.05, 1, part);
    assert_true(part[0] > 3);
    if (part[2] > 0.5 * part[0])
        fail_msg("a warm lamp gets %.2f of red, %.2f of blue", part[0], part[2]);
}

/* The light that something white of so much light gets on a board on a wall. */
static void get_on_board(const double wall[3], const double board[3], double light, double more[3])
{
    const struct thing near = {ELLIPSE, 26, 26, {board[0], board[1], board[2]}};
    const struct thing white = {ELLIPSE, 8, 8, {light, light, light}};
    struct picture p = with_skirt(wall, &near, 0, 0);
    double before[3];

    draw_thing(&p, &white, CX, CY);
    light_of(&p, 0, before);
    light_of(&p, 1, more);
    for (int c = 0; c < 3; c++)
        more[c] -= before[c];
    picture_free(&p);
}

/* Paint near something white and clipped is brighter than what is farther off, but in blue alone,
 * or not in red: the white does not become blue, or cyan. */
TEST(painted)
{
    static const double wall[2][3] = {{0.137, 0.145, 0.191}, {0.385, 0.168, 0.058}};
    static const double board[2][3] = {{0.128, 0.153, 0.297}, {0.365, 0.253, 0.153}};

    for (int i = 0; i < 2; i++) {
        double more[3];

        get_on_board(wall[i], board[i], 2, more);
        if (more[0] < 0.5 || more[0] < 0.9 * more[1] || more[0] < 0.9 * more[2])
            fail_msg("case %d: white gets %.2f %.2f %.2f", i, more[0], more[1], more[2]);
    }
}

TEST(scales)
{
    const struct thing lamp = {ELLIPSE, 8, 8, {6, 6, 6}};
    double half[3], one[3];

    added(black, &lamp, 0, 0.05, 0.25f, half);
    added(black, &lamp, 0, 0.05, 0.5f, one);
    if (half[1] < 0.4 * one[1] || half[1] > 0.6 * one[1])
        fail_msg("half the estimate adds %.2f, the whole %.2f", half[1], one[1]);
}

/* The hue changes little where little light is lost: each channel has lost little. */
TEST(little)
{
    const struct thing lamp = {ELLIPSE, 8, 8, {4, 4.5, 9}};
    double some[3], more[3];

    added(black, &lamp, 0, 0.05, 0.02f, some);
    added(black, &lamp, 0, 0.05, 0.2f, more);
    assert_true(some[1] > 0.01);
    for (int c = 0; c < 3; c++)
        if (some[c] > 2 * 0.1 * more[c])
            fail_msg("a tenth of the estimate adds %.3f, all of it %.2f", some[c], more[c]);
}

/* A lamp that moves by parts of a pixel is not another lamp. */
TEST(steady)
{
    const struct thing lamp = {ELLIPSE, 7, 7, {6, 6, 6}};
    double least = 1e9, most = 0;

    for (int i = 0; i < 8; i++) {
        double part[3];

        added(black, &lamp, i / 8.0, 0.05, 1, part);
        least = fmin(least, part[1]);
        most = fmax(most, part[1]);
    }
    if (most > 1.25 * least)
        fail_msg("a moving lamp gets %.2f to %.2f of its light", least, most);
}

/* The light of a lamp's disc. */
static double light_of_disc(const struct picture *p)
{
    const struct refocus_highlight_params highlights = estimated(1);
    uint8_t *out = malloc(3 * W * H);
    double light = 0;

    assert_non_null(out);
    render(p, &highlights, 0, 2, K, out);
    for (int y = CY - 12; y < CY + 12; y++)
        for (int x = CX - 12; x < CX + 12; x++)
            light += picture_light(out[3 * (y * W + x) + 1]);
    free(out);
    return light;
}

/* A lamp below a crowd of small ones keeps its light, though all of them are in one part of the
 * lists, and are more than its share. */
TEST(crowded)
{
    const struct thing lamp = {ELLIPSE, 7, 7, {6, 6, 6}};
    struct picture p = with_skirt(black, &lamp, 0, 0.05);
    double alone, among;

    alone = light_of_disc(&p);
    for (int y = 64; y < 108; y++)
        for (int x = 0; x < W; x++) {
            const int across = abs(x % 9 - 4), down = abs(y % 9 - 4);

            if (abs(x - CX) > 40 && across < 3 && down < 4)
                memset(p.rgb + 3 * (ptrdiff_t)(y * W + x), across < 2 && down < 3 ? 255 : 140, 3);
        }
    among = light_of_disc(&p);
    if (among < 0.8 * alone || among > 1.25 * alone)
        fail_msg("a lamp among others has a light of %.2f, alone %.2f", among, alone);
    picture_free(&p);
}

/* A lamp of a video, or none, whose skirt flickers. */
static struct picture frame_of(int i)
{
    const struct thing lamp = {ELLIPSE, 4, 4, {6, 6, 6}};
    static const double share[4] = {0.05, 0.062, 0.047, 0.058};

    return i == 8 ? picture_flat(W, H, (uint8_t[3]){0, 0, 0}, BEHIND)
                  : with_skirt(black, &lamp, i * 0.37, share[i % 4]);
}

/* Renders frames 0 to 9 one after the other; returns how far the light of frames 3 to 7 differs, as
 * a part of it, and sets the light of the last two. */
static double flicker(float keep, bool in_place, double last[2], uint8_t *out)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, K);
    struct refocus_settings params = refocus_settings_default(0.5f, K);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_renderer *renderer;
    double least = 1e9, most = 0;

    limits.threads = in_place ? 1 : 2;
    limits.in_place = limits.highlights = in_place;
    params.highlights = estimated(1);
    params.highlights.steady = keep;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    for (int i = 0; i < 10; i++) {
        struct picture p = frame_of(i);
        const struct refocus_image photo = picture_image(&p);
        const struct refocus_disparity disparity = picture_disparity(&p);
        double light = 0;

        assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        for (int y = CY - 20; y < CY + 20; y++)
            for (int x = CX - 20; x < CX + 20; x++)
                light += picture_light(out[3 * (y * W + x) + 1]);
        if (i >= 8)
            last[i - 8] = light;
        else if (i >= 3) {
            least = fmin(least, light);
            most = fmax(most, light);
        }
        if (i < 9)
            memset(out, 0, 3 * W * H);
        picture_free(&p);
    }
    refocus_renderer_destroy(&renderer);
    return (most - least) / most;
}

/* Light that flickers is held; a lamp that goes out or on is followed at once. Strips do as well.
 */
TEST(video)
{
    uint8_t *held = malloc(3 * W * H), *other = malloc(3 * W * H);
    double plain_last[2], held_last[2], strip_last[2], plain, steady_now;

    assert_non_null(held);
    assert_non_null(other);
    plain = flicker(0, false, plain_last, other);
    steady_now = flicker(0.8f, false, held_last, held);
    if (plain < 0.03 || steady_now > 0.7 * plain)
        fail_msg("light of a lamp differs by %.3f, held by %.3f", plain, steady_now);
    if (held_last[0] != plain_last[0] || fabs(held_last[1] / plain_last[1] - 1) > 0.01)
        fail_msg("a lamp that goes out and on has %.1f and %.1f, held %.1f and %.1f", plain_last[0],
                 plain_last[1], held_last[0], held_last[1]);
    flicker(0.8f, true, strip_last, other);
    assert_same_pixels(other, held, W, H, "held in strips");
    free(held);
    free(other);
}

/* A photo that was held is rendered as by a new renderer once nothing is to be held. */
TEST(held_no_more)
{
    struct refocus_settings params = refocus_settings_default(0.5f, K);
    struct refocus_renderer *renderer = NULL;
    uint8_t *wanted = malloc(3 * W * H), *is = malloc(3 * W * H);
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, wanted, W, H, 3 * W);

    assert_non_null(wanted);
    assert_non_null(is);
    params.highlights = estimated(1);
    for (int i = 0; i < 3; i++) { /* a new renderer, and frames before and at the same place */
        struct picture p = frame_of(i == 0 ? 3 : i + 1);
        const struct refocus_image photo = picture_image(&p);
        const struct refocus_disparity disparity = picture_disparity(&p);

        if (!renderer)
            renderer = prepared(&p, K, 2);
        assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
        params.highlights.steady = i == 0 ? 0 : 0.9f;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        if (i == 0)
            refocus_renderer_destroy(&renderer);
        image.plane[0] = is;
        picture_free(&p);
    }
    assert_memory_not_equal(is, wanted, 3 * W * H);
    params.highlights.steady = 0;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    assert_same_pixels(is, wanted, W, H, "held no more");
    refocus_renderer_destroy(&renderer);
    free(wanted);
    free(is);
}

/* Where nothing is clipped, every byte stays. */
TEST(unclipped)
{
    const struct refocus_highlight_params off = refocus_highlight_params_default();
    const struct refocus_highlight_params on = estimated(1);
    struct picture p = picture_make(W, H, 5);
    uint8_t *a = malloc(3 * W * H), *b = malloc(3 * W * H);

    assert_non_null(a);
    assert_non_null(b);
    for (int i = 0; i < 3 * W * H; i++)
        p.rgb[i] = p.rgb[i] > 242 ? 242 : p.rgb[i];
    render(&p, &off, 0, 2, K, a);
    render(&p, &on, 0, 2, K, b);
    assert_same_pixels(b, a, W, H, "nothing clipped");
    free(a);
    free(b);
    picture_free(&p);
}

/* Threads, blocks, larger renderers and earlier renders change nothing. */
TEST(same_bytes)
{
    const struct refocus_highlight_params on = estimated(1);
    const struct refocus_highlight_params off = refocus_highlight_params_default();
    struct refocus_settings params = refocus_settings_default(0.5f, K);

    for (uint32_t seed = 1; seed <= 4; seed++) {
        const int w = seed == 4 ? 1441 : 331, h = seed == 4 ? 391 : 289;
        struct picture p = night(seed, w, h);
        uint8_t *whole = malloc(3 * (size_t)w * (size_t)h), *is = malloc(3 * (size_t)w * (size_t)h);
        const struct refocus_image image =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, is, w, h, 3 * w);
        struct refocus_renderer *renderer;

        assert_non_null(whole);
        assert_non_null(is);
        render(&p, &off, 0, 1, K, is);
        render(&p, &on, 0, 1, K, whole);
        assert_true(memcmp(is, whole, 3 * (size_t)w * (size_t)h) != 0);
        render(&p, &on, 0, 4, K, is);
        assert_same_pixels(is, whole, w, h, "estimated by four threads");
        render(&p, &on, 1, 2, K, is);
        assert_same_pixels(is, whole, w, h, "estimated in blocks");
        render(&p, &on, 0, 2, 127, is);
        assert_same_pixels(is, whole, w, h, "estimated by a renderer for larger blurs");
        renderer = prepared(&p, K, 2);
        for (int i = 0; i < 3; i++) {
            params.highlights = refocus_highlight_params_default();
            params.highlights.gain = i == 1 ? 4 : 1;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
            params.highlights = on;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
            assert_same_pixels(is, whole, w, h, "estimated after another render");
        }
        refocus_renderer_destroy(&renderer);
        free(whole);
        free(is);
        picture_free(&p);
    }
}
