/* test_mixed_pixels.c: mixed pixels along silhouettes go to the nearer surface. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/refocus.h>

#include "depth/mixed_pixels.h"

enum { WIDTH = 203, HEIGHT = 150, RADIUS = 50, NEAR = 50000, FAR = 10000 };

struct stage {
    uint8_t rgb[3 * WIDTH * HEIGHT];
    uint16_t before[WIDTH * HEIGHT], map[WIDTH * HEIGHT], nearer[WIDTH * HEIGHT];
    uint8_t run[WIDTH * HEIGHT];
};

/* How far a pixel is outside of the disc, pixels. */
static double outside(int i)
{
    const int x = i % WIDTH - WIDTH / 2, y = i / WIDTH - HEIGHT / 2;

    return ((double)(x * x + y * y) - RADIUS * RADIUS) / (2.0 * RADIUS);
}

/* A dark disc, whose edge is a ramp of `soft` pixels in the photo and none in the map. */
static void draw(struct stage *s, double soft, int contrast)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double share = 0.5 - outside(i) / soft;
        const double in = share < 0 ? 0 : share > 1 ? 1 : share;

        for (int c = 0; c < 3; c++)
            s->rgb[3 * i + c] = (uint8_t)(200 - 10 * c - contrast * in);
        s->before[i] = s->map[i] = outside(i) < 0 ? NEAR : FAR;
    }
}

/* Planes of a photo of as many discs across and down. */
struct planes {
    int across, down;
    bool video;
    uint8_t *rgb, *run;
    uint16_t *map, *nearer;
};

static void claim(const struct planes *p, int threads)
{
    const int width = p->across * WIDTH;
    const struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, p->rgb, width,
                                                            p->down * HEIGHT, 3 * (ptrdiff_t)width);
    const struct rf_mixed_pixels mixed = {
        &photo, {p->map, width}, {p->nearer, width}, {p->run, width}, !p->video};
    struct rf_pool pool;
    struct rf_run state = {.looked_at = NULL};

    atomic_init(&state.state, RF_RUN_RUNNING);
    assert_int_equal(rf_pool_start(&pool, threads, NULL, &state), REFOCUS_OK);
    rf_claim_mixed_pixels(&mixed, &pool);
    rf_pool_end(&pool);
}

static void run(struct stage *s, int threads)
{
    const struct planes planes = {1, 1, false, s->rgb, s->run, s->map, s->nearer};

    claim(&planes, threads);
}

static void *allocate(size_t size)
{
    void *memory = malloc(size);

    assert_non_null(memory);
    return memory;
}

/* As run(), of a photo of `across` x `down` such discs; the map is that of one in the middle. */
static void run_many(struct stage *s, int across, int down, bool video)
{
    const size_t pixels = (size_t)across * WIDTH * (size_t)down * HEIGHT;
    const struct planes p = {.across = across,
                             .down = down,
                             .video = video,
                             .rgb = allocate(3 * pixels),
                             .run = allocate(pixels),
                             .map = allocate(pixels * sizeof *p.map),
                             .nearer = allocate(pixels * sizeof *p.nearer)};
    const size_t middle = ((size_t)(down / 2 * HEIGHT) * across + across / 2) * WIDTH;

    for (int i = 0; i < down * HEIGHT * across; i++) {
        const size_t from = (size_t)(i / across % HEIGHT) * WIDTH, to = (size_t)i * WIDTH;

        memcpy(p.rgb + 3 * to, s->rgb + 3 * from, 3 * (size_t)WIDTH);
        memcpy(p.map + to, s->map + from, WIDTH * sizeof *p.map);
    }
    claim(&p, 2);
    for (int y = 0; y < HEIGHT; y++)
        memcpy(s->map + y * WIDTH, p.map + middle + (size_t)y * across * WIDTH,
               WIDTH * sizeof *p.map);
    free(p.rgb);
    free(p.run);
    free(p.map);
    free(p.nearer);
}

static struct stage *make(void)
{
    return allocate(sizeof(struct stage));
}

/* Across a ramp of 6 pixels, those with 15 % and more of the disc are within 2.1 pixels of it. */
TEST(soft_photo)
{
    struct stage *s = make();
    int taken = 0;

    draw(s, 6, 120);
    run(s, 2);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        if (s->before[i] == NEAR || outside(i) > 3.2)
            assert_int_equal(s->map[i], s->before[i]);
        if (outside(i) >= 0 && outside(i) < 1)
            assert_int_equal(s->map[i], NEAR);
        taken += s->map[i] != s->before[i];
    }
    assert_in_range(taken, 2 * 3 * RADIUS, 3 * 7 * RADIUS);
    free(s);
}

/* Pixels that the nearer surface has got, of which none may be farther out than `most`. */
static int taken_within(const struct stage *s, double most)
{
    int taken = 0;

    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (s->map[i] != s->before[i]) {
            assert_int_equal(s->map[i], NEAR);
            assert_true(outside(i) < most);
            taken++;
        }
    return taken;
}

/* A small photo that is sharp stays as it is. In a large one a mixed pixel lies across its edges,
 * half of it beyond the map's at most, unless it is a frame of a video. */
TEST(sharp_photo)
{
    struct stage *s = make();

    draw(s, 1, 120);
    run(s, 1);
    assert_memory_equal(s->map, s->before, sizeof s->map);
    run_many(s, 3, 2, false);
    assert_memory_equal(s->map, s->before, sizeof s->map);
    run_many(s, 12, 9, false);
    assert_in_range(taken_within(s, 0.6), RADIUS, 2 * 4 * RADIUS);
    draw(s, 1, 120);
    run_many(s, 12, 9, true);
    assert_memory_equal(s->map, s->before, sizeof s->map);
    draw(s, 0.01, 120);
    run_many(s, 12, 9, false);
    assert_in_range(taken_within(s, 0.01), 0, 16); /* whose middle is on the edge */
    free(s);
}

/* Where the photo does not show the edge the map stays. */
TEST(unseen_edge)
{
    struct stage *s = make();

    draw(s, 6, 10);
    run(s, 1);
    assert_memory_equal(s->map, s->before, sizeof s->map);
    free(s);
}

/* Pixels that are taken where a ring around the disc, from `first` to `last` pixels away, holds
 * `part` of the disc's colour; or one within it, where these are negative. */
static int taken_beside_ring(double first, double last, double part)
{
    struct stage *s = make();
    int taken;

    draw(s, 1, 120);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (outside(i) > first && outside(i) < last)
            for (int c = 0; c < 3; c++)
                s->rgb[3 * i + c] = (uint8_t)(200 - 10 * c - 120 * part);
    run_many(s, 12, 9, false);
    taken = taken_within(s, 4);
    free(s);
    return taken;
}

/* Neither the far nor the near surface may have a pattern across a silhouette. */
TEST(patterns)
{
    const int plain = taken_beside_ring(0, 0, 0);

    assert_true(plain > RADIUS);
    assert_true(taken_beside_ring(2, 4, 0.05) > plain / 2);
    assert_true(taken_beside_ring(2, 4, 0.4) < plain / 2);   /* shares rise */
    assert_true(taken_beside_ring(0.6, 6, 0.2) < 2 * plain); /* shares do not end */
    assert_true(taken_beside_ring(-5, -2, 0.7) > plain / 2);
    assert_true(taken_beside_ring(-5, -2, 0.3) < plain / 2);
}

/* A line of one pixel, some pixels from what is taken, is not smoothed away. */
TEST(thin_surface)
{
    enum { COLUMN = WIDTH / 2 - RADIUS - 9 };
    struct stage *s = make();

    draw(s, 6, 120);
    for (int y = 0; y < HEIGHT; y++)
        s->before[y * WIDTH + COLUMN] = s->map[y * WIDTH + COLUMN] = NEAR;
    run(s, 2);
    for (int y = 0; y < HEIGHT; y++)
        assert_int_equal(s->map[y * WIDTH + COLUMN], NEAR);
    assert_true(taken_within(s, 3.2) > 2 * 3 * RADIUS);
    free(s);
}

/* Pixels at the disc that the nearer surface gets where the farther one, or the nearer, is `off`
 * nearer than at the edge from some pixels away from it on. */
static int taken_where(int off, bool far_side)
{
    enum { NEARER = 60000, FARTHER = 30000 };
    struct stage *s = make();
    int taken = 0;

    draw(s, 6, 120);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const bool near = outside(i) < 0;
        const bool away = near ? !far_side && outside(i) < -4 : far_side && outside(i) > 4;

        s->before[i] = s->map[i] = (uint16_t)((near ? NEARER : FARTHER) + (away ? off : 0));
    }
    run(s, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        taken += outside(i) < 3 && s->map[i] != s->before[i];
    free(s);
    return taken;
}

/* A surface goes on if it stays within half of what lies between the two. Where an edge lies
 * slantwise, no pixel that is looked at is away from it. */
TEST(surfaces_that_go_on)
{
    assert_true(taken_where(0, true) > 2 * 3 * RADIUS);
    assert_true(taken_where(-14999, true) > 2 * taken_where(-15000, true));
    assert_true(taken_where(14999, true) > 2 * taken_where(15000, true));
    assert_true(taken_where(-14999, false) > 2 * taken_where(-15000, false));
}

/* Pixels whose left and right neighbours are both of the other surface. */
static int teeth_of(const uint16_t *map)
{
    int teeth = 0;

    for (int y = 1; y < HEIGHT - 1; y++)
        for (int x = 1; x < WIDTH - 1; x++) {
            const uint16_t *at = map + y * WIDTH + x;

            teeth += at[-1] != at[0] && at[1] != at[0];
        }
    return teeth;
}

/* Every seventh column of the photo has a softer edge, so that more of it is taken. */
TEST(teeth)
{
    struct stage *softer = make(), *s = make();

    draw(softer, 9, 120);
    draw(s, 5, 120);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (i % WIDTH % 7 == 0)
            memcpy(s->rgb + 3 * i, softer->rgb + 3 * i, 3);
    run(s, 2);
    assert_true(teeth_of(s->nearer) > 10); /* before they are smoothed */
    assert_int_equal(teeth_of(s->map), 0);
    free(softer);
    free(s);
}

TEST(threads)
{
    struct stage *one = make(), *three = make();

    draw(one, 6, 120);
    draw(three, 6, 120);
    run(one, 1);
    run(three, 3);
    assert_memory_equal(one->map, three->map, sizeof one->map);
    free(one);
    free(three);
}
