/* views.c: the picture of `refocus render --view` is made. */
#include <stdlib.h>
#include "views/falsecolour.h"
#include "views/moved.h"
#include "views/peaking.h"
#include "views/stereo_views.h"
#include "views/views.h"

const struct option_word view_words[] = {
    {"none", "the refocused photo"},
    {"depth", "the disparities, with metres where they are known"},
    {"blur", "the blur radii, with lines where they are half a pixel"},
    {"overlay", "the disparities over the photo"},
    {"peaking", "the photo in grey, its edges in focus in green"},
    {"anaglyph", "what two eyes see, for glasses of red and cyan"},
    {"edges",
     "the photo in grey; orange and blue where edges of the depth went nearer and farther"},
    {0}};

static int lost(int status)
{
    return status == REFOCUS_OK
               ? EXIT_DONE
               : report_failure(EXIT_FAILED, "--view", "%s", refocus_strerror(status));
}

/* The limits of what is sharp, K |d - df| = 1/2 pixel, unless there are others: where
 * more than 1/16 of the picture has another blur than K |d - df|. Along depth edges
 * some have: pixels that mix two surfaces are given the disparity of one of them. */
static bool find_limits(const struct shot *shot, const uint16_t *blur, const uint16_t *disparity,
                        struct blur_limits *limits)
{
    const struct refocus_image *photo = shot->input.photo->image;
    const double most = (double)shot->engine.params.render.max_blur_radius;
    const double focus = (double)shot->engine.params.render.focus_disparity;
    const size_t pixels = (size_t)photo->width * (size_t)photo->height;
    size_t others = 0;

    for (size_t i = 0; i < pixels; i++)
        others += fabs(256 * most * fabs(disparity[i] / 65535.0 - focus) - blur[i]) > 2;
    if (!(most > 0) || others > pixels / 16)
        return false;
    limits->near_disparity = focus + 0.5 / most;
    limits->far_disparity = focus - 0.5 / most;
    return true;
}

static void draw_edges(const struct shot *shot, const uint16_t *disparity,
                       const struct refocus_image *out)
{
    const struct input *input = &shot->input;
    const struct refocus_disparity given = refocus_disparity16(
        input->disparity, input->width, input->height, 2 * (ptrdiff_t)input->width);

    moved_draw(input->photo->image, disparity, shot->engine.places_edges ? &given : NULL, out);
}

static int make_view(const struct shot *shot, struct refocus_image *out, int view)
{
    const struct refocus_image *photo = shot->input.photo->image;
    const int width = photo->width, height = photo->height;
    const size_t pixels = (size_t)width * (size_t)height;
    const struct refocus_depth_range known = {shot->input.report.near_m, shot->input.report.far_m};
    const struct refocus_depth_range *range =
        known.near_m > 0 && known.far_m > known.near_m ? &known : NULL;
    uint16_t *disparity = malloc(pixels * sizeof *disparity);
    uint16_t *blur = malloc(pixels * sizeof *blur);
    struct refocus_image made = {0};
    struct blur_limits limits;
    int status = disparity && blur ? REFOCUS_OK : REFOCUS_ERR_MEMORY;

    if (status == REFOCUS_OK)
        status = refocus_get_view(shot->engine.renderer, REFOCUS_VIEW_DISPARITY, disparity,
                                  (ptrdiff_t)width * 2);
    if (status == REFOCUS_OK)
        status =
            refocus_get_view(shot->engine.renderer, REFOCUS_VIEW_BLUR, blur, (ptrdiff_t)width * 2);
    if (status == REFOCUS_OK && view == VIEW_PEAKING) {
        peaking_draw(photo, blur, out);
    } else if (status == REFOCUS_OK && view == VIEW_EDGES) {
        draw_edges(shot, disparity, out);
    } else if (status == REFOCUS_OK) {
        if (view == VIEW_BLUR)
            made = falsecolour_blur(blur, disparity, width, height,
                                    (double)shot->engine.params.render.max_blur_radius, range,
                                    find_limits(shot, blur, disparity, &limits) ? &limits : NULL);
        else
            made = falsecolour_depth(disparity, width, height, range,
                                     view == VIEW_OVERLAY ? photo : NULL);
        status = made.plane[0] ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    }
    if (made.plane[0]) {
        free(out->plane[0]);
        *out = made;
    }
    free(disparity);
    free(blur);
    return lost(status);
}

/* The left eye in red over the right one: things in focus lie in the plane of the
 * screen. */
static int make_anaglyph(struct shot *shot, const struct refocus_image *out, double parallax)
{
    const double apart = isnan(parallax) ? fmin(out->width / 50.0, STEREO_MOST) : parallax;
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    struct refocus_image left = *out;
    struct stereo stereo;
    int status = stereo_open(&stereo, shot);

    left.plane[0] = malloc(pixels * 3);
    if (status == EXIT_DONE && !left.plane[0])
        status = lost(REFOCUS_ERR_MEMORY);
    if (status == EXIT_DONE)
        status = stereo_render(&stereo, shot, apart / 2, &left);
    if (status == EXIT_DONE)
        status = stereo_render(&stereo, shot, -apart / 2, out);
    for (size_t i = 0; i < pixels && status == EXIT_DONE; i++)
        out->plane[0][3 * i] = left.plane[0][3 * i];
    free(left.plane[0]);
    stereo_close(&stereo);
    return status;
}

int views_render(struct shot *shot, struct refocus_image *out, int view, double parallax,
                 int repeat)
{
    int status;

    if (view == VIEW_ANAGLYPH)
        return make_anaglyph(shot, out, parallax);
    status = engine_render(&shot->engine, out, repeat);
    if (status == EXIT_DONE && view != VIEW_NONE)
        status = make_view(shot, out, view);
    return status;
}
