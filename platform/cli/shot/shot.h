/* One photo on the table: read, prepared, with its lens setting in engine.params. */
#ifndef RF_CLI_SHOT_H
#define RF_CLI_SHOT_H

#include "shot/engine.h"
#include "inputs/inputs.h"

struct shot_settings {
    const struct depth_settings *depth;
    const struct lens_settings *lens;
    const struct engine_settings *engine;
    double most_blur; /* the renderer is made for, where that is more than K; 0: K */
};

struct shot {
    struct input input;
    struct engine engine;
};

/* Exit code; prints why it is not EXIT_DONE. Ended by shot_close(), whatever it returned. */
int shot_open(struct shot *shot, const char *photo, const struct shot_settings *settings);
void shot_close(struct shot *shot);

/* A picture to render into, of the whole photo or, where region[0] is not NAN, of X, Y, width
 * and height in it; plane[0] is to be freed. Exit code as above. */
int shot_output(struct shot *shot, const double region[4], struct refocus_image *out);

#endif
