/* source.c: plays a file that a source reads, and converts its frames. */
#include "source.h"

#include <stdlib.h>
#include <string.h>
#include <refocus/platform/convert.h>

enum { MOST_FRAMES = 12, MOST_BYTES = 1 << 20 };

/* Every byte that the frame promises, for the sanitizers. */
static void read_frame(const struct refocus_frame *frame)
{
    volatile unsigned sum = 0;

    if (frame->format == REFOCUS_FRAME_ANY || frame->format >= REFOCUS_FRAME_FORMAT_COUNT ||
        frame->width < 1 || frame->height < 1 || frame->width > REFOCUS_MAX_SIDE ||
        frame->height > REFOCUS_MAX_SIDE)
        abort();
    for (int i = 0; i < rf_format_planes(frame->format); i++)
        for (int y = 0; y < rf_plane_rows(frame->format, i, frame->height); y++)
            for (int64_t x = 0; x < rf_plane_row(frame->format, i, frame->width); x++)
                sum += frame->plane[i][y * frame->stride[i] + x];
    (void)sum;
}

/* Converts the frame to a picture or to samples; one of the two must work. */
static void convert(struct refocus_converter *converter, const struct refocus_frame *frame)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    uint8_t *memory = malloc(pixels * 3);
    struct refocus_reason reason;

    if (memory && converter) {
        const struct refocus_image image = refocus_image_packed(
            REFOCUS_FORMAT_RGB8, memory, frame->width, frame->height, 3 * frame->width);

        if (frame->format < REFOCUS_FRAME_Y16)
            refocus_convert_rgb8(converter, frame, &image, &reason);
        if (frame->format >= REFOCUS_FRAME_GREY)
            refocus_convert_samples(converter, frame, (uint16_t *)memory, &reason);
    }
    free(memory);
}

static void take_frames(struct refocus_source *source)
{
    struct refocus_converter *converter = NULL;

    refocus_converter_create(&converter);
    for (int i = 0; i < MOST_FRAMES; i++) {
        const struct refocus_frame *frame = NULL;
        const int status = refocus_source_wait(source, 0, &frame, NULL);

        if ((status == REFOCUS_OK) != (frame != NULL))
            abort();
        if (frame) {
            read_frame(frame);
            if (i < 2)
                convert(converter, frame);
            if (i % 3 != 2) /* some stay out until the end */
                refocus_source_release(source, frame);
        } else if (status == REFOCUS_ERR_END ||
                   refocus_source_restart(source, NULL, NULL) != REFOCUS_OK) {
            break;
        }
    }
    refocus_converter_destroy(&converter);
}

void fuzz_source(const char *name)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_source *source = NULL;
    struct refocus_source_counters counters = refocus_source_counters_default();
    struct refocus_reason reason = {""};

    if (refocus_source_open(&source, name, &reason) != REFOCUS_OK) {
        if (source || !reason.text[0])
            abort();
        return;
    }
    refocus_source_get_mode(source, 0, &mode);
    config.flags = REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_LOOP;
    if ((int64_t)mode.width * mode.height <= MOST_BYTES &&
        refocus_source_start(source, &config, &mode, &reason) == REFOCUS_OK)
        take_frames(source);
    refocus_source_stop(source);
    refocus_source_get_counters(source, &counters);
    if (counters.frames != counters.released)
        abort();
    refocus_source_close(&source);
}
