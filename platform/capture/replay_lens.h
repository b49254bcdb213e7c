/* replay_lens.h: the lens of a scripted camera: it moves frame by frame, may stick and report a
 * wrong position, and decides which picture of a focus stack is seen. */
#ifndef RF_CAPTURE_REPLAY_LENS_H
#define RF_CAPTURE_REPLAY_LENS_H

#include "backend.h"
#include "replay_script.h"

struct rf_lens {
    double position, target;
    double shown; /* in the frame that was last taken; NAN before */
    int picture;  /* number of the picture that is open, or -1 */
};

void rf_lens_start(struct rf_lens *lens, const struct rf_script *script);
void rf_lens_describe(const struct rf_lens *lens, const struct rf_script *script,
                      struct refocus_source_lens *out);
void rf_lens_focus(struct rf_lens *lens, const struct rf_script *script, uint32_t mode,
                   double position);
/* The lens goes on by one frame; the frame says where it is. */
void rf_lens_move(struct rf_lens *lens, const struct rf_script *script,
                  struct refocus_frame *frame);
/* Opens the picture that the lens sees, unless it is open. */
int rf_lens_look(struct rf_lens *lens, const struct rf_script *script,
                 struct refocus_source **picture, struct refocus_reason *reason);

#endif
