/* capture.h: a node of PipeWire that frames are taken from. */
#ifndef RF_PIPEWIRE_CAPTURE_H
#define RF_PIPEWIRE_CAPTURE_H

#include "pipewire.h"

/* The thread of PipeWire writes to everything but `name` under the lock of the loop. */
struct rf_pipewire_camera {
    struct rf_pipewire pipewire;
    const char *name; /* behind the colon */
    uint32_t node;
    char serial[24];
    struct pw_stream *stream;
    struct spa_hook hook;
    struct refocus_source_config config;
    struct rf_pipewire_format format;
    struct rf_pipewire_buffer buffer[RF_MOST_BUFFERS];
    uint32_t order[RF_MOST_BUFFERS]; /* buffers that wait, the oldest first */
    int waiting;
    uint32_t sequence;      /* the number of the frame before */
    bool known, monotonic;  /* there was a frame; times are of CLOCK_MONOTONIC */
    bool failed, too_small; /* the stream; a buffer */
    bool removing;          /* PipeWire waits for frames that are out */
    char words[128];        /* why the stream failed */
    struct refocus_frame last;
};

/* stream.c: called in the thread of PipeWire, with the camera. */
extern const struct pw_stream_events rf_pipewire_camera_events;

#endif
