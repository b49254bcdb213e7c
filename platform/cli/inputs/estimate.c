/* estimate.c: depth is estimated of pictures: of a stereo pair, or of one photo by a network. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "inputs/estimate.h"
#include "inputs/opencv.h"
#include "line/report.h"

/* Read the other picture of a pair: a file of its own, or the second one in the left file. */
static int read_right(struct refocus_photo **photo, const char *name, bool second)
{
    struct refocus_reason reason = {""};
    const int status = second ? refocus_photo_read_second(photo, name, limits_taken(), &reason)
                              : refocus_photo_read(photo, name, limits_taken(), &reason);

    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, name, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    if (!(*photo)->image->plane[0])
        return report_failure(EXIT_FAILED, name, "it is a depth map, not a photo; give a photo");
    return EXIT_DONE;
}

/* Take floats that grow towards the camera as the depth of the photo, and the way they were made.
 */
static void take(struct input *input, const char *way, float *samples, int width, int height,
                 const struct depth_settings *settings)
{
    struct refocus_depth_map *map = &input->made_map;

    *map = refocus_depth_map_default();
    input->made.depth = map;
    input->made.info = &input->made_info;
    snprintf(input->made_info.container, sizeof input->made_info.container, "%s", way);
    input->made_samples = samples;
    map->samples = samples;
    map->width = width;
    map->height = height;
    map->stride = (ptrdiff_t)width * (ptrdiff_t)sizeof *samples;
    map->sample = REFOCUS_SAMPLE_F32;
    if (!isnan(settings->near_m))
        map->near_m = settings->near_m;
    if (!isnan(settings->far_m))
        map->far_m = settings->far_m;
    input->depth_from = &input->made;
}

/* Take the halves of a picture that holds two side by side. */
static void halve(struct refocus_image *left, struct refocus_image *right)
{
    left->width /= 2;
    *right = *left;
    right->plane[0] += 3 * (ptrdiff_t)left->width;
}

static int load(const struct opencv **cv, const char *what)
{
    char why[OPENCV_WHY];

    *cv = opencv_load(why);
    return *cv ? EXIT_DONE : report_failure(EXIT_FAILED, what, "%s", why);
}

const struct option_word stereo_order_words[] = {
    {"auto", "what only one picture shows tells, else it is the left one"},
    {"left-first", "the left one"},
    {"right-first", "the right one, as where eyes are crossed to see depth"},
    {0}};

/* enum refocus_stereo_order of these words. */
static const uint32_t orders[] = {REFOCUS_STEREO_ORDER_SEEN, REFOCUS_STEREO_LEFT_FIRST,
                                  REFOCUS_STEREO_RIGHT_FIRST};

static const char *order_evidence(const struct refocus_stereo_params *params,
                                  const struct refocus_stereo_report *report)
{
    if (params->order != REFOCUS_STEREO_ORDER_SEEN)
        return "the order of the pictures is as it was given";
    return report->order >= REFOCUS_STEREO_ORDER_SURE
               ? "what only one picture shows tells that the left one comes first"
           : report->order <= -REFOCUS_STEREO_ORDER_SURE
               ? "what only one picture shows tells that the right one comes first"
               : "nothing tells which picture is the left one; the first is taken for it";
}

/* Pairs that came out right agree in 49 to 95 %, those that did not in 30 and 35 %. */
static const double LEAST_SURE = 0.45;

static void tell_doubt(const char *name, const struct refocus_stereo_report *report)
{
    if ((double)report->matched < LEAST_SURE)
        report_warning(
            name,
            "depth is doubtful, as only %.0f %% of the pixels of the two pictures agree; "
            "look at it with 'refocus depth', and give a rectified pair of one moment",
            100.0 * (double)report->matched);
}

static int match(struct input *input, const char *right, const struct stereo_settings *how,
                 const struct depth_settings *settings)
{
    struct refocus_stereo_params params = refocus_stereo_params_default();
    struct refocus_stereo_report report = refocus_stereo_report_default();
    struct refocus_cv_reason reason = {""};
    const char *const left = input->photo_name;
    struct refocus_image other;
    const struct opencv *cv;
    float *samples = NULL;
    int status = load(&cv, right ? right : left);

    params.method = (uint32_t)how->method;
    params.order = orders[how->order];
    if (status == EXIT_DONE && (right || how->within))
        status = read_right(&input->side, right ? right : left, right == NULL);
    if (status != EXIT_DONE)
        return status;
    if (!input->side && input->photo->image->width < 2)
        return report_failure(EXIT_FAILED, left,
                              "it is one pixel wide; give two pictures side by side");
    if (input->side)
        other = *input->side->image;
    else
        halve(input->photo->image, &other);
    samples = malloc((size_t)input->photo->image->width * (size_t)input->photo->image->height *
                     sizeof *samples);
    if (!samples)
        return report_failure(EXIT_FAILED, left, "not enough memory");
    report_progress("matching", 0.2);
    status = cv->stereo(input->photo->image, &other, &params, samples, &report, &reason);
    if (status != REFOCUS_OK) {
        free(samples);
        return report_failure(EXIT_FAILED, right ? right : left, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    }
    tell_doubt(right ? right : left, &report);
    snprintf(input->made_info.evidence[0], REFOCUS_INFO_LENGTH,
             "stereo: disparities %.1f to %.1f pixels, %.0f %% of the pixels agree from both sides",
             (double)report.least, (double)report.greatest, 100.0 * (double)report.matched);
    snprintf(input->made_info.evidence[1], REFOCUS_INFO_LENGTH,
             "stereo: the second picture is %.1f pixels lower, turned by %.2f degrees and %.2f %% "
             "larger, which is undone",
             (double)report.vertical_offset, (double)report.turn * 180 / acos(-1),
             100.0 * (double)report.grow);
    snprintf(input->made_info.evidence[2], REFOCUS_INFO_LENGTH, "stereo: %s",
             order_evidence(&params, &report));
    input->made_info.evidence_count = 3;
    take(input, "stereo", samples, input->photo->image->width, input->photo->image->height,
         settings);
    return EXIT_DONE;
}

int input_read_stereo(struct input *input, const char *left, const char *right,
                      const struct stereo_settings *how, const struct depth_settings *settings)
{
    int status = input_read_left(input, left, how->within);

    if (status == EXIT_DONE)
        status = match(input, right, how, settings);
    return status == EXIT_DONE ? input_convert(input, settings) : status;
}

static void adjust(struct refocus_network *network, const struct network_settings *how)
{
    if (!isnan(how->size[0])) {
        network->width = (int32_t)how->size[0];
        network->height = (int32_t)how->size[1];
    }
    if (!isnan(how->mean[0]))
        for (int i = 0; i < 3; i++)
            network->mean[i] = (float)how->mean[i];
    if (!isnan(how->scale))
        network->scale = (float)how->scale;
    if (how->inverse)
        network->inverse = !network->inverse;
}

static int estimate_depth(struct input *input, const char *model,
                          const struct network_settings *how, const struct depth_settings *settings)
{
    struct refocus_estimate estimate = refocus_estimate_default();
    struct refocus_network network = refocus_network_default();
    struct refocus_cv_reason reason = {""};
    const struct opencv *cv;
    int status = load(&cv, model);

    if (status != EXIT_DONE)
        return status;
    cv->network((uint32_t)how->preset, &network);
    status = cv->network_fit(&network, model, &reason);
    adjust(&network, how);
    report_progress("estimating", 0.2);
    if (status == REFOCUS_OK)
        status = cv->estimate(input->photo->image, model, &network, &estimate, &reason);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, model, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    take(input, "network", estimate.samples, estimate.width, estimate.height, settings);
    return EXIT_DONE;
}

/* Stretches rows, or columns, of w x h samples to n of each. */
static void stretch(const float *in, int w, int h, bool down, int n, float *out)
{
    const int most = (down ? h : w) - 1, lines = down ? w : h;
    const ptrdiff_t step = down ? w : 1, line = down ? 1 : w, line_out = down ? 1 : n;

    for (int i = 0; i < n; i++) {
        const double at = ((double)i + 0.5) * (most + 1) / n - 0.5;
        const double within = at < 0 ? 0 : at > most ? most : at;
        const int first = (int)within, second = first < most ? first + 1 : most;
        const float share = (float)(within - first);

        for (int k = 0; k < lines; k++) {
            const float a = in[k * line + first * step], b = in[k * line + second * step];

            out[k * line_out + i * step] = a + share * (b - a);
        }
    }
}

/* A network has a picture of its own shape, whatever that of the photo. A map that is written gets
 * the photo's, or who reads it would take it for another picture's, or one on its side. */
static int reshape(struct input *input)
{
    const struct refocus_image *photo = input->photo->image;
    const int width = input->made_map.width, height = input->made_map.height;
    const int64_t down = ((int64_t)width * photo->height + photo->width / 2) / photo->width;
    const int64_t across = ((int64_t)height * photo->width + photo->height / 2) / photo->height;
    const bool is_down = down > height;
    const int64_t n = is_down ? down : across;
    const uint64_t bytes = (uint64_t)n * (uint64_t)(is_down ? width : height) * sizeof(float);
    float *samples = NULL;

    if (n <= (is_down ? height : width) || n > REFOCUS_MAX_SIDE)
        return EXIT_DONE;
    if (bytes <= SIZE_MAX)
        samples = malloc((size_t)bytes);
    if (!samples)
        return report_failure(EXIT_FAILED, input->depth_name, "not enough memory");
    stretch(input->made_samples, width, height, is_down, (int)n, samples);
    free(input->made_samples);
    input->made_samples = samples;
    input->made_map.samples = samples;
    *(is_down ? &input->made_map.height : &input->made_map.width) = (int32_t)n;
    input->made_map.stride = (ptrdiff_t)input->made_map.width * (ptrdiff_t)sizeof *samples;
    return EXIT_DONE;
}

int input_read_estimate(struct input *input, const char *photo, const char *model,
                        const struct network_settings *how, const struct depth_settings *settings)
{
    int status = input_read_photo(input, photo, "a photo");

    if (status == EXIT_DONE)
        status = estimate_depth(input, model, how, settings);
    if (status == EXIT_DONE && !settings->full)
        status = reshape(input);
    return status == EXIT_DONE ? input_convert(input, settings) : status;
}

int input_estimate_depth(struct input *input, const struct depth_settings *settings)
{
    input->depth_name = settings->model ? settings->model : input->photo_name;
    return settings->model ? estimate_depth(input, settings->model, &settings->network, settings)
                           : match(input, settings->right, &settings->stereo, settings);
}

const struct option_word stereo_match_words[] = {
    {"checked", "both ways; what disagrees is filled"},
    {"plain", "OpenCV's semi-global matching as it is"},
    {"wls", "filled by weighted least squares; needs the module refocus-ximgproc"},
    {0}};
