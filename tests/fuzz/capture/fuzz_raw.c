/* fuzz_raw.c: any bytes as a raw stream. The first line is what follows the comma after the
 * file's name; the rest is the file. */
#include "source.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static void run(const uint8_t *data, size_t size)
{
    const uint8_t *end = memchr(data, '\n', size);
    const size_t length = end ? (size_t)(end - data) : size;
    char path[64], name[512];
    int fd;

    if (length > 256)
        return;
    fd = fuzz_open(end ? end + 1 : data, end ? size - length - 1 : 0, path);
    snprintf(name, sizeof name, "raw:%s,%.*s", path, (int)length, (const char *)data);
    fuzz_source(name);
    close(fd);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size > 0)
        fuzz_run_failing(run, data, size);
    return 0;
}
