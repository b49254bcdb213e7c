/* settings.c: settings that come from the page: the members of a file of settings, but for those
 * that name files. */
#include "serve/serving.h"
#include "shot/shot_options.h"

static const struct option options[] = {
    GROUP_HERE(shot_lens_options),
    GROUP_HERE(shot_method_options),
    {.help = NULL},
};

const struct command page_settings = {.name = "settings", .usage = "", .table = options};

static int check(struct shot_settings *settings)
{
    const struct engine_settings *const engine = &settings->engine;

    if (engine->controls.focus_map || engine->controls.sharp_mask)
        return report_failure(EXIT_WRONG, "settings", "one of them names a file; leave it out");
    if (refocus_method_traits((uint32_t)engine->method) & REFOCUS_METHOD_WHOLE_PHOTO)
        return report_failure(EXIT_WRONG, "settings: method", "'%s' is too slow for the page",
                              refocus_method_name((uint32_t)engine->method));
    return engine->aperture ? bokeh_check_is_shape("settings: aperture", engine->aperture)
                            : EXIT_DONE;
}

int page_settings_read(const char *bytes, size_t size, const struct shot_settings *base,
                       struct shot_settings *settings)
{
    struct shot_settings taken = *base;
    json_error_t error;
    json_t *const root =
        json_loadb(size > 0 ? bytes : "{}", size > 0 ? size : 2, JSON_REJECT_DUPLICATES, &error);
    int status;

    if (!root)
        return report_failure(EXIT_WRONG, "settings", "they are not JSON: line %d, column %d: %s",
                              error.line, error.column, error.text);
    status = settings_take(&page_settings, "settings", root, &taken);
    json_decref(root);
    if (status != OPTIONS_PARSED)
        return status;
    *settings = taken;
    return check(settings);
}
