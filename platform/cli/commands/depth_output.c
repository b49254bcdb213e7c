/* depth_output.c: what the command `refocus depth` writes, and its report. */
#include "commands/depth_output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "line/interrupt.h"
#include "line/report.h"
#include "outputs/outputs.h"

static double percent(uint64_t part, const struct refocus_depth_map *map)
{
    return 100.0 * (double)part / ((double)map->width * map->height);
}

/* The way the depth was made, as the lines of text say it. */
static json_t *with_evidence(json_t *json, const struct refocus_photo_info *info)
{
    json_t *lines = info->evidence_count ? json_array() : NULL;

    for (int i = 0; lines && i < info->evidence_count; i++)
        json_array_append_new(lines, report_text_json(info->evidence[i]));
    if (lines && json_object_set_new(json, "evidence", lines)) {
        json_decref(json);
        return NULL;
    }
    return json;
}

/* The findings of a focus stack, in the words of struct refocus_stack_result; null: it is none.
 */
static json_t *stack_json(const struct refocus_stack_result *stack)
{
    json_t *order;

    if (stack->struct_size == 0)
        return json_null();
    order = json_array();
    for (int i = 0; order && i < REFOCUS_STACK_MOST_FRAMES && stack->order[i]; i++)
        json_array_append_new(order, json_integer(stack->order[i]));
    return json_pack(
        "{s:i, s:o, s:f, s:f, s:b, s:f, s:f, s:f, s:f, s:f, s:f, s:i, s:f}", "reference",
        (int)stack->reference, "order", order, "order_margin", (double)stack->order_margin,
        "direction", (double)stack->direction, "by_rows", stack->by_rows != 0, "measured",
        (double)stack->measured, "moved", (double)stack->moved, "moving", (double)stack->moving,
        "alike", (double)stack->alike, "disorder", (double)stack->disorder, "blur",
        (double)stack->blur, "matched", (int)stack->matched, "exposure", (double)stack->exposure);
}

int depth_output_report(const struct depth_command_settings *settings, const struct input *input)
{
    const struct refocus_depth_map *map = input->depth_from->depth;
    const struct refocus_depth_report *report = &input->report;

    if (settings->json) {
        json_t *json = json_pack(
            "{s:o, s:o, s:i, s:i, s:o, s:o, s:o}", "file", report_text_json(input->photo_name),
            "output", report_text_json(settings->output), "width", input->width, "height",
            input->height, "depth", report_depth_json(input->depth_from, report), "edges",
            edges_json(&input->edges), "stack", stack_json(&input->stack));
        return report_print_json(with_evidence(json, &input->made_info));
    }
    printf("size     %dx%d\n", input->width, input->height);
    if (report->near_m > 0)
        printf("near     %.4g m\n", report->near_m);
    if (report->far_m > 0)
        printf("far      %.4g m\n", report->far_m);
    printf("filled   %llu samples without a value, %.1f %%\n", (unsigned long long)report->unknown,
           percent(report->unknown, map));
    if (settings->depth.speckle > 1)
        printf("specks   %llu samples in small patches, filled too, %.1f %%\n",
               (unsigned long long)report->specks, percent(report->specks, map));
    if (report->strays > 0)
        printf("strays   %llu samples far nearer than all others, filled too\n",
               (unsigned long long)report->strays);
    for (int i = 0; i < input->made_info.evidence_count; i++)
        printf("because  %s\n", input->made_info.evidence[i]);
    printf("clamped  %llu samples beyond the range, %.1f %%\n", (unsigned long long)report->clamped,
           percent(report->clamped, map));
    return report_end_output();
}

/* A grey picture of the disparities or of what is known of them. */
static int write_view(const struct depth_command_settings *settings, const struct input *input)
{
    const bool known = settings->view == VIEW_CONFIDENCE;
    const int width = known ? input->depth_from->depth->width : input->width;
    const int height = known ? input->depth_from->depth->height : input->height;
    const size_t pixels = (size_t)width * (size_t)height;
    uint8_t *rgb = pixels <= SIZE_MAX / 3 ? malloc(3 * pixels) : NULL;
    int status;

    if (!rgb)
        return report_failure(EXIT_FAILED, settings->output, "not enough memory");
    for (size_t i = 0; i < 3 * pixels; i++)
        rgb[i] = known ? input->confidence[i / 3] : (uint8_t)(input->disparity[i / 3] >> 8);

    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, width, height, 3 * (ptrdiff_t)width);
    status = output_write_image(settings->output, &image, NULL);
    free(rgb);
    return status;
}

/* Disparity at a point, 0..1 of the upright photo. */
static double disparity_at(const struct input *input, double x, double y)
{
    const int column = (int)fmin(x * input->width, input->width - 1);
    const int row = (int)fmin(y * input->height, input->height - 1);

    return input->disparity[(size_t)row * (size_t)input->width + (size_t)column] / 65535.0;
}

/* The focus to be saved: that of the options, else that of the photo. */
static int settle_focus(const struct depth_command_settings *settings, const struct input *input,
                        struct refocus_depth_write *depth)
{
    const struct refocus_image *photo = input->photo->image;
    const struct refocus_photo_info *info = input->photo->info;
    const double larger = photo->width > photo->height ? photo->width : photo->height;
    const double x = settings->focus_at[0], y = settings->focus_at[1];
    double d;

    if (isnan(x)) {
        if (info->focus_x > 0 || info->focus_y > 0) {
            depth->focus_x = info->focus_x;
            depth->focus_y = info->focus_y;
        }
        depth->focus_distance = info->focus_distance;
        depth->blur_at_infinity = info->blur_at_infinity;
        if (info->own_blur > 0 && info->focus_x >= 0 && input->photo->depth->near_m <= 0) {
            /* No metres: they are not written, and 0 is taken for infinity then. */
            depth->focus_distance = 0;
            depth->blur_at_infinity =
                info->own_blur * disparity_at(input, info->focus_x, info->focus_y);
        }
        return EXIT_DONE;
    }
    if (x >= photo->width || y >= photo->height)
        return report_failure(EXIT_WRONG, "--focus-at",
                              "%g,%g lies outside of %s; give 0,0 to %d,%d", x, y,
                              input->photo_name, photo->width - 1, photo->height - 1);
    depth->focus_x = (x + 0.5) / photo->width;
    depth->focus_y = (y + 0.5) / photo->height;
    d = disparity_at(input, depth->focus_x, depth->focus_y);
    if (depth->near_m > 0 && depth->far_m > depth->near_m) {
        const struct refocus_depth_range range = {depth->near_m, depth->far_m};
        const double z = refocus_depth_of_disparity(&range, d);

        depth->focus_distance = isfinite(z) ? z : 0;
    }
    if (!isnan(settings->blur))
        depth->blur_at_infinity = settings->blur * d / larger;
    return EXIT_DONE;
}

static int write_photo(const struct depth_command_settings *settings, const struct input *input)
{
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_reason reason = {""};
    char *temporary = NULL;
    int status;

    depth.disparity = input->disparity;
    depth.width = input->width;
    depth.height = input->height;
    depth.stride = 2 * (ptrdiff_t)input->width;
    depth.near_m = input->report.near_m;
    depth.far_m = input->report.far_m;
    status = settle_focus(settings, input, &depth);
    if (status == EXIT_DONE && settings->stack.on) {
        depth.confidence = input->confidence;
        depth.confidence_stride = input->width;
    }
    report_cut(settings->output);
    if (status == EXIT_DONE && settings->stack.on)
        status = stacked_write_temporary(input, settings->output, &temporary);
    if (status == EXIT_DONE)
        status = interrupt_came()
                     ? REFOCUS_ERR_CANCELLED
                     : refocus_photo_write_depth(settings->output,
                                                 temporary ? temporary : input->photo_name, &depth,
                                                 &reason);
    if (temporary) {
        remove(temporary);
        interrupt_clean_up(NULL, NULL);
    }
    free(temporary);
    report_cut(NULL);
    if (status > 0) /* an exit code: the failure has been reported */
        return status;
    if (status == REFOCUS_ERR_CANCELLED)
        return report_failure(EXIT_FAILED, settings->output, REPORT_INTERRUPTED);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, settings->output, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    return EXIT_DONE;
}

int depth_output_write(const struct depth_command_settings *settings, const struct input *input)
{
    if (settings->view != VIEW_NONE)
        return write_view(settings, input);
    if (output_is_jpeg(settings->output))
        return write_photo(settings, input);
    return output_write_gray16(settings->output, input->disparity, input->width, input->height);
}
