/* render.c: the command `refocus render` refocuses one photo. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "shot/engine.h"
#include "inputs/inputs.h"
#include "outputs/outputs.h"
#include "settings/settings.h"
#include "shot/shot.h"
#include "views/stereo_views.h"
#include "views/views.h"

struct settings {
    struct shot_settings shot;
    const char *output;
    double region[4], parallax;
    int view;
};

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    OUTPUT_OPTION(struct settings, output,
                  "the picture to write: " OUTPUT_PICTURES "; keeps the photo's EXIF "
                  "data and colour profile"),
    SHOT_DEPTH_OPTIONS(struct settings, shot),
    BEHIND_OPTIONS(struct settings, shot.behind),
    SHOT_LENS_OPTIONS(struct settings, shot),
    SHOT_METHOD_OPTIONS(struct settings, shot),
    {.kind = OPTION_NUMBERS,
     .name = "--region",
     .argument = "X,Y,W,H",
     .offset = offsetof(struct settings, region),
     .least = 0,
     .greatest = REFOCUS_MAX_SIDE,
     .count = 4,
     .help = "render only this part of the picture, pixels"},
    {.kind = OPTION_CHOICE,
     .name = "--view",
     .argument = "WHAT",
     .offset = offsetof(struct settings, view),
     .choice = view_name,
     .summary = view_summary,
     .help = "write a picture of how it is made instead"},
    {.kind = OPTION_NUMBER,
     .name = "--parallax",
     .argument = "PIXELS",
     .offset = offsetof(struct settings, parallax),
     .least = 0,
     .greatest = STEREO_MOST,
     .help = "anaglyph: between the eyes at disparity 1 when 0 is in focus; default "
             "1/50 of the width"},
    {.kind = OPTION_HEADING, .help = "Running"},
    SETTINGS_OPTION(struct settings, shot.load),
    SAVE_SETTINGS_OPTION(struct settings, shot.save),
    RUN_OPTIONS(struct settings, shot.engine),
    REPEAT_OPTION(struct settings, shot.engine),
    SHOT_PAPER_OPTIONS(struct settings, shot),
    {.help = NULL},
};

static int check(struct settings *settings, const char *photo)
{
    const char *inputs[SHOT_INPUTS];
    const int count = shot_inputs(&settings->shot, photo, inputs);
    int status = shot_check(&settings->shot, false);

    if (status == EXIT_DONE && settings->view != VIEW_NONE && !isnan(settings->region[0]))
        status = report_failure(EXIT_WRONG, "--region",
                                "a view always shows the whole; leave --region or "
                                "--view out");
    if (status == EXIT_DONE && settings->view != VIEW_ANAGLYPH && !isnan(settings->parallax))
        status =
            report_failure(EXIT_WRONG, "--parallax", "goes with --view anaglyph; give that too");
    if (status == EXIT_DONE && settings->view != VIEW_NONE && settings->shot.behind.image)
        status = report_failure(EXIT_WRONG, "--behind", "no view shows it; leave it or --view out");
    if (status == EXIT_DONE)
        status = output_check(settings->output, OUTPUT_PICTURE, NULL, inputs, count);
    if (status == EXIT_DONE && settings->shot.save)
        status = settings_check(settings->shot.save, inputs, count);
    return status;
}

static int print_report(const struct settings *settings, const struct engine *engine,
                        const struct input *input, const struct refocus_image *out)
{
    if (settings->shot.engine.json) {
        json_t *json = json_pack(
            "{s:o, s:o, s:i, s:i, s:o, s:o, s:o}", "photo", report_text_json(input->photo_name),
            "output", report_text_json(settings->output), "width", (int)out->width, "height",
            (int)out->height, "depth", report_depth_json(input->depth_from, &input->report),
            "edges", edges_json(&engine->edges), "matte", input_matte_json(input));
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

static int render(struct shot *shot, struct refocus_image *out, const struct settings *settings,
                  const char *photo)
{
    int status = shot_open(shot, photo, &settings->shot, 0);

    if (status == EXIT_DONE)
        status = shot_output(shot, settings->region, out);
    if (status == EXIT_DONE)
        status = views_render(shot, out, settings->view, settings->parallax,
                              (int)settings->shot.engine.repeat);
    return status;
}

static int run(int argc, char **argv)
{
    struct settings settings = {.shot = SHOT_SETTINGS_NONE, .region = {NAN}, .parallax = NAN};
    struct shot shot;
    struct refocus_image out = {0};
    const char *files[2];
    int status;

    status = options_parse(&render_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    status = check(&settings, files[0]);
    if (status != EXIT_DONE)
        return status;
    status = render(&shot, &out, &settings, files[0]);
    if (status == EXIT_DONE) {
        report_progress("writing", 0.9);
        status = output_write_image(settings.output, &out,
                                    settings.view == VIEW_NONE ? shot.input.photo : NULL);
    }
    report_progress_end();
    if (status == EXIT_DONE && settings.shot.save)
        status = settings_save(&render_command, settings.shot.save, &settings);
    if (status == EXIT_DONE)
        status = print_report(&settings, &shot.engine, &shot.input, &out);
    free(out.plane[0]);
    shot_close(&shot);
    return status;
}

const struct command render_command = {
    .name = "render",
    .usage = "PHOTO -o OUT [options]",
    .summary = "refocus one photo",
    .notes = "The blur radius of a pixel of disparity d is K |d - df| pixels: K is "
             "--blur, df the disparity in focus. The blur of a lens is K = s R (1/near "
             "- 1/far), s the focal length in pixels and R = focal length / 2N.\n"
             "Ctrl-C ends with status 1 and leaves what was at OUT as it was.",
    .options = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
