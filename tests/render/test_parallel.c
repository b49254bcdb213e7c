/* test_parallel.c: the caller's parallel_for: whatever it does with the items, the same bytes. */
#include <pthread.h>

#include "pictures.h"

enum { WIDTH = 97, HEIGHT = 83, MOST = 8 };

struct caller {
    int most; /* items asked for at once, ever */
    int calls;
    int inside; /* loops that run: never more than one */
};

static void enter(struct caller *caller, int32_t count)
{
    assert_int_equal(caller->inside++, 0);
    assert_true(count >= 1);
    caller->calls++;
    caller->most = count > caller->most ? count : caller->most;
}

static void serial(void *user, void (*work)(void *context, int32_t item), void *context,
                   int32_t count)
{
    enter(user, count);
    for (int32_t i = 0; i < count; i++)
        work(context, i);
    ((struct caller *)user)->inside--;
}

static void backwards(void *user, void (*work)(void *context, int32_t item), void *context,
                      int32_t count)
{
    enter(user, count);
    for (int32_t i = count - 1; i >= 0; i--)
        work(context, i);
    ((struct caller *)user)->inside--;
}

struct item {
    void (*work)(void *context, int32_t item);
    void *context;
    int32_t number;
};

static void *run_item(void *user)
{
    const struct item *item = user;

    item->work(item->context, item->number);
    return NULL;
}

/* A thread an item, as they come. */
static void threaded(void *user, void (*work)(void *context, int32_t item), void *context,
                     int32_t count)
{
    struct item item[MOST];
    pthread_t thread[MOST];

    enter(user, count);
    assert_true(count <= MOST);
    for (int32_t i = 0; i < count; i++) {
        item[i] = (struct item){work, context, i};
        assert_int_equal(pthread_create(&thread[i], NULL, run_item, &item[i]), 0);
    }
    for (int32_t i = 0; i < count; i++)
        pthread_join(thread[i], NULL);
    ((struct caller *)user)->inside--;
}

TEST(same_bytes)
{
    static const struct {
        const char *name;
        void (*loop)(void *user, void (*work)(void *context, int32_t item), void *context,
                     int32_t count);
        int threads;
    } callers[] = {{"serial", serial, 4},
                   {"backwards", backwards, 5},
                   {"threads", threaded, 3},
                   {"threads", threaded, MOST},
                   {"one", serial, 1}};
    struct picture p = picture_make(WIDTH, HEIGHT, 11);
    const struct refocus_image photo = picture_image(&p);
    uint8_t small[6] = {0, 50, 100, 150, 200, 250};
    const struct refocus_disparity coarse = refocus_disparity8(small, 3, 2, 3);
    const size_t size = 3 * WIDTH * HEIGHT;
    uint8_t *expected = malloc(size * (size_t)style_count), *out = malloc(size);
    struct refocus_renderer *renderer = prepared(&p, 8, 1);

    assert_true(expected && out);
    assert_int_equal(refocus_prepare(renderer, &photo, &coarse), REFOCUS_OK);
    for (int i = 0; i < style_count; i++)
        render_style(renderer, &p, &styles[i], 0.4f, 8, expected + size * (size_t)i);
    refocus_renderer_destroy(&renderer);

    for (size_t c = 0; c < sizeof callers / sizeof callers[0]; c++) {
        struct caller caller = {0, 0, 0};
        struct refocus_renderer_params limits = refocus_renderer_params_default(WIDTH, HEIGHT, 8);
        struct refocus_renderer_info info = refocus_renderer_info_default();
        int rendered = 0;

        limits.threads = callers[c].threads;
        limits.papers = refocus_papers();
        limits.methods = REFOCUS_METHODS_ALL;
        limits.parallel.parallel_for = callers[c].loop;
        limits.parallel.user = &caller;
        assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
        refocus_renderer_get_info(renderer, &info);
        assert_int_equal(info.threads, callers[c].threads);
        assert_int_equal(refocus_prepare(renderer, &photo, &coarse), REFOCUS_OK);
        for (int i = 0; i < style_count; i++) {
            if (left_out(i + (int)c, 3))
                continue;
            memset(out, 0x55, size);
            render_style(renderer, &p, &styles[i], 0.4f, 8, out);
            assert_same_pixels(out, expected + size * (size_t)i, WIDTH, HEIGHT, callers[c].name);
            rendered++;
        }
        refocus_renderer_destroy(&renderer);
        assert_int_equal(caller.inside, 0);
        if (callers[c].threads > 1)
            assert_true(caller.calls > rendered && caller.most == callers[c].threads);
    }
    free(expected);
    free(out);
    picture_free(&p);
}

/* Cancelled from within a loop: it ends, and the next picture is as it should be. */
struct breaker {
    struct refocus_renderer *renderer;
    int left; /* loops until it cancels */
};

static void cancelling(void *user, void (*work)(void *context, int32_t item), void *context,
                       int32_t count)
{
    struct breaker *breaker = user;

    if (breaker->left-- == 0)
        refocus_cancel(breaker->renderer);
    for (int32_t i = 0; i < count; i++)
        work(context, i);
}

TEST(cancel_within)
{
    struct picture p = picture_make(WIDTH, HEIGHT, 12);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    const struct refocus_settings params = refocus_settings_default(0.4f, 8);
    struct refocus_renderer_params limits = refocus_renderer_params_default(WIDTH, HEIGHT, 8);
    struct breaker breaker = {NULL, -1};
    uint8_t *expected = malloc(3 * WIDTH * HEIGHT), *out = malloc(3 * WIDTH * HEIGHT);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, WIDTH, HEIGHT, 3 * WIDTH);
    int cancelled = 0, status = REFOCUS_ERR_CANCELLED;

    assert_true(expected && out);
    limits.threads = 2;
    limits.parallel.parallel_for = cancelling;
    limits.parallel.user = &breaker;
    assert_int_equal(refocus_renderer_create(&breaker.renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(breaker.renderer, &photo, &disparity), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(breaker.renderer, &params, &image), REFOCUS_OK);
    memcpy(expected, out, 3 * WIDTH * HEIGHT);
    for (int loop = 0; status != REFOCUS_OK; loop++) {
        assert_int_equal(refocus_prepare(breaker.renderer, &photo, &disparity), REFOCUS_OK);
        breaker.left = loop;
        status = refocus_render_settings(breaker.renderer, &params, &image);
        cancelled += status == REFOCUS_ERR_CANCELLED;
        breaker.left = -1;
        assert_int_equal(refocus_render_settings(breaker.renderer, &params, &image), REFOCUS_OK);
        assert_same_pixels(out, expected, WIDTH, HEIGHT, "after a cancelled loop");
    }
    assert_true(cancelled > 3);
    refocus_renderer_destroy(&breaker.renderer);
    free(expected);
    free(out);
    picture_free(&p);
}

/* Calls into the renderer from within its loop, from the thread that is in it and from another. */
struct intruder {
    struct refocus_renderer *renderer;
    struct refocus_image photo;
    struct refocus_disparity disparity;
    int refused; /* loops in which all calls were */
};

static void *intrude(void *user)
{
    struct intruder *in = user;
    const struct refocus_scene scene = refocus_scene_default(&in->photo, &in->disparity);
    const struct refocus_render_params params = refocus_render_params_default(0.4f, 8);
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();
    struct refocus_renderer_info info = refocus_renderer_info_default();
    uint8_t pixel[3] = {1, 2, 3};
    const struct refocus_image out = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixel, 1, 1, 3);
    uint16_t view;

    assert_int_equal(refocus_prepare(in->renderer, &in->photo, &in->disparity), REFOCUS_ERR_BUSY);
    assert_int_equal(refocus_prepare_scene(in->renderer, &scene), REFOCUS_ERR_BUSY);
    assert_int_equal(refocus_render(in->renderer, &params, &out), REFOCUS_ERR_BUSY);
    assert_int_equal(refocus_get_view(in->renderer, REFOCUS_VIEW_DISPARITY, &view, 2),
                     REFOCUS_ERR_BUSY);
    assert_int_equal(refocus_get_depth_edges(in->renderer, &report), REFOCUS_ERR_BUSY);
    refocus_renderer_get_info(in->renderer, &info);
    assert_int_equal(info.threads, 2);
    assert_true(pixel[0] == 1 && pixel[1] == 2 && pixel[2] == 3);
    return NULL;
}

static void intruding(void *user, void (*work)(void *context, int32_t item), void *context,
                      int32_t count)
{
    struct intruder *in = user;
    pthread_t thread;

    intrude(in);
    assert_int_equal(pthread_create(&thread, NULL, intrude, in), 0);
    for (int32_t i = 0; i < count; i++)
        work(context, i);
    pthread_join(thread, NULL);
    in->refused++;
}

TEST(second_call)
{
    struct picture p = picture_make(WIDTH, HEIGHT, 13);
    struct intruder in = {NULL, picture_image(&p), picture_disparity(&p), 0};
    struct refocus_renderer_params limits = refocus_renderer_params_default(WIDTH, HEIGHT, 8);
    struct refocus_renderer *alone = prepared(&p, 8, 1);
    static uint8_t expected[3 * WIDTH * HEIGHT], out[3 * WIDTH * HEIGHT];
    static uint16_t view[WIDTH * HEIGHT];

    render_style(alone, &p, &styles[0], 0.4f, 8, expected);
    limits.threads = 2;
    limits.parallel.parallel_for = intruding;
    limits.parallel.user = &in;
    assert_int_equal(refocus_renderer_create(&in.renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(in.renderer, &in.photo, &in.disparity), REFOCUS_OK);
    render_style(in.renderer, &p, &styles[0], 0.4f, 8, out);
    assert_same_pixels(out, expected, WIDTH, HEIGHT, "with calls that were refused");
    assert_true(in.refused > 3);
    assert_int_equal(refocus_get_view(in.renderer, REFOCUS_VIEW_DISPARITY, view, 2 * WIDTH),
                     REFOCUS_OK);
    refocus_renderer_destroy(&in.renderer);
    refocus_renderer_destroy(&alone);
    picture_free(&p);
}
