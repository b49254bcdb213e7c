/* refocus live: what its threads share. Capture, depth, rendering and output run at the same
 * time, with a bounded queue between each two. */
#ifndef RF_CLI_LIVE_H
#define RF_CLI_LIVE_H

#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/sink.h>
#include <refocus/platform/source.h>
#include "shot/engine.h"
#include "inputs/inputs.h"

/* live_estimate.c: "--depth estimate:MODEL,every=N,preset=NAME" */
struct live_estimate_settings {
    char model[4096]; /* empty: not wanted */
    long every;
    int preset;
};

struct live_settings {
    const char *camera, *out, *calibration, *socket;
    struct depth_settings depth;
    struct live_estimate_settings estimate;
    struct lens_settings lens;
    struct engine_settings engine;
    double size[2], fps, frames, duration, patience, blur_most, steady;
    int format, policy;
    bool fast, loop, no_commands, list, dmabuf;
    bool offline; /* from files to files: nothing goes by the clock on the wall */
};

enum { POLICY_DEFAULT = -1, POLICY_NEWEST, POLICY_EVERY };

/* live_queue.c: pictures on their way from one thread to the next -------------------------- */

struct live_picture {
    struct refocus_image image; /* RGB8, or the camera's Y, U, V; memory owned by the queue */
    size_t capacity;
    int64_t timestamp_ns; /* of the camera, for pairing */
    int64_t taken_ns;     /* CLOCK_MONOTONIC: when it was taken, as far as is known */
    float lens_dioptres;
    bool still;
    int64_t key; /* which of the pictures that a network sees holds for its depth; from 1 on */
};

enum { LIVE_SLOTS = 4 };

struct live_queue {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    struct live_picture slot[LIVE_SLOTS];
    int free[LIVE_SLOTS], free_count;
    int full[LIVE_SLOTS], full_count; /* oldest first */
    int most;                         /* full ones at a time */
    bool newest_wins, closed;
    uint64_t dropped;
};

void live_queue_init(struct live_queue *queue, int policy);
void live_queue_free(struct live_queue *queue);
/* No more will come; what is full can still be taken. */
void live_queue_close(struct live_queue *queue);
/* A slot to fill, of memory for such a picture; NULL when the queue is closed. *memory is
 * false when there is none. */
struct live_picture *live_queue_fill(struct live_queue *queue, uint32_t format, int width,
                                     int height, bool *memory);
void live_queue_put(struct live_queue *queue, struct live_picture *picture);
/* The oldest, or NULL after 100 ms without one, or when it is closed and empty. */
struct live_picture *live_queue_take(struct live_queue *queue, bool *ended);
/* Back to the free ones: taken, or not worth to be put. */
void live_queue_return(struct live_queue *queue, struct live_picture *picture);
uint64_t live_queue_dropped(struct live_queue *queue);

/* live_stats.c: times without end in constant memory --------------------------------------- */

enum { LIVE_BINS = 1200 };

/* Bins 2 % wide from 1 microsecond on. */
struct live_times {
    uint64_t bin[LIVE_BINS], count;
    double sum_ms, min_ms, max_ms;
};
void live_times_add(struct live_times *times, double ms);
double live_times_quantile(const struct live_times *times, double share);
json_t *live_times_json(const struct live_times *times);

/* live_depth.c: depth maps on their way, and which goes with which frame -------------------- */

enum { LIVE_DEPTHS = 16 };

/* What disparities mean, in 1/m: 1 is near, 0 is far. Both 0: not known. */
struct live_range {
    double near, far;
};

static inline bool live_range_is_known(const struct live_range *range)
{
    return range->near > range->far;
}

struct live_depth_map {
    uint16_t *disparity; /* packed */
    size_t capacity;
    int width, height;
    struct live_range range;
    int64_t timestamp_ns;
    uint64_t number; /* 0: empty */
};

struct live_depths {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    struct live_depth_map map[LIVE_DEPTHS];
    uint64_t count;    /* maps so far */
    int pinned;        /* the one that is being used, or -1 */
    int64_t needed_ns; /* maps from before this moment are needed no more */
    bool every, ended;
    bool still; /* there is one map for all times */
};

void live_depths_init(struct live_depths *depths, bool every);
void live_depths_free(struct live_depths *depths);
void live_depths_end(struct live_depths *depths);
/* A map to fill that no one uses; NULL when it is over or there is no memory. */
struct live_depth_map *live_depths_fill(struct live_depths *depths, int width, int height);
void live_depths_put(struct live_depths *depths, struct live_depth_map *map, int64_t timestamp_ns,
                     bool still);
/*
 * The map within half a frame of a moment, else *paired = false and the newest one, or, when every
 * frame counts, the one nearest in time, which does not hang on how far depth is ahead; NULL when
 * there is none at all. Used until the next call.
 */
const struct live_depth_map *live_depths_pair(struct live_depths *depths, int64_t timestamp_ns,
                                              int64_t half_ns, bool *paired);

/* live_range.c: a range that follows what is seen ------------------------------------------ */

struct live_range_end {
    bool moves;
    double unused_s; /* so long it could have been nearer to the other */
};

struct live_ranger {
    struct live_range range;
    bool near_given, far_given; /* by the command line: that end does not move */
    struct live_range past[3];  /* ranges that the last maps showed */
    uint64_t maps;
    struct live_range_end near_end, far_end;
    int64_t last_ns;
    uint32_t *counts; /* a histogram of codes, allocated with the first map */
};

/* Metres that are given; 0: those that are seen. */
void live_range_begin(struct live_ranger *ranger, double near_m, double far_m);
void live_range_end(struct live_ranger *ranger);
/* The nearest and the farthest surface of a map of packed 16-bit distances, where 0 is unknown;
 * false: it shows none, or there is no memory. */
bool live_range_measure(struct live_ranger *ranger, const struct refocus_depth_map *map,
                        struct live_range *seen);
/* ranger->range, for a map taken then that shows this. The first one sets it. */
void live_range_follow(struct live_ranger *ranger, const struct live_range *seen, int64_t now_ns);
/* Puts a map of a wider range in place of a map, in memory that `wide` owns. */
int live_range_widen(struct live_depth_map *wide, const struct live_depth_map **map,
                     const struct live_range *range);

/* live_focus.c: focus and blur as they are asked for -------------------------------------- */

/* Something to focus on. A point is looked up in the next frame, and is a distance from then on,
 * or a disparity where distances are not known. */
struct live_target {
    bool known;             /* false: the disparity at the point has not been read yet */
    bool dioptres;          /* value is 1/m, else a disparity */
    bool follows_lens;      /* where the camera's own lens is, if it says so */
    double value, point[2]; /* the point NAN: the centre */
};

struct live_focus {
    pthread_mutex_t lock;
    struct live_target from, to; /* a pull from one to the other */
    int64_t begin_ns, duration_ns;
    bool begun; /* at begin_ns; else it begins with the next frame */
    int64_t now_ns;
    struct live_range range; /* both of the present frame */
    double blur, blur_most;
    double stretch;    /* K as a multiple of --blur, after the range has moved; 1 once it has stood
                          still for long */
    int width, height; /* of the pictures; 0: none has come */
};

void live_focus_init(struct live_focus *focus, const struct live_settings *settings);
/* A line of commands, which holds from the next frame on; false: it is not understood, and why.
 * *quit is set by "quit". */
bool live_focus_command(struct live_focus *focus, const char *line, bool *quit, char *why,
                        size_t size);
/* A frame, and when it was taken: by that, and not by when it is worked on, pulls go on. The
 * lens of its camera, or NAN, and what its disparities mean, which becomes as wide as it must be
 * to hold what is in focus. */
void live_focus_frame(struct live_focus *focus, int64_t now_ns, double lens_dioptres,
                      struct live_range *range);
/* Whether there is a point to look up in that frame, for live_focus_found(). */
bool live_focus_point(struct live_focus *focus, double point[2]);
void live_focus_found(struct live_focus *focus, const double point[2], double disparity);
/* What holds for that frame. */
void live_focus_get(struct live_focus *focus, double *disparity, double *blur);
/* The size of the pictures, beyond which points are refused. */
void live_focus_size(struct live_focus *focus, int width, int height);

/* live_steady.c: depth that does not flicker ---------------------------------------------- */

struct live_steady {
    struct refocus_temporal *filter; /* NULL: off, or no map has come */
    struct live_depth_map map;       /* the filtered one, and the number of what it was made of */
    struct live_times times;
};

/* Puts the filtered map in place of a map, filtering it when it has not been yet. Returns what
 * refocus_temporal_create() and refocus_temporal_run() do. */
int live_steady_run(struct live_steady *steady, double strength, const struct live_depth_map **map,
                    const struct refocus_image *photo);
void live_steady_end(struct live_steady *steady);

/* The whole ------------------------------------------------------------------------------- */

/* Counts and times of one thread each; read when all have ended. */
struct live_stage {
    struct live_times times;
    uint64_t frames, corrupt, damaged, reordered, timeouts, recoveries, skipped;
    double worst_recovery_ms;
};

struct live {
    const struct live_settings *settings;
    struct refocus_source *camera, *depth_camera;
    struct refocus_source_mode mode, depth_mode;
    struct refocus_sink *sink;
    struct refocus_calibration *calibration;
    struct live_queue captured, rendered;
    struct live_queue to_estimate;    /* copies of every n-th picture */
    struct live_estimator *estimator; /* or NULL */
    int64_t offered, key;             /* of the thread that captures */
    struct live_depths depths;
    struct live_focus focus;
    struct live_ranger ranger;  /* to the thread of depth */
    struct live_depth_map wide; /* to the thread that renders */

    atomic_bool quit;
    int wake_fd;          /* eventfd: readable when it is over; for the thread of the commands */
    int command_fd;       /* listens on the socket of the commands, or -1 */
    sem_t first_commands; /* offline: those that stand on standard input have been read */
    bool socket_is_ours;
    pthread_mutex_t lock;
    int exit_code; /* under the lock, with what and why of the first failure */
    char what[256], why[512];

    struct live_stage capture, depth, pair, prepare, render, output;
    struct live_times latency;
    atomic_uint_fast64_t frames_out;
    uint64_t paired, unpaired, without_depth;
    uint64_t sink_dropped, commands, commands_refused;
    double create_ms;
    struct live_steady steady; /* to the thread that renders */
    struct engine *engine;
    uint32_t yuv_formats;     /* bit f: pictures of enum refocus_format f stay as they are */
    uint32_t rendered_format; /* enum refocus_format; of the thread that captures */
    int64_t first_out_ns, last_out_ns;
    /* To the thread that renders, of the last frame: */
    double lens_dioptres, focus_disparity, blur;
    struct live_range range;
    int64_t clock_ns, last_frame_ns; /* the clock is that of the frames, from 0 on */
    uint64_t frames_rendered;
};

int64_t live_now_ns(void);
/* Remember the first failure, and let all come to an end. */
void live_fail(struct live *live, int exit_code, const char *what, const char *why);
void live_end(struct live *live);
bool live_is_over(struct live *live);

/* live_estimate.c. An exit code, and prints why. */
bool live_estimate_is_meant(const char *depth);
int live_estimate_parse(struct live_estimate_settings *settings, const char *depth);
int live_estimate_open(struct live *live);
void live_estimate_close(struct live *live);
/* Number the picture, and give the network what the frame looks like when its turn is. */
int live_estimate_offer(struct live *live, struct live_picture *picture,
                        const struct refocus_frame *frame, struct refocus_converter *converter,
                        struct refocus_reason *reason);
void *live_estimate_thread(void *live);

/* live_commands.c: make the socket of the settings, where there is one; an exit code, and
 * prints why. Close and remove it. */
int live_commands_open(struct live *live);
void live_commands_close(struct live *live);

/* live_capture.c, live_output.c, live_commands.c: main functions of threads. */
void *live_capture_thread(void *live);
void *live_depth_thread(void *live);
void *live_output_thread(void *live);
void *live_command_thread(void *live);
/* The depth file as the one map of the depths; an exit code, and prints why. */
int live_read_fixed_depth(struct live *live);
/* live_render.c: takes pictures until it is over. */
void live_render(struct live *live);

/* live_report.c: print it, when all threads have ended; an exit code. */
int live_report(struct live *live);

/* live_calibration.c: what is wrong with it, or NULL. */
const char *live_parse_calibration(const json_t *root, struct refocus_calibration *calibration);
/* An exit code, and prints why. */
int live_read_calibration(struct refocus_calibration **calibration, const char *file);

#endif
