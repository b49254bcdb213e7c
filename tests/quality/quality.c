/* quality.c: refocus-quality: how good the pictures are.
 *
 * Renders reference scenes through the public API and scores the result against the
 * pictures that a path tracer with a real thin lens made of the same scenes. */
#include <getopt.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#include "../clock.h"
#include "metrics.h"
#include "png_io.h"
#include "scene.h"
#include "settings.h"
#include "yuv.h"

enum { MAX_RUNS = 32 };

struct job {
    struct quality_settings run[MAX_RUNS];
    int runs;
    double blur;     /* only views of this K; < 0: all */
    int blades;      /* only views of this number of blades; < 0: all */
    int border;      /* < 0: K */
    const char *out; /* folder for pictures, or NULL */
    json_t *rows;    /* for --json, or NULL */
};

/* The view's aperture; *aperture stays NULL for a disc. */
static int make_aperture(const struct quality_view *view, struct refocus_aperture **aperture)
{
    *aperture = NULL;
    return view->blades ? refocus_aperture_create_polygon(aperture, view->blades, view->corner)
                        : REFOCUS_OK;
}

static int render_image(const struct quality_scene *scene, const struct quality_view *view,
                        const struct quality_settings *settings, const struct refocus_image *photo,
                        const struct refocus_image *out, double *ms)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(scene->width, scene->height, (float)view->blur);
    struct refocus_settings params = settings->render;
    const struct refocus_disparity disparity = refocus_disparity16(
        scene->disparity, scene->width, scene->height, 2 * (ptrdiff_t)scene->width);
    struct refocus_aperture *aperture = NULL;
    struct refocus_renderer *renderer = NULL;
    int status;

    limits.threads = settings->threads;
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHOD_BIT(settings->render.render.method);
    limits.cpu = (uint32_t)settings->cpu;
    limits.thin = settings->render.thin.enabled;
    if ((status = make_aperture(view, &aperture)) ||
        (status = refocus_renderer_create(&renderer, &limits)) ||
        (status = refocus_prepare(renderer, photo, &disparity)))
        goto done;
    params.render.focus_disparity = (float)view->focus;
    params.render.max_blur_radius = (float)view->blur;
    params.render.aperture = aperture;
    const double start = now_ms();
    status = refocus_render_settings(renderer, &params, out);
    *ms = now_ms() - start;
done:
    refocus_renderer_destroy(&renderer);
    refocus_aperture_destroy(&aperture);
    return status;
}

/* The photo as a camera would give it, and the result as a display would show it. */
static int render(const struct quality_scene *scene, const struct quality_view *view,
                  const struct quality_settings *settings, uint8_t *pixels, double *ms)
{
    const int w = scene->width, h = scene->height;
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, scene->photo, w, h, 3 * (ptrdiff_t)w);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, w, h, 3 * (ptrdiff_t)w);
    const int format = settings->format ? settings->format : settings->through;
    struct refocus_image in_yuv, out_yuv;
    uint8_t *memory;
    int status = REFOCUS_OK;

    *ms = 0;
    if (!format && !settings->input)
        return render_image(scene, view, settings, &photo, &out, ms);
    if (!format) {
        memcpy(pixels, scene->photo, 3 * (size_t)w * (size_t)h);
        return REFOCUS_OK;
    }
    memory = malloc(2 * refocus_image_bytes((uint32_t)format, w, h));
    if (!memory)
        return REFOCUS_ERR_MEMORY;
    in_yuv = refocus_image_planar((uint32_t)format, memory, w, h);
    out_yuv = refocus_image_planar((uint32_t)format,
                                   memory + refocus_image_bytes((uint32_t)format, w, h), w, h);
    yuv_from_rgb(&photo, &in_yuv);
    if (settings->input) {
        yuv_to_rgb(&in_yuv, &out);
    } else if (settings->format) {
        status = render_image(scene, view, settings, &in_yuv, &out_yuv, ms);
        if (status == REFOCUS_OK)
            yuv_to_rgb(&out_yuv, &out);
    } else {
        /* the photo is not needed any more: out may hold it, converted there and back */
        yuv_to_rgb(&in_yuv, &out);
        status = render_image(scene, view, settings, &out, &out, ms);
        yuv_from_rgb(&out, &out_yuv);
        yuv_to_rgb(&out_yuv, &out);
    }
    free(memory);
    return status;
}

/* The picture, and its error: the difference of each channel, times 4, about grey. */
static int write_pictures(const struct job *job, const char *scene, const char *file,
                          const char *label, const uint8_t *pixels, const uint8_t *reference,
                          int width, int height)
{
    const size_t size = 3 * (size_t)width * (size_t)height;
    const int stem = (int)(strlen(file) > 4 ? strlen(file) - 4 : 0);
    uint8_t *error = malloc(size);
    char path[1200];
    int result = -1;

    if (!error)
        return -1;
    for (size_t i = 0; i < size; i++) {
        const int value = 128 + 4 * (pixels[i] - reference[i]);
        error[i] = (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
    }
    snprintf(path, sizeof path, "%s/%s_%.*s_%s.png", job->out, scene, stem, file, label);
    if (png_io_write(path, pixels, width, height))
        goto done;
    snprintf(path, sizeof path, "%s/%s_%.*s_%s_error.png", job->out, scene, stem, file, label);
    result = png_io_write(path, error, width, height);
done:
    free(error);
    return result;
}

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static void report(const struct job *job, const char *scene, const struct quality_view *view,
                   const char *label, const struct quality_scores *s, double ms)
{
    if (!job->rows) {
        printf("%-11s %-22s %-20s %7.2f %7.2f %7.4f %7.2f %9.1f\n", scene, view->file, label,
               s->psnr, s->edge_psnr, s->ssim, s->rmse, ms);
        fflush(stdout);
        return;
    }
    json_array_append_new(
        job->rows,
        json_pack("{s:s, s:s, s:f, s:f, s:i, s:s, s:o, s:o, s:o, s:o, s:i, s:i, s:f}", "scene",
                  scene, "file", view->file, "focus", view->focus, "blur", view->blur, "blades",
                  view->blades, "run", label, "psnr", number(s->psnr), "edge_psnr",
                  number(s->edge_psnr), "ssim", number(s->ssim), "rmse", number(s->rmse), "pixels",
                  (int)s->pixels, "edge_pixels", (int)s->edge_pixels, "render_ms", ms));
}

/* Returns the picture to score a run against: an earlier run's, or the reference. */
static const uint8_t *standard(const struct job *job, int run, uint8_t *const *pictures,
                               const uint8_t *reference)
{
    for (int i = 0; i < run; i++) {
        if (!strcmp(job->run[i].label, job->run[run].against))
            return pictures[i];
    }
    return reference;
}

static int score_view(const struct job *job, const struct quality_scene *scene,
                      const struct quality_view *view)
{
    const size_t pixels = (size_t)scene->width * (size_t)scene->height;
    const int border = job->border < 0 ? (int)ceil(view->blur) : job->border;
    uint8_t *picture[MAX_RUNS] = {NULL};
    uint8_t *reference = quality_scene_reference(scene, view);
    uint8_t *mask = malloc(pixels);
    int result = -1;

    if (!reference || !mask ||
        quality_edge_mask(scene->disparity, scene->width, scene->height, view->focus, view->blur,
                          mask))
        goto done;
    for (int i = 0; i < job->runs; i++) {
        const struct quality_settings *run = &job->run[i];
        struct quality_scores scores;
        double ms;

        if (!(picture[i] = malloc(3 * pixels)))
            goto done;
        const int status = render(scene, view, run, picture[i], &ms);
        if (status) {
            fprintf(stderr, "refocus-quality: %s: %s: %s\n", view->file, run->label,
                    refocus_strerror(status));
            goto done;
        }
        const uint8_t *against = standard(job, i, picture, reference);
        if (quality_score(picture[i], against, scene->width, scene->height, border, mask, &scores))
            goto done;
        report(job, scene->name, view, run->label, &scores, ms);
        if (job->out && write_pictures(job, scene->name, view->file, run->label, picture[i],
                                       against, scene->width, scene->height))
            goto done;
    }
    result = 0;
done:
    for (int i = 0; i < job->runs; i++)
        free(picture[i]);
    free(reference);
    free(mask);
    return result;
}

static int score_scene(const struct job *job, const char *folder)
{
    struct quality_scene scene;
    int result = 0;

    if (quality_scene_read(&scene, folder))
        return -1;
    for (int i = 0; i < scene.views && !result; i++) {
        const struct quality_view *view = &scene.view[i];

        if ((job->blur < 0 || view->blur == job->blur) &&
            (job->blades < 0 || view->blades == job->blades))
            result = score_view(job, &scene, view);
    }
    quality_scene_free(&scene);
    return result;
}

static int score_pair(const struct job *job, const char *path_a, const char *path_b)
{
    int width, height, width_b, height_b, result = -1;
    uint8_t *a = png_io_read(path_a, 3, &width, &height);
    uint8_t *b = a ? png_io_read(path_b, 3, &width_b, &height_b) : NULL;
    const struct quality_view view = {.file = "pair"};
    struct quality_scores scores;

    if (!a || !b)
        goto done;
    if (width != width_b || height != height_b) {
        fprintf(stderr, "refocus-quality: %s: %d x %d, but %s is %d x %d\n", path_a, width, height,
                path_b, width_b, height_b);
        goto done;
    }
    result = quality_score(a, b, width, height, job->border < 0 ? 0 : job->border, NULL, &scores);
    if (!result)
        report(job, "", &view, "", &scores, 0);
    if (!result && job->out)
        result = write_pictures(job, "pair", "", "", a, b, width, height);
done:
    free(a);
    free(b);
    return result;
}

static void help(void)
{
    puts("usage: refocus-quality [options] --run LABEL:key=value,... SCENE_FOLDER...\n"
         "       refocus-quality --pair [options] A.png B.png\n\n"
         "Scores renderings of reference scenes: PSNR and RMSE of the 8-bit values, PSNR near\n"
         "depth edges, SSIM of the luma; all but a border of K pixels.\n\n"
         "  --run LABEL:SETTINGS  may be given up to 32 times; method=input is the floor\n"
         "  --blur K, --blades N  only these views\n"
         "  --border N            leave out N pixels at each side (default K; pair: 0)\n"
         "  --out FOLDER          write each picture, and its error x 4 about grey\n"
         "  --json                one JSON array instead of a table\n\n"
         "settings, as in struct refocus_settings:");
    quality_settings_help(stdout);
}

static int parse(struct job *job, int argc, char **argv, int *pair, int *json)
{
    static const struct option options[] = {
        {"run", required_argument, NULL, 'r'},
        {"blur", required_argument, NULL, 'k'},
        {"blades", required_argument, NULL, 'n'},
        {"border", required_argument, NULL, 'b'},
        {"out", required_argument, NULL, 'o'},
        {"json", no_argument, NULL, 'j'},
        {"pair", no_argument, NULL, 'p'},
        {"help", no_argument, NULL, 'h'},
        {0},
    };

    for (int c; (c = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        if (c == 'r' && job->runs == MAX_RUNS)
            return 2;
        if (c == 'r' && quality_settings_parse(&job->run[job->runs++], optarg))
            return 2;
        if (c == 'k')
            job->blur = atof(optarg);
        if (c == 'n')
            job->blades = atoi(optarg);
        if (c == 'b')
            job->border = atoi(optarg);
        if (c == 'o')
            job->out = optarg;
        *json |= c == 'j';
        *pair |= c == 'p';
        if (c == 'h') {
            help();
            exit(0);
        }
        if (c == '?')
            return 2;
    }
    if (*pair ? argc - optind != 2 : argc == optind || !job->runs) {
        fputs("refocus-quality: see refocus-quality --help\n", stderr);
        return 2;
    }
    return 0;
}

int main(int argc, char **argv)
{
    static struct job job = {.blur = -1, .blades = -1, .border = -1};
    int pair = 0, json = 0, failed = 0;
    const int bad = parse(&job, argc, argv, &pair, &json);

    if (bad)
        return bad;
    if (json)
        job.rows = json_array();
    else
        printf("%-11s %-22s %-20s %7s %7s %7s %7s %9s\n", "scene", "view", "run", "PSNR", "edge",
               "SSIM", "RMSE", "ms");
    if (pair)
        failed = score_pair(&job, argv[optind], argv[optind + 1]);
    for (int i = optind; i < argc && !pair && !failed; i++)
        failed = score_scene(&job, argv[i]);
    if (json && !failed) {
        json_dumpf(job.rows, stdout, JSON_INDENT(1) | JSON_REAL_PRECISION(8));
        putchar('\n');
    }
    json_decref(job.rows);
    return failed ? 1 : 0;
}
