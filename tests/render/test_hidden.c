/* test_hidden.c: what rays see of the hidden background beside the edge of a subject: nothing of
 * the subject itself, and no borders of tiles. */
#include "pictures.h"

enum { WIDTH = 192, HEIGHT = 160, TILE = 16, MIDDLE = WIDTH / 2 };

static struct refocus_renderer *prepare(const struct picture *p, float blur)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, blur);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity map = picture_disparity(p);
    struct refocus_renderer *renderer;

    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &map), REFOCUS_OK);
    return renderer;
}

static void render(struct refocus_renderer *renderer, float focus, float blur, int rays,
                   uint8_t *rgb)
{
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, WIDTH, HEIGHT, 3 * WIDTH);
    struct refocus_render_params params = refocus_render_params_default(focus, blur);

    params.rays = rays;
    assert_int_equal(refocus_render(renderer, &params, &out), REFOCUS_OK);
}

/* A white subject in focus before a black wall: the wall stays black, however little its blur is.
 * Its edge is vertical, or a diagonal. */
TEST(stays_dark)
{
    static const int rays[] = {16, 64, 128, REFOCUS_RAYS_FULL};
    uint8_t *rgb = malloc(3 * WIDTH * HEIGHT);

    assert_non_null(rgb);
    for (int diagonal = 0; diagonal < 2; diagonal++) {
        struct picture p = picture_flat(WIDTH, HEIGHT, (const uint8_t[]){0, 0, 0}, 0);
        struct refocus_renderer *renderer;

        for (int i = 0; i < WIDTH * HEIGHT; i++)
            if (i % WIDTH + (diagonal ? i / WIDTH - HEIGHT / 2 : 0) > MIDDLE) {
                memset(p.rgb + 3 * i, 255, 3);
                p.disparity[i] = 65535;
            }
        renderer = prepare(&p, 4);
        for (int step = 0; step < 4 * 32; step++) {
            const float blur = 0.25f + (float)(step / 4) * 0.05f;
            int brightest = 0;

            render(renderer, 1, blur, rays[step % 4], rgb);
            for (int i = 0; i < WIDTH * HEIGHT; i++)
                if (p.disparity[i] == 0 && rgb[3 * i] > brightest)
                    brightest = rgb[3 * i];
            if (brightest > 0)
                fail_msg("%s edge, K = %g, %d rays: %d", diagonal ? "diagonal" : "vertical",
                         (double)blur, rays[step % 4], brightest);
        }
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
    free(rgb);
}

/* A dark bar far before a bright wall in focus has a row of half-covered pixels on either side that
 * the map gives to the wall: but for them the wall that shows through the blurred bar is as bright
 * as if there were none. */
TEST(leaves_mixtures)
{
    uint8_t *rgb[2] = {malloc(3 * WIDTH * HEIGHT), malloc(3 * WIDTH * HEIGHT)};

    assert_true(rgb[0] && rgb[1]);
    for (int mixed = 0; mixed < 2; mixed++) {
        struct picture p = picture_flat(WIDTH, HEIGHT, (const uint8_t[]){220, 210, 200}, 0);
        struct refocus_renderer *renderer;

        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const int from_bar = abs(i / WIDTH - HEIGHT / 2) - TILE;

            if (from_bar < 0)
                p.disparity[i] = 65535;
            if (from_bar < mixed)
                memset(p.rgb + 3 * i, from_bar < 0 ? 20 : 130, 3);
        }
        renderer = prepare(&p, 20);
        render(renderer, 0, 20, 64, rgb[mixed]);
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        if (abs(i / (3 * WIDTH) - HEIGHT / 2) != TILE && abs(rgb[0][i] - rgb[1][i]) > 1)
            fail_msg("row %d: %d, %d without mixtures", i / (3 * WIDTH), rgb[1][i], rgb[0][i]);
    free(rgb[0]);
    free(rgb[1]);
}

/* The largest step between columns `at` - 1 and `at` + 16 k behind the bar, beyond what the slopes
 * on both sides make of it; in half codes. */
static int largest_step(const uint8_t *rgb, int at)
{
    int most = 0;

    for (int y = HEIGHT / 2 - TILE; y < HEIGHT / 2 + TILE; y++)
        for (int x = 2 * TILE + at; x < WIDTH - 2 * TILE; x += TILE) {
            const uint8_t *p = rgb + 3 * (y * WIDTH + x);
            const int step = abs(2 * (p[0] - p[-3]) - (p[-3] - p[-6]) - (p[3] - p[0]));

            most = step > most ? step : most;
        }
    return most;
}

/* A dark bar before a striped wall, of which one half is in focus: what rays see of the wall behind
 * the blurred bar changes about as smoothly from tile to tile as within tiles. */
TEST(has_no_seams)
{
    struct picture p = picture_flat(WIDTH, HEIGHT, (const uint8_t[]){0, 0, 0}, 0);
    struct refocus_renderer *renderer;
    uint8_t *rgb = malloc(3 * WIDTH * HEIGHT);
    int within = 0;

    assert_non_null(rgb);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const bool bar = abs(i / WIDTH - HEIGHT / 2) < TILE;

        memset(p.rgb + 3 * i, bar ? 20 : i / WIDTH / 6 % 2 ? 60 : 220, 3);
        p.disparity[i] = (uint16_t)(bar ? 65535 : i % WIDTH < MIDDLE - TILE / 2 ? 0 : 30000);
    }
    renderer = prepare(&p, 40);
    render(renderer, 0, 40, 64, rgb);
    for (int i = 1; i < TILE - 1; i++)
        within = largest_step(rgb, i) > within ? largest_step(rgb, i) : within;
    assert_in_range(largest_step(rgb, 0), 0, 2 * within);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
    free(rgb);
}

/* A grey subject in focus before a white wall, on a map with Gaussian noise, or nearly: 1/200 of
 * the range is a fifth of a pixel of blur. No light of the wall comes through the subject. */
TEST(noise_lets_nothing_through)
{
    struct picture p = picture_flat(WIDTH, HEIGHT, (const uint8_t[]){255, 255, 255}, 0);
    struct refocus_renderer *renderer;
    uint8_t *rgb = malloc(3 * WIDTH * HEIGHT);
    uint32_t seed = 1;

    assert_non_null(rgb);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int sum = 0;

        for (int k = 0; k < 12; k++)
            sum += (int)(noise(&seed) % 657) - 328; /* a variance of twelve times 190 squared */
        p.disparity[i] = (uint16_t)(i % WIDTH < TILE ? 1000 + sum / 2 : 40000 + sum / 2);
        if (i % WIDTH >= TILE)
            memset(p.rgb + 3 * i, 90, 3);
    }
    renderer = prepare(&p, 40);
    render(renderer, 40000 / 65535.0f, 40, 64, rgb);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (i % WIDTH >= TILE + 2 && abs(rgb[3 * i] - 90) > 20)
            fail_msg("(%d, %d): %d", i % WIDTH, i / WIDTH, rgb[3 * i]);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
    free(rgb);
}
