/* test_edges_video.c: what frames of a video take over from the one before when edges of their
 * depth are placed (REFOCUS_DEPTH_EDGES_STEADY). */
#include "../core/edge_drawings.h"

#include <math.h>

static struct refocus_renderer *renderer;
static struct picture p;

static int set_up(void **state)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(WIDTH, HEIGHT + 20, 4);

    (void)state;
    params.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
    p = make(WIDTH, HEIGHT + 20);
    p.height = HEIGHT;
    return refocus_renderer_create(&renderer, &params);
}

static int tear_down(void **state)
{
    (void)state;
    refocus_renderer_destroy(&renderer);
    end(&p);
    return 0;
}

/* Places the next frame, with a map that has a sample for `side` x `side` pixels; p.out receives
 * the disparities. `how` is AUTO for a frame of its own, of which the video knows nothing then. */
static struct refocus_depth_edges_report frame(uint32_t how, int side)
{
    const struct refocus_image photo = photo_of(&p);
    const struct refocus_disparity map =
        refocus_disparity16(p.map, p.width / side, p.height / side, 2 * (p.width / side));
    struct refocus_scene scene = refocus_scene_default(&photo, &map);
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();

    scene.depth_edges = how;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    assert_int_equal(refocus_get_depth_edges(renderer, &report), REFOCUS_OK);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, p.out, 2 * p.width),
                     REFOCUS_OK);
    return report;
}

/* The disc's map is soft. */
static void draw_soft(double sigma)
{
    draw(&p, disc, 1);
    soften(&p, sigma, 0);
}

/* The map becomes one of the middles, or the means, of squares. */
static void reduce(int side, bool mean)
{
    for (int i = 0; i < p.width / side * (p.height / side); i++) {
        const uint16_t *first =
            p.map + i / (p.width / side) * side * p.width + i % (p.width / side) * side;
        int sum = 0;

        for (int k = 0; k < side * side; k++)
            sum += first[k / side * p.width + k % side];
        p.map[i] = mean ? (uint16_t)(sum / (side * side)) : first[side / 2 * p.width + side / 2];
    }
}

/* A small difference is followed by a quarter a frame; but at once near what moves in the photo, in
 * a frame of another height, and after a map of samples at points, which is not placed. */
TEST(follows_slowly)
{
    enum { FAR = 13107, BY = 400 }; /* 0.2 is the background of the disc. */

    for (int other = 0; other < 4; other++) {
        draw_soft(3);
        frame(REFOCUS_DEPTH_EDGES_AUTO, 1);
        frame(REFOCUS_DEPTH_EDGES_STEADY, 1);
        assert_int_equal(p.out[0], FAR);
        if (other == 2) {
            draw(&p, disc, 1);
            reduce(4, false);
            assert_true(fabs(frame(REFOCUS_DEPTH_EDGES_STEADY, 4).softness - 4 * 0.41) < 0.1);
        }
        p.height = other == 1 ? HEIGHT + 20 : HEIGHT;
        draw_soft(3);
        for (int i = 0; other == 3 && i < 3 * 4; i++) /* in the block from 8, 8 on */
            p.rgb[3 * (8 * WIDTH + 8) + i] ^= 64;
        for (int i = 0; i < p.width * p.height; i++)
            p.map[i] = (uint16_t)(p.map[i] + BY);
        frame(REFOCUS_DEPTH_EDGES_STEADY, 1);
        for (int block = 0; block < 3; block++)
            assert_int_equal(p.out[8 * block * (WIDTH + 1)], FAR + (other ? BY : BY / 4));
        assert_int_equal(p.out[WIDTH - 1], FAR + (other == 1 || other == 2 ? BY : BY / 4));
        p.height = HEIGHT;
    }
}

static float softness_of(uint32_t how, int side, double sigma)
{
    draw_soft(sigma);
    reduce(side, true);
    return frame(how, side).softness;
}

/* Softness is told in pixels of the photo, and follows by a quarter: also where the photo is
 * reduced to half its size, as the map has a sixth of it. */
TEST(softness)
{
    for (int side = 3; side <= 6; side += 3) {
        const double first = softness_of(REFOCUS_DEPTH_EDGES_AUTO, side, 6);
        const double second = softness_of(REFOCUS_DEPTH_EDGES_AUTO, side, 7);
        double found;

        assert_true(first > 5 && first < second && second < 7);
        softness_of(REFOCUS_DEPTH_EDGES_STEADY, side, 6);
        found = softness_of(REFOCUS_DEPTH_EDGES_STEADY, side, 7);
        assert_true(fabs(found - (3 * first + second) / 4) < 1e-3);
    }
}

/* A map that is hardly sharp counts as soft after one that was. */
TEST(parted_stays)
{
    for (int after = 0; after < 2; after++) {
        draw_soft(after ? 2 : 0.3);
        frame(REFOCUS_DEPTH_EDGES_AUTO, 1);
        assert_int_equal(frame(REFOCUS_DEPTH_EDGES_STEADY, 1).parted, after);
        draw_soft(0.46);
        assert_int_equal(frame(REFOCUS_DEPTH_EDGES_STEADY, 1).parted, after);
    }
}

int main(void)
{
    return unit_test_run(set_up, tear_down);
}
