/* fuzz_calibration.c: calibration files: what is accepted must be sound enough to register depth
 * with. Allocations fail in our code alone: Jansson 2.14 itself goes astray when some of its own
 * do. */
#include <stdlib.h>
#include <string.h>
#include "with_failures.h"
#include "line/report.h"
#include "live/live_calibration.h"

enum { MOST_SIDE = 64 };

/* The input: no file is made for it. */
static const char *text;
static size_t length;

json_t *__wrap_json_load_file(const char *path, size_t flags, json_error_t *error);

json_t *__wrap_json_load_file(const char *path, size_t flags, json_error_t *error)
{
    (void)path;
    return json_loadb(text, length, flags, error);
}

static void use(const struct refocus_calibration *c)
{
    static uint16_t samples[MOST_SIDE * MOST_SIDE], out[MOST_SIDE * MOST_SIDE];

    if (c->depth.width < 1 || c->depth.height < 1 || c->colour.width < 1 || c->colour.height < 1 ||
        !(c->depth.fx > 0) || !(c->colour.fy > 0))
        abort();
    if (c->depth.width > MOST_SIDE || c->depth.height > MOST_SIDE || c->colour.width > MOST_SIDE ||
        c->colour.height > MOST_SIDE)
        return;
    for (int i = 0; i < c->depth.width * c->depth.height; i++)
        samples[i] = (uint16_t)(i * 2654435761u >> 12);
    refocus_register_depth(c, samples, 0.001, out);
}

static void run(const uint8_t *data, size_t size)
{
    struct refocus_calibration *calibration = NULL;

    text = (const char *)data;
    length = size;
    if (live_read_calibration(&calibration, "calibration") == EXIT_DONE)
        use(calibration);
    else if (calibration)
        abort();
    free(calibration);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run_failing(run, data, size);
    return 0;
}
