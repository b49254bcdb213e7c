/* replay_frame.c: what the frames of a scripted camera hold: a made-up scene, a JPEG file, or
 * frames of another source. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "replay.h"
#include "replay_scene.h"

enum { MOST_JPEG_BYTES = 1 << 24 };

int rf_replay_draw(struct rf_replay *replay, struct refocus_reason *reason)
{
    const uint64_t bytes =
        rf_frame_bytes(replay->format, replay->stride, replay->width, replay->height);

    if (bytes == 0)
        return rf_capture_fail(reason, REFOCUS_ERR_FORMAT,
                               "the script's stride is less than a row");
    free(replay->scene);
    replay->scene = bytes < SIZE_MAX ? calloc(1, (size_t)bytes + 1) : NULL;
    if (!replay->scene)
        return rf_capture_fail_memory(reason);
    replay->scene_bytes = (size_t)bytes;
    rf_scene_draw(replay->scene, replay->format, replay->stride, replay->width, replay->height);
    return REFOCUS_OK;
}

/* The bytes of the JPEG file, and by a decoder's eye its size. */
int rf_replay_read_jpeg(struct rf_replay *replay, struct refocus_reason *reason)
{
    struct refocus_photo *photo = NULL;
    FILE *file = fopen(replay->script.jpeg, "rb");
    int status = refocus_photo_read(&photo, replay->script.jpeg, NULL, reason);

    if (status == REFOCUS_OK) {
        replay->width = photo->info->stored_width;
        replay->height = photo->info->stored_height;
        refocus_photo_free(&photo);
        replay->scene = malloc(MOST_JPEG_BYTES);
        if (!replay->scene || !file)
            status = rf_capture_fail_memory(reason);
        else
            replay->scene_bytes = fread(replay->scene, 1, MOST_JPEG_BYTES, file);
    }
    if (file)
        fclose(file);
    return status;
}

/* Copy the scene, moved sideways by four pixels a frame, as one that pans. */
static void copy_scene(const struct rf_replay *replay, const struct refocus_frame *frame,
                       uint8_t *memory, int64_t number)
{
    const int64_t steps = frame->width / 4 > 0 ? frame->width / 4 : 1;
    const int64_t shift = number % steps * 4;
    const uint8_t *from = replay->scene;

    for (int i = 0; i < rf_format_planes(frame->format); i++) {
        const int64_t row = rf_plane_row(frame->format, i, frame->width);
        const int64_t cut = frame->width < 4 ? 0 : shift * row / frame->width / 4 * 4;

        for (int y = 0; y < rf_plane_rows(frame->format, i, frame->height); y++) {
            memcpy(memory, from + cut, (size_t)(row - cut));
            memcpy(memory + (row - cut), from, (size_t)cut);
            memory += frame->stride[i];
            from += frame->stride[i];
        }
    }
}

static int copy_inner(struct rf_replay *replay, int buffer, struct refocus_frame *frame,
                      struct refocus_reason *reason)
{
    const struct refocus_frame *inner;
    const int status = refocus_source_wait(replay->inner, 1000, &inner, reason);
    int64_t stride;
    uint64_t bytes;

    if (status != REFOCUS_OK)
        return status;
    stride = rf_plane_row(inner->format, 0, inner->width);
    stride = replay->stride > stride ? replay->stride : stride;
    bytes = rf_frame_bytes(inner->format, stride, inner->width, inner->height);
    if (bytes == 0 || !rf_ring_reserve(&replay->ring, buffer, bytes)) {
        refocus_source_release(replay->inner, inner);
        return rf_capture_fail_memory(reason);
    }
    frame->format = inner->format;
    frame->width = inner->width;
    frame->height = inner->height;
    frame->flags |= inner->flags & REFOCUS_FRAME_FULL_RANGE;
    rf_frame_lay_out(frame, replay->ring.memory[buffer], stride);
    for (int i = 0; i < rf_format_planes(inner->format); i++) {
        uint8_t *to = replay->ring.memory[buffer] + (frame->plane[i] - frame->plane[0]);

        for (int y = 0; y < rf_plane_rows(inner->format, i, inner->height); y++)
            memcpy(to + y * frame->stride[i], inner->plane[i] + y * inner->stride[i],
                   (size_t)rf_plane_row(inner->format, i, inner->width));
    }
    refocus_source_release(replay->inner, inner);
    return REFOCUS_OK;
}

int rf_replay_fill(struct rf_replay *replay, int buffer, struct refocus_frame *frame,
                   struct refocus_reason *reason)
{
    if (replay->script.stack) {
        const int status = rf_lens_look(&replay->lens, &replay->script, &replay->inner, reason);

        if (status != REFOCUS_OK)
            return status;
    }
    if (replay->inner)
        return copy_inner(replay, buffer, frame, reason);
    if (!rf_ring_reserve(&replay->ring, buffer, replay->scene_bytes))
        return rf_capture_fail_memory(reason);
    frame->format = replay->format;
    frame->width = replay->width;
    frame->height = replay->height;
    if (replay->format == REFOCUS_FRAME_MJPEG) {
        memcpy(replay->ring.memory[buffer], replay->scene, replay->scene_bytes);
        frame->plane[0] = replay->ring.memory[buffer];
        frame->bytes = replay->scene_bytes;
        return REFOCUS_OK;
    }
    rf_frame_lay_out(frame, replay->ring.memory[buffer], replay->stride);
    copy_scene(replay, frame, replay->ring.memory[buffer], replay->next);
    return REFOCUS_OK;
}
