/* info.c: the command `refocus info` tells what depth, lens and orientation data a file carries. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "commands/commands.h"
#include "commands/info_text.h"
#include "inputs/disparities.h"
#include "inputs/read_input.h"
#include "inputs/lens.h"
#include "inputs/limits.h"
#include "inputs/standard_input.h"
#include "inputs/unit.h"
#include "line/report.h"
#include "inputs/depth_options.h"

struct settings {
    bool json;
    struct depth_settings depth;
    struct lens_settings lens;
};

static const struct option options[] = {
    {OPTION(OPTION_FLAG, "--json", NULL, struct settings, json),
     .brief = "print it as one JSON object",
     .help = "print it as one JSON object; what is not known is null"},
    GROUP(depth_file_options, struct settings, depth),
    GROUP(depth_unit_options, struct settings, depth),
    GROUP(orient_depth_options, struct settings, depth),
    GROUP(repair_options, struct settings, depth),
    GROUP(limit_options, struct settings, depth.limits),
    {.kind = OPTION_HEADING, .help = "The lens whose depth of field is told"},
    GROUP(focus_options, struct settings, lens),
    GROUP(lens_options, struct settings, lens),
    {.help = NULL},
};

static int read_any(struct input *input, const char *file)
{
    struct refocus_reason reason = {""};
    const int status = standard_photo_or_map(&input->photo, file, &reason);

    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, file, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    input->photo_name = input->depth_name = file;
    input->depth_from = input->photo;
    input->report = refocus_depth_report_default();
    return EXIT_DONE;
}

static bool lens_is_given(const struct lens_settings *lens)
{
    return input_focus_is_given(lens) || !isnan(lens->blur) || !isnan(lens->f_number);
}

/* The edges of the map on the photo's, and the depth of field that it has then. */
static int measure_photo(struct input *input, const struct lens_settings *lens,
                         struct info_findings *found)
{
    const struct refocus_depth_map *map = input->photo->depth;
    const struct refocus_disparity given =
        refocus_disparity16(input->disparity, map->width, map->height, (ptrdiff_t)map->width * 2);
    uint16_t *placed = NULL;
    int status =
        edges_place(input->photo->image, &given, &placed, &input->edges, input->photo_name);

    if (status == EXIT_DONE)
        status = depth_of_field_find(input, lens, placed, &found->field);
    free(placed);
    return status;
}

/* The range of the depth map, its holes and its edges; a map of nothing but holes is worth
 * telling. */
static int measure_depth(struct input *input, const struct settings *settings,
                         struct info_findings *found)
{
    struct refocus_repair_params params = refocus_repair_params_default();
    struct refocus_depth_map *map = input->photo->depth;
    struct refocus_depth_report *report = &input->report;
    const uint64_t samples = (uint64_t)map->width * (uint64_t)map->height;
    int status = input_settle_embedded(input, &settings->depth);

    if (status != EXIT_DONE)
        return status;
    refocus_depth_set_invalid(map, settings->depth.invalid);
    params.speckle = (int32_t)settings->depth.speckle;
    found->unit_is_doubtful =
        unit_is_doubtful(input->photo, &settings->depth, false, found->unit_line);
    input->disparity = samples <= SIZE_MAX / 2 ? malloc((size_t)samples * 2) : NULL;
    status = input->disparity ? input_repair(input, map, &params, input->disparity, report)
                              : REFOCUS_ERR_MEMORY;
    if (status == REFOCUS_OK)
        return input->photo->image->plane[0] ? measure_photo(input, &settings->lens, found)
                                             : EXIT_DONE;
    if (status != REFOCUS_ERR_NO_DEPTH)
        return report_failure(EXIT_FAILED, input->photo_name, "the depth map: %s",
                              refocus_strerror(status));
    report->unknown = samples;
    return EXIT_DONE;
}

static int measure(struct input *input, const char *file, const struct settings *settings,
                   struct info_findings *found)
{
    int status = read_any(input, file);

    if (status == EXIT_DONE && input->photo->depth->samples)
        status = measure_depth(input, settings, found);
    if (status == EXIT_DONE && !found->field.known && lens_is_given(&settings->lens))
        status = report_failure(EXIT_FAILED, input->photo_name,
                                "it is no photo with depth, so that it has no depth of field; "
                                "leave focus and blur out");
    return status;
}

/* A photo and the map of --depth, read as they are rendered. */
static int measure_pair(struct input *input, const char *file, const struct settings *settings,
                        struct info_findings *found)
{
    struct depth_settings depth = settings->depth;
    int status;

    depth.full = true;
    depth.deep = DEEP_ALL; /* nothing is rendered, so that no bits are dropped */
    status = input_read(input, file, &depth);
    return status == EXIT_DONE
               ? depth_of_field_find(input, &settings->lens, input->disparity, &found->field)
               : status;
}

static int check(const struct settings *settings)
{
    if (!settings->depth.file && settings->depth.orient != ORIENT_AUTO)
        return report_failure(EXIT_WRONG, "--orient-depth",
                              "it turns the map of --depth; give that too");
    return input_check_lens(&settings->lens);
}

static int run(int argc, char **argv)
{
    struct settings settings = {.depth = DEPTH_SETTINGS_NONE, .lens = LENS_SETTINGS_NONE};
    struct info_findings found = {.unit_is_doubtful = false};
    struct input input = {.width = 0};
    const char *files[2];
    int status;

    status = options_parse(&info_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    status = input_check_depth(&settings.depth);
    if (status == EXIT_DONE)
        status = check(&settings);
    if (status == EXIT_DONE)
        status =
            (settings.depth.file ? measure_pair : measure)(&input, files[0], &settings, &found);
    if (status == EXIT_DONE && settings.json) {
        status = report_print_json(info_json(&input, &found));
    } else if (status == EXIT_DONE) {
        info_print(&input, &found);
        status = report_end_output();
    }
    input_free(&input);
    return status;
}

const struct command info_command = {
    .name = "info",
    .usage = "FILE|- [options]",
    .summary = "what depth, lens and orientation data a file carries, and why it is believed",
    .table = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
