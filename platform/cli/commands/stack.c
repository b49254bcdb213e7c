/* stack.c: the command `refocus stack` photographs a focus stack with a camera that can move its
 * lens, and has `refocus depth` make depth and a photo of it. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "commands/commands.h"
#include "commands/depth_stack.h"
#include "commands/stack_shots.h"
#include "line/interrupt.h"
#include "line/report.h"
#include "outputs/outputs.h"

struct settings {
    struct shots_settings shots;
    struct stack_settings stack;
    const char *output, *keep;
    bool dry_run, json;
};

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    OUTPUT_OPTION(struct settings, output,
                  "the disparities to write, 1 = nearest: .png, .tif or .pgm of 16 bits or .pfm; "
                  "or a .jpg: the photo that is in focus everywhere, with the depth inside"),
    {OPTION(OPTION_TEXT, "--photo", "FILE", struct settings, stack.photo), .elsewhere = true,
     .brief = "write the photo that is in focus everywhere",
     .help = "write the photo that is in focus everywhere: " OUTPUT_PICTURES},
    {OPTION(OPTION_TEXT, "--keep", "FOLDER", struct settings, keep), .elsewhere = true,
     .brief = "make this folder, with the frames and stack.json",
     .help = "make this folder, with the frames and stack.json, which refocus depth --focal-stack "
             "--positions reads; -o may be left out then"},
    {.kind = OPTION_HEADING, .help = "Camera"},
    {OPTION(OPTION_TEXT, "--camera", "SOURCE", struct settings, shots.camera),
     .brief = "libcamera:0, v4l2:/dev/video0 or replay:SCRIPT",
     .help = "libcamera:0, v4l2:/dev/video0 or replay:SCRIPT; refocus live --list shows those that "
             "there are, and with --camera the range of the lens"},
    {OPTION(OPTION_INTEGER, "--steps", "N", struct settings, shots.steps),
     .least = REFOCUS_STACK_LEAST_FRAMES, .greatest = REFOCUS_STACK_MOST_FRAMES,
     .brief = "positions of the lens, even in dioptres; default 9",
     .help = "positions of the lens, even in dioptres; default 9"},
    {OPTION(OPTION_NUMBERS, "--range", "FAR,NEAR", struct settings, shots.range), .least = -1e9,
     .greatest = 1e9, .count = 2, .decimals = true,
     .brief = "the first and the last of them; default: all",
     .help = "the first and the last of them, in dioptres (1 / metres) of libcamera, without unit "
             "of V4L2; default: the whole range of the lens"},
    {OPTION(OPTION_INTEGER, "--average", "N", struct settings, shots.average), .least = 1,
     .greatest = 64, .help = "frames at each position, whose mean is taken; default 1"},
    {OPTION(OPTION_NUMBER, "--settle", "MS", struct settings, shots.settle), .least = 0,
     .greatest = 10000,
     .help = "milliseconds between the lens's report that it is there and the frame; default 300"},
    {OPTION(OPTION_NUMBERS, "--size", "WxH", struct settings, shots.size), .least = 16,
     .greatest = REFOCUS_MAX_SIDE, .count = 2,
     .help = "of the frames; the nearest that the camera has"},
    {OPTION(OPTION_FLAG, "--dry-run", NULL, struct settings, dry_run),
     .brief = "print the positions and do nothing", .help = "print the positions and do nothing"},
    {OPTION(OPTION_FLAG, "--json", NULL, struct settings, json),
     .brief = "print a report as one JSON object",
     .help = "print the report as one JSON object: that of refocus depth, or of --dry-run"},
    {.help = NULL},
};

static int print_plan(const struct settings *settings, const struct shots *shots)
{
    const char *unit = shots->lens.dioptres ? "dioptres" : "of no unit";

    if (!settings->json) {
        printf("lens     %g to %g, %s\n", shots->lens.least, shots->lens.greatest, unit);
        for (int k = 0; k < shots->count; k++) {
            printf("%2d       %.4g", k + 1, shots->asked[k]);
            if (shots->lens.dioptres)
                printf(", %.3g m", 1 / shots->asked[k]);
            printf("\n");
        }
        return report_end_output();
    }
    json_t *positions = json_array();

    for (int k = 0; k < shots->count; k++)
        json_array_append_new(positions, report_number_json(shots->asked[k]));
    return report_print_json(json_pack("{s:b,s:f,s:f,s:i,s:o}", "dioptres",
                                       (int)shots->lens.dioptres, "least", shots->lens.least,
                                       "greatest", shots->lens.greatest, "average",
                                       (int)settings->shots.average, "positions", positions));
}

/* refocus depth goes on from the files. */
static int make_depth(const struct settings *settings, const struct shots *shots,
                      const char *folder, const char *ending)
{
    static char name[REFOCUS_STACK_MOST_FRAMES + 1][SHOTS_NAME];
    char *argv[REFOCUS_STACK_MOST_FRAMES + 12];
    int argc = 0;

    argv[argc++] = "depth";
    argv[argc++] = "--focal-stack";
    argv[argc++] = "--positions";
    shots_name(name[0], folder, -1, ending);
    argv[argc++] = name[0];
    argv[argc++] = "-o";
    argv[argc++] = (char *)(uintptr_t)settings->output;
    if (settings->stack.photo) {
        argv[argc++] = "--photo";
        argv[argc++] = (char *)(uintptr_t)settings->stack.photo;
    }
    if (settings->json)
        argv[argc++] = "--json";
    argv[argc++] = "--";
    for (int k = 0; k < shots->count; k++) {
        shots_name(name[k + 1], folder, k, ending);
        argv[argc++] = name[k + 1];
    }
    argv[argc] = NULL;
    return depth_run(argc, argv, settings->keep ? NULL : settings->shots.camera);
}

struct place {
    const struct shots *shots;
    char *folder;
    const char *ending;
};

static void remove_place(void *of)
{
    const struct place *place = of;

    shots_remove(place->shots, place->folder, place->ending);
}

/* The folder of --keep, or one beside the output that is removed in the end. */
static int make_folder(const struct settings *settings, char **folder)
{
    const char *const beside = settings->output;
    const char *slash = settings->keep ? NULL : strrchr(beside, '/');
    const int length = slash ? (int)(slash - beside) + 1 : 0;
    char name[SHOTS_NAME];
    int made;

    if (settings->keep) {
        snprintf(name, sizeof name, "%s", settings->keep);
        made =
            strlen(settings->keep) < sizeof name - 16 ? mkdir(name, 0777) : (errno = ENAMETOOLONG);
    } else {
        const int n = snprintf(name, sizeof name, "%.*s.refocus-stack-XXXXXX", length, beside);

        if (n >= (int)sizeof name - 16) {
            errno = ENAMETOOLONG;
            made = -1;
        } else {
            made = mkdtemp(name) ? 0 : -1;
        }
    }
    *folder = made == 0 ? strdup(name) : NULL;
    if (*folder)
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, settings->keep ? settings->keep : beside, "%s",
                          errno == EEXIST ? "it is there already; give a new folder"
                                          : strerror(errno));
}

static int photograph(const struct settings *settings, struct shots *shots)
{
    struct place place = {.shots = shots};
    int status = make_folder(settings, &place.folder);
    bool kept = false;

    if (status != EXIT_DONE)
        return status;
    /* Files that stay are small where they can be. */
    place.ending = settings->keep && output_is_picture("x.png") ? ".png" : ".ppm";
    interrupt_clean_up(remove_place, &place);
    status = shots_take(shots, place.folder, place.ending);
    shots_end(shots);
    if (status == EXIT_DONE && settings->keep) {
        interrupt_clean_up(NULL, NULL);
        kept = true;
    }
    if (status == EXIT_DONE && settings->output)
        status = make_depth(settings, shots, place.folder, place.ending);
    else if (status == EXIT_DONE && settings->json)
        status = print_plan(settings, shots);
    interrupt_clean_up(NULL, NULL);
    if (!kept)
        remove_place(&place);
    free(place.folder);
    return status;
}

static const char *const photo_endings[] = {".jpg", ".jpeg", NULL};

static int check(const struct settings *settings)
{
    int status = EXIT_DONE;

    if (!settings->shots.camera)
        return report_failure(EXIT_WRONG, "--camera",
                              "none is given; refocus live --list shows those that there are");
    if (settings->dry_run)
        return EXIT_DONE;
    if (settings->output || !settings->keep)
        status = output_check(settings->output, OUTPUT_DEPTH, photo_endings, NULL, 0);
    if (status == EXIT_DONE && settings->stack.photo && !settings->output)
        return report_failure(EXIT_WRONG, "--photo", "it goes with -o; give that too");
    if (status == EXIT_DONE && settings->stack.photo)
        status = output_check(settings->stack.photo, OUTPUT_PICTURE, NULL, NULL, 0);
    if (status == EXIT_DONE && settings->stack.photo)
        status = output_check_two(settings->stack.photo, settings->output);
    return status;
}

static int run(int argc, char **argv)
{
    struct settings settings = {
        .shots = {.steps = 9, .range = {NAN, NAN}, .average = 1, .settle = 300, .size = {NAN, NAN}},
        .stack = STACK_SETTINGS_NONE};
    struct shots shots;
    const char *files[1];
    int status = options_parse(&stack_command, argc, argv, &settings, files);

    if (status != OPTIONS_PARSED)
        return status;
    status = check(&settings);
    if (status != EXIT_DONE)
        return status;
    status = shots_plan(&shots, &settings.shots, NULL);
    if (status == EXIT_DONE)
        status = settings.dry_run ? print_plan(&settings, &shots) : photograph(&settings, &shots);
    shots_end(&shots);
    return status;
}

const struct command stack_command = {
    .name = "stack",
    .usage = "--camera SOURCE -o OUT [options]",
    .summary = "photograph a focus stack, and make depth and a sharp photo of it",
    .notes = "The camera has to be able to move its lens. It keeps still, and so does the scene: "
             "exposure and white balance are locked, the lens goes from far to near, and a frame "
             "is taken when it is where it was sent.",
    .table = options,
    .files_least = 0,
    .files_most = 0,
    .run = run,
};
