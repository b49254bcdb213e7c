/* depth_of_field.c: what still looks sharp, by Potmesil & Chakravarty 1981, section 2.2.
 *
 * An eye resolves 1/1000 of a distance. Seen from where its perspective is right, which is s away,
 * the focal length in pixels, a photo looks sharp up to circles of confusion of s/1000. With H =
 * 1000 f/N that is the same as |1/z - 1/U| <= 1/H (eq. 5), and as |d - df| <= s/2000 K, which needs
 * no metres: f/8 at 50 mm focused at 1 m has H = 6.25 m, and limits 1/(1 + 0.16) = 0.862 m and
 * 1/(1 - 0.16) = 1.190 m. Where no focal length is known it is that of a normal lens, the diagonal.
 */
#include <math.h>
#include <stdio.h>
#include "commands/depth_of_field.h"
#include "line/report.h"

static const double acuity = 1000;

static void choose_lens(const struct input *input, const struct lens_settings *settings,
                        struct refocus_lens *lens, struct depth_of_field *field)
{
    field->from = !isnan(settings->focal_length) ? LENS_GIVEN : LENS_OF_FILE;
    if (!input_lens(input, settings, lens)) {
        lens->focal_length_mm = hypot(36, 24);
        field->from = LENS_NORMAL;
    }
    field->focal_length_mm = lens->focal_length_mm;
    lens->f_number = 1; /* until the blur says it */
}

int depth_of_field_find(const struct input *input, const struct lens_settings *settings,
                        const uint16_t *disparity, struct depth_of_field *field)
{
    const struct refocus_depth_range range = {input->report.near_m, input->report.far_m};
    const double width = input->photo->image->width;
    struct refocus_depth_of_field limits;
    struct refocus_lens lens;
    double reach;
    int status = input_blur(input, settings, &field->blur);

    if (status == EXIT_DONE)
        status = input_focus(input, settings, disparity, &field->focus);
    if (status != EXIT_DONE)
        return status;
    choose_lens(input, settings, &lens, field);
    field->sharp = refocus_focal_length_px(&lens, width) / acuity / 2;
    reach = field->blur > 0 ? field->sharp / field->blur : 1;
    field->nearest = fmin(field->focus + reach, 1);
    field->farthest = fmax(field->focus - reach, 0);
    lens.f_number = refocus_f_number_of_blur(&lens, &range, width, field->blur);
    field->f_number = lens.f_number;
    field->focus_m = refocus_depth_of_disparity(&range, field->focus);
    field->hyperfocal_m = refocus_hyperfocal_m(&lens, acuity);
    limits = refocus_depth_of_field_m(field->focus_m, field->hyperfocal_m);
    field->near_m = limits.near_m;
    field->far_m = limits.far_m;
    field->known = true;
    return EXIT_DONE;
}

static void print_limits(const struct depth_of_field *field)
{
    printf("%.4g m ", field->near_m);
    if (isfinite(field->far_m))
        printf("to %.4g m", field->far_m);
    else
        printf("and beyond");
    if (isfinite(field->focus_m))
        printf(", the depth of field about %.4g m\n", field->focus_m);
    else
        printf(", the depth of field about infinity\n");
}

void depth_of_field_print(const struct depth_of_field *field)
{
    static const char *const from[] = {"", " in 35 mm terms", ", as a normal lens has,"};

    if (!field->known)
        return;
    printf("sharp         ");
    if (!(field->blur > 0)) {
        puts("everything, for there is no blur");
    } else if (field->hyperfocal_m > 0) {
        print_limits(field);
        printf("hyperfocal    %.4g m, by %.4g mm%s at f/%.3g\n", field->hyperfocal_m,
               field->focal_length_mm, from[field->from], field->f_number);
    } else {
        printf("disparities %.3f to %.3f, the depth of field about %.3f by %.1f pixels of blur\n",
               field->farthest, field->nearest, field->focus, field->blur);
    }
}

json_t *depth_of_field_json(const struct depth_of_field *field)
{
    if (!field->known)
        return json_null();
    return json_pack(
        "{s:f, s:f, s:f, s:f, s:f, s:o, s:o, s:o, s:o, s:o, s:f}", "focus", field->focus, "blur",
        field->blur, "sharp_px", field->sharp, "nearest", field->nearest, "farthest",
        field->farthest, "focus_m", report_metres_json(field->focus_m), "near_m",
        report_metres_json(field->near_m), "far_m", report_metres_json(field->far_m),
        "hyperfocal_m", report_metres_json(field->hyperfocal_m), "f_number",
        report_number_json(field->f_number), "focal_length_mm", field->focal_length_mm);
}
