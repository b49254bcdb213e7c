/* controls.c: focus beyond a plain lens is set up from options: a wider, tilted or painted zone in
 * focus, and limits of the blur. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "shot/controls.h"
#include "shot/papers.h"
#include "line/report.h"

static bool given(double value)
{
    return !isnan(value);
}

static void take(float *to, double from)
{
    if (given(from))
        *to = (float)from;
}

static int wrong_bands(const char *text)
{
    return report_failure(EXIT_WRONG, "--also-focus",
                          "'%s' cannot be used; give up to %d bands D, D:W or D:W:T "
                          "with commas, each number from 0 to 1",
                          text, REFOCUS_MAX_BANDS - 1);
}

/* "0.2,0.7:0.05,0.9:0.02:0.1" */
static int parse_bands(const char *text, struct refocus_settings *params)
{
    const char *at = text;

    for (;;) {
        float value[3] = {0, params->focus.half_width, params->focus.transition};

        if (params->focus.bands == REFOCUS_MAX_BANDS - 1)
            return wrong_bands(text);
        for (int i = 0; i < 3; i++) {
            char *end;
            const double number = strtod(at, &end);

            if (end == at || strspn(at, "+-.0123456789eE") < (size_t)(end - at) ||
                !(number >= 0 && number <= 1))
                return wrong_bands(text);
            value[i] = (float)number;
            if (i == 1)
                value[2] = value[1];
            at = end;
            if (*at != ':')
                break;
            at++;
            if (i == 2)
                return wrong_bands(text);
        }
        params->focus.band[params->focus.bands++] =
            (struct refocus_band){value[0], value[1], value[2]};
        if (*at == '\0')
            return EXIT_DONE;
        if (*at++ != ',')
            return wrong_bands(text);
    }
}

static int read_map(const char *file, struct refocus_disparity *map,
                    const struct refocus_disparity **to)
{
    int width, height;
    uint8_t *grey;

    if (!file)
        return EXIT_DONE;
    grey = papers_read_grey(file, &width, &height);
    if (!grey)
        return EXIT_FAILED;
    *map = refocus_disparity8(grey, width, height, width);
    *to = map;
    return EXIT_DONE;
}

int controls_check(const struct control_settings *s, bool focus_given)
{
    if (given(s->focus_plane[0]) && focus_given)
        return report_failure(EXIT_WRONG, "--focus-plane",
                              "the focus is given twice; leave --focus-plane or the "
                              "other --focus... out");
    if (given(s->focus_plane[0]) && (given(s->tilt_line[0]) || given(s->tilt_angle)))
        return report_failure(EXIT_WRONG, "--focus-plane",
                              "the plane is given twice; give --focus-plane, or "
                              "--tilt-angle and --tilt-line");
    if (given(s->tilt_line[0]) && !given(s->tilt_angle))
        return report_failure(EXIT_WRONG, "--tilt-line",
                              "it goes with --tilt-angle; give that too");
    if (s->far_clamp > s->near_clamp)
        return report_failure(EXIT_WRONG, "--far-clamp",
                              "%g is nearer than --near-clamp %g; give a number from 0 to %g",
                              s->far_clamp, s->near_clamp, s->near_clamp);
    return EXIT_DONE;
}

int controls_apply(const struct control_settings *s, struct refocus_settings *params,
                   struct controls *controls)
{
    int status = EXIT_DONE;

    memcpy(controls->focus_plane, s->focus_plane, sizeof controls->focus_plane);
    memcpy(controls->tilt_line, s->tilt_line, sizeof controls->tilt_line);
    controls->tilt_angle = s->tilt_angle;
    take(&params->focus.half_width, s->focus_width);
    take(&params->focus.transition,
         given(s->focus_transition) ? s->focus_transition : s->focus_width);
    if (given(s->tilt_compress))
        params->focus.depth_share = (float)(1 - s->tilt_compress);
    take(&params->focus.least_disparity, s->far_clamp);
    take(&params->focus.most_disparity, s->near_clamp);
    take(&params->focus.blur_limit, s->blur_limit);
    if (s->also_focus)
        status = parse_bands(s->also_focus, params);
    if (status == EXIT_DONE)
        status = read_map(s->focus_map, &controls->focus_map, &params->focus.map);
    if (status == EXIT_DONE)
        status = read_map(s->sharp_mask, &controls->sharp_mask, &params->focus.sharp_map);
    return status;
}

static int outside(const char *name, double x, double y, const struct refocus_disparity *prepared)
{
    return report_failure(EXIT_WRONG, name, "%g,%g lies outside of the picture; give 0,0 to %d,%d",
                          x, y, (int)prepared->width - 1, (int)prepared->height - 1);
}

static bool is_inside(const double at[2], const struct refocus_disparity *prepared)
{
    return at[0] <= prepared->width - 1 && at[1] <= prepared->height - 1;
}

/* The middle of a pixel in parts of width and height. */
static struct refocus_focus_point point_at(const double at[2], float disparity,
                                           const struct refocus_disparity *prepared)
{
    return (struct refocus_focus_point){(float)((at[0] + 0.5) / prepared->width),
                                        (float)((at[1] + 0.5) / prepared->height), disparity};
}

static void tilt(struct refocus_settings *params, const struct refocus_focus_plane *plane)
{
    params->focus.tilt_x = plane->x;
    params->focus.tilt_y = plane->y;
    params->focus.tilt_across = plane->across;
    params->focus.tilt_down = plane->down;
    params->render.focus_disparity = plane->focus_disparity;
}

static int aim_by_points(const struct controls *controls, struct refocus_settings *params,
                         const struct refocus_disparity *prepared)
{
    struct refocus_focus_point point[3];
    struct refocus_focus_plane plane;

    for (int i = 0; i < 3; i++) {
        const double *at = controls->focus_plane + 2 * i;
        float disparity;

        if (!is_inside(at, prepared))
            return outside("--focus-plane", at[0], at[1], prepared);
        if (refocus_focus_at_point(prepared, (int)at[0], (int)at[1], 0, &disparity) != REFOCUS_OK)
            return outside("--focus-plane", at[0], at[1], prepared);
        point[i] = point_at(at, disparity, prepared);
    }
    if (refocus_focus_plane_of_points(&plane, point) != REFOCUS_OK)
        return report_failure(EXIT_WRONG, "--focus-plane",
                              "the three pixels lie on one line, or nearly; give others");
    tilt(params, &plane);
    return EXIT_DONE;
}

static int aim_by_line(const struct controls *controls, struct refocus_settings *params,
                       const struct refocus_disparity *prepared)
{
    const double y = (prepared->height - 1) / 2.0;
    const double level[4] = {0, y, prepared->width - 1.0, y};
    const double *line = given(controls->tilt_line[0]) ? controls->tilt_line : level;
    const struct refocus_focus_point from =
        point_at(line, params->render.focus_disparity, prepared);
    const struct refocus_focus_point to =
        point_at(line + 2, params->render.focus_disparity, prepared);
    struct refocus_focus_plane plane;

    for (int i = 0; i < 4; i += 2)
        if (!is_inside(line + i, prepared))
            return outside("--tilt-line", line[i], line[i + 1], prepared);
    if (refocus_focus_plane_of_line(&plane, &from, &to, (double)prepared->height / prepared->width,
                                    controls->tilt_angle) != REFOCUS_OK)
        return report_failure(EXIT_WRONG, "--tilt-line",
                              "both its ends are at one pixel; give two");
    tilt(params, &plane);
    return EXIT_DONE;
}

void controls_turn_about(struct controls *controls, const struct refocus_image *photo, double y)
{
    const double line[4] = {0, y, photo->width - 1, y};

    if (given(controls->tilt_angle) && !given(controls->tilt_line[0]))
        memcpy(controls->tilt_line, line, sizeof line);
}

int controls_aim(const struct controls *controls, struct refocus_settings *params,
                 const struct refocus_disparity *prepared)
{
    if (given(controls->focus_plane[0]))
        return aim_by_points(controls, params, prepared);
    if (given(controls->tilt_angle))
        return aim_by_line(controls, params, prepared);
    return EXIT_DONE;
}

bool controls_suit_method(const struct refocus_settings *p)
{
    const bool any = p->field.shape != REFOCUS_FIELD_LENS || p->focus.half_width > 0 ||
                     p->focus.bands > 0 || p->focus.tilt_across != 0 || p->focus.tilt_down != 0 ||
                     p->focus.depth_share != 1 || p->focus.map || p->focus.sharp_map ||
                     p->focus.least_disparity > 0 || p->focus.most_disparity < 1 ||
                     p->focus.blur_limit < p->render.max_blur_radius;

    return !any || (refocus_method_traits(p->render.method) & REFOCUS_METHOD_ANY_FOCUS);
}

int controls_check_method(const struct refocus_settings *p)
{
    char words[METHOD_WORDS];

    if (controls_suit_method(p))
        return EXIT_DONE;
    return report_failure(
        EXIT_WRONG, "--method", "%s knows the focus of a plain lens only; give %s",
        refocus_method_name(p->render.method), method_words(words, REFOCUS_METHOD_ANY_FOCUS, true));
}

void controls_free(struct controls *controls)
{
    free((void *)controls->focus_map.samples);
    free((void *)controls->sharp_mask.samples);
}
