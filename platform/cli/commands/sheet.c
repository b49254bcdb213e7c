/* sheet.c: the command `refocus sheet` renders a contact sheet over focus, aperture or other
 * settings. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "outputs/outputs.h"
#include "line/report.h"
#include "settings/settings.h"
#include "commands/sheet_cells.h"
#include "commands/sheet_picture.h"
#include "shot/shot.h"
#include "inputs/depth_options.h"
#include "shot/shot_options.h"

struct settings {
    struct shot_settings shot;
    struct sheet_settings sheet;
    const char *output;
    double region[4];
};

#define LIST(name_, argument_, field_, brief_, help_)                                              \
    {                                                                                              \
        OPTION(OPTION_TEXT, name_, argument_, struct settings, sheet.field_), .brief = brief_,     \
                                                                              .help = help_        \
    }

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    OUTPUT_OPTION(struct settings, output, "the picture to write: " OUTPUT_PICTURES),
    GROUP(shot_depth_options, struct settings, shot),
    GROUP(behind_options, struct settings, shot.behind),
    GROUP(light_options, struct settings, shot.depth),
    {.kind = OPTION_HEADING, .help = "The sheet"},
    {OPTION(OPTION_CHOICE, "--kind", "WHAT", struct settings, sheet.kind),
     .words = sheet_kind_words, .brief = "what differs from cell to cell",
     .help = "what differs from cell to cell; default focus"},
    LIST("--focuses", "D,D...", focuses, "disparities in focus",
         "disparities in focus; default 0,0.25,0.5,0.75,1"),
    LIST("--blurs", "K,K...", blurs, "blur radii, pixels of the photo",
         "blur radii in pixels of the photo; default a quarter of --blur, half, and all of it"),
    LIST("--f-numbers", "N,N...", f_numbers, NULL, "in place of --blurs, as --f-number"),
    LIST("--apertures", "A,A...", apertures, NULL,
         "shapes as --aperture takes them; default a disc, polygons, a heart and a star"),
    LIST("--sigmas", "S,S...", sigmas, NULL, "as --sigma; default off,400,100,30"),
    {OPTION(OPTION_INTEGER, "--cell-width", "PIXELS", struct settings, sheet.cell_width),
     .least = 8, .greatest = 8192,
     .help = "width of a cell, at most that of the photo; default 320"},
    {OPTION(OPTION_NUMBERS, "--region", "X,Y,W,H", struct settings, region), .least = 0,
     .greatest = REFOCUS_MAX_SIDE, .count = 4,
     .help = "cells show only this part of the picture, pixels"},
    GROUP(shot_lens_options, struct settings, shot),
    GROUP(shot_method_options, struct settings, shot),
    {.kind = OPTION_HEADING, .help = "Running"},
    CONFIG_OPTIONS(struct settings, shot.config, shot.preset, NULL),
    SETTINGS_OPTION(struct settings, shot.load),
    SAVE_SETTINGS_OPTION(struct settings, shot.save),
    GROUP(run_options, struct settings, shot.engine),
    GROUP(paper_options, struct settings, shot.engine),
    {.help = NULL},
};

/* Options in whose place the sheet's own are; those of a file of settings are passed
 * over. */
static int check_lists(const struct sheet_settings *s, int argc, char **argv)
{
    const struct {
        bool holds;
        const char *options[5], *why;
    } rules[] = {
        {s->blurs != NULL,
         {"--blur", "--f-number"},
         "--blurs is in its place; leave one of them out"},
        {s->kind == SHEET_FOCUS,
         {"--focus", "--focus-at", "--focus-distance", "--focus-rectangle"},
         "--focuses is in its place; give that, or another --kind"},
        {s->kind == SHEET_APERTURE, {"--aperture"}, "--apertures is in its place; leave it out"},
        {s->kind == SHEET_BOKEH, {"--bokeh"}, "the sheet has a cell for each; leave it out"},
        {s->kind == SHEET_SIGMA,
         {"--sigma", "--blend"},
         "the sheet has cells for several; leave it out"},
    };
    int status = EXIT_DONE;

    for (size_t i = 0; i < sizeof rules / sizeof *rules && status == EXIT_DONE; i++)
        if (rules[i].holds)
            status = options_refuse(&sheet_command, argc, argv, rules[i].options, rules[i].why);
    return status;
}

static int check(struct settings *settings, const char *photo, int argc, char **argv)
{
    const char *inputs[SHOT_INPUTS];
    const int count = shot_inputs(&settings->shot, photo, inputs);
    struct shot_settings shot = settings->shot;
    int status = check_lists(&settings->sheet, argc, argv);

    if (status == EXIT_DONE && settings->sheet.f_numbers &&
        !(isnan(shot.lens.blur) && isnan(shot.lens.f_number)))
        status = report_failure(EXIT_WRONG, "--f-numbers",
                                "is in place of --blur and --f-number; leave them out");
    if (settings->sheet.f_numbers)
        shot.lens.f_number = 1; /* it stands for any: --focal-length goes with them
                                   too */
    if (status == EXIT_DONE)
        status = shot_check(&shot, false);
    if (!settings->sheet.f_numbers)
        settings->shot = shot;
    settings->shot.depth = shot.depth;
    if (status == EXIT_DONE)
        status = output_check(settings->output, OUTPUT_PICTURE, NULL, inputs, count);
    if (status == EXIT_DONE && settings->shot.save)
        status = settings_check(settings->shot.save, inputs, count);
    return status;
}

/* The part of the photo that a cell shows, untouched. */
static void take_photo(const struct refocus_image *photo, const struct refocus_settings *params,
                       const struct refocus_image *out)
{
    for (int y = 0; y < out->height; y++)
        memcpy(out->plane[0] + y * out->stride[0],
               photo->plane[0] + (params->render.region_y + y) * photo->stride[0] +
                   3 * params->render.region_x,
               (size_t)out->width * 3);
}

static int render_cell(struct shot *shot, const struct refocus_settings *usual,
                       const struct sheet_cell *cell, const struct refocus_image *out)
{
    struct refocus_settings *params = &shot->engine.params;
    int status;

    *params = *usual;
    if (cell->untouched) {
        take_photo(shot->input.photo->image, params, out);
        return EXIT_DONE;
    }
    if (!isnan(cell->focus))
        params->render.focus_disparity = (float)cell->focus;
    if (!isnan(cell->blur))
        params->render.max_blur_radius = (float)cell->blur;
    if (!isnan(cell->sigma))
        params->render.sigma = isinf(cell->sigma) ? 1e30f : (float)cell->sigma;
    if (cell->blend >= 0)
        params->render.blend = (uint32_t)cell->blend;
    if (cell->look) {
        params->render.aperture = cell->look->params.render.aperture;
        params->look.cat_eye = cell->look->params.look.cat_eye;
        params->look.fringe = cell->look->params.look.fringe;
        params->look.star_spikes = cell->look->params.look.star_spikes;
        shot->engine.has_sides = cell->look->has_sides;
    }
    status = shot_suit(shot);
    return status == EXIT_DONE ? engine_render(&shot->engine, out, 1) : status;
}

/* Size of a cell that shows `full` and is no wider than was asked for. */
static void cell_size(const struct refocus_image *full, double wanted, int *width, int *height)
{
    const int most = isnan(wanted) ? 320 : (int)wanted;

    *width = most < full->width ? most : full->width;
    *height = (int)(((int64_t)full->height * *width + full->width / 2) / full->width);
    *height = *height > 0 ? *height : 1;
}

static int make_cells(struct shot *shot, const struct sheet *sheet, const struct settings *settings,
                      struct refocus_image *picture)
{
    const struct refocus_settings usual = shot->engine.params;
    struct refocus_image full = {0};
    struct refocus_settings placed;
    const char *why = NULL;
    int width, height, status = shot_output(shot, settings->region, NULL, &full);

    if (status != EXIT_DONE)
        return status;
    placed = usual;
    placed.render.region_x = shot->engine.params.render.region_x;
    placed.render.region_y = shot->engine.params.render.region_y;
    placed.render.region_width = shot->engine.params.render.region_width;
    placed.render.region_height = shot->engine.params.render.region_height;
    cell_size(&full, settings->sheet.cell_width, &width, &height);
    *picture = sheet_picture(sheet, width, height, &why);
    if (!picture->plane[0])
        status = report_failure(EXIT_FAILED, settings->output, "%s", why);
    for (int i = 0; i < sheet->count && status == EXIT_DONE; i++) {
        report_progress("rendering", 0.3 + 0.6 * i / sheet->count);
        status = render_cell(shot, &placed, &sheet->cell[i], &full);
        if (status == EXIT_DONE)
            sheet_picture_put(picture, sheet, i, &full, width, height);
    }
    free(full.plane[0]);
    return status;
}

static int make(struct shot *shot, struct sheet *sheet, const char *photo,
                const struct settings *settings, struct refocus_image *picture)
{
    struct shot_settings wanted = settings->shot;
    int status;

    if (!isnan(sheet->least_f_number))
        wanted.lens.f_number = sheet->least_f_number;
    if (settings->sheet.kind == SHEET_FOCUS && !input_focus_is_given(&wanted.lens))
        wanted.lens.focus = 1; /* each cell has its own: none has to be found */
    shot_suit_output(&wanted.depth, NULL);
    status = shot_open(shot, photo, &wanted, isnan(sheet->most_blur) ? 0 : sheet->most_blur);
    if (status == EXIT_DONE)
        status = sheet_fill(sheet, &settings->sheet, &wanted.lens, &shot->input,
                            (double)shot->engine.params.render.max_blur_radius);
    if (status == EXIT_DONE)
        status = make_cells(shot, sheet, settings, picture);
    if (status == EXIT_DONE) {
        report_progress("writing", 0.9);
        status = output_write_image(settings->output, picture, NULL);
    }
    return status;
}

static int print_report(const struct settings *settings, const struct shot *shot,
                        const struct sheet *sheet, const struct refocus_image *picture)
{
    json_t *cells;

    if (!settings->shot.engine.json)
        return EXIT_DONE;
    cells = json_array();
    for (int i = 0; i < sheet->count && cells; i++)
        if (json_array_append_new(cells, report_text_json(sheet->cell[i].caption)) != 0) {
            json_decref(cells);
            cells = NULL;
        }
    return report_print_json(json_pack(
        "{s:o, s:o, s:i, s:i, s:s, s:i, s:o, s:s}", "photo",
        report_text_json(shot->input.photo_name), "output", report_text_json(settings->output),
        "width", (int)picture->width, "height", (int)picture->height, "kind",
        sheet_kind_words[settings->sheet.kind].name, "columns", sheet->columns, "cells", cells,
        "method", refocus_method_name(shot->engine.params.render.method)));
}

static int run(int argc, char **argv)
{
    struct settings settings = {
        .shot = SHOT_SETTINGS_NONE, .sheet = {.cell_width = NAN}, .region = {NAN}};
    struct sheet *sheet = NULL;
    struct refocus_image picture = {0};
    struct shot shot = {.engine = {.spool = -1}};
    const char *files[2];
    int status = options_parse(&sheet_command, argc, argv, &settings, files);

    if (status != OPTIONS_PARSED)
        return status;
    status = check(&settings, files[0], argc, argv);
    if (status != EXIT_DONE)
        return status;
    sheet = malloc(sizeof *sheet);
    if (!sheet)
        return report_failure(EXIT_FAILED, settings.output, "not enough memory");
    status = sheet_begin(sheet, &settings.sheet, &settings.shot.engine);
    if (status == EXIT_DONE)
        status = make(&shot, sheet, files[0], &settings, &picture);
    report_progress_end();
    if (status == EXIT_DONE && settings.shot.save)
        status = settings_save(&sheet_command, settings.shot.save, &settings);
    if (status == EXIT_DONE)
        status = print_report(&settings, &shot, sheet, &picture);
    free(picture.plane[0]);
    shot_close(&shot);
    sheet_end(sheet);
    free(sheet);
    return status;
}

const struct command sheet_command = {
    .name = "sheet",
    .usage = "PHOTO -o OUT [options]",
    .summary = "contact sheet over focus and aperture",
    .notes = "Lists have commas between their values, at most 16 of them. Each cell is rendered at "
             "full size and made smaller then: what it shows is what render makes.\n"
             "Ctrl-C ends with status 1 and leaves what was at OUT as it was.",
    .table = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
