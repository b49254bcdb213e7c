/* fuzz_settings.c: files of settings over a table with every kind of option: values that are
 * taken are in their ranges. */
#include <math.h>
#include <stdlib.h>
#include "line/report.h"
#include "options.h"
#include "outputs/outputs.h"
#include "settings/settings.h"

int output_check(const char *path, unsigned kinds, const char *const *others,
                 const char *const *inputs, int input_count)
{
    (void)path;
    (void)kinds;
    (void)others;
    (void)inputs;
    (void)input_count;
    return EXIT_DONE;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct values v = {false, NAN, {NAN, NAN, NAN, NAN}, NAN, NULL, 0};
    const int status = settings_read(&fuzz_command, "file", (const char *)data, size, &v);

    if (status != OPTIONS_PARSED && status != EXIT_FAILED)
        abort();
    if (status == OPTIONS_PARSED)
        fuzz_check_values(&v);
    settings_forget();
    return 0;
}
