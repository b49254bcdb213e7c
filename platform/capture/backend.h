/* What a kind of source is to source.c, and what they all share. */
#ifndef RF_CAPTURE_BACKEND_H
#define RF_CAPTURE_BACKEND_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/platform/source.h>
#ifdef __cplusplus
extern "C" {
#endif

enum { RF_MOST_BUFFERS = 32 };

struct rf_source_ops;

/* The public source. A backend keeps its own in state. */
struct refocus_source {
    const struct rf_source_ops *ops;
    void *state;
    char *name; /* whole, owned */
    struct refocus_source_config config;
    struct refocus_source_counters counters;
    bool streaming;
    int wake_fd;  /* eventfd: readable after an interrupt */
    uint64_t out; /* bit n: buffer n is the caller's */
    bool sequence_known;
    uint32_t sequence; /* of the frame before */
};

/* Reasons are never NULL here. After an error of start, reopen or open nothing streams;
 * state of a failed open is freed by the backend itself. */
struct rf_source_ops {
    const char *scheme; /* before the colon */
    int (*open)(struct refocus_source *source, const char *rest, struct refocus_reason *reason);
    int (*get_mode)(struct refocus_source *source, int index, struct refocus_source_mode *mode);
    /* By source->config; fills the mode. */
    int (*start)(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason);
    int (*wait)(struct refocus_source *source, int64_t deadline_ns, struct refocus_frame **frame,
                struct refocus_reason *reason);
    void (*release)(struct refocus_source *source, struct refocus_frame *frame);
    void (*stop)(struct refocus_source *source); /* only while it streams */
    /* Stopped: close the device and open it again. */
    int (*reopen)(struct refocus_source *source, struct refocus_reason *reason);
    int (*set_control)(struct refocus_source *source, const char *name, double value,
                       struct refocus_reason *reason); /* or NULL */
    void (*close)(struct refocus_source *source);
    int (*list)(refocus_source_found *found, void *user); /* or NULL */
};

extern const struct rf_source_ops rf_source_file, rf_source_y4m, rf_source_raw, rf_source_replay,
    rf_source_v4l2, rf_source_libcamera;

/* clock.c -------------------------------------------------------------------------- */

int64_t rf_now_ns(void);

/*
 * Wait until fd (or -1) has one of the events, or a moment of CLOCK_MONOTONIC. Returns
 * REFOCUS_OK, REFOCUS_ERR_TIMEOUT or REFOCUS_ERR_CANCELLED; *revents is what poll()
 * says.
 */
int rf_source_poll(const struct refocus_source *source, int fd, short events, int64_t deadline_ns,
                   short *revents);

/* Pacing of files and scripts: frame n is due at a moment. */
struct rf_pace {
    int64_t start_ns, period_ns;
    bool fast;
};
void rf_pace_start(struct rf_pace *pace, double fps, bool fast);
int64_t rf_pace_due(const struct rf_pace *pace, int64_t frame);

/* clock.c, too --------------------------------------------------------------------- */

#if defined(__GNUC__) || defined(__clang__)
__attribute__((format(printf, 3, 4)))
#endif
int rf_capture_fail(struct refocus_reason *reason, int status, const char *format, ...);
int rf_capture_fail_memory(struct refocus_reason *reason);
/* Status of errno's value for a file or device, and words: "what: why; what to do". */
int rf_capture_fail_errno(struct refocus_reason *reason, int error, const char *what);

/* layout.c ------------------------------------------------------------------------- */

/* Planes of a format; 0 for an unknown one. */
int rf_format_planes(uint32_t format);
/* Bytes of a row and number of rows of a plane. */
int64_t rf_plane_row(uint32_t format, int plane, int width);
int rf_plane_rows(uint32_t format, int plane, int height);
/* Whether so many rows of so many bytes can lie so far apart in memory, in either direction. */
bool rf_stride_fits(ptrdiff_t stride, int64_t row, int rows);
/* Stride of plane > 0 that goes with the stride of plane 0. */
int64_t rf_plane_stride(uint32_t format, int plane, int64_t stride);
/* Bytes of a frame whose planes follow each other; 0 when a side is out of its
 * range. */
uint64_t rf_frame_bytes(uint32_t format, int64_t stride, int width, int height);
/* Point a frame's planes into such memory. */
void rf_frame_lay_out(struct refocus_frame *frame, const uint8_t *memory, int64_t stride);
/* By name, not minding case; REFOCUS_FRAME_ANY for none. */
uint32_t rf_format_by_name(const char *name);
/* Zero the frame and put "not known" where that is not 0. */
void rf_frame_clear(struct refocus_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
