/* view_save.h: the files that `refocus view` saves. */
#ifndef RF_CLI_VIEW_SAVE_H
#define RF_CLI_VIEW_SAVE_H

#include "inputs/read_input.h"
#include "view/session.h"

struct view_names {
    char picture[1024], settings[1024], depth[1024];
};

struct view_saving {
    struct view_names names;
    const struct input *input;
    /* Writes the options that make the picture; an exit code. */
    int (*settings)(void *of, const struct rf_view_result *result, const char *file);
    void *of;
    bool quiet; /* say nothing of what was saved */
    int saved;  /* files written, and failures */
    int failed;
};

/* Names beside `output`, or made of the photo's in this folder when it is NULL; false
 * when they are too long. */
bool view_make_names(struct view_names *names, const char *output, const char *photo);

/* A callback for rf_session_setup.save; user is a struct view_saving. */
void view_save(void *user, const struct rf_view_result *result, char words[RF_VIEW_WORDS]);

#endif
