/* stream.c: the thread of PipeWire takes formats, buffers and frames from a node. */
#include <stdio.h>
#include "capture.h"

static void state_changed(void *data, enum pw_stream_state old, enum pw_stream_state state,
                          const char *error)
{
    struct rf_pipewire_camera *camera = data;

    (void)old;
    if (state == PW_STREAM_STATE_ERROR) {
        camera->failed = true;
        snprintf(camera->words, sizeof camera->words, "%s", error ? error : "unknown error");
    }
    rf_pipewire_wake(&camera->pipewire);
}

static void param_changed(void *data, uint32_t id, const struct spa_pod *param)
{
    struct rf_pipewire_camera *camera = data;
    uint8_t bytes[RF_POD_BYTES];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(bytes, sizeof bytes);
    const struct spa_pod *pods[2];

    if (id != SPA_PARAM_Format || !param)
        return;
    camera->format = rf_pipewire_read_format(param);
    if (camera->format.format == REFOCUS_FRAME_ANY) {
        camera->failed = true;
        snprintf(camera->words, sizeof camera->words, "its format or size is not known");
    }
    rf_pipewire_offer_buffers(&builder, pods, camera->config.buffers, 0, 0,
                              1 << SPA_DATA_MemPtr | 1 << SPA_DATA_MemFd | 1 << SPA_DATA_DmaBuf);
    pw_stream_update_params(camera->stream, pods, 2);
    rf_pipewire_wake(&camera->pipewire);
}

static void add_buffer(void *data, struct pw_buffer *from)
{
    struct rf_pipewire_camera *camera = data;

    for (uint32_t i = 0; i < RF_MOST_BUFFERS; i++) {
        struct rf_pipewire_buffer *buffer = &camera->buffer[i];

        if (buffer->buffer)
            continue;
        camera->too_small = !rf_pipewire_map(buffer, from, &camera->format);
        buffer->frame.buffer = i;
        from->user_data = buffer->buffer ? buffer : NULL;
        break;
    }
    rf_pipewire_wake(&camera->pipewire);
}

/* PipeWire will unmap the buffer: a frame that the caller reads is waited for. */
static void remove_buffer(void *data, struct pw_buffer *from)
{
    struct rf_pipewire_camera *camera = data;
    struct rf_pipewire_buffer *buffer = from->user_data;
    int n = 0;

    if (!buffer)
        return;
    for (int i = 0; i < camera->waiting; i++)
        if (&camera->buffer[camera->order[i]] != buffer)
            camera->order[n++] = camera->order[i];
    camera->waiting = n;
    for (camera->removing = true; buffer->out;)
        pw_thread_loop_wait(camera->pipewire.loop);
    camera->removing = false;
    pw_thread_loop_signal(camera->pipewire.loop, false);
    rf_pipewire_unmap(buffer);
}

static void process(void *data)
{
    struct rf_pipewire_camera *camera = data;
    struct pw_buffer *from;

    while ((from = pw_stream_dequeue_buffer(camera->stream))) {
        struct rf_pipewire_buffer *buffer = from->user_data;

        if (!buffer || camera->waiting == RF_MOST_BUFFERS) {
            pw_stream_queue_buffer(camera->stream, from);
            continue;
        }
        rf_pipewire_lay_out(buffer, &camera->format);
        camera->order[camera->waiting++] = buffer->frame.buffer;
    }
    rf_pipewire_wake(&camera->pipewire);
}

const struct pw_stream_events rf_pipewire_camera_events = {
    PW_VERSION_STREAM_EVENTS, .state_changed = state_changed, .param_changed = param_changed,
    .add_buffer = add_buffer, .remove_buffer = remove_buffer, .process = process};
