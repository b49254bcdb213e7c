/* capture.c: the source `pipewire:` takes frames from a node of PipeWire. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "capture.h"

static const int64_t patience_ns = 3000000000;

/* Learn which nodes there are, and choose one; the choice holds until the source is opened anew. */
static int find_camera(struct refocus_source *source, struct refocus_reason *reason)
{
    struct rf_pipewire_camera *camera = source->state;
    const struct rf_pipewire_node *node;
    int status;

    if (!camera->pipewire.loop)
        return rf_pipewire_fail_gone(reason);
    if (camera->serial[0])
        return REFOCUS_OK;
    status = rf_pipewire_sync(&camera->pipewire, source, reason);
    if (status != REFOCUS_OK)
        return status;
    pw_thread_loop_lock(camera->pipewire.loop);
    node = rf_pipewire_find(&camera->pipewire, camera->name);
    if (node) {
        camera->node = node->id;
        memcpy(camera->serial, node->serial, sizeof camera->serial);
    }
    pw_thread_loop_unlock(camera->pipewire.loop);
    if (camera->serial[0])
        return REFOCUS_OK;
    return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                           camera->name[0]
                               ? "PipeWire has no node '%.60s' that gives video; --list shows "
                                 "those that there are"
                               : "PipeWire has no camera%.60s",
                           camera->name);
}

static int open_camera(struct refocus_source *source, const char *rest,
                       struct refocus_reason *reason)
{
    struct rf_pipewire_camera *camera = calloc(1, sizeof *camera);
    int status;

    if (!camera)
        return rf_capture_fail_memory(reason);
    camera->name =
        source->name + (strlen(source->name) - strlen(rest)); /* the source outlives `rest` */
    source->state = camera;
    status = rf_pipewire_open(&camera->pipewire, reason);
    if (status != REFOCUS_OK)
        free(camera);
    return status;
}

static void close_camera(struct refocus_source *source)
{
    struct rf_pipewire_camera *camera = source->state;

    rf_pipewire_close(&camera->pipewire);
    free(camera);
}

static int reopen(struct refocus_source *source, struct refocus_reason *reason)
{
    struct rf_pipewire_camera *camera = source->state;

    rf_pipewire_close(&camera->pipewire);
    camera->serial[0] = '\0';
    return rf_pipewire_open(&camera->pipewire, reason);
}

static int get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode)
{
    struct rf_pipewire_camera *camera = source->state;
    struct refocus_reason ignored;

    if (find_camera(source, &ignored) != REFOCUS_OK)
        return REFOCUS_ERR_ARGUMENT;
    return rf_pipewire_mode(&camera->pipewire, camera->node, REFOCUS_FRAME_ANY, index, mode);
}

static void stop(struct refocus_source *source)
{
    struct rf_pipewire_camera *camera = source->state;

    pw_thread_loop_lock(camera->pipewire.loop);
    for (int i = 0; i < RF_MOST_BUFFERS; i++)
        camera->buffer[i].out = false;
    pw_thread_loop_signal(camera->pipewire.loop, false);
    while (camera->removing)
        pw_thread_loop_wait(camera->pipewire.loop);
    rf_pipewire_end_stream(&camera->pipewire, &camera->stream);
    pw_thread_loop_unlock(camera->pipewire.loop);
    source->counters.lost = source->counters.dequeued - source->counters.queued;
}

static int begin(struct rf_pipewire_camera *camera, struct refocus_reason *reason)
{
    uint8_t bytes[RF_POD_BYTES];
    struct spa_pod_builder builder = SPA_POD_BUILDER_INIT(bytes, sizeof bytes);
    const struct spa_pod *pods[4];
    const int n = rf_pipewire_offer_wishes(&builder, pods, &camera->config);
    struct pw_properties *props =
        pw_properties_new(PW_KEY_MEDIA_TYPE, "Video", PW_KEY_MEDIA_CATEGORY, "Capture",
                          PW_KEY_MEDIA_ROLE, "Camera", PW_KEY_APP_NAME, "refocus", PW_KEY_NODE_NAME,
                          "refocus", "target.object", camera->serial, NULL);

    camera->stream = props ? pw_stream_new(camera->pipewire.core, "refocus", props) : NULL;
    if (!camera->stream)
        return rf_capture_fail_memory(reason);
    pw_stream_add_listener(camera->stream, &camera->hook, &rf_pipewire_camera_events, camera);
    if (pw_stream_connect(camera->stream, PW_DIRECTION_INPUT, PW_ID_ANY,
                          PW_STREAM_FLAG_AUTOCONNECT | PW_STREAM_FLAG_DONT_RECONNECT |
                              PW_STREAM_FLAG_MAP_BUFFERS,
                          pods, (uint32_t)n) < 0)
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "PipeWire makes no stream");
    return REFOCUS_OK;
}

/* Whether the node that frames come from is still there. */
static bool is_there(const struct rf_pipewire_camera *camera)
{
    for (int i = 0; i < camera->pipewire.nodes; i++)
        if (camera->pipewire.node[i].id == camera->node &&
            strcmp(camera->pipewire.node[i].serial, camera->serial) == 0)
            return true;
    return false;
}

/* Under the lock: what is wrong with the stream, or REFOCUS_OK. */
static int health(const struct rf_pipewire_camera *camera, struct refocus_reason *reason)
{
    if (camera->pipewire.gone)
        return rf_pipewire_fail_gone(reason);
    if (!is_there(camera))
        return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the node is gone; start its program");
    if (camera->too_small)
        return rf_capture_fail(reason, REFOCUS_ERR_IO,
                               "its buffers are smaller than a picture, or cannot be mapped");
    if (camera->failed)
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "PipeWire: %s", camera->words);
    return REFOCUS_OK;
}

/* Wait until both sides have agreed on a format. */
static int agree(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason)
{
    const int64_t deadline_ns = rf_now_ns() + patience_ns;
    struct rf_pipewire_camera *camera = source->state;
    int status = REFOCUS_OK, wait = REFOCUS_OK;

    for (;;) {
        pw_thread_loop_lock(camera->pipewire.loop);
        status = health(camera, reason);
        mode->format = camera->format.format;
        mode->width = camera->format.width;
        mode->height = camera->format.height;
        mode->fps = camera->format.fps;
        pw_thread_loop_unlock(camera->pipewire.loop);
        if (status != REFOCUS_OK || mode->format != REFOCUS_FRAME_ANY)
            return status;
        if (wait == REFOCUS_ERR_CANCELLED)
            return rf_capture_fail(reason, wait, "interrupted");
        if (wait != REFOCUS_OK)
            return rf_capture_fail(reason, REFOCUS_ERR_IO,
                                   "PipeWire does not link the camera with this program; start "
                                   "wireplumber");
        wait = rf_pipewire_wait(&camera->pipewire, source, deadline_ns);
    }
}

static int start(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason)
{
    struct rf_pipewire_camera *camera = source->state;
    int status = find_camera(source, reason);

    if (status != REFOCUS_OK)
        return status;
    if (source->config.format != REFOCUS_FRAME_ANY &&
        rf_pipewire_mode(&camera->pipewire, camera->node, source->config.format, 0, mode) ==
            REFOCUS_ERR_ARGUMENT)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED, "the node has no %s",
                               refocus_frame_format_name(source->config.format));
    pw_thread_loop_lock(camera->pipewire.loop);
    camera->config = source->config;
    camera->format = (struct rf_pipewire_format){.format = REFOCUS_FRAME_ANY};
    camera->failed = camera->too_small = camera->known = false;
    camera->last = refocus_frame_default();
    status = health(camera, reason);
    if (status == REFOCUS_OK)
        status = begin(camera, reason);
    pw_thread_loop_unlock(camera->pipewire.loop);
    if (status == REFOCUS_OK)
        status = agree(source, mode, reason);
    if (status != REFOCUS_OK)
        stop(source);
    return status;
}

/* Complete what is said of a frame by those before it. */
static void follow(struct rf_pipewire_camera *camera, struct refocus_frame *frame)
{
    const struct refocus_frame *last = &camera->last;

    if (!camera->known)
        camera->monotonic = llabs(rf_now_ns() - frame->timestamp_ns) < 1000000000;
    else if (frame->sequence == camera->sequence)
        frame->sequence++; /* the producer does not count */
    if (camera->monotonic)
        frame->flags |= REFOCUS_FRAME_MONOTONIC;
    if (camera->known && (frame->format != last->format || frame->width != last->width ||
                          frame->height != last->height || frame->stride[0] != last->stride[0]))
        frame->flags |= REFOCUS_FRAME_CHANGED;
    camera->sequence = frame->sequence;
    camera->known = true;
    camera->last = *frame;
}

static int wait_frame(struct refocus_source *source, int64_t deadline_ns,
                      struct refocus_frame **result, struct refocus_reason *reason)
{
    struct rf_pipewire_camera *camera = source->state;
    int status;

    for (;;) {
        struct rf_pipewire_buffer *buffer = NULL;

        pw_thread_loop_lock(camera->pipewire.loop);
        status = health(camera, reason);
        if (camera->waiting > 0) {
            buffer = &camera->buffer[camera->order[0]];
            memmove(camera->order, camera->order + 1,
                    (size_t)--camera->waiting * sizeof *camera->order);
            buffer->out = true;
            follow(camera, &buffer->frame);
        }
        pw_thread_loop_unlock(camera->pipewire.loop);
        if (buffer) {
            source->counters.dequeued++;
            rf_pipewire_touch(buffer, true);
            *result = &buffer->frame;
            return REFOCUS_OK;
        }
        if (status != REFOCUS_OK)
            return status;
        status = rf_pipewire_wait(&camera->pipewire, source, deadline_ns);
        if (status != REFOCUS_OK)
            return status;
    }
}

static void release(struct refocus_source *source, struct refocus_frame *frame)
{
    struct rf_pipewire_camera *camera = source->state;
    struct rf_pipewire_buffer *buffer = &camera->buffer[frame->buffer];

    rf_pipewire_touch(buffer, false);
    pw_thread_loop_lock(camera->pipewire.loop);
    buffer->out = false;
    if (camera->removing)
        pw_thread_loop_signal(camera->pipewire.loop, false);
    else if (pw_stream_queue_buffer(camera->stream, buffer->buffer) == 0)
        source->counters.queued++;
    pw_thread_loop_unlock(camera->pipewire.loop);
}

static int list(refocus_source_found *found, void *user)
{
    struct refocus_reason ignored;
    struct rf_pipewire pipewire;
    int n;

    if (rf_pipewire_open(&pipewire, &ignored) != REFOCUS_OK)
        return 0;
    rf_pipewire_sync(&pipewire, NULL, &ignored);
    pw_thread_loop_lock(pipewire.loop);
    n = pipewire.nodes;
    for (int i = 0; i < n; i++) {
        const struct rf_pipewire_node *node = &pipewire.node[i];
        char name[sizeof node->name + 16];

        if (node->name[0])
            snprintf(name, sizeof name, "pipewire:%s", node->name);
        else
            snprintf(name, sizeof name, "pipewire:%u", node->id);
        found(user, name, node->description);
    }
    pw_thread_loop_unlock(pipewire.loop);
    rf_pipewire_close(&pipewire);
    return n;
}

REFOCUS_API extern const struct rf_source_ops rf_source_pipewire;
const struct rf_source_ops rf_source_pipewire = {.scheme = "pipewire",
                                                 .kind = REFOCUS_SOURCE_KIND_CAMERA,
                                                 .open = open_camera,
                                                 .get_mode = get_mode,
                                                 .start = start,
                                                 .wait = wait_frame,
                                                 .release = release,
                                                 .stop = stop,
                                                 .reopen = reopen,
                                                 .close = close_camera,
                                                 .list = list};
