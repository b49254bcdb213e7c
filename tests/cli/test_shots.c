/* test_shots.c: what `refocus stack` asks of a camera, in which order, and what it makes of frames.
 * What the command prints and writes is not linked. */
#define _GNU_SOURCE /* memmem */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/platform/convert.h>
#include <refocus/refocus.h>
#include "commands/stack_shots.h"
#include "inputs/read_input.h"
#include "line/interrupt.h"
#include "line/report.h"
#include "outputs/outputs.h"

static struct refocus_source_config asked;
static bool begins;     /* The camera begins. */
static char calls[200]; /* words for what the lens and the exposure were told */
static int frames, written;

#define WRAPPED(name, ...)                                                                         \
    int __wrap_##name(__VA_ARGS__);                                                                \
    int __real_##name(__VA_ARGS__)
WRAPPED(refocus_source_start, struct refocus_source *, const struct refocus_source_config *,
        struct refocus_source_mode *, struct refocus_reason *);
WRAPPED(refocus_source_set_focus, struct refocus_source *, uint32_t, double,
        struct refocus_reason *);
WRAPPED(refocus_source_lock_exposure, struct refocus_source *, int, struct refocus_reason *);
WRAPPED(refocus_convert_rgb8, struct refocus_converter *, const struct refocus_frame *,
        const struct refocus_image *, struct refocus_reason *);

int __wrap_refocus_source_start(struct refocus_source *source,
                                const struct refocus_source_config *config,
                                struct refocus_source_mode *mode, struct refocus_reason *reason)
{
    asked = *config;
    return begins ? __real_refocus_source_start(source, config, mode, reason) : REFOCUS_ERR_IO;
}

int __wrap_refocus_source_set_focus(struct refocus_source *source, uint32_t mode, double position,
                                    struct refocus_reason *reason)
{
    const size_t n = strlen(calls);

    if (mode == REFOCUS_SOURCE_FOCUS_FIXED)
        snprintf(calls + n, sizeof calls - n, "%g ", position);
    else
        snprintf(calls + n, sizeof calls - n, "mode %u ", mode);
    return __real_refocus_source_set_focus(source, mode, position, reason);
}

int __wrap_refocus_source_lock_exposure(struct refocus_source *source, int lock,
                                        struct refocus_reason *reason)
{
    (void)source;
    (void)reason;
    strcat(calls, lock ? "lock " : "unlock ");
    return REFOCUS_OK;
}

/* Frames are 10 and 11 in turns. */
int __wrap_refocus_convert_rgb8(struct refocus_converter *converter,
                                const struct refocus_frame *frame, const struct refocus_image *out,
                                struct refocus_reason *reason)
{
    (void)converter;
    (void)reason;
    assert_false(frame->flags & REFOCUS_FRAME_CORRUPT);
    for (int y = 0; y < out->height; y++)
        memset(out->plane[0] + y * out->stride[0], 10 + frames % 2, 3 * (size_t)out->width);
    frames++;
    return REFOCUS_OK;
}

int report_failure(int exit_code, const char *what, const char *why, ...)
{
    (void)what;
    (void)why;
    return exit_code;
}

void report_warning(const char *what, const char *why, ...)
{
    (void)what;
    (void)why;
}

void report_progress(const char *doing, double done)
{
    (void)doing;
    (void)done;
}

void report_progress_end(void)
{
}

void interrupt_call(void (*function)(void *), void *of)
{
    (void)function;
    (void)of;
}

int input_exit_code(int status)
{
    (void)status;
    return EXIT_FAILED;
}

int output_write_image(const char *path, const struct refocus_image *image,
                       const struct refocus_write_options *options)
{
    (void)path;
    (void)options;
    written++;
    for (int x = 0; x < 3 * image->width; x++)
        assert_int_equal(image->plane[0][x], 11); /* the mean of 10 and 11, rounded */
    return EXIT_DONE;
}

int output_write_file(const char *path, const void *bytes, size_t size)
{
    (void)path;
    assert_non_null(memmem(bytes, size, "0.0,\n  1.0,\n  2.0\n", 17));
    return EXIT_DONE;
}

TEST(size_is_asked_for)
{
    static const struct {
        double given[2];
        int32_t width, height;
    } cases[] = {{{1280, 720}, 1280, 720}, {{480, 640}, 480, 640}, {{NAN, NAN}, 0, 0}};

    for (int i = 0; i < 3; i++) {
        const struct shots_settings settings = {.camera = "replay::size 64x48;lens 0 2",
                                                .steps = 2,
                                                .range = {NAN, NAN},
                                                .average = 1,
                                                .size = {cases[i].given[0], cases[i].given[1]}};
        struct shots shots;

        assert_int_equal(shots_plan(&shots, &settings, NULL), EXIT_DONE);
        assert_int_equal(shots_take(&shots, ".", ".ppm"), EXIT_FAILED);
        shots_end(&shots);
        assert_int_equal(asked.width, cases[i].width);
        assert_int_equal(asked.height, cases[i].height);
        assert_int_equal(asked.flags, REFOCUS_SOURCE_FAST);
    }
}

/* The exposure is that of the middle, and locked as long as pictures are taken, from the farthest
 * to the nearest; then the lens is the camera's again. Damaged frames are none: half of these are.
 */
TEST(the_camera_is_left_as_it_was)
{
    char script[4096] = "replay::size 4x4;lens 0 2;lens-speed 1";
    const struct shots_settings settings = {
        .camera = script, .steps = 3, .range = {NAN, NAN}, .average = 2, .size = {NAN, NAN}};
    struct shots shots;

    for (int n = 0; n < 200; n += 2)
        sprintf(script + strlen(script), ";at %d corrupt", n);
    begins = true;
    assert_int_equal(shots_plan(&shots, &settings, NULL), EXIT_DONE);
    calls[0] = '\0';
    assert_int_equal(shots_take(&shots, ".", ".ppm"), EXIT_DONE);
    assert_true(frames == 6 && written == 3);
    assert_string_equal(calls, "1 lock 0 1 2 unlock mode 0 ");
    shots_end(&shots);
    begins = false;
}
