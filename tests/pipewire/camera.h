/* camera.h: a camera of PipeWire whose frames and faults a test chooses. */
#ifndef PIPEWIRE_CAMERA_H
#define PIPEWIRE_CAMERA_H

#include <pipewire/pipewire.h>
#include <stdbool.h>
#include <stdint.h>

/* Frames of NV12 and GRAY16 have bytes of `value`, those of U and V its successor; frames of JPEG
 * are `size` such bytes. Set what follows `fill` as the next frame shall say it. */
struct camera {
    struct pw_thread_loop *loop;
    struct pw_context *context;
    struct pw_core *core;
    struct pw_stream *stream;
    struct spa_hook hook;
    uint32_t format;         /* enum spa_video_format: NV12, GRAY16_LE, or ENCODED for JPEG */
    int width, height, room; /* bytes more than a picture takes */
    bool agreed;             /* somebody looks at pictures of this size */
    bool device;             /* planes lie one by one in memory that is said to be a device's */

    uint32_t missing;      /* bytes of the memory of a device, at its end */
    uint32_t offset, size; /* size 0: as large as the picture */
    int32_t stride;        /* 0: rows without gaps */
    int32_t said_stride;   /* the one that is said, where it is not 0 */
    uint32_t chunk_flags, header_flags;
    uint64_t sequence;
    int64_t pts;
};

/* False when there is no PipeWire. device: NV12 in buffers of DmaBuf. They are no memory of a
 * device, but can be mapped as such is, from a page on that is not the first. */
bool camera_open(struct camera *camera, const char *name, uint32_t format, int width, int height,
                 int room, bool device);
/* From now on pictures have another size. */
void camera_resize(struct camera *camera, int width, int height);
/* Show one frame; false when nobody looks or all buffers are taken. */
bool camera_show(struct camera *camera, uint8_t value);
void camera_close(struct camera *camera);

#endif
