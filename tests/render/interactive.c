/* interactive.c: how soon a renderer answers, on a picture of 12 megapixels: the first picture
 * after a tap, changes of the lens, regions, and a cancel at any moment. Prints JSON.
 *
 * usage: render-interactive [--size WxH] [--blur K] [--threads N] [--tries N] */
#include <pthread.h>

#include "pictures.h"
#include "../clock.h"

static int width = 4000, height = 3000, threads = 2, tries = 12;
static float blur = 100;

/* A call in a thread of its own. */
struct call {
    struct refocus_renderer *renderer;
    const struct refocus_image *photo; /* prepare, or NULL: render */
    const struct refocus_disparity *disparity;
    struct refocus_settings params;
    struct refocus_image out;
    int status;
    double end_ms;
};

static void run(struct call *call)
{
    call->status = call->photo ? refocus_prepare(call->renderer, call->photo, call->disparity)
                               : refocus_render_settings(call->renderer, &call->params, &call->out);
    call->end_ms = clock_ms(CLOCK_MONOTONIC);
}

static void *run_thread(void *user)
{
    run(user);
    return NULL;
}

/* Cancels the call at moments spread over its first two seconds; the longest time that
 * it went on, by the clock and of all threads' processors. */
static void measure_cancel(struct call call, const char *name, int last)
{
    double worst = 0, worst_cpu = 0, sum = 0, length = 2000;
    int cancelled = 0;

    for (int i = 0; i < tries; i++) {
        double start = clock_ms(CLOCK_MONOTONIC), begin, cpu;
        pthread_t thread;

        assert_int_equal(pthread_create(&thread, NULL, run_thread, &call), 0);
        sleep_ms(length * (i + 0.5) / tries);
        begin = clock_ms(CLOCK_MONOTONIC);
        cpu = clock_ms(CLOCK_PROCESS_CPUTIME_ID);
        refocus_cancel(call.renderer);
        pthread_join(thread, NULL);
        cpu = clock_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu;
        if (call.status == REFOCUS_OK) { /* it had ended: spread them over its length */
            length = call.end_ms - start;
            continue;
        }
        assert_int_equal(call.status, REFOCUS_ERR_CANCELLED);
        cancelled++;
        sum += call.end_ms - begin;
        worst = call.end_ms - begin > worst ? call.end_ms - begin : worst;
        worst_cpu = cpu > worst_cpu ? cpu : worst_cpu;
    }
    printf("    {\"of\": \"%s\", \"cancelled\": %d, \"worst_ms\": %.2f, \"mean_ms\": "
           "%.2f, "
           "\"worst_cpu_ms\": %.2f}%s\n",
           name, cancelled, worst, cancelled ? sum / cancelled : 0, worst_cpu, last ? "" : ",");
    fflush(stdout);
}

static struct refocus_image part(uint8_t *out, int w, int h)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, out, w, h, 3 * (ptrdiff_t)w);
}

/* The least time of some renders, each after `before`. */
static double time_render(struct call call, const struct refocus_settings *before)
{
    struct call first = call;
    double best = 1e30;

    if (before) {
        first.params = *before;
        first.out = part(call.out.plane[0], width, height);
    }
    for (int i = 0; i < 5; i++) {
        double start;

        if (before) {
            run(&first);
            assert_int_equal(first.status, REFOCUS_OK);
        }
        start = clock_ms(CLOCK_MONOTONIC);
        run(&call);
        assert_int_equal(call.status, REFOCUS_OK);
        best = call.end_ms - start < best ? call.end_ms - start : best;
    }
    return best;
}

static void print_time(const char *name, double ms)
{
    printf("    {\"what\": \"%s\", \"ms\": %.2f},\n", name, ms);
    fflush(stdout);
}

static void measure_times(struct call call, uint8_t *out)
{
    struct refocus_settings tap, half;
    double start = clock_ms(CLOCK_MONOTONIC);

    assert_int_equal(refocus_prepare(call.renderer, call.photo, call.disparity), REFOCUS_OK);
    print_time("prepare", clock_ms(CLOCK_MONOTONIC) - start);
    call.photo = NULL;
    tap = call.params;
    tap.render.focus_disparity = 0.2f;
    half = call.params;
    half.render.max_blur_radius = blur / 2;
    print_time("whole, after another focus", time_render(call, &tap));
    print_time("whole, after another f-number", time_render(call, &half));
    half = call.params;
    half.render.sigma = 400;
    print_time("whole, after another sigma", time_render(call, &half));
    print_time("whole, after another region", time_render(call, NULL));
    call.out = part(out, width < 256 ? width : 256, height < 256 ? height : 256);
    call.params.render.region_x = (width - call.out.width) / 2 / 16 * 16 + 5;
    call.params.render.region_y = (height - call.out.height) / 3;
    call.params.render.region_x =
        call.params.render.region_x > width - call.out.width ? 0 : call.params.render.region_x;
    call.params.render.region_width = call.out.width;
    call.params.render.region_height = call.out.height;
    print_time("256x256, after another focus", time_render(call, &tap));
    half = call.params;
    half.render.region_x = half.render.region_y = half.render.region_width =
        half.render.region_height = 0;
    print_time("256x256, after the whole", time_render(call, &half));
    call.params.render.region_x = call.params.render.region_y = 0;
    call.params.render.region_width = call.params.render.region_height = 0;
}

static void parse(int argc, char **argv)
{
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!strcmp(argv[i], "--size"))
            sscanf(argv[i + 1], "%dx%d", &width, &height);
        else if (!strcmp(argv[i], "--blur"))
            blur = (float)atof(argv[i + 1]);
        else if (!strcmp(argv[i], "--threads"))
            threads = atoi(argv[i + 1]);
        else if (!strcmp(argv[i], "--tries"))
            tries = atoi(argv[i + 1]);
    }
}

TEST(measure)
{
    struct picture p = picture_make(width, height, 77);
    uint8_t *out = malloc(3 * (size_t)width * (size_t)height), small[48];
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    const struct refocus_disparity coarse = refocus_disparity8(small, 8, 6, 8);
    struct refocus_renderer_params limits = refocus_renderer_params_default(width, height, blur);
    struct call call = {
        NULL, &photo, &disparity, refocus_settings_default(0.5f, blur), part(out, width, height),
        0,    0};
    struct refocus_renderer_info info = refocus_renderer_info_default();

    assert_non_null(out);
    for (int i = 0; i < 48; i++)
        small[i] = (uint8_t)(i * 97);
    limits.threads = threads;
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&call.renderer, &limits), REFOCUS_OK);
    refocus_renderer_get_info(call.renderer, &info);
    printf("{\n  \"width\": %d, \"height\": %d, \"blur\": %g, \"threads\": %d, "
           "\"rays\": %d, "
           "\"cpu\": \"%s\",\n  \"times\": [\n",
           width, height, (double)blur, info.threads, call.params.render.rays,
           refocus_cpu_name(info.cpu));
    measure_times(call, out);
    printf("    {}\n  ],\n  \"cancel\": [\n");
    measure_cancel(call, "prepare", 0);
    call.disparity = &coarse;
    measure_cancel(call, "prepare, depth 8x6", 0);
    call.disparity = &disparity;
    assert_int_equal(refocus_prepare(call.renderer, &photo, &disparity), REFOCUS_OK);
    call.photo = NULL;
    for (uint32_t m = 0; m < REFOCUS_METHOD_COUNT; m++) {
        for (int full = 0; full < 2; full++) {
            char name[60];

            if (full && m > REFOCUS_METHOD_BLUR)
                continue;
            call.params = refocus_settings_default(0.5f, blur);
            call.params.render.method = m;
            call.params.render.rays = full ? REFOCUS_RAYS_FULL : 128;
            call.params.highlights.gain = full ? 4 : 9.5f; /* hit by rays; splatted */
            call.params.look.star_spikes = 8;
            call.params.look.star_length = 127;
            call.params.foveated.angle = 90;
            call.params.scatter.spread = REFOCUS_SPREAD_LOMMEL;
            snprintf(name, sizeof name, "%s%s", refocus_method_name(m), full ? ", every ray" : "");
            measure_cancel(call, name, m == REFOCUS_METHOD_COUNT - 1);
        }
    }
    printf("  ]\n}\n");
    refocus_renderer_destroy(&call.renderer);
    free(out);
    picture_free(&p);
}

int main(int argc, char **argv)
{
    parse(argc, argv);
    return unit_test_run(NULL, NULL);
}
