/* live_state.h: what the threads of refocus live share, and how they end together. */
#ifndef RF_CLI_LIVE_STATE_H
#define RF_CLI_LIVE_STATE_H

#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/sink.h>
#include <refocus/platform/source.h>
#include "live/live_depth.h"
#include "live/live_focus.h"
#include "live/live_queue.h"
#include "live/live_range.h"
#include "live/live_settings.h"
#include "live/live_steady.h"
#include "live/live_times.h"
#include "live/live_track.h"

struct live_estimator;
struct live_stack;

/* Counts and times of one thread each; read when all have ended. */
struct live_stage {
    struct live_times times;
    uint64_t frames, corrupt, damaged, reordered, retimed, timeouts, recoveries, skipped;
    double worst_recovery_ms;
};

/* Capture, depth, rendering and output run at the same time, with a bounded queue between each
 * two. */
struct live {
    const struct live_settings *settings;
    struct refocus_source *camera, *depth_camera; /* set and interrupted under the lock */
    struct refocus_source_mode mode, depth_mode;
    struct refocus_sink *sink;
    struct refocus_calibration *calibration;
    struct live_queue captured, rendered;
    struct live_queue to_estimate;    /* copies of every n-th picture */
    struct live_estimator *estimator; /* or NULL */
    struct live_stack *stack;         /* or NULL */
    int64_t offered, key;             /* belongs to the thread that captures */
    struct live_depths depths;
    struct live_focus focus;
    struct live_ranger ranger;        /* belongs to the thread of depth */
    struct live_depth_map wide, full; /* belong to the thread that renders */

    atomic_bool quit;
    int wake_fd;          /* eventfd: readable when it is over; for the thread of the commands */
    int command_fd;       /* listens on the socket of the commands, or -1 */
    sem_t first_commands; /* offline: those that stand on standard input have been read */
    bool socket_is_ours;
    bool has_lock, has_semaphore; /* the lock that follows, and first_commands, are there */
    pthread_mutex_t lock;
    int exit_code; /* under the lock, with what and why of the first failure */
    char what[256], why[512];

    struct live_stage capture, depth, pair, prepare, render, output;
    struct live_times latency;
    atomic_uint_fast64_t frames_out;
    uint64_t stacks; /* focus stacks that became depth */
    uint64_t paired, unpaired, without_depth;
    uint64_t sink_dropped, commands, commands_refused;
    double create_ms;
    struct live_steady steady; /* belongs to the thread that renders, as do these: */
    struct live_tracker tracker;
    uint64_t tracked; /* number of the rectangle that is followed */
    int64_t tracked_ns;
    struct engine *engine;
    uint32_t yuv_formats;     /* bit f: pictures of enum refocus_format f stay as they are */
    uint32_t rendered_format; /* enum refocus_format; belongs to the thread that captures */
    int64_t first_out_ns, last_out_ns;
    /* These belong to the thread that renders, and are about the last frame: */
    double lens_dioptres, focus_disparity, blur;
    struct live_range range;
    int64_t clock_ns, last_frame_ns; /* the clock is that of the frames, from 0 on */
    uint64_t frames_rendered;
};

/* Begin with no thread and no camera, in memory of zeros. What is given stays the caller's. An exit
 * code; unless that is EXIT_DONE it prints why, and there is nothing to clear. */
int live_begin(struct live *live, const struct live_settings *settings, struct engine *engine);
void live_clear(struct live *live);

/* Remember the first failure; what "": it has been printed. A source that fails does no more than
 * that and ends: what came before is still rendered and written. */
void live_note_failure(struct live *live, int exit_code, const char *what, const char *why);
/* Remember the first failure, and stop. */
void live_fail(struct live *live, int exit_code, const char *what, const char *why);
/* Let all come to an end at once. */
void live_stop(struct live *live);
bool live_is_over(struct live *live);

#endif
