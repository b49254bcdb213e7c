/* fuzz_settings.c: settings as a page sends them: what is taken is in its range, and names no file.
 */
#include <stdlib.h>
#include <string.h>
#include "serve/serving.h"

static bool in(double value, double least, double most)
{
    return isnan(value) || (value >= least && value <= most);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct shot_settings base = SHOT_SETTINGS_NONE;
    struct shot_settings settings;
    struct engine engine;
    char why[256] = "";
    int status;

    report_keep(why, sizeof why);
    status = page_settings_read((const char *)data, size, &base, &settings);
    if (status != EXIT_DONE && !why[0])
        abort();
    if (status != EXIT_DONE)
        return 0;
    if (!in(settings.lens.focus, 0, 1) || !in(settings.lens.blur, 0, REFOCUS_MAX_BLUR_RADIUS) ||
        !in(settings.engine.highlights, 0, 16) || !in(settings.engine.controls.focus_width, 0, 1) ||
        settings.engine.controls.focus_map || settings.engine.controls.sharp_mask ||
        settings.depth.file || settings.depth.matte || settings.engine.papers.field_map)
        abort();
    /* The aperture would be read here, were it a file. */
    if (settings.engine.aperture &&
        (settings.engine.aperture[0] == '/' || settings.engine.aperture[0] == '.'))
        abort();
    engine_begin(&engine, &settings.engine);
    engine_end(&engine);
    return 0;
}
