/* live_lens.h: how the camera's own lens comes to its focus. */
#ifndef RF_CLI_LIVE_LENS_H
#define RF_CLI_LIVE_LENS_H

#include <stdbool.h>
#include <jansson.h>
#include <refocus/platform/source.h>

struct live_lens_settings {
    bool wanted; /* false: as the camera does without being asked */
    uint32_t mode;
    double position;
};

/* "off", "once", "continuous" or "fixed:POSITION", NULL for none; an exit code, and prints why. */
int live_lens_parse(struct live_lens_settings *settings, const char *text);
/* Ask a source that is open; an exit code, and prints why. */
int live_lens_ask(struct refocus_source *source, const char *name,
                  const struct live_lens_settings *settings);
/* A line of what the lens can do; nothing where it does not move. */
void live_lens_print(struct refocus_source *source);
/* Where the lens is, and what was asked of it; null where it does not move. */
json_t *live_lens_json(struct refocus_source *source, const struct live_lens_settings *settings);

#endif
