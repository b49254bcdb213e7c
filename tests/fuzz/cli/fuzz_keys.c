/* fuzz_keys.c: key frames: what is taken gives values in their ranges at any time. */
#include <math.h>
#include <stdlib.h>
#include "settings/keys.h"
#include "line/options.h"
#include "line/report.h"

const char *options_nearest(const char *text, const char *(*word)(const void *list, int i),
                            const void *list)
{
    (void)text;
    return word(list, 0);
}

static void check(const struct keys *keys)
{
    const double seconds = keys_seconds(keys);

    if (!(seconds > 0 && seconds <= 3600))
        abort();
    for (int i = -1; i <= 9; i++) {
        struct refocus_settings p = refocus_settings_default(0.5f, 10);

        keys_apply(keys, seconds * i / 8, &p);
        if (!(p.render.focus_disparity >= 0 && p.render.focus_disparity <= 1 &&
              p.render.max_blur_radius >= 0 &&
              p.render.max_blur_radius <= REFOCUS_MAX_BLUR_RADIUS && p.highlights.gain >= 1 &&
              p.field.falloff >= 0.0009f))
            abort();
        if ((double)p.render.max_blur_radius > fmax(keys_most(keys, "blur", 10), 10) + 1e-4)
            abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct keys *keys = NULL;

    if (keys_read(&keys, "file", (const char *)data, size) == EXIT_DONE)
        check(keys);
    else if (keys)
        abort();
    keys_free(keys);
    return 0;
}
