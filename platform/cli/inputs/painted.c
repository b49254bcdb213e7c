/* painted.c: depth is painted by a file of strokes over a photo. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/platform/strokes.h>
#include "inputs/painted.h"
#include "line/report.h"

/* The most bytes that refocus_strokes_load() takes. */
enum { MAX_BYTES = 64 << 20 };

void painted_begin(struct input *input, const struct depth_settings *settings)
{
    struct refocus_depth_map *const map = &input->made_map;

    *map = refocus_depth_map_default();
    input->made.depth = map;
    input->made.info = &input->made_info;
    snprintf(input->made_info.container, sizeof input->made_info.container, "strokes");
    map->width = input->width = input->photo->image->width;
    map->height = input->height = input->photo->image->height;
    input->report.value_near = map->value_near = 1;
    input->report.near_m = isnan(settings->near_m) ? 0 : settings->near_m;
    input->report.far_m = isnan(settings->far_m) ? 0 : settings->far_m;
    input->depth_from = &input->made;
}

int painted_read(struct input *input, const char *photo, const struct depth_settings *settings)
{
    const int status = input_read_photo(input, photo, "a photo");

    if (status == EXIT_DONE)
        painted_begin(input, settings);
    return status;
}

/* The painting's disparities become the input's; all of them are known. */
static int take(struct input *input, const struct refocus_strokes *strokes)
{
    const size_t pixels = (size_t)input->width * (size_t)input->height;

    if (!input->disparity)
        input->disparity = malloc(pixels * sizeof *input->disparity);
    if (!input->confidence) {
        input->confidence = malloc(pixels);
        if (input->confidence)
            memset(input->confidence, 255, pixels);
    }
    if (!input->disparity || !input->confidence)
        return REFOCUS_ERR_MEMORY;
    memcpy(input->disparity, refocus_strokes_disparity(strokes), pixels * sizeof *input->disparity);
    return REFOCUS_OK;
}

/* To be destroyed before the input, also after an error. */
static int open_strokes(struct input *input, const char *file, struct refocus_strokes **strokes)
{
    const struct refocus_disparity base = refocus_disparity16(
        input->disparity, input->width, input->height, 2 * (ptrdiff_t)input->width);
    struct refocus_strokes_reason reason = {""};
    struct refocus_reason unread = {""};
    struct refocus_blob blob = {NULL, 0};
    int status = refocus_file_read(file, MAX_BYTES, &blob, &unread);

    *strokes = NULL;
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, file, "%s", unread.text);
    status = refocus_strokes_create(strokes, input->photo->image, input->disparity ? &base : NULL);
    if (status == REFOCUS_OK)
        status = refocus_strokes_load(*strokes, blob.data, blob.size, &reason);
    free(blob.data);
    if (status == REFOCUS_OK)
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, file, "%s",
                          reason.text[0] ? reason.text : refocus_strerror(status));
}

int painted_apply(struct input *input, const char *file)
{
    struct refocus_photo_info *const info = &input->made_info;
    struct refocus_strokes *strokes = NULL;
    int status = open_strokes(input, file, &strokes);

    if (status == EXIT_DONE && take(input, strokes) != REFOCUS_OK)
        status = report_failure(EXIT_FAILED, file, "%s", refocus_strerror(REFOCUS_ERR_MEMORY));
    if (status == EXIT_DONE && info->evidence_count < REFOCUS_INFO_LINES)
        snprintf(info->evidence[info->evidence_count++], REFOCUS_INFO_LENGTH, "painted: %d strokes",
                 refocus_strokes_count(strokes));
    refocus_strokes_destroy(&strokes);
    return status;
}

int painted_over(struct input *input, const struct depth_settings *settings)
{
    if (!settings->strokes)
        return EXIT_DONE;
    if (!input->disparity)
        painted_begin(input, settings);
    return painted_apply(input, settings->strokes);
}
