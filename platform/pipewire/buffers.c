/* buffers.c: the memory of buffers that come from PipeWire is mapped and described as frames. */
#include <errno.h>
#include <linux/dma-buf.h>
#include <spa/buffer/meta.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>
#include "pipewire.h"

/* Bytes that a picture takes of memory i, when its rows have no gaps. */
static uint64_t needed(const struct rf_pipewire_buffer *buffer,
                       const struct rf_pipewire_format *format, int i, int64_t stride)
{
    if (format->format == REFOCUS_FRAME_MJPEG)
        return 1;
    if (buffer->planes == 1)
        return rf_frame_bytes(format->format, stride, format->width, format->height);
    return (uint64_t)rf_plane_row(format->format, i, format->width) *
           (uint64_t)rf_plane_rows(format->format, i, format->height);
}

/* Looks beyond the end of a file, where memory is said to lie, would end the program.
 */
static bool ends_early(const struct spa_data *data)
{
    const off_t end = lseek((int)data->fd, 0, SEEK_END);

    return end >= 0 && (uint64_t)end < (uint64_t)data->mapoffset + data->maxsize;
}

/* PipeWire maps all but memory of devices. */
static bool map(struct rf_pipewire_memory *memory, const struct spa_data *data)
{
    const uint64_t page = (uint64_t)sysconf(_SC_PAGESIZE), gap = data->mapoffset % page;

    memory->size = data->maxsize;
    memory->fd = -1;
    memory->first = data->data;
    if (data->maxsize == 0 || data->data)
        return data->maxsize > 0;
    if (data->type != SPA_DATA_DmaBuf || ends_early(data))
        return false;
    memory->mapped = (size_t)(gap + data->maxsize);
    memory->map = mmap(NULL, memory->mapped, PROT_READ, MAP_SHARED, (int)data->fd,
                       (off_t)(data->mapoffset - gap));
    if (memory->map == MAP_FAILED) {
        memory->map = NULL;
        return false;
    }
    memory->first = (uint8_t *)memory->map + gap;
    memory->fd = (int)data->fd;
    return true;
}

bool rf_pipewire_map(struct rf_pipewire_buffer *buffer, struct pw_buffer *from,
                     const struct rf_pipewire_format *format)
{
    const struct spa_buffer *spa = from->buffer;
    const int planes = rf_format_planes(format->format);
    bool sound = planes > 0 && spa->n_datas > 0;

    buffer->planes = spa->n_datas >= (uint32_t)planes ? planes : 1;
    for (int i = 0; sound && i < buffer->planes; i++)
        sound = map(&buffer->memory[i], &spa->datas[i]) &&
                needed(buffer, format, i, rf_plane_row(format->format, 0, format->width)) <=
                    buffer->memory[i].size;
    buffer->buffer = from;
    if (!sound)
        rf_pipewire_unmap(buffer);
    return sound;
}

void rf_pipewire_unmap(struct rf_pipewire_buffer *buffer)
{
    for (int i = 0; i < 3; i++)
        if (buffer->memory[i].map)
            munmap(buffer->memory[i].map, buffer->memory[i].mapped);
    memset(buffer, 0, sizeof *buffer);
}

void rf_pipewire_touch(const struct rf_pipewire_buffer *buffer, bool begin)
{
    for (int i = 0; i < buffer->planes; i++) {
        struct dma_buf_sync sync = {.flags = DMA_BUF_SYNC_READ |
                                             (begin ? DMA_BUF_SYNC_START : DMA_BUF_SYNC_END)};

        if (buffer->memory[i].fd >= 0)
            while (ioctl(buffer->memory[i].fd, DMA_BUF_IOCTL_SYNC, &sync) != 0 && errno == EINTR)
                continue;
    }
}

/* The other side may write to the chunk at any time: each number is read once. */
static bool lay_out_plane(struct rf_pipewire_buffer *buffer,
                          const struct rf_pipewire_format *format, int i,
                          const volatile struct spa_chunk *chunk)
{
    struct refocus_frame *frame = &buffer->frame;
    const struct rf_pipewire_memory *memory = &buffer->memory[i];
    const uint32_t offset = chunk->offset % memory->size, given = chunk->size;
    const int32_t gap = chunk->stride;
    const int64_t row = rf_plane_row(format->format, i, format->width);
    const int64_t stride = gap ? gap : row;
    const uint64_t size = given < memory->size - offset ? given : memory->size - offset;
    bool whole;

    if (format->format == REFOCUS_FRAME_MJPEG) {
        frame->plane[0] = memory->first + offset;
        frame->bytes = size;
        return size > 0;
    }
    if (buffer->planes == 1)
        whole = stride >= row && needed(buffer, format, i, stride) - 1 < size;
    else
        whole = stride >= row &&
                (uint64_t)(stride * (rf_plane_rows(format->format, i, format->height) - 1) + row) <=
                    size;
    frame->plane[i] = memory->first + (whole ? offset : 0);
    frame->stride[i] = (ptrdiff_t)(whole ? stride : row);
    return whole;
}

void rf_pipewire_lay_out(struct rf_pipewire_buffer *buffer, const struct rf_pipewire_format *format)
{
    const struct spa_buffer *from = buffer->buffer->buffer;
    const struct spa_meta_header *header =
        spa_buffer_find_meta_data(from, SPA_META_Header, sizeof *header);
    struct refocus_frame *frame = &buffer->frame;
    const uint32_t number = frame->buffer;
    bool whole = true;

    *frame = refocus_frame_default();
    frame->buffer = number;
    frame->format = format->format;
    frame->width = format->width;
    frame->height = format->height;
    frame->matrix = format->matrix;
    for (int i = 0; i < buffer->planes; i++) {
        if (!lay_out_plane(buffer, format, i, from->datas[i].chunk) ||
            from->datas[i].chunk->flags & SPA_CHUNK_FLAG_CORRUPTED)
            whole = false;
        frame->dmabuf[i] = buffer->memory[i].fd;
    }
    if (buffer->planes == 1 && format->format != REFOCUS_FRAME_MJPEG)
        rf_frame_lay_out(frame, frame->plane[0], frame->stride[0]);
    for (int i = buffer->planes; i < rf_format_planes(format->format); i++)
        frame->dmabuf[i] = buffer->memory[0].fd;
    if (!whole || (header && header->flags & SPA_META_HEADER_FLAG_CORRUPTED))
        frame->flags |= REFOCUS_FRAME_CORRUPT;
    if (format->full_range)
        frame->flags |= REFOCUS_FRAME_FULL_RANGE;
    frame->timestamp_ns = header && header->pts > 0 ? header->pts : rf_now_ns();
    frame->sequence = header ? (uint32_t)header->seq : 0;
}
