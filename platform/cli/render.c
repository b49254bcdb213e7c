/* refocus render */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands.h"
#include "engine.h"
#include "falsecolour.h"
#include "inputs.h"
#include "outputs.h"
#include "settings.h"
#include "shot.h"

enum view { VIEW_NONE, VIEW_DEPTH, VIEW_BLUR };

struct settings {
    struct depth_settings depth;
    struct lens_settings lens;
    struct engine_settings engine;
    const char *output, *load, *save;
    double region[4];
    int view;
};

static const char *view_name(uint32_t index)
{
    static const char *const names[] = {"none", "depth", "blur"};
    return index < 3 ? names[index] : NULL;
}

static const char *view_summary(uint32_t index)
{
    static const char *const summaries[] = {"the refocused photo", "the disparities",
                                            "the blur radii"};
    return index < 3 ? summaries[index] : NULL;
}

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    OUTPUT_OPTION(struct settings, output,
                  "the picture to write: .jpg, .png or .ppm; keeps the photo's EXIF data and "
                  "colour profile"),
    DEPTH_FILE_OPTION(struct settings, depth),
    DEPTH_UNIT_OPTIONS(struct settings, depth),
    REPAIR_OPTIONS(struct settings, depth),
    {.kind = OPTION_HEADING, .help = "Focus and blur"},
    FOCUS_OPTIONS(struct settings, lens),
    LENS_OPTIONS(struct settings, lens),
    CONTROL_OPTIONS(struct settings, engine.controls),
    BOKEH_OPTIONS(struct settings, engine.bokeh),
    {.kind = OPTION_HEADING, .help = "Rendering"},
    METHOD_OPTION(struct settings, engine),
    METHOD_OPTIONS(struct settings, engine),
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
     .help = "write a picture in false colours with a legend instead"},
    {.kind = OPTION_HEADING, .help = "Running"},
    SETTINGS_OPTIONS(struct settings, load, save),
    RUN_OPTIONS(struct settings, engine),
    PAPER_OPTIONS(struct settings, engine.papers),
    {.help = NULL},
};

static int check(const struct settings *settings, const char *photo)
{
    static const char *const endings[] = {".jpg", ".jpeg", ".png", ".ppm", NULL};
    const char *const inputs[] = {photo, settings->depth.file, settings->engine.aperture,
                                  settings->engine.papers.field_map,
                                  settings->engine.controls.focus_map,
                                  settings->engine.controls.sharp_mask, settings->load};
    int status;

    status = input_check_depth(&settings->depth);
    if (status == EXIT_DONE)
        status = input_check_lens(&settings->lens);
    if (status == EXIT_DONE)
        status = controls_check(&settings->engine.controls, !isnan(settings->lens.focus) ||
                                    !isnan(settings->lens.focus_at[0]) ||
                                    !isnan(settings->lens.focus_distance) ||
                                    !isnan(settings->lens.focus_rectangle[0]));
    if (status == EXIT_DONE && settings->view != VIEW_NONE && !isnan(settings->region[0]))
        status = report_failure(EXIT_WRONG, "--region",
                                "a view is always of the whole; leave --region or --view out");
    if (status == EXIT_DONE)
        status = output_check(settings->output, endings, inputs, 7);
    if (status == EXIT_DONE && settings->save)
        status = settings_check(settings->save, inputs, 6);
    return status;
}

/* The picture to render into: all of the photo or the region; plane[0] is the caller's. */
static int make_output(struct refocus_image *out, struct engine *engine,
                       const struct input *input, const struct settings *settings)
{
    const struct refocus_image *photo = &input->photo->image;
    const double *region = settings->region;
    int width = photo->width, height = photo->height;

    if (!isnan(region[0])) {
        if (region[2] < 1 || region[3] < 1 || region[0] + region[2] > width ||
            region[1] + region[3] > height)
            return report_failure(EXIT_WRONG, "--region",
                                  "%g,%g,%g,%g does not lie within the %dx%d pixels of %s",
                                  region[0], region[1], region[2], region[3], width, height,
                                  input->photo_name);
        engine->params.region_x = (int32_t)region[0];
        engine->params.region_y = (int32_t)region[1];
        engine->params.region_width = width = (int32_t)region[2];
        engine->params.region_height = height = (int32_t)region[3];
    }
    *out = refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, width, height,
                                (ptrdiff_t)width * 3);
    if ((uint64_t)width * 3 * (uint64_t)height <= SIZE_MAX)
        out->plane[0] = malloc((size_t)width * 3 * (size_t)height);
    if (!out->plane[0])
        return report_failure(EXIT_FAILED, input->photo_name,
                              "not enough memory for %dx%d pixels", width, height);
    return EXIT_DONE;
}

/* Replace the rendered picture by the layer of --view. */
static int make_view(struct refocus_image *out, const struct engine *engine,
                     const struct input *input, int view)
{
    const int width = out->width, height = out->height;
    const struct refocus_depth_range range = {input->report.near_m, input->report.far_m};
    const bool known = range.near_m > 0 && range.far_m > range.near_m;
    uint16_t *values = malloc((size_t)width * (size_t)height * sizeof *values);
    int status = values ? refocus_get_view(engine->renderer,
                                           view == VIEW_DEPTH ? REFOCUS_VIEW_DISPARITY
                                                              : REFOCUS_VIEW_BLUR,
                                           values, (ptrdiff_t)width * 2)
                        : REFOCUS_ERR_MEMORY;

    if (status == REFOCUS_OK) {
        free(out->plane[0]);
        *out = view == VIEW_DEPTH
                   ? falsecolour_depth(values, width, height, known ? &range : NULL)
                   : falsecolour_blur(values, width, height, engine->params.max_blur_radius);
        status = out->plane[0] ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    }
    free(values);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, "--view", "%s", refocus_strerror(status));
    return EXIT_DONE;
}

static int print_report(const struct settings *settings, const struct engine *engine,
                        const struct input *input, const struct refocus_image *out)
{
    if (settings->engine.json) {
        json_t *json = json_pack("{s:o, s:o, s:i, s:i, s:o}", "photo",
                                 report_text_json(input->photo_name), "output",
                                 report_text_json(settings->output), "width",
                                 (int)out->width, "height", (int)out->height, "depth",
                                 report_depth_json(input->depth_from, &input->report));
        json_t *run = engine_json(engine);

        if (json && json_object_update(json, run) != 0) {
            json_decref(json);
            json = NULL;
        }
        json_decref(run);
        return report_print_json(json);
    }
    if (settings->engine.repeat > 1) {
        printf("prepare %.2f ms, render %.2f ms (median of %.0f; %.2f to %.2f)\n",
               engine->prepare_ms, engine->render_ms.median, settings->engine.repeat,
               engine->render_ms.min, engine->render_ms.max);
        return report_end_output();
    }
    return EXIT_DONE;
}

static int render(struct shot *shot, struct refocus_image *out,
                  const struct settings *settings, const char *photo)
{
    const struct shot_settings wanted = {.depth = &settings->depth, .lens = &settings->lens,
                                         .engine = &settings->engine};
    int status = shot_open(shot, photo, &wanted);

    if (status == EXIT_DONE)
        status = make_output(out, &shot->engine, &shot->input, settings);
    if (status == EXIT_DONE)
        status = engine_render(&shot->engine, out, (int)settings->engine.repeat);
    if (status == EXIT_DONE && settings->view != VIEW_NONE)
        status = make_view(out, &shot->engine, &shot->input, settings->view);
    return status;
}

static int run(int argc, char **argv)
{
    struct settings settings = {.depth = DEPTH_SETTINGS_NONE,
                                .lens = LENS_SETTINGS_NONE,
                                .engine = ENGINE_SETTINGS_NONE(1),
                                .region = {NAN}};
    struct shot shot;
    struct refocus_image out = {0};
    const char *files[2];
    int status;

    status = options_parse(&render_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    settings.engine.bokeh.f_number = settings.lens.f_number;
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
    if (status == EXIT_DONE && settings.save)
        status = settings_save(&render_command, settings.save, &settings);
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
    .notes = "The blur radius of a pixel of disparity d is K |d - df| pixels: K is --blur, df "
             "the disparity in focus. The blur of a lens is K = s R (1/near - 1/far), s the "
             "focal length in pixels and R = focal length / 2N.\n"
             "Ctrl-C ends with status 1 and leaves what was at OUT as it was.",
    .options = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
