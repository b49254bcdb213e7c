/* What a kind of sink is to sink.c. */
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
    uint32_t format, matrix, range; /* of pictures to come: enum refocus_format and so
                                       on */
};

struct rf_sink_ops {
    const char *scheme; /* before the colon, or NULL for a pattern of pictures */
    int (*open)(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason);
    /* Formats of Y, U and V; NULL: none. */
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

/* rgb_to_yuv.c: an RGB8 picture as a frame of BT.601, limited range, each chroma sample
 * the mean of its pixels; or as packed RGB. The frame's planes are written to. */
void rf_encode(const struct refocus_image *image, const struct refocus_frame *frame);
bool rf_can_encode(uint32_t format);

/* The frame format of a picture's; REFOCUS_FRAME_ANY for none. */
uint32_t rf_frame_format_of(uint32_t image_format);

/* samples.c: Y, U or V of frames, wherever they lie. */
struct rf_samples {
    uint8_t *first;
    int step;         /* bytes to the next of the row, */
    ptrdiff_t stride; /* to the next row */
};
void rf_samples_of(struct rf_samples samples[3], uint32_t format, const uint8_t *const plane[3],
                   const ptrdiff_t stride[3]);
/* Codes of Y as they are, and those of U and V, of which there are so many rows: where
 * one has twice as many, rows are repeated, or become the mean of two, half up. */
void rf_copy_samples(const struct rf_samples to[3], int to_rows, const struct rf_samples from[3],
                     int from_rows, int width, int height);
/* Whether a frame format is of such samples; whether two hold as many: both 4:2:0 or
 * 4:2:2. */
bool rf_has_samples(uint32_t format);
bool rf_same_samples(uint32_t format, uint32_t other);
/* Rows of U and V of a frame format. */
int rf_rows_of_chroma(uint32_t format, int height);
/* A picture of Y, U and V into a frame of such a format that has that many rows of U
 * and V. */
void rf_rearrange(const struct refocus_image *image, const struct refocus_frame *frame,
                  int chroma_rows);

#endif
