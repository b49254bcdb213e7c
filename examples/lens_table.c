/* lens_table.c: what a lens does before anything is rendered: for some f-numbers how large the blur
 * gets, and from where to where a portrait is sharp.
 *
 * The photo is 1600 pixels wide and shows what a full-frame sensor sees through an 85 mm lens. The
 * scene reaches from 1.5 to 30 m, and the focus is at 2 m.
 *
 *     lens_table    prints the table
 */
#include <math.h>
#include <stdio.h>
#include <refocus/lens.h>

enum { WIDTH = 1600 };

static const struct refocus_depth_range range = {1.5, 30};
static const double focus_m = 2;

/* A circle of confusion of one pixel counts as sharp: an eye that resolves one pixel's angle, which
 * is 1 / s, s the focal length in pixels. */
static double acuity(const struct refocus_lens *lens)
{
    return refocus_focal_length_px(lens, WIDTH);
}

static void print_row(struct refocus_lens lens)
{
    const double K = refocus_max_blur_radius(&lens, &range, WIDTH);
    const double focus = refocus_disparity_of_depth(&range, focus_m);
    const double hyperfocal_m = refocus_hyperfocal_m(&lens, acuity(&lens));
    const struct refocus_depth_of_field sharp = refocus_depth_of_field_m(focus_m, hyperfocal_m);

    printf("f/%-4g  %5.1f mm  K = %5.1f px  the wall blurs by %5.1f px (%.3f mm on the sensor)  "
           "sharp from %.3f to %.3f m\n",
           lens.f_number, 2000 * refocus_aperture_radius_m(&lens), K,
           refocus_blur_radius(K, 0, focus),
           1000 * refocus_circle_of_confusion_m(&lens, focus_m, range.far_m), sharp.near_m,
           sharp.far_m);
}

int main(void)
{
    static const double f_numbers[] = {1.4, 2, 2.8, 4, 5.6, 8};
    struct refocus_lens lens = {.focal_length_mm = 85, .sensor_width_mm = 36};
    double f_number;

    for (size_t i = 0; i < sizeof f_numbers / sizeof *f_numbers; i++) {
        lens.f_number = f_numbers[i];
        print_row(lens);
    }
    f_number = refocus_f_number_of_blur(&lens, &range, WIDTH, 40);
    printf("A blur of K = 40 px is that of f/%.2f.\n", f_number);
    return isfinite(f_number) ? 0 : 1;
}
