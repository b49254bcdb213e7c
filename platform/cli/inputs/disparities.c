/* disparities.c: the samples of a depth map become the disparities that are rendered: repaired,
 * turned, enlarged to the photo's size, their edges placed. */
#include "inputs/disparities.h"
#include <stdlib.h>
#include <string.h>
#include "line/report.h"

int input_check_range(const struct input *input, const struct refocus_depth_map *map)
{
    if (map->near_m > 0 && map->far_m > 0 && map->near_m >= map->far_m)
        return report_failure(EXIT_WRONG, input->depth_name,
                              "near %g m is not nearer than far %g m; give --near and --far",
                              map->near_m, map->far_m);
    return EXIT_DONE;
}

/* Follow the photo's edges to its size, with filled samples counting least. */
static int enlarge(struct input *input, const struct depth_settings *settings)
{
    const struct refocus_image *photo = input->photo->image;
    const struct refocus_disparity map = refocus_disparity16(
        input->disparity, input->width, input->height, (ptrdiff_t)input->width * 2);
    struct refocus_upsample_params params = refocus_upsample_params_default();
    const uint64_t bytes = (uint64_t)photo->width * (uint64_t)photo->height * 2;
    uint16_t *full = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    struct refocus_reason reason = {""};
    int status = REFOCUS_ERR_MEMORY;

    params.confidence = input->confidence;
    params.confidence_stride = input->width;
    if (full && settings->upsample > 0)
        status = upsample_by_filter(settings->upsample, photo, &map, full, &reason);
    else if (full)
        status = refocus_upsample(photo, &map, &params, full, (ptrdiff_t)photo->width * 2);
    if (status != REFOCUS_OK) {
        free(full);
        if (reason.text[0])
            return report_failure(EXIT_FAILED, "--upsample", "%s", reason.text);
        return report_failure(EXIT_FAILED, input->depth_name, "the depth map: %s",
                              refocus_strerror(status));
    }
    free(input->disparity);
    input->disparity = full;
    input->width = photo->width;
    input->height = photo->height;
    return EXIT_DONE;
}

bool input_has_edges_placed(const struct input *input, const struct depth_settings *settings)
{
    return settings->edges == EDGES_AUTO && input->photo && input->photo->image->plane[0];
}

static bool has_other_size(const struct input *input)
{
    return input->photo && input->photo->image->plane[0] &&
           (input->photo->image->width != input->width ||
            input->photo->image->height != input->height);
}

static bool has_guesses(const struct input *input)
{
    return input->report.unknown + input->report.specks + input->report.strays > 0 ||
           (input->depth_from && input->depth_from->confidence);
}

static bool worth_enlarging(const struct input *input, const struct depth_settings *settings)
{
    return has_other_size(input) &&
           (settings->upsample > 0 ||
            (settings->full && (!input_has_edges_placed(input, settings) || has_guesses(input))));
}

/* Put the edges of the disparities on the photo's. */
static int place(struct input *input)
{
    const struct refocus_disparity map = refocus_disparity16(
        input->disparity, input->width, input->height, (ptrdiff_t)input->width * 2);
    uint16_t *placed = NULL;
    const int status =
        edges_place(input->photo->image, &map, &placed, &input->edges, input->depth_name);

    if (status != EXIT_DONE)
        return status;
    free(input->disparity);
    input->disparity = placed;
    input->width = input->photo->image->width;
    input->height = input->photo->image->height;
    return EXIT_DONE;
}

/* Edges are looked for in the enlarged map: here where disparities of the photo's size or a filter
 * of OpenCV are asked for, else by the renderer. */
static int fit(struct input *input, const struct depth_settings *settings)
{
    const int status = worth_enlarging(input, settings) ? enlarge(input, settings) : EXIT_DONE;

    return status == EXIT_DONE && settings->full && input_has_edges_placed(input, settings)
               ? place(input)
               : status;
}

int input_placed(const struct input *input, const struct depth_settings *settings,
                 uint16_t **placed)
{
    const size_t bytes = (size_t)input->width * (size_t)input->height * sizeof *input->disparity;
    struct depth_settings full = *settings;
    struct input copy = *input;
    int status;

    full.full = true;
    *placed = NULL;
    copy.disparity = malloc(bytes);
    if (!copy.disparity)
        return report_failure(EXIT_FAILED, input->photo_name, "not enough memory");
    memcpy(copy.disparity, input->disparity, bytes);
    status = fit(&copy, &full);
    if (status == EXIT_DONE)
        *placed = copy.disparity;
    else
        free(copy.disparity);
    return status;
}

/* The pixels in the middle of each of so many parts of a photo, packed, to be freed; or NULL. */
static void *sample_photo(const struct refocus_image *photo, int columns, int rows)
{
    const int bytes = refocus_format_bytes(photo->format);
    const uint64_t size = (uint64_t)columns * (uint64_t)rows * (uint64_t)bytes;
    uint8_t *const samples = size <= SIZE_MAX ? malloc((size_t)size) : NULL, *to = samples;

    for (int y = 0; y < rows && samples; y++) {
        const int64_t row = (2 * (int64_t)y + 1) * photo->height / (2 * (int64_t)rows);
        const uint8_t *const from = photo->plane[0] + row * photo->stride[0];

        for (int x = 0; x < columns; x++, to += bytes)
            memcpy(to, from + (2 * (int64_t)x + 1) * photo->width / (2 * (int64_t)columns) * bytes,
                   (size_t)bytes);
    }
    return samples;
}

int input_repair(const struct input *input, const struct refocus_depth_map *map,
                 struct refocus_repair_params *params, uint16_t *disparity,
                 struct refocus_depth_report *report)
{
    const struct refocus_image *photo = input->photo ? input->photo->image : NULL;
    const int bytes = photo && photo->plane[0] ? refocus_format_bytes(photo->format) : 0;
    const bool on_its_side = input->orientation >= 5;
    const int columns = on_its_side ? map->height : map->width;
    const int rows = on_its_side ? map->width : map->height;
    struct refocus_image turned;
    void *samples = NULL;
    int status = REFOCUS_ERR_MEMORY;

    params->photo = bytes == 3 || bytes == 4 ? photo : NULL;
    if (params->photo && input->orientation > 1) {
        samples = sample_photo(photo, columns, rows);
        if (!samples ||
            !orient_turn(&samples, (size_t)bytes, columns, rows, orient_back(input->orientation)))
            goto end;
        turned = refocus_image_packed(photo->format, samples, map->width, map->height,
                                      (ptrdiff_t)map->width * bytes);
        params->photo = &turned;
    }
    status = refocus_depth_repair(map, params, disparity, (ptrdiff_t)map->width * 2, report);
end:
    free(samples);
    return status;
}

/* A sample is no surer than the file says; those that were filled stay guesses. */
static void weigh(struct input *input)
{
    const uint8_t *const said = input->depth_from->confidence;
    const size_t samples = (size_t)input->width * (size_t)input->height;

    for (size_t i = 0; said && i < samples; i++)
        if (said[i] < input->confidence[i])
            input->confidence[i] = said[i];
}

/* Turn the disparities and their confidence by input->orientation. */
static bool turn(struct input *input)
{
    const int width = input->width, height = input->height;
    void *disparity = input->disparity, *confidence = input->confidence;
    bool turned;

    if (input->orientation <= 1)
        return true;
    turned = orient_turn(&disparity, sizeof *input->disparity, width, height, input->orientation);
    input->disparity = disparity;
    turned = turned && orient_turn(&confidence, 1, width, height, input->orientation);
    input->confidence = confidence;
    if (turned && input->orientation >= 5) {
        input->width = height;
        input->height = width;
    }
    return turned;
}

static void tell_strays(const struct input *input)
{
    const struct refocus_depth_report *report = &input->report;

    if (report->strays > 0)
        report_warning(input->depth_name,
                       "samples that are far nearer than all others (%llu, the rest %.3g m and "
                       "farther) are taken for mistakes and filled; --near keeps them",
                       (unsigned long long)report->strays, report->near_m);
}

int input_convert(struct input *input, const struct depth_settings *settings)
{
    struct refocus_depth_map settled = *input->depth_from->depth, *map = &settled;
    struct refocus_repair_params params = refocus_repair_params_default();
    const uint64_t bytes = (uint64_t)map->width * (uint64_t)map->height * sizeof(uint16_t);
    int status = REFOCUS_ERR_MEMORY;

    refocus_depth_set_invalid(map, settings->invalid);
    if (input_check_range(input, map) != EXIT_DONE)
        return EXIT_WRONG;
    if (bytes <= SIZE_MAX) {
        input->disparity = malloc((size_t)bytes);
        input->confidence = malloc((size_t)bytes / 2);
    }
    input->width = map->width;
    input->height = map->height;
    params.speckle = (int32_t)settings->speckle;
    input->report = refocus_depth_report_default();
    params.confidence = input->confidence;
    params.confidence_stride = map->width;
    if (input->disparity && input->confidence)
        status = input_repair(input, map, &params, input->disparity, &input->report);
    if (status == REFOCUS_ERR_NO_DEPTH)
        return report_failure(EXIT_FAILED, input->depth_name,
                              "no sample of the depth map holds a value; give another "
                              "--depth or --depth-unit");
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, input->depth_name, "the depth map: %s",
                              refocus_strerror(status));
    tell_strays(input);
    weigh(input);
    if (!turn(input))
        return report_failure(EXIT_FAILED, input->depth_name, "not enough memory to turn the map");
    return fit(input, settings);
}

const uint8_t *input_confidence(const struct input *input)
{
    return has_other_size(input) && has_guesses(input) ? input->confidence : NULL;
}
