/* view.c: the command `refocus view` shows a viewfinder window for one photo. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "commands/view_light.h"
#include "commands/view_save.h"
#include "inputs/depth_options.h"
#include "inputs/painted.h"
#include "line/interrupt.h"
#include "line/module.h"
#include "line/report.h"
#include "settings/settings.h"
#include "outputs/outputs.h"
#include "shot/shot.h"
#include "view/view.h"
#include "shot/shot_options.h"

struct settings {
    struct shot_settings shot;
    const char *output, *font;
    double size[2], dpi, seconds;
    bool fullscreen, page;
};

#define SETTINGS_NONE                                                                              \
    {                                                                                              \
        .shot = SHOT_SETTINGS_NONE, .size = {NAN, NAN}, .dpi = NAN, .seconds = NAN                 \
    }

static const struct option options[] = {
    OUTPUT_OPTION(struct settings, output,
                  "the picture that 's' saves: " OUTPUT_PICTURES "; settings and depth get "
                  "names of it. Default: the photo's name with -refocused.jpg, here"),
    {.kind = OPTION_HEADING, .help = "Depth"},
    GROUP(shot_depth_options, struct settings, shot),
    GROUP(light_options, struct settings, shot.depth),
    GROUP(shot_lens_options, struct settings, shot),
    GROUP(shot_method_options, struct settings, shot),
    {.kind = OPTION_HEADING, .help = "Running"},
    CONFIG_OPTIONS(struct settings, shot.config, shot.preset, "a look"),
    SETTINGS_OPTION(struct settings, shot.load),
    GROUP(run_options, struct settings, shot.engine),
    {.kind = OPTION_HEADING, .help = "Window"},
    {OPTION(OPTION_FLAG, "--page", NULL, struct settings, page),
     .brief = "the page of refocus serve in a browser",
     .help = "the page of 'refocus serve' in a browser in place of the window, with the options of "
             "that: the program that $BROWSER names opens it, or xdg-open; where there is neither, "
             "open the link that is printed. The port is a free one unless --port says which",
     .elsewhere = true},
    {OPTION(OPTION_NUMBERS, "--size", "WxH", struct settings, size), .least = 64, .greatest = 16384,
     .count = 2, .help = "of the window; default: as large as the photo and the screen allow",
     .elsewhere = true},
    {OPTION(OPTION_FLAG, "--fullscreen", NULL, struct settings, fullscreen),
     .brief = "the whole screen", .help = "the whole screen", .elsewhere = true},
    {OPTION(OPTION_TEXT, "--font", "FILE|none", struct settings, font),
     .help = "font of its text, TrueType or OpenType; default: DejaVu Sans, Noto Sans or "
             "Liberation Sans, where the system has them; without any the text is in the title",
     .elsewhere = true},
    {OPTION(OPTION_NUMBER, "--dpi", "N", struct settings, dpi), .least = 24, .greatest = 2400,
     .help = "of the screen, by which the text has its size; default: what the screen says, or 96",
     .elsewhere = true},
    {OPTION(OPTION_NUMBER, "--seconds", "S", struct settings, seconds), .least = 0, .above = true,
     .greatest = 86400, .help = "close it after that time", .elsewhere = true},
    GROUP(paper_options, struct settings, shot.engine),
    {.help = NULL},
};

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
        "{s:o, s:i, s:i, s:s, s:i, s:i, s:i, s:s, s:f, s:f, s:i, s:o, s:I}", "file",
        report_text_json(input->photo_name), "width", (int)input->photo->image->width, "height",
        (int)input->photo->image->height, "driver", report->driver, "window_width", report->width,
        "window_height", report->height, "reduction", report->reduction, "method",
        refocus_method_name(report->last.method), "focus", (double)report->last.focus, "blur",
        (double)report->last.blur, "saved", saving->saved, "times", times, "peak_rss_kib",
        (json_int_t)report_peak_rss_kib()));
}

/* The setup of the window, and the part of it that the session's thread needs. */
struct viewing {
    struct settings settings;
    struct engine engine;
    struct input input;
    struct view_light light;
    double f_number; /* the one that a blur of 1 pixel has; NAN: it is not known */
};

/* A tap is a new --focus-at: the plane of focus turns about its line, and one through
 * three points gives way to it. */
static void take_tap(struct controls *controls, const struct refocus_image *photo,
                     const struct rf_view_state *state)
{
    controls->focus_plane[0] = NAN;
    controls_turn_about(controls, photo,
                        fmin(fmax(floor(state->tap_y + 0.5), 0), photo->height - 1));
}

static void aim(void *of, const struct rf_view_state *state, struct refocus_settings *params)
{
    const struct viewing *v = of;
    const struct refocus_image *photo = v->input.photo->image;
    const struct refocus_disparity size = {.width = photo->width, .height = photo->height};
    struct controls controls = v->engine.controls;

    if (!isnan(v->engine.field_disparity))
        params->field.disparity = (float)v->engine.field_disparity;
    if (state->focus_tap == 0)
        return;
    take_tap(&controls, photo, state);
    params->focus.tilt_x = params->focus.tilt_y = 0.5f;
    params->focus.tilt_across = params->focus.tilt_down = 0;
    controls_aim(&controls, params, &size); /* a line within the photo needs no depth */
}

/* The options that make the same picture. */
static int save_settings(void *of, const struct rf_view_result *result, const char *file)
{
    const struct viewing *v = of;
    const struct refocus_settings *lens = result->params;
    struct settings settings = v->settings;
    struct control_settings *controls = &settings.shot.engine.controls;
    struct controls aimed = v->engine.controls;

    if (result->state->focus_tap > 0)
        take_tap(&aimed, v->input.photo->image, result->state);
    else if (!isnan(v->settings.shot.lens.focus_at[0]))
        controls_turn_about(&aimed, v->input.photo->image, v->settings.shot.lens.focus_at[1]);
    memcpy(controls->focus_plane, aimed.focus_plane, sizeof controls->focus_plane);
    memcpy(controls->tilt_line, aimed.tilt_line, sizeof controls->tilt_line);
    settings.shot.lens = (struct lens_settings)LENS_SETTINGS_NONE;
    if (isnan(controls->focus_plane[0]))
        settings.shot.lens.focus = (double)result->state->focus;
    settings.shot.lens.blur = (double)lens->render.max_blur_radius;
    settings.shot.engine.method = (int)lens->render.method;
    settings.shot.engine.sigma = lens->render.sigma < 1e30f ? (double)lens->render.sigma : INFINITY;
    return settings_save(&view_command, file, &settings);
}

/* The lens to begin with. */
static int choose_state(struct viewing *v, struct rf_view_state *state)
{
    const struct shot_settings *shot = &v->settings.shot;
    struct refocus_settings *params = &v->engine.params;
    const struct refocus_image *photo = v->input.photo->image;
    double blur = 0;
    int status = input_blur(&v->input, &shot->lens, &blur);

    params->render.max_blur_radius = (float)blur;
    if (status == EXIT_DONE)
        status = papers_place(&shot->engine.papers, params, photo->width, photo->height);
    if (status == EXIT_DONE)
        status = shot_aim(&v->input, &shot->lens, &v->engine.controls, v->input.disparity, params);
    if (status == EXIT_DONE)
        status = controls_check_method(params);
    if (status == EXIT_DONE)
        status = bokeh_check_method(params, v->engine.has_sides);
    state->blur = (float)blur;
    state->focus = params->render.focus_disparity;
    state->method = params->render.method;
    return status;
}

/* The f-number of a blur of 1 pixel, by one so small that its blur is not limited. */
static double f_number_of_pixel(const struct input *input, const struct lens_settings *lens)
{
    struct lens_settings small = *lens;
    double blur, number;

    small.blur = NAN;
    small.f_number = 64;
    if (!(input->report.near_m > 0 && input->report.far_m > input->report.near_m) ||
        input_blur_and_f_number(input, &small, &blur, &number) != EXIT_DONE)
        return NAN;
    return blur * number;
}

/* The lens in the words of photographers, as far as the depth has metres. */
static void describe(void *of, const struct rf_view_state *state, char *words, size_t size)
{
    const struct viewing *v = of;
    const struct refocus_depth_range range = {v->input.report.near_m, v->input.report.far_m};
    char focus[32], number[32] = "";

    snprintf(focus, sizeof focus, "%.3f", (double)state->focus);
    if (!isnan(v->f_number)) {
        const double metres = refocus_depth_of_disparity(&range, (double)state->focus);

        if (isinf(metres))
            snprintf(focus, sizeof focus, "\u221e");
        else
            snprintf(focus, sizeof focus, "%.3g m", metres);
        if (state->blur > 0)
            snprintf(number, sizeof number, " \u00b7 f/%.2g", v->f_number / (double)state->blur);
    }
    snprintf(words, size, "focus %s%s \u00b7 blur %.1f px", focus, number, (double)state->blur);
}

/* The methods that can do what the settings ask for. */
static uint32_t suitable_methods(const struct engine *engine)
{
    struct refocus_settings params = engine->params;
    uint32_t methods = 0;

    for (params.render.method = 0; params.render.method < REFOCUS_METHOD_COUNT;
         params.render.method++)
        if (controls_suit_method(&params) && bokeh_suits_method(&params, engine->has_sides))
            methods |= REFOCUS_METHOD_BIT(params.render.method);
    return methods;
}

typedef int view_run_fn(const struct rf_view_setup *setup, struct rf_view_report *report,
                        char *reason);

static int show(struct viewing *v, view_run_fn *run_window)
{
    const struct settings *settings = &v->settings;
    const char *name = v->input.photo_name;
    struct view_saving saving = {.input = &v->input,
                                 .settings = save_settings,
                                 .of = v,
                                 .quiet = settings->shot.engine.json};
    struct rf_view_setup setup = {.title = name,
                                  .font = settings->font,
                                  .dpi = isnan(settings->dpi) ? 0 : settings->dpi,
                                  .describe = describe,
                                  .describe_user = v,
                                  .stop = interrupt_cancels,
                                  .fullscreen = settings->fullscreen};
    struct rf_view_report *const report = calloc(1, sizeof *report);
    char reason[256] = "";
    int status;

    if (!report)
        return report_failure(EXIT_FAILED, name, "not enough memory");
    status = choose_state(v, &setup.state);
    v->f_number = f_number_of_pixel(&v->input, &settings->shot.lens);
    setup.methods = suitable_methods(&v->engine);
    setup.session.photo = v->input.photo->image;
    setup.session.disparity = v->input.disparity;
    setup.session.matte = v->input.matte.samples ? &v->input.matte : NULL;
    setup.session.params = v->engine.params;
    view_light_join(&v->light, &v->input, &setup.session);
    setup.session.still_rays = v->engine.still_rays;
    setup.session.aim = aim;
    setup.session.aim_user = v;
    setup.session.threads =
        isnan(settings->shot.engine.threads) ? 0 : (int)settings->shot.engine.threads;
    setup.session.cpu = (uint32_t)settings->shot.engine.cpu;
    setup.session.save = view_save;
    setup.session.save_user = &saving;
    setup.width = isnan(settings->size[0]) ? 0 : (int)settings->size[0];
    setup.height = isnan(settings->size[1]) ? 0 : (int)settings->size[1];
    setup.quit_after_ms = isnan(settings->seconds) ? 0 : (int)(settings->seconds * 1000);
    if (status == EXIT_DONE && !view_make_names(&saving.names, settings->output, name))
        status = report_failure(EXIT_FAILED, name,
                                "its name is too long to make others of it; give --output");
    if (status == EXIT_DONE) {
        report_progress_end();
        if (run_window(&setup, report, reason) != REFOCUS_OK)
            status = report_failure(EXIT_FAILED, name, "%s", reason);
        else if (saving.failed > 0)
            status = EXIT_FAILED;
        else if (settings->shot.engine.json)
            status = print_report(&v->input, report, &saving);
    }
    free(report);
    return status;
}

static int check_method(const struct engine_settings *settings)
{
    const uint32_t method = (uint32_t)settings->method;
    char words[METHOD_WORDS];

    if (!(refocus_method_traits(method) & REFOCUS_METHOD_WHOLE_PHOTO))
        return EXIT_DONE;
    return report_failure(EXIT_WRONG, "--method", "'%s' is not for the window; give %s",
                          refocus_method_name(method),
                          method_words(words, REFOCUS_METHOD_WHOLE_PHOTO, false));
}

/* The photo and its depth, or depth by strokes. */
static int read_input(struct viewing *v, const char *photo)
{
    const struct depth_settings *depth = &v->settings.shot.depth;
    struct input *input = &v->input;
    int status = input_read(input, photo, depth);

    input->most_blur = REFOCUS_PLAIN_BLUR_RADIUS; /* keys change the method */
    if (status != EXIT_DONE)
        return status;
    if (!input->disparity && !depth->strokes)
        return report_failure(EXIT_FAILED, photo,
                              "it carries no depth; give a depth map to --depth or MODEL.onnx to "
                              "--estimate, or paint it: 'refocus view --page PHOTO'");
    return painted_over(input, depth);
}

static int open_photo(struct viewing *v, const char *photo)
{
    static const struct module_function window = {
        "../view/refocus-view.so", "refocus/refocus-view.so", "rf_view_run", "the window", "SDL2"};
    view_run_fn *run_window;
    char why[MODULE_WHY];
    int status;

    if (!module_load(&window, &run_window, why))
        return report_failure(EXIT_FAILED, photo, "%s", why);
    status = engine_begin(&v->engine, &v->settings.shot.engine);
    v->engine.name = photo;
    if (status == EXIT_DONE) {
        report_progress("reading", 0);
        view_light_begin(&v->light, &v->engine, &v->settings.shot, v->settings.output);
        status = read_input(v, photo);
        if (status == EXIT_DONE)
            status = view_light_settle(&v->engine, &v->settings.shot, &v->input);
        if (status == EXIT_DONE)
            status = show(v, run_window);
        report_progress_end();
    }
    input_free(&v->input);
    engine_end(&v->engine);
    return status;
}

static int check(struct settings *settings, const char *photo)
{
    const char *inputs[SHOT_INPUTS + 1];
    int count = shot_inputs(&settings->shot, photo, inputs);
    int status = shot_check(&settings->shot, false);

    inputs[count++] = settings->font;
    settings->shot.depth.full = settings->shot.depth.optional = true;
    if (status == EXIT_DONE)
        status = check_method(&settings->shot.engine);
    if (status == EXIT_DONE && settings->output)
        status = output_check(settings->output, OUTPUT_PICTURE, NULL, inputs, count);
    return status;
}

static int run(int argc, char **argv)
{
    struct viewing viewing = {.settings = SETTINGS_NONE};
    const char *files[2] = {NULL};
    int status;

    /* The page takes the options of serve. */
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--page") == 0) {
            memmove(argv + i, argv + i + 1, (size_t)(argc - i) * sizeof *argv);
            return serve_in_browser(argc - 1, argv);
        }
    status = options_parse(&view_command, argc, argv, &viewing.settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    if (viewing.settings.page) /* by the configuration file */
        return serve_in_browser(argc, argv);
    status = check(&viewing.settings, files[0]);
    return status == EXIT_DONE ? open_photo(&viewing, files[0]) : status;
}

const struct command view_command = {
    .name = "view",
    .usage = "PHOTO [options]",
    .summary = "viewfinder: tap to focus, drag for the aperture",
    .notes = "Tap or click to focus; drag or turn the wheel for the aperture; ctrl and "
             "the wheel, or two fingers, to enlarge; drag with the right button to "
             "move. Keys: b before and after, d depth, k peaking: what is sharp, m next "
             "method, home and end the whole photo and pixel by pixel, s save the "
             "picture, j its settings, w the depth, h or ? shows the keys, q quit.\n"
             "A tap is a new --focus-at: a plane of --tilt-angle then turns about it, "
             "and one of --focus-plane ends. What 's' saves is what render makes of "
             "the settings that 'j' saves; the window shows --quality auto by 64 rays.",
    .table = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
