/* refocus depth */
#include <stdio.h>
#include "commands.h"
#include "inputs.h"
#include "outputs.h"
#include "report.h"

struct settings {
    struct depth_settings depth;
    const char *output;
    bool json;
};

static const struct option options[] = {
    OUTPUT_OPTION(struct settings, output,
                  "the disparities to write, 1 = nearest: .png or .pgm of 16 bits (65535 = 1) "
                  "or .pfm of 32-bit floats"),
    DEPTH_UNIT_OPTIONS(struct settings, depth),
    {.kind = OPTION_FLAG,
     .name = "--json",
     .offset = offsetof(struct settings, json),
     .help = "print the report as one JSON object"},
    {.help = NULL},
};

static double percent(uint64_t part, const struct refocus_depth_map *map)
{
    return 100.0 * (double)part / ((double)map->width * map->height);
}

static int print_report(const struct settings *settings, const struct input *input)
{
    const struct refocus_depth_map *map = &input->depth_from->depth;
    const struct refocus_depth_report *report = &input->report;

    if (settings->json) {
        json_t *json = json_pack("{s:o, s:o, s:o}", "file",
                                 report_text_json(input->photo_name), "output",
                                 report_text_json(settings->output), "depth",
                                 report_depth_json(input->depth_from, report));
        return report_print_json(json);
    }
    printf("size     %dx%d\n", (int)map->width, (int)map->height);
    if (report->near_m > 0)
        printf("near     %.4g m\n", report->near_m);
    if (report->far_m > 0)
        printf("far      %.4g m\n", report->far_m);
    printf("filled   %llu samples without a value, %.1f %%\n",
           (unsigned long long)report->unknown, percent(report->unknown, map));
    printf("clamped  %llu samples beyond the range, %.1f %%\n",
           (unsigned long long)report->clamped, percent(report->clamped, map));
    return report_end_output();
}

static int run(int argc, char **argv)
{
    static const char *const endings[] = {".png", ".pgm", ".pfm", NULL};
    struct settings settings = {.depth = DEPTH_SETTINGS_NONE};
    struct input input = {0};
    const char *files[2];
    int status;

    status = options_parse(&depth_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    status = input_check_depth(&settings.depth);
    if (status == EXIT_DONE)
        status = output_check(settings.output, endings, files, 1);
    if (status != EXIT_DONE)
        return status;
    report_progress("reading", 0);
    status = input_read_depth(&input, files[0], &settings.depth);
    if (status == EXIT_DONE) {
        report_progress("writing", 0.7);
        status = output_write_gray16(settings.output, input.disparity,
                                     input.depth_from->depth.width,
                                     input.depth_from->depth.height);
    }
    report_progress_end();
    if (status == EXIT_DONE)
        status = print_report(&settings, &input);
    input_free(&input);
    return status;
}

const struct command depth_command = {
    .name = "depth",
    .usage = "FILE -o OUT [options]",
    .summary = "read the depth of a photo or a depth file, and write it as disparities",
    .notes = "FILE is a photo that carries depth, or a depth map. Samples without a value are "
             "filled from those around them, from the farther side where two surfaces meet, "
             "and counted.",
    .options = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
