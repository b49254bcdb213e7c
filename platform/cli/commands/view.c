/* refocus view */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "shot/engine.h"
#include "inputs/inputs.h"
#include "line/interrupt.h"
#include "outputs/outputs.h"
#include "line/report.h"
#include "line/settings.h"
#include "commands/view_module.h"
#include "commands/view_save.h"

struct settings {
    struct depth_settings depth;
    struct lens_settings lens;
    struct engine_settings engine;
    const char *output, *load;
    double size[2], seconds;
    bool fullscreen;
};

static const struct option options[] = {
    OUTPUT_OPTION(
        struct settings, output,
        "the picture that 's' saves: .jpg, .png or .ppm; settings, depth and strokes "
        "get names of it. Default: the photo's name with -refocused.jpg, here"),
    {.kind = OPTION_HEADING, .help = "Depth; without any it can be painted"},
    DEPTH_FILE_OPTION(struct settings, depth),
    DEPTH_UNIT_OPTIONS(struct settings, depth),
    REPAIR_OPTIONS(struct settings, depth),
    {.kind = OPTION_HEADING, .help = "Focus and blur to begin with"},
    FOCUS_OPTIONS(struct settings, lens),
    LENS_OPTIONS(struct settings, lens),
    {.kind = OPTION_HEADING, .help = "Rendering"},
    METHOD_OPTION(struct settings, engine),
    METHOD_OPTIONS(struct settings, engine),
    RUN_OPTIONS(struct settings, engine),
    {.kind = OPTION_HEADING, .help = "Window"},
    {.kind = OPTION_TEXT,
     .name = SETTINGS_NAME,
     .argument = "FILE",
     .offset = offsetof(struct settings, load),
     .help = "JSON object of options to begin with, as 'j' saves it; the command line "
             "overrules "
             "it",
     .elsewhere = true},
    {.kind = OPTION_NUMBERS,
     .name = "--size",
     .argument = "WxH",
     .offset = offsetof(struct settings, size),
     .least = 64,
     .greatest = 16384,
     .count = 2,
     .help = "of the window; default: as large as the photo and the screen allow",
     .elsewhere = true},
    {.kind = OPTION_FLAG,
     .name = "--fullscreen",
     .offset = offsetof(struct settings, fullscreen),
     .help = "the whole screen",
     .elsewhere = true},
    {.kind = OPTION_NUMBER,
     .name = "--seconds",
     .argument = "S",
     .offset = offsetof(struct settings, seconds),
     .least = 0,
     .above = true,
     .greatest = 86400,
     .help = "close it after that time",
     .elsewhere = true},
    {.help = NULL},
};

static bool interrupted(void *unused)
{
    (void)unused;
    return interrupt_came();
}

static json_t *time_json(const struct rf_view_time *time)
{
    const bool shown = time->first_ms >= 0;

    return json_pack("{s:s, s:o, s:o, s:o}", "cause", time->cause, "first_ms",
                     report_number_json(shown ? time->first_ms : NAN), "first_cpu_ms",
                     report_number_json(shown ? time->first_cpu_ms : NAN), "full_ms",
                     report_number_json(time->full_ms < 0 ? NAN : time->full_ms));
}

static int print_report(const struct input *input, const struct rf_view_report *report,
                        const struct view_saving *saving)
{
    json_t *const times = json_array();

    for (int i = 0; i < report->count; i++)
        json_array_append_new(times, time_json(&report->times[i]));
    return report_print_json(json_pack(
        "{s:o, s:i, s:i, s:s, s:i, s:i, s:i, s:s, s:f, s:f, s:i, s:i, s:o, s:I}",
        "file", report_text_json(input->photo_name), "width",
        (int)input->photo->image.width, "height", (int)input->photo->image.height,
        "driver", report->driver, "window_width", report->width, "window_height",
        report->height, "reduction", report->reduction, "method",
        refocus_method_name(report->last.method), "focus", (double)report->last.focus,
        "blur", (double)report->last.blur, "strokes", report->strokes, "saved",
        saving->saved, "times", times, "peak_rss_kib",
        (json_int_t)report_peak_rss_kib()));
}

/* The options that make the same picture. */
static int save_settings(void *of, const struct refocus_render_params *lens,
                         const char *file)
{
    struct settings settings = *(const struct settings *)of;

    settings.lens = (struct lens_settings)LENS_SETTINGS_NONE;
    settings.lens.focus = (double)lens->focus_disparity;
    settings.lens.blur = (double)lens->max_blur_radius;
    settings.engine.method = (int)lens->method;
    settings.engine.sigma = lens->sigma < 1e30f ? (double)lens->sigma : INFINITY;
    return settings_save(&view_command, file, &settings);
}

static int choose_state(const struct input *input, const struct settings *settings,
                        struct rf_view_state *state)
{
    double blur, focus = 0;
    int status = input_blur(input, &settings->lens, &blur);

    if (status == EXIT_DONE && input->disparity)
        status = input_focus(input, &settings->lens, input->disparity, &focus);
    state->blur = (float)blur;
    state->focus = (float)focus;
    state->method = (uint32_t)settings->engine.method;
    return status;
}

static int show(struct settings *settings, struct engine *engine, struct input *input,
                view_run_fn *run_window)
{
    struct view_saving saving = {.input = input,
                                 .settings = save_settings,
                                 .of = settings,
                                 .quiet = settings->engine.json};
    struct rf_view_setup setup = {.title = input->photo_name,
                                  .stop = interrupted,
                                  .fullscreen = settings->fullscreen};
    struct rf_view_report *const report = calloc(1, sizeof *report);
    char reason[256] = "";
    int status;

    if (!report)
        return report_failure(EXIT_FAILED, input->photo_name, "not enough memory");
    setup.session.photo = &input->photo->image;
    setup.session.disparity = input->disparity;
    setup.session.params = engine->params;
    setup.session.sigma_of_sweep = isnan(settings->engine.sigma);
    setup.session.threads =
        isnan(settings->engine.threads) ? 0 : (int)settings->engine.threads;
    setup.session.cpu = (uint32_t)settings->engine.cpu;
    setup.session.save = view_save;
    setup.session.save_user = &saving;
    setup.width = isnan(settings->size[0]) ? 0 : (int)settings->size[0];
    setup.height = isnan(settings->size[1]) ? 0 : (int)settings->size[1];
    setup.quit_after_ms =
        isnan(settings->seconds) ? 0 : (int)(settings->seconds * 1000);
    status = choose_state(input, settings, &setup.state);
    if (status == EXIT_DONE &&
        !view_make_names(&saving.names, settings->output, input->photo_name))
        status = report_failure(EXIT_FAILED, input->photo_name,
                                "its name is too long to make "
                                "others of it; give --output");
    if (status == EXIT_DONE) {
        report_progress_end();
        if (run_window(&setup, report, reason) != REFOCUS_OK)
            status = report_failure(EXIT_FAILED, input->photo_name, "%s", reason);
        else if (saving.failed > 0)
            status = EXIT_FAILED;
        else if (settings->engine.json)
            status = print_report(input, report, &saving);
    }
    free(report);
    return status;
}

static int check_method(const struct settings *settings)
{
    const uint32_t without_memory = REFOCUS_METHOD_BIT(REFOCUS_METHOD_SWEEP) |
                                    REFOCUS_METHOD_BIT(REFOCUS_METHOD_SEARCH) |
                                    REFOCUS_METHOD_BIT(REFOCUS_METHOD_RAYTRACE) |
                                    REFOCUS_METHOD_BIT(REFOCUS_METHOD_JITTERED) |
                                    REFOCUS_METHOD_BIT(REFOCUS_METHOD_BLUR);

    if (without_memory & REFOCUS_METHOD_BIT(settings->engine.method))
        return EXIT_DONE;
    return report_failure(
        EXIT_WRONG, "--method",
        "'%s' is not for the window; give sweep, search, raytrace, jittered "
        "or blur",
        refocus_method_name((uint32_t)settings->engine.method));
}

static int open_photo(struct settings *settings, const char *photo)
{
    struct input input = {0};
    struct engine engine;
    char why[256];
    view_run_fn *const run_window = view_module(why);
    int status;

    if (!run_window)
        return report_failure(EXIT_FAILED, photo, "%s", why);
    status = engine_begin(&engine, &settings->engine);
    if (status == EXIT_DONE) {
        report_progress("reading", 0);
        status = input_read(&input, photo, &settings->depth);
        if (status == EXIT_DONE)
            status = show(settings, &engine, &input, run_window);
        report_progress_end();
    }
    input_free(&input);
    engine_end(&engine);
    return status;
}
static int run(int argc, char **argv)
{
    static const char *const endings[] = {".jpg", ".jpeg", ".png", ".ppm", NULL};
    struct settings settings = {.depth = DEPTH_SETTINGS_NONE,
                                .lens = LENS_SETTINGS_NONE,
                                .engine = ENGINE_SETTINGS_NONE(1),
                                .size = {NAN, NAN},
                                .seconds = NAN};
    const char *files[2] = {NULL};
    int status;

    status = options_parse(&view_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    settings.depth.full = settings.depth.optional = true;
    status = input_check_depth(&settings.depth);
    if (status == EXIT_DONE)
        status = input_check_lens(&settings.lens);
    if (status == EXIT_DONE)
        status = check_method(&settings);
    if (status == EXIT_DONE && settings.output) {
        const char *const inputs[] = {files[0], settings.depth.file,
                                      settings.engine.aperture};

        status = output_check(settings.output, endings, inputs, 3);
    }
    return status == EXIT_DONE ? open_photo(&settings, files[0]) : status;
}

const struct command view_command = {
    .name = "view",
    .usage = "PHOTO [options]",
    .summary = "interactive window: tap to focus, change the aperture, paint depth",
    .notes = "Tap or click to focus; drag or turn the wheel for the aperture; ctrl and "
             "the wheel, "
             "or two fingers, to enlarge; drag with the right button to move. Keys: t "
             "focus, m "
             "method, d depth, k peaking, b before and after, p paint an object, a "
             "more of it, x "
             "less of it, o brush, g gradient, l a layer of the whole picture, f fill "
             "anew, 0 to "
             "9, page up and page down the disparity to fill with, [ ] brush, u undo, "
             "home and "
             "end the size, s save the picture, j the settings, w depth and strokes, h "
             "keys, q "
             "quit.",
    .options = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
