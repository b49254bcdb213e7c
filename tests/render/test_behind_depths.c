/* test_behind_depths.c: a second layer that the caller knows, where what it hides has several
 * depths: a bar close to the lens, before a board, before a wall. */
#include "pictures.h"

enum { W = 150, H = 130, WALL = 3000, BOARD = 21000, BAR = 60000, TOP = 60 };
static const float K = 40;
static const uint8_t bar_code[3] = {40, 160, 70};

/* How wide the bar is, and what is behind it. */
struct kind {
    const char *name;
    int wide;
    bool has_rod; /* in place of the board a rod, all of it behind the bar */
};

struct scene {
    uint8_t photo[3 * W * H], layer[4 * W * H];
    uint16_t map[W * H], layer_map[W * H];
};

static int top_of_bar(int x)
{
    return TOP + (x - W / 2) / 9;
}

static bool in_bar(const struct kind *kind, int x, int y)
{
    return y >= top_of_bar(x) && y < top_of_bar(x) + kind->wide;
}

static bool in_board(const struct kind *kind, int x, int y)
{
    return kind->has_rod ? y >= top_of_bar(x) + 5 && y < top_of_bar(x) + 9 : y > 30 + x / 4;
}

/* The code of the board, and of the wall, in a channel. */
static uint8_t behind_code(bool board, int x, int y, int c)
{
    return (uint8_t)(board ? 30 + 12 * c + (x / 5 + y / 6) % 2 * 25 : 190 + 15 * c + x / 8);
}

static void make(struct scene *s, const struct kind *kind)
{
    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W;
        const bool bar = in_bar(kind, x, y), board = in_board(kind, x, y);

        for (int c = 0; c < 3; c++) {
            s->photo[3 * i + c] = bar ? bar_code[c] : behind_code(board, x, y, c);
            s->layer[4 * i + c] = behind_code(board && bar, x, y, c);
        }
        s->map[i] = bar ? BAR : board ? BOARD : WALL;
        s->layer[4 * i + 3] = bar || board ? 255 : 0;
        s->layer_map[i] = bar && board ? BOARD : WALL;
    }
}

/* Traces all rays of a disc, each of them exactly. */
static void trace(const struct kind *kind, double focus, uint8_t *out)
{
    enum { GRID = 14 };
    static const int depth[] = {BAR, BOARD, WALL};

    for (int i = 0; i < W * H; i++) {
        double sum[3] = {0};
        int rays = 0;

        for (int v = -GRID; v <= GRID; v++)
            for (int u = -GRID; u <= GRID; u++) {
                const double a = u / (GRID + 0.5), b = v / (GRID + 0.5);
                int x[3], y[3], k = 0;

                if (a * a + b * b > 1)
                    continue;
                for (int d = 0; d < 3; d++) {
                    const double s = (double)K * (focus - depth[d] / 65535.0);

                    x[d] = (int)floor(i % W + a * s + 0.5);
                    y[d] = (int)floor(i / W + b * s + 0.5);
                }
                k = in_bar(kind, x[0], y[0]) ? 0 : in_board(kind, x[1], y[1]) ? 1 : 2;
                rays++;
                for (int c = 0; c < 3; c++)
                    sum[c] += picture_light(k ? behind_code(k == 1, x[k], y[k], c) : bar_code[c]);
            }
        for (int c = 0; c < 3; c++)
            out[3 * i + c] = picture_code(sum[c] / rays);
    }
}

static void prepare(struct refocus_renderer *renderer, const struct scene *s, bool behind)
{
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, (void *)s->photo, W, H, 3 * W);
    const struct refocus_image layer =
        refocus_image_packed(REFOCUS_FORMAT_RGBA8, (void *)s->layer, W, H, 4 * W);
    const struct refocus_disparity map = refocus_disparity16(s->map, W, H, 2 * W);
    const struct refocus_disparity farther = refocus_disparity16(s->layer_map, W, H, 2 * W);
    struct refocus_scene scene = refocus_scene_default(&photo, &map);

    scene.behind = behind ? &layer : NULL;
    scene.behind_disparity = behind ? &farther : NULL;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
}

static struct refocus_renderer *create(float most)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, most);
    struct refocus_renderer *renderer;

    limits.behind = limits.thin = 1;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    return renderer;
}

static void render(struct refocus_renderer *renderer, float focus, float blur, uint8_t *out)
{
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_settings params = refocus_settings_default(focus, blur);

    params.render.rays = 64;
    params.thin.enabled = 1;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
}

/* The mean squared difference. */
static double difference(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;

    for (int i = 0; i < 3 * W * H; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum / (3 * W * H);
}

/* The focus on the wall: nothing that is known of the board shows as sharp as that. */
TEST(board_is_blurred)
{
    static const struct kind kinds[] = {
        {"wire", 2, false}, {"bar", 14, false}, {"rod behind a bar", 14, true}};
    static struct scene s;
    static uint8_t out[3 * W * H], should[3 * W * H];
    struct refocus_renderer *renderer = create(K);
    const float focus = WALL / 65535.0f;

    for (int i = 0; i < 3; i++) {
        double made_up, known;

        make(&s, &kinds[i]);
        trace(&kinds[i], (double)focus, should);
        prepare(renderer, &s, false);
        render(renderer, focus, K, out);
        made_up = difference(out, should);
        prepare(renderer, &s, true);
        render(renderer, focus, K, out);
        known = difference(out, should);
        printf("%s: %.2f known, %.2f made up\n", kinds[i].name, known, made_up);
        assert_true(known <= made_up);
        assert_true(kinds[i].wide < 14 || kinds[i].has_rod || 4 * known < made_up);
    }
    refocus_renderer_destroy(&renderer);
}

/* A small blur, which needs less around a region than tiles are wide. */
TEST(same_by_regions)
{
    enum { SIDE_OF_REGION = 10 };
    static struct scene s;
    static uint8_t whole[3 * W * H], part[3 * W * H];
    struct refocus_renderer *renderer = create(5);
    struct refocus_render_params params = refocus_render_params_default(WALL / 65535.0f, 5);
    const struct refocus_image all = refocus_image_packed(REFOCUS_FORMAT_RGB8, whole, W, H, 3 * W);

    make(&s, &(struct kind){"bar", 14, false});
    prepare(renderer, &s, true);
    assert_int_equal(refocus_render(renderer, &params, &all), REFOCUS_OK);
    for (int y = 0; y < H; y += SIDE_OF_REGION)
        for (int x = 0; x < W; x += SIDE_OF_REGION) {
            const struct refocus_image image = refocus_image_packed(
                REFOCUS_FORMAT_RGB8, part + 3 * (W * y + x), SIDE_OF_REGION, SIDE_OF_REGION, 3 * W);

            prepare(renderer, &s, true);
            params.region_x = x;
            params.region_y = y;
            params.region_width = params.region_height = SIDE_OF_REGION;
            assert_int_equal(refocus_render(renderer, &params, &image), REFOCUS_OK);
        }
    assert_same_pixels(part, whole, W, H, "regions");
    refocus_renderer_destroy(&renderer);
}

/* A fence in focus, whose edges mix with the wall: what is behind the wall is no part of that. */
TEST(mixtures_are_of_what_is_seen)
{
    static uint8_t layer[4 * W * H], out[3 * W * H], expected[3 * W * H];
    static uint16_t layer_map[W * H];
    struct picture fence = picture_fence(W, H, 3);
    const struct refocus_image photo = picture_image(&fence);
    const struct refocus_image black =
        refocus_image_packed(REFOCUS_FORMAT_RGBA8, layer, W, H, 4 * W);
    const struct refocus_disparity map = picture_disparity(&fence);
    const struct refocus_disparity farther = refocus_disparity16(layer_map, W, H, 2 * W);
    struct refocus_scene scene = refocus_scene_default(&photo, &map);
    struct refocus_renderer *renderer = create(K);

    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    render(renderer, FENCE_NEAR / 65535.0f, 20, expected);
    for (int i = 0; i < W * H; i++)
        layer[4 * i + 3] = fence.disparity[i] == FENCE_FAR ? 255 : 0;
    scene.behind = &black;
    scene.behind_disparity = &farther;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    render(renderer, FENCE_NEAR / 65535.0f, 20, out);
    /* Where a layer is known, half-covered pixels beside crossings are not drawn as the fence;
     * taken for what is behind the wall they are up to 51 codes darker. */
    for (int i = 0; i < 3 * W * H; i++)
        assert_in_range(abs(out[i] - expected[i]), 0, 4);
    refocus_renderer_destroy(&renderer);
    picture_free(&fence);
}
