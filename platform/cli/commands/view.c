/* view.c: the command `refocus view` shows a viewfinder window for one photo. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "commands/view_module.h"
#include "commands/view_save.h"
#include "inputs/painted.h"
#include "line/interrupt.h"
#include "line/report.h"
#include "settings/settings.h"
#include "outputs/outputs.h"
#include "shot/shot.h"

struct settings {
    struct shot_settings shot;
    const char *output, *strokes;
    double size[2], seconds;
    bool fullscreen;
};

#define SETTINGS_NONE                                                                              \
    {                                                                                              \
        .shot = SHOT_SETTINGS_NONE, .size = {NAN, NAN}, .seconds = NAN                             \
    }

static const struct option options[] = {
    OUTPUT_OPTION(struct settings, output,
                  "the picture that 's' saves: " OUTPUT_PICTURES "; settings, depth and strokes "
                  "get names of it. Default: the photo's name with -refocused.jpg, here"),
    {.kind = OPTION_HEADING, .help = "Depth; without any it can be painted"},
    SHOT_DEPTH_OPTIONS(struct settings, shot),
    {.kind = OPTION_TEXT,
     .name = "--strokes",
     .argument = "FILE.json",
     .offset = offsetof(struct settings, strokes),
     .brief = "paint these strokes to begin with",
     .help = "paint these strokes to begin with: over the depth, or over nothing",
     .elsewhere = true},
    SHOT_LENS_OPTIONS(struct settings, shot),
    SHOT_METHOD_OPTIONS(struct settings, shot),
    {.kind = OPTION_HEADING, .help = "Running"},
    CONFIG_OPTIONS(struct settings, shot.config, shot.preset, "a look"),
    SETTINGS_OPTION(struct settings, shot.load),
    RUN_OPTIONS(struct settings, shot.engine),
    {.kind = OPTION_HEADING, .help = "Window"},
    {.kind = OPTION_NUMBERS,
     .name = "--size",
     .argument = "WxH",
     .offset = offsetof(struct settings, size),
     .least = 64,
     .greatest = 16384,
     .count = 2,
     .brief = "of the window",
     .help = "of the window; default: as large as the photo and the screen allow",
     .elsewhere = true},
    {.kind = OPTION_FLAG,
     .name = "--fullscreen",
     .offset = offsetof(struct settings, fullscreen),
     .brief = "the whole screen",
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
    SHOT_PAPER_OPTIONS(struct settings, shot),
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
        "{s:o, s:i, s:i, s:s, s:i, s:i, s:i, s:s, s:f, s:f, s:i, s:i, s:o, s:I}", "file",
        report_text_json(input->photo_name), "width", (int)input->photo->image->width, "height",
        (int)input->photo->image->height, "driver", report->driver, "window_width", report->width,
        "window_height", report->height, "reduction", report->reduction, "method",
        refocus_method_name(report->last.method), "focus", (double)report->last.focus, "blur",
        (double)report->last.blur, "strokes", report->strokes, "saved", saving->saved, "times",
        times, "peak_rss_kib", (json_int_t)report_peak_rss_kib()));
}

/* The setup of the window, and the part of it that the session's thread needs. */
struct viewing {
    struct settings settings;
    struct engine engine;
    struct input input;
    struct refocus_strokes *strokes; /* NULL: none to begin with */
    char *text;                      /* text of the settings */
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
    const uint16_t *disparity =
        v->strokes ? refocus_strokes_disparity(v->strokes) : v->input.disparity;
    const struct refocus_image *photo = v->input.photo->image;
    double blur = 0;
    int status = input_blur(&v->input, &shot->lens, &blur);

    params->render.max_blur_radius = (float)blur;
    if (status == EXIT_DONE)
        status = papers_place(&shot->engine.papers, params, photo->width, photo->height);
    if (status == EXIT_DONE)
        status = shot_aim(&v->input, &shot->lens, &v->engine.controls, disparity, params);
    if (status == EXIT_DONE)
        status = controls_check_method(params);
    if (status == EXIT_DONE)
        status = bokeh_check_method(params, v->engine.has_sides);
    state->blur = (float)blur;
    state->focus = params->render.focus_disparity;
    state->method = params->render.method;
    return status;
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

static int show(struct viewing *v, view_run_fn *run_window)
{
    static const char *const in_sight[] = {"--depth",    "--depth-unit",     "--focus",
                                           "--focus-at", "--focus-distance", "--focus-rectangle",
                                           "--blur",     "--method",         NULL};
    static const struct settings usual = SETTINGS_NONE;
    const struct settings *settings = &v->settings;
    const char *name = v->input.photo_name;
    struct view_saving saving = {.input = &v->input,
                                 .settings = save_settings,
                                 .of = v,
                                 .quiet = settings->shot.engine.json};
    struct rf_view_setup setup = {
        .title = name, .stop = interrupted, .fullscreen = settings->fullscreen};
    struct rf_view_report *const report = calloc(1, sizeof *report);
    char reason[256] = "";
    int status;

    v->text = settings_text(&view_command, settings, &usual, in_sight);
    if (!report || !v->text) {
        free(report);
        return report_failure(EXIT_FAILED, name, "not enough memory");
    }
    status = choose_state(v, &setup.state);
    setup.settings = v->text;
    setup.methods = suitable_methods(&v->engine);
    setup.session.photo = v->input.photo->image;
    setup.session.disparity = v->input.disparity;
    setup.session.matte = v->input.matte.samples ? &v->input.matte : NULL;
    setup.session.strokes = v->strokes;
    setup.session.params = v->engine.params;
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
                                "its name is too long to make others of it; give "
                                "--output");
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

/* The photo, its depth, all 0 where there is none, and the strokes over it. */
static int read_input(struct viewing *v, const char *photo)
{
    const struct depth_settings *depth = &v->settings.shot.depth;
    struct input *input = &v->input;
    int status = input_read(input, photo, depth);

    input->most_blur = REFOCUS_PLAIN_BLUR_RADIUS; /* keys change the method */
    if (status == EXIT_DONE && !input->disparity) {
        painted_begin(input, depth);
        input->disparity =
            calloc((size_t)input->width * (size_t)input->height, sizeof *input->disparity);
        if (!input->disparity)
            status = report_failure(EXIT_FAILED, photo, "not enough memory");
    }
    if (status == EXIT_DONE && v->settings.strokes)
        status = painted_open(input, v->settings.strokes, &v->strokes);
    return status;
}

static int open_photo(struct viewing *v, const char *photo)
{
    char why[256];
    view_run_fn *const run_window = view_module(why);
    int status;

    if (!run_window)
        return report_failure(EXIT_FAILED, photo, "%s", why);
    status = engine_begin(&v->engine, &v->settings.shot.engine);
    v->engine.name = photo;
    if (status == EXIT_DONE) {
        report_progress("reading", 0);
        status = read_input(v, photo);
        if (status == EXIT_DONE)
            status = show(v, run_window);
        report_progress_end();
    }
    refocus_strokes_destroy(&v->strokes);
    input_free(&v->input);
    engine_end(&v->engine);
    free(v->text);
    return status;
}

static int check(struct settings *settings, const char *photo)
{
    const char *inputs[SHOT_INPUTS + 1];
    int count = shot_inputs(&settings->shot, photo, inputs);
    int status = shot_check(&settings->shot, false);

    inputs[count++] = settings->strokes;
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
    int status = options_parse(&view_command, argc, argv, &viewing.settings, files);

    if (status != OPTIONS_PARSED)
        return status;
    status = check(&viewing.settings, files[0]);
    return status == EXIT_DONE ? open_photo(&viewing, files[0]) : status;
}

const struct command view_command = {
    .name = "view",
    .usage = "PHOTO [options]",
    .summary = "interactive window: tap to focus, change the aperture, paint depth",
    .notes = "Tap or click to focus; drag or turn the wheel for the aperture; ctrl and "
             "the wheel, or two fingers, to enlarge; drag with the right button to "
             "move. Keys: t focus, m method, d depth, k peaking, b before and after, p "
             "paint an object, a more of it, x less of it, o brush, g gradient, l a "
             "layer of the whole picture, f fill anew, 0 to 9, page up and page down "
             "the disparity to fill with, [ ] brush, u undo, home and end the size, s "
             "save the picture, j the settings, w depth and strokes, i shows the other "
             "settings, h keys, q quit.\n"
             "A tap is a new --focus-at: a plane of --tilt-angle then turns about it, "
             "and one of --focus-plane ends. What 's' saves is what render makes of "
             "the settings that 'j' saves.",
    .options = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
