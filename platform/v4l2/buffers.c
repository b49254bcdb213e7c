/* buffers.c: buffers of V4L2 devices are mapped into the memory of the process. */
#include <errno.h>
#include <fcntl.h>
#include <linux/dma-buf.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#include "v4l2.h"

/* A struct v4l2_buffer with room for its planes. */
struct slot {
    struct v4l2_buffer buffer;
    struct v4l2_plane plane[VIDEO_MAX_PLANES];
};

static void slot_init(const struct rf_v4l2 *device, struct slot *slot, int n)
{
    memset(slot, 0, sizeof *slot);
    slot->buffer.type = device->type;
    slot->buffer.memory = V4L2_MEMORY_MMAP;
    slot->buffer.index = (uint32_t)n;
    if (device->multi) {
        slot->buffer.m.planes = slot->plane;
        slot->buffer.length = VIDEO_MAX_PLANES;
    }
}

static int64_t bytes_per_line(const struct rf_v4l2 *device, int memory)
{
    const struct v4l2_format *f = &device->v4l2_format;

    return device->multi ? f->fmt.pix_mp.plane_fmt[memory].bytesperline : f->fmt.pix.bytesperline;
}

uint64_t rf_v4l2_needed(const struct rf_v4l2 *device, int i)
{
    const int64_t stride = bytes_per_line(device, i);

    if (device->format == REFOCUS_FRAME_MJPEG)
        return 1;
    if (stride < rf_plane_row(device->format, i, device->width))
        return UINT64_MAX;
    if (device->memories == 1)
        return rf_frame_bytes(device->format, stride, device->width, device->height);
    return (uint64_t)stride * (uint64_t)rf_plane_rows(device->format, i, device->height);
}

/* Map memory i of buffer n; 0 or an errno. */
static int map_memory(struct rf_v4l2 *device, int n, int i, const struct slot *slot,
                      bool export_dmabuf)
{
    struct rf_v4l2_buffer *buffer = &device->buffer[n];
    const bool output = V4L2_TYPE_IS_OUTPUT(device->type);
    off_t offset = device->multi ? slot->plane[i].m.mem_offset : slot->buffer.m.offset;
    int fd = device->fd, error;
    void *memory;

    buffer->length[i] = device->multi ? slot->plane[i].length : slot->buffer.length;
    if (buffer->length[i] < rf_v4l2_needed(device, i))
        return EOVERFLOW;
    if (export_dmabuf) {
        struct v4l2_exportbuffer export;

        memset(&export, 0, sizeof export);
        export.type = device->type;
        export.index = (uint32_t)n;
        export.plane = (uint32_t)i;
        export.flags = O_CLOEXEC | O_RDONLY;
        error = rf_v4l2_ioctl(device->fd, VIDIOC_EXPBUF, &export);
        if (error)
            return error;
        fd = buffer->dmabuf[i] = export.fd;
        offset = 0;
    }
    memory = mmap(NULL, buffer->length[i], output ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED,
                  fd, offset);
    if (memory == MAP_FAILED)
        return errno;
    buffer->memory[i] = memory;
    return 0;
}

static int map_buffer(struct rf_v4l2 *device, int n, bool export_dmabuf)
{
    struct slot slot;
    int error;

    slot_init(device, &slot, n);
    error = rf_v4l2_ioctl(device->fd, VIDIOC_QUERYBUF, &slot.buffer);
    for (int i = 0; i < device->memories && !error; i++)
        error = map_memory(device, n, i, &slot, export_dmabuf);
    return error;
}

int rf_v4l2_map(struct rf_v4l2 *device, int count, bool export_dmabuf,
                struct refocus_reason *reason)
{
    struct v4l2_requestbuffers request;
    int error;

    memset(&request, 0, sizeof request);
    request.count = (uint32_t)count;
    request.type = device->type;
    request.memory = V4L2_MEMORY_MMAP;
    error = rf_v4l2_ioctl(device->fd, VIDIOC_REQBUFS, &request);
    if (error)
        return rf_v4l2_fail(device, reason, error, "asking for buffers");
    device->count = request.count < RF_MOST_BUFFERS ? (int)request.count : RF_MOST_BUFFERS;
    for (int n = 0; n < device->count; n++)
        for (int i = 0; i < 3; i++) {
            device->buffer[n].memory[i] = NULL;
            device->buffer[n].dmabuf[i] = -1;
        }
    for (int n = 0; n < device->count && !error; n++)
        error = map_buffer(device, n, export_dmabuf);
    if (!error && device->count >= 2)
        return REFOCUS_OK;
    rf_v4l2_unmap(device);
    if (error == EOVERFLOW)
        return rf_capture_fail(reason, REFOCUS_ERR_IO,
                               "%s: the driver's strides or buffers are less than a picture",
                               device->path);
    if (!error)
        return rf_capture_fail_memory(reason);
    return rf_v4l2_fail(device, reason, error,
                        export_dmabuf ? "exporting its buffers" : "mapping its buffers");
}

void rf_v4l2_unmap(struct rf_v4l2 *device)
{
    struct v4l2_requestbuffers request;
    int type = (int)device->type;

    if (device->streaming && rf_v4l2_ioctl(device->fd, VIDIOC_STREAMOFF, &type) == 0)
        device->streaming = false;
    for (int n = 0; n < device->count; n++)
        for (int i = 0; i < 3; i++) {
            struct rf_v4l2_buffer *buffer = &device->buffer[n];

            if (buffer->memory[i])
                munmap(buffer->memory[i], buffer->length[i]);
            if (buffer->dmabuf[i] >= 0)
                close(buffer->dmabuf[i]);
            buffer->memory[i] = NULL;
            buffer->dmabuf[i] = -1;
        }
    device->count = 0;
    memset(&request, 0, sizeof request);
    request.type = device->type;
    request.memory = V4L2_MEMORY_MMAP;
    if (device->fd >= 0)
        rf_v4l2_ioctl(device->fd, VIDIOC_REQBUFS, &request);
}

void rf_v4l2_lay_out(const struct rf_v4l2 *device, int n, const uint32_t offset[3],
                     struct refocus_frame *frame)
{
    const struct rf_v4l2_buffer *buffer = &device->buffer[n];

    *frame = refocus_frame_default();
    frame->format = device->format;
    frame->width = device->width;
    frame->height = device->height;
    frame->matrix = device->matrix;
    frame->flags = device->flags;
    frame->buffer = (uint32_t)n;
    if (device->memories == 1) {
        rf_frame_lay_out(frame, buffer->memory[0] + offset[0], bytes_per_line(device, 0));
        for (int i = 0; i < rf_format_planes(frame->format); i++)
            frame->dmabuf[i] = buffer->dmabuf[0];
        return;
    }
    for (int i = 0; i < device->memories; i++) {
        frame->plane[i] = buffer->memory[i] + offset[i];
        frame->stride[i] = (ptrdiff_t)bytes_per_line(device, i);
        frame->dmabuf[i] = buffer->dmabuf[i];
    }
}

int rf_v4l2_queue(struct rf_v4l2 *device, int n, int64_t timestamp_ns)
{
    struct slot slot;

    slot_init(device, &slot, n);
    if (V4L2_TYPE_IS_OUTPUT(device->type)) {
        slot.buffer.field = V4L2_FIELD_NONE;
        slot.buffer.timestamp.tv_sec = (time_t)(timestamp_ns / 1000000000);
        slot.buffer.timestamp.tv_usec = (suseconds_t)(timestamp_ns % 1000000000 / 1000);
        slot.buffer.bytesused = (uint32_t)rf_v4l2_needed(device, 0);
        for (int i = 0; i < device->memories; i++)
            slot.plane[i].bytesused = (uint32_t)rf_v4l2_needed(device, i);
    }
    if (device->multi)
        slot.buffer.length = (uint32_t)device->memories;
    return rf_v4l2_ioctl(device->fd, VIDIOC_QBUF, &slot.buffer);
}

int rf_v4l2_dequeue(struct rf_v4l2 *device, struct rf_v4l2_done *done)
{
    struct slot slot;
    int error;

    slot_init(device, &slot, 0);
    error = rf_v4l2_ioctl(device->fd, VIDIOC_DQBUF, &slot.buffer);
    if (error)
        return error;
    if (slot.buffer.index >= (uint32_t)device->count)
        return EPROTO;
    memset(done, 0, sizeof *done);
    done->index = (int)slot.buffer.index;
    done->flags = slot.buffer.flags;
    done->sequence = slot.buffer.sequence;
    done->timestamp_ns = (int64_t)slot.buffer.timestamp.tv_sec * 1000000000 +
                         (int64_t)slot.buffer.timestamp.tv_usec * 1000;
    done->bytes[0] = slot.buffer.bytesused;
    for (int i = 0; i < device->memories && device->multi; i++) {
        done->bytes[i] = slot.plane[i].bytesused;
        done->offset[i] = slot.plane[i].data_offset;
    }
    return 0;
}

void rf_v4l2_sync(const struct rf_v4l2_buffer *buffer, bool begin)
{
    for (int i = 0; i < 3; i++)
        if (buffer->dmabuf[i] >= 0) {
            struct dma_buf_sync sync = {.flags = DMA_BUF_SYNC_READ |
                                                 (begin ? DMA_BUF_SYNC_START : DMA_BUF_SYNC_END)};

            rf_v4l2_ioctl(buffer->dmabuf[i], DMA_BUF_IOCTL_SYNC, &sync);
        }
}
