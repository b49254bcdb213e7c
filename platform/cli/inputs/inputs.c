#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "inputs/inputs.h"
#include "inputs/made.h"
#include "line/report.h"

static bool given(double value)
{
    return !isnan(value);
}

int input_exit_code(int status)
{
    return status == REFOCUS_ERR_ARGUMENT ? EXIT_WRONG : EXIT_FAILED;
}

/* Flags of the names in --invalid; false when one is not known. */
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
    struct refocus_depth_map map;
    uint32_t flags;

    if (!find_codes(settings->invalid, &flags))
        return report_failure(EXIT_WRONG, "--invalid",
                              "'%s' is not known; give zero, max or 2047, or several "
                              "with commas",
                              settings->invalid);

    memset(&map, 0, sizeof map);
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

bool input_focus_is_given(const struct lens_settings *settings)
{
    return given(settings->focus) || given(settings->focus_at[0]) ||
           given(settings->focus_distance) || given(settings->focus_rectangle[0]);
}

int input_check_lens(const struct lens_settings *settings)
{
    const int ways = given(settings->focus) + given(settings->focus_at[0]) +
                     given(settings->focus_distance) + given(settings->focus_rectangle[0]);

    if (ways > 1)
        return report_failure(EXIT_WRONG,
                              given(settings->focus_rectangle[0]) ? "--focus-rectangle"
                              : given(settings->focus_distance)   ? "--focus-distance"
                                                                  : "--focus-at",
                              "the focus is given twice; give one of --focus, "
                              "--focus-at, --focus-distance and --focus-rectangle");
    if (given(settings->blur) && given(settings->f_number))
        return report_failure(EXIT_WRONG, "--f-number",
                              "the blur is given twice; give --blur or --f-number");
    if (given(settings->focal_length) && !given(settings->f_number))
        return report_failure(EXIT_WRONG, "--focal-length",
                              "it goes with --f-number; give that too");
    if (given(settings->sensor_width) && !given(settings->focal_length))
        return report_failure(EXIT_WRONG, "--sensor-width",
                              "it goes with --focal-length; give that too");
    return EXIT_DONE;
}

/* --near, --far and --depth-unit over what the photo says of its own depth. */
static int settle_embedded(struct input *input, const struct depth_settings *settings)
{
    struct refocus_depth_map *map = &input->photo->depth;

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
    const struct refocus_image *photo = &input->photo->image;
    const struct refocus_disparity map = refocus_disparity16(
        input->disparity, input->width, input->height, (ptrdiff_t)input->width * 2);
    struct refocus_upsample_params params = refocus_upsample_params_default();
    const uint64_t bytes = (uint64_t)photo->width * (uint64_t)photo->height * 2;
    uint16_t *full = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    int status = REFOCUS_ERR_MEMORY;

    params.confidence = input->confidence;
    params.confidence_stride = input->width;
    if (full && settings->upsample > 0) {
        status =
            made_upsample((uint32_t)settings->upsample - 1, photo, &map, full, input->depth_name);
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

/* Move the edges of a map of the photo's size onto the photo's. */
static int snap(struct input *input, const struct depth_settings *settings)
{
    const struct refocus_snap_params params = refocus_snap_params_default((int32_t)settings->snap);
    const ptrdiff_t stride = (ptrdiff_t)input->width * 2;
    const struct refocus_disparity map =
        refocus_disparity16(input->disparity, input->width, input->height, stride);
    uint16_t *out = malloc((size_t)stride * (size_t)input->height);
    int status = REFOCUS_ERR_MEMORY;

    if (out)
        status = refocus_depth_snap(&input->photo->image, &map, &params, out, stride);
    if (status != REFOCUS_OK) {
        free(out);
        return report_failure(EXIT_FAILED, input->depth_name, "the depth map: %s",
                              refocus_strerror(status));
    }
    free(input->disparity);
    input->disparity = out;
    return EXIT_DONE;
}

static bool worth_snapping(const struct input *input, const struct depth_settings *settings)
{
    return settings->snap > 0 && input->photo && input->photo->image.plane[0] &&
           input->photo->image.width == input->width && input->photo->image.height == input->height;
}

static bool worth_enlarging(const struct input *input, const struct depth_settings *settings)
{
    return input->photo && input->photo->image.plane[0] &&
           (input->photo->image.width != input->width ||
            input->photo->image.height != input->height) &&
           (settings->full || input->report.unknown + input->report.specks > 0);
}

int input_convert(struct input *input, const struct depth_settings *settings)
{
    struct refocus_depth_map settled = input->depth_from->depth, *map = &settled;
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
    if (worth_snapping(input, settings))
        return snap(input, settings);
    if (settings->snap > 0 && input->photo)
        return report_failure(EXIT_FAILED, input->depth_name,
                              "its depth has %dx%d samples, the photo %dx%d pixels; "
                              "--snap takes depth of the photo's size, give --full "
                              "instead",
                              input->width, input->height, input->photo->image.width,
                              input->photo->image.height);
    return worth_enlarging(input, settings) ? enlarge(input, settings) : EXIT_DONE;
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
    if (photo->info.stored_bits > 8)
        report_warning(name, "it has %d bits a channel; 8 are taken, %s",
                       (int)photo->info.stored_bits,
                       strcmp(photo->info.container, "HEIC") == 0 ? "rounded" : "dithered");
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
    if (!input->photo->image.plane[0])
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

int input_read(struct input *input, const char *photo, const struct depth_settings *settings)
{
    int status = input_read_photo(input, photo, "the photo, and this file to --depth");

    if (status != EXIT_DONE)
        return status;
    if (settings->file) {
        status = read_side(input, settings->file, settings);
        if (status == EXIT_DONE && has_another_shape(&input->side->depth, &input->photo->image))
            return report_failure(EXIT_FAILED, settings->file,
                                  "its %dx%d samples have another shape than the photo "
                                  "of %dx%d pixels; give the map of this photo, as "
                                  "upright as the photo is",
                                  input->side->depth.width, input->side->depth.height,
                                  input->photo->image.width, input->photo->image.height);
    } else {
        if (!input->photo->depth.samples && settings->optional)
            return EXIT_DONE;
        if (!input->photo->depth.samples)
            return report_no_depth(photo);
        input->depth_name = photo;
        input->depth_from = input->photo;
        status = settle_embedded(input, settings);
    }
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
    free(input->made_samples);
    refocus_photo_free(&input->side);
    refocus_photo_free(&input->photo);
}

static bool range_is_known(const struct input *input)
{
    return input->report.near_m > 0 && input->report.far_m > input->report.near_m;
}

static double larger_side(const struct refocus_image *image)
{
    return image->width > image->height ? image->width : image->height;
}

/* The lens of --f-number; see the help of LENS_OPTIONS for what stands in for what. */
static bool choose_lens(const struct input *input, const struct lens_settings *settings,
                        struct refocus_lens *lens)
{
    const double width = input->photo->image.width, height = input->photo->image.height;

    lens->f_number = settings->f_number;
    if (given(settings->focal_length)) {
        lens->focal_length_mm = settings->focal_length;
        lens->sensor_width_mm = given(settings->sensor_width)
                                    ? settings->sensor_width
                                    : 36 * width / larger_side(&input->photo->image);
        return true;
    }
    /* 35 mm terms compare diagonals: that of 36 x 24 mm with the picture's. */
    lens->focal_length_mm = input->photo->info.focal_length_35mm;
    lens->sensor_width_mm =
        sqrt(36.0 * 36 + 24 * 24) * width / sqrt(width * width + height * height);
    return lens->focal_length_mm > 0;
}

/* K by the settings, and how it came about. */
struct blur_choice {
    double radius, asked;   /* pixels: that is taken, and that of the f-number */
    double f_number;        /* the one that gives `radius`; NAN: none does */
    double own, own_number; /* without metres: what stands for which f-number */
    const char *from;       /* "pixels", "lens", "file" or "default" */
};

/* That of 50 mm at f/2 on full frame, from 0.87 m to far away. */
static double default_blur(const struct input *input)
{
    return fmin(larger_side(&input->photo->image) / 50, REFOCUS_MAX_BLUR_RADIUS);
}

/* f-numbers of files may be anything. */
static bool is_f_number(double number)
{
    return number >= 0.5 && number <= 64;
}

/* Without metres a lens has no blur. A file's own blur, or the default, stands for the
 * f-number that the file names, else for f/2 as most phones have it, and others are more
 * or less of it: K is as 1/N. */
static void blur_without_metres(const struct input *input, double f_number,
                                struct blur_choice *choice)
{
    static const double usual = 2;
    const struct refocus_photo_info *info = &input->depth_from->info;

    if (info->own_blur > 0) {
        choice->from = "file";
        choice->own = info->own_blur * larger_side(&input->photo->image);
        choice->own_number = info->f_number;
    } else {
        choice->from = "default";
        choice->own = default_blur(input);
        choice->own_number = info->simulated_f_number;
    }
    if (!is_f_number(choice->own_number))
        choice->own_number = usual;
    choice->asked = choice->own * choice->own_number / f_number;
}

static int choose_blur(const struct input *input, const struct lens_settings *settings,
                       struct blur_choice *choice)
{
    const struct refocus_depth_range range = {input->report.near_m, input->report.far_m};
    struct refocus_lens lens;

    *choice = (struct blur_choice){.f_number = NAN};
    if (!given(settings->f_number)) {
        choice->from = given(settings->blur) ? "pixels" : "default";
        choice->radius = choice->asked =
            given(settings->blur) ? settings->blur : default_blur(input);
        return EXIT_DONE;
    }
    if (range_is_known(input)) {
        choice->from = "lens";
        if (!choose_lens(input, settings, &lens))
            return report_failure(EXIT_FAILED, input->photo_name,
                                  "--f-number needs a focal length, which it does not say; give "
                                  "--focal-length and --sensor-width, or --blur");
        choice->asked = refocus_max_blur_radius(&lens, &range, input->photo->image.width);
    } else if (given(settings->focal_length)) {
        return report_failure(EXIT_FAILED, input->depth_name,
                              "--focal-length needs distances in metres, which it does "
                              "not say; give --near and --far, or leave it out");
    } else {
        blur_without_metres(input, settings->f_number, choice);
    }
    choice->radius = fmin(choice->asked, REFOCUS_MAX_BLUR_RADIUS);
    choice->f_number = choice->asked > choice->radius
                           ? settings->f_number * choice->asked / choice->radius
                           : settings->f_number;
    return EXIT_DONE;
}

/* One line, whether metres are missing, the blur is too large, or both. */
static void warn_of_blur(const struct input *input, const struct lens_settings *settings,
                         const struct blur_choice *choice)
{
    char limited[96] = "";

    if (choice->asked > choice->radius)
        snprintf(limited, sizeof limited, ", limited to %d, the most, which f/%.3g has",
                 (int)REFOCUS_MAX_BLUR_RADIUS, choice->f_number);
    if (choice->own > 0)
        report_warning("--f-number",
                       "%s says no distances in metres; f/%g gives %.1f pixels of blur%s, "
                       "by the %s of %.1f at f/%g; --near and --far give that of a lens",
                       input->depth_name, settings->f_number, choice->asked, limited,
                       strcmp(choice->from, "file") == 0 ? "file's own" : "default", choice->own,
                       choice->own_number);
    else if (limited[0])
        report_warning("--f-number", "f/%g gives %.0f pixels of blur%s", settings->f_number,
                       choice->asked, limited);
}

int input_blur(const struct input *input, const struct lens_settings *settings, double *blur)
{
    struct blur_choice choice;
    const int status = choose_blur(input, settings, &choice);

    if (status != EXIT_DONE)
        return status;
    warn_of_blur(input, settings, &choice);
    *blur = choice.radius;
    return EXIT_DONE;
}

int input_blur_and_f_number(const struct input *input, const struct lens_settings *settings,
                            double *blur, double *f_number)
{
    struct blur_choice choice;
    const int status = choose_blur(input, settings, &choice);

    *blur = choice.radius;
    *f_number = choice.f_number;
    return status;
}

json_t *input_blur_json(const struct input *input, const struct lens_settings *settings)
{
    struct blur_choice choice;

    if (choose_blur(input, settings, &choice) != EXIT_DONE)
        return json_object();
    return json_pack("{s:s, s:o}", "blur_from", choice.from, "f_number",
                     report_number_json(choice.f_number));
}

double input_surface_at(const uint16_t *disparity, int width, int height, int x, int y)
{
    const struct refocus_disparity map =
        refocus_disparity16(disparity, width, height, (ptrdiff_t)width * 2);
    float focus = 0;

    refocus_focus_at_point(&map, x, y, 0, &focus);
    return focus;
}

static int focus_in_rectangle(const struct input *input, const double rectangle[4],
                              const uint16_t *prepared, double *focus)
{
    const int width = input->photo->image.width, height = input->photo->image.height;
    const struct refocus_disparity map =
        refocus_disparity16(prepared, width, height, (ptrdiff_t)width * 2);
    float found = 0;

    if (refocus_focus_in_rectangle(&map, (int)rectangle[0], (int)rectangle[1], (int)rectangle[2],
                                   (int)rectangle[3], &found) != REFOCUS_OK)
        return report_failure(EXIT_WRONG, "--focus-rectangle",
                              "%g,%g,%g,%g does not lie within the %dx%d pixels of %s",
                              rectangle[0], rectangle[1], rectangle[2], rectangle[3], width, height,
                              input->photo_name);
    *focus = found;
    return EXIT_DONE;
}

static int focus_at_distance(const struct input *input, double metres, double *focus)
{
    const struct refocus_depth_range range = {input->report.near_m, input->report.far_m};

    if (!range_is_known(input))
        return report_failure(EXIT_FAILED, input->depth_name,
                              "--focus-distance needs distances in metres, which it "
                              "does not say; give --near and --far, or --focus or "
                              "--focus-at in its place");
    *focus = refocus_disparity_of_depth(&range, metres);
    if (!(*focus >= 0 && *focus <= 1))
        return report_failure(EXIT_WRONG, "--focus-distance",
                              "%g m lies outside of the depth of %s; give %g to %g m", metres,
                              input->depth_name, range.near_m, range.far_m);
    return EXIT_DONE;
}

int input_focus(const struct input *input, const struct lens_settings *settings,
                const uint16_t *prepared, double *focus)
{
    const int width = input->photo->image.width, height = input->photo->image.height;
    const struct refocus_photo_info *info = &input->photo->info;
    double x = width / 2, y = height / 2;

    if (given(settings->focus)) {
        *focus = settings->focus;
        return EXIT_DONE;
    }
    if (given(settings->focus_distance))
        return focus_at_distance(input, settings->focus_distance, focus);
    if (given(settings->focus_rectangle[0]))
        return focus_in_rectangle(input, settings->focus_rectangle, prepared, focus);
    if (given(settings->focus_at[0])) {
        x = settings->focus_at[0];
        y = settings->focus_at[1];
        if (!(x >= 0 && x < width && y >= 0 && y < height))
            return report_failure(EXIT_WRONG, "--focus-at",
                                  "%g,%g lies outside of %s; give 0,0 to %d,%d", x, y,
                                  input->photo_name, width - 1, height - 1);
    } else if (info->focus_x >= 0 && info->focus_x <= 1 && info->focus_y >= 0 &&
               info->focus_y <= 1 && (info->focus_x > 0 || info->focus_y > 0)) {
        x = fmin(info->focus_x * width, width - 1);
        y = fmin(info->focus_y * height, height - 1);
    }
    *focus = input_surface_at(prepared, width, height, (int)x, (int)y);
    return EXIT_DONE;
}
