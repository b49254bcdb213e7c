/* modes.c: the formats and sizes that a node of PipeWire offers. */
#include <spa/param/format-utils.h>
#include <spa/pod/iter.h>
#include <string.h>
#include "pipewire.h"

struct modes {
    uint32_t format; /* the only one that counts, or ANY */
    int left;        /* modes before the one that is wanted */
    bool found;
    struct refocus_source_mode mode;
};

/* The values of a property; of an enumeration without its default, of a range the default. */
static const void *values_of(const struct spa_pod *pod, uint32_t key, uint32_t type, uint32_t size,
                             uint32_t *count)
{
    const struct spa_pod_prop *prop = spa_pod_find_prop(pod, NULL, key);
    uint32_t choice;
    struct spa_pod *values;

    *count = 0;
    if (!prop)
        return NULL;
    values = spa_pod_get_values(&prop->value, count, &choice);
    if (SPA_POD_TYPE(values) != type || SPA_POD_BODY_SIZE(values) < size || *count == 0) {
        *count = 0;
        return NULL;
    }
    if (choice != SPA_CHOICE_Enum || *count == 1) {
        *count = 1;
        return SPA_POD_BODY(values);
    }
    (*count)--;
    return (const char *)SPA_POD_BODY(values) + SPA_POD_BODY_SIZE(values);
}

static void format_came(void *data, int seq, uint32_t id, uint32_t index, uint32_t next,
                        const struct spa_pod *pod)
{
    static const uint32_t jpeg = REFOCUS_FRAME_MJPEG;
    struct modes *modes = data;
    uint32_t type, subtype, kinds = 1, sizes, rates;
    const uint32_t *kind = &jpeg;
    const struct spa_rectangle *size;
    const struct spa_fraction *rate;
    double fps = 0;

    (void)seq;
    (void)index;
    (void)next;
    if (modes->found || id != SPA_PARAM_EnumFormat || !pod ||
        spa_format_parse(pod, &type, &subtype) < 0 || type != SPA_MEDIA_TYPE_video ||
        (subtype != SPA_MEDIA_SUBTYPE_raw && subtype != SPA_MEDIA_SUBTYPE_mjpg))
        return;
    if (subtype == SPA_MEDIA_SUBTYPE_raw)
        kind = values_of(pod, SPA_FORMAT_VIDEO_format, SPA_TYPE_Id, sizeof *kind, &kinds);
    size = values_of(pod, SPA_FORMAT_VIDEO_size, SPA_TYPE_Rectangle, sizeof *size, &sizes);
    rate = values_of(pod, SPA_FORMAT_VIDEO_framerate, SPA_TYPE_Fraction, sizeof *rate, &rates);
    for (uint32_t i = 0; i < rates; i++)
        if (rate[i].denom && (double)rate[i].num / rate[i].denom > fps)
            fps = (double)rate[i].num / rate[i].denom;
    for (uint32_t i = 0; i < kinds; i++)
        for (uint32_t j = 0; j < sizes; j++) {
            const uint32_t format = kind == &jpeg ? jpeg : rf_pipewire_format_of(kind[i]);

            if (format == REFOCUS_FRAME_ANY ||
                (modes->format != REFOCUS_FRAME_ANY && format != modes->format) ||
                size[j].width < 1 || size[j].height < 1 || size[j].width > REFOCUS_MAX_SIDE ||
                size[j].height > REFOCUS_MAX_SIDE || modes->found || modes->left-- > 0)
                continue;
            modes->found = true;
            modes->mode.format = format;
            modes->mode.width = (int32_t)size[j].width;
            modes->mode.height = (int32_t)size[j].height;
            modes->mode.fps = fps;
        }
}

static const struct pw_node_events node_events = {PW_VERSION_NODE_EVENTS, .param = format_came};

int rf_pipewire_mode(struct rf_pipewire *pipewire, uint32_t node, uint32_t format, int index,
                     struct refocus_source_mode *mode)
{
    struct modes modes = {.format = format, .left = index};
    struct refocus_reason ignored;
    struct spa_hook hook;
    struct pw_proxy *proxy;
    int status;

    modes.mode = refocus_source_mode_default();
    spa_zero(hook);
    pw_thread_loop_lock(pipewire->loop);
    proxy = pw_registry_bind(pipewire->registry, node, PW_TYPE_INTERFACE_Node, PW_VERSION_NODE, 0);
    if (proxy) {
        pw_node_add_listener((struct pw_node *)proxy, &hook, &node_events, &modes);
        pw_node_enum_params((struct pw_node *)proxy, 0, SPA_PARAM_EnumFormat, 0, UINT32_MAX, NULL);
    }
    pw_thread_loop_unlock(pipewire->loop);
    if (!proxy)
        return REFOCUS_ERR_GONE;
    status = rf_pipewire_sync(pipewire, NULL, &ignored);
    if (status == REFOCUS_OK && !modes.found)
        status = REFOCUS_ERR_ARGUMENT;
    pw_thread_loop_lock(pipewire->loop);
    spa_hook_remove(&hook);
    pw_proxy_destroy(proxy);
    pw_thread_loop_unlock(pipewire->loop);
    if (status == REFOCUS_OK)
        *mode = modes.mode;
    return status;
}
