/* test_session.c: the viewer's session: first a quick picture, then the full one, and nobody
 * waits. */
#define _POSIX_C_SOURCE 200809L
#include "unit_test.h"
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include "session.h"
#include "../../clock.h"

enum { W = 1200, H = 900, PIXELS = W * H }; /* large enough to be shown reduced first */

static uint8_t *pixels;
static uint16_t *depth;
static struct refocus_image photo;
static struct rf_session_setup setup;

/* The things that the session's thread did. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t came = PTHREAD_COND_INITIALIZER;
static int frames;
static uint32_t saved_what;
static int saved_width, saved_rays;
static uint16_t saved_depth;
static uint32_t saved_format;

static void on_frame(void *user)
{
    assert_ptr_equal(user, &setup);
    pthread_mutex_lock(&lock);
    frames++;
    pthread_cond_signal(&came);
    pthread_mutex_unlock(&lock);
}

static void on_save(void *user, const struct rf_view_result *result, char words[RF_VIEW_WORDS])
{
    assert_ptr_equal(user, &setup);
    pthread_mutex_lock(&lock);
    saved_what |= result->what;
    saved_width = result->picture->width;
    saved_format = result->picture->format;
    saved_rays = result->params->render.rays;
    saved_depth = result->disparity[H / 2 * W + W / 2];
    strcpy(words, "saved");
    pthread_cond_signal(&came);
    pthread_mutex_unlock(&lock);
}

static int slow(void)
{
    const char *const factor = getenv("REFOCUS_SLOW");

    return factor ? atoi(factor) : 1;
}

/* Two surfaces, and a pattern that blur changes. */
static void make_scene(void)
{
    pixels = malloc(3 * (size_t)PIXELS);
    depth = malloc(2 * (size_t)PIXELS);
    assert_non_null(pixels);
    assert_non_null(depth);
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;

        depth[i] = x > W / 3 && x < 2 * W / 3 ? 50000 : 9000;
        for (int c = 0; c < 3; c++)
            pixels[3 * i + c] = (uint8_t)((x / 7 * 31 + y / 5 * 57 + c * 40) & 255);
    }
    photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
    setup.photo = &photo;
    setup.disparity = depth;
    setup.params = refocus_settings_default(0, 0);
    setup.threads = 2;
    setup.notify = on_frame;
    setup.save = on_save;
    setup.notify_user = setup.save_user = &setup;
}

static struct rf_view_state whole(float focus, float blur)
{
    struct rf_view_state state;

    memset(&state, 0, sizeof state);
    state.focus = focus;
    state.blur = blur;
    state.scale = 1;
    state.width = W;
    state.height = H;
    return state;
}

static struct rf_session *begin(void)
{
    struct rf_session *session;

    assert_int_equal(rf_session_create(&session, &setup), REFOCUS_OK);
    return session;
}

/* Wait for a frame of that request or a newer one; full: for the full one. */
static const struct rf_view_frame *wait_for(struct rf_session *session, uint64_t request, bool full)
{
    const double end = now_ms() + 60000.0 * slow();
    const struct rf_view_frame *frame = NULL;

    while (now_ms() < end) {
        rf_session_tick(session);
        if (rf_session_frame(session, &frame) && frame->request >= request &&
            (frame->full || !full))
            return frame;
        assert_int_equal(rf_session_status(session), REFOCUS_OK);
        sleep_ms(1);
    }
    fail_msg("%s", "no frame came");
    return NULL;
}

static void expect_render_of(const struct refocus_image *picture, const struct rf_view_frame *frame,
                             uint32_t method, float focus, float blur)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 127);
    struct refocus_settings lens = refocus_settings_default(focus, blur);
    struct refocus_disparity map = refocus_disparity16(depth, W, H, 2 * W);
    struct refocus_scene scene = refocus_scene_default(picture, &map);
    struct refocus_image out = photo;
    struct refocus_renderer *renderer;
    int wrong = 0;

    limits.thin = 1;
    limits.deep = picture != &photo;
    scene.matte = setup.matte;
    lens.render.method = method;
    out.plane[0] = malloc(3 * (size_t)PIXELS);
    assert_non_null(out.plane[0]);
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    if (picture != &photo && setup.to_tones) {
        struct refocus_image light =
            refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, malloc(6 * (size_t)PIXELS), W, H, 6 * W);

        assert_non_null(light.plane[0]);
        assert_int_equal(refocus_render_settings(renderer, &lens, &light), REFOCUS_OK);
        setup.to_tones(&setup, &light, &lens, &out);
        free(light.plane[0]);
    } else {
        assert_int_equal(refocus_render_settings(renderer, &lens, &out), REFOCUS_OK);
    }
    for (int i = 0; i < PIXELS; i++) {
        const uint8_t *const p = out.plane[0] + 3 * i;

        wrong +=
            frame->pixels[i] != (0xff000000u | (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2]);
    }
    assert_int_equal(wrong, 0);
    refocus_renderer_destroy(&renderer);
    free(out.plane[0]);
}

static void expect_render(const struct rf_view_frame *frame, uint32_t method, float focus,
                          float blur)
{
    expect_render_of(&photo, frame, method, focus, blur);
}

TEST(test_full_is_render)
{
    struct rf_session *session = begin();
    struct rf_view_state state = whole(0.2f, 9);
    const struct rf_view_frame *frame;

    assert_true(rf_session_reduction(session) > 1);
    frame = wait_for(session, rf_session_show(session, &state), true);
    expect_render(frame, REFOCUS_METHOD_SWEEP, 0.2f, 9);
    state.focus_tap = 1;
    state.tap_x = W / 2.0;
    state.tap_y = 11;
    frame = wait_for(session, rf_session_show(session, &state), true);
    assert_true(frame->of.focus > 0.7629f && frame->of.focus < 0.763f); /* 50000 / 65535 */
    expect_render(frame, REFOCUS_METHOD_SWEEP, frame->of.focus, 9);
    state.tap_x = W / 3.0 + 1; /* at an edge the nearer one counts */
    state.focus_tap = 2;
    frame = wait_for(session, rf_session_show(session, &state), false);
    assert_true(frame->of.focus > 0.76f);
    rf_session_destroy(&session);
}

/* Raytracing all of it takes many seconds: no call waits for that, nor does what
 * follows. */
TEST(test_nobody_waits)
{
    struct rf_session *session = begin();
    struct rf_view_state state = whole(0.2f, 30);
    const struct rf_view_frame *frame;
    double start, longest = 0;
    uint64_t request;

    frame = wait_for(session, rf_session_show(session, &state), true);
    state.method = REFOCUS_METHOD_RAYTRACE;
    setup.params.render.rays = 64;
    for (int i = 0; i < 20; i++) {

        state.focus = (float)i / 20;
        start = now_ms();
        request = rf_session_show(session, &state);
        if (now_ms() - start > longest)
            longest = now_ms() - start;
        sleep_ms(20);
    }
    assert_true(longest < 200.0 * slow());
    state.method = REFOCUS_METHOD_SWEEP;
    state.blur = 5;
    request = rf_session_show(session, &state);
    frame = wait_for(session, request, true);
    assert_int_equal(frame->request, request);
    expect_render(frame, REFOCUS_METHOD_SWEEP, state.focus, 5);
    state.method = REFOCUS_METHOD_RAYTRACE;
    rf_session_show(session, &state);
    start = now_ms();
    rf_session_destroy(&session);
    assert_true(now_ms() - start < 5000.0 * slow());
}

/* While something is held no full picture is begun. */
TEST(test_hold)
{
    struct rf_session *session = begin();
    struct rf_view_state state = whole(0.2f, 9);
    const struct rf_view_frame *frame;
    uint64_t request;

    wait_for(session, rf_session_show(session, &state), true);
    state.hold = true;
    for (int i = 0; i < 5; i++) {
        state.blur = 10.0f + (float)i;
        request = rf_session_show(session, &state);
        frame = wait_for(session, request, false);
        assert_false(frame->full);
        sleep_ms(100);
        assert_false(rf_session_frame(session, &frame));
    }
    state.hold = false;
    request = rf_session_show(session, &state);
    expect_render(wait_for(session, request, true), REFOCUS_METHOD_SWEEP, 0.2f, 14);
    rf_session_destroy(&session);
}

TEST(test_modes)
{
    struct rf_session *session = begin();
    struct rf_view_state state = whole(0.2f, 9);
    const struct rf_view_frame *frame;
    int wrong = 0;

    state.mode = RF_VIEW_BEFORE;
    frame = wait_for(session, rf_session_show(session, &state), true);
    for (int i = 0; i < PIXELS; i++)
        wrong += frame->pixels[i] != (0xff000000u | (uint32_t)pixels[3 * i] << 16 |
                                      (uint32_t)pixels[3 * i + 1] << 8 | pixels[3 * i + 2]);
    assert_int_equal(wrong, 0);
    state.mode = RF_VIEW_DEPTH;
    state.x = W / 2.0; /* moved: right of it there is nothing */
    state.width = W - 200;
    frame = wait_for(session, rf_session_show(session, &state), true);
    assert_int_equal(frame->of.width, W - 200);
    assert_int_equal(frame->pixels[0], 0xff000000u + (50000 >> 8) * 0x010101u);
    assert_int_equal(frame->pixels[W / 2 - 1], 0xff000000u + (9000 >> 8) * 0x010101u);
    assert_int_equal(frame->pixels[W / 2], 0xff202020u);
    state.width = 16384; /* many windows for a pixel of the photo */
    state.height = 3;
    state.scale = 15.9;
    frame = wait_for(session, rf_session_show(session, &state), true);
    assert_int_equal(frame->pixels[0], 0xff000000u + (50000 >> 8) * 0x010101u);
    state.scale = 1.0 / 64;
    state.mode = RF_VIEW_RESULT;
    state.peaking = true;
    frame = wait_for(session, rf_session_show(session, &state), true);
    assert_int_equal(frame->pixels[16383], 0xff202020u);
    rf_session_destroy(&session);
}

static void wait_for_saved(uint32_t what)
{
    pthread_mutex_lock(&lock);
    while (saved_what != what)
        pthread_cond_wait(&came, &lock);
    pthread_mutex_unlock(&lock);
}

TEST(test_saving)
{
    struct rf_session *session = begin();
    struct rf_view_state state = whole(0.2f, 3);
    char words[RF_VIEW_WORDS] = "";

    wait_for(session, rf_session_show(session, &state), true);
    assert_false(rf_session_words(session, words));
    saved_what = 0;
    rf_session_save(session, RF_SAVE_DEPTH);
    rf_session_save(session, RF_SAVE_PICTURE | RF_SAVE_SETTINGS);
    wait_for_saved(RF_SAVE_PICTURE | RF_SAVE_SETTINGS | RF_SAVE_DEPTH);
    assert_int_equal(saved_depth, 50000);
    assert_int_equal(saved_width, W);
    while (!rf_session_words(session, words))
        rf_session_tick(session);
    assert_string_equal(words, "saved");
    rf_session_destroy(&session);
    rf_session_destroy(&session);
}

/* Where rays go by the blur, the sweep has them in what is saved, and not in what is shown. */
TEST(test_still_rays)
{
    static const struct {
        float blur;
        uint32_t method;
        int rays;
    } saved[] = {{30, REFOCUS_METHOD_SWEEP, 144},
                 {20, REFOCUS_METHOD_SWEEP, 64},
                 {30, REFOCUS_METHOD_SEARCH, 64}};
    struct rf_view_state state = whole(0.2f, 0);
    struct rf_session *session;

    setup.still_rays = true;
    session = begin();
    for (size_t i = 0; i < sizeof saved / sizeof *saved; i++) {
        state.blur = saved[i].blur;
        state.method = saved[i].method;
        expect_render(wait_for(session, rf_session_show(session, &state), true), state.method, 0.2f,
                      state.blur);
        saved_what = 0;
        rf_session_save(session, RF_SAVE_PICTURE);
        wait_for_saved(RF_SAVE_PICTURE);
        assert_int_equal(saved_rays, saved[i].rays);
    }
    rf_session_destroy(&session);
    setup.still_rays = false;
}

/* A matte, of a size of its own, is part of the scene. */
TEST(test_matte)
{
    static const uint8_t samples[6] = {0, 0, 255, 255, 0, 0};
    const struct refocus_disparity matte = refocus_disparity8(samples, 6, 1, 6);
    struct rf_view_state view = whole(0.1f, 9);
    struct rf_session *session;

    setup.matte = &matte;
    session = begin();
    expect_render(wait_for(session, rf_session_show(session, &view), true), 0, 0.1f, 9);
    rf_session_destroy(&session);
    setup.matte = NULL;
}

/* Sweep renders all that the photo holds, other methods its 8 bits. */
static bool is_swept(void *user, struct refocus_settings *params)
{
    assert_ptr_equal(user, &setup);
    return params->render.method == REFOCUS_METHOD_SWEEP;
}

/* Tones that nothing else makes: the two bytes of red's half are red and green. */
static int red_tones(void *user, const struct refocus_image *light,
                     const struct refocus_settings *params, const struct refocus_image *out)
{
    assert_ptr_equal(user, &setup);
    assert_int_equal(light->format, REFOCUS_FORMAT_RGB_HALF);
    assert_int_equal(params->render.method, REFOCUS_METHOD_SWEEP);
    memset(out->plane[0], 0, 3 * (size_t)PIXELS);
    for (int i = 0; i < PIXELS; i++)
        memcpy(out->plane[0] + 3 * (size_t)i, light->plane[0] + 6 * (size_t)i, 2);
    return REFOCUS_OK;
}

/* Full pictures are of the deep photo, by methods that take it; a change of method changes what is
 * prepared, both ways. So are pictures that are saved, as deep as they are asked for. What is light
 * goes through the tones of the photo. */
TEST(test_deep_photos)
{
    static const uint32_t methods[] = {REFOCUS_METHOD_SWEEP, REFOCUS_METHOD_SEARCH,
                                       REFOCUS_METHOD_SWEEP};
    uint16_t *const samples = malloc(6 * (size_t)PIXELS);
    const struct refocus_image deep =
        refocus_image_packed(REFOCUS_FORMAT_RGB16, samples, W, H, 6 * W);
    struct rf_view_state state = whole(0.2f, 9);
    struct rf_session *session;

    assert_non_null(samples);
    for (int i = 0; i < 3 * PIXELS; i++)
        samples[i] = (uint16_t)(pixels[i] * 129); /* a half as bright as the 8 bits say */
    setup.deep = &deep;
    setup.takes_deep = is_swept;
    setup.deep_user = &setup;
    session = begin();
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        state.method = methods[i];
        expect_render_of(methods[i] == REFOCUS_METHOD_SWEEP ? &deep : &photo,
                         wait_for(session, rf_session_show(session, &state), true), methods[i],
                         0.2f, 9);
    }
    rf_session_destroy(&session);
    setup.saved.format = REFOCUS_FORMAT_RGB16;
    session = begin();
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        state.method = methods[i];
        wait_for(session, rf_session_show(session, &state), true);
        saved_what = 0;
        rf_session_save(session, RF_SAVE_PICTURE);
        wait_for_saved(RF_SAVE_PICTURE);
        assert_int_equal(saved_format, methods[i] == REFOCUS_METHOD_SWEEP ? REFOCUS_FORMAT_RGB16
                                                                          : REFOCUS_FORMAT_RGB8);
    }
    rf_session_destroy(&session);
    setup.saved.format = REFOCUS_FORMAT_NONE;
    setup.to_tones = red_tones;
    session = begin();
    expect_render_of(&deep, wait_for(session, rf_session_show(session, &state), true),
                     REFOCUS_METHOD_SWEEP, 0.2f, 9);
    rf_session_destroy(&session);
    setup.deep = NULL;
    setup.takes_deep = NULL;
    setup.to_tones = NULL;
    free(samples);
}

int main(void)
{
    int failed;

    make_scene();
    failed = unit_test_run(NULL, NULL);
    free(pixels);
    free(depth);
    return failed;
}
