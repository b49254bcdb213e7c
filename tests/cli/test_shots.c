/* test_shots.c: what `refocus stack` asks of a camera: frames of --size, or of any. What the
 * command prints and writes is not linked, as the camera does not begin. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <refocus/refocus.h>
#include "commands/stack_shots.h"
#include "inputs/inputs.h"
#include "line/interrupt.h"
#include "line/report.h"
#include "outputs/outputs.h"

static struct refocus_source_config asked;

int __wrap_refocus_source_start(struct refocus_source *source,
                                const struct refocus_source_config *config,
                                struct refocus_source_mode *mode, struct refocus_reason *reason);

int __wrap_refocus_source_start(struct refocus_source *source,
                                const struct refocus_source_config *config,
                                struct refocus_source_mode *mode, struct refocus_reason *reason)
{
    (void)source;
    (void)mode;
    (void)reason;
    asked = *config;
    return REFOCUS_ERR_IO;
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
    (void)image;
    (void)options;
    return EXIT_FAILED;
}

int output_write_file(const char *path, const void *bytes, size_t size)
{
    (void)path;
    (void)bytes;
    (void)size;
    return EXIT_FAILED;
}

static void size_is_asked_for(void **state)
{
    static const struct {
        double given[2];
        int32_t width, height;
    } cases[] = {{{1280, 720}, 1280, 720}, {{480, 640}, 480, 640}, {{NAN, NAN}, 0, 0}};

    (void)state;
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(size_is_asked_for)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
