/* bench_frames.c: whole frames are timed over blur, quality and threads. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bench/bench_frames.h"

enum { MOST_THREADS = 64 };

/* Best times of one setting, in milliseconds. */
struct times {
    double copy, box, prepare, render;
};

struct place {
    int width, height, threads, quality;
    double blur;
};

struct buffers {
    uint8_t *out, *rows; /* buffers of the frame's size */
    uint32_t *sum;       /* sums of a row */
};

/* Mean of 2 K + 1 rows and columns, the border extended: running sums, plain C. */
static void box_rows(uint8_t *restrict out, const uint8_t *restrict in, int width, int height,
                     int K)
{
    const uint32_t scale = (1u << 24) / (2 * (uint32_t)K + 1);

    for (int y = 0; y < height; y++) {
        const uint8_t *row = in + (size_t)y * (size_t)width * 3;
        uint8_t *to = out + (size_t)y * (size_t)width * 3;

        for (int c = 0; c < 3; c++) {
            uint32_t sum = 0;

            for (int x = -K; x <= K; x++)
                sum += row[3 * (x < 0 ? 0 : x < width ? x : width - 1) + c];
            for (int x = 0; x < width; x++) {
                const int after = x + K + 1 < width ? x + K + 1 : width - 1;
                const int before = x > K ? x - K : 0;

                to[3 * x + c] = (uint8_t)((sum * scale + (1 << 23)) >> 24);
                sum += (uint32_t)row[3 * after + c] - row[3 * before + c];
            }
        }
    }
}

static void slide(uint32_t *restrict sum, uint8_t *restrict out, const uint8_t *restrict after,
                  const uint8_t *restrict before, uint32_t scale, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        out[i] = (uint8_t)((sum[i] * scale + (1 << 23)) >> 24);
        sum[i] += (uint32_t)after[i] - before[i];
    }
}

static void box_columns(uint8_t *out, const uint8_t *in, uint32_t *sum, int width, int height,
                        int K)
{
    const uint32_t scale = (1u << 24) / (2 * (uint32_t)K + 1);
    const size_t row = (size_t)width * 3;

    memset(sum, 0, row * sizeof *sum);
    for (int y = -K; y <= K; y++) {
        const uint8_t *from = in + row * (size_t)(y < 0 ? 0 : y < height ? y : height - 1);

        for (size_t i = 0; i < row; i++)
            sum[i] += from[i];
    }
    for (int y = 0; y < height; y++)
        slide(sum, out + row * (size_t)y,
              in + row * (size_t)(y + K + 1 < height ? y + K + 1 : height - 1),
              in + row * (size_t)(y > K ? y - K : 0), scale, row);
}

static void keep(double *best, double start)
{
    const double taken = report_clock_ms() - start;

    *best = taken < *best ? taken : *best;
}

/* Everything in turns, so that all see the same machine. */
static int measure(struct engine *engine, const struct scene *scene, const struct place *place,
                   const struct buffers *b, int repeat, struct times *best)
{
    const int width = place->width, height = place->height;
    const size_t bytes = 3 * (size_t)width * (size_t)height;
    const struct refocus_disparity disparity = refocus_disparity16(
        scene->disparity, scene->map_width, scene->map_height, (ptrdiff_t)scene->map_width * 2);
    const struct refocus_scene taken = refocus_scene_default(&scene->photo, &disparity);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, b->out, width, height, (ptrdiff_t)width * 3);

    *best = (struct times){INFINITY, INFINITY, INFINITY, INFINITY};
    for (int i = 0; i < repeat; i++) {
        double start = report_clock_ms();
        int status;

        memcpy(b->out, scene->photo.plane[0], bytes);
        keep(&best->copy, start);
        start = report_clock_ms();
        box_rows(b->rows, b->out, width, height, (int)place->blur);
        box_columns(b->out, b->rows, b->sum, width, height, (int)place->blur);
        keep(&best->box, start);
        status = engine_prepare(engine, &taken);
        if (status == EXIT_DONE)
            status = engine_render(engine, &out, 1);
        if (status != EXIT_DONE)
            return status;
        best->prepare = engine->prepare_ms < best->prepare ? engine->prepare_ms : best->prepare;
        best->render = engine->render_ms.min < best->render ? engine->render_ms.min : best->render;
    }
    return EXIT_DONE;
}

static json_t *row_json(const struct place *place, const struct engine *engine,
                        const struct times *t)
{
    return json_pack("{s:i, s:i, s:f, s:s, s:i, s:i, s:s, s:f, s:f, s:f, s:f}", "width",
                     place->width, "height", place->height, "blur", place->blur, "quality",
                     engine_quality_words[place->quality].name, "rays",
                     (int)engine->params.render.rays, "threads", (int)engine->info.threads, "cpu",
                     refocus_cpu_name(engine->info.cpu), "memcpy_ms", t->copy, "box_ms", t->box,
                     "prepare_ms", t->prepare, "render_ms", t->render);
}

static void print_row(const struct place *place, const struct engine *engine, const struct times *t)
{
    printf("%5dx%-5d %5g  %-9s %7d  %8.3f %8.2f %8.2f %9.2f %8.1f %8.2f\n", place->width,
           place->height, place->blur, engine_quality_words[place->quality].name,
           (int)engine->info.threads, t->copy, t->box, t->prepare, t->render, 1e3 / t->render,
           t->render / t->box);
}

static int one(const struct engine_settings *common, const struct place *place,
               const struct scene *scene, const struct buffers *buffers, const char *name,
               json_t *rows)
{
    struct engine_settings settings = *common;
    struct engine engine;
    struct times times;
    int status;

    settings.quality = place->quality;
    settings.threads = place->threads;
    status = engine_begin(&engine, &settings);
    engine.name = name;
    if (status == EXIT_DONE)
        status = engine_create(&engine, &settings, place->width, place->height, place->blur);
    engine.params.render.focus_disparity = 0.3f;
    if (status == EXIT_DONE)
        status = measure(&engine, scene, place, buffers, (int)settings.repeat, &times);
    if (status == EXIT_DONE && rows)
        json_array_append_new(rows, row_json(place, &engine, &times));
    else if (status == EXIT_DONE)
        print_row(place, &engine, &times);
    engine_end(&engine);
    return status;
}

/* The threads that are asked for, else one and one for each processor. */
static int thread_counts(const struct engine_settings *settings, int counts[2])
{
    const int all = report_processors() < MOST_THREADS ? report_processors() : MOST_THREADS;

    counts[0] = settings->threads > 0 ? (int)settings->threads : 1;
    counts[1] = all;
    return settings->threads > 0 || all == 1 ? 1 : 2;
}

static int all_of(const struct engine_settings *settings, const struct scene *scene,
                  const char *name, json_t *rows)
{
    static const double blurs[] = {10, 20, 40};
    const int width = scene->photo.width, height = scene->photo.height;
    const size_t row = 3 * (size_t)width, bytes = row * (size_t)height;
    struct buffers buffers = {malloc(bytes), malloc(bytes), malloc(row * sizeof(uint32_t))};
    int counts[2], status = EXIT_DONE;
    const int count = thread_counts(settings, counts);

    if (!buffers.out || !buffers.rows || !buffers.sum)
        status = report_failure(EXIT_FAILED, name, "not enough memory");
    for (int i = 0; i < 3 * 3 * count && status == EXIT_DONE; i++) {
        const struct place place = {width, height, counts[i % count], i / count % 3,
                                    blurs[i / count / 3]};

        status = one(settings, &place, scene, &buffers, name, rows);
        report_progress("measuring frames", (i + 1.0) / (9 * count));
    }
    report_progress_end();
    free(buffers.out);
    free(buffers.rows);
    free(buffers.sum);
    return status;
}

int bench_frames(const struct engine_settings *settings, const struct scene *scene,
                 const char *name)
{
    static const int sizes[][2] = {{720, 540}, {1280, 720}, {1920, 1080}};
    json_t *rows = settings->json ? json_array() : NULL;
    int status = EXIT_DONE;

    if (!settings->json)
        printf("%-11s %5s  %-9s %7s  %8s %8s %8s %9s %8s %8s\n", "size", "blur", "quality",
               "threads", "memcpy", "box blur", "prepare", "render ms", "frames/s", "to box");
    if (scene)
        status = all_of(settings, scene, name ? name : "made-up scene", rows);
    for (int i = 0; i < 3 && !scene && status == EXIT_DONE; i++) {
        struct scene made = {0};

        status = bench_scene_make(&made, sizes[i][0], sizes[i][1]);
        if (status == EXIT_DONE)
            status = all_of(settings, &made, "made-up scene", rows);
        bench_scene_free(&made);
    }
    if (status != EXIT_DONE) {
        json_decref(rows);
        return status;
    }
    return rows ? report_print_json(json_pack("{s:o}", "frames", rows)) : report_end_output();
}
