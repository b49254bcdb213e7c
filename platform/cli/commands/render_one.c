/* render_one.c: one photo is rendered and written as `refocus render` is asked to. */
#include <stdio.h>
#include <stdlib.h>
#include "commands/commands.h"
#include "commands/render_one.h"
#include "line/memory.h"
#include "outputs/outputs.h"
#include "settings/settings.h"
#include "shot/spool.h"
#include "shot/strips.h"
#include "views/views.h"

/* Pictures of fewer rows stay in memory. */
enum { LEAST_SPOOLED = 1000 };

static bool is_whole(const struct render_settings *settings)
{
    return settings->view == VIEW_NONE && isnan(settings->region[0]);
}

int render_check_files(const struct render_settings *settings, const char *photo, bool alone)
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

static int print_report(const struct render_settings *settings, const struct engine *engine,
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

static int render(struct shot *shot, struct refocus_image *out,
                  const struct render_settings *settings, const char *photo)
{
    int status = shot_open(shot, photo, &settings->shot, 0);

    if (status == EXIT_DONE)
        status = shot_output(shot, settings->region, settings->output, out);
    if (status == EXIT_DONE && settings->shot.engine.in_strips &&
        settings->shot.engine.repeat <= 1 && out->height >= LEAST_SPOOLED)
        shot->engine.spool = spool_open();
    shot->engine.keeps_light = keep_has_light(&settings->keep, settings->output);
    if (status == EXIT_DONE)
        status = views_render(shot, out, settings->view, settings->parallax,
                              (int)settings->shot.engine.repeat);
    return status;
}

static int write_picture(const struct render_settings *settings, const struct shot *shot,
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
static int render_in_strips(struct shot *shot, struct refocus_image *out,
                            struct render_settings *settings, const char *photo)
{
    struct shot_settings *used = &settings->shot;

    shot_close(shot);
    report_warning(photo, "there is little memory: it is rendered in strips, as by --low-memory");
    used->engine.memory_kib = 0;
    used->engine.in_strips = true;
    strips_check(&used->engine, &used->depth, false);
    return render(shot, out, settings, photo);
}

int render_one(const struct render_settings *given, const char *photo)
{
    struct render_settings own = *given, *const settings = &own;
    struct shot_settings *used = &settings->shot;
    struct shot shot;
    struct refocus_image out = {0};
    int status;

    if (settings->view == VIEW_NONE)
        shot_suit_output(&used->depth, settings->output);
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
