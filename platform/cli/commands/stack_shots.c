/* stack_shots.c: a camera moves its lens and photographs a focus stack, into a folder or for
 * whoever takes the pictures.
 */
#include "commands/stack_shots.h"
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <refocus/platform/convert.h>
#include "line/interrupt.h"
#include "line/report.h"
#include "outputs/outputs.h"

enum { MEASURE_MS = 1000 }; /* the camera finds its exposure in that time */

/* ----- plan ----- */

static int plan_range(struct shots *shots)
{
    const char *option = shots->settings->option;
    const double *range = shots->settings->range;
    const struct refocus_source_lens *lens = &shots->lens;
    const bool given = !isnan(range[0]);
    const double from = given ? range[0] : lens->least, to = given ? range[1] : lens->greatest;

    if (!(from >= lens->least && to <= lens->greatest && from < to))
        return report_failure(EXIT_WRONG,
                              !given   ? shots->settings->camera
                              : option ? option
                                       : "--range",
                              "its lens goes from %g to %g; give the farther one first",
                              lens->least, lens->greatest);
    shots->count = (int)shots->settings->steps;
    for (int k = 0; k < shots->count; k++)
        shots->asked[k] = from + (to - from) * k / (shots->count - 1);
    for (int k = 1; k < shots->count && !lens->dioptres; k++) /* steps are whole numbers */
        if (lround(shots->asked[k]) == lround(shots->asked[k - 1]))
            return report_failure(EXIT_WRONG, option ? option : "--steps",
                                  "its lens has %g positions in that range; give fewer steps",
                                  to - from + 1);
    return EXIT_DONE;
}

int shots_plan(struct shots *shots, const struct shots_settings *settings,
               struct refocus_source *source)
{
    struct refocus_reason reason = {""};
    int status = REFOCUS_OK;

    memset(shots, 0, sizeof *shots);
    shots->settings = settings;
    shots->lens = refocus_source_lens_default();
    shots->source = source;
    if (!source)
        status = refocus_source_open(&shots->source, settings->camera, &reason);
    if (status == REFOCUS_OK)
        status = refocus_source_get_lens(shots->source, &shots->lens, &reason);
    if (status != REFOCUS_OK)
        return shots_fail(shots, status, &reason);
    if (!(shots->lens.modes >> REFOCUS_SOURCE_FOCUS_FIXED & 1))
        return report_failure(EXIT_FAILED, settings->camera,
                              "its lens cannot be moved; focus by hand, and give the pictures to "
                              "refocus depth --focal-stack");
    return plan_range(shots);
}

void shots_end(struct shots *shots)
{
    refocus_source_close(&shots->source);
}

/* ----- pictures ----- */

struct picture {
    struct refocus_converter *converter;
    int width, height;
    uint8_t *rgb;
    uint16_t *sum; /* up to 64 frames added up */
};

/* Makes it as large as the first frame; all others have to be so, too. */
static int make_picture(struct picture *picture, const struct shots *shots,
                        const struct refocus_frame *frame)
{
    const uint64_t bytes = 3 * (uint64_t)frame->width * (uint64_t)frame->height;

    if (picture->rgb)
        return frame->width == picture->width && frame->height == picture->height
                   ? EXIT_DONE
                   : report_failure(EXIT_FAILED, shots->settings->camera,
                                    "its frames have changed their size");
    picture->width = frame->width;
    picture->height = frame->height;
    picture->rgb = bytes <= SIZE_MAX / 2 ? malloc((size_t)bytes) : NULL;
    picture->sum = bytes <= SIZE_MAX / 2 ? malloc(2 * (size_t)bytes) : NULL;
    return picture->rgb && picture->sum && !refocus_converter_create(&picture->converter)
               ? EXIT_DONE
               : report_failure(EXIT_FAILED, shots->settings->camera, "not enough memory");
}

static int add_frame(struct shots *shots, struct picture *picture)
{
    struct refocus_reason reason = {""};
    const struct refocus_frame *frame;
    int status = shots_next_frame(shots, &frame);

    if (status != EXIT_DONE)
        return status;
    status = make_picture(picture, shots, frame);
    if (status == EXIT_DONE) {
        const struct refocus_image image = refocus_image_packed(
            REFOCUS_FORMAT_RGB8, picture->rgb, frame->width, frame->height, 3 * frame->width);
        const int got = refocus_convert_rgb8(picture->converter, frame, &image, &reason);

        status = got == REFOCUS_OK ? EXIT_DONE : shots_fail(shots, got, &reason);
    }
    refocus_source_release(shots->source, frame);
    return status;
}

/* The mean of the frames at one position. */
static int take_picture(struct shots *shots, struct picture *picture)
{
    const int frames = (int)shots->settings->average;
    int status = EXIT_DONE;

    for (int i = 0; i < frames && status == EXIT_DONE; i++) {
        status = add_frame(shots, picture);
        const size_t bytes = 3 * (size_t)picture->width * (size_t)picture->height;

        for (size_t b = 0; b < bytes && status == EXIT_DONE && frames > 1; b++) {
            picture->sum[b] = (uint16_t)((i ? picture->sum[b] : frames / 2) + picture->rgb[b]);
            if (i + 1 == frames)
                picture->rgb[b] = (uint8_t)(picture->sum[b] / frames);
        }
    }
    return status;
}

bool shots_name(char name[SHOTS_NAME], const char *folder, int k, const char *ending)
{
    const int n = k < 0 ? snprintf(name, SHOTS_NAME, "%s/stack.json", folder)
                        : snprintf(name, SHOTS_NAME, "%s/%02d%s", folder, k, ending);

    return n > 0 && n < SHOTS_NAME;
}

void shots_remove(const struct shots *shots, const char *folder, const char *ending)
{
    char name[SHOTS_NAME];

    for (int k = -1; k < shots->count; k++)
        if (shots_name(name, folder, k, ending))
            unlink(name);
    rmdir(folder);
}

/* Positions without a unit count from the first, since they may be below 0. */
static int write_positions(const struct shots *shots, const char *folder, const char *ending)
{
    json_t *json = json_object(), *positions = json_array(), *frames = json_array();
    const double first = shots->lens.dioptres ? 0 : shots->reported[0];
    char name[SHOTS_NAME];
    char *text = NULL;
    int status;

    for (int k = 0; k < shots->count; k++) {
        snprintf(name, sizeof name, "%02d%s", k, ending);
        json_array_append_new(positions, json_real(shots->reported[k] - first));
        json_array_append_new(frames, json_string(name));
    }
    if (!json_object_set_new(json, "dioptres", json_boolean(shots->lens.dioptres)) &&
        !json_object_set_new(json, "positions", positions) &&
        !json_object_set_new(json, "frames", frames))
        text = json_dumps(json, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    json_decref(json);
    shots_name(name, folder, -1, ending);
    status = text ? output_write_file(name, text, strlen(text))
                  : report_failure(EXIT_FAILED, name, "not enough memory");
    free(text);
    return status;
}

/* ----- all of it ----- */

static void interrupt_source(void *source)
{
    refocus_source_interrupt(source);
}

static int start(struct shots *shots)
{
    const struct shots_settings *settings = shots->settings;
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_reason reason = {""};
    int status;

    if (!isnan(settings->size[0])) {
        config.width = (int32_t)settings->size[0];
        config.height = (int32_t)settings->size[1];
    }
    if (refocus_source_kind(settings->camera) == REFOCUS_SOURCE_KIND_SCRIPT)
        config.flags = REFOCUS_SOURCE_FAST;
    status = refocus_source_start(shots->source, &config, NULL, &reason);
    return status == REFOCUS_OK ? EXIT_DONE : shots_fail(shots, status, &reason);
}

/* The exposure is that of the middle of the range. */
static int lock_exposure(struct shots *shots)
{
    struct refocus_reason reason = {""};
    int status = shots_focus(shots, shots->asked[shots->count / 2]);

    if (status == EXIT_DONE)
        status = shots_pass_time(shots, MEASURE_MS);
    if (status != EXIT_DONE)
        return status;
    status = refocus_source_lock_exposure(shots->source, 1, &reason);
    if (status == REFOCUS_ERR_UNSUPPORTED)
        report_warning(shots->settings->camera, "its exposure cannot be locked; frames may differ");
    else if (status != REFOCUS_OK)
        return shots_fail(shots, status, &reason);
    return EXIT_DONE;
}

static void warn_of_positions(const struct shots *shots)
{
    for (int k = 0; k < shots->count; k++)
        if (fabs(shots->reported[k] - shots->asked[k]) > 0.25 * shots_step(shots)) {
            report_warning(shots->settings->camera,
                           "its lens reports %g where %g was asked for; depth goes by what it "
                           "reports",
                           shots->reported[k], shots->asked[k]);
            return;
        }
}

int shots_photograph(struct shots *shots, shots_picture_fn *take, void *user)
{
    struct picture picture = {0};
    int status = lock_exposure(shots);

    for (int k = 0; k < shots->count && status == EXIT_DONE; k++) {
        report_progress("photographing", (double)k / shots->count);
        status = shots_move_lens(shots, k);
        if (status == EXIT_DONE)
            status = take_picture(shots, &picture);
        if (status == EXIT_DONE) {
            const struct refocus_image image = refocus_image_packed(
                REFOCUS_FORMAT_RGB8, picture.rgb, picture.width, picture.height, 3 * picture.width);

            status = take(user, shots, k, &image);
        }
    }
    refocus_source_lock_exposure(shots->source, 0, NULL);
    report_progress_end();
    if (status == EXIT_DONE)
        warn_of_positions(shots);
    refocus_converter_destroy(&picture.converter);
    free(picture.rgb);
    free(picture.sum);
    return status;
}

struct place {
    const char *folder, *ending;
};

static int write_picture(void *user, const struct shots *shots, int k,
                         const struct refocus_image *image)
{
    const struct place *place = user;
    char name[SHOTS_NAME];

    (void)shots;
    return shots_name(name, place->folder, k, place->ending)
               ? output_write_image(name, image, NULL)
               : report_failure(EXIT_FAILED, place->folder, "the name is too long");
}

int shots_take(struct shots *shots, const char *folder, const char *ending)
{
    struct place place = {folder, ending};
    int status;

    interrupt_call(interrupt_source, shots->source);
    status = start(shots);
    if (status == EXIT_DONE)
        status = shots_photograph(shots, write_picture, &place);
    interrupt_call(NULL, NULL);
    if (shots->lens.modes >> REFOCUS_SOURCE_FOCUS_CONTINUOUS & 1) /* the camera's own again */
        refocus_source_set_focus(shots->source, REFOCUS_SOURCE_FOCUS_CONTINUOUS, 0, NULL);
    return status == EXIT_DONE ? write_positions(shots, folder, ending) : status;
}
