/* test_threads.c: any number of threads renders equal pictures; another thread can cancel. */
#include <pthread.h>
#include <stdatomic.h>

#include "pictures.h"
#include "../clock.h"

TEST(same_bytes)
{
    static const int sizes[][2] = {{97, 61}, {16, 16}, {33, 130}, {1, 40}, {200, 3}};
    static const int threads[] = {2, 3, 8};

    for (int s = 0; s < 5; s++) {
        struct picture p = picture_make(sizes[s][0], sizes[s][1], 5u + (uint32_t)s);
        const size_t size = 3 * (size_t)p.width * (size_t)p.height;
        uint8_t *one = malloc(size * (size_t)style_count), *many = malloc(size);
        struct refocus_renderer *renderer = prepared(&p, 8, 1);

        assert_true(one && many);
        for (int i = 0; i < style_count; i++)
            render_style(renderer, &p, &styles[i], 0.4f, 8, one + size * (size_t)i);
        refocus_renderer_destroy(&renderer);
        for (int t = 0; t < 3; t++) {
            struct refocus_renderer_info info = refocus_renderer_info_default();

            if (left_out(s + t + 2, 3))
                continue;
            renderer = prepared(&p, 8, threads[t]);
            refocus_renderer_get_info(renderer, &info);
            assert_int_equal(info.threads, threads[t]);
            for (int i = style_count - 1; i >= 0; i--) {
                memset(many, 0xaa, size);
                render_style(renderer, &p, &styles[i], 0.4f, 8, many);
                assert_same_pixels(many, one + size * (size_t)i, p.width, p.height, styles[i].name);
            }
            refocus_renderer_destroy(&renderer);
        }
        free(one);
        free(many);
        picture_free(&p);
    }
}

/* A thread that cancels without end. */
struct canceller {
    struct refocus_renderer *renderer;
    atomic_int stop;
};

static void *cancel_all(void *user)
{
    struct canceller *canceller = user;

    while (!atomic_load(&canceller->stop)) {
        refocus_cancel(canceller->renderer);
        sleep_ms(1);
    }
    return NULL;
}

/* Full ray tracing of this picture takes many seconds; cancelled, almost none. */
TEST(cancel_render)
{
    struct picture p = picture_make(900, 700, 3);
    const struct style slow = {"slow",
                               REFOCUS_METHOD_RAYTRACE,
                               REFOCUS_RAYS_FULL,
                               1,
                               1,
                               0,
                               0,
                               REFOCUS_BLEND_LINEAR,
                               0,
                               0,
                               0,
                               0};
    struct refocus_settings params = style_params(&slow, 0.5f, 60);
    struct canceller canceller = {prepared(&p, 60, 3), 0};
    uint8_t *out = malloc(3 * 900 * 700), *before = malloc(3 * 900 * 700);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 900, 700, 3 * 900);
    pthread_t thread;

    assert_true(out && before);
    render_style(canceller.renderer, &p, &styles[0], 0.5f, 4, before);

    assert_int_equal(pthread_create(&thread, NULL, cancel_all, &canceller), 0);
    const double start = 1e-3 * now_ms();
    assert_int_equal(refocus_render_settings(canceller.renderer, &params, &image),
                     REFOCUS_ERR_CANCELLED);
    const double taken = 1e-3 * now_ms() - start;
    atomic_store(&canceller.stop, 1);
    pthread_join(thread, NULL);
    if (taken > 5)
        fail_msg("cancelling took %.1f s", taken);

    /* The photo is still prepared, and a cancel with nothing running does nothing. */
    refocus_cancel(canceller.renderer);
    render_style(canceller.renderer, &p, &styles[0], 0.5f, 4, out);
    assert_same_pixels(out, before, 900, 700, "after a cancelled render");
    refocus_renderer_destroy(&canceller.renderer);
    free(out);
    free(before);
    picture_free(&p);
}

/* A cancelled prepare leaves nothing prepared; one that is not succeeds. */
TEST(cancel_prepare)
{
    struct picture p = picture_make(700, 500, 3);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    struct canceller canceller = {prepared(&p, 4, 2), 0};
    uint8_t *out = malloc(3 * 700 * 500), *before = malloc(3 * 700 * 500);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 700, 500, 3 * 700);
    pthread_t thread;

    assert_true(out && before);
    render_style(canceller.renderer, &p, &styles[0], 0.5f, 2, before);
    assert_int_equal(pthread_create(&thread, NULL, cancel_all, &canceller), 0);
    for (int i = 0; i < 50; i++) {
        const int status = refocus_prepare(canceller.renderer, &photo, &disparity);
        const struct refocus_settings params = refocus_settings_default(0.5f, 0);
        const int after = refocus_render_settings(canceller.renderer, &params, &image);

        assert_true(status == REFOCUS_OK || status == REFOCUS_ERR_CANCELLED);
        if (status == REFOCUS_OK)
            assert_true(after == REFOCUS_OK || after == REFOCUS_ERR_CANCELLED);
        else
            assert_int_equal(after, REFOCUS_ERR_STATE);
    }
    atomic_store(&canceller.stop, 1);
    pthread_join(thread, NULL);
    assert_int_equal(refocus_prepare(canceller.renderer, &photo, &disparity), REFOCUS_OK);
    render_style(canceller.renderer, &p, &styles[0], 0.5f, 2, out);
    assert_same_pixels(out, before, 700, 500, "after cancelled prepares");
    refocus_renderer_destroy(&canceller.renderer);
    free(out);
    free(before);
    picture_free(&p);
}

/* Two renderers in two threads do not know of each other. */
struct pair {
    struct picture picture;
    uint8_t *out;
};

static void *render_many(void *user)
{
    struct pair *pair = user;
    struct refocus_renderer *renderer = prepared(&pair->picture, 6, 2);

    for (int i = 0; i < 5; i++)
        render_style(renderer, &pair->picture, &styles[i % 3], 0.7f, 6, pair->out);
    refocus_renderer_destroy(&renderer);
    return NULL;
}

TEST(two_renderers)
{
    struct pair pair[2];
    pthread_t thread;
    uint8_t expected[3 * 80 * 60];

    for (int i = 0; i < 2; i++) {
        pair[i].picture = picture_make(80, 60, 40u + (uint32_t)i);
        pair[i].out = malloc(3 * 80 * 60);
        assert_non_null(pair[i].out);
    }
    assert_int_equal(pthread_create(&thread, NULL, render_many, &pair[1]), 0);
    render_many(&pair[0]);
    pthread_join(thread, NULL);
    for (int i = 0; i < 2; i++) {
        struct refocus_renderer *renderer = prepared(&pair[i].picture, 6, 1);

        render_style(renderer, &pair[i].picture, &styles[4 % 3], 0.7f, 6, expected);
        assert_same_pixels(pair[i].out, expected, 80, 60, "two renderers at once");
        refocus_renderer_destroy(&renderer);
        free(pair[i].out);
        picture_free(&pair[i].picture);
    }
}

/* Two threads in one renderer: each call does all of its work, or is refused and does nothing. */
struct rival {
    struct refocus_renderer *renderer;
    const uint8_t *expected;
    int done, refused;
};

static void *render_rivalling(void *user)
{
    struct rival *rival = user;
    const struct refocus_render_params params = refocus_render_params_default(0.7f, 6);
    uint8_t out[3 * 80 * 60];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 80, 60, 240);

    while (rival->done < 20) {
        int status;

        memset(out, 0x33, sizeof out);
        status = refocus_render(rival->renderer, &params, &image);
        if (status == REFOCUS_OK) {
            assert_same_pixels(out, rival->expected, 80, 60, "one of two threads");
            rival->done++;
            continue;
        }
        assert_int_equal(status, REFOCUS_ERR_BUSY);
        for (size_t i = 0; i < sizeof out; i++)
            assert_int_equal(out[i], 0x33);
        rival->refused++;
        sleep_ms(1);
    }
    return NULL;
}

TEST(one_renderer)
{
    struct picture p = picture_make(80, 60, 44);
    struct refocus_renderer *renderer = prepared(&p, 6, 2);
    const struct refocus_render_params params = refocus_render_params_default(0.7f, 6);
    static uint8_t expected[3 * 80 * 60];
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, expected, 80, 60, 240);
    struct rival rival[2] = {{renderer, expected, 0, 0}, {renderer, expected, 0, 0}};
    pthread_t thread;

    assert_int_equal(refocus_render(renderer, &params, &image), REFOCUS_OK);
    assert_int_equal(pthread_create(&thread, NULL, render_rivalling, &rival[1]), 0);
    render_rivalling(&rival[0]);
    pthread_join(thread, NULL);
    print_message("%d calls were refused\n", rival[0].refused + rival[1].refused);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
