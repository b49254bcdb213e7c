/* read_input.c: reads a photo, its depth and its matte, which disparities.c then makes ready for
 * rendering. */
#include <stdlib.h>
#include <string.h>
#include "inputs/disparities.h"
#include "inputs/read_input.h"
#include "inputs/matte.h"
#include "inputs/map_shape.h"
#include "inputs/standard_input.h"
#include "inputs/unit.h"
#include "line/report.h"

static bool given(double value)
{
    return !isnan(value);
}

int input_exit_code(int status)
{
    return status == REFOCUS_ERR_ARGUMENT ? EXIT_WRONG : EXIT_FAILED;
}

bool input_depth_is_made(const struct depth_settings *settings)
{
    return settings->model || settings->right || settings->stereo.within;
}

int input_check_depth(const struct depth_settings *settings)
{
    struct refocus_depth_map map = refocus_depth_map_default();

    limits_take(&settings->limits);
    if (refocus_depth_set_invalid(&map, settings->invalid) != REFOCUS_OK)
        return report_failure(EXIT_WRONG, "--invalid",
                              "'%s' is not known; give zero, max or numbers, up to %d, with "
                              "commas",
                              settings->invalid, REFOCUS_DEPTH_MOST_UNKNOWN);

    if (settings->file && standard_is(settings->file))
        return report_failure(EXIT_WRONG, "--depth",
                              "'-' is standard input, which is for the photo; give a file");
    map.sample = REFOCUS_SAMPLE_U16;
    if (settings->unit && refocus_depth_set_unit(&map, settings->unit) != REFOCUS_OK)
        return report_failure(
            EXIT_WRONG, "--depth-unit",
            "'%s' is not known; give disparity, disparity/16, inverse, mm, m or a "
            "number per metre such as 5000/m",
            settings->unit);
    if ((settings->file != NULL) + input_depth_is_made(settings) > 1 ||
        (settings->model && (settings->right || settings->stereo.within)) ||
        (settings->right && settings->stereo.within))
        return report_failure(EXIT_WRONG, settings->model ? "--estimate" : "--stereo",
                              "depth is given twice; give one of --depth, --estimate, --stereo and "
                              "--stereo-file");
    if (input_depth_is_made(settings) && (settings->unit || settings->orient != ORIENT_AUTO))
        return report_failure(EXIT_WRONG, settings->unit ? "--depth-unit" : "--orient-depth",
                              "it is for depth that is read from a file; leave it out");
    if (settings->near_m >= settings->far_m)
        return report_failure(EXIT_WRONG, "--near",
                              "%g m is not nearer than --far %g m; give the smaller "
                              "number to --near",
                              settings->near_m, settings->far_m);
    return upsample_check(settings->upsample);
}

int input_settle_embedded(struct input *input, const struct depth_settings *settings)
{
    struct refocus_depth_map *map = input->photo->depth;

    if (settings->unit) {
        const int status = refocus_depth_set_unit(map, settings->unit);
        if (status != REFOCUS_OK)
            return report_failure(EXIT_WRONG, "--depth-unit",
                                  "'%s' does not suit the depth of %s: %s", settings->unit,
                                  input->depth_name, refocus_strerror(status));
    }
    if (given(settings->near_m))
        map->near_m = settings->near_m;
    if (given(settings->far_m))
        map->far_m = settings->far_m;
    return input_check_range(input, map);
}

static int report_no_depth(const char *photo, const struct refocus_photo *read)
{
    if (read && read->info->views > 0)
        return report_failure(EXIT_FAILED, photo,
                              "it carries no depth but another view; give --stereo-file, which "
                              "makes depth of the two");
    return report_failure(EXIT_FAILED, photo,
                          "it carries no depth; give a depth map to --depth, MODEL.onnx to "
                          "--estimate or the other picture of a stereo pair to --stereo, or make "
                          "a map by 'refocus depth PHOTO -o MAP.png' with --focal-stack or "
                          "--strokes");
}

/* The file may be the photo itself. */
static int read_side(struct input *input, const char *file, const struct depth_settings *settings)
{
    struct refocus_reason reason = {""};
    int status;

    input->depth_name = file;
    status = refocus_depth_read(
        &input->side, file, settings->unit, given(settings->near_m) ? settings->near_m : 0,
        given(settings->far_m) ? settings->far_m : 0, limits_taken(), &reason);
    if (status == REFOCUS_ERR_NO_DEPTH && file == input->photo_name)
        return report_no_depth(file, input->photo);
    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), file, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    refocus_depth_set_invalid(input->side->depth, settings->invalid);
    input->depth_from = input->side;
    return EXIT_DONE;
}

/* The depth file has been read, and how it lies is known. */
static void tell_doubt(const struct input *input, const struct depth_settings *settings)
{
    char line[UNIT_LINE];

    if (unit_is_doubtful(input->side, settings, input->orientation > 1, line))
        report_warning(input->depth_name, "%s", line);
}

void input_tell_bits(const struct refocus_photo *photo, const char *name)
{
    if (photo->info->stored_bits > 8)
        report_warning(name, "it has %d bits a channel; 8 are taken, %s",
                       (int)photo->info->stored_bits,
                       strcmp(photo->info->container, "HEIC") == 0 ? "rounded" : "dithered");
}

/* Read a photo, or the first picture of a stereo file. */
static int take_photo(struct input *input, const char *photo, bool first, const char *instead)
{
    struct refocus_reason reason = {""};
    int status;

    memset(input, 0, sizeof *input);
    input->photo_name = input->depth_name = photo;
    status = first ? refocus_photo_read_first(&input->photo, photo, limits_taken(), &reason)
                   : standard_photo(&input->photo, photo, &reason);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, photo, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    if (!input->photo->image->plane[0])
        return report_failure(EXIT_FAILED, photo, "it is a depth map, not a photo; give %s",
                              instead);
    return EXIT_DONE;
}

int input_take_photo(struct input *input, const char *photo, const char *instead)
{
    return take_photo(input, photo, false, instead);
}

int input_read_photo(struct input *input, const char *photo, const char *instead)
{
    const int status = input_take_photo(input, photo, instead);

    if (status == EXIT_DONE)
        input_tell_bits(input->photo, photo);
    return status;
}

int input_read_left(struct input *input, const char *left, bool within)
{
    const int status = take_photo(input, left, within, "a photo");

    if (status == EXIT_DONE)
        input_tell_bits(input->photo, left);
    return status;
}

const struct option_word gain_map_words[] = {
    [GAIN_MAP_USE] = {"use", "highlights have the light that it says they have; tones stay"},
    [GAIN_MAP_IGNORE] = {"ignore", "the photo is taken for what its 8 bits show"},
    {0}};

static int take_light(struct input *input)
{
    if (refocus_light_create(&input->light, input->photo) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, input->photo_name,
                              "not enough memory for its gain map; give --gain-map ignore");
    input->deep = *refocus_light_image(input->light);
    return EXIT_DONE;
}

/* Choose what of the photo is rendered. */
static int choose_bits(struct input *input, const struct depth_settings *settings)
{
    const struct refocus_image *deep = input->photo->deep;
    const bool asked = settings->transfer || !isnan(settings->white);

    if (input->photo->info->gain_map_stops > 0 && settings->gain_map == GAIN_MAP_USE &&
        settings->light)
        return take_light(input);
    if (asked && (!deep->plane[0] || settings->deep == DEEP_NONE))
        return report_failure(EXIT_FAILED, settings->transfer ? "--transfer" : "--white",
                              "the option is for photos of more than 8 bits, rendered by sweep, "
                              "search, blur or interpolated in linear light without --sigma, "
                              "--grain, --star, --view and --wiggle; leave it out");
    if (!deep->plane[0] || settings->deep == DEEP_NONE ||
        (settings->deep == DEEP_LIGHT && deep->format != REFOCUS_FORMAT_RGB_FLOAT)) {
        input_tell_bits(input->photo, input->photo_name);
        return EXIT_DONE;
    }
    input->deep = *deep;
    input->deep.transfer = (uint32_t)settings->transfer;
    input->deep.white = isnan(settings->white) ? 0 : (float)settings->white;
    return EXIT_DONE;
}

/* Find out how the map is to be turned; one that has the shape of another picture then is refused,
 * one of the photo's own only where it lies on its side. */
static int settle_shape(struct input *input, const struct depth_settings *settings)
{
    const struct refocus_image *photo = input->photo->image;
    const struct refocus_depth_map *map = input->depth_from->depth;
    const int photo_orientation = input->photo->info->orientation;
    const bool own = input->depth_from == input->photo;
    const bool on_its_side = shape_lies_on_its_side(map->width, map->height, photo);
    int width = map->width, height = map->height;

    input->orientation =
        orient_choose((enum orient)settings->orient, on_its_side, photo_orientation, own);
    if (settings->orient == ORIENT_AUTO && input->orientation > 1)
        report_warning(input->depth_name,
                       "its %dx%d samples lie on their side; they are turned %s EXIF orientation "
                       "%d of the photo; --orient-depth says otherwise",
                       width, height, own ? "back by" : "by", photo_orientation);
    if (input->orientation >= 5) {
        width = map->height;
        height = map->width;
    }
    if (shape_lies_on_its_side(width, height, photo) && !on_its_side)
        return report_failure(EXIT_FAILED, input->depth_name,
                              "its %dx%d samples lie on their side once --orient-depth has turned "
                              "them; leave that out, or give 0 or 180",
                              (int)map->width, (int)map->height);
    if (shape_is_of_half(width, height, photo))
        return report_failure(
            EXIT_FAILED, input->depth_name,
            "its %dx%d samples are of one half of the photo of %dx%d pixels; give "
            "that half as the photo, of two pictures side by side the first one",
            (int)map->width, (int)map->height, (int)photo->width, (int)photo->height);
    if (shape_lies_on_its_side(width, height, photo))
        return report_failure(
            EXIT_FAILED, input->depth_name,
            "its %dx%d samples lie on their side beside the photo of %dx%d pixels; turn them by "
            "--orient-depth 90 or 270, or give the map of this photo",
            (int)map->width, (int)map->height, (int)photo->width, (int)photo->height);
    return own ? EXIT_DONE : shape_check(input->depth_name, width, height, photo, "map");
}

/* The matte that is asked for, else the photo's own, where it has the photo's shape. */
static int settle_matte(struct input *input, const char *asked)
{
    const struct refocus_image *photo = input->photo->image;
    const struct refocus_depth_map *own = input->photo->matte;

    input->matte_name = asked ? asked : input->photo_name;
    if (asked)
        return matte_is_none(asked)
                   ? EXIT_DONE
                   : matte_read(asked, photo, &input->matte_samples, &input->matte);
    if (!own->samples || shape_is_another(own->width, own->height, photo))
        return EXIT_DONE;
    return matte_take(own, input->photo_name, photo, &input->matte_samples, &input->matte);
}

json_t *input_matte_json(const struct input *input)
{
    return matte_json(input->matte_name, &input->matte);
}

struct refocus_scene input_scene(const struct input *input, const struct refocus_disparity *map)
{
    struct refocus_scene scene =
        refocus_scene_default(input->deep.plane[0] ? &input->deep : input->photo->image, map);

    scene.matte = input->matte.samples ? &input->matte : NULL;
    scene.confidence = input_confidence(input);
    scene.confidence_stride = scene.confidence ? input->width : 0;
    return scene;
}

int input_read(struct input *input, const char *photo, const struct depth_settings *settings)
{
    int status =
        take_photo(input, photo, settings->stereo.within, "the photo, and this file to --depth");

    if (status != EXIT_DONE)
        return status;
    if ((status = choose_bits(input, settings)) != EXIT_DONE)
        return status;
    if (settings->make) {
        status = settings->make(input, settings);
    } else if (settings->file) {
        status = read_side(input, settings->file, settings);
    } else {
        if (!input->photo->depth->samples && settings->optional)
            return EXIT_DONE;
        if (!input->photo->depth->samples)
            return report_no_depth(photo, input->photo);
        input->depth_name = photo;
        input->depth_from = input->photo;
        status = input_settle_embedded(input, settings);
    }
    if (status == EXIT_DONE && !settings->make)
        status = settle_shape(input, settings);
    if (status == EXIT_DONE && input->side && !settings->make)
        tell_doubt(input, settings);
    if (status == EXIT_DONE)
        status = settle_matte(input, settings->matte);
    return status == EXIT_DONE ? input_convert(input, settings) : status;
}

int input_read_depth(struct input *input, const char *file, const struct depth_settings *settings)
{
    int status;

    memset(input, 0, sizeof *input);
    input->photo_name = file;
    status = read_side(input, file, settings);
    input->orientation = orient_choose((enum orient)settings->orient, false, 1, false);
    if (status == EXIT_DONE)
        tell_doubt(input, settings);
    return status == EXIT_DONE ? input_convert(input, settings) : status;
}

void input_free(struct input *input)
{
    free(input->disparity);
    free(input->confidence);
    free(input->matte_samples);
    free(input->made_samples);
    free(input->stacked.plane[0]);
    refocus_light_destroy(&input->light);
    refocus_photo_free(&input->side);
    refocus_photo_free(&input->photo);
}
