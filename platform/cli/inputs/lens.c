/* lens.c: focus and blur are found by the options, the photo's own facts and its depth. */
#include <stdio.h>
#include <string.h>
#include "inputs/lens.h"
#include "inputs/subject.h"
#include "line/report.h"

static bool given(double value)
{
    return !isnan(value);
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

static bool range_is_known(const struct input *input)
{
    return input->report.near_m > 0 && input->report.far_m > input->report.near_m;
}

static double larger_side(const struct refocus_image *image)
{
    return image->width > image->height ? image->width : image->height;
}

struct refocus_lens input_given_lens(const struct lens_settings *settings, int width, int height)
{
    const double larger = width > height ? width : height;

    return (struct refocus_lens){.focal_length_mm = settings->focal_length,
                                 .f_number = settings->f_number,
                                 .sensor_width_mm = given(settings->sensor_width)
                                                        ? settings->sensor_width
                                                        : 36 * width / larger};
}

bool input_lens(const struct input *input, const struct lens_settings *settings,
                struct refocus_lens *lens)
{
    const double width = input->photo->image->width, height = input->photo->image->height;

    lens->f_number = settings->f_number;
    if (given(settings->focal_length)) {
        *lens = input_given_lens(settings, input->photo->image->width, input->photo->image->height);
        return true;
    }
    /* 35 mm terms compare diagonals: that of 36 x 24 mm with the picture's. */
    lens->focal_length_mm = input->photo->info->focal_length_35mm;
    lens->sensor_width_mm =
        sqrt(36.0 * 36 + 24 * 24) * width / sqrt(width * width + height * height);
    return lens->focal_length_mm > 0;
}

/* K by the settings, and how it was found. */
struct blur_choice {
    double radius, asked;   /* pixels: that is taken, and that of the f-number */
    double f_number;        /* the one that gives `radius`; NAN: none does */
    double own, own_number; /* without metres or lens: what stands for which f-number */
    const char *from;       /* "pixels", "lens", "file" or "default" */
};

/* The blur of 50 mm at f/2 on full frame, from 0.87 m to far away. */
static double usual_blur(const struct input *input)
{
    return fmin(larger_side(input->photo->image) / 50, REFOCUS_PLAIN_BLUR_RADIUS);
}

/* The largest blur radius that the renderer will be made for at most. */
static double most_blur(const struct input *input)
{
    return input->most_blur > 0 ? input->most_blur : REFOCUS_MAX_BLUR_RADIUS;
}

/* f-numbers of files may be anything. */
static bool is_f_number(double number)
{
    return number >= 0.5 && number <= 64;
}

/* Without metres, or a focal length, a lens has no blur. A file's own blur, or the default, stands
 * for the f-number that the file names, else for f/2 as most phones have it, and others are more or
 * less of it: K is as 1/N. */
static void blur_without_lens(const struct input *input, double f_number,
                              struct blur_choice *choice)
{
    static const double usual = 2;
    const struct refocus_photo_info *info = input->depth_from->info;

    if (info->own_blur > 0) {
        choice->from = "file";
        choice->own = info->own_blur * larger_side(input->photo->image);
        choice->own_number = info->f_number;
    } else {
        choice->from = "default";
        choice->own = usual_blur(input);
        choice->own_number = info->simulated_f_number;
    }
    if (!is_f_number(choice->own_number))
        choice->own_number = usual;
    choice->asked = choice->own * choice->own_number / f_number;
}

/* Without an option: the blur that the file names, or that of the f-number which its phone
 * simulates, else the usual one. */
static void choose_default(const struct input *input, struct blur_choice *choice)
{
    const struct refocus_depth_range range = {input->report.near_m, input->report.far_m};
    const struct refocus_photo_info *info = input->depth_from ? input->depth_from->info : NULL;
    struct lens_settings simulated = LENS_SETTINGS_NONE;
    struct refocus_lens lens;

    simulated.f_number = info ? info->simulated_f_number : 0;
    choice->from = "file";
    if (info && info->own_blur > 0) {
        choice->asked = info->own_blur * larger_side(input->photo->image);
    } else if (is_f_number(simulated.f_number) && range_is_known(input) &&
               input_lens(input, &simulated, &lens)) {
        choice->f_number = simulated.f_number;
        choice->asked = refocus_max_blur_radius(&lens, &range, input->photo->image->width);
    } else {
        choice->from = "default";
        choice->asked = usual_blur(input);
    }
    choice->radius = fmin(choice->asked, REFOCUS_PLAIN_BLUR_RADIUS);
    if (choice->radius < choice->asked)
        choice->f_number *= choice->asked / choice->radius;
}

void input_default_blur(const struct input *input, double *blur, char why[INPUT_WHY])
{
    struct blur_choice choice = {.f_number = NAN};

    choose_default(input, &choice);
    *blur = choice.radius;
    if (strcmp(choice.from, "default") == 0)
        snprintf(why, INPUT_WHY, "1/50 of the larger side, for the file names no blur");
    else if (given(choice.f_number))
        snprintf(why, INPUT_WHY, "the f/%.3g that its phone simulates", choice.f_number);
    else
        snprintf(why, INPUT_WHY, "the blur that the file names");
}

static int choose_blur(const struct input *input, const struct lens_settings *settings,
                       struct blur_choice *choice)
{
    const struct refocus_depth_range range = {input->report.near_m, input->report.far_m};
    struct refocus_lens lens;

    *choice = (struct blur_choice){.f_number = NAN};
    if (given(settings->blur) && settings->blur > most_blur(input))
        return report_failure(
            EXIT_WRONG, "--blur",
            "%g pixels are more than %g, the most of view, serve and all methods but sweep",
            settings->blur, most_blur(input));
    if (given(settings->blur)) {
        choice->from = "pixels";
        choice->radius = choice->asked = settings->blur;
        return EXIT_DONE;
    }
    if (!given(settings->f_number)) {
        choose_default(input, choice);
        return EXIT_DONE;
    }
    if (range_is_known(input)) {
        choice->from = "lens";
        if (input_lens(input, settings, &lens))
            choice->asked = refocus_max_blur_radius(&lens, &range, input->photo->image->width);
        else
            blur_without_lens(input, settings->f_number, choice);
    } else if (given(settings->focal_length)) {
        return report_failure(EXIT_FAILED, input->depth_name,
                              "--focal-length needs distances in metres, which it does "
                              "not say; give --near and --far, or leave it out");
    } else {
        blur_without_lens(input, settings->f_number, choice);
    }
    choice->radius = fmin(choice->asked, most_blur(input));
    choice->f_number = choice->asked > choice->radius
                           ? settings->f_number * choice->asked / choice->radius
                           : settings->f_number;
    return EXIT_DONE;
}

/* Print one line about an f-number that was asked for, whether metres are missing, the blur is too
 * large, or both. */
static void warn_of_blur(const struct input *input, const struct lens_settings *settings,
                         const struct blur_choice *choice)
{
    const bool metres = range_is_known(input);
    char limited[96] = "";

    if (choice->asked > choice->radius)
        snprintf(limited, sizeof limited, ", limited to %d, the most, which f/%.3g has",
                 (int)most_blur(input), choice->f_number);
    if (!given(settings->f_number))
        return;
    if (choice->own > 0)
        report_warning(
            "--f-number",
            "%s says no %s; f/%g gives %.1f pixels of blur%s, by the %s of %.1f at "
            "f/%g; %s that of a lens",
            metres ? input->photo_name : input->depth_name,
            metres ? "focal length" : "distances in metres", settings->f_number, choice->asked,
            limited, strcmp(choice->from, "file") == 0 ? "file's own" : "default", choice->own,
            choice->own_number, metres ? "--focal-length gives" : "--near and --far give");
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
    const int width = input->photo->image->width, height = input->photo->image->height;
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
                              "--focus-distance needs distances in metres, which it does not say; "
                              "give --near and --far, or --focus or --focus-at in its place");
    *focus = refocus_disparity_of_depth(&range, metres);
    if (!(*focus >= 0 && *focus <= 1))
        return report_failure(EXIT_WRONG, "--focus-distance",
                              "%g m lies outside of the depth of %s; give %g to %g m", metres,
                              input->depth_name, range.near_m, range.far_m);
    return EXIT_DONE;
}

void input_focus_point(const struct input *input, const struct lens_settings *settings,
                       double at[2])
{
    const int width = input->photo->image->width, height = input->photo->image->height;
    const struct refocus_photo_info *info = input->photo->info;
    const double *const rectangle = settings->focus_rectangle;

    at[0] = at[1] = NAN;
    if (given(settings->focus) || given(settings->focus_distance))
        return;
    if (given(rectangle[0])) {
        at[0] = fmin(floor(rectangle[0] + rectangle[2] / 2), width - 1);
        at[1] = fmin(floor(rectangle[1] + rectangle[3] / 2), height - 1);
    } else if (given(settings->focus_at[0])) {
        at[0] = settings->focus_at[0];
        at[1] = settings->focus_at[1];
    } else if (info->focus_x >= 0 && info->focus_x <= 1 && info->focus_y >= 0 &&
               info->focus_y <= 1 && (info->focus_x > 0 || info->focus_y > 0)) {
        at[0] = floor(fmin(info->focus_x * width, width - 1));
        at[1] = floor(fmin(info->focus_y * height, height - 1));
    }
}

int input_focus(const struct input *input, const struct lens_settings *settings,
                const uint16_t *prepared, double *focus)
{
    const int width = input->photo->image->width, height = input->photo->image->height;
    const struct refocus_photo_info *info = input->photo->info;
    double at[2];

    if (given(settings->focus)) {
        *focus = settings->focus;
        return EXIT_DONE;
    }
    if (given(settings->focus_distance))
        return focus_at_distance(input, settings->focus_distance, focus);
    if (given(settings->focus_rectangle[0]))
        return focus_in_rectangle(input, settings->focus_rectangle, prepared, focus);
    input_focus_point(input, settings, at);
    if (given(settings->focus_at[0])) {
        if (!(at[0] >= 0 && at[0] < width && at[1] >= 0 && at[1] < height))
            return report_failure(EXIT_WRONG, "--focus-at",
                                  "%g,%g lies outside of %s; give 0,0 to %d,%d", at[0], at[1],
                                  input->photo_name, width - 1, height - 1);
    } else if (given(at[0])) {
        /* the file says where */
    } else if (info->focus_distance > 0 && input->depth_from == input->photo &&
               range_is_known(input)) {
        const struct refocus_depth_range range = {input->report.near_m, input->report.far_m};

        *focus = fmin(fmax(refocus_disparity_of_depth(&range, info->focus_distance), 0), 1);
        return EXIT_DONE;
    } else {
        *focus = input_surface_at(prepared, width, height, width / 2, height / 2);
        input_find_subject(prepared, width, height, *focus, focus);
        return EXIT_DONE;
    }
    *focus = input_surface_at(prepared, width, height, (int)at[0], (int)at[1]);
    return EXIT_DONE;
}
