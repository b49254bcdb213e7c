/* camera.c: a camera of PipeWire whose frames and faults a test chooses. */
#define _GNU_SOURCE /* memfd_create() */
#include "camera.h"
#include <spa/buffer/meta.h>
#include <spa/param/buffers.h>
#include <spa/param/video/format-utils.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum {
    PADDING = 64, /* a row may be longer by as much */
    PAGE = 4096,
};

static const struct spa_pod *offer(struct camera *camera, struct spa_pod_builder *builder)
{
    const struct spa_rectangle size =
        SPA_RECTANGLE((uint32_t)camera->width, (uint32_t)camera->height);
    const struct spa_fraction rate = SPA_FRACTION(30, 1);
    const bool jpeg = camera->format == SPA_VIDEO_FORMAT_ENCODED;
    struct spa_pod_frame object;

    spa_pod_builder_push_object(builder, &object, SPA_TYPE_OBJECT_Format, SPA_PARAM_EnumFormat);
    spa_pod_builder_add(
        builder, SPA_FORMAT_mediaType, SPA_POD_Id(SPA_MEDIA_TYPE_video), SPA_FORMAT_mediaSubtype,
        SPA_POD_Id(jpeg ? SPA_MEDIA_SUBTYPE_mjpg : SPA_MEDIA_SUBTYPE_raw), SPA_FORMAT_VIDEO_size,
        SPA_POD_Rectangle(&size), SPA_FORMAT_VIDEO_framerate, SPA_POD_Fraction(&rate), 0);
    if (!jpeg)
        spa_pod_builder_add(builder, SPA_FORMAT_VIDEO_format, SPA_POD_Id(camera->format), 0);
    if (camera->format == SPA_VIDEO_FORMAT_NV12)
        spa_pod_builder_add(builder, SPA_FORMAT_VIDEO_colorRange,
                            SPA_POD_Id(SPA_VIDEO_COLOR_RANGE_0_255), SPA_FORMAT_VIDEO_colorMatrix,
                            SPA_POD_Id(SPA_VIDEO_COLOR_MATRIX_BT709), 0);
    return spa_pod_builder_pop(builder, &object);
}

/* Whether a picture of this size is agreed on. */
static bool is_agreed(const struct camera *camera, const struct spa_pod *param)
{
    struct spa_video_info_mjpg jpeg;
    struct spa_video_info_raw raw;

    spa_zero(raw);
    spa_zero(jpeg);
    if (camera->format == SPA_VIDEO_FORMAT_ENCODED) {
        if (spa_format_video_mjpg_parse(param, &jpeg) < 0)
            return false;
        raw.size = jpeg.size;
    } else if (spa_format_video_raw_parse(param, &raw) < 0) {
        return false;
    }
    return raw.size.width == (uint32_t)camera->width && raw.size.height == (uint32_t)camera->height;
}

/* Rows of `width` samples, of all planes. */
static int rows_of(const struct camera *camera)
{
    return camera->format == SPA_VIDEO_FORMAT_NV12 ? camera->height * 3 / 2 : camera->height;
}

static int row_bytes(const struct camera *camera)
{
    return camera->format == SPA_VIDEO_FORMAT_GRAY16_LE ? 2 * camera->width : camera->width;
}

static void param_changed(void *data, uint32_t id, const struct spa_pod *param)
{
    struct camera *camera = data;
    uint8_t bytes[1024];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(bytes, sizeof bytes);
    const struct spa_pod *pods[2];

    if (id != SPA_PARAM_Format)
        return;
    camera->agreed = param && is_agreed(camera, param);
    if (!param)
        return;
    pods[0] = spa_pod_builder_add_object(
        &builder, SPA_TYPE_OBJECT_ParamBuffers, SPA_PARAM_Buffers, SPA_PARAM_BUFFERS_buffers,
        SPA_POD_CHOICE_RANGE_Int(4, 2, 8), SPA_PARAM_BUFFERS_blocks,
        SPA_POD_Int(camera->device ? 2 : 1), SPA_PARAM_BUFFERS_size,
        SPA_POD_Int((row_bytes(camera) + PADDING) * rows_of(camera) + camera->room),
        SPA_PARAM_BUFFERS_dataType,
        SPA_POD_CHOICE_FLAGS_Int(camera->device ? 1 << SPA_DATA_DmaBuf
                                                : 1 << SPA_DATA_MemFd | 1 << SPA_DATA_MemPtr));
    pods[1] = spa_pod_builder_add_object(&builder, SPA_TYPE_OBJECT_ParamMeta, SPA_PARAM_Meta,
                                         SPA_PARAM_META_type, SPA_POD_Id(SPA_META_Header),
                                         SPA_PARAM_META_size,
                                         SPA_POD_Int(sizeof(struct spa_meta_header)));
    pw_stream_update_params(camera->stream, pods, 2);
}

/* Both planes lie in one file, the second one some pages behind the first. */
static void add_buffer(void *of, struct pw_buffer *buffer)
{
    const struct camera *camera = of;
    const uint32_t size = (uint32_t)(row_bytes(camera) + PADDING) * (uint32_t)camera->height;
    const uint32_t whole = (size + PAGE - 1) / PAGE * PAGE;
    const int fd = camera->device ? memfd_create("plane", MFD_CLOEXEC) : -1;
    uint8_t *map = NULL;

    if (fd < 0)
        return;
    if (ftruncate(fd, PAGE + 2 * whole - camera->missing) == 0)
        map = mmap(NULL, PAGE + 2 * whole, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    for (uint32_t i = 0; i < buffer->buffer->n_datas; i++) {
        struct spa_data *data = &buffer->buffer->datas[i];

        data->type = SPA_DATA_DmaBuf;
        data->flags = SPA_DATA_FLAG_READWRITE;
        data->fd = i ? dup(fd) : fd;
        data->mapoffset = PAGE + i * whole;
        data->maxsize = map == MAP_FAILED ? 0 : size;
        data->data = map + data->mapoffset;
    }
    buffer->user_data = map;
}

static void remove_buffer(void *of, struct pw_buffer *buffer)
{
    const struct camera *camera = of;
    const struct spa_data *const data = buffer->buffer->datas;

    if (!camera->device)
        return;
    munmap(buffer->user_data, PAGE + 2 * (size_t)(data[1].mapoffset - data[0].mapoffset));
    for (uint32_t i = 0; i < buffer->buffer->n_datas; i++)
        close((int)data[i].fd);
}

static const struct pw_stream_events events = {
    PW_VERSION_STREAM_EVENTS, .param_changed = param_changed, .add_buffer = add_buffer,
    .remove_buffer = remove_buffer};

bool camera_open(struct camera *camera, const char *name, uint32_t format, int width, int height,
                 int room, bool device)
{
    uint8_t bytes[1024];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(bytes, sizeof bytes);
    const struct spa_pod *pod;

    pw_init(NULL, NULL);
    memset(camera, 0, sizeof *camera);
    camera->format = format;
    camera->width = width;
    camera->height = height;
    camera->room = room;
    camera->device = device;
    camera->loop = pw_thread_loop_new("camera", NULL);
    camera->context = pw_context_new(pw_thread_loop_get_loop(camera->loop), NULL, 0);
    camera->core = pw_context_connect(camera->context, NULL, 0);
    if (!camera->core)
        return false;
    camera->stream = pw_stream_new(
        camera->core, name,
        pw_properties_new(PW_KEY_MEDIA_CLASS, "Video/Source", PW_KEY_NODE_NAME, name, NULL));
    pw_stream_add_listener(camera->stream, &camera->hook, &events, camera);
    pod = offer(camera, &builder);
    pw_stream_connect(camera->stream, PW_DIRECTION_OUTPUT, PW_ID_ANY,
                      PW_STREAM_FLAG_DRIVER |
                          (device ? PW_STREAM_FLAG_ALLOC_BUFFERS : PW_STREAM_FLAG_MAP_BUFFERS),
                      &pod, 1);
    return pw_thread_loop_start(camera->loop) == 0;
}

void camera_resize(struct camera *camera, int width, int height)
{
    uint8_t bytes[1024];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(bytes, sizeof bytes);
    const struct spa_pod *pod;

    pw_thread_loop_lock(camera->loop);
    camera->width = width;
    camera->height = height;
    camera->agreed = false;
    pod = offer(camera, &builder);
    pw_stream_update_params(camera->stream, &pod, 1);
    pw_thread_loop_unlock(camera->loop);
}

/* Fills a memory with the rows from `first` to `end`. */
static void fill_rows(const struct camera *camera, const struct spa_data *data, int first, int end,
                      uint8_t value)
{
    const int row = row_bytes(camera);
    const int32_t stride = camera->stride > row ? camera->stride : row;
    uint8_t *to = (uint8_t *)data->data + camera->offset % (data->maxsize / 8);

    memset(data->data, 0, data->maxsize);
    for (int y = first; y < end; y++)
        memset(to + (y - first) * stride, value + (y >= camera->height), (size_t)row);
    data->chunk->offset = camera->offset;
    data->chunk->size = camera->size ? camera->size : (uint32_t)(stride * (end - first));
    data->chunk->stride = camera->said_stride ? camera->said_stride : camera->stride;
    data->chunk->flags = (int32_t)camera->chunk_flags;
}

static void fill(struct camera *camera, const struct spa_buffer *buffer, uint8_t value)
{
    struct spa_meta_header *header =
        spa_buffer_find_meta_data(buffer, SPA_META_Header, sizeof *header);
    const int rows = rows_of(camera), luma = camera->device ? camera->height : rows;

    fill_rows(camera, &buffer->datas[0], 0, luma, value);
    if (camera->device)
        fill_rows(camera, &buffer->datas[1], luma, rows, value);
    header->flags = camera->header_flags;
    header->seq = camera->sequence;
    header->pts = camera->pts;
}

bool camera_show(struct camera *camera, uint8_t value)
{
    struct pw_buffer *buffer = NULL;

    pw_thread_loop_lock(camera->loop);
    if (camera->agreed && pw_stream_get_state(camera->stream, NULL) == PW_STREAM_STATE_STREAMING)
        buffer = pw_stream_dequeue_buffer(camera->stream);
    if (buffer) {
        fill(camera, buffer->buffer, value);
        pw_stream_queue_buffer(camera->stream, buffer);
        pw_stream_trigger_process(camera->stream);
    }
    pw_thread_loop_unlock(camera->loop);
    return buffer;
}

void camera_close(struct camera *camera)
{
    /* Before the stream ends, lest the thread calls it afterwards. */
    pw_thread_loop_stop(camera->loop);
    if (camera->stream)
        pw_stream_destroy(camera->stream);
    if (camera->core)
        pw_core_disconnect(camera->core);
    pw_context_destroy(camera->context);
    pw_thread_loop_destroy(camera->loop);
    pw_deinit();
}
