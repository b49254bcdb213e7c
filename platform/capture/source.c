/* source.c: sources are opened by name; checks and counts are the same for every kind. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include "backend.h"
#include "modules.h"

#define RF_SOURCE_POINTER(name) &rf_source_##name,
static const struct rf_source_ops *const backends[] = {
#ifdef RF_HAVE_V4L2
    &rf_source_v4l2,
#endif
    RF_SOURCE_LIST(RF_SOURCE_POINTER)};
enum { BACKENDS = sizeof backends / sizeof *backends };

/* Kinds that a build may lack; all of them are cameras. */
static const char *const optional[] = {"v4l2", "libcamera", "pipewire"};
enum { OPTIONAL = sizeof optional / sizeof *optional };

const char *refocus_source_backends(void)
{
    return RF_SOURCES;
}

/* The text behind the scheme and its colon, or NULL when the name is of another kind. */
static const char *behind(const char *name, const char *scheme)
{
    const size_t length = strlen(scheme);

    return strncmp(name, scheme, length) == 0 && name[length] == ':' ? name + length + 1 : NULL;
}

uint32_t refocus_source_kind(const char *name)
{
    for (int i = 0; name && i < BACKENDS; i++)
        if (behind(name, backends[i]->scheme))
            return backends[i]->kind;
    for (int i = 0; name && i < OPTIONAL; i++)
        if (behind(name, optional[i]))
            return REFOCUS_SOURCE_KIND_CAMERA;
    return REFOCUS_SOURCE_KIND_NONE;
}

static const struct rf_source_ops *find(const char *name, const char **rest)
{
    for (int i = 0; i < BACKENDS; i++) {
        *rest = behind(name, backends[i]->scheme);
        if (*rest)
            return backends[i];
    }
    if ((*rest = behind(name, "libcamera")))
        return rf_libcamera();
    *rest = behind(name, "pipewire");
    return *rest ? rf_pipewire_source() : NULL;
}

/* A kind that the build has is not there when its module is not installed. */
static int missing(const char *kind, struct refocus_reason *reason)
{
    if (strstr(refocus_source_backends(), kind))
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%s: its module refocus-%s is not installed beside the library",
                               kind, kind);
    return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED, "this build has no %s; there are %s",
                           kind, refocus_source_backends());
}

static int unknown(const char *name, struct refocus_reason *reason)
{
    for (int i = 0; i < OPTIONAL; i++)
        if (behind(name, optional[i]))
            return missing(optional[i], reason);
    return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                           "no such kind of source; give KIND:NAME with one of %s",
                           refocus_source_backends());
}

int refocus_source_open(struct refocus_source **result, const char *name,
                        struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_source *source;
    const struct rf_source_ops *ops;
    const char *rest = "";
    int status;

    if (!result)
        return REFOCUS_ERR_ARGUMENT;
    *result = NULL;
    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!name)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "no name; give KIND:NAME");
    ops = find(name, &rest);
    if (!ops)
        return unknown(name, reason);
    source = calloc(1, sizeof *source);
    if (!source)
        return rf_capture_fail_memory(reason);
    source->ops = ops;
    source->config = refocus_source_config_default();
    source->counters = refocus_source_counters_default();
    source->wake_fd = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    source->name = strdup(name);
    status = !source->name         ? rf_capture_fail_memory(reason)
             : source->wake_fd < 0 ? rf_capture_fail_errno(reason, errno, name)
                                   : ops->open(source, rest, reason);
    if (status != REFOCUS_OK) {
        if (source->wake_fd >= 0)
            close(source->wake_fd);
        free(source->name);
        free(source);
        return status;
    }
    *result = source;
    return REFOCUS_OK;
}

void refocus_source_close(struct refocus_source **handle)
{
    struct refocus_source *source = handle ? *handle : NULL;

    if (!source)
        return;
    refocus_source_stop(source);
    source->ops->close(source);
    close(source->wake_fd);
    free(source->name);
    free(source);
    *handle = NULL;
}

/* As far as the caller's struct goes. */
static int write_mode(struct refocus_source_mode *mode, const struct refocus_source_mode *own)
{
    return refocus_struct_write(mode, REFOCUS_SIZE_TO(struct refocus_source_mode, fps), own,
                                sizeof *own);
}

int refocus_source_get_mode(struct refocus_source *source, int index,
                            struct refocus_source_mode *mode)
{
    struct refocus_source_mode own = refocus_source_mode_default();
    int status;

    if (!source || index < 0 || write_mode(mode, &own))
        return REFOCUS_ERR_ARGUMENT;
    status = source->ops->get_mode(source, index, &own);
    if (status == REFOCUS_OK)
        write_mode(mode, &own);
    return status;
}

static bool config_is_sound(const struct refocus_source_config *config)
{
    return config->format < REFOCUS_FRAME_FORMAT_COUNT && config->width >= 0 &&
           config->width <= REFOCUS_MAX_SIDE && config->height >= 0 &&
           config->height <= REFOCUS_MAX_SIDE && config->fps >= 0 && config->fps <= 10000 &&
           config->default_fps >= 0 && config->default_fps <= 10000 &&
           (config->buffers == 0 || (config->buffers >= 2 && config->buffers <= RF_MOST_BUFFERS)) &&
           config->flags < 16;
}

/* Zeros the caller's mode, which may be NULL: one of no known size is refused before anything is
 * done. */
static int clear_mode(struct refocus_source_mode *mode, struct refocus_reason *reason)
{
    const struct refocus_source_mode none = refocus_source_mode_default();

    if (mode && write_mode(mode, &none))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "mode is not of a known size of struct");
    return REFOCUS_OK;
}

static int begin(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason)
{
    struct refocus_source_mode own = refocus_source_mode_default();
    int status;

    source->out = 0;
    source->sequence_known = false;
    status = source->ops->start(source, &own, reason);
    source->streaming = status == REFOCUS_OK;
    if (mode && status == REFOCUS_OK)
        write_mode(mode, &own);
    return status;
}

int refocus_source_start(struct refocus_source *source, const struct refocus_source_config *config,
                         struct refocus_source_mode *mode, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_source_config own;
    uint64_t ignored;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if ((status = clear_mode(mode, reason)))
        return status;
    if (config &&
        (status = refocus_struct_read(
             &own, sizeof own, REFOCUS_SIZE_TO(struct refocus_source_config, flags), config)))
        return rf_capture_fail(reason, status, "config is not of a known size of struct");
    config = config ? &own : NULL;
    if (!source || (config && !config_is_sound(config)))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "what is wanted of the source is out of its range");
    if (source->streaming)
        return rf_capture_fail(reason, REFOCUS_ERR_STATE, "it streams already; stop it first");
    source->config = config ? *config : refocus_source_config_default();
    if (source->config.buffers == 0)
        source->config.buffers = 4;
    if (read(source->wake_fd, &ignored, sizeof ignored) < 0 && errno != EAGAIN)
        return rf_capture_fail_errno(reason, errno, source->name);
    return begin(source, mode, reason);
}

/* Counts what the camera left out; a step back is no gap but a device that began
 * anew. */
static void count_lost(struct refocus_source *source, const struct refocus_frame *frame)
{
    const uint32_t step = frame->sequence - source->sequence;

    if (source->sequence_known && step > 1 && step < 1u << 31)
        source->counters.dropped += step - 1;
    source->sequence = frame->sequence;
    source->sequence_known = true;
    source->counters.frames++;
    source->counters.corrupt += (frame->flags & REFOCUS_FRAME_CORRUPT) != 0;
}

int refocus_source_wait(struct refocus_source *source, int timeout_ms,
                        const struct refocus_frame **result, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_frame *frame = NULL;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!source || !result)
        return REFOCUS_ERR_ARGUMENT;
    *result = NULL;
    if (!source->streaming)
        return rf_capture_fail(reason, REFOCUS_ERR_STATE, "it does not stream; start it");
    status = rf_source_poll(source, -1, 0, 0, NULL);
    if (status == REFOCUS_ERR_CANCELLED)
        return rf_capture_fail(reason, status, "interrupted");
    status = source->ops->wait(
        source, rf_now_ns() + (int64_t)(timeout_ms > 0 ? timeout_ms : 0) * 1000000, &frame, reason);
    if (status == REFOCUS_ERR_TIMEOUT)
        return rf_capture_fail(reason, status, "no frame came within %d ms", timeout_ms);
    if (status == REFOCUS_ERR_CANCELLED)
        return rf_capture_fail(reason, status, "interrupted");
    if (status != REFOCUS_OK)
        return status;
    source->out |= (uint64_t)1 << frame->buffer;
    count_lost(source, frame);
    *result = frame;
    return REFOCUS_OK;
}

void refocus_source_release(struct refocus_source *source, const struct refocus_frame *frame)
{
    if (!source || !frame || !source->streaming || frame->buffer >= RF_MOST_BUFFERS ||
        !(source->out >> frame->buffer & 1))
        return;
    source->out &= ~((uint64_t)1 << frame->buffer);
    source->counters.released++;
    source->ops->release(source, (struct refocus_frame *)(uintptr_t)frame);
}

void refocus_source_stop(struct refocus_source *source)
{
    if (!source || !source->streaming)
        return;
    for (; source->out; source->out &= source->out - 1)
        source->counters.released++;
    source->ops->stop(source);
    source->streaming = false;
}

int refocus_source_restart(struct refocus_source *source, struct refocus_source_mode *mode,
                           struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!source)
        return REFOCUS_ERR_ARGUMENT;
    if ((status = clear_mode(mode, reason)))
        return status;
    refocus_source_stop(source);
    if (rf_source_poll(source, -1, 0, 0, NULL) == REFOCUS_ERR_CANCELLED)
        return rf_capture_fail(reason, REFOCUS_ERR_CANCELLED, "interrupted");
    status = source->ops->reopen ? source->ops->reopen(source, reason) : REFOCUS_OK;
    /* A device that lost its power forgets its focus. Pictures out of focus are better than none:
     * whether it obeys is not asked. */
    if (status == REFOCUS_OK && source->focused)
        source->ops->set_focus(source, source->focus_mode, source->focus_position,
                               &(struct refocus_reason){""});
    if (status == REFOCUS_OK)
        status = begin(source, mode, reason);
    source->counters.restarts += status == REFOCUS_OK;
    return status;
}

void refocus_source_interrupt(struct refocus_source *source)
{
    const uint64_t one = 1;

    /* A full counter refuses the write, and is readable all the same. */
    if (source && write(source->wake_fd, &one, sizeof one) < 0)
        return;
}

int refocus_source_set_control(struct refocus_source *source, const char *name, double value,
                               struct refocus_reason *reason)
{
    struct refocus_reason unheard;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!source || !name)
        return REFOCUS_ERR_ARGUMENT;
    if (!(value >= -(double)INT32_MAX && value <= (double)INT32_MAX))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "%.60s: %g is no value of a control",
                               name, value);
    if (!source->ops->set_control)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "sources of the kind '%s' have no controls", source->ops->scheme);
    return source->ops->set_control(source, name, value, reason);
}

void refocus_source_get_counters(const struct refocus_source *source,
                                 struct refocus_source_counters *counters)
{
    const struct refocus_source_counters none = refocus_source_counters_default();

    refocus_struct_write(counters, REFOCUS_SIZE_TO(struct refocus_source_counters, restarts),
                         source ? &source->counters : &none, sizeof none);
}

int refocus_source_list(refocus_source_found *found, void *user)
{
    int total = 0;

    if (!found)
        return REFOCUS_ERR_ARGUMENT;
    for (int i = 0; i < BACKENDS + 2; i++) {
        const struct rf_source_ops *ops = i < BACKENDS    ? backends[i]
                                          : i == BACKENDS ? rf_libcamera()
                                                          : rf_pipewire_source();
        const int n = ops && ops->list ? ops->list(found, user) : 0;

        if (n < 0)
            return n;
        total += n;
    }
    return total;
}
