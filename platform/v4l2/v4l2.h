/* v4l2.h: a V4L2 device, its format and its buffers, for capture and output alike. */
#ifndef RF_V4L2_H
#define RF_V4L2_H

#include <linux/videodev2.h>
#include "backend.h"

struct rf_v4l2_buffer {
    uint8_t *memory[3];
    size_t length[3];
    int dmabuf[3];
};

struct rf_v4l2 {
    char path[64];
    int fd;
    bool multi;    /* the multi-planar API */
    uint32_t type; /* enum v4l2_buf_type */
    struct v4l2_format v4l2_format;
    uint32_t format;             /* enum refocus_frame_format */
    int width, height, memories; /* memories of a buffer: 1 to 3 */
    uint32_t matrix, flags;      /* flags of struct refocus_frame */
    struct rf_v4l2_buffer buffer[RF_MOST_BUFFERS];
    int count;
    bool streaming; /* until the driver has ended the stream, or the device is closed */
};

/* device.c ------------------------------------------------------------------------- */

/* ioctl() that is not cut short by signals: 0 or an errno. */
int rf_v4l2_ioctl(int fd, unsigned long request, void *argument);
/* "/dev/video0", "video0" or "0"; checks that it captures, or puts out. */
int rf_v4l2_open(struct rf_v4l2 *device, const char *name, bool output,
                 struct refocus_reason *reason);
void rf_v4l2_close(struct rf_v4l2 *device);
/* Set a format of this size and check what the driver made of it. memories: planes in
 * memories of their own. REFOCUS_ERR_UNSUPPORTED when the driver chose a format that is
 * not ours. */
int rf_v4l2_set_format(struct rf_v4l2 *device, uint32_t fourcc, int width, int height,
                       struct refocus_reason *reason);
int rf_v4l2_fail(const struct rf_v4l2 *device, struct refocus_reason *reason, int error,
                 const char *doing);
/* The code of a V4L2 format and back; 0 for none. */
uint32_t rf_v4l2_format_of(uint32_t fourcc);
/* The n-th code that means a format. */
uint32_t rf_v4l2_fourcc_of(uint32_t format, int n);

/* buffers.c ------------------------------------------------------------------------ */

/* Ask for buffers and map them, all or none. */
int rf_v4l2_map(struct rf_v4l2 *device, int count, bool export_dmabuf,
                struct refocus_reason *reason);
/* Stop the stream, if it runs, and give the buffers up. */
void rf_v4l2_unmap(struct rf_v4l2 *device);
/* Point the frame into buffer n. */
void rf_v4l2_lay_out(const struct rf_v4l2 *device, int n, const uint32_t offset[3],
                     struct refocus_frame *frame);
/* Bytes that a picture takes of memory i. */
uint64_t rf_v4l2_needed(const struct rf_v4l2 *device, int i);
/* 0 or an errno. bytes: of each memory, for output. */
int rf_v4l2_queue(struct rf_v4l2 *device, int n, int64_t timestamp_ns);
struct rf_v4l2_done {
    int index;
    uint32_t flags, sequence;
    int64_t timestamp_ns;
    uint32_t bytes[3], offset[3];
};
int rf_v4l2_dequeue(struct rf_v4l2 *device, struct rf_v4l2_done *done);
/* Called before and after the processor reads exported buffers. */
void rf_v4l2_sync(const struct rf_v4l2_buffer *buffer, bool begin);

/* modes.c, where the state of the source begins with the device -------------------- */

/* A function of struct rf_source_ops. */
int rf_v4l2_get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode);
/* Set the format and size that the configuration asks for, else those that there are. */
int rf_v4l2_choose_format(struct refocus_source *source, struct refocus_reason *reason);
/* Set frames a second, or 0: leave them. Returns what the device says, 0 when it does not. */
double rf_v4l2_set_rate(const struct rf_v4l2 *device, double fps);

/* lens.c: functions of struct rf_source_ops; the state of the source begins with the device. */
int rf_v4l2_get_lens(struct refocus_source *source, struct refocus_source_lens *lens,
                     struct refocus_reason *reason);
int rf_v4l2_set_focus(struct refocus_source *source, uint32_t mode, double position,
                      struct refocus_reason *reason);
int rf_v4l2_lock_exposure(struct refocus_source *source, bool lock, struct refocus_reason *reason);

#endif
