/* depth.c: the command `refocus depth` makes, reads, repairs or enlarges a depth map. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "inputs/inputs.h"
#include "line/interrupt.h"
#include "inputs/made.h"
#include "outputs/outputs.h"
#include "inputs/painted.h"
#include "commands/depth_stack.h"
#include "line/report.h"

enum view { VIEW_NONE, VIEW_DISPARITY, VIEW_CONFIDENCE };

struct settings {
    struct depth_settings depth;
    double focus_at[2], blur;
    const char *output, *model, *strokes;
    struct network_settings network;
    int view;
    struct stereo_settings stereo;
    struct stack_settings stack;
    bool side_by_side;
    bool json;
};

static const char *view_name(uint32_t index)
{
    static const char *const names[] = {"none", "disparity", "confidence"};

    return index < sizeof names / sizeof *names ? names[index] : NULL;
}

static const char *view_summary(uint32_t index)
{
    static const char *const words[] = {"the disparities as they are",
                                        "their picture, bright = near",
                                        "white where measured, black where filled"};

    return index < sizeof words / sizeof *words ? words[index] : NULL;
}

static const struct option options[] = {
    OUTPUT_OPTION(struct settings, output,
                  "the disparities to write, 1 = nearest: .png, .tif or .pgm of 16 bits "
                  "(65535 = 1) or .pfm of 32-bit floats; or a .jpg: the JPEG photo, "
                  "every byte of it, with the depth inside as GDepth"),
    DEPTH_FILE_OPTION(struct settings, depth),
    DEPTH_UNIT_OPTIONS(struct settings, depth),
    ORIENT_DEPTH_OPTION(struct settings, depth),
    REPAIR_OPTIONS(struct settings, depth),
    LIMIT_OPTIONS(struct settings, depth.limits),
    {.kind = OPTION_FLAG,
     .name = "--full",
     .offset = offsetof(struct settings, depth.full),
     .brief = "bring the depth to the photo's size, edge on edge",
     .help = "bring the depth to the photo's size, its edges on the photo's"},
    {.kind = OPTION_CHOICE,
     .name = "--depth-edges",
     .argument = "HOW",
     .offset = offsetof(struct settings, depth.edges),
     .choice = edges_name,
     .summary = edges_summary,
     .help = "the edges of the depth map",
     .needs = "--full"},
    {.kind = OPTION_CHOICE,
     .name = "--upsample",
     .argument = "HOW",
     .offset = offsetof(struct settings, depth.upsample),
     .choice = upsample_name,
     .help = "how --full does it, before --depth-edges: by the library (default), or by filters "
             "of OpenCV, the last three by its module refocus-ximgproc",
     .needs = "--full,--strokes"},
    ESTIMATE_OPTIONS(struct settings, model, network, "depth of the one photo, by a network"),
    {.kind = OPTION_TEXT,
     .name = "--strokes",
     .argument = "FILE.json",
     .offset = offsetof(struct settings, strokes),
     .brief = "paint these strokes",
     .help = "paint these strokes: over nothing, or over the depth of --depth, "
             "--estimate or a stereo pair"},
    STACK_OPTIONS(struct settings, stack),
    STEREO_FILE_OPTION(struct settings, stereo, "FILE holds both pictures of a stereo pair"),
    {MATCH_OPTION(struct settings, stereo, "how a stereo pair is matched")},
    {PAIR_ORDER_OPTION(struct settings, stereo)},
    {.kind = OPTION_FLAG,
     .name = "--side-by-side",
     .offset = offsetof(struct settings, side_by_side),
     .brief = "FILE holds a stereo pair, the left picture left",
     .help = "FILE holds both pictures of a stereo pair, the left one left"},
    {.kind = OPTION_CHOICE,
     .name = "--view",
     .argument = "WHAT",
     .offset = offsetof(struct settings, view),
     .choice = view_name,
     .summary = view_summary,
     .brief = "write a picture to look at instead",
     .help = "write an 8-bit picture to look at instead: " OUTPUT_PICTURES},
    {.kind = OPTION_NUMBERS,
     .name = "--focus-at",
     .argument = "X,Y",
     .offset = offsetof(struct settings, focus_at),
     .least = 0,
     .greatest = REFOCUS_MAX_SIDE,
     .count = 2,
     .help = "for a .jpg: the pixel in focus when it is opened again; default: what "
             "the photo says"},
    {.kind = OPTION_NUMBER,
     .name = "--blur",
     .argument = "K",
     .offset = offsetof(struct settings, blur),
     .least = 0,
     .greatest = REFOCUS_MAX_BLUR_RADIUS,
     .help = "for a .jpg, with --focus-at: the blur radius of disparity 0 when 1 is in "
             "focus"},
    {.kind = OPTION_FLAG,
     .name = "--json",
     .offset = offsetof(struct settings, json),
     .brief = "print a report as one JSON object",
     .help = "print the report as one JSON object"},
    {.help = NULL},
};

static double percent(uint64_t part, const struct refocus_depth_map *map)
{
    return 100.0 * (double)part / ((double)map->width * map->height);
}

/* The way the depth was made, as the lines of text say it. */
static json_t *with_evidence(json_t *json, const struct refocus_photo_info *info)
{
    json_t *lines = info->evidence_count ? json_array() : NULL;

    for (int i = 0; lines && i < info->evidence_count; i++)
        json_array_append_new(lines, report_text_json(info->evidence[i]));
    if (lines && json_object_set_new(json, "evidence", lines)) {
        json_decref(json);
        return NULL;
    }
    return json;
}

/* The findings of a focus stack, in the words of struct refocus_stack_result; null: it is none.
 */
static json_t *stack_json(const struct refocus_stack_result *stack)
{
    json_t *order;

    if (stack->struct_size == 0)
        return json_null();
    order = json_array();
    for (int i = 0; order && i < REFOCUS_STACK_MOST_FRAMES && stack->order[i]; i++)
        json_array_append_new(order, json_integer(stack->order[i]));
    return json_pack("{s:i, s:o, s:f, s:f, s:b, s:f, s:f, s:f, s:f, s:f, s:f}", "reference",
                     (int)stack->reference, "order", order, "order_margin",
                     (double)stack->order_margin, "direction", (double)stack->direction, "by_rows",
                     stack->by_rows != 0, "measured", (double)stack->measured, "moved",
                     (double)stack->moved, "moving", (double)stack->moving, "alike",
                     (double)stack->alike, "disorder", (double)stack->disorder, "blur",
                     (double)stack->blur);
}

static int print_report(const struct settings *settings, const struct input *input)
{
    const struct refocus_depth_map *map = input->depth_from->depth;
    const struct refocus_depth_report *report = &input->report;

    if (settings->json) {
        json_t *json = json_pack(
            "{s:o, s:o, s:i, s:i, s:o, s:o, s:o}", "file", report_text_json(input->photo_name),
            "output", report_text_json(settings->output), "width", input->width, "height",
            input->height, "depth", report_depth_json(input->depth_from, report), "edges",
            edges_json(&input->edges), "stack", stack_json(&input->stack));
        return report_print_json(with_evidence(json, &input->made_info));
    }
    printf("size     %dx%d\n", input->width, input->height);
    if (report->near_m > 0)
        printf("near     %.4g m\n", report->near_m);
    if (report->far_m > 0)
        printf("far      %.4g m\n", report->far_m);
    printf("filled   %llu samples without a value, %.1f %%\n", (unsigned long long)report->unknown,
           percent(report->unknown, map));
    if (settings->depth.speckle > 1)
        printf("specks   %llu samples in small patches, filled too, %.1f %%\n",
               (unsigned long long)report->specks, percent(report->specks, map));
    if (report->strays > 0)
        printf("strays   %llu samples far nearer than all others, filled too\n",
               (unsigned long long)report->strays);
    for (int i = 0; i < input->made_info.evidence_count; i++)
        printf("because  %s\n", input->made_info.evidence[i]);
    printf("clamped  %llu samples beyond the range, %.1f %%\n", (unsigned long long)report->clamped,
           percent(report->clamped, map));
    return report_end_output();
}

/* A grey picture of the disparities or of what is known of them. */
static int write_view(const struct settings *settings, const struct input *input)
{
    const bool known = settings->view == VIEW_CONFIDENCE;
    const int width = known ? input->depth_from->depth->width : input->width;
    const int height = known ? input->depth_from->depth->height : input->height;
    const size_t pixels = (size_t)width * (size_t)height;
    uint8_t *rgb = pixels <= SIZE_MAX / 3 ? malloc(3 * pixels) : NULL;
    int status;

    if (!rgb)
        return report_failure(EXIT_FAILED, settings->output, "not enough memory");
    for (size_t i = 0; i < 3 * pixels; i++)
        rgb[i] = known ? input->confidence[i / 3] : (uint8_t)(input->disparity[i / 3] >> 8);

    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, width, height, 3 * (ptrdiff_t)width);
    status = output_write_image(settings->output, &image, NULL);
    free(rgb);
    return status;
}

/* Disparity at a point, 0..1 of the upright photo. */
static double disparity_at(const struct input *input, double x, double y)
{
    const int column = (int)fmin(x * input->width, input->width - 1);
    const int row = (int)fmin(y * input->height, input->height - 1);

    return input->disparity[(size_t)row * (size_t)input->width + (size_t)column] / 65535.0;
}

/* The focus to be saved: that of the options, else that of the photo. */
static int settle_focus(const struct settings *settings, const struct input *input,
                        struct refocus_depth_write *depth)
{
    const struct refocus_image *photo = input->photo->image;
    const struct refocus_photo_info *info = input->photo->info;
    const double larger = photo->width > photo->height ? photo->width : photo->height;
    const double x = settings->focus_at[0], y = settings->focus_at[1];
    double d;

    if (isnan(x)) {
        if (info->focus_x > 0 || info->focus_y > 0) {
            depth->focus_x = info->focus_x;
            depth->focus_y = info->focus_y;
        }
        depth->focus_distance = info->focus_distance;
        depth->blur_at_infinity = info->blur_at_infinity;
        if (info->own_blur > 0 && info->focus_x >= 0 && input->photo->depth->near_m <= 0) {
            /* No metres: they are not written, and 0 is taken for infinity then. */
            depth->focus_distance = 0;
            depth->blur_at_infinity =
                info->own_blur * disparity_at(input, info->focus_x, info->focus_y);
        }
        return EXIT_DONE;
    }
    if (x >= photo->width || y >= photo->height)
        return report_failure(EXIT_WRONG, "--focus-at",
                              "%g,%g lies outside of %s; give 0,0 to %d,%d", x, y,
                              input->photo_name, photo->width - 1, photo->height - 1);
    depth->focus_x = (x + 0.5) / photo->width;
    depth->focus_y = (y + 0.5) / photo->height;
    d = disparity_at(input, depth->focus_x, depth->focus_y);
    if (depth->near_m > 0 && depth->far_m > depth->near_m) {
        const struct refocus_depth_range range = {depth->near_m, depth->far_m};
        const double z = refocus_depth_of_disparity(&range, d);

        depth->focus_distance = isfinite(z) ? z : 0;
    }
    if (!isnan(settings->blur))
        depth->blur_at_infinity = settings->blur * d / larger;
    return EXIT_DONE;
}

static int write_photo(const struct settings *settings, const struct input *input)
{
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_reason reason = {""};
    char *temporary = NULL;
    int status;

    depth.disparity = input->disparity;
    depth.width = input->width;
    depth.height = input->height;
    depth.stride = 2 * (ptrdiff_t)input->width;
    depth.near_m = input->report.near_m;
    depth.far_m = input->report.far_m;
    status = settle_focus(settings, input, &depth);
    if (status == EXIT_DONE && settings->stack.on) {
        depth.confidence = input->confidence;
        depth.confidence_stride = input->width;
    }
    interrupt_hold(true);
    if (status == EXIT_DONE && settings->stack.on)
        status = stacked_write_temporary(input, settings->output, &temporary);
    if (status == EXIT_DONE)
        status = interrupt_came()
                     ? REFOCUS_ERR_CANCELLED
                     : refocus_photo_write_depth(settings->output,
                                                 temporary ? temporary : input->photo_name, &depth,
                                                 &reason);
    if (temporary)
        remove(temporary);
    free(temporary);
    interrupt_hold(false);
    if (status > 0) /* an exit code: the failure has been reported */
        return status;
    if (status == REFOCUS_ERR_CANCELLED)
        return report_failure(EXIT_FAILED, settings->output, "interrupted; nothing was written");
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, settings->output, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    return EXIT_DONE;
}

static int write_output(const struct settings *settings, const struct input *input)
{
    if (settings->view != VIEW_NONE)
        return write_view(settings, input);
    if (output_is_jpeg(settings->output))
        return write_photo(settings, input);
    return output_write_gray16(settings->output, input->disparity, input->width, input->height);
}

static const char *const photo_endings[] = {".jpg", ".jpeg", NULL};

static bool is_made(const struct settings *settings, const char *const *files)
{
    return files[1] || settings->stack.on || settings->side_by_side || settings->stereo.within ||
           settings->model;
}

/* Options of depth that is read or matched, with depth that is not. */
static int check_ways(const struct settings *settings, const char *const *files, int argc,
                      char **argv)
{
    static const char *const of_read[] = {"--depth-unit", "--invalid", "--speckle", "--upsample",
                                          NULL};
    const bool pair = is_made(settings, files) && !settings->model && !settings->stack.on;
    static const char *const of_pairs[] = {"--match", "--pair-order", NULL};
    int status = EXIT_DONE;
    const bool nothing = settings->strokes && !settings->depth.file && !is_made(settings, files);

    if (!pair)
        status = options_refuse(&depth_command, argc, argv, of_pairs,
                                "it is for stereo pairs; give RIGHT, --side-by-side or "
                                "--stereo-file, or leave it out");
    if (status != EXIT_DONE)
        return status;
    if (is_made(settings, files) && settings->depth.unit)
        return report_failure(EXIT_WRONG, "--depth-unit",
                              "it is for depth that is read from a file; leave it out");
    if (pair && options_given(&depth_command, argc, argv, "--upsample"))
        return report_failure(EXIT_WRONG, "--upsample",
                              "depth of a stereo pair has the photo's size; leave it "
                              "out");
    if (!nothing)
        return EXIT_DONE;
    return options_refuse(&depth_command, argc, argv, of_read,
                          "--strokes alone paint over nothing; give --depth, or leave "
                          "it out");
}

/* Options of a focus stack, and the number of its frames. */
static int check_stack(const struct settings *settings, const char *const *files, int argc,
                       char **argv)
{
    static const char *const of_others[] = {
        "--full",       "--upsample",     "--depth-edges", "--strokes", "--match",
        "--pair-order", "--orient-depth", "--invalid",     "--speckle", NULL};
    static const char *const of_focus[] = {"--positions", "--reference", "--order", NULL};
    int count = 0, status = EXIT_DONE;

    while (files[count])
        count++;
    if (!settings->stack.on)
        return count <= 2 ? EXIT_DONE
                          : report_failure(EXIT_WRONG, files[2],
                                           "one file too many; give refocus depth FILE [RIGHT], "
                                           "or --focal-stack");
    if (count < REFOCUS_STACK_LEAST_FRAMES)
        return report_failure(EXIT_WRONG, files[0],
                              "one frame is no focus stack; give two at least");
    if (settings->stack.reference > count)
        return report_failure(EXIT_WRONG, "--reference", "there are %d frames; give 1 to %d", count,
                              count);
    status = options_refuse(&depth_command, argc, argv, of_others,
                            "it is not for depth of a focus stack; leave it out");
    if (status == EXIT_DONE && settings->stack.in_focus != IN_FOCUS_AUTO)
        status = options_refuse(&depth_command, argc, argv, of_focus,
                                "frames of --in-focus differ in their apertures; leave it out");
    if (status == EXIT_DONE && settings->stack.photo)
        status = output_check(settings->stack.photo, OUTPUT_PICTURE, NULL, files, count);
    if (status == EXIT_DONE && settings->stack.photo)
        status = output_check_two(settings->stack.photo, settings->output);
    if (status == EXIT_DONE)
        status = output_check(settings->output, settings->view ? OUTPUT_PICTURE : OUTPUT_DEPTH,
                              settings->view ? NULL : photo_endings, files, count);
    return status;
}

static int check(const struct settings *settings, const char *const *files, int argc, char **argv)
{
    const char *const inputs[] = {files[0], settings->depth.file, files[1], settings->model,
                                  settings->strokes};
    int status = input_check_depth(&settings->depth);

    if (status == EXIT_DONE)
        status = output_check(settings->output, settings->view ? OUTPUT_PICTURE : OUTPUT_DEPTH,
                              settings->view ? NULL : photo_endings, inputs, 5);
    if (status == EXIT_DONE)
        status = check_stack(settings, files, argc, argv);
    if (status == EXIT_DONE && (files[1] != NULL && !settings->stack.on) + settings->stack.on +
                                       settings->side_by_side + settings->stereo.within +
                                       (settings->model != NULL) + (settings->depth.file != NULL) >
                                   1)
        return report_failure(EXIT_WRONG, files[0],
                              "its depth is given twice; give one of RIGHT, "
                              "--side-by-side, --stereo-file, "
                              "--estimate and --depth");
    if (status == EXIT_DONE && is_made(settings, files) && output_is_jpeg(settings->output) &&
        settings->side_by_side && settings->view == VIEW_NONE)
        return report_failure(EXIT_WRONG, settings->output,
                              "depth of half a picture does not fit the file; give a "
                              ".png");
    if (status == EXIT_DONE && settings->strokes && settings->side_by_side)
        return report_failure(EXIT_WRONG, "--strokes",
                              "they are not painted over half a picture; give LEFT and "
                              "RIGHT");
    if (status == EXIT_DONE && !isnan(settings->blur) && isnan(settings->focus_at[0]))
        return report_failure(EXIT_WRONG, "--blur", "it goes with --focus-at; give that too");
    if (status == EXIT_DONE && !isnan(settings->focus_at[0]) &&
        (settings->view != VIEW_NONE || !output_is_jpeg(settings->output)))
        return report_failure(EXIT_WRONG, "--focus-at",
                              "it is kept in a photo alone; give -o a .jpg, or leave "
                              "it out");
    return status == EXIT_DONE ? check_ways(settings, files, argc, argv) : status;
}

static int read_input(const struct settings *settings, const char *const *files,
                      struct input *input)
{
    if (settings->stack.on)
        return input_read_stack(input, files, &settings->stack, &settings->depth);
    if (settings->model)
        return input_read_estimate(input, files[0], settings->model, &settings->network,
                                   &settings->depth);
    if (is_made(settings, files))
        return input_read_stereo(input, files[0], files[1], &settings->stereo, &settings->depth);
    if (settings->strokes && !settings->depth.file)
        return painted_read(input, files[0], &settings->depth);
    if (settings->depth.file || settings->depth.full ||
        (output_is_jpeg(settings->output) && settings->view == VIEW_NONE))
        return input_read(input, files[0], &settings->depth);
    return input_read_depth(input, files[0], &settings->depth);
}

int depth_of_stack(int argc, char **argv, const char *called)
{
    struct settings settings = {.network = NETWORK_SETTINGS_NONE,
                                .depth = DEPTH_SETTINGS_NONE,
                                .stack = STACK_SETTINGS_NONE,
                                .focus_at = {NAN, NAN},
                                .blur = NAN};
    struct input input = {0};
    const char *files[REFOCUS_STACK_MOST_FRAMES + 1] = {NULL};
    int status;

    status = options_parse(&depth_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    settings.stack.called = called;
    status = check(&settings, files, argc, argv);
    if (status != EXIT_DONE)
        return status;
    if (!settings.depth.full)
        settings.depth.edges = EDGES_AS_GIVEN;
    settings.depth.full |= settings.strokes != NULL;
    report_progress("reading", 0);
    status = read_input(&settings, files, &input);
    if (status == EXIT_DONE && settings.strokes) {
        report_progress("painting", 0.4);
        status = painted_apply(&input, settings.strokes);
    }
    if (status == EXIT_DONE) {
        report_progress("writing", 0.7);
        if (settings.stack.photo)
            status = stacked_write_photo(&input, settings.stack.photo);
        if (status == EXIT_DONE)
            status = write_output(&settings, &input);
    }
    report_progress_end();
    if (status == EXIT_DONE)
        status = print_report(&settings, &input);
    input_free(&input);
    return status;
}

static int run(int argc, char **argv)
{
    return depth_of_stack(argc, argv, NULL);
}

const struct command depth_command = {
    .name = "depth",
    .usage = "FILE [RIGHT] -o OUT [options]",
    .summary = "make, read, repair or upsample the depth of a photo, and write it",
    .notes = "FILE is a photo that carries depth, a photo with --depth, a depth map, "
             "the left picture of a stereo pair, or any photo with --estimate or "
             "--strokes; with --focal-stack give all frames of a focus stack. Samples without a "
             "value are filled from those around them, "
             "from the farther side where two surfaces meet, or from behind a thin thing at the "
             "border, and counted.",
    .options = options,
    .files_least = 1,
    .files_most = REFOCUS_STACK_MOST_FRAMES,
    .too_many = "a focus stack has 32 frames at the most; leave out every other one",
    .run = run,
};
