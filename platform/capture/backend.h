/* backend.h: a kind of source, as source.c calls it, and the list of all kinds. */
#ifndef RF_CAPTURE_BACKEND_H
#define RF_CAPTURE_BACKEND_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/platform/source.h>
#include "clock.h"
#include "failure.h"
#include "layout.h"
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
    bool focused; /* as the last refocus_source_set_focus() that was obeyed asked for: */
    uint32_t focus_mode;
    double focus_position;
    bool sequence_known;
    uint32_t sequence; /* number of the frame before */
};

/* Reasons are never NULL here. After an error of start, reopen or open nothing streams; the state
 * of a failed open is freed by the backend itself. */
struct rf_source_ops {
    const char *scheme; /* word before the colon */
    uint32_t kind;      /* enum refocus_source_kind */
    int (*open)(struct refocus_source *source, const char *rest, struct refocus_reason *reason);
    int (*get_mode)(struct refocus_source *source, int index, struct refocus_source_mode *mode);
    /* Start as source->config says; fills the mode. */
    int (*start)(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason);
    int (*wait)(struct refocus_source *source, int64_t deadline_ns, struct refocus_frame **frame,
                struct refocus_reason *reason);
    void (*release)(struct refocus_source *source, struct refocus_frame *frame);
    void (*stop)(struct refocus_source *source); /* only while it streams */
    /* Stopped: close the device and open it again; NULL: there is no device. */
    int (*reopen)(struct refocus_source *source, struct refocus_reason *reason);
    int (*set_control)(struct refocus_source *source, const char *name, double value,
                       struct refocus_reason *reason); /* or NULL */
    void (*close)(struct refocus_source *source);
    int (*list)(refocus_source_found *found, void *user); /* or NULL */
    /* The lens and the exposure; each may be NULL. Modes and positions were checked. */
    int (*get_lens)(struct refocus_source *source, struct refocus_source_lens *lens,
                    struct refocus_reason *reason);
    int (*set_focus)(struct refocus_source *source, uint32_t mode, double position,
                     struct refocus_reason *reason);
    int (*lock_exposure)(struct refocus_source *source, bool lock, struct refocus_reason *reason);
};

/* Each line is one kind: rf_source_NAME is defined in the file that implements it. */
#define RF_SOURCE_LIST(SOURCE)                                                                     \
    SOURCE(file)                                                                                   \
    SOURCE(y4m)                                                                                    \
    SOURCE(raw)                                                                                    \
    SOURCE(replay)

#define RF_DECLARE_SOURCE(name) extern const struct rf_source_ops rf_source_##name;
RF_SOURCE_LIST(RF_DECLARE_SOURCE)
#undef RF_DECLARE_SOURCE
/* Kinds that a build may lack; libcamera and PipeWire are in modules of their own, see modules.h.
 */
extern const struct rf_source_ops rf_source_v4l2, rf_source_libcamera;

/* Frames a second of a source whose own rate is this, or 0: as source->config says. */
double rf_source_fps(const struct refocus_source *source, double own);

/*
 * Wait until fd (or -1) has one of the events, or a moment of CLOCK_MONOTONIC. Returns REFOCUS_OK,
 * REFOCUS_ERR_TIMEOUT or REFOCUS_ERR_CANCELLED; *revents receives the events that poll() reports.
 */
int rf_source_poll(const struct refocus_source *source, int fd, short events, int64_t deadline_ns,
                   short *revents);

/* Wait until a moment, but not beyond the deadline: REFOCUS_OK, or as rf_source_poll() returns. */
int rf_source_sleep(const struct refocus_source *source, int64_t due, int64_t deadline_ns);

#ifdef __cplusplus
}
#endif
#endif
