/* pipewire.h: the connection to PipeWire, its formats and the buffers of frames that come. */
#ifndef RF_PIPEWIRE_H
#define RF_PIPEWIRE_H

#include <pipewire/pipewire.h>
#include <spa/pod/builder.h>
#include "backend.h"

enum { RF_MOST_NODES = 64, RF_POD_BYTES = 4096 };

/* A node that gives video. */
struct rf_pipewire_node {
    uint32_t id;
    int priority;
    bool camera, ours; /* whether the node is a camera, and whether a sink `pipewire:` made it */
    char serial[24], name[128], description[128];
};

/* Whatever is below `loop` is written by the thread of PipeWire and read under the lock of the
 * loop. */
struct rf_pipewire {
    struct pw_context *context;
    struct pw_core *core;
    struct pw_registry *registry;
    struct spa_hook core_hook, registry_hook;
    int ready; /* eventfd: something has happened */
    struct pw_thread_loop *loop;
    int asked, answered; /* numbers of round trips */
    bool gone;           /* the connection is broken */
    bool drained;        /* calls that waited for a stream that ends are over */
    struct rf_pipewire_node node[RF_MOST_NODES];
    int nodes;
};

/* session.c: may be called without the lock -------------------------------------------- */

/* Connect. Nothing waits for PipeWire yet, which may be at a stand. */
int rf_pipewire_open(struct rf_pipewire *pipewire, struct refocus_reason *reason);
void rf_pipewire_close(struct rf_pipewire *pipewire);
/* Wait until something happens; as rf_source_poll(). source: whose interrupt ends it, or NULL. */
int rf_pipewire_wait(struct rf_pipewire *pipewire, const struct refocus_source *source,
                     int64_t deadline_ns);
/* Wait until everything that was asked is answered; then all nodes are known. */
int rf_pipewire_sync(struct rf_pipewire *pipewire, const struct refocus_source *source,
                     struct refocus_reason *reason);
/* In the thread of PipeWire: end a wait. */
void rf_pipewire_wake(struct rf_pipewire *pipewire);
/* Under the lock: end a stream, if there is one, when calls that were queued for it are over.
 * PipeWire 0.3.65 would make them to a stream that is gone. */
void rf_pipewire_end_stream(struct rf_pipewire *pipewire, struct pw_stream **stream);
int rf_pipewire_fail_gone(struct refocus_reason *reason);
/* The node of that name, number or description; of no name the best camera that is not of the sink
 * `pipewire:`. Under the lock, and good as long. */
const struct rf_pipewire_node *rf_pipewire_find(const struct rf_pipewire *pipewire,
                                                const char *name);

/* formats.c ---------------------------------------------------------------------------- */

struct rf_pipewire_format {
    uint32_t format; /* enum refocus_frame_format, ANY: none */
    int width, height;
    double fps;
    uint32_t matrix; /* enum refocus_matrix */
    bool full_range;
};

/* The format for one of enum spa_video_format; 0 for none. */
uint32_t rf_pipewire_format_of(uint32_t spa);
/* The format that both sides agreed on; format ANY when it is not one of ours. */
struct rf_pipewire_format rf_pipewire_read_format(const struct spa_pod *pod);
/* Formats of a source, the best first: 4 at the most. */
int rf_pipewire_offer_wishes(struct spa_pod_builder *builder, const struct spa_pod *pods[4],
                             const struct refocus_source_config *config);
/* The one format of a sink. */
const struct spa_pod *rf_pipewire_offer(struct spa_pod_builder *builder,
                                        const struct rf_pipewire_format *format);
/* Buffers of either, with a header; bytes and stride 0: as the other side wants. */
void rf_pipewire_offer_buffers(struct spa_pod_builder *builder, const struct spa_pod *pods[2],
                               int count, uint64_t bytes, int64_t stride, uint32_t types);

/* modes.c ------------------------------------------------------------------------------ */

/* Mode number index of a node, among those of a format or of all; REFOCUS_ERR_ARGUMENT where there
 * are not as many. */
int rf_pipewire_mode(struct rf_pipewire *pipewire, uint32_t node, uint32_t format, int index,
                     struct refocus_source_mode *mode);

/* buffers.c ---------------------------------------------------------------------------- */

/* A buffer, and the frame that lies in it. */
struct rf_pipewire_buffer {
    struct pw_buffer *buffer; /* NULL: unused */
    bool out;                 /* the caller reads the frame */
    int planes;               /* memories: 1 or a plane each */
    struct rf_pipewire_memory {
        uint8_t *first;
        size_t size;
        void *map; /* our own mapping, or NULL */
        size_t mapped;
        int fd; /* descriptor of a device's memory, or -1 */
    } memory[3];
    struct refocus_frame frame;
};

/* False, and unused, when it cannot be mapped or is smaller than a picture of the format. */
bool rf_pipewire_map(struct rf_pipewire_buffer *buffer, struct pw_buffer *from,
                     const struct rf_pipewire_format *format);
void rf_pipewire_unmap(struct rf_pipewire_buffer *buffer);
/* Describe as a frame what lies in it now. */
void rf_pipewire_lay_out(struct rf_pipewire_buffer *buffer,
                         const struct rf_pipewire_format *format);
/* Called before and after the processor reads memory of a device. */
void rf_pipewire_touch(const struct rf_pipewire_buffer *buffer, bool begin);

#endif
