/* fuzz_config.c: configuration files over a table with every kind of option: values that are taken
 * are in their ranges, and of one group one alone. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "line/subcommands.h"
#include "line/report.h"
#include "options.h"
#include "settings/config.h"

const struct command *const commands[] = {&fuzz_command, NULL};

const struct command *commands_find(const char *name)
{
    return strcmp(name, fuzz_command.name) == 0 ? &fuzz_command : NULL;
}

static void check(const uint8_t *data, size_t size, const char *section)
{
    struct values v = {false, 0.5, {NAN, NAN, NAN, NAN}, NAN, NULL, 0};
    bool found;
    const int status =
        config_read(&fuzz_command, "file", (const char *)data, size, section, &v, &found);

    if (status != OPTIONS_PARSED && status != EXIT_FAILED)
        abort();
    if (status != OPTIONS_PARSED)
        return;
    fuzz_check_values(&v);
    if (!found && (v.number != 0.5 || v.flag || v.text || v.choice))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    check(data, size, "fuzz");
    check(data, size, "preset mine");
    return 0;
}
