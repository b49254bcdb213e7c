/* refocus-depth-quality: what coarse depth costs, and what upsampling it costs.
 *
 *     refocus-depth-quality SCENE_FOLDER...   quality against the exact disparities
 *     refocus-depth-quality --time            CPU time of refocus_upsample()
 *
 * Prints tables in Markdown; tests/depth.md holds them. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <refocus/refocus.h>

#include "metrics.h"
#include "png_io.h"
#include "scene.h"
#ifdef RF_HAVE_OPENCV
#include <refocus/platform/opencv.h>
#endif

enum { EDGE = 65535 / 20 }; /* a step of one pixel of blur at K = 20 */

struct coarse {
    int width, height;
    uint16_t *disparity;
    uint8_t *confidence; /* 0 where the sensor saw nothing, or NULL */
};

typedef int upsample_fn(const struct quality_scene *scene, const struct coarse *coarse,
                        uint16_t *out);

static double sample(const struct coarse *c, int x, int y)
{
    x = x < 0 ? 0 : x >= c->width ? c->width - 1 : x;
    y = y < 0 ? 0 : y >= c->height ? c->height - 1 : y;
    return c->disparity[(size_t)y * (size_t)c->width + (size_t)x];
}

static int exact(const struct quality_scene *scene, const struct coarse *coarse, uint16_t *out)
{
    (void)coarse;
    memcpy(out, scene->disparity, (size_t)scene->width * (size_t)scene->height * sizeof *out);
    return 0;
}

static int nearest(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    for (int y = 0; y < scene->height; y++)
        for (int x = 0; x < scene->width; x++)
            *out++ = (uint16_t)sample(c, (2 * x + 1) * c->width / (2 * scene->width),
                                      (2 * y + 1) * c->height / (2 * scene->height));
    return 0;
}

static int bilinear(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    for (int y = 0; y < scene->height; y++) {
        const double v = (y + 0.5) * c->height / scene->height - 0.5, fy = v - floor(v);

        for (int x = 0; x < scene->width; x++) {
            const double u = (x + 0.5) * c->width / scene->width - 0.5, fx = u - floor(u);
            const int i = (int)floor(u), j = (int)floor(v);

            *out++ = (uint16_t)lrint(
                (1 - fy) * ((1 - fx) * sample(c, i, j) + fx * sample(c, i + 1, j)) +
                fy * ((1 - fx) * sample(c, i, j + 1) + fx * sample(c, i + 1, j + 1)));
        }
    }
    return 0;
}

/* Joint bilateral: the mean over 5 x 5 samples by nearness and likeness (Kopf et al. 2007). */
static int joint_bilateral(const struct quality_scene *scene, const struct coarse *c,
                           uint16_t *out)
{
    const int w = scene->width, h = scene->height;

    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            const double u = (x + 0.5) * c->width / w - 0.5, v = (y + 0.5) * c->height / h - 0.5;
            const uint8_t *p = scene->photo + 3 * ((size_t)y * (size_t)w + (size_t)x);
            double sum = 0, total = 0;

            for (int j = (int)floor(v) - 2; j <= (int)floor(v) + 2; j++) {
                for (int i = (int)floor(u) - 2; i <= (int)floor(u) + 2; i++) {
                    const int ci = i < 0 ? 0 : i >= c->width ? c->width - 1 : i;
                    const int cj = j < 0 ? 0 : j >= c->height ? c->height - 1 : j;
                    const uint8_t *q =
                        scene->photo + 3 * ((size_t)((2 * cj + 1) * h / (2 * c->height)) *
                                                (size_t)w +
                                            (size_t)((2 * ci + 1) * w / (2 * c->width)));
                    double apart = 0, weight;

                    for (int k = 0; k < 3; k++)
                        apart += (p[k] - q[k]) * (p[k] - q[k]);
                    weight = exp(-((u - i) * (u - i) + (v - j) * (v - j)) / 2 -
                                 apart / (2 * 0.1 * 0.1 * 255 * 255)) + 1e-12;
                    total += weight;
                    sum += weight * sample(c, ci, cj);
                }
            }
            *out++ = (uint16_t)lrint(sum / total);
        }
    }
    return 0;
}

static int upsample(const struct quality_scene *scene, const struct coarse *c,
                    const uint8_t *confidence, uint16_t *out)
{
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height, 3 * scene->width);
    const struct refocus_disparity map =
        refocus_disparity16(c->disparity, c->width, c->height, 2 * c->width);
    struct refocus_upsample_params params = refocus_upsample_params_default();

    params.confidence = confidence;
    params.confidence_stride = c->width;
    return refocus_upsample(&photo, &map, &params, out, 2 * (ptrdiff_t)scene->width);
}

static int cluster(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    return upsample(scene, c, NULL, out);
}

static int trusting(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    return upsample(scene, c, c->confidence, out);
}

#ifdef RF_HAVE_OPENCV
static int by_opencv(uint32_t filter, const struct quality_scene *scene, const struct coarse *c,
                     uint16_t *out)
{
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height, 3 * scene->width);
    const struct refocus_disparity map =
        refocus_disparity16(c->disparity, c->width, c->height, 2 * c->width);

    return refocus_cv_upsample_by(filter, &photo, &map, out, NULL);
}

static int cv_bilinear(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    return by_opencv(REFOCUS_CV_BILINEAR, scene, c, out);
}

static int cv_joint(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    return by_opencv(REFOCUS_CV_JOINT_BILATERAL, scene, c, out);
}

static int cv_guided(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    return by_opencv(REFOCUS_CV_GUIDED, scene, c, out);
}

static int cv_fast(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    return by_opencv(REFOCUS_CV_FAST_GLOBAL, scene, c, out);
}

static int cv_joint_full(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    return by_opencv(REFOCUS_CV_JOINT_BILATERAL_FULL, scene, c, out);
}
#endif

/* The exact disparities, three pixels to the right and down. */
static int moved(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    enum { OFF = 3 };

    (void)c;
    for (int y = 0; y < scene->height; y++)
        for (int x = 0; x < scene->width; x++)
            *out++ = scene->disparity[(size_t)(y < OFF ? 0 : y - OFF) * (size_t)scene->width +
                                      (size_t)(x < OFF ? 0 : x - OFF)];
    return 0;
}

static int snapped(const struct quality_scene *scene, const struct coarse *c, uint16_t *out)
{
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height, 3 * scene->width);
    const ptrdiff_t stride = 2 * (ptrdiff_t)scene->width;
    const struct refocus_snap_params params = refocus_snap_params_default(3);
    uint16_t *map = malloc((size_t)stride * (size_t)scene->height);
    int status = map ? moved(scene, c, map) : -1;

    if (!status) {
        const struct refocus_disparity d =
            refocus_disparity16(map, scene->width, scene->height, stride);

        status = refocus_depth_snap(&photo, &d, &params, out, stride);
    }
    free(map);
    return status;
}

static const struct {
    const char *name;
    upsample_fn *run;
} ways[] = {{"exact disparity", exact},
            {"nearest", nearest},
            {"bilinear", bilinear},
            {"joint bilateral mean", joint_bilateral},
#ifdef RF_HAVE_OPENCV
            {"OpenCV bilinear", cv_bilinear},
            {"OpenCV joint bilateral", cv_joint},
            {"OpenCV guided", cv_guided},
            {"OpenCV fast global smoother", cv_fast},
            {"OpenCV joint bilateral, full size", cv_joint_full},
#endif
            {"refocus_upsample, holes filled", cluster},
            {"refocus_upsample, holes as confidence", trusting},
            {"exact, 3 px off", moved},
            {"the same, refocus_depth_snap", snapped}};

/* Pixels on either side of a step. */
static void find_edges(const uint16_t *d, int w, int h, uint8_t *edge)
{
    memset(edge, 0, (size_t)w * (size_t)h);
    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x;

            if (x + 1 < w && abs(d[i] - d[i + 1]) >= EDGE)
                edge[i] = edge[i + 1] = 1;
            if (y + 1 < h && abs(d[i] - d[i + (size_t)w]) >= EDGE)
                edge[i] = edge[i + (size_t)w] = 1;
        }
    }
}

static bool any_within(const uint8_t *edge, int w, int h, int x, int y, int reach)
{
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < w && j < h && edge[(size_t)j * (size_t)w + (size_t)i])
                return true;
    return false;
}

struct fit {
    double hit, stray;     /* shares: true edges found within 1 px, found ones that are true */
    double smooth, beside; /* mean |error| more than 4 px from an edge, and up to there */
};

static int measure(const struct quality_scene *scene, const uint16_t *d, struct fit *fit)
{
    const int w = scene->width, h = scene->height;
    uint8_t *edge = malloc((size_t)w * (size_t)h), *found = malloc((size_t)w * (size_t)h);
    long edges = 0, hits = 0, founds = 0, trues = 0, smooth = 0, beside = 0;
    double smooth_sum = 0, beside_sum = 0;

    if (!edge || !found) {
        free(edge);
        free(found);
        return -1;
    }
    find_edges(scene->disparity, w, h, edge);
    find_edges(d, w, h, found);
    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x;
            const double error = abs(d[i] - scene->disparity[i]) / 65535.0;

            edges += edge[i];
            hits += edge[i] && any_within(found, w, h, x, y, 1);
            founds += found[i];
            trues += found[i] && any_within(edge, w, h, x, y, 1);
            if (any_within(edge, w, h, x, y, 4)) {
                beside++;
                beside_sum += error;
            } else {
                smooth++;
                smooth_sum += error;
            }
        }
    }
    *fit = (struct fit){100.0 * (double)hits / (double)edges,
                        100.0 * (double)trues / (double)(founds ? founds : 1),
                        smooth_sum / (double)smooth, beside_sum / (double)beside};
    free(edge);
    free(found);
    return 0;
}

/* Mean PSNR and edge PSNR of all views without blades against the traced references. */
static int refocused(const struct quality_scene *scene, uint16_t *d, double *psnr,
                     double *edge_psnr)
{
    const int w = scene->width, h = scene->height;
    struct refocus_renderer_params limits = refocus_renderer_params_default(w, h, 64);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, scene->photo, w, h, 3 * w);
    const struct refocus_disparity map = refocus_disparity16(d, w, h, 2 * w);
    struct refocus_renderer *renderer = NULL;
    uint8_t *pixels = malloc(3 * (size_t)w * (size_t)h), *mask = malloc((size_t)w * (size_t)h);
    int views = 0, result = -1;

    *psnr = *edge_psnr = 0;
    if (!pixels || !mask || refocus_renderer_create(&renderer, &limits) ||
        refocus_prepare(renderer, &photo, &map))
        goto done;
    for (int i = 0; i < scene->views; i++) {
        const struct quality_view *view = &scene->view[i];
        struct refocus_render_params params =
            refocus_render_params_default((float)view->focus, (float)view->blur);
        const struct refocus_image out =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, w, h, 3 * w);
        struct quality_scores scores;
        uint8_t *reference;
        int bad;

        if (view->blades)
            continue;
        if (!(reference = quality_scene_reference(scene, view)))
            goto done;
        bad = refocus_render(renderer, &params, &out) ||
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

static int read_coarse(const struct quality_scene *scene, struct coarse *coarse)
{
    char path[1200];
    uint16_t *mm;
    struct refocus_depth_map map = {.sample = REFOCUS_SAMPLE_U16,
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

static int score_scene(const char *folder, const char *pictures)
{
    struct quality_scene scene;
    struct coarse coarse = {0, 0, NULL, NULL};
    uint16_t *d;
    double exact_psnr = 0, exact_edge = 0;
    int result = -1;

    if (quality_scene_read(&scene, folder))
        return -1;
    d = malloc((size_t)scene.width * (size_t)scene.height * sizeof *d);
    if (!d || read_coarse(&scene, &coarse))
        goto done;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        double psnr, edge;
        struct fit fit;
        char path[1200];

        const int status = ways[i].run(&scene, &coarse, d);

        if (status == REFOCUS_ERR_UNSUPPORTED)
            continue; /* the module of contrib filters is not there */
        if (status || measure(&scene, d, &fit) ||
            refocused(&scene, d, &psnr, &edge))
            goto done;
        if (i == 0) {
            exact_psnr = psnr;
            exact_edge = edge;
        }
        printf("| %s | %s | %.1f | %.1f | %.2f | %.2f | %.2f | %+.2f | %.2f | %+.2f |\n",
               scene.name, ways[i].name, fit.hit, fit.stray, 1000 * fit.smooth,
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

static double clock_ms(clockid_t clock)
{
    struct timespec t;

    clock_gettime(clock, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* CPU time of all threads together; the least and the median of 20. */
static int compare(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

/* By the core, or by a filter of OpenCV: with the threads that it takes. */
static int run_way(const struct quality_scene *scene, const struct coarse *c, int threads,
                   uint32_t cpu, uint32_t filter, uint16_t *out)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height, 3 * scene->width);
    const struct refocus_disparity map =
        refocus_disparity16(c->disparity, c->width, c->height, 2 * c->width);

#ifdef RF_HAVE_OPENCV
    if (filter != UINT32_MAX)
        return by_opencv(filter, scene, c, out);
#endif
    (void)filter;
    params.threads = threads;
    params.cpu = cpu;
    return refocus_upsample(&photo, &map, &params, out, 2 * (ptrdiff_t)scene->width);
}

static void time_way(const struct quality_scene *scene, const struct coarse *c, const char *name,
                     int threads, uint32_t cpu, uint32_t filter, uint16_t *out)
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
    struct coarse map = {CW, CH, malloc(CW * CH * 2), NULL};
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
                                      (size_t)(x * scene.width / W)), 3);
    for (int y = 0; y < CH; y++)
        for (int x = 0; x < CW; x++)
            map.disparity[y * CW + x] =
                scene.disparity[(size_t)((2 * y + 1) * scene.height / (2 * CH)) *
                                    (size_t)scene.width +
                                (size_t)((2 * x + 1) * scene.width / (2 * CW))];
    for (int threads = 1; threads <= 2; threads++)
        for (uint32_t cpu = REFOCUS_CPU_C; cpu <= REFOCUS_CPU_AVX2; cpu++)
            time_way(&large, &map, refocus_cpu_name(cpu), threads, cpu, UINT32_MAX, out);
#ifdef RF_HAVE_OPENCV
    for (uint32_t i = 0; refocus_cv_filter_name(i); i++) {
        char name[80];

        snprintf(name, sizeof name, "OpenCV %s", refocus_cv_filter_name(i));
        time_way(&large, &map, name, 2, 0, i, out);
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
        fputs("usage: refocus-depth-quality [--time | --out FOLDER] SCENE_FOLDER...\n", stderr);
        return 2;
    }
    puts(timing ? "| scene | instructions | threads | CPU ms, least | median | wall ms, least | "
                  "median |\n| --- | --- | --: | --: | --: | --: | --: |"
                : "| scene | depth | true edges found within 1 px, % | found edges that are "
                  "true, % | error in smooth parts, 1/1000 | within 4 px of edges, 1/1000 | "
                  "PSNR, dB | to exact | edge PSNR, dB | to exact |\n"
                  "| --- | --- | --: | --: | --: | --: | --: | --: | --: | --: |");
    for (int i = timing ? 2 : pictures ? 3 : 1; i < argc && !failed; i++)
        failed = timing ? time_scene(argv[i]) : score_scene(argv[i], pictures);
    return failed ? 1 : 0;
}
