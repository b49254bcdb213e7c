/* depth.c: the command `refocus depth` makes, reads, repairs or enlarges a depth map. */
#include <math.h>

#include "commands/commands.h"
#include "commands/depth_output.h"
#include "inputs/painted.h"
#include "line/report.h"
#include "outputs/outputs.h"
#include "inputs/depth_options.h"

static const struct option_word view_words[] = {
    {"none", "the disparities as they are"},
    {"disparity", "their picture, bright = near"},
    {"confidence", "white where measured, black where filled"},
    {0}};

static const struct option options[] = {
    OUTPUT_OPTION(struct depth_command_settings, output,
                  "the disparities to write, 1 = nearest: .png, .tif or .pgm of 16 bits "
                  "(65535 = 1) or .pfm of 32-bit floats; or a .jpg: the JPEG photo, "
                  "every byte of it, with the depth inside as GDepth"),
    GROUP(depth_file_options, struct depth_command_settings, depth),
    GROUP(depth_unit_options, struct depth_command_settings, depth),
    GROUP(orient_depth_options, struct depth_command_settings, depth),
    GROUP(repair_options, struct depth_command_settings, depth),
    GROUP(limit_options, struct depth_command_settings, depth.limits),
    {OPTION(OPTION_FLAG, "--full", NULL, struct depth_command_settings, depth.full),
     .brief = "bring the depth to the photo's size, edge on edge",
     .help = "bring the depth to the photo's size, its edges on the photo's"},
    {OPTION(OPTION_CHOICE, "--depth-edges", "HOW", struct depth_command_settings, depth.edges),
     .words = edges_words, .help = "the edges of the depth map", .needs = "--full"},
    {OPTION(OPTION_CHOICE, "--upsample", "HOW", struct depth_command_settings, depth.upsample),
     .words = upsample_words,
     .help = "how --full does it, before --depth-edges: by the library (default), or by filters "
             "of OpenCV, the last three by its module refocus-ximgproc",
     .needs = "--full,--strokes"},
    ESTIMATE_OPTIONS(struct depth_command_settings, model, network,
                     "depth of the one photo, by a network"),
    {OPTION(OPTION_TEXT, "--strokes", "FILE.json", struct depth_command_settings, strokes),
     .brief = "paint these strokes",
     .help = "paint these strokes: over nothing, or over the depth of --depth, "
             "--estimate or a stereo pair"},
    GROUP(stack_options, struct depth_command_settings, stack),
    STEREO_FILE_OPTION(struct depth_command_settings, stereo,
                       "FILE holds both pictures of a stereo pair"),
    {MATCH_OPTION(struct depth_command_settings, stereo, "how a stereo pair is matched")},
    {PAIR_ORDER_OPTION(struct depth_command_settings, stereo)},
    {OPTION(OPTION_FLAG, "--side-by-side", NULL, struct depth_command_settings, side_by_side),
     .brief = "FILE holds a stereo pair, the left picture left",
     .help = "FILE holds both pictures of a stereo pair, the left one left"},
    {OPTION(OPTION_CHOICE, "--view", "WHAT", struct depth_command_settings, view),
     .words = view_words, .brief = "write a picture to look at instead",
     .help = "write an 8-bit picture to look at instead: " OUTPUT_PICTURES},
    {OPTION(OPTION_NUMBERS, "--focus-at", "X,Y", struct depth_command_settings, focus_at),
     .least = 0, .greatest = REFOCUS_MAX_SIDE, .count = 2,
     .help =
         "for a .jpg: the pixel in focus when it is opened again; default: what the photo says"},
    {OPTION(OPTION_NUMBER, "--blur", "K", struct depth_command_settings, blur), .least = 0,
     .greatest = REFOCUS_MAX_BLUR_RADIUS,
     .help = "for a .jpg, with --focus-at: the blur radius of disparity 0 when 1 is in focus"},
    {OPTION(OPTION_FLAG, "--json", NULL, struct depth_command_settings, json),
     .brief = "print a report as one JSON object", .help = "print the report as one JSON object"},
    {.help = NULL},
};

static const char *const photo_endings[] = {".jpg", ".jpeg", NULL};

static bool is_made(const struct depth_command_settings *settings, const char *const *files)
{
    return files[1] || settings->stack.on || settings->side_by_side || settings->stereo.within ||
           settings->model;
}

/* Options of depth that is read or matched, with depth that is not. */
static int check_ways(const struct depth_command_settings *settings, const char *const *files,
                      int argc, char **argv)
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
                              "depth of a stereo pair has the photo's size; leave it out");
    if (!nothing)
        return EXIT_DONE;
    return options_refuse(&depth_command, argc, argv, of_read,
                          "--strokes alone paint over nothing; give --depth, or leave it out");
}

/* Options of a focus stack, and the number of its frames. */
static int check_stack(const struct depth_command_settings *settings, const char *const *files,
                       int argc, char **argv)
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

static int check(const struct depth_command_settings *settings, const char *const *files, int argc,
                 char **argv)
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
                              "its depth is given twice; give one of RIGHT, --side-by-side, "
                              "--stereo-file, --focal-stack, --estimate and --depth");
    if (status == EXIT_DONE && is_made(settings, files) && output_is_jpeg(settings->output) &&
        settings->side_by_side && settings->view == VIEW_NONE)
        return report_failure(EXIT_WRONG, settings->output,
                              "depth of half a picture does not fit the file; give a .png");
    if (status == EXIT_DONE && settings->strokes && settings->side_by_side)
        return report_failure(EXIT_WRONG, "--strokes",
                              "they are not painted over half a picture; give LEFT and RIGHT");
    if (status == EXIT_DONE && !isnan(settings->blur) && isnan(settings->focus_at[0]))
        return report_failure(EXIT_WRONG, "--blur", "it goes with --focus-at; give that too");
    if (status == EXIT_DONE && !isnan(settings->focus_at[0]) &&
        (settings->view != VIEW_NONE || !output_is_jpeg(settings->output)))
        return report_failure(EXIT_WRONG, "--focus-at",
                              "it is kept in a photo alone; give -o a .jpg, or leave it out");
    return status == EXIT_DONE ? check_ways(settings, files, argc, argv) : status;
}

static int read_input(const struct depth_command_settings *settings, const char *const *files,
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

int depth_run(int argc, char **argv, const char *called)
{
    struct depth_command_settings settings = {.network = NETWORK_SETTINGS_NONE,
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
    if (settings.stack.photo &&
        output_deep_format(settings.stack.photo) == REFOCUS_FORMAT_RGB_FLOAT)
        settings.stack.light = REFOCUS_FORMAT_RGB_FLOAT;
    else if (output_is_jpeg(settings.stack.photo) || output_is_jpeg(settings.output))
        settings.stack.light = REFOCUS_FORMAT_RGB_HALF;
    status = check(&settings, files, argc, argv);
    if (status != EXIT_DONE)
        return status;
    if (!settings.depth.full)
        settings.depth.edges = EDGES_AS_GIVEN;
    settings.depth.full |= settings.strokes != NULL;
    report_progress("reading", 0);
    report_cut(settings.output ? settings.output : files[0]);
    status = read_input(&settings, files, &input);
    if (status == EXIT_DONE && settings.strokes) {
        report_progress("painting", 0.4);
        status = painted_apply(&input, settings.strokes);
    }
    report_cut(NULL);
    if (status == EXIT_DONE) {
        report_progress("writing", 0.7);
        if (settings.stack.photo)
            status = stacked_write_photo(&input, settings.stack.photo);
        if (status == EXIT_DONE)
            status = depth_output_write(&settings, &input);
    }
    report_progress_end();
    if (status == EXIT_DONE)
        status = depth_output_report(&settings, &input);
    input_free(&input);
    return status;
}

static int run(int argc, char **argv)
{
    return depth_run(argc, argv, NULL);
}

const struct command depth_command = {
    .name = "depth",
    .usage = "FILE [RIGHT] -o OUT [options]",
    .summary = "make, read, repair or upsample the depth of a photo, and write it",
    .notes = "FILE is a photo that carries depth, a photo with --depth, a depth map, the left "
             "picture of a stereo pair, or any photo with --estimate or --strokes; with "
             "--focal-stack give all frames of a focus stack. Samples without a value are filled "
             "from those around them, from the farther side where two surfaces meet, or from "
             "behind a thin thing at the border, and counted. In --json, 'stack' is what was found "
             "of a focus stack, in the words of struct refocus_stack_result (refocus/stack.h).",
    .table = options,
    .files_least = 1,
    .files_most = REFOCUS_STACK_MOST_FRAMES,
    .too_many = "a focus stack has 32 frames at the most; leave out every other one",
    .run = run,
};
