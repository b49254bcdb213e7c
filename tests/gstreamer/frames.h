/* frames.h: frames and maps for tests of the element, and the library's own pictures of them. */
#ifndef RF_TESTS_GSTREAMER_FRAMES_H
#define RF_TESTS_GSTREAMER_FRAMES_H

#include <gst/check/gstharness.h>
#include <gst/video/video.h>
#include <refocus/refocus.h>

/* The element with a harness on each of its pads; the depth pad is left out with depth NULL. */
struct bench {
    GstElement *element;
    GstHarness *video, *depth;
    GstBus *bus;
};

void bench_open(struct bench *bench, const char *video_caps, const char *depth_caps);
void bench_close(struct bench *bench);
/* The text of the error that was posted, or NULL; g_free() ends it. */
char *bench_error(struct bench *bench);

/* A frame or map of these caps with a pattern that differs by seed, 40 ms long. */
GstBuffer *frame_make(const char *caps, unsigned seed, GstClockTime time);
/* A map of one value. */
GstBuffer *frame_flat(const char *caps, int value, GstClockTime time);

/* A frame as the library renders it alone: with these settings, by this map. */
GstBuffer *frame_expect(const char *caps, GstBuffer *frame, const struct refocus_disparity *map,
                        struct refocus_settings *settings);
/* Whether two frames of these caps show the same, whatever their strides. */
gboolean frame_same(const char *caps, GstBuffer *a, GstBuffer *b);

/* The settings of an element that is told focus and blur alone. */
struct refocus_settings frame_settings(double focus, double blur);

#endif
