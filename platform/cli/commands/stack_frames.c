/* stack_frames.c: the frames of a focus stack: where they are focused, or how wide their apertures
 * are.
 */
#include "commands/stack_frames.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>
#include "inputs/read_input.h"
#include "inputs/standard_input.h"
#include "line/options.h"
#include "line/report.h"

static int take_position(struct stack_frames *frames, int *n, double position)
{
    if (!(position >= 0) || position > 1e6)
        return report_failure(EXIT_WRONG, "--positions",
                              "%g is no focus in dioptres; give numbers from 0 to 1e6", position);
    for (int k = 0; k < *n && k < REFOCUS_STACK_MOST_FRAMES; k++)
        if (frames->position[k] == position)
            return report_failure(EXIT_WRONG, "--positions",
                                  "%g is there twice; give each frame its own", position);
    if (*n < REFOCUS_STACK_MOST_FRAMES)
        frames->position[*n] = position;
    ++*n;
    return EXIT_DONE;
}

static int positions_of_text(struct stack_frames *frames, const char *text, int *n)
{
    for (const char *at = text;;) {
        char *end;
        const double position = strtod(at, &end);

        if (end == at || (*end && *end != ','))
            return report_failure(EXIT_WRONG, "--positions",
                                  "'%s' is no list of numbers; give dioptres with commas, such as "
                                  "0.2,0.5,1, or a .json file",
                                  text);
        const int status = take_position(frames, n, position);
        if (status != EXIT_DONE)
            return status;
        if (!*end)
            return EXIT_DONE;
        at = end + 1;
    }
}

/* A list of numbers, or an object with one as "positions", whose "dioptres" may be false. */
static int positions_of_file(struct stack_frames *frames, const char *file, int *n)
{
    json_error_t error;
    json_t *json = json_load_file(file, JSON_REJECT_DUPLICATES, &error);
    json_t *list = json_is_object(json) ? json_object_get(json, "positions") : json, *value;
    size_t i;
    int status = EXIT_DONE;

    if (!json)
        return report_failure(EXIT_FAILED, file, "%s", error.text);
    if (!json_is_array(list)) {
        json_decref(json);
        return report_failure(EXIT_FAILED, file,
                              "it holds no positions; give [0.2, 0.5, 1] or "
                              "{\"positions\": [0.2, 0.5, 1]}, in dioptres");
    }
    frames->no_unit = json_is_false(json_object_get(json, "dioptres"));
    json_array_foreach(list, i, value)
    {
        status = json_is_number(value)
                     ? take_position(frames, n, json_number_value(value))
                     : report_failure(EXIT_FAILED, file, "position %zu is no number; give dioptres",
                                      i + 1);
        if (status != EXIT_DONE)
            break;
    }
    json_decref(json);
    return status;
}

static bool is_json(const char *text)
{
    const char *dot = strrchr(text, '.');

    return dot && strcmp(dot, ".json") == 0;
}

/* EXIF of each frame, 0 where it says nothing. */
struct said {
    double distance[REFOCUS_STACK_MOST_FRAMES], f_number[REFOCUS_STACK_MOST_FRAMES];
};

/* A file that cannot be read is told when it is read for its pixels. */
static void read_exif(const struct stack_frames *frames, struct said *said)
{
    for (int k = 0; k < frames->count; k++) {
        struct refocus_reason ignored;
        struct refocus_photo *photo = NULL;
        const bool read = standard_look(&photo, frames->file[k], &ignored) == REFOCUS_OK;

        said->distance[k] = read ? photo->info->subject_distance : 0;
        said->f_number[k] = read ? photo->info->f_number : 0;
        refocus_photo_free(&photo);
    }
}

/* Sets positions to 1 / value, if all values are above 0 and differ. */
static bool take_inverse(struct stack_frames *frames, const double *value)
{
    bool known = true;

    for (int k = 0; k < frames->count; k++) {
        known = known && value[k] > 0;
        frames->position[k] = 1 / value[k];
        for (int j = 0; j < k && known; j++)
            known = frames->position[j] != frames->position[k];
    }
    for (int k = 0; k < frames->count && !known; k++)
        frames->position[k] = NAN;
    return known;
}

/* Whether frames are of one focus and several apertures. Lenses for close-ups have smaller
 * apertures the nearer they are focused: many frames that do not tell their distance are a focus
 * stack. */
static bool tells_apertures(const struct stack_frames *frames, const struct said *said)
{
    enum { FEW = 3 };
    const double stop = 1.4;
    double least = said->f_number[0], most = least;
    bool known = true;

    for (int k = 0; k < frames->count; k++) {
        if (said->f_number[k] <= 0 || said->distance[k] != said->distance[0])
            return false;
        least = fmin(least, said->f_number[k]);
        most = fmax(most, said->f_number[k]);
        known = known && said->distance[k] > 0;
    }
    return most > least && (known || (frames->count <= FEW && most >= stop * least));
}

static int read_apertures(struct stack_frames *frames, const struct said *said)
{
    double f_number = 0;

    frames->of_files = take_inverse(frames, said->f_number);
    for (int k = 0; k < frames->count && !frames->of_files; k++) {
        for (int j = 0; j < k; j++)
            if (said->f_number[j] > 0 && said->f_number[j] == said->f_number[k])
                f_number = said->f_number[j];
    }
    if (f_number > 0)
        return report_failure(EXIT_FAILED, frames->file[0],
                              "two frames have an aperture of f/%g; give each its own", f_number);
    if (!frames->of_files && frames->count > 2)
        return report_failure(
            EXIT_FAILED, frames->file[0],
            "not all frames tell their f-numbers; give two frames, or photos with EXIF");
    return EXIT_DONE;
}

/* By the distances or the f-numbers that all files name in their EXIF, else by none. */
static int read_files(struct stack_frames *frames, int in_focus)
{
    struct said said;

    read_exif(frames, &said);
    if (in_focus == IN_FOCUS_AUTO && !tells_apertures(frames, &said)) {
        frames->of_files = take_inverse(frames, said.distance);
        return EXIT_DONE;
    }
    frames->kind = in_focus == IN_FOCUS_FARTHEST ? REFOCUS_STACK_APERTURE_FARTHEST
                                                 : REFOCUS_STACK_APERTURE_NEAREST;
    return read_apertures(frames, &said);
}

int stack_frames_read(struct stack_frames *frames, const char *text, int in_focus)
{
    int n = 0, status;

    frames->kind = REFOCUS_STACK_FOCUS;
    for (int k = 0; k < frames->count; k++)
        frames->position[k] = NAN;
    if (!text)
        return read_files(frames, in_focus);
    status =
        is_json(text) ? positions_of_file(frames, text, &n) : positions_of_text(frames, text, &n);
    if (status == EXIT_DONE && n != frames->count)
        return report_failure(EXIT_WRONG, "--positions",
                              "%d positions for %d frames; give one for each", n, frames->count);
    return status;
}

int stack_frames_reference(const struct stack_frames *frames)
{
    const int wanted = frames->kind == REFOCUS_STACK_FOCUS ? frames->count / 2 : 0;

    for (int k = 0; k < frames->count; k++) {
        int before = 0;

        for (int j = 0; j < frames->count; j++)
            before += frames->position[j] < frames->position[k];
        if (before == wanted && !isnan(frames->position[k]))
            return k;
    }
    return wanted;
}

int stack_frames_photo(struct stack_frames *frames, int k, struct input *input)
{
    const int status = input_take_photo(input, frames->file[k], "a photo");

    if (status == EXIT_DONE && !frames->bits_told) {
        input_tell_bits(input->photo, frames->file[k]);
        frames->bits_told = input->photo->info->stored_bits > 8;
    }
    return status;
}

int stack_frames_settle(struct stack_frames *frames, struct input *input)
{
    const int k = input->stack.reference - 1;
    struct refocus_photo *const photo = input->photo;
    struct input other;
    int status;

    if (k == frames->reference || standard_is(frames->file[k]))
        return EXIT_DONE;
    status = stack_frames_photo(frames, k, &other);
    for (int y = 0; status == EXIT_DONE && y < input->height; y++)
        memcpy(other.photo->image->plane[0] + y * other.photo->image->stride[0],
               photo->image->plane[0] + y * photo->image->stride[0], 3 * (size_t)input->width);
    if (status == EXIT_DONE) {
        input->photo = other.photo;
        other.photo = photo;
    }
    input_free(&other);
    return status;
}
