/* live_estimate.c: depth is made of the pictures themselves: every n-th one goes through a network,
 * in a thread of its own, while the others are rendered. */
#include <stdlib.h>
#include <string.h>
#include "inputs/estimate.h"
#include "inputs/opencv.h"
#include "line/report.h"
#include "live/live_estimate.h"

static const char prefix[] = "estimate:";

bool live_estimate_is_meant(const char *depth)
{
    return strncmp(depth, prefix, strlen(prefix)) == 0;
}

static int find_preset(const char *name)
{
    for (uint32_t i = 0; opencv_network_name(i); i++)
        if (strcmp(opencv_network_name(i), name) == 0)
            return (int)i;
    return -1;
}

/* "estimate:MODEL,every=N,preset=NAME", from the end, as names of files may hold
 * commas. */
int live_estimate_parse(struct live_estimate_settings *settings, const char *depth)
{
    char *comma;

    *settings = (struct live_estimate_settings){.every = 1};
    if (snprintf(settings->model, sizeof settings->model, "%s", depth + strlen(prefix)) >=
        (int)sizeof settings->model)
        return report_failure(EXIT_WRONG, "--depth", "the name of the model is too long");
    while ((comma = strrchr(settings->model, ','))) {
        char *end;

        if (strncmp(comma, ",every=", 7) == 0) {
            settings->every = strtol(comma + 7, &end, 10);
            if (end == comma + 7 || *end || settings->every < 1 || settings->every > 1000000)
                return report_failure(EXIT_WRONG, "--depth",
                                      "'%.40s' is no number of frames; give every=1 or more",
                                      comma + 1);
        } else if (strncmp(comma, ",preset=", 8) == 0) {
            settings->preset = find_preset(comma + 8);
            if (settings->preset < 0)
                return report_failure(EXIT_WRONG, "--depth",
                                      "there is no preset '%.40s'; "
                                      "refocus depth --help-all lists those that there are",
                                      comma + 8);
        } else {
            break;
        }
        *comma = '\0';
    }
    if (!settings->model[0])
        return report_failure(EXIT_WRONG, "--depth", "give estimate:MODEL.onnx");
    return EXIT_DONE;
}

/* A network's values have no unit and drift from picture to picture: the range that
 * becomes 0 to 1 follows them slowly, so that nothing pumps. */
static const double tail = 0.01, follow = 0.1;

struct live_estimator {
    const struct opencv *cv;
    struct refocus_estimator *network;
    float *sorted;
    size_t capacity;
    bool range_known;
    double least, greatest;
};

int live_estimate_open(struct live *live)
{
    const struct live_estimate_settings *settings = &live->settings->estimate;
    struct refocus_network network = refocus_network_default();
    struct refocus_cv_reason reason = {""};
    char why[OPENCV_WHY];
    const struct opencv *cv = opencv_load(why);
    struct live_estimator *estimator = cv ? calloc(1, sizeof *estimator) : NULL;
    int status = REFOCUS_ERR_MEMORY;

    live->estimator = estimator;
    if (!cv)
        return report_failure(EXIT_FAILED, settings->model, "%s", why);
    if (estimator) {
        estimator->cv = cv;
        status = cv->network((uint32_t)settings->preset, &network);
    }
    if (status == REFOCUS_OK)
        status = cv->network_fit(&network, settings->model, &reason);
    if (status == REFOCUS_OK)
        status = cv->estimator_create(&estimator->network, settings->model, &network, &reason);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, settings->model, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    return EXIT_DONE;
}

void live_estimate_close(struct live *live)
{
    if (!live->estimator)
        return;
    live->estimator->cv->estimator_destroy(&live->estimator->network);
    free(live->estimator->sorted);
    free(live->estimator);
}

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;

    return (x > y) - (x < y);
}

/* The range lies between the tails of the values, and is smoothed from map to map. */
static int find_range(struct live_estimator *estimator, const struct refocus_estimate *estimate)
{
    const size_t all = (size_t)estimate->width * (size_t)estimate->height;
    const size_t step = all / 10000 + 1;
    size_t n = 0;
    double least, greatest;

    if (all > estimator->capacity) {
        free(estimator->sorted);
        estimator->sorted = malloc(all * sizeof *estimator->sorted);
        estimator->capacity = estimator->sorted ? all : 0;
    }
    if (!estimator->sorted)
        return REFOCUS_ERR_MEMORY;
    for (size_t i = 0; i < all; i += step)
        if (isfinite(estimate->samples[i]))
            estimator->sorted[n++] = estimate->samples[i];
    if (n == 0)
        return REFOCUS_ERR_NO_DEPTH;
    qsort(estimator->sorted, n, sizeof *estimator->sorted, compare);
    least = (double)estimator->sorted[(size_t)(tail * (double)(n - 1))];
    greatest = (double)estimator->sorted[(size_t)((1 - tail) * (double)(n - 1) + 0.5)];
    if (!estimator->range_known) {
        estimator->least = least;
        estimator->greatest = greatest;
    }
    estimator->range_known = true;
    estimator->least += follow * (least - estimator->least);
    estimator->greatest += follow * (greatest - estimator->greatest);
    return REFOCUS_OK;
}

static void to_disparity(const struct live_estimator *estimator,
                         const struct refocus_estimate *estimate, uint16_t *disparity)
{
    const size_t all = (size_t)estimate->width * (size_t)estimate->height;
    const double range = estimator->greatest - estimator->least;

    for (size_t i = 0; i < all; i++) {
        const double value = (double)estimate->samples[i];
        const double d = range > 0 ? (value - estimator->least) / range : 0.5;

        disparity[i] = (uint16_t)(d > 0 ? d < 1 ? d * 65535 + 0.5 : 65535 : 0); /* NaN: 0 */
    }
}

static int estimate_one(struct live *live, const struct live_picture *picture,
                        struct refocus_cv_reason *reason)
{
    const int64_t begin = live_now_ns();
    struct refocus_estimate estimate = refocus_estimate_default();
    struct live_depth_map *to = NULL;
    int status = live->estimator->cv->estimator_run(live->estimator->network, &picture->image,
                                                    &estimate, reason);
    double ms;

    if (status == REFOCUS_OK)
        status = find_range(live->estimator, &estimate);
    ms = (double)(live_now_ns() - begin) / 1e6;
    if (status == REFOCUS_OK) {
        to = live_depths_fill(&live->depths, estimate.width, estimate.height);
        status = to || live_is_over(live) ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    }
    if (to) {
        to_disparity(live->estimator, &estimate, to->disparity);
        to->range = (struct live_range){0, 0};
        live_times_add(&live->depth.times, ms);
        live->depth.frames++;
        live_depths_put(&live->depths, to, picture->key, false);
    }
    live->estimator->cv->estimate_free(&estimate);
    return status;
}

void *live_estimate_thread(void *argument)
{
    struct live *live = argument;
    bool ended = false;
    int status = REFOCUS_OK;

    while (!ended && status == REFOCUS_OK && !live_is_over(live)) {
        struct live_picture *picture = live_queue_take(&live->to_estimate, &ended);
        struct refocus_cv_reason reason = {""};

        if (!picture)
            continue;
        status = estimate_one(live, picture, &reason);
        live_queue_return(&live->to_estimate, picture);
        if (status != REFOCUS_OK)
            live_fail(live, EXIT_FAILED, live->settings->estimate.model,
                      reason.text[0] ? reason.text : refocus_strerror(status));
    }
    live_depths_end(&live->depths, false);
    return NULL;
}

/* The picture itself, or what the frame that it was copied from comes to in R, G and B: by way of
 * the copy, as camera memory is slow to read. */
static int copy_rgb(const struct live_picture *picture, const struct refocus_frame *frame,
                    struct refocus_converter *converter, struct refocus_image *out,
                    struct refocus_reason *reason)
{
    const struct refocus_image *from = &picture->image;
    struct refocus_frame own = refocus_frame_copy(frame);

    if (from->format == REFOCUS_FORMAT_RGB8) {
        memcpy(out->plane[0], from->plane[0], (size_t)from->stride[0] * (size_t)from->height);
        return REFOCUS_OK;
    }
    /* The copy of a JPEG picture is decoded already, and that of UYVY has another order. */
    if (own.format == REFOCUS_FRAME_MJPEG) {
        own.flags |= REFOCUS_FRAME_FULL_RANGE;
        own.matrix = from->matrix;
    }
    for (own.format = REFOCUS_FRAME_YUYV; own.format < REFOCUS_FRAME_FORMAT_COUNT; own.format++)
        if (refocus_frame_image_format(own.format) == from->format)
            break;
    for (int i = 0; i < refocus_format_planes(from->format); i++) {
        own.plane[i] = from->plane[i];
        own.stride[i] = from->stride[i];
    }
    return refocus_convert_rgb8(converter, &own, out, reason);
}

int live_estimate_offer(struct live *live, struct live_picture *picture,
                        const struct refocus_frame *frame, struct refocus_converter *converter,
                        struct refocus_reason *reason)
{
    const struct refocus_image *from = &picture->image;
    int status = REFOCUS_OK;
    bool memory;

    if (live->offered++ % live->settings->estimate.every == 0) {
        struct live_picture *copy = live_queue_fill(&live->to_estimate, REFOCUS_FORMAT_RGB8,
                                                    from->width, from->height, &memory);

        if (copy && memory)
            status = copy_rgb(picture, frame, converter, &copy->image, reason);
        if (copy && memory && status == REFOCUS_OK) {
            copy->key = ++live->key;
            live_queue_put(&live->to_estimate, copy);
        } else if (copy) {
            live_queue_return(&live->to_estimate, copy);
        }
    }
    picture->key = live->key;
    return status;
}
