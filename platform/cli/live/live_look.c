/* live_look.c: the look of live pictures beside focus and blur, by the options that render has. */
#include "line/report.h"
#include "live/live_estimate.h"
#include "live/live_look.h"

const char live_look_no_metres[] = "--focus-distance and --f-number need a depth in metres; give "
                                   "--near and --far, or --focus and --blur";

bool live_look_needs_metres(const struct live_settings *settings)
{
    return !isnan(settings->lens.focus_distance) || !isnan(settings->lens.f_number);
}

int live_look_check(struct live_settings *settings)
{
    const struct lens_settings *const lens = &settings->lens;
    int status = input_check_lens(lens);

    if (status == EXIT_DONE)
        status = controls_check(&settings->engine.controls, input_focus_is_given(lens));
    if (status != EXIT_DONE)
        return status;
    if (!isnan(settings->engine.controls.focus_plane[0]))
        return report_failure(EXIT_WRONG, "--focus-plane",
                              "what is seen at three pixels changes in live; give --tilt-angle and "
                              "--tilt-line");
    if (!isnan(lens->f_number) && isnan(lens->focal_length))
        return report_failure(EXIT_WRONG, "--f-number",
                              "it goes with --focal-length in live; give that too");
    if (live_look_needs_metres(settings) && live_estimate_is_meant(settings->depth.file))
        return report_failure(EXIT_WRONG, settings->depth.file, "%s", live_look_no_metres);
    settings->engine.bokeh.f_number = lens->f_number;
    /* Frames have no time for either. With quality best refocus() splats thin structures of a
     * single picture, and puts the silhouettes of Y, U and V right. */
    settings->engine.no_thin = true;
    settings->engine.fill = FILL_SMOOTH;
    return EXIT_DONE;
}

int live_look_check_method(const struct live *live)
{
    struct refocus_settings params = live->engine->params;
    int status;

    params.render.max_blur_radius = (float)live->settings->blur_most;
    if (!isnan(live->engine->controls.tilt_angle))
        params.focus.tilt_across = 1; /* whatever the plane will be */
    status = controls_check_method(&params);
    return status == EXIT_DONE ? bokeh_check_method(&params, live->engine->has_sides) : status;
}

/* The places that options name have to be in the first frame; later ones may be smaller. */
static int check_places(struct live *live, int width, int height)
{
    const double *const box = live->settings->lens.focus_rectangle;
    const double *const at = live->settings->lens.focus_at;

    live_focus_size(&live->focus, width, height);
    if (!isnan(box[0]) && !live_focus_has_inside(&live->focus, box))
        return report_failure(EXIT_WRONG, "--focus-rectangle",
                              "%g,%g,%g,%g does not lie within the %dx%d pixels of the camera",
                              box[0], box[1], box[2], box[3], width, height);
    if (!isnan(at[0]) && !(at[0] >= 0 && at[0] < width && at[1] >= 0 && at[1] < height))
        return report_failure(EXIT_WRONG, "--focus-at",
                              "%g,%g lies outside of the %dx%d pixels of the camera; give 0,0 to "
                              "%d,%d",
                              at[0], at[1], width, height, width - 1, height - 1);
    return EXIT_DONE;
}

int live_look_place(struct live *live, int width, int height)
{
    static const struct refocus_depth_range one_dioptre = {1, INFINITY};
    const struct lens_settings *const lens = &live->settings->lens;
    struct refocus_settings aimed = live->engine->params;
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, width, height, 3 * (ptrdiff_t)width);
    int status = papers_place(&live->settings->engine.papers, &live->engine->params, width, height);

    if (status == EXIT_DONE && live->frames_rendered <= 1)
        status = check_places(live, width, height);
    if (status == EXIT_DONE)
        status = live_look_aim(live, &photo, &aimed);
    if (status == EXIT_DONE && !isnan(lens->f_number)) {
        const struct refocus_lens given = input_given_lens(lens, width, height);

        live_focus_lens(&live->focus, refocus_max_blur_radius(&given, &one_dioptre, width));
    }
    return status;
}

int live_look_aim(struct live *live, const struct refocus_image *photo,
                  struct refocus_settings *params)
{
    const struct engine *const engine = live->engine;
    const double *const at = live->settings->lens.focus_at;
    const struct refocus_disparity size =
        refocus_disparity16(NULL, photo->width, photo->height, 2 * (ptrdiff_t)photo->width);
    struct controls aimed = engine->controls;
    double looked_at[2];

    live_focus_looked_at(&live->focus, looked_at);
    papers_suit(&live->settings->engine.papers, looked_at, photo->width, photo->height, params);
    params->field.disparity = isnan(engine->field_disparity) ? params->render.focus_disparity
                                                             : (float)engine->field_disparity;
    if (!isnan(at[0]))
        controls_turn_about(&aimed, photo, fmin(fmax(at[1], 0), photo->height - 1));
    return controls_aim(&aimed, params, &size);
}

bool live_look_takes_yuv(const struct engine *engine)
{
    const struct refocus_settings *const params = &engine->params;

    return refocus_method_traits(params->render.method) & REFOCUS_METHOD_TAKES_YUV &&
           params->look.cat_eye == 0 && params->look.fringe == 0 && params->look.grain == 0 &&
           params->look.star_spikes == 0 && !engine->has_sides;
}
