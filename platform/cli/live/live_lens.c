/* live_lens.c: the camera's own lens is focused as the command line asks, and reported. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "inputs/read_input.h"
#include "line/report.h"
#include "live/live_lens.h"

static const char *const words[REFOCUS_SOURCE_FOCUS_COUNT] = {
    [REFOCUS_SOURCE_FOCUS_CONTINUOUS] = "continuous",
    [REFOCUS_SOURCE_FOCUS_ONCE] = "once",
    [REFOCUS_SOURCE_FOCUS_FIXED] = "fixed",
    [REFOCUS_SOURCE_FOCUS_OFF] = "off"};

int live_lens_parse(struct live_lens_settings *settings, const char *text)
{
    const size_t word = strcspn(text ? text : "", ":");
    char *end;

    if (!text)
        return EXIT_DONE;
    for (uint32_t mode = 0; mode < REFOCUS_SOURCE_FOCUS_COUNT; mode++) {
        const bool placed = mode == REFOCUS_SOURCE_FOCUS_FIXED;

        if (strlen(words[mode]) != word || strncmp(text, words[mode], word) != 0 ||
            placed != (text[word] == ':'))
            continue;
        *settings = (struct live_lens_settings){true, mode, 0};
        if (!placed)
            return EXIT_DONE;
        settings->position = strtod(text + word + 1, &end);
        if (text[word + 1] && !*end && isfinite(settings->position))
            return EXIT_DONE;
    }
    return report_failure(EXIT_WRONG, "--autofocus",
                          "'%.60s' is none; give off, once, continuous or fixed:POSITION", text);
}

/* "off, once, fixed:0 to fixed:10 dioptres" */
static void list_ways(const struct refocus_source_lens *lens, char *text, size_t size)
{
    size_t n = 0;

    text[0] = '\0';
    for (uint32_t i = REFOCUS_SOURCE_FOCUS_COUNT; i-- > 0;) {
        if (!(lens->modes >> i & 1) || n >= size)
            continue;
        n += (size_t)snprintf(text + n, size - n, "%s%s", n ? ", " : "", words[i]);
        if (i == REFOCUS_SOURCE_FOCUS_FIXED && n < size)
            n += (size_t)snprintf(text + n, size - n, ":%g to %g%s", lens->least, lens->greatest,
                                  lens->dioptres ? " dioptres" : "");
    }
}

int live_lens_ask(struct refocus_source *source, const char *name,
                  const struct live_lens_settings *settings)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    struct refocus_reason reason = {""};
    char ways[160];
    int status;

    if (!settings->wanted)
        return EXIT_DONE;
    status = refocus_source_set_focus(source, settings->mode, settings->position, &reason);
    if (status == REFOCUS_OK)
        return EXIT_DONE;
    if (status == REFOCUS_ERR_UNSUPPORTED && refocus_source_get_lens(source, &lens, NULL) == 0) {
        list_ways(&lens, ways, sizeof ways);
        return report_failure(EXIT_FAILED, "--autofocus", "%s: %s; %s%s", name, reason.text,
                              lens.modes ? "it takes " : "leave it out", ways);
    }
    return report_failure(input_exit_code(status), "--autofocus", "%s: %s", name,
                          reason.text[0] ? reason.text : refocus_strerror(status));
}

void live_lens_print(struct refocus_source *source)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    char ways[160];

    if (refocus_source_get_lens(source, &lens, NULL) != REFOCUS_OK || !lens.modes)
        return;
    list_ways(&lens, ways, sizeof ways);
    printf("lens, --autofocus %s\n", ways);
}

json_t *live_lens_json(struct refocus_source *source, const struct live_lens_settings *settings)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    json_t *json;

    if (refocus_source_get_lens(source, &lens, NULL) != REFOCUS_OK || !lens.modes)
        return json_null();
    json =
        json_pack("{s:s?, s:o, s:b}", "autofocus", settings->wanted ? words[settings->mode] : NULL,
                  "position", report_number_json(lens.position), "dioptres", lens.dioptres != 0);
    if (json && lens.modes >> REFOCUS_SOURCE_FOCUS_FIXED & 1) {
        json_object_set_new(json, "least", json_real(lens.least));
        json_object_set_new(json, "greatest", json_real(lens.greatest));
    }
    return json;
}
