/* render.c: the command `refocus render` refocuses photos, each by render_one.c. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "commands/commands.h"
#include "commands/many.h"
#include "commands/render_one.h"
#include "inputs/depth_options.h"
#include "inputs/standard_input.h"
#include "outputs/outputs.h"
#include "settings/settings.h"
#include "shot/shot_options.h"
#include "views/stereo_views.h"
#include "views/views.h"

/* All photos of a command line. */
struct batch {
    struct render_settings settings;
    struct many many;
    json_t *reports; /* for --json, in the order of the photos */
    int rendered;
};

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    OUTPUT_OPTION(
        struct render_settings, output,
        "the picture to write: " OUTPUT_PICTURES "; keeps what else the photo's file says: EXIF, "
        "colour profile and XMP, a JPEG also a JPEG's IPTC and comments, a PNG a PNG's chunks; "
        "OpenEXR, PPM and PFM keep nothing. A folder, or a name with {name}, {ext}, {n} (number) "
        "or the name of an option such as {f-number}, for several photos; --depth and "
        "--matte take {name}, too. - is standard output"),
    GROUP(keeping_options, struct render_settings, keep),
    {OPTION(OPTION_INTEGER, "--jobs", "N", struct render_settings, jobs), .elsewhere = true,
     .least = 1, .greatest = 256, .brief = "photos at a time",
     .help = "photos at a time; default one for each processor, fewer where they would take more "
             "than three quarters of the free memory"},
    GROUP(result_options, struct render_settings, result),
    GROUP(shot_depth_options, struct render_settings, shot),
    GROUP(behind_options, struct render_settings, shot.behind),
    GROUP(light_options, struct render_settings, shot.depth),
    GROUP(shot_lens_options, struct render_settings, shot),
    GROUP(shot_method_options, struct render_settings, shot),
    GROUP(strips_options, struct render_settings, shot.engine),
    {OPTION(OPTION_NUMBERS, "--region", "X,Y,W,H", struct render_settings, region), .least = 0,
     .greatest = REFOCUS_MAX_SIDE, .count = 4,
     .help = "render only this part of the picture, pixels"},
    {OPTION(OPTION_CHOICE, "--view", "WHAT", struct render_settings, view), .words = view_words,
     .omits_default = true, .help = "write a picture of how it is made instead"},
    {OPTION(OPTION_NUMBER, "--parallax", "PIXELS", struct render_settings, parallax), .least = 0,
     .greatest = STEREO_MOST,
     .help = "anaglyph: between the eyes at disparity 1 when 0 is in focus; default "
             "1/50 of the width"},
    {.kind = OPTION_HEADING, .help = "Running"},
    CONFIG_OPTIONS(struct render_settings, shot.config, shot.preset, "a look"),
    SETTINGS_OPTION(struct render_settings, shot.load),
    SAVE_SETTINGS_OPTION(struct render_settings, shot.save),
    GROUP(run_options, struct render_settings, shot.engine),
    GROUP(repeat_options, struct render_settings, shot.engine),
    GROUP(paper_options, struct render_settings, shot.engine),
    {.help = NULL},
};

/* Settle the options that do not depend on the photo. */
static int check_options(struct render_settings *settings)
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

/* The settings of one photo. */
static struct render_settings settings_of(const struct batch *batch, int index)
{
    const struct many_photo *photo = &batch->many.photos[index];
    struct render_settings settings = batch->settings;

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
    struct render_settings settings = settings_of(batch, index);

    settings.shot.save = NULL;
    if (!(settings.shot.engine.threads > 0))
        settings.shot.engine.threads = threads;
    return render_one(&settings, batch->many.photos[index].photo);
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
    const struct render_settings *settings = &batch->settings;
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
static int check_standard(struct render_settings *settings, const char *const *files, char name[16])
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
    struct render_settings *settings = &batch->settings;
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
        const struct render_settings one = settings_of(batch, i);

        status = render_check_files(&one, files[i], batch->many.count == 1);
    }
    if (status == EXIT_DONE)
        status = many_check(&batch->many);
    if (status != EXIT_DONE)
        return status;
    if (batch->many.count > 1 && (settings->shot.depth.right || settings->shot.depth.strokes))
        return report_failure(EXIT_WRONG, settings->shot.depth.right ? "--stereo" : "--strokes",
                              "it is for one photo; give that alone");
    if (batch->many.count > 1)
        return make_all(batch);
    *settings = settings_of(batch, 0);
    return render_one(settings, files[0]);
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
