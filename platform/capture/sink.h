/* sink.h: a kind of sink, as sink.c calls it. */
#ifndef RF_CAPTURE_SINK_H
#define RF_CAPTURE_SINK_H

#include <refocus/platform/sink.h>
#include "backend.h"

struct rf_sink_ops;

struct refocus_sink {
    const struct rf_sink_ops *ops;
    void *state;
    bool started;
    int width, height;
    double fps;
    uint32_t format, matrix, range; /* format of the pictures to come */
    int32_t aspect[2];              /* width to height of a pixel; 0 and 0: not known */
    uint32_t chroma_place;          /* enum refocus_chroma_place */
    int (*cancelled)(void *user);   /* NULL: never */
    void *user;
};

/* Reasons are never NULL here; open, start and close may be, where there is nothing to do. */
struct rf_sink_ops {
    const char *scheme; /* word before the colon, or NULL for a pattern of pictures */
    int (*open)(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason);
    /* Whether it takes pictures of such a format of Y, U and V; NULL: none. */
    bool (*takes)(const struct refocus_sink *sink, uint32_t format);
    /* sink->format and so on are set. */
    int (*start)(struct refocus_sink *sink, int width, int height, double fps,
                 struct refocus_reason *reason);
    int (*write)(struct refocus_sink *sink, const struct refocus_image *image,
                 struct refocus_reason *reason);
    int (*close)(struct refocus_sink *sink, struct refocus_reason *reason);
};

extern const struct rf_sink_ops rf_sink_null, rf_sink_y4m, rf_sink_raw, rf_sink_pictures,
    rf_sink_v4l2;

#endif
