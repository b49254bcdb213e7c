/* live_output.c: the thread that writes what is rendered. */
#include <string.h>
#include <time.h>
#include "line/interrupt.h"
#include "live/live_output.h"

/* A device that went away is opened again until patience ends. */
static bool reopen(struct live *live, const struct refocus_image *image,
                   struct refocus_reason *reason)
{
    const struct timespec pause = {0, 50000000};
    const int64_t since = live_now_ns();

    refocus_sink_close(&live->sink, NULL);
    while (!live_is_over(live)) {
        if (refocus_sink_open(&live->sink, live->settings->out, reason) == REFOCUS_OK &&
            refocus_sink_start_image(live->sink, image, live->mode.fps, reason) == REFOCUS_OK) {
            live->output.recoveries++;
            return true;
        }
        refocus_sink_close(&live->sink, NULL);
        if ((double)(live_now_ns() - since) / 1e9 > live->settings->patience)
            return false;
        nanosleep(&pause, NULL);
    }
    return false;
}

static bool is_device(const struct live *live)
{
    return strncmp(live->settings->out, "v4l2:", 5) == 0 ||
           strncmp(live->settings->out, "pipewire:", 9) == 0;
}

bool live_output_is_stream(const struct live *live)
{
    return strncmp(live->settings->out, "y4m:", 4) == 0 ||
           strncmp(live->settings->out, "raw:", 4) == 0;
}

/* False when it is over. */
static bool write_picture(struct live *live, const struct live_picture *picture,
                          struct refocus_image *last)
{
    const struct refocus_image *image = &picture->image;
    struct refocus_reason reason = {""};
    int status = REFOCUS_OK;

    if (image->width != last->width || image->height != last->height ||
        image->format != last->format || image->range != last->range ||
        image->matrix != last->matrix)
        status = refocus_sink_start_image(live->sink, image, live->mode.fps, &reason);
    *last = *image;
    if (status == REFOCUS_OK)
        status = refocus_sink_write(live->sink, image, &reason);
    if (status == REFOCUS_ERR_TIMEOUT || status == REFOCUS_ERR_CANCELLED) {
        live->sink_dropped++;
        return true;
    }
    if (status == REFOCUS_ERR_END)
        return false; /* the window was closed by its user */
    if ((status == REFOCUS_ERR_GONE || status == REFOCUS_ERR_IO) && is_device(live)) {
        live->sink_dropped++;
        if (reopen(live, image, &reason))
            return true;
        if (live_is_over(live))
            return false;
    }
    if (status == REFOCUS_OK) {
        live->last_out_ns = live_now_ns();
        live->first_out_ns = live->first_out_ns ? live->first_out_ns : live->last_out_ns;
        live_times_add(&live->latency, (double)(live->last_out_ns - picture->taken_ns) / 1e6);
        atomic_fetch_add(&live->frames_out, 1);
        return true;
    }
    live_fail(live, EXIT_FAILED, live->settings->out,
              reason.text[0] ? reason.text : refocus_strerror(status));
    return false;
}

void *live_output_thread(void *argument)
{
    struct live *live = argument;
    const double most = live->settings->frames;
    struct refocus_image last = {.struct_size = sizeof(struct refocus_image),
                                 .format = REFOCUS_FORMAT_NONE};
    bool ended = false;

    while (!ended) {
        struct live_picture *picture = live_queue_take(&live->rendered, &ended);
        const int64_t begin = live_now_ns();
        bool go_on;

        if (!picture)
            continue;
        if (interrupt_came()) {
            live->sink_dropped++;
            live_queue_return(&live->rendered, picture);
            continue;
        }
        go_on = write_picture(live, picture, &last);
        live_times_add(&live->output.times, (double)(live_now_ns() - begin) / 1e6);
        live_queue_return(&live->rendered, picture);
        if (most > 0 && (double)atomic_load(&live->frames_out) >= most)
            go_on = false;
        if (!go_on)
            break;
    }
    live_stop(live);
    live_queue_close(&live->rendered);
    return NULL;
}
