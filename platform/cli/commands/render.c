/* render.c: the command `refocus render` refocuses one photo. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "commands/commands.h"
#include "commands/many.h"
#include "shot/engine.h"
#include "inputs/read_input.h"
#include "outputs/editable.h"
#include "inputs/standard_input.h"
#include "inputs/transfer.h"
#include "line/memory.h"
#include "outputs/outputs.h"
#include "outputs/result.h"
#include "settings/settings.h"
#include "shot/shot.h"
#include "shot/spool.h"
#include "shot/strips.h"
#include "views/stereo_views.h"
#include "views/views.h"
#include "inputs/depth_options.h"
#include "shot/shot_options.h"

/* Pictures of fewer rows stay in memory. */
enum { LEAST_SPOOLED = 1000 };

struct settings {
    struct shot_settings shot;
    const char *output;
    double region[4], parallax, jobs;
    int view;
    struct keep_settings keep;
    struct result_settings result;
};

/* All photos of a command line. */
struct batch {
    struct settings settings;
    struct many many;
    json_t *reports; /* for --json, in the order of the photos */
    int rendered;
};

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    OUTPUT_OPTION(
        struct settings, output,
        "the picture to write: " OUTPUT_PICTURES "; keeps what else the photo's file says: EXIF, "
        "colour profile and XMP, a JPEG also a JPEG's IPTC and comments, a PNG a PNG's chunks; "
        "OpenEXR, PPM and PFM keep nothing. A folder, or a name with {name}, {ext}, {n} (number) "
        "or the name of an option such as {f-number}, for several photos; --depth and "
        "--matte take {name}, too. - is standard output"),
    GROUP(keeping_options, struct settings, keep),
    {OPTION(OPTION_INTEGER, "--jobs", "N", struct settings, jobs), .elsewhere = true, .least = 1,
     .greatest = 256, .brief = "photos at a time",
     .help = "photos at a time; default one for each processor, fewer where they would take more "
             "than three quarters of the free memory"},
    GROUP(result_options, struct settings, result),
    GROUP(shot_depth_options, struct settings, shot),
    GROUP(behind_options, struct settings, shot.behind),
    GROUP(light_options, struct settings, shot.depth),
    GROUP(transfer_options, struct settings, shot.depth),
    GROUP(shot_lens_options, struct settings, shot),
    GROUP(shot_method_options, struct settings, shot),
    GROUP(strips_options, struct settings, shot.engine),
    {OPTION(OPTION_NUMBERS, "--region", "X,Y,W,H", struct settings, region), .least = 0,
     .greatest = REFOCUS_MAX_SIDE, .count = 4,
     .help = "render only this part of the picture, pixels"},
    {OPTION(OPTION_CHOICE, "--view", "WHAT", struct settings, view), .words = view_words,
     .help = "write a picture of how it is made instead"},
    {OPTION(OPTION_NUMBER, "--parallax", "PIXELS", struct settings, parallax), .least = 0,
     .greatest = STEREO_MOST,
     .help = "anaglyph: between the eyes at disparity 1 when 0 is in focus; default "
             "1/50 of the width"},
    {.kind = OPTION_HEADING, .help = "Running"},
    CONFIG_OPTIONS(struct settings, shot.config, shot.preset, "a look"),
    SETTINGS_OPTION(struct settings, shot.load),
    SAVE_SETTINGS_OPTION(struct settings, shot.save),
    GROUP(run_options, struct settings, shot.engine),
    GROUP(repeat_options, struct settings, shot.engine),
    GROUP(paper_options, struct settings, shot.engine),
    {.help = NULL},
};

static bool is_whole(const struct settings *settings)
{
    return settings->view == VIEW_NONE && isnan(settings->region[0]);
}

/* Settle the options that do not depend on the photo. */
static int check_options(struct settings *settings)
{
    int status = shot_check(&settings->shot, false);

    if (status == EXIT_DONE && settings->view != VIEW_NONE && !isnan(settings->region[0]))
        status = report_failure(EXIT_WRONG, "--region",
                                "a view always shows the whole; leave --region or --view out");
    if (status == EXIT_DONE && settings->view != VIEW_ANAGLYPH && !isnan(settings->parallax))
        status =
            report_failure(EXIT_WRONG, "--parallax", "goes with --view anaglyph; give that too");
    if (status == EXIT_DONE && settings->view != VIEW_NONE && settings->shot.behind.image)
        status = report_failure(EXIT_WRONG, "--behind", "no view shows it; leave it or --view out");
    if (status == EXIT_DONE && settings->view != VIEW_NONE && settings->shot.engine.in_strips)
        status = report_failure(EXIT_WRONG, "--low-memory",
                                "views need the whole photo; leave it or --view out");
    return status;
}

static int check_files(const struct settings *settings, const char *photo, bool alone)
{
    const char *inputs[SHOT_INPUTS];
    const int count = shot_inputs(&settings->shot, photo, inputs);
    int status = settings->result.standard
                     ? EXIT_DONE
                     : output_check(settings->output, OUTPUT_PICTURE, NULL, inputs, count);

    if (status == EXIT_DONE)
        status = keep_check(&settings->keep, settings->output, is_whole(settings));
    if (status == EXIT_DONE)
        status = result_check(&settings->result, settings->output, alone);
    if (status == EXIT_DONE && settings->shot.save)
        status = settings_check(settings->shot.save, inputs, count);
    return status;
}

static int print_report(const struct settings *settings, const struct engine *engine,
                        const struct input *input, const struct refocus_image *out)
{
    if (settings->shot.engine.json) {
        json_t *json = json_pack("{s:o, s:o, s:i, s:i, s:o, s:o, s:o, s:b}", "photo",
                                 report_text_json(input->photo_name), "output",
                                 report_text_json(settings->output), "width", (int)out->width,
                                 "height", (int)out->height, "depth",
                                 report_depth_json(input->depth_from, &input->report), "edges",
                                 edges_json(&engine->edges), "matte", input_matte_json(input),
                                 "gain_map", input->light != NULL);
        json_t *run = engine_json(engine);
        json_t *blur = input_blur_json(input, &settings->shot.lens);

        if (json && (json_object_update(json, run) != 0 || json_object_update(json, blur) != 0)) {
            json_decref(json);
            json = NULL;
        }
        json_decref(run);
        json_decref(blur);
        return report_print_json(json);
    }
    if (settings->shot.engine.repeat > 1) {
        printf("prepare %.2f ms, render %.2f ms (median of %.0f; %.2f to %.2f)\n",
               engine->prepare_ms, engine->render_ms.median, settings->shot.engine.repeat,
               engine->render_ms.min, engine->render_ms.max);
        return report_end_output();
    }
    return EXIT_DONE;
}

/* How much of a deep photo is taken: 8-bit pictures are made of dithered codes, which keeps
 * shallow gradients, unless there is light above white. */
static int deep_of(const struct settings *settings)
{
    const struct depth_settings *depth = &settings->shot.depth;

    if (settings->view != VIEW_NONE)
        return DEEP_NONE;
    return output_deep_format(settings->output) || depth->transfer || !isnan(depth->white) ||
                   depth->no_dither
               ? DEEP_ALL
               : DEEP_LIGHT;
}

static int render(struct shot *shot, struct refocus_image *out, const struct settings *settings,
                  const char *photo)
{
    const uint32_t deep = output_deep_format(settings->output);
    const struct refocus_image *const from = &shot->input.deep;
    int status = shot_open(shot, photo, &settings->shot, 0);
    /* With a gain map, a PNG has 8 bits as the photo has, and a PFM all the light. */
    const bool whole =
        from->plane[0] && deep && (!shot->input.light || deep == REFOCUS_FORMAT_RGB_FLOAT);

    if (status == EXIT_DONE)
        status = shot_output(shot, settings->region, whole ? deep : REFOCUS_FORMAT_RGB8, out);
    if (status == EXIT_DONE && settings->shot.engine.in_strips &&
        settings->shot.engine.repeat <= 1 && out->height >= LEAST_SPOOLED)
        shot->engine.spool = spool_open();
    if (status == EXIT_DONE && out->format == from->format && deep == REFOCUS_FORMAT_RGB16) {
        out->transfer = from->transfer; /* a PNG is of the photo's kind */
        out->white = from->white;
    }
    shot->engine.keeps_light = keep_has_light(&settings->keep, settings->output);
    if (status == EXIT_DONE)
        status = views_render(shot, out, settings->view, settings->parallax,
                              (int)settings->shot.engine.repeat);
    return status;
}

static int write_picture(const struct settings *settings, const struct shot *shot,
                         const struct refocus_image *out)
{
    struct editable editable = {.options = output_keeps(NULL)};
    int status = EXIT_DONE;

    if (settings->view == VIEW_NONE)
        status =
            keep_options(&settings->keep, &shot->input, &settings->shot.depth, settings->output,
                         is_whole(settings), &shot->engine.params.render, &editable);
    if (shot->engine.rendered.plane[0])
        editable.options.light = &shot->engine.rendered;
    return status == EXIT_DONE
               ? result_write(&settings->result, settings->output, out, editable.options)
               : status;
}

/* Once more, where the memory there is was too little. */
static int render_in_strips(struct shot *shot, struct refocus_image *out, struct settings *settings,
                            const char *photo)
{
    struct shot_settings *used = &settings->shot;

    shot_close(shot);
    report_warning(photo, "there is little memory: it is rendered in strips, as by --low-memory");
    used->engine.memory_kib = 0;
    used->engine.in_strips = true;
    strips_check(&used->engine, &used->depth, false);
    return render(shot, out, settings, photo);
}

/* Render a photo and write it. */
static int make(const struct settings *given, const char *photo)
{
    struct settings own = *given, *const settings = &own;
    struct shot_settings *used = &settings->shot;
    struct shot shot;
    struct refocus_image out = {0};
    int status;

    used->depth.deep = deep_of(settings);
    used->depth.light = settings->view == VIEW_NONE;
    if (settings->view == VIEW_NONE && !output_deep_format(settings->output) &&
        strips_suit(&used->engine, &used->depth, used->behind.image != NULL))
        used->engine.memory_kib = memory_free_kib() / 4 * 3; /* the rest is for the pictures */
    status = render(&shot, &out, settings, photo);
    if (status != EXIT_DONE && shot.engine.short_of_memory)
        status = render_in_strips(&shot, &out, settings, photo);
    if (status == EXIT_DONE && settings->view == VIEW_NONE)
        status = shot_rendered(&shot, &out);
    if (status == EXIT_DONE)
        status = result_resize(&settings->result, &out);
    if (status == EXIT_DONE) {
        report_progress("writing", 0.9);
        status = write_picture(settings, &shot, &out);
    }
    report_progress_end();
    if (status == EXIT_DONE && settings->shot.save)
        status = settings_save(&render_command, settings->shot.save, given);
    if (status == EXIT_DONE)
        status = print_report(settings, &shot.engine, &shot.input, &out);
    free(out.plane[0]);
    shot_close(&shot);
    return status;
}

/* The settings of one photo. */
static struct settings settings_of(const struct batch *batch, int index)
{
    const struct many_photo *photo = &batch->many.photos[index];
    struct settings settings = batch->settings;

    settings.output = photo->output;
    settings.shot.depth.file = photo->depth;
    settings.shot.depth.matte = photo->matte;
    return settings;
}

static const char *name_of(const void *of, int index)
{
    return ((const struct batch *)of)->many.photos[index].photo;
}

static int work(void *of, int index, int threads)
{
    const struct batch *batch = of;
    struct settings settings = settings_of(batch, index);

    settings.shot.save = NULL;
    if (!(settings.shot.engine.threads > 0))
        settings.shot.engine.threads = threads;
    return make(&settings, batch->many.photos[index].photo);
}

static void printed(void *of, int index, int status, FILE *output)
{
    struct batch *batch = of;
    json_t *report = status == EXIT_DONE ? json_loadf(output, 0, NULL) : NULL;

    if (report && json_array_set_new(batch->reports, (size_t)index, report) == 0)
        batch->rendered++;
}

/* A report on each photo, which is as good as failed until there is a better one. */
static json_t *begin_reports(const struct many *many)
{
    json_t *reports = json_array();

    for (int i = 0; reports && i < many->count; i++)
        json_array_append_new(
            reports, json_pack("{s:o, s:o, s:b}", "photo", report_text_json(many->photos[i].photo),
                               "output", report_text_json(many->photos[i].output), "failed", 1));
    return reports;
}

/* Several photos, each in a process of its own. */
static int make_all(struct batch *batch)
{
    const struct settings *settings = &batch->settings;
    const struct jobs jobs = {.count = batch->many.count,
                              .at_once = isnan(settings->jobs) ? 0 : (int)settings->jobs,
                              .of = batch,
                              .name = name_of,
                              .work = work,
                              .printed = settings->shot.engine.json ? printed : NULL};
    int status;

    if (settings->shot.engine.repeat > 1)
        return report_failure(EXIT_WRONG, "--repeat",
                              "it times one photo; give one, or leave it out");
    if (jobs.printed)
        batch->reports = begin_reports(&batch->many);
    status = jobs_run(&jobs);
    if (status == EXIT_DONE && settings->shot.save)
        status = settings_save(&render_command, settings->shot.save, settings);
    if (jobs.printed &&
        report_print_json(json_pack("{s:i, s:i, s:o}", "rendered", batch->rendered, "failed",
                                    jobs.count - batch->rendered, "photos", batch->reports)))
        status = EXIT_FAILED;
    return status;
}

/* Settle what goes from standard input or to standard output, which one photo alone can. `name`
 * receives the name that says the format. */
static int check_standard(struct settings *settings, const char *const *files, char name[16])
{
    const char *output = settings->output ? settings->output : "";

    for (int i = 0; files[1] && files[i]; i++)
        if (standard_is(files[i]) || standard_is(output))
            return report_failure(EXIT_WRONG, "-", "it stands for one photo; give that alone");
    if (!standard_is(output))
        return EXIT_DONE;
    if (settings->shot.engine.json || settings->shot.engine.repeat > 1)
        return report_failure(EXIT_WRONG, settings->shot.engine.json ? "--json" : "--repeat",
                              "standard output is the picture's; give -o a file");
    if (isatty(STDOUT_FILENO))
        return report_failure(EXIT_WRONG, "-o", "standard output is a terminal; send it to a file");
    settings->result.standard = true;
    snprintf(name, 16, "-.%s",
             settings->result.format ? result_format((uint32_t)settings->result.format)
                                     : standard_ending(files[0]));
    settings->output = name;
    return EXIT_DONE;
}

static int run_batch(struct batch *batch, const char *const *files)
{
    struct settings *settings = &batch->settings;
    const char *format =
        settings->result.format ? result_format((uint32_t)settings->result.format) : NULL;
    char name[16];
    int status = check_options(settings);

    if (status == EXIT_DONE)
        status = check_standard(settings, files, name);
    if (status == EXIT_DONE)
        status = many_name(&batch->many, &render_command, settings, files, settings->output, format,
                           settings->shot.depth.file, settings->shot.depth.matte);
    for (int i = 0; i < batch->many.count && status == EXIT_DONE; i++) {
        const struct settings one = settings_of(batch, i);

        status = check_files(&one, files[i], batch->many.count == 1);
    }
    if (status == EXIT_DONE)
        status = many_check(&batch->many);
    if (status != EXIT_DONE)
        return status;
    if (batch->many.count > 1 && settings->shot.depth.right)
        return report_failure(EXIT_WRONG, "--stereo", "it is for one photo; give that alone");
    if (batch->many.count > 1)
        return make_all(batch);
    *settings = settings_of(batch, 0);
    return make(settings, files[0]);
}

static int run(int argc, char **argv)
{
    struct batch batch = {.settings = {.shot = SHOT_SETTINGS_NONE,
                                       .region = {NAN},
                                       .parallax = NAN,
                                       .result = RESULT_SETTINGS_NONE,
                                       .jobs = NAN}};
    const char **files = calloc((size_t)argc + 1, sizeof *files);
    int status;

    if (!files)
        return report_failure(EXIT_FAILED, "render", "not enough memory");
    status = options_parse(&render_command, argc, argv, &batch.settings, files);
    if (status == OPTIONS_PARSED)
        status = run_batch(&batch, files);
    many_free(&batch.many);
    free(files);
    return status;
}

const struct command render_command = {
    .name = "render",
    .usage = "PHOTO... -o OUT [options]",
    .summary = "refocus photos",
    .notes = "The blur radius of a pixel of disparity d is K |d - df| pixels: K is "
             "--blur, df the disparity in focus. The blur of a lens is K = s R (1/near "
             "- 1/far), s the focal length in pixels and R = focal length / 2N.\n"
             "Several photos are rendered in processes of their own. One that fails is told in a "
             "line that begins with its name, and does not stop the others; the last line says how "
             "many were rendered, and the exit status is 1 when one has failed. Two photos never "
             "get one name: that is refused before anything is written.\n"
             "Ctrl-C ends with status 1 and leaves what was at OUT as it was.",
    .table = options,
    .files_least = 1,
    .files_most = INT_MAX,
    .run = run,
};
