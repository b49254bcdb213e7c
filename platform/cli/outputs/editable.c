/* editable.c: a result holds its all-in-focus original and depth where it is a JPEG or HEIC, made
 * of one of the two if nothing is asked for. */
#include <string.h>
#include "outputs/editable.h"
#include "outputs/outputs.h"
#include "line/report.h"

const struct option keeping_options[] = {
    {OPTION(OPTION_FLAG, "--editable", NULL, struct keep_settings, editable), .elsewhere = true,
     .help = "keep the all-in-focus original and its depth in the result, which every command then "
             "starts from; the default for a JPEG or HEIC made of one of them"},
    {OPTION(OPTION_FLAG, "--no-editable", NULL, struct keep_settings, no_editable),
     .elsewhere = true, .help = "keep neither: the file is smaller"},
    {OPTION(OPTION_FLAG, "--strip", NULL, struct keep_settings, strip), .elsewhere = true,
     .help = "keep nothing of the photo's file but its colour profile"},
    {.help = NULL},
};

/* Whether the format holds original and depth. */
static bool is_holder(const char *name)
{
    return output_is_jpeg(name) || output_ends_in(name, ".heic");
}

int keep_check(const struct keep_settings *settings, const char *output, bool whole)
{
    if (!settings->editable)
        return EXIT_DONE;
    if (settings->no_editable || settings->strip)
        return report_failure(EXIT_WRONG, "--editable", "it does not go with %s; leave one out",
                              settings->strip ? "--strip" : "--no-editable");
    if (!whole)
        return report_failure(
            EXIT_WRONG, "--editable",
            "it is for the whole photo, refocused; leave --region and --view out");
    if (!is_holder(output))
        return report_failure(EXIT_WRONG, "--editable",
                              "it is for JPEG and HEIC; end the name of the output in .jpg or "
                              ".heic");
    return EXIT_DONE;
}

bool keep_has_light(const struct keep_settings *settings, const char *output)
{
    return output_is_jpeg(output) && !settings->strip;
}

/* Whether the depth is that of the photo's own GDepth as it is. */
static bool has_own_depth(const struct input *input, const struct depth_settings *depth)
{
    return input->depth_from == input->photo &&
           input->photo->info->depth_source == REFOCUS_DEPTH_SOURCE_GDEPTH && !depth->unit &&
           isnan(depth->near_m) && isnan(depth->far_m) && !depth->invalid && depth->speckle == 0;
}

static struct refocus_depth_write depth_of(const struct input *input)
{
    const struct refocus_photo_info *const info = input->photo->info;
    struct refocus_depth_write depth = refocus_depth_write_default();

    depth.disparity = input->disparity;
    depth.width = input->width;
    depth.height = input->height;
    depth.stride = (ptrdiff_t)input->width * 2;
    depth.confidence = input_confidence(input);
    depth.confidence_stride = input->width;
    depth.near_m = input->report.near_m;
    depth.far_m = input->report.far_m;
    depth.focus_x = info->focus_x;
    depth.focus_y = info->focus_y;
    return depth;
}

int keep_options(const struct keep_settings *settings, const struct input *input,
                 const struct depth_settings *depth, const char *output, bool whole,
                 const struct refocus_render_params *lens, struct editable *editable)
{
    const struct refocus_photo *const photo = input->photo;
#ifdef RF_HAVE_EDITABLE
    const bool can = !photo->deep->plane[0] || photo->deep->format == REFOCUS_FORMAT_RGB16;
#else
    const bool can = false;
#endif
    /* A photo that lost nothing so far would be several times the size of its result. */
    const bool wanted = settings->editable || strcmp(photo->info->container, "JPEG") == 0 ||
                        strcmp(photo->info->container, "HEIC") == 0;

    editable->options = output_keeps(photo);
    if (settings->strip) {
        editable->options.exif = NULL;
        editable->options.keep = NULL;
    }
    if (settings->editable && !can)
        return report_failure(EXIT_FAILED, input->photo_name,
                              "--editable is for photos that are not of floats, by a build with "
                              "expat and libpng; leave it out");
    if (!can || !wanted || !whole || settings->strip || settings->no_editable || !is_holder(output))
        return EXIT_DONE;
    editable->given = refocus_editable_default();
    editable->given.own_depth = has_own_depth(input, depth);
    editable->depth = depth_of(input);
    editable->given.depth = &editable->depth;
    editable->given.focus_disparity = lens->focus_disparity;
    editable->given.max_blur_radius = lens->max_blur_radius;
    editable->given.simulated_f_number = input->depth_from->info->simulated_f_number;
    if (depth->matte && input->matte.samples) {
        editable->given.matte = input->matte.samples;
        editable->given.matte_width = (int32_t)input->matte.width;
        editable->given.matte_height = (int32_t)input->matte.height;
        editable->given.matte_stride = input->matte.stride;
    }
    editable->options.editable = &editable->given;
    return EXIT_DONE;
}
