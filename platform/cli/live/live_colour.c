/* live_colour.c: the thread that takes pictures from the camera. */
#include "line/report.h"
#include "live/live_colour.h"
#include "live/live_estimate.h"
#include "live/live_lane.h"
#include "live/live_stack.h"

/* When it was taken: by the camera's clock where that is ours and plausible. */
static int64_t taken_at(const struct refocus_frame *frame, int64_t now_ns)
{
    const int64_t age = now_ns - frame->timestamp_ns;

    return frame->flags & REFOCUS_FRAME_MONOTONIC && age >= 0 && age < 1000000000
               ? frame->timestamp_ns
               : now_ns;
}

/* A frame is rendered in its own Y, U and V if nobody needs anything else. */
static uint32_t format_for(const struct live_lane *lane, const struct refocus_frame *frame)
{
    const struct live *live = lane->live;
    const uint32_t own =
        live->yuv_formats ? refocus_convert_image_format(lane->converter, frame) : 0;

    return own && live->yuv_formats >> own & 1 ? own : (uint32_t)REFOCUS_FORMAT_RGB8;
}

static int deliver_colour(struct live_lane *lane, const struct refocus_frame *frame, int64_t now_ns,
                          struct refocus_reason *reason)
{
    struct live *live = lane->live;
    struct live_picture *picture;
    bool memory;
    int status;

    const uint32_t format = format_for(lane, frame);
    picture = live_queue_fill(&live->captured, format, frame->width, frame->height, &memory);
    if (!picture)
        return REFOCUS_OK;
    /* The time of waiting for a free slot is not that of converting. */
    const int64_t begin = live_now_ns();
    if (!memory)
        status = REFOCUS_ERR_MEMORY;
    else if (format == REFOCUS_FORMAT_RGB8)
        status = refocus_convert_rgb8(lane->converter, frame, &picture->image, reason);
    else
        status = refocus_convert_copy(lane->converter, frame, &picture->image, reason);
    live->rendered_format = format;
    if (status == REFOCUS_OK && live->estimator)
        status = live_estimate_offer(live, picture, frame, lane->converter, reason);
    if (status != REFOCUS_OK) {
        live_queue_return(&live->captured, picture);
        return status;
    }
    picture->timestamp_ns = frame->timestamp_ns;
    picture->taken_ns = taken_at(frame, now_ns);
    picture->lens_dioptres = frame->lens_dioptres;
    picture->still = frame->flags & REFOCUS_FRAME_STILL;
    live_times_add(&lane->stage->times, (double)(live_now_ns() - begin) / 1e6);
    live_queue_put(&live->captured, picture);
    return REFOCUS_OK;
}

void *live_colour_thread(void *argument)
{
    struct live *live = argument;
    struct live_lane lane =
        live_lane_of(live, live->camera, live->settings->camera, &live->mode, &live->capture);

    lane.deliver = deliver_colour;
    lane.between = live->stack ? live_stack_take : NULL;
    if (refocus_converter_create(&lane.converter) == REFOCUS_OK)
        live_lane_run(&lane);
    else
        live_fail(live, EXIT_FAILED, lane.name, "not enough memory");
    refocus_converter_destroy(&lane.converter);
    live_queue_close(&live->captured);
    live_queue_close(&live->to_estimate);
    return NULL;
}
