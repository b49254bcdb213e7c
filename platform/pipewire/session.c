/* session.c: a connection to PipeWire with a thread of its own, and the nodes that give video. */
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>
#include "pipewire.h"

static const int64_t patience_ns = 2000000000;

void rf_pipewire_wake(struct rf_pipewire *pipewire)
{
    const uint64_t one = 1;

    if (write(pipewire->ready, &one, sizeof one) < 0)
        return; /* full: it is readable all the same */
}

static void core_done(void *data, uint32_t id, int seq)
{
    struct rf_pipewire *pipewire = data;

    if (id == PW_ID_CORE && seq == pipewire->asked)
        pipewire->answered = seq;
    rf_pipewire_wake(pipewire);
}

static void core_error(void *data, uint32_t id, int seq, int res, const char *message)
{
    struct rf_pipewire *pipewire = data;

    (void)seq;
    (void)message;
    if (id == PW_ID_CORE && res == -EPIPE)
        pipewire->gone = true;
    rf_pipewire_wake(pipewire);
}

static const struct pw_core_events core_events = {PW_VERSION_CORE_EVENTS, .done = core_done,
                                                  .error = core_error};

static void copy(char *to, size_t size, const struct spa_dict *props, const char *key)
{
    const char *value = spa_dict_lookup(props, key);

    snprintf(to, size, "%s", value ? value : "");
}

static void node_came(void *data, uint32_t id, uint32_t permissions, const char *type,
                      uint32_t version, const struct spa_dict *props)
{
    struct rf_pipewire *pipewire = data;
    const char *class, *program, *priority;
    struct rf_pipewire_node *node;

    (void)permissions;
    (void)version;
    if (!props || strcmp(type, PW_TYPE_INTERFACE_Node) != 0 || pipewire->nodes == RF_MOST_NODES)
        return;
    class = spa_dict_lookup(props, PW_KEY_MEDIA_CLASS);
    if (!class || (strcmp(class, "Video/Source") != 0 && strcmp(class, "Stream/Output/Video") != 0))
        return;
    program = spa_dict_lookup(props, PW_KEY_APP_NAME);
    priority = spa_dict_lookup(props, PW_KEY_PRIORITY_SESSION);
    node = &pipewire->node[pipewire->nodes++];
    node->id = id;
    node->camera = class[0] == 'V';
    node->ours = program && strcmp(program, "refocus") == 0;
    node->priority = priority ? atoi(priority) : 0;
    copy(node->serial, sizeof node->serial, props, PW_KEY_OBJECT_SERIAL);
    copy(node->name, sizeof node->name, props, PW_KEY_NODE_NAME);
    copy(node->description, sizeof node->description, props, PW_KEY_NODE_DESCRIPTION);
}

static void node_went(void *data, uint32_t id)
{
    struct rf_pipewire *pipewire = data;

    for (int i = 0; i < pipewire->nodes; i++)
        if (pipewire->node[i].id == id) {
            pipewire->node[i] = pipewire->node[--pipewire->nodes];
            rf_pipewire_wake(pipewire);
        }
}

static const struct pw_registry_events registry_events = {
    PW_VERSION_REGISTRY_EVENTS, .global = node_came, .global_remove = node_went};

int rf_pipewire_fail_gone(struct refocus_reason *reason)
{
    return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the connection to PipeWire is broken");
}

int rf_pipewire_wait(struct rf_pipewire *pipewire, const struct refocus_source *source,
                     int64_t deadline_ns)
{
    const struct refocus_source never = {.wake_fd = -1};
    const int status =
        rf_source_poll(source ? source : &never, pipewire->ready, POLLIN, deadline_ns, NULL);
    uint64_t ignored;

    if (status == REFOCUS_OK && read(pipewire->ready, &ignored, sizeof ignored) < 0)
        return errno == EAGAIN ? REFOCUS_OK : REFOCUS_ERR_IO;
    return status;
}

int rf_pipewire_sync(struct rf_pipewire *pipewire, const struct refocus_source *source,
                     struct refocus_reason *reason)
{
    const int64_t deadline_ns = rf_now_ns() + patience_ns;
    int status = REFOCUS_OK;
    bool gone, done = false;

    pw_thread_loop_lock(pipewire->loop);
    pipewire->asked = pw_core_sync(pipewire->core, PW_ID_CORE, pipewire->asked);
    pw_thread_loop_unlock(pipewire->loop);
    for (;;) {
        pw_thread_loop_lock(pipewire->loop);
        done = pipewire->answered == pipewire->asked;
        gone = pipewire->gone;
        pw_thread_loop_unlock(pipewire->loop);
        if (gone)
            return rf_pipewire_fail_gone(reason);
        if (done)
            return REFOCUS_OK;
        if (status == REFOCUS_ERR_CANCELLED)
            return rf_capture_fail(reason, status, "interrupted");
        if (status != REFOCUS_OK)
            return rf_capture_fail(reason, REFOCUS_ERR_IO,
                                   "PipeWire does not answer; start it anew");
        status = rf_pipewire_wait(pipewire, source, deadline_ns);
    }
}

static void begin(void)
{
    pw_init(NULL, NULL);
    pw_log_set_level(SPA_LOG_LEVEL_NONE); /* reasons say what failed */
}

static int connect_core(struct rf_pipewire *pipewire, struct refocus_reason *reason)
{
    pipewire->loop = pw_thread_loop_new("refocus", NULL);
    if (!pipewire->loop)
        return rf_capture_fail_memory(reason);
    pipewire->context = pw_context_new(pw_thread_loop_get_loop(pipewire->loop), NULL, 0);
    if (!pipewire->context)
        return rf_capture_fail(reason, REFOCUS_ERR_IO,
                               "PipeWire's client.conf or modules are missing; install pipewire");
    pipewire->core = pw_context_connect(pipewire->context, NULL, 0);
    if (!pipewire->core && errno == EACCES)
        return rf_capture_fail_errno(reason, errno, "PipeWire");
    if (!pipewire->core)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "no PipeWire runs for this user; start pipewire and wireplumber");
    pw_core_add_listener(pipewire->core, &pipewire->core_hook, &core_events, pipewire);
    pipewire->registry = pw_core_get_registry(pipewire->core, PW_VERSION_REGISTRY, 0);
    if (!pipewire->registry)
        return rf_capture_fail_memory(reason);
    pw_registry_add_listener(pipewire->registry, &pipewire->registry_hook, &registry_events,
                             pipewire);
    if (pw_thread_loop_start(pipewire->loop) < 0)
        return rf_capture_fail_memory(reason);
    return REFOCUS_OK;
}

int rf_pipewire_open(struct rf_pipewire *pipewire, struct refocus_reason *reason)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    int status;

    pthread_once(&once, begin);
    memset(pipewire, 0, sizeof *pipewire);
    pipewire->ready = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    status = pipewire->ready < 0 ? rf_capture_fail_errno(reason, errno, "PipeWire")
                                 : connect_core(pipewire, reason);
    if (status != REFOCUS_OK)
        rf_pipewire_close(pipewire);
    return status;
}

static int tell_drained(struct spa_loop *loop, bool async, uint32_t seq, const void *data,
                        size_t size, void *user)
{
    struct rf_pipewire *pipewire = user;

    (void)loop, (void)async, (void)seq, (void)data, (void)size;
    pipewire->drained = true;
    pw_thread_loop_signal(pipewire->loop, false);
    return 0;
}

void rf_pipewire_end_stream(struct rf_pipewire *pipewire, struct pw_stream **stream)
{
    if (!*stream)
        return;
    pw_stream_disconnect(*stream);
    pipewire->drained = false;
    pw_loop_invoke(pw_thread_loop_get_loop(pipewire->loop), tell_drained, 0, NULL, 0, false,
                   pipewire);
    while (!pipewire->drained)
        pw_thread_loop_wait(pipewire->loop);
    pw_stream_destroy(*stream);
    *stream = NULL;
}

static int note_thread(struct spa_loop *loop, bool async, uint32_t seq, const void *data,
                       size_t size, void *user)
{
    (void)loop, (void)async, (void)seq, (void)data, (void)size;
    *(pthread_t *)user = pthread_self();
    return 0;
}

/* The thread of a context that is ended before it has begun runs for ever (PipeWire 0.3.65), and
 * whoever ends it waits for it. Until then calls to it are made by the caller itself. */
static void wait_for_data_thread(struct pw_context *context)
{
    const struct timespec pause = {0, 1000000};
    pthread_t thread = pthread_self();

    for (int tries = 0; tries < 200 && pthread_equal(thread, pthread_self()); tries++) {
        pw_data_loop_invoke(pw_context_get_data_loop(context), note_thread, 0, NULL, 0, true,
                            &thread);
        if (pthread_equal(thread, pthread_self()))
            nanosleep(&pause, NULL);
    }
}

void rf_pipewire_close(struct rf_pipewire *pipewire)
{
    if (pipewire->loop)
        pw_thread_loop_stop(pipewire->loop);
    if (pipewire->registry)
        pw_proxy_destroy((struct pw_proxy *)pipewire->registry);
    if (pipewire->core)
        pw_core_disconnect(pipewire->core);
    if (pipewire->context) {
        wait_for_data_thread(pipewire->context);
        pw_context_destroy(pipewire->context);
    }
    if (pipewire->loop)
        pw_thread_loop_destroy(pipewire->loop);
    if (pipewire->ready >= 0)
        close(pipewire->ready);
    memset(pipewire, 0, sizeof *pipewire);
    pipewire->ready = -1;
}

const struct rf_pipewire_node *rf_pipewire_find(const struct rf_pipewire *pipewire,
                                                const char *name)
{
    const struct rf_pipewire_node *best = NULL;

    for (int i = 0; i < pipewire->nodes; i++) {
        const struct rf_pipewire_node *node = &pipewire->node[i];
        char number[16];

        snprintf(number, sizeof number, "%u", node->id);
        if (name[0] ? strcmp(name, node->name) == 0 || strcmp(name, number) == 0 ||
                          strcmp(name, node->description) == 0
                    : node->camera && !node->ours && (!best || node->priority > best->priority))
            best = node;
    }
    return best;
}
