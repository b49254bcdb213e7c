/* test_splat.c: highlights that are splatted are even discs, hidden where rays say so, of the light
 * that rays would hit. */
#include "pictures.h"
#include "things.h"

enum { AROUND = 30 }; /* codes, where there is no highlight */
enum { W = 160, H = 144, CX = W / 2, CY = H / 2 };
enum { BEHIND = 6554 }; /* 12 pixels of blur behind the focus at 0.5 */

/* Apertures: so many blades, 0: round, or these. */
enum { HEART = -1, STAR = -2, MASK = -3, BUBBLE = -4 /* with a bright edge */ };

/* A lens: its aperture, and its look; and the method that renders it. */
struct lens {
    int shape;
    float cat_eye, fringe;
    uint32_t method;
};

/* An aperture that is turned. If it has a hole that a lens cuts off, highlights are gathered
 * through it; else they are splatted. */
static struct refocus_aperture *make_aperture(int blades, bool gathered)
{
    /* Nothing of it lies beyond the circle, where a lens would move it. */
    static const uint8_t mask[7][4] = {{0},
                                       {0, 255, 255, 0},
                                       {0, 0, 255, 255},
                                       {255, 120, 255, 0},
                                       {255, 255, 255, 0},
                                       {0, 0, 255, 0},
                                       {0}};
    struct refocus_aperture_params params = refocus_aperture_params_default();
    struct refocus_aperture *aperture;

    if (blades == MASK) {
        params.mask = mask[0];
        params.mask_width = params.mask_stride = 4;
        params.mask_height = 7;
        params.squeeze = 0.8;
        assert_int_equal(refocus_aperture_create(&aperture, &params), REFOCUS_OK);
        return aperture;
    }
    params.edge_behind = blades == BUBBLE ? 0.7 : 0;
    params.edge_before = -params.edge_behind;
    params.blades = blades > 0 ? blades : 0;
    params.figure = blades == HEART  ? REFOCUS_FIGURE_HEART
                    : blades == STAR ? REFOCUS_FIGURE_STAR
                                     : REFOCUS_FIGURE_NONE;
    params.rotation_deg = 17;
    params.hole = gathered ? 0.02 : 0;
    assert_int_equal(refocus_aperture_create(&aperture, &params), REFOCUS_OK);
    return aperture;
}

static void render(struct refocus_renderer *renderer, int blur, int rays, float gain,
                   bool prefilter, const struct refocus_aperture *aperture, const struct lens *lens,
                   bool gathered, uint8_t out[3 * W * H])
{
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_settings params = refocus_settings_default(0.5f, (float)blur);

    params.render.rays = rays;
    params.render.prefilter = prefilter;
    params.highlights.gain = gain;
    params.render.aperture = aperture;
    if (lens) {
        params.look.cat_eye = lens->cat_eye;
        params.look.fringe = lens->fringe;
        params.render.method = lens->method;
    }
    if (gathered && params.look.cat_eye == 0)
        params.look.cat_eye = 0.001f;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
}

/* Codes of green alone. */
static void render_green(struct refocus_renderer *renderer, int blur, int rays, float gain,
                         const struct refocus_aperture *aperture, int green[W * H])
{
    static uint8_t out[3 * W * H];

    render(renderer, blur, rays, gain, true, aperture, NULL, false, out);
    for (int i = 0; i < W * H; i++)
        green[i] = out[3 * i + 1];
}

/* A highlight of 2 half + 1 pixels at (x, y) is one even disc: what it adds to codes that
 * are all AROUND differs by an eighth inside, and is nothing outside. */
static void expect_disc(const int green[W * H], double x, double y, int half, double radius)
{
    int inside = 0, least = 255, most = 0;

    for (int i = 0; i < W * H; i++) {
        const double away = hypot(i % W - x, i / W - y);
        const int gained = green[i] - AROUND;

        if (away > radius + 1.5 * half + 1)
            assert_int_equal(gained, 0);
        if (away > radius - half - 1)
            continue;
        inside++;
        least = gained < least ? gained : least;
        most = gained > most ? gained : most;
    }
    if (inside < 3 || least < 4 || most - least > least / 8 + 1)
        fail_msg("a disc of %g pixels: %d pixels gained %d to %d codes", radius, inside, least,
                 most);
}

/* A small highlight before or behind the focus is one even disc with a crisp edge, of few
 * rays and of many. */
TEST(discs)
{
    static const uint16_t depths[] = {6554, 24000, 59000, 42000};

    for (int k = 0; k < 4; k++) {
        struct picture p = picture_flat(W, H, (uint8_t[3]){AROUND, AROUND, AROUND}, depths[k]);
        const double radius = fabs(30 * (0.5 - depths[k] / 65535.0));
        struct refocus_renderer *renderer;

        for (int y = CY - 1; y <= CY + 1; y++)
            memset(p.rgb + 3 * (y * W + CX - 1), 255, 9);
        renderer = prepared(&p, 30, 2);
        for (int rays = 32; rays <= 128; rays *= 4) {
            static const struct lens search = {.method = REFOCUS_METHOD_SEARCH};
            static uint8_t out[3 * W * H];
            static int green[W * H];

            render_green(renderer, 30, rays, 16, NULL, green);
            expect_disc(green, CX, CY, 1, radius);
            render(renderer, 30, rays, 16, true, NULL, &search, false, out);
            for (int i = 0; i < W * H; i++)
                green[i] = out[3 * i + 1];
            expect_disc(green, CX, CY, 1, radius);
        }
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
}

/* A highlight on a slanted wall is, too: a tile's slabs are wide where the wall is that much
 * out of focus, and what is about as near as the highlight does not hide it. */
TEST(slanted)
{
    struct refocus_renderer *renderer;
    static int green[W * H];

    for (int k = -3; k <= 3; k++) {
        struct picture p = picture_flat(W, H, (uint8_t[3]){AROUND, AROUND, AROUND}, BEHIND);
        const int x = CX + 9 * k, y = CY + 4 * k;

        for (int i = 0; i < W * H; i++)
            p.disparity[i] = (uint16_t)(12000 - 50 * (i % W) - 20 * (i / W));
        for (int j = y - 2; j <= y + 2; j++)
            memset(p.rgb + 3 * (j * W + x - 2), 255, 15);
        renderer = prepared(&p, 100, 2);
        render_green(renderer, 100, 128, 16, NULL, green);
        expect_disc(green, x, y, 2, 100 * (0.5 - p.disparity[y * W + x] / 65535.0));
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
}

/* Highlights behind a post: in focus it keeps its codes, and what is nearer cuts discs off
 * where rays say so, too; of a round aperture, of one of five blades, which has no two
 * sides alike, of figures whose rows are several chords, of masks and rings, and of what lenses
 * with a cat's eye and colour fringes make of them. */
static void expect_hidden(uint16_t post, const struct lens *lens)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){30, 30, 30}, BEHIND);
    struct refocus_aperture *splatted = make_aperture(lens->shape, false),
                            *gathered = make_aperture(lens->shape, true);
    static uint8_t out[4][3 * W * H];
    struct refocus_renderer *renderer;
    double light = 0, off = 0;

    for (int i = 0; i < 8; i++)
        draw_skirt(&p, 19 + 17 * i, 21 + 13 * i, 9, (const double[3]){8, 8, 8}, 0.04);
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 9; j++)
            memset(p.rgb + 3 * ((20 + 13 * i + j % 3) * W + 18 + 17 * i + j / 3), 255, 3);
    for (int y = 0; y < H; y++)
        for (int x = CX - 9; x < CX + 9; x++) {
            p.disparity[y * W + x] = post;
            memset(p.rgb + 3 * (y * W + x), 60, 3);
        }
    renderer = prepared(&p, 30, 2);
    for (int k = 0; k < 4; k++)
        render(renderer, 30, 192, k % 2 ? 6 : 1, true, k < 2 ? splatted : gathered, lens, k >= 2,
               out[k]);
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 2; c++) {
            const double own = picture_light(out[1][3 * i + c]) - picture_light(out[0][3 * i + c]);
            const double of_rays =
                picture_light(out[3][3 * i + c]) - picture_light(out[2][3 * i + c]);

            if (post == 32768 && abs(i % W - CX) < 9 - (i % W >= CX))
                assert_int_equal(out[1][3 * i + c], out[0][3 * i + c]);
            light += own * own;
            off += (own - of_rays) * (own - of_rays);
        }
    /* So many rays show masks and bright edges less well. */
    if (off > (lens->shape <= MASK ? 0.06 : 0.03) * light || light == 0)
        fail_msg("aperture %d, cat's eye %g, fringe %g, a post at %u: rays do not gather %.3f of "
                 "what is splatted",
                 lens->shape, lens->cat_eye, lens->fringe, post, off / light);
    refocus_aperture_destroy(&splatted);
    refocus_aperture_destroy(&gathered);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

TEST(hidden)
{
    static const uint16_t posts[] = {32768, 20000, 60000};
    static const struct lens lenses[] = {{0, 0, 0, 0},    {5, 0, 0, 0},    {HEART, 0, 0, 0},
                                         {STAR, 0, 0, 0}, {MASK, 0, 0, 0}, {BUBBLE, 0, 0.15f, 0},
                                         {0, 0.5f, 0, 0}, {5, 0.5f, 0, 0}, {0, 0, -0.3f, 0}};

    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < sizeof lenses / sizeof lenses[0]; i++)
            if (i < 4 || i % 3 == (size_t)k)
                expect_hidden(posts[k], &lenses[i]);
}

/* A highlight that is out of focus by 100 pixels is cut off by what is most of the way to it. */
TEST(hidden_from_afar)
{
    static const uint16_t edges[] = {19661, 6554, 45875}; /* out of focus by 70, 90, 30 pixels */

    for (int k = 0; k < 3; k++) {
        struct picture p = picture_flat(W, H, (uint8_t[3]){10, 10, 10}, 0);
        struct refocus_aperture *gathered = make_aperture(0, true);
        struct refocus_settings params = refocus_settings_default(1, 100);
        struct refocus_renderer *renderer;
        static uint8_t out[2][3 * W * H];
        double light = 0, off = 0;

        for (int y = 0; y < H; y++)
            for (int x = 0; x < CX; x++)
                p.disparity[y * W + x] = edges[k];
        draw_skirt(&p, CX + 10, CY, 25, (const double[3]){8, 8, 8}, 0.04);
        for (int y = CY - 2; y <= CY + 2; y++)
            memset(p.rgb + 3 * (y * W + CX + 8), 255, 15);
        renderer = prepared(&p, 100, 2);
        params.highlights.gain = 16;
        params.render.rays = REFOCUS_RAYS_FULL;
        for (int i = 0; i < 2; i++) {
            const struct refocus_image image =
                refocus_image_packed(REFOCUS_FORMAT_RGB8, out[i], W, H, 3 * W);

            params.render.aperture = i ? gathered : NULL;
            params.look.cat_eye = i ? 0.001f : 0;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        }
        for (int i = 0; i < W * H; i++) {
            const double dark = picture_light(10), of_rays = picture_light(out[1][3 * i + 1]);
            const double own = picture_light(out[0][3 * i + 1]);

            light += (own - dark) * (own - dark);
            off += (own - of_rays) * (own - of_rays);
        }
        if (off > 0.01 * light || light == 0)
            fail_msg("an edge at %u: rays do not gather %.4f of what is splatted", edges[k],
                     off / light);
        refocus_aperture_destroy(&gathered);
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
}

/* Light of each channel, at a gain of 4, through such an iris, of what there is
 * without. */
static void gained(struct refocus_renderer *renderer, int shape, bool gathered, double times[3])
{
    struct refocus_aperture *aperture = make_aperture(shape, gathered);
    double light[2][3] = {{0}};

    for (int k = 0; k < 2; k++) {
        static uint8_t out[3 * W * H];

        render(renderer, 30, 512, k ? 4 : 1, false, aperture, NULL, gathered, out);
        for (int i = 0; i < 3 * W * H; i++)
            light[k][i % 3] += picture_light(out[i]);
    }
    for (int c = 0; c < 3; c++)
        times[c] = light[1][c] / light[0][c];
    refocus_aperture_destroy(&aperture);
}

/* About as much whichever way highlights go. */
TEST(ways)
{
    const struct thing highlight = {ELLIPSE, 6, 5, {12, 6, 1.5}};
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, BEHIND);
    struct refocus_renderer *renderer;

    draw_thing(&p, &highlight, CX + 0.3, CY - 0.2);
    renderer = prepared(&p, 30, 2);
    for (int k = 0; k < 6; k++) {
        static const int shapes[] = {0, 6, HEART, STAR, MASK, BUBBLE};
        double splatted[3], gathered[3];

        gained(renderer, shapes[k], false, splatted);
        gained(renderer, shapes[k], true, gathered);
        for (int c = 0; c < 3; c++)
            if (fabs(splatted[c] - gathered[c]) > 0.05 * gathered[c])
                fail_msg("aperture %d: channel %d has %.3f times its light splatted, %.3f "
                         "gathered",
                         shapes[k], c, splatted[c], gathered[c]);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
