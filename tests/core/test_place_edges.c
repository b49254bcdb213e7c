/* test_place_edges.c: edges of disparity maps in memory and with threads of the caller. */
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "unit_test.h"
#include <refocus/refocus.h>

#include "depth/upsample.h"
#include "edges/place.h"
#include "support/arena.h"

enum { WIDTH = 120, HEIGHT = 90, GUARD = 256, LOOKS = 2000 };

/* Everything that is passed to rf_place_edges(). */
struct stage {
    struct rf_kernels kernels;
    struct rf_pool pool;
    struct rf_run run;
    struct refocus_image photo;
    struct refocus_disparity map;
    uint8_t *memory; /* GUARD bytes behind `bytes` of them */
    uint64_t bytes;
    uint8_t *shares; /* for the workers */
    uint16_t *out;
    int looks, last;     /* at the last look the run is cancelled; 0: never */
    clock_t at, longest; /* when it was, and the longest way to one */
};

static void look(void *user)
{
    struct stage *s = user;
    const clock_t now = clock();

    s->longest = now - s->at > s->longest ? now - s->at : s->longest;
    s->at = now;
    if (++s->looks == s->last)
        atomic_store(&s->run.state, RF_RUN_CANCELLED);
}

/* A soft disc that lies four pixels beside that of the photo. */
static void draw(struct stage *s, int width, int height, int columns, int rows)
{
    uint8_t *rgb = malloc((size_t)width * (size_t)height * 3);
    uint16_t *map = malloc((size_t)columns * (size_t)rows * sizeof *map);

    assert_true(rgb && map);
    for (int i = 0; i < width * height; i++) {
        const int x = i % width * WIDTH / width - 60, y = i / width * HEIGHT / height - 45;

        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = (uint8_t)((x * x + y * y < 900 ? 190 : 70) + i * 31 % (17 + c));
    }
    for (int i = 0; i < columns * rows; i++) {
        const int x = i % columns * WIDTH / columns - 64, y = i / columns * HEIGHT / rows - 45;
        const int off = (x * x + y * y - 900) / 8;

        map[i] = (uint16_t)(30000 - 20000 * (off < -30 ? -30 : off > 30 ? 30 : off) / 30);
    }
    s->photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, width, height, 3 * (ptrdiff_t)width);
    s->map = refocus_disparity16(map, columns, rows, 2 * (ptrdiff_t)columns);
    s->out = malloc((size_t)width * (size_t)height * sizeof *s->out);
    assert_non_null(s->out);
}

static void start(struct stage *s, int threads)
{
    uint32_t cpu = REFOCUS_CPU_AUTO;

    assert_true(rf_kernels_select(&s->kernels, &cpu));
    s->run.looked_at = s->last ? look : NULL;
    s->run.user = s;
    atomic_init(&s->run.state, RF_RUN_RUNNING);
    assert_int_equal(rf_pool_start(&s->pool, threads, NULL, &s->run), REFOCUS_OK);
    s->memory = aligned_alloc(RF_ARENA_ALIGN, (size_t)s->bytes + GUARD);
    s->shares = malloc((size_t)rf_upsample_share() * (size_t)threads);
    assert_non_null(s->memory);
    assert_non_null(s->shares);
    memset(s->memory, 0xa5, (size_t)s->bytes + GUARD);
}

static bool place(struct stage *s)
{
    const struct rf_place_edges place = {.kernels = &s->kernels,
                                         .pool = &s->pool,
                                         .photo = &s->photo,
                                         .map = &s->map,
                                         .memory = s->memory,
                                         .shares = {s->shares, rf_upsample_share()},
                                         .out = {s->out, s->photo.width}};
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();

    return rf_place_edges(&place, &report);
}

static void end(struct stage *s)
{
    for (int i = 0; i < GUARD; i++)
        assert_int_equal(s->memory[s->bytes + (uint64_t)i], 0xa5);
    rf_pool_end(&s->pool);
    free(s->memory);
    free(s->shares);
    free(s->photo.plane[0]);
    free((void *)(uintptr_t)s->map.samples);
    free(s->out);
}

/* Memory for the largest photo with any map is enough for all that are smaller, and the result is
 * that of refocus_depth_edges(). */
TEST(memory_for_all)
{
    static const int sizes[][4] = {{WIDTH, HEIGHT, WIDTH, HEIGHT},
                                   {WIDTH, HEIGHT, 30, 20},
                                   {WIDTH, HEIGHT, 500, 300},
                                   {WIDTH, HEIGHT, 12, 9},
                                   {33, HEIGHT, 33, HEIGHT},
                                   {WIDTH, 5, WIDTH, 4},
                                   {1, 1, 9, 9},
                                   {WIDTH, HEIGHT, 119, 200},
                                   {70, 80, 1, 1}};
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();

    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const int *size = sizes[i];
        struct stage s = {.bytes = rf_place_edges_bytes(WIDTH, HEIGHT, WIDTH + 1, HEIGHT + 1)};
        const size_t bytes = (size_t)size[0] * (size_t)size[1] * 2;
        uint16_t *out = malloc(bytes);

        assert_non_null(out);
        assert_true(rf_place_edges_bytes(size[0], size[1], size[2], size[3]) <= s.bytes);
        draw(&s, size[0], size[1], size[2], size[3]);
        start(&s, 2);
        assert_int_equal(
            refocus_depth_edges(&s.photo, &s.map, &params, out, 2 * (ptrdiff_t)size[0], NULL),
            REFOCUS_OK);
        memcpy(s.out, s.map.samples, size[0] == size[2] && size[1] == size[3] ? bytes : 0);
        place(&s);
        assert_memory_equal(s.out, out, bytes);
        free(out);
        end(&s);
    }
    assert_true(rf_place_edges_bytes(65535, 65535, 65535, 65535) < UINT64_MAX);
}

/* Wherever the run is cancelled, it ends. */
TEST(cancelled)
{
    static const int columns[] = {WIDTH, WIDTH / 4};
    int ended = 0;

    for (int i = 0; i < 2 * LOOKS; i += 7) {
        struct stage s = {.last = 1 + i / 2,
                          .bytes = rf_place_edges_bytes(WIDTH, HEIGHT, WIDTH + 1, HEIGHT + 1)};

        draw(&s, WIDTH, HEIGHT, columns[i % 2], HEIGHT);
        start(&s, 1);
        place(&s);
        ended += s.looks >= s.last;
        end(&s);
    }
    assert_true(ended > LOOKS / 10);
}

/* Whoever cancels waits for the next look: none takes long, of all that is done. The best of a few
 * is taken, as others are busy, too. */
TEST(looks_often)
{
    enum { W = 2000, H = 1500, TIMES = 5, PARTS = 25 };
    double worst = 1;

    for (int i = 0; i < TIMES && worst * PARTS > 1; i++) {
        struct stage s = {.last = INT_MAX, .bytes = rf_place_edges_bytes(W, H, W + 1, H + 1)};
        clock_t began;

        draw(&s, W, H, W, H);
        start(&s, 1);
        began = s.at = clock();
        place(&s);
        worst = fmin(worst, (double)s.longest / (double)(clock() - began));
        end(&s);
    }
    print_message("the longest way to a look is 1/%.0f of all\n", 1 / worst);
    assert_true(worst * PARTS <= 1);
}
