/* bench.c: the command `refocus bench` times kernels and whole frames, and counts what rays hit.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bench/bench_frames.h"
#include "bench/bench_kernels.h"
#include "bench/bench_scene.h"
#include "bench/bench_rays.h"
#include "commands/commands.h"
#include "shot/engine.h"
#include "inputs/read_input.h"
#include "inputs/lens.h"
#include "inputs/depth_options.h"
#include "shot/shot_options.h"

struct settings {
    struct depth_settings depth;
    struct lens_settings lens;
    struct engine_settings engine;
    double size[2];
    bool statistics; /* --rays alone */
    bool frames, kernels;
};

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "What is rendered"},
    {OPTION(OPTION_NUMBERS, "--size", "WxH", struct settings, size), .least = 1,
     .greatest = REFOCUS_MAX_SIDE, .count = 2,
     .brief = "of the made-up scene without PHOTO; default 720x540",
     .help = "size of the made-up scene that is taken without PHOTO, default 720x540"},
    GROUP(depth_file_options, struct settings, depth),
    GROUP(depth_unit_options, struct settings, depth),
    GROUP(limit_options, struct settings, depth.limits),
    GROUP(focus_options, struct settings, lens),
    {.kind = OPTION_HEADING, .help = "How"},
    GROUP(method_options, struct settings, engine),
    GROUP(ray_options, struct settings, engine),
    QUALITY_OPTION(struct settings, engine.quality, "standard", NULL),
    GROUP(rendering_options, struct settings, engine),
    {OPTION(OPTION_FLAG, "--rays", NULL, struct settings, statistics),
     .brief = "what the rays of the mask hit, in place of times",
     .help = "without a number: no times, but what the rays of the mask hit: how many find a true "
             "intersection after 1, 2, ... tests of the search"},
    {OPTION(OPTION_FLAG, "--frames", NULL, struct settings, frames),
     .brief = "a table over blur, quality, threads and sizes",
     .help = "a table over blur, quality, threads and, without PHOTO or --size, sizes; in turns "
             "with a memcpy of the frame and a plain box blur of the same radius"},
    {OPTION(OPTION_FLAG, "--kernels", NULL, struct settings, kernels),
     .brief = "the loops that frames are made of",
     .help = "no frames, but the loops that they are made of: nanoseconds for a pixel or a ray "
             "sample, and those of plain C"},
    GROUP(run_options, struct settings, engine),
    GROUP(repeat_options, struct settings, engine),
    GROUP(paper_options, struct settings, engine),
    {.help = NULL},
};

static double megapixels(const struct scene *scene)
{
    return (double)scene->photo.width * scene->photo.height / 1e6;
}

static int print_report(const struct settings *settings, const struct engine *engine,
                        const struct scene *scene, const char *photo)
{
    const struct spread *times = &engine->render_ms;
    const struct refocus_settings *params = &engine->params;
    char rays[16] = "full";

    if (settings->engine.json) {
        json_t *json = json_pack("{s:o, s:i, s:i, s:i, s:f}", "photo",
                                 photo ? report_text_json(photo) : json_null(), "width",
                                 (int)scene->photo.width, "height", (int)scene->photo.height,
                                 "repeat", (int)settings->engine.repeat, "megapixels_per_second",
                                 megapixels(scene) * 1e3 / times->median);
        json_t *run = engine_json(engine);

        if (json && json_object_update(json, run) != 0) {
            json_decref(json);
            json = NULL;
        }
        json_decref(run);
        return report_print_json(json);
    }
    if (params->render.rays != REFOCUS_RAYS_FULL)
        snprintf(rays, sizeof rays, "%d", (int)params->render.rays);
    printf("%dx%d, %s, blur %.4g, focus %.3f, %s rays, %d threads, %s\n", (int)scene->photo.width,
           (int)scene->photo.height, refocus_method_name(params->render.method),
           (double)params->render.max_blur_radius, (double)params->render.focus_disparity, rays,
           (int)engine->info.threads, refocus_cpu_name(engine->info.cpu));
    printf("create   %9.2f ms   %.1f MiB\n", engine->create_ms,
           (double)engine->info.memory / (1 << 20));
    printf("prepare  %9.2f ms\n", engine->prepare_ms);
    printf("render   %9.2f ms   median of %.0f, %.2f to %.2f; %.2f megapixels a second\n",
           times->median, settings->engine.repeat, times->min, times->max,
           megapixels(scene) * 1e3 / times->median);
    return report_end_output();
}

static int check(const struct settings *settings, const char *photo, int argc, char **argv)
{
    static const char *const of_frames[] = {
        "--focus",   "--focus-at", "--focus-distance", "--focus-rectangle", "--blur",
        "--quality", NULL};
    static const char *const of_kernels[] = {"--kernels", "--cpu", "--json", NULL};
    int status = input_check_depth(&settings->depth);

    if (status == EXIT_DONE)
        status = input_check_lens(&settings->lens);
    if (status == EXIT_DONE && settings->frames)
        status = options_refuse(&bench_command, argc, argv, of_frames,
                                "the table of --frames has its own; leave it out");
    if (status == EXIT_DONE && settings->kernels)
        status = options_refuse_beside(&bench_command, argc, argv, of_kernels,
                                       "it does not go with --kernels; leave it out");
    if (status == EXIT_DONE && settings->kernels && (photo || settings->statistics))
        status = report_failure(EXIT_WRONG, "--kernels", "it takes no %s; leave one of them out",
                                photo ? "photo" : "--rays");
    if (status != EXIT_DONE)
        return status;
    if (settings->frames && settings->statistics)
        return report_failure(EXIT_WRONG, "--frames",
                              "it does not go with --rays without a number; leave one of them out");
    if (photo && !isnan(settings->size[0]))
        return report_failure(EXIT_WRONG, "--size",
                              "the photo has a size of its own; leave one of them out");
    if (!photo && (settings->depth.file || settings->depth.unit || !isnan(settings->depth.near_m) ||
                   !isnan(settings->depth.far_m) || !isnan(settings->lens.focus_distance)))
        return report_failure(EXIT_WRONG, "bench",
                              "--depth, --depth-unit, --near, --far and "
                              "--focus-distance go with a photo; give one");
    return EXIT_DONE;
}

static int count_rays(const struct engine *engine, const struct settings *settings,
                      const uint16_t *disparity, int width, int height)
{
    struct ray_statistics statistics;

    if (ray_statistics(&statistics, disparity, width, height, engine->params.render.focus_disparity,
                       engine->params.render.max_blur_radius, engine->aperture) != 0)
        return report_failure(EXIT_FAILED, "--rays", "not enough memory");
    if (settings->engine.json)
        return report_print_json(ray_statistics_json(&statistics));
    ray_statistics_print(&statistics);
    return report_end_output();
}

static int measure(struct engine *engine, const struct settings *settings, struct input *input,
                   const struct scene *scene)
{
    const int width = scene->photo.width, height = scene->photo.height;
    const struct refocus_disparity disparity = refocus_disparity16(
        scene->disparity, scene->map_width, scene->map_height, (ptrdiff_t)scene->map_width * 2);
    const struct refocus_scene taken = refocus_scene_default(&scene->photo, &disparity);
    const size_t pixels = (size_t)width * (size_t)height;
    struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, width, height, (ptrdiff_t)width * 3);
    uint16_t *prepared = malloc(pixels * 2);
    double blur = 0, focus = 0;
    int status;

    out.plane[0] = malloc(pixels * 3);
    status = prepared && out.plane[0] ? input_blur(input, &settings->lens, &blur)
                                      : report_failure(EXIT_FAILED, "bench", "not enough memory");
    if (status == EXIT_DONE)
        status = engine_create(engine, &settings->engine, width, height, blur);
    report_progress("preparing", 0.15);
    if (status == EXIT_DONE)
        status = engine_prepare(engine, &taken);
    if (status == EXIT_DONE) {
        refocus_get_view(engine->renderer, REFOCUS_VIEW_DISPARITY, prepared, (ptrdiff_t)width * 2);
        status = input_focus(input, &settings->lens, prepared, &focus);
        engine->params.render.focus_disparity = (float)focus;
    }
    if (status == EXIT_DONE && settings->statistics)
        status = count_rays(engine, settings, prepared, width, height);
    else if (status == EXIT_DONE)
        status = engine_render(engine, &out, (int)settings->engine.repeat);
    report_progress_end();
    free(prepared);
    free(out.plane[0]);
    return status;
}

/* --rays has a number everywhere, and here a meaning without one. Takes it out of
 * argv. */
static bool take_bare_rays(int *argc, char **argv)
{
    for (int i = 1; i < *argc && strcmp(argv[i], "--") != 0; i++) {
        const char *next = i + 1 < *argc ? argv[i + 1] : "-";

        if (strcmp(argv[i], "--rays") != 0 || strcmp(next, "full") == 0 ||
            strspn(next, "0123456789+.e") == strlen(next))
            continue;
        if (next[0] != '-' && strpbrk(next, "./") == NULL)
            continue; /* neither an option nor a file: let it be refused as a number */
        memmove(argv + i, argv + i + 1, sizeof *argv * (size_t)(*argc - i));
        --*argc;
        return true;
    }
    return false;
}

static int run(int argc, char **argv)
{
    struct settings settings = {.depth = DEPTH_SETTINGS_NONE,
                                .lens = LENS_SETTINGS_NONE,
                                .engine = ENGINE_SETTINGS_NONE(QUALITY_STANDARD, 5),
                                .size = {NAN, NAN}};
    struct engine engine;
    struct input input = {0};
    struct scene scene = {0};
    struct refocus_photo_info none = {.focus_x = -1, .focus_y = -1};
    struct refocus_photo made = {.image = &scene.photo, .info = &none};
    const char *files[2];
    int status;

    settings.depth.edges = EDGES_AS_GIVEN;
    settings.statistics = take_bare_rays(&argc, argv);
    status = options_parse(&bench_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    status = check(&settings, files[0], argc, argv);
    if (status != EXIT_DONE)
        return status;
    if (settings.kernels)
        return bench_kernels(&settings.engine);
    status = engine_begin(&engine, &settings.engine);
    if (status == EXIT_DONE && files[0]) {
        engine.name = files[0];
        status = input_read(&input, files[0], &settings.depth);
        input.most_blur = engine_most_blur(&settings.engine);
        if (status == EXIT_DONE) {
            scene.photo = *input.photo->image;
            scene.disparity = input.disparity;
            scene.map_width = input.width;
            scene.map_height = input.height;
        }
    } else if (status == EXIT_DONE) {
        engine.name = input.photo_name = input.depth_name = "made-up scene";
        status = bench_scene_make(&scene, isnan(settings.size[0]) ? 720 : (int)settings.size[0],
                                  isnan(settings.size[0]) ? 540 : (int)settings.size[1]);
        input.photo = &made;
    }
    if (status == EXIT_DONE && settings.frames)
        status = bench_frames(&settings.engine,
                              files[0] || !isnan(settings.size[0]) ? &scene : NULL, files[0]);
    else if (status == EXIT_DONE)
        status = measure(&engine, &settings, &input, &scene);
    if (status == EXIT_DONE && !settings.statistics && !settings.frames)
        status = print_report(&settings, &engine, &scene, files[0]);
    engine_end(&engine);
    if (files[0]) {
        input_free(&input);
    } else {
        bench_scene_free(&scene);
    }
    return status;
}

const struct command bench_command = {
    .name = "bench",
    .usage = "[PHOTO] [options]",
    .summary = "time whole frames",
    .notes = "Without PHOTO a made-up scene is rendered. The times are of preparing "
             "and rendering alone, without files, and of --repeat frames, default 5.",
    .table = options,
    .files_least = 0,
    .files_most = 1,
    .run = run,
};
