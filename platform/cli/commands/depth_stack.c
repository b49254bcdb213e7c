/* depth_stack.c: depth and an all-in-focus photo are made of a focus stack. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/depth_stack.h"
#include "line/interrupt.h"
#include "line/report.h"

const struct option stack_options[] = {
    {OPTION(OPTION_FLAG, "--focal-stack", NULL, struct stack_settings, on),
     .brief = "the FILEs show one view at 2 to 32 focus distances, or apertures",
     .help = "the FILEs show one view at 2 to 32 focus distances, one after the other, or at "
             "several apertures: depth, and a photo that is in focus everywhere, are made of them"},
    {OPTION(OPTION_TEXT, "--positions", "LIST", struct stack_settings, positions),
     .help = "focus of each frame in dioptres, 1 / metres, with commas, or a .json file with a "
             "list of them; then any order will do, and depth is in metres; default: the subject "
             "distances of EXIF, else equally far apart",
     .needs = "--focal-stack"},
    {OPTION(OPTION_INTEGER, "--reference", "N", struct stack_settings, reference), .least = 1,
     .greatest = REFOCUS_STACK_MOST_FRAMES,
     .help = "the result is seen as in the N-th frame; default: the one in the middle",
     .needs = "--focal-stack"},
    {OPTION(OPTION_CHOICE, "--align", "HOW", struct stack_settings, align),
     .words = stack_align_words, .help = "how frames are laid on each other",
     .needs = "--focal-stack"},
    {OPTION(OPTION_CHOICE, "--order", "HOW", struct stack_settings, order),
     .words = stack_order_words, .help = "order of focus of frames without positions",
     .needs = "--focal-stack"},
    {OPTION(OPTION_CHOICE, "--in-focus", "WHICH", struct stack_settings, in_focus),
     .words = stack_in_focus_words,
     .help = "what is in focus in frames of one focus and several apertures, whose f-numbers EXIF "
             "tells; of two without, the sharper one has the smaller aperture, and is the photo",
     .needs = "--focal-stack"},
    {OPTION(OPTION_TEXT, "--photo", "FILE", struct stack_settings, photo),
     .help = "write the photo that is in focus everywhere as well: " OUTPUT_PICTURES
             "; a .jpg as OUT is that photo with the depth inside. Light above white that blurred "
             "frames tell of is in a .exr and .pfm, and the gain map of a .jpg",
     .needs = "--focal-stack"},
    {.help = NULL},
};

/* A share of measured pixels below this is no depth. */
#define LEAST_MEASURED 0.002
/* Frames that are less alike than this show different places. */
#define LEAST_ALIKE 0.5
/* An order that is found is doubtful where the next best one is no worse than this. */
#define LEAST_ORDER_MARGIN 0.01
/* The picture shows which end is far from here on. */
#define LEAST_DIRECTION (1 / 25.0)
/* More of a photo that moves is of one frame for the most part; what is out of order adds to it. */
#define MOST_MOVING 0.5
/* More of it is no order: 0.03 in stacks of nine frames as they were taken, 0.9 shuffled. */
#define MOST_DISORDER 0.5

const struct option_word stack_align_words[] = {
    [REFOCUS_STACK_ALIGN_SIMILARITY] = {"similarity", "scale, shift and rotation are undone"},
    [REFOCUS_STACK_ALIGN_NONE] = {"none", "frames are taken as they are"},
    {0}};

const struct option_word stack_order_words[] = {
    [REFOCUS_STACK_ORDER_ADDED] = {"given", "the farthest focus first"},
    [REFOCUS_STACK_ORDER_FOUND] = {"found", "found by their sharpness; edges, and what lies lower, "
                                            "show which end is far, else it is as given"},
    [REFOCUS_STACK_ORDER_EITHER] = {"auto", "as given, the farthest first or last: edges, and what "
                                            "lies lower, show which, else first"},
    {0}};

const struct option_word stack_in_focus_words[] = {
    [IN_FOCUS_AUTO] = {"auto", "the focus differs, unless EXIF tells of one focus and several "
                               "apertures: then it is on the nearest surface"},
    [IN_FOCUS_NEAREST] = {"nearest", "the aperture differs, and the nearest surface is in focus"},
    [IN_FOCUS_FARTHEST] = {"farthest", "the aperture differs, and the farthest one is"},
    {0}};

/* ----- frames ----- */

static const char *name_of(const struct stack_frames *frames, int k)
{
    return frames->called ? frames->called : frames->file[k];
}

static int add(struct refocus_stack *stack, struct stack_frames *frames, int k)
{
    struct input other;
    int status = stack_frames_photo(frames, k, &other);

    if (status == EXIT_DONE) {
        status = refocus_stack_add(stack, other.photo->image, frames->position[k]);
        if (status == REFOCUS_ERR_ARGUMENT)
            status = report_failure(EXIT_FAILED, name_of(frames, k),
                                    "it is %dx%d, and other frames are not; give frames of one "
                                    "size",
                                    other.photo->image->width, other.photo->image->height);
        else if (status != REFOCUS_OK)
            status =
                report_failure(EXIT_FAILED, name_of(frames, k),
                               "it cannot be added to the stack: %s", refocus_strerror(status));
    }
    input_free(&other);
    return status;
}

static int add_all(struct refocus_stack *stack, struct stack_frames *frames,
                   const struct input *input)
{
    for (int k = 0; k < frames->count; k++) {
        report_progress("reading", 0.6 * k / frames->count);
        if (k != frames->reference) {
            const int status = add(stack, frames, k);

            if (status != EXIT_DONE)
                return status;
        } else if (refocus_stack_add(stack, input->photo->image, frames->position[k])) {
            return report_failure(EXIT_FAILED, name_of(frames, k),
                                  "it cannot be added to the stack");
        }
    }
    return EXIT_DONE;
}

/* ----- result ----- */

static void set_range(struct input *input, const struct stack_frames *frames,
                      const struct depth_settings *settings)
{
    double least = frames->position[0], most = least;

    for (int k = 1; k < frames->count; k++) {
        least = fmin(least, frames->position[k]);
        most = fmax(most, frames->position[k]);
    }
    if (!isnan(most) && !frames->no_unit && frames->kind == REFOCUS_STACK_FOCUS) {
        input->report.near_m = 1 / most;
        input->report.far_m = least > 0 ? 1 / least : INFINITY;
    }
    if (!isnan(settings->near_m))
        input->report.near_m = settings->near_m;
    if (!isnan(settings->far_m))
        input->report.far_m = settings->far_m;
}

/* Why hardly any depth was measured. */
static const char *why_unmeasured(const struct refocus_stack_result *result)
{
    if (result->moving <= (float)MOST_MOVING)
        return "no part of the picture is sharper in one frame than in the others; give frames of "
               "different focus";
    if (result->alike < (float)LEAST_ALIKE)
        return "frames do not lie on each other: the camera moved too far, or they show different "
               "places; give frames of one view";
    return "something moves in most of the picture, or its light changed; leave out the frames "
           "that differ, or give another --reference";
}

int stack_judge(const struct refocus_stack_result *result, const char *name)
{
    if (result->measured < (float)LEAST_MEASURED)
        return report_failure(EXIT_FAILED, name, "%s", why_unmeasured(result));
    if (result->disorder > (float)MOST_DISORDER)
        report_warning(name, "frames do not follow each other in focus; give the farthest first, "
                             "--positions, or --order found");
    else if (result->alike < (float)LEAST_ALIKE)
        report_warning(name, "not all frames lie on each other: the camera moved too far, or they "
                             "show different places; depth is wrong there");
    else if (result->moving + result->disorder > (float)MOST_MOVING)
        report_warning(name, "in much of the picture something moves, its light changed, or frames "
                             "do not follow each other: depth and photo are doubtful");
    return EXIT_DONE;
}

/* Tell of an order that was found where it is another one than frames were given in. */
static void tell_order(const struct refocus_stack_result *result, const char *name, int count)
{
    char list[4 * REFOCUS_STACK_MOST_FRAMES] = "";
    bool as_given = true;

    for (int k = 0; k < count; k++) {
        as_given = as_given && result->order[k] == k + 1;
        snprintf(list + strlen(list), sizeof list - strlen(list), k ? " %d" : "%d",
                 result->order[k]);
    }
    if (as_given)
        return;
    if (result->order_margin < (float)LEAST_ORDER_MARGIN)
        report_warning(name,
                       "frames are taken in the order %s, which is doubtful; give "
                       "--positions, or the farthest first and --order given",
                       list);
    else if (fabs((double)result->direction) < LEAST_DIRECTION)
        report_warning(name,
                       "frames are taken in the order %s; whether it begins with the "
                       "farthest is not seen: give --positions if it does not",
                       list);
    else
        report_warning(name, "frames are taken in the order %s, the farthest first%s", list,
                       result->by_rows ? ", by what lies lower alone, which is doubtful: give "
                                         "--positions if it is not"
                                       : "");
}

static void add_evidence(struct refocus_photo_info *info, const char *text)
{
    snprintf(info->evidence[info->evidence_count++], REFOCUS_INFO_LENGTH, "%s", text);
}

/* Tell why the first frame is taken for the farthest, or the last. */
static void tell_direction(struct refocus_photo_info *info, const char *name,
                           const struct refocus_stack_result *result)
{
    const char *const farthest = result->direction > 0 ? "first" : "last";
    const char *const why =
        result->by_rows ? "what lies lower, which is nearer in most pictures, tells" : "edges show";

    if (fabs((double)result->direction) < LEAST_DIRECTION) {
        add_evidence(info,
                     "focus stack: nothing shows which end is far; the first is taken for it");
        return;
    }
    snprintf(info->evidence[info->evidence_count++], REFOCUS_INFO_LENGTH,
             "focus stack: %s that the %s frame is focused farthest", why, farthest);
    if (result->by_rows && result->direction < 0)
        report_warning(name, "the last frame is taken for the farthest, by what lies lower alone, "
                             "which is doubtful; if the first is the farthest, give --order given");
}

static int judge_apertures(const struct refocus_stack_result *result, const char *name)
{
    if (result->measured < (float)LEAST_MEASURED)
        return report_failure(EXIT_FAILED, name,
                              "no blur of the sharper frame is like the other one; give frames of "
                              "one focus and different apertures");
    if (result->alike < (float)LEAST_ALIKE)
        report_warning(name, "not all frames lie on each other: the camera moved too far, or they "
                             "show different places; depth is wrong there");
    return EXIT_DONE;
}

static void tell_apertures(struct refocus_photo_info *info, const struct stack_frames *frames,
                           const struct refocus_stack_result *result)
{
    double least = frames->position[0], most = least;

    for (int k = 1; k < frames->count; k++) {
        least = fmin(least, frames->position[k]);
        most = fmax(most, frames->position[k]);
    }
    if (frames->of_files)
        snprintf(info->evidence[info->evidence_count++], REFOCUS_INFO_LENGTH,
                 "EXIF: the f-numbers of the frames, %.3g to %.3g", 1 / most, 1 / least);
    snprintf(info->evidence[info->evidence_count++], REFOCUS_INFO_LENGTH,
             "apertures: the %s surface is taken to be in focus; the widest aperture blurs by up "
             "to %.1f pixels",
             frames->kind == REFOCUS_STACK_APERTURE_NEAREST ? "nearest" : "farthest",
             (double)result->blur);
}

/* Makes room for the light of the photo, in the format of the file that gets it. */
static bool begin_light(struct input *input, uint32_t format)
{
    const struct refocus_image *image = input->photo->image;
    const ptrdiff_t line = (ptrdiff_t)image->width * refocus_format_bytes(format);
    uint8_t *pixels = malloc((size_t)image->height * (size_t)line);

    input->stacked = refocus_image_packed(format, pixels, image->width, image->height, line);
    return pixels != NULL;
}

/* Whether there is light that 8 bits do not hold: a sixteenth above white in a pixel. */
static bool exceeds(const struct refocus_image *light)
{
    enum { ONE_SIXTEENTH_MORE = 0x3c40 }; /* a half */
    const size_t samples = 3 * (size_t)light->width * (size_t)light->height;
    const uint16_t *halves = (const uint16_t *)(const void *)light->plane[0];

    if (light->format != REFOCUS_FORMAT_RGB_HALF)
        return true;
    for (size_t i = 0; i < samples; i++)
        if (halves[i] > ONE_SIXTEENTH_MORE)
            return true;
    return false;
}

static int finish(struct input *input, struct refocus_stack *stack,
                  const struct stack_frames *frames, const struct stack_settings *how)
{
    struct refocus_stack_result result = refocus_stack_result_default();
    const struct refocus_image *image = input->photo->image;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    int status;

    input->disparity = malloc(pixels * sizeof *input->disparity);
    input->confidence = malloc(pixels);
    if (!input->disparity || !input->confidence ||
        (how->light && frames->kind == REFOCUS_STACK_FOCUS && !begin_light(input, how->light)))
        return report_failure(EXIT_FAILED, input->photo_name, "not enough memory");
    result.photo = image->plane[0];
    result.photo_stride = image->stride[0];
    result.disparity = input->disparity;
    result.disparity_stride = 2 * (ptrdiff_t)image->width;
    result.confidence = input->confidence;
    result.confidence_stride = image->width;
    if (input->stacked.plane[0])
        result.light = &input->stacked;
    report_progress("comparing", 0.6);
    if (refocus_stack_finish(stack, &result))
        return report_failure(EXIT_FAILED, input->photo_name, "the stack cannot be finished");
    input->has_stacked = result.light && exceeds(result.light);
    result.light = NULL;
    input->stack = result;
    input->photo_name = name_of(frames, result.reference - 1);
    status = frames->kind == REFOCUS_STACK_FOCUS ? stack_judge(&result, input->photo_name)
                                                 : judge_apertures(&result, input->photo_name);
    if (status != EXIT_DONE)
        return status;
    if (isnan(frames->position[0]) && how->order == REFOCUS_STACK_ORDER_FOUND &&
        frames->kind == REFOCUS_STACK_FOCUS)
        tell_order(&result, input->photo_name, frames->count);
    for (size_t i = 0; i < pixels; i++)
        input->report.unknown += input->confidence[i] < 128;
    snprintf(input->made_info.evidence[0], REFOCUS_INFO_LENGTH,
             "focus stack: %d frames, moved by up to %.1f pixels, in the geometry of frame %d",
             frames->count, (double)result.moved, result.reference);
    input->made_info.evidence_count = 1;
    if (result.moving > 0)
        snprintf(input->made_info.evidence[input->made_info.evidence_count++], REFOCUS_INFO_LENGTH,
                 "focus stack: something moves in %.1f %% of the picture: frames that differ from "
                 "frame %d are left out there",
                 100 * (double)result.moving, result.reference);
    if (result.matched)
        snprintf(input->made_info.evidence[input->made_info.evidence_count++], REFOCUS_INFO_LENGTH,
                 "focus stack: frames of another exposure or white are matched to frame %d: %u, "
                 "the farthest of %.2f times its light",
                 result.reference, (unsigned)result.matched, (double)result.exposure);
    if (frames->kind != REFOCUS_STACK_FOCUS) {
        tell_apertures(&input->made_info, frames, &result);
        return EXIT_DONE;
    }
    if (frames->of_files)
        add_evidence(&input->made_info, "EXIF: the subject distances of the frames");
    if (isnan(frames->position[0]) && how->order == REFOCUS_STACK_ORDER_EITHER)
        tell_direction(&input->made_info, input->photo_name, &result);
    return EXIT_DONE;
}

/* The input's map is of the photo's size, and all of it has a value. */
static void begin(struct input *input)
{
    struct refocus_depth_map *const map = &input->made_map;

    *map = refocus_depth_map_default();
    input->made.depth = map;
    input->made.info = &input->made_info;
    snprintf(input->made_info.container, sizeof input->made_info.container, "focus-stack");
    map->width = input->width = input->photo->image->width;
    map->height = input->height = input->photo->image->height;
    input->report.value_near = map->value_near = 1;
    input->depth_from = &input->made;
}

int input_read_stack(struct input *input, const char *const *files,
                     const struct stack_settings *how, const struct depth_settings *settings)
{
    struct refocus_stack_params params;
    struct refocus_stack *stack = NULL;
    struct stack_frames frames = {.file = files, .called = how->called};
    int status;

    while (files[frames.count])
        frames.count++;
    status = stack_frames_read(&frames, how->positions, how->in_focus);
    if (status != EXIT_DONE)
        return status;
    frames.reference =
        isnan(how->reference) ? stack_frames_reference(&frames) : (int)how->reference - 1;
    status = stack_frames_photo(&frames, frames.reference, input);
    if (status != EXIT_DONE)
        return status;
    begin(input);
    input->photo_name = name_of(&frames, frames.reference);
    params = refocus_stack_params_default(input->width, input->height, frames.count);
    if (frames.kind != REFOCUS_STACK_FOCUS && !isnan(how->reference))
        return report_failure(EXIT_WRONG, "--reference",
                              "frames differ in their apertures, and the photo is that of the "
                              "smallest one; leave it out");
    params.reference = isnan(how->reference) ? 0 : frames.reference + 1;
    params.align = (uint32_t)how->align;
    params.order = (uint32_t)how->order;
    params.kind = frames.kind;
    status = refocus_stack_create(&stack, &params);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, name_of(&frames, frames.reference), "%s",
                              status == REFOCUS_ERR_ARGUMENT
                                  ? "it is too small; give frames of 16 x 16 pixels and more"
                                  : refocus_strerror(status));
    set_range(input, &frames, settings);
    status = add_all(stack, &frames, input);
    if (status == EXIT_DONE)
        status = finish(input, stack, &frames, how);
    if (status == EXIT_DONE)
        status = stack_frames_settle(&frames, input);
    refocus_stack_destroy(&stack);
    return status;
}

/* ----- photo ----- */

int stacked_write_photo(const struct input *input, const char *path)
{
    const struct refocus_image *const light = input->has_stacked ? &input->stacked : NULL;
    struct refocus_write_options keeps = output_keeps(input->photo);

    if (light && output_deep_format(path) == REFOCUS_FORMAT_RGB_FLOAT)
        return output_write_image(path, light, &keeps);
    if (output_is_jpeg(path))
        keeps.light = light;
    return output_write_image(path, input->photo->image, &keeps);
}

static void remove_file(void *path)
{
    remove(path);
}

int stacked_write_temporary(const struct input *input, const char *path, char **temporary)
{
    struct refocus_reason reason = {""};
    int status;

    interrupt_hold(true);
    status = refocus_file_temporary(path, temporary, &reason);
    if (status == REFOCUS_OK)
        interrupt_clean_up(remove_file, *temporary);
    interrupt_hold(false);
    return status == REFOCUS_OK
               ? stacked_write_photo(input, *temporary)
               : report_failure(EXIT_FAILED, path, "%s",
                                reason.text[0] ? reason.text : refocus_strerror(status));
}
