/* output.c: the sink `pipewire:` is a camera of PipeWire, which browsers and calls find. */
#include <spa/buffer/meta.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "pipewire.h"
#include "rgb_to_yuv.h"
#include "samples.h"
#include "sink.h"

enum { BUFFERS = 8 };

/* The thread of PipeWire writes to `agreed` and what is below under the lock of the loop. */
struct output {
    struct rf_pipewire pipewire;
    char name[128];
    struct pw_stream *stream;
    struct spa_hook hook;
    struct rf_pipewire_format offered;
    uint64_t sequence;
    struct rf_pipewire_format agreed; /* format ANY: nobody looks */
    enum pw_stream_state state;
    bool looked_away; /* nobody has looked since the last frame */
    struct pw_buffer *buffer[RF_MOST_BUFFERS], *spare[RF_MOST_BUFFERS];
    int buffers, spares;
};

static void state_changed(void *data, enum pw_stream_state old, enum pw_stream_state state,
                          const char *error)
{
    struct output *output = data;

    (void)old;
    (void)error;
    output->state = state;
    if (state != PW_STREAM_STATE_STREAMING)
        output->looked_away = true;
}

static void param_changed(void *data, uint32_t id, const struct spa_pod *param)
{
    struct output *output = data;
    uint8_t bytes[RF_POD_BYTES];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(bytes, sizeof bytes);
    struct rf_pipewire_format *agreed = &output->agreed;
    const struct spa_pod *pods[2];
    int64_t stride;

    if (id != SPA_PARAM_Format)
        return;
    agreed->format = REFOCUS_FRAME_ANY;
    if (!param)
        return;
    *agreed = rf_pipewire_read_format(param);
    stride = rf_plane_row(agreed->format, 0, agreed->width);
    if (!rf_can_encode(agreed->format))
        return;
    rf_pipewire_offer_buffers(&builder, pods, BUFFERS,
                              rf_frame_bytes(agreed->format, stride, agreed->width, agreed->height),
                              stride, 1 << SPA_DATA_MemPtr | 1 << SPA_DATA_MemFd);
    pw_stream_update_params(output->stream, pods, 2);
}

static void add_buffer(void *data, struct pw_buffer *buffer)
{
    struct output *output = data;

    if (output->buffers < RF_MOST_BUFFERS)
        output->buffer[output->buffers++] = buffer;
}

static void remove_buffer(void *data, struct pw_buffer *buffer)
{
    struct output *output = data;
    int n = 0;

    for (int i = 0; i < output->buffers; i++)
        if (output->buffer[i] != buffer)
            output->buffer[n++] = output->buffer[i];
    output->buffers = n;
    output->spares = 0;
    output->looked_away = true;
}

static const struct pw_stream_events stream_events = {
    PW_VERSION_STREAM_EVENTS, .state_changed = state_changed, .param_changed = param_changed,
    .add_buffer = add_buffer, .remove_buffer = remove_buffer};

static int open_output(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason)
{
    struct output *output = calloc(1, sizeof *output);
    int status;

    if (!output)
        return rf_capture_fail_memory(reason);
    snprintf(output->name, sizeof output->name, "%s", rest[0] ? rest : "Refocused camera");
    status = rf_pipewire_open(&output->pipewire, reason);
    if (status != REFOCUS_OK)
        free(output);
    else
        sink->state = output;
    return status;
}

/* Any order of Y, U and V: codes only change places. */
static bool takes(const struct refocus_sink *sink, uint32_t format)
{
    (void)sink;
    (void)format;
    return true;
}

/* The format of the pictures themselves, then those with as many samples, then the others. */
static int offer(const struct output *output, uint32_t image_format,
                 struct spa_pod_builder *builder, const struct spa_pod *pods[16])
{
    enum { OWN, AS_MANY, ANY, NONE };
    const bool rgb = image_format == REFOCUS_FORMAT_RGB8;
    const uint32_t own = rgb ? (uint32_t)REFOCUS_FRAME_RGB24 : rf_frame_format_of(image_format);
    struct rf_pipewire_format format = output->offered;
    int n = 0;

    for (int round = OWN; round < NONE; round++)
        for (uint32_t f = REFOCUS_FRAME_YUYV; f <= REFOCUS_FRAME_BGRX; f++) {
            const int rank = f == own                   ? OWN
                             : rf_same_samples(f, own)  ? AS_MANY
                             : rgb || rf_has_samples(f) ? ANY
                                                        : NONE;

            format.format = f;
            if (rank == round)
                pods[n++] = rf_pipewire_offer(builder, &format);
        }
    return n;
}

static int connect_stream(struct output *output, const struct spa_pod **pods, int n,
                          struct refocus_reason *reason)
{
    struct pw_properties *props = pw_properties_new(
        PW_KEY_MEDIA_CLASS, "Video/Source", PW_KEY_MEDIA_ROLE, "Camera", PW_KEY_APP_NAME, "refocus",
        PW_KEY_NODE_NAME, output->name, PW_KEY_NODE_DESCRIPTION, output->name, NULL);

    output->stream = props ? pw_stream_new(output->pipewire.core, output->name, props) : NULL;
    if (!output->stream)
        return rf_capture_fail_memory(reason);
    pw_stream_add_listener(output->stream, &output->hook, &stream_events, output);
    if (pw_stream_connect(output->stream, PW_DIRECTION_OUTPUT, PW_ID_ANY,
                          PW_STREAM_FLAG_DRIVER | PW_STREAM_FLAG_MAP_BUFFERS, pods,
                          (uint32_t)n) < 0)
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "PipeWire makes no stream");
    return REFOCUS_OK;
}

/* Where a camera is shown already, PipeWire agrees on a format with who looks once more. */
static int start(struct refocus_sink *sink, int width, int height, double fps,
                 struct refocus_reason *reason)
{
    struct output *output = sink->state;
    uint8_t bytes[RF_POD_BYTES];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(bytes, sizeof bytes);
    const struct spa_pod *pods[16];
    int n, status = REFOCUS_OK;

    pw_thread_loop_lock(output->pipewire.loop);
    output->offered = (struct rf_pipewire_format){.width = width,
                                                  .height = height,
                                                  .fps = fps,
                                                  .matrix = sink->matrix,
                                                  .full_range = sink->range == REFOCUS_RANGE_FULL};
    n = offer(output, sink->format, &builder, pods);
    if (output->stream)
        pw_stream_update_params(output->stream, pods, (uint32_t)n);
    else
        status = connect_stream(output, pods, n, reason);
    pw_thread_loop_unlock(output->pipewire.loop);
    return status;
}

static void fill(struct output *output, const struct refocus_image *image,
                 const struct spa_buffer *to)
{
    struct refocus_frame frame = refocus_frame_default();
    struct spa_meta_header *header = spa_buffer_find_meta_data(to, SPA_META_Header, sizeof *header);
    const int64_t stride = rf_plane_row(output->agreed.format, 0, image->width);
    struct spa_chunk *chunk = to->datas[0].chunk;

    frame.format = output->agreed.format;
    frame.width = image->width;
    frame.height = image->height;
    rf_frame_lay_out(&frame, to->datas[0].data, stride);
    if (image->format == REFOCUS_FORMAT_RGB8)
        rf_encode(image, &frame);
    else
        rf_rearrange(image, &frame, rf_rows_of_chroma(frame.format, image->height));
    chunk->offset = 0;
    chunk->size = (uint32_t)rf_frame_bytes(frame.format, stride, image->width, image->height);
    chunk->stride = (int32_t)stride;
    chunk->flags = SPA_CHUNK_FLAG_NONE;
    if (!header)
        return;
    header->flags = 0;
    header->offset = 0;
    header->pts = rf_now_ns();
    header->dts_offset = 0;
    header->seq = output->sequence;
}

/* Whether somebody looks, and sees pictures like this one. */
static bool is_watched(const struct output *output, const struct refocus_image *image)
{
    return output->state == PW_STREAM_STATE_STREAMING && rf_can_encode(output->agreed.format) &&
           (image->format == REFOCUS_FORMAT_RGB8 || rf_has_samples(output->agreed.format)) &&
           output->agreed.width == image->width && output->agreed.height == image->height;
}

/* A buffer to fill, or NULL. PipeWire 0.3.65 gives none back that was with somebody who left: when
 * the next one comes, all of them are taken for free. */
static struct pw_buffer *take(struct output *output)
{
    if (output->looked_away) {
        while (pw_stream_dequeue_buffer(output->stream))
            continue;
        memcpy(output->spare, output->buffer, sizeof output->spare);
        output->spares = output->buffers;
        output->looked_away = false;
    }
    return output->spares > 0 ? output->spare[--output->spares]
                              : pw_stream_dequeue_buffer(output->stream);
}

static int write_frame(struct refocus_sink *sink, const struct refocus_image *image,
                       struct refocus_reason *reason)
{
    struct output *output = sink->state;
    int status = REFOCUS_OK;

    pw_thread_loop_lock(output->pipewire.loop);
    output->sequence++;
    if (output->pipewire.gone || output->state == PW_STREAM_STATE_ERROR) {
        status = rf_pipewire_fail_gone(reason);
    } else if (is_watched(output, image)) {
        struct pw_buffer *buffer = take(output);

        if (buffer && buffer->buffer->n_datas > 0 && buffer->buffer->datas[0].data &&
            buffer->buffer->datas[0].maxsize >=
                rf_frame_bytes(output->agreed.format,
                               rf_plane_row(output->agreed.format, 0, image->width), image->width,
                               image->height))
            fill(output, image, buffer->buffer);
        else
            status = rf_capture_fail(reason, REFOCUS_ERR_TIMEOUT, "nobody takes the frames");
        if (buffer)
            pw_stream_queue_buffer(output->stream, buffer);
        pw_stream_trigger_process(output->stream);
    }
    pw_thread_loop_unlock(output->pipewire.loop);
    return status;
}

static int close_output(struct refocus_sink *sink, struct refocus_reason *reason)
{
    struct output *output = sink->state;

    (void)reason;
    if (output->stream) {
        pw_thread_loop_lock(output->pipewire.loop);
        rf_pipewire_end_stream(&output->pipewire, &output->stream);
        pw_thread_loop_unlock(output->pipewire.loop);
    }
    rf_pipewire_close(&output->pipewire);
    free(output);
    return REFOCUS_OK;
}

REFOCUS_API extern const struct rf_sink_ops rf_sink_pipewire;
const struct rf_sink_ops rf_sink_pipewire = {.scheme = "pipewire",
                                             .open = open_output,
                                             .takes = takes,
                                             .start = start,
                                             .write = write_frame,
                                             .close = close_output};
