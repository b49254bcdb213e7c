/* inputs.c: a photo and its depth are read, and the depth is made ready for rendering. */
#include <stdlib.h>
#include <string.h>
#include "inputs/inputs.h"
#include "inputs/edges.h"
#include "inputs/upsample.h"
#include "line/report.h"

static bool given(double value)
{
    return !isnan(value);
}

int input_exit_code(int status)
{
    return status == REFOCUS_ERR_ARGUMENT ? EXIT_WRONG : EXIT_FAILED;
}

/* Find the flags for the names in --invalid; false when one is not known. */
static bool find_codes(const char *names, uint32_t *flags)
{
    static const struct {
        const char *name;
        uint32_t flag;
    } codes[] = {{"zero", REFOCUS_DEPTH_ZERO_IS_UNKNOWN},
                 {"max", REFOCUS_DEPTH_MAX_IS_UNKNOWN},
                 {"2047", REFOCUS_DEPTH_2047_IS_UNKNOWN}};

    *flags = 0;
    while (names && *names) {
        const size_t length = strcspn(names, ",");
        bool found = false;

        for (size_t i = 0; i < sizeof codes / sizeof *codes; i++) {
            if (strlen(codes[i].name) == length && !strncmp(names, codes[i].name, length)) {
                *flags |= codes[i].flag;
                found = true;
            }
        }
        if (!found)
            return false;
        names += length + (names[length] == ',');
    }
    return true;
}

int input_check_depth(const struct depth_settings *settings)
{
    struct refocus_depth_map map = refocus_depth_map_default();
    uint32_t flags;

    if (!find_codes(settings->invalid, &flags))
        return report_failure(EXIT_WRONG, "--invalid",
                              "'%s' is not known; give zero, max or 2047, or several "
                              "with commas",
                              settings->invalid);

    map.sample = REFOCUS_SAMPLE_U16;
    if (settings->unit && refocus_depth_set_unit(&map, settings->unit) != REFOCUS_OK)
        return report_failure(EXIT_WRONG, "--depth-unit",
                              "'%s' is not known; give disparity, inverse, mm, m or a "
                              "number per metre such as 5000/m",
                              settings->unit);
    if (settings->near_m >= settings->far_m)
        return report_failure(EXIT_WRONG, "--near",
                              "%g m is not nearer than --far %g m; give the smaller "
                              "number to --near",
                              settings->near_m, settings->far_m);
    return EXIT_DONE;
}

/* Put --near, --far and --depth-unit over what the photo says about its own depth. */
static int settle_embedded(struct input *input, const struct depth_settings *settings)
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
    int status = REFOCUS_ERR_MEMORY;

    params.confidence = input->confidence;
    params.confidence_stride = input->width;
    if (full && settings->upsample > 0) {
        status = upsample_by_filter((uint32_t)settings->upsample - 1, photo, &map, full,
                                    input->depth_name);
        if (status != EXIT_DONE) {
            free(full);
            return status;
        }
    } else if (full)
        status = refocus_upsample(photo, &map, &params, full, (ptrdiff_t)photo->width * 2);
    if (status != REFOCUS_OK) {
        free(full);
        return report_failure(EXIT_FAILED, input->depth_name, "the depth map: %s",
                              refocus_strerror(status));
    }
    free(input->disparity);
    input->disparity = full;
    input->width = photo->width;
    input->height = photo->height;
    return EXIT_DONE;
}

/* An explicit filter says how edges are to be. */
bool input_has_edges_placed(const struct input *input, const struct depth_settings *settings)
{
    return settings->edges == EDGES_AUTO && settings->upsample == 0 && input->photo &&
           input->photo->image->plane[0];
}

static bool has_other_size(const struct input *input)
{
    return input->photo && input->photo->image->plane[0] &&
           (input->photo->image->width != input->width ||
            input->photo->image->height != input->height);
}

static bool has_guesses(const struct input *input)
{
    return input->report.unknown + input->report.specks > 0;
}

static bool worth_enlarging(const struct input *input, const struct depth_settings *settings)
{
    return settings->full && has_other_size(input) &&
           (!input_has_edges_placed(input, settings) || has_guesses(input));
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

/* Filled samples count least when the map is enlarged, which the edges are then looked for in:
 * here where disparities of the photo's size are asked for, else by the renderer. */
static int fit(struct input *input, const struct depth_settings *settings)
{
    const int status = worth_enlarging(input, settings) ? enlarge(input, settings) : EXIT_DONE;

    return status == EXIT_DONE && settings->full && input_has_edges_placed(input, settings)
               ? place(input)
               : status;
}

int input_convert(struct input *input, const struct depth_settings *settings)
{
    struct refocus_depth_map settled = *input->depth_from->depth, *map = &settled;
    struct refocus_repair_params params = refocus_repair_params_default();
    const uint64_t bytes = (uint64_t)map->width * (uint64_t)map->height * sizeof(uint16_t);
    int status = REFOCUS_ERR_MEMORY;
    uint32_t flags;

    find_codes(settings->invalid, &flags);
    map->flags |= flags;

    if (map->near_m > 0 && map->far_m > 0 && map->near_m >= map->far_m)
        return report_failure(EXIT_WRONG, input->depth_name,
                              "near %g m is not nearer than far %g m; give --near and "
                              "--far",
                              map->near_m, map->far_m);
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
        status = refocus_depth_repair(map, &params, input->disparity, (ptrdiff_t)map->width * 2,
                                      &input->report);
    if (status == REFOCUS_ERR_NO_DEPTH)
        return report_failure(EXIT_FAILED, input->depth_name,
                              "no sample of the depth map holds a value; give another "
                              "--depth or --depth-unit");
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, input->depth_name, "the depth map: %s",
                              refocus_strerror(status));
    return fit(input, settings);
}

static int report_no_depth(const char *photo)
{
    return report_failure(EXIT_FAILED, photo,
                          "it carries no depth; give a depth map to --depth, or make "
                          "one by 'refocus depth PHOTO -o MAP.png' with --estimate "
                          "MODEL.onnx or --strokes FILE.json");
}

/* The file may be the photo itself. */
static int read_side(struct input *input, const char *file, const struct depth_settings *settings)
{
    struct refocus_reason reason = {""};
    int status;

    input->depth_name = file;
    status = refocus_depth_read(&input->side, file, settings->unit,
                                given(settings->near_m) ? settings->near_m : 0,
                                given(settings->far_m) ? settings->far_m : 0, NULL, &reason);
    if (status == REFOCUS_ERR_NO_DEPTH && file == input->photo_name)
        return report_no_depth(file);
    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), file, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    input->depth_from = input->side;
    return EXIT_DONE;
}

void input_tell_bits(const struct refocus_photo *photo, const char *name)
{
    if (photo->info->stored_bits > 8)
        report_warning(name, "it has %d bits a channel; 8 are taken, %s",
                       (int)photo->info->stored_bits,
                       strcmp(photo->info->container, "HEIC") == 0 ? "rounded" : "dithered");
}

int input_read_photo(struct input *input, const char *photo, const char *instead)
{
    struct refocus_reason reason = {""};
    int status;

    memset(input, 0, sizeof *input);
    input->photo_name = input->depth_name = photo;
    status = refocus_photo_read(&input->photo, photo, NULL, &reason);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, photo, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    if (!input->photo->image->plane[0])
        return report_failure(EXIT_FAILED, photo,
                              "it is a depth map, not a photo; "
                              "give %s",
                              instead);
    input_tell_bits(input->photo, photo);
    return EXIT_DONE;
}

/* A map of another picture, or one that lies on its side: neither is stretched to fit.
 * Cameras' 4:3 and 16:9 go together, and a square is what networks make of any picture;
 * of a few samples the shape says nothing. */
static bool has_another_shape(const struct refocus_depth_map *map,
                              const struct refocus_image *photo)
{
    enum { FEWEST = 16 };
    const int64_t wide = (int64_t)map->width * photo->height;
    const int64_t high = (int64_t)map->height * photo->width;

    return map->width >= FEWEST && map->height >= FEWEST && map->width != map->height &&
           (2 * wide > 3 * high || 2 * high > 3 * wide);
}

static int check_shape(const struct input *input, const char *file,
                       const struct refocus_depth_map *map, const char *what)
{
    const struct refocus_image *photo = input->photo->image;

    if (!has_another_shape(map, photo))
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, file,
                          "its %dx%d samples have another shape than the photo of %dx%d pixels; "
                          "give the %s of this photo, as upright as the photo is",
                          (int)map->width, (int)map->height, (int)photo->width, (int)photo->height,
                          what);
}

/* Read the matte with the codes that the file has: white is all subject. */
static int read_matte(struct input *input, const char *file)
{
    struct refocus_photo *read = NULL;
    struct refocus_reason reason = {""};
    struct refocus_depth_map map;
    uint64_t bytes;
    int status = refocus_depth_read(&read, file, NULL, 0, 0, NULL, &reason);

    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), file, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    map = *read->depth;
    bytes = (uint64_t)map.width * (uint64_t)map.height * 2;
    map.meaning = REFOCUS_DEPTH_DISPARITY;
    map.flags = 0;
    map.near_m = map.far_m = map.value_far = 0;
    map.value_near = map.sample == REFOCUS_SAMPLE_U8    ? 255
                     : map.sample == REFOCUS_SAMPLE_U16 ? 65535
                                                        : 1;
    input->matte_name = file;
    input->matte_samples = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    input->matte =
        refocus_disparity16(input->matte_samples, map.width, map.height, (ptrdiff_t)map.width * 2);
    status = check_shape(input, file, &map, "matte");
    if (status == EXIT_DONE &&
        (!input->matte_samples ||
         refocus_depth_to_disparity(&map, input->matte_samples, input->matte.stride, NULL)))
        status = report_failure(EXIT_FAILED, file, "not enough memory for the matte");
    refocus_photo_free(&read);
    return status;
}

json_t *input_matte_json(const struct input *input)
{
    const int64_t samples = (int64_t)input->matte.width * input->matte.height;
    int64_t subject = 0, mixed = 0;

    if (!input->matte_samples)
        return json_null();
    for (int64_t i = 0; i < samples; i++) {
        subject += input->matte_samples[i] == 65535;
        mixed += input->matte_samples[i] > 0 && input->matte_samples[i] < 65535;
    }
    return json_pack("{s:o, s:i, s:i, s:f, s:f}", "file", report_text_json(input->matte_name),
                     "width", (int)input->matte.width, "height", (int)input->matte.height,
                     "subject", (double)subject / (double)samples, "mixed",
                     (double)mixed / (double)samples);
}

struct refocus_scene input_scene(const struct input *input, const struct refocus_disparity *map)
{
    struct refocus_scene scene = refocus_scene_default(input->photo->image, map);

    scene.matte = input->matte.samples ? &input->matte : NULL;
    if (has_other_size(input) && has_guesses(input)) {
        scene.confidence = input->confidence;
        scene.confidence_stride = input->width;
    }
    return scene;
}

int input_read(struct input *input, const char *photo, const struct depth_settings *settings)
{
    int status = input_read_photo(input, photo, "the photo, and this file to --depth");

    if (status != EXIT_DONE)
        return status;
    if (settings->file) {
        status = read_side(input, settings->file, settings);
        if (status == EXIT_DONE)
            status = check_shape(input, settings->file, input->side->depth, "map");
    } else {
        if (!input->photo->depth->samples && settings->optional)
            return EXIT_DONE;
        if (!input->photo->depth->samples)
            return report_no_depth(photo);
        input->depth_name = photo;
        input->depth_from = input->photo;
        status = settle_embedded(input, settings);
    }
    if (status == EXIT_DONE && settings->matte)
        status = read_matte(input, settings->matte);
    return status == EXIT_DONE ? input_convert(input, settings) : status;
}

int input_read_depth(struct input *input, const char *file, const struct depth_settings *settings)
{
    int status;

    memset(input, 0, sizeof *input);
    input->photo_name = file;
    status = read_side(input, file, settings);
    return status == EXIT_DONE ? input_convert(input, settings) : status;
}

void input_free(struct input *input)
{
    free(input->disparity);
    free(input->confidence);
    free(input->matte_samples);
    free(input->made_samples);
    refocus_photo_free(&input->side);
    refocus_photo_free(&input->photo);
}
