/* fake_v4l2.h: a V4L2 device of no machine, and calls of the system that fail. */
#ifndef CAPTURE_FAKE_V4L2_H
#define CAPTURE_FAKE_V4L2_H

#include <stdbool.h>
#include <stdint.h>

enum { FAKE_WIDTH = 32, FAKE_HEIGHT = 16 };

/* The device /dev/video7, for programs linked with --wrap of the calls in fake_v4l2.c. It keeps
 * the rules of drivers: no format is set while it has buffers, no buffer goes while one is mapped,
 * one is queued once, and a second opening is refused. */
extern struct fake_v4l2 {
    bool multi;   /* planes lie in memories of their own */
    bool output;  /* frames go in */
    bool changes; /* a change of the signal comes before the next frame */

    long calls;   /* calls made so far */
    long fail_at; /* the call that fails, from 1 on; 0 = none */
    bool forever; /* later calls fail, too, as after the device was unplugged */
    int failure;  /* the errno */

    unsigned long refused; /* a request that fails with EIO, the next `refusals` times */
    int refusals;

    uint32_t space, encoding, range; /* the driver's words for its colours */
    uint32_t length;                 /* bytes of a buffer; 0 = enough */
    struct {
        uint32_t bytes, offset, flags;
        int64_t us;
    } filled;             /* the driver's words for a frame; bytes 0 = the whole buffer */
    uint32_t rate[2];     /* the numerator and the denominator of the period that is set */
    int64_t queued_at_us; /* the time of the frame that was put out last */

    int fd, buffers, mapped;
    bool streaming;
    unsigned queued, done; /* bit n: buffer n */
    uint32_t sequence, fourcc;
    long frames; /* dequeued in all */
} fake;

#endif
