/* replay.h: the state of a camera by script, which replay.c runs. */
#ifndef RF_REPLAY_H
#define RF_REPLAY_H

#include "backend.h"
#include "replay_lens.h"
#include "replay_script.h"
#include "ring.h"

struct rf_replay {
    struct rf_script script;
    uint32_t format; /* as they are now, after changes */
    int width, height;
    int64_t stride;
    uint8_t *scene; /* the frame at rest, in the present format, or the bytes of the
                       JPEG */
    size_t scene_bytes;
    struct refocus_source *inner; /* source of "from", or a picture of the stack */
    struct rf_lens lens;
    int64_t next;  /* the frame to come */
    int64_t first; /* the frame that was due when the pace began */
    struct rf_pace pace;
    int64_t stalled_until_ns, gone_until_ns;
    bool failed, changed, gone;
    uint32_t refused; /* buffers that will be lost on their return */
    int stuck;        /* buffers that were lost so far */
    struct rf_ring ring;
};

/* The faults of one frame; those of the stream change the state above at once. */
struct rf_frame_faults {
    int64_t dropped, late_ms, shift_ms;
    bool corrupt, queue_error, memory;
};

/* Each returns REFOCUS_OK or an error, with its reason. */

/* Read and parse the script of a name behind "replay:"; rf_script_free() in any case. */
int rf_replay_read_script(struct rf_script *script, const char *rest,
                          struct refocus_reason *reason);

/* Draw the scene anew in the format, size and stride of now. */
int rf_replay_draw(struct rf_replay *replay, struct refocus_reason *reason);

/* Read the script's JPEG file, and take the size of its frames. */
int rf_replay_read_jpeg(struct rf_replay *replay, struct refocus_reason *reason);

/* Fill a buffer of the ring with the frame `replay->next`, and say in *frame where it lies. */
int rf_replay_fill(struct rf_replay *replay, int buffer, struct refocus_frame *frame,
                   struct refocus_reason *reason);

/* Move `replay->next` past the frames that are dropped, by the script or because all buffers were
 * full, and find the faults of the frame that comes instead. */
int rf_replay_next(struct rf_replay *replay, struct rf_frame_faults *faults,
                   struct refocus_reason *reason);

/* Whether frames can come at all: the device is there, the stream has not failed, and the script
 * is not at its end. */
int rf_replay_check(const struct rf_replay *replay, struct refocus_reason *reason);

/* When a frame is due, in nanoseconds of rf_now_ns(). */
int64_t rf_replay_due(const struct rf_replay *replay, int64_t frame);

#endif
