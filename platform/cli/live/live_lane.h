/* live_lane.h: the frames of one camera, which is taken up again after a fault. */
#ifndef RF_CLI_LIVE_LANE_H
#define RF_CLI_LIVE_LANE_H

#include "live/live_state.h"

/* When a frame was taken, by its camera. */
struct live_moment {
    bool known;
    int64_t ns;
    uint32_t sequence;
};

/* A camera and what happens to its frames. */
struct live_lane {
    struct live *live;
    struct refocus_source *source;
    const char *name;
    struct live_stage *stage;
    struct refocus_converter *converter;
    /* A status; the frame is released by the caller. */
    int (*deliver)(struct live_lane *lane, const struct refocus_frame *frame, int64_t now_ns,
                   struct refocus_reason *reason);
    /* Before each wait for a frame; a code other than EXIT_DONE ends the lane. May be NULL. */
    int (*between)(struct live_lane *lane);
    void *user; /* for deliver() */
    int64_t last_ns;
    int64_t quiet_since_ns;        /* no frame has come from then on */
    int64_t period_ns;             /* between two frames */
    struct live_moment sure, seen; /* the last frame of a sound time, and the last of all */
    bool doubted;                  /* the last frame's time was not believed */
    bool newest_wins;
    int64_t late_ns; /* older frames alone are skipped for a newer one; 0: any */
    bool warned;     /* The words for what is left out were printed. */
    bool done;       /* nothing else will come */
    bool failed;     /* the failure is noted, and the lane has ended by it */
};

/* A lane that is ready for live_lane_run(), but for deliver() and user. */
struct live_lane live_lane_of(struct live *live, struct refocus_source *source, const char *name,
                              const struct refocus_source_mode *mode, struct live_stage *stage);
/* Deliver frames until it is over. */
void live_lane_run(struct live_lane *lane);

#endif
