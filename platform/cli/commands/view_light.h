/* view_light.h: `refocus view` renders photos of more than 8 bits, and gain maps, as `refocus
 * render` does. */
#ifndef RF_CLI_VIEW_LIGHT_H
#define RF_CLI_VIEW_LIGHT_H

#include "shot/shot.h"
#include "view/session.h"

struct view_light {
    const struct input *input;
    const char *output; /* name of the picture that is saved, or NULL: a JPEG */
    bool adds_grain;    /* pictures of 8 bits have grain, which no option gives or refuses */
};

/* Called between engine_begin() and the reading of the photo, of which is taken what a picture
 * of that name is made of (NULL: of 8 bits): --transfer and --white are refused where the engine
 * cannot render light. */
void view_light_begin(struct view_light *light, struct engine *engine,
                      struct shot_settings *settings, const char *output);

/* Called when it was read. By --transfer and --white the photo of 8 bits, which quick pictures are
 * made of, gets the tones of what is rendered. An exit code, and prints why it is not EXIT_DONE. */
int view_light_settle(const struct engine *engine, const struct shot_settings *settings,
                      struct input *input);

/* Give the session all that the photo holds; light and input stay the caller's until it ends. */
void view_light_join(struct view_light *light, const struct input *input,
                     struct rf_session_setup *session);

#endif
