/* behind.c: the files of a second layer are read. */
#include <string.h>
#include "inputs/behind.h"
#include "line/report.h"

const struct option behind_options[] = {
    {OPTION(OPTION_TEXT, "--behind", "IMAGE", struct behind_settings, image),
     .needs = "--behind-depth",
     .help = "what the photo hides, where that is known: a picture of the photo's size, which is "
             "shown where a blurred foreground uncovers it"},
    {OPTION(OPTION_TEXT, "--behind-depth", "MAP", struct behind_settings, depth),
     .needs = "--behind",
     .help = "depth map of IMAGE, of its size, in the units and between the distances of the "
             "photo's; counts where it is farther than that"},
    {.help = NULL},
};

static int check_size(const char *name, int width, int height, const struct refocus_image *photo)
{
    if (width == photo->width && height == photo->height)
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, name,
                          "it is %dx%d, the photo %dx%d; give what is behind in the photo's size",
                          width, height, (int)photo->width, (int)photo->height);
}

static int read_image(struct behind *behind, const char *name, const struct refocus_image *photo)
{
    struct refocus_reason reason = {""};
    const int status = refocus_photo_read(&behind->photo, name, limits_taken(), &reason);

    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), name, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    if (!behind->photo->image->plane[0])
        return report_failure(EXIT_FAILED, name,
                              "it is a depth map, not a picture; give it to --behind-depth");
    input_tell_bits(behind->photo, name);
    return check_size(name, behind->photo->image->width, behind->photo->image->height, photo);
}

/* The map is read on the photo's scale: distances between its z0 and z1, and samples that have no
 * range of their own between those that became 1 and 0. */
static int read_depth(struct behind *behind, const char *name,
                      const struct depth_settings *photo_depth, const struct input *photo)
{
    const struct refocus_depth_report *report = &photo->report;
    struct refocus_reason reason = {""};
    struct depth_settings settings = *photo_depth;
    struct input *input = &behind->depth;
    struct refocus_depth_map *map;
    int status = refocus_depth_read(&input->side, name, settings.unit, report->near_m,
                                    report->far_m, limits_taken(), &reason);

    input->photo_name = input->depth_name = name;
    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), name, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    map = input->side->depth;
    if (map->value_near == map->value_far) {
        map->value_near = report->value_near;
        map->value_far = report->value_far;
    }
    input->depth_from = input->side;
    settings.edges = EDGES_AS_GIVEN;
    return input_convert(input, &settings);
}

int behind_read(struct behind *behind, const struct behind_settings *settings,
                const struct depth_settings *depth, const struct input *input)
{
    const struct refocus_image *photo = input->photo->image;
    int status;

    memset(behind, 0, sizeof *behind);
    if (!settings->image)
        return EXIT_DONE;
    status = read_image(behind, settings->image, photo);
    if (status == EXIT_DONE)
        status = read_depth(behind, settings->depth, depth, input);
    if (status == EXIT_DONE)
        status = check_size(settings->depth, behind->depth.width, behind->depth.height, photo);
    if (status != EXIT_DONE)
        return status;
    behind->image = *behind->photo->image;
    behind->disparity = refocus_disparity16(behind->depth.disparity, photo->width, photo->height,
                                            (ptrdiff_t)photo->width * 2);
    return EXIT_DONE;
}

void behind_add(const struct behind *behind, struct refocus_scene *scene)
{
    if (behind->image.struct_size == 0)
        return;
    scene->behind = &behind->image;
    scene->behind_disparity = &behind->disparity;
}

void behind_free(struct behind *behind)
{
    refocus_photo_free(&behind->photo);
    input_free(&behind->depth);
}
