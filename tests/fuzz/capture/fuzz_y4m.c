/* fuzz_y4m.c: any bytes as a Y4M stream. */
#include "source.h"

#include <stdio.h>
#include <unistd.h>

static void run(const uint8_t *data, size_t size)
{
    char path[64], name[80];
    const int fd = fuzz_open(data, size, path);

    snprintf(name, sizeof name, "y4m:%s", path);
    fuzz_source(name);
    close(fd);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run_failing(run, data, size);
    return 0;
}
