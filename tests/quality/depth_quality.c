/* depth_quality.c: refocus-depth-quality: what coarse depth costs, and what upsampling it costs.
 *
 *     refocus-depth-quality SCENE_FOLDER...   quality against the exact disparities
 *     refocus-depth-quality --time SCENE_FOLDER...   CPU time of refocus_upsample()
 *     refocus-depth-quality --faults SCENE_FOLDER...   exact disparities spoilt, edges put right
 *     refocus-depth-quality --truth NAME PHOTO.png TRUTH.png...
 *         every 4th row and column of known disparities, 0 = unknown, brought back
 *
 * Prints tables in Markdown; tests/depth.md holds them. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#include "../clock.h"
#include "depth_fit.h"
#include "depth_ways.h"
#include "faults.h"
#include "metrics.h"
#include "png_io.h"
#include "scene.h"
#ifdef RF_HAVE_OPENCV
#include <refocus/platform/opencv.h>
#endif

static struct refocus_image photo_of(const struct quality_scene *scene)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height,
                                3 * scene->width);
}

static struct refocus_disparity whole_map(const struct quality_scene *scene, const uint16_t *d)
{
    return refocus_disparity16(d, scene->width, scene->height, 2 * scene->width);
}

/* Mean PSNR and edge PSNR of all views without blades against the traced references. */
static int refocused(const struct quality_scene *scene, struct refocus_disparity map, double *psnr,
                     double *edge_psnr)
{
    const int w = scene->width, h = scene->height;
    struct refocus_renderer_params limits = refocus_renderer_params_default(w, h, 64);
    const struct refocus_image photo = photo_of(scene);
    struct refocus_renderer *renderer = NULL;
    uint8_t *pixels = malloc(3 * (size_t)w * (size_t)h), *mask = malloc((size_t)w * (size_t)h);
    int views = 0, result = -1;

    *psnr = *edge_psnr = 0;
    if (!pixels || !mask || refocus_renderer_create(&renderer, &limits) ||
        refocus_prepare(renderer, &photo, &map))
        goto done;
    for (int i = 0; i < scene->views; i++) {
        const struct quality_view *view = &scene->view[i];
        struct refocus_settings params =
            refocus_settings_default((float)view->focus, (float)view->blur);
        const struct refocus_image out =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, w, h, 3 * w);
        struct quality_scores scores;
        uint8_t *reference;
        int bad;

        if (view->blades)
            continue;
        if (!(reference = quality_scene_reference(scene, view)))
            goto done;
        bad = refocus_render_settings(renderer, &params, &out) ||
              quality_edge_mask(scene->disparity, w, h, view->focus, view->blur, mask) ||
              quality_score(pixels, reference, w, h, (int)ceil(view->blur), mask, &scores);
        free(reference);
        if (bad)
            goto done;
        *psnr += scores.psnr;
        *edge_psnr += scores.edge_psnr;
        views++;
    }
    *psnr /= views;
    *edge_psnr /= views;
    result = 0;
done:
    refocus_renderer_destroy(&renderer);
    free(pixels);
    free(mask);
    return result;
}

static int read_coarse(const struct quality_scene *scene, struct depth_coarse *coarse)
{
    char path[1200];
    uint16_t *mm;
    struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                    .sample = REFOCUS_SAMPLE_U16,
                                    .meaning = REFOCUS_DEPTH_DISTANCE,
                                    .flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN,
                                    .metres_per_unit = 0.001,
                                    .near_m = scene->near_m,
                                    .far_m = scene->far_m};
    struct refocus_repair_params params = refocus_repair_params_default();
    int status;

    snprintf(path, sizeof path, "%s/depth_lowres.png", scene->folder);
    if (!(mm = png_io_read(path, 1, &coarse->width, &coarse->height)))
        return -1;
    map.samples = mm;
    map.width = coarse->width;
    map.height = coarse->height;
    map.stride = 2 * coarse->width;
    coarse->disparity = malloc((size_t)coarse->width * (size_t)coarse->height * 2);
    coarse->confidence = malloc((size_t)coarse->width * (size_t)coarse->height);
    params.confidence = coarse->confidence;
    params.confidence_stride = coarse->width;
    status = coarse->disparity && coarse->confidence
                 ? refocus_depth_repair(&map, &params, coarse->disparity, map.stride, NULL)
                 : -1;
    free(mm);
    return status;
}

static int score_scene(const char *folder, unsigned table, const char *pictures)
{
    struct quality_scene scene;
    struct depth_coarse coarse = {0, 0, NULL, NULL};
    uint16_t *d;
    double exact_psnr = 0, exact_edge = 0;
    int result = -1;

    if (quality_scene_read(&scene, folder))
        return -1;
    d = malloc((size_t)scene.width * (size_t)scene.height * sizeof *d);
    if (!d || read_coarse(&scene, &coarse))
        goto done;
    for (size_t i = 0; depth_ways[i].name; i++) {
        double psnr, edge;
        struct depth_fit fit;
        char path[1200];

        if (!(depth_ways[i].tables & table))
            continue;

        const int status = depth_ways[i].run(&scene, &coarse, d);

        if (status == REFOCUS_ERR_UNSUPPORTED)
            continue; /* the module of contrib filters is not there */
        if (status || depth_fit(&scene, NULL, d, &fit) ||
            refocused(&scene, whole_map(&scene, d), &psnr, &edge))
            goto done;
        if (i == 0) {
            exact_psnr = psnr;
            exact_edge = edge;
        }
        printf("| %s | %s | %.1f | %.1f | %.2f | %.2f | %.2f | %+.2f | %.2f | %+.2f |\n",
               scene.name, depth_ways[i].name, fit.hit, fit.stray, 1000 * fit.smooth,
               1000 * fit.beside, psnr, psnr - exact_psnr, edge, edge - exact_edge);
        fflush(stdout);
        if (pictures) {
            uint8_t *rgb = malloc(3 * (size_t)scene.width * (size_t)scene.height);

            if (!rgb)
                goto done;
            for (size_t k = 0; k < 3 * (size_t)scene.width * (size_t)scene.height; k++)
                rgb[k] = (uint8_t)(d[k / 3] >> 8);
            snprintf(path, sizeof path, "%s/%s_%zu.png", pictures, scene.name, i);
            const int bad = png_io_write(path, rgb, scene.width, scene.height);
            free(rgb);
            if (bad)
                goto done;
        }
    }
    result = 0;
done:
    free(d);
    free(coarse.disparity);
    free(coarse.confidence);
    quality_scene_free(&scene);
    return result;
}

static int score_faults(const char *folder)
{
    struct quality_scene scene;
    uint16_t *faulty, *d;
    double exact[2] = {0, 0};
    int result = -1;

    if (quality_scene_read(&scene, folder))
        return -1;

    const int w = scene.width, h = scene.height;
    const struct refocus_image photo = photo_of(&scene);
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();

    faulty = malloc((size_t)w * (size_t)h * sizeof *faulty);
    d = malloc((size_t)w * (size_t)h * sizeof *d);
    if (!faulty || !d)
        goto done;
    for (const struct fault *fault = faults; fault->name; fault++) {
        const int columns = w / fault->divisor, rows = h / fault->divisor;
        const struct refocus_disparity map =
            refocus_disparity16(faulty, columns, rows, 2 * columns);
        double before[2], after[2];

        if (fault->make(scene.disparity, w, h, faulty) ||
            refocused(&scene, map, &before[0], &before[1]) ||
            refocus_depth_edges(&photo, &map, &params, d, 2 * w, NULL) ||
            refocused(&scene, whole_map(&scene, d), &after[0], &after[1]))
            goto done;
        if (fault == faults)
            memcpy(exact, before, sizeof exact);
        printf("| %s | %s |", scene.name, fault->name);
        for (int i = 0; i < 2; i++)
            printf(" %.2f | %+.2f | %.2f | %+.2f |", before[i], before[i] - exact[i], after[i],
                   after[i] - exact[i]);
        puts("");
        fflush(stdout);
    }
    result = 0;
done:
    free(faulty);
    free(d);
    quality_scene_free(&scene);
    return result;
}

static int score_all_faults(int scenes, char **folder)
{
    int failed = 0;

    puts("| scene | map | PSNR, dB | to exact | edges put right | to exact | edge PSNR, dB | "
         "to exact | edges put right | to exact |\n"
         "| --- | --- | --: | --: | --: | --: | --: | --: | --: | --: |");
    for (int i = 0; i < scenes && !failed; i++)
        failed = score_faults(folder[i]);
    return failed ? 1 : 0;
}

/* The samples that are there as disparities over the whole range, the others inpainted. */
static int spread(const uint16_t *raw, int width, int height, const double range[2],
                  uint16_t *disparity, uint8_t *confidence, struct refocus_depth_report *report)
{
    struct refocus_repair_params params = refocus_repair_params_default();
    const struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                          .samples = raw,
                                          .width = width,
                                          .height = height,
                                          .stride = 2 * (ptrdiff_t)width,
                                          .sample = REFOCUS_SAMPLE_U16,
                                          .meaning = REFOCUS_DEPTH_DISPARITY,
                                          .flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN,
                                          .value_far = range[0],
                                          .value_near = range[1]};

    params.confidence = confidence;
    params.confidence_stride = width;
    return refocus_depth_repair(&map, &params, disparity, 2 * (ptrdiff_t)width, report);
}

enum { NTH = 4 };

/* A sample from the middle of every 4 x 4 pixels. */
static uint16_t *decimate(const uint16_t *raw, int stride, int width, int height)
{
    uint16_t *coarse = malloc((size_t)width * (size_t)height * sizeof *coarse);

    for (int i = 0; coarse && i < width * height; i++)
        coarse[i] = raw[(size_t)(i / width * NTH + NTH / 2) * (size_t)stride +
                        (size_t)(i % width * NTH + NTH / 2)];
    return coarse;
}

/* Without the columns and rows that do not fill 4 x 4 pixels. */
static void crop(void *samples, size_t bytes, int stride, int width, int height)
{
    for (int y = 0; y < height; y++)
        memmove((char *)samples + (size_t)y * (size_t)width * bytes,
                (char *)samples + (size_t)y * (size_t)stride * bytes, (size_t)width * bytes);
}

static int score_truth(const char *name, const char *photo, const char *truth)
{
    static const double whole[2] = {0, 0};
    struct quality_scene scene = {.name = name};
    struct depth_coarse coarse = {0, 0, NULL, NULL};
    uint16_t *raw, *few = NULL, *d = NULL;
    uint8_t *known = NULL;
    struct refocus_depth_report report = refocus_depth_report_default();
    int w, h, stride, result = -1;

    scene.photo = png_io_read(photo, 3, &w, &h);
    raw = png_io_read(truth, 1, &stride, &scene.height);
    if (!scene.photo || !raw || w != stride || h != scene.height)
        goto done;
    coarse.width = w / NTH;
    coarse.height = h / NTH;
    scene.width = coarse.width * NTH;
    scene.height = coarse.height * NTH;
    crop(scene.photo, 3, stride, scene.width, scene.height);
    crop(raw, sizeof *raw, stride, scene.width, scene.height);

    const size_t pixels = (size_t)scene.width * (size_t)scene.height;

    few = decimate(raw, scene.width, coarse.width, coarse.height);
    scene.disparity = malloc(pixels * sizeof *d);
    d = malloc(pixels * sizeof *d);
    known = malloc(pixels);
    coarse.disparity = malloc(pixels / (NTH * NTH) * sizeof *d);
    coarse.confidence = malloc(pixels / (NTH * NTH));
    if (!few || !scene.disparity || !d || !known || !coarse.disparity || !coarse.confidence ||
        spread(raw, scene.width, scene.height, whole, scene.disparity, known, &report))
        goto done;

    const double range[2] = {report.value_far, report.value_near};

    if (spread(few, coarse.width, coarse.height, range, coarse.disparity, coarse.confidence,
               &report))
        goto done;
    for (const struct depth_way *way = depth_ways; way->name; way++) {
        struct depth_fit fit;

        if (!(way->tables & IN_TRUTH))
            continue;
        if (way->run(&scene, &coarse, d) || depth_fit(&scene, known, d, &fit))
            goto done;
        printf("| %s | %s | %.1f | %.1f | %.2f | %.2f |\n", name, way->name, fit.hit, fit.stray,
               1000 * fit.smooth, 1000 * fit.beside);
    }
    result = 0;
done:
    if (result)
        fprintf(stderr, "refocus-depth-quality: %s and %s: cannot be judged\n", photo, truth);
    free(coarse.disparity);
    free(coarse.confidence);
    free(scene.photo);
    free(scene.disparity);
    free(known);
    free(few);
    free(raw);
    free(d);
    return result;
}

static int score_truths(int argc, char **argv)
{
    int failed = argc % 3;

    puts("| photo | depth | true edges found within 1 px, % | found edges that are true, % | "
         "error in smooth parts, 1/1000 | within 4 px of edges, 1/1000 |\n"
         "| --- | --- | --: | --: | --: | --: |");
    for (int i = 0; i < argc && !failed; i += 3)
        failed = score_truth(argv[i], argv[i + 1], argv[i + 2]);
    return failed ? 1 : 0;
}

/* CPU time of all threads together; the least and the median of 20. */
static int compare(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

/* Upsamples by the core, or by a filter of OpenCV, with the given number of threads. */
static int run_way(const struct quality_scene *scene, const struct depth_coarse *c, int threads,
                   uint32_t cpu, uint32_t filter, uint16_t *out)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height, 3 * scene->width);
    const struct refocus_disparity map =
        refocus_disparity16(c->disparity, c->width, c->height, 2 * c->width);

#ifdef RF_HAVE_OPENCV
    if (filter != UINT32_MAX)
        return depth_by_opencv(filter, scene, c, out);
#endif
    (void)filter;
    params.threads = threads;
    params.cpu = cpu;
    return refocus_upsample(&photo, &map, &params, out, 2 * (ptrdiff_t)scene->width);
}

static void time_way(const struct quality_scene *scene, const struct depth_coarse *c,
                     const char *name, int threads, uint32_t cpu, uint32_t filter, uint16_t *out)
{
    enum { RUNS = 21, FEW = 5 };
    double cpu_ms[RUNS], wall_ms[RUNS];
    int runs = RUNS;

    for (int i = 0; i < runs; i++) {
        const double cpu0 = clock_ms(CLOCK_PROCESS_CPUTIME_ID);
        const double wall0 = clock_ms(CLOCK_MONOTONIC);

        if (run_way(scene, c, threads, cpu, filter, out))
            return;
        cpu_ms[i] = clock_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu0;
        wall_ms[i] = clock_ms(CLOCK_MONOTONIC) - wall0;
        if (cpu_ms[i] > 200)
            runs = FEW;
    }
    qsort(cpu_ms, (size_t)runs, sizeof *cpu_ms, compare);
    qsort(wall_ms, (size_t)runs, sizeof *wall_ms, compare);
    printf("| %s | %s | %d | %.1f | %.1f | %.1f | %.1f |\n", scene->name, name, threads, cpu_ms[0],
           cpu_ms[runs / 2], wall_ms[0], wall_ms[runs / 2]);
    fflush(stdout);
}

static int time_scene(const char *folder)
{
    enum { W = 1920, H = 1080, CW = 320, CH = 240 };
    struct quality_scene scene, large;
    struct depth_coarse map = {CW, CH, malloc(CW * CH * 2), NULL};
    uint16_t *out = malloc((size_t)W * H * 2);
    int result = -1;

    if (quality_scene_read(&scene, folder))
        return -1;
    large = scene;
    large.width = W;
    large.height = H;
    large.photo = malloc((size_t)3 * W * H);
    if (!map.disparity || !out || !large.photo)
        goto done;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            memcpy(large.photo + 3 * ((size_t)y * W + (size_t)x),
                   scene.photo + 3 * ((size_t)(y * scene.height / H) * (size_t)scene.width +
                                      (size_t)(x * scene.width / W)),
                   3);
    for (int y = 0; y < CH; y++)
        for (int x = 0; x < CW; x++)
            map.disparity[y * CW + x] =
                scene.disparity[(size_t)((2 * y + 1) * scene.height / (2 * CH)) *
                                    (size_t)scene.width +
                                (size_t)((2 * x + 1) * scene.width / (2 * CW))];
    for (int threads = 1; threads <= 2; threads++)
        for (uint32_t cpu = REFOCUS_CPU_C; refocus_cpu_name(cpu); cpu++)
            time_way(&large, &map, refocus_cpu_name(cpu), threads, cpu, UINT32_MAX, out);
#ifdef RF_HAVE_OPENCV
    for (uint32_t i = 0; refocus_cv_filter_name(i); i++) {
        char name[80];

        snprintf(name, sizeof name, "OpenCV %s", refocus_cv_filter_name(i));
        time_way(&large, &map, name, i == REFOCUS_CV_JOINT_BILATERAL ? 1 : 2, 0, i, out);
    }
#endif
    result = 0;
done:
    free(large.photo);
    free(map.disparity);
    free(out);
    quality_scene_free(&scene);
    return result;
}

int main(int argc, char **argv)
{
    const bool timing = argc > 1 && !strcmp(argv[1], "--time");
    const char *pictures = argc > 2 && !strcmp(argv[1], "--out") ? argv[2] : NULL;
    int failed = 0;

    if (argc < 2) {
        fputs("usage: refocus-depth-quality [--time | --faults | --out FOLDER] "
              "SCENE_FOLDER...\n"
              "       refocus-depth-quality --truth NAME PHOTO.png TRUTH.png...\n",
              stderr);
        return 2;
    }
    if (!strcmp(argv[1], "--truth"))
        return score_truths(argc - 2, argv + 2);
    if (!strcmp(argv[1], "--faults"))
        return score_all_faults(argc - 2, argv + 2);
    puts(timing ? "| scene | instructions | threads | CPU ms, least | median | wall ms, least | "
                  "median |\n| --- | --- | --: | --: | --: | --: | --: |"
                : "| scene | depth | true edges found within 1 px, % | found edges that are "
                  "true, % | error in smooth parts, 1/1000 | within 4 px of edges, 1/1000 | "
                  "PSNR, dB | to exact | edge PSNR, dB | to exact |\n"
                  "| --- | --- | --: | --: | --: | --: | --: | --: | --: | --: |");
    for (int i = timing ? 2 : pictures ? 3 : 1; i < argc && !failed; i++)
        failed = timing ? time_scene(argv[i]) : score_scene(argv[i], IN_SCENES, pictures);
    return failed ? 1 : 0;
}
