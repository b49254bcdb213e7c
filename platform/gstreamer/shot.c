/* shot.c: what is in focus and how much is blurred follows from the settings, and it is rendered.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "frame.h"
#include "shot.h"

/* Small changes of the light of highlights from frame to frame are reduced by this part, as by
 * `refocus live`. */
#define STEADY_LIGHT 0.8f

static int fail(struct refocus_reason *reason, int status, const char *text)
{
    snprintf(reason->text, sizeof reason->text, "%s", text);
    return status;
}

static bool is_known(const struct refocus_depth_range *range)
{
    return range->near_m > 0 && range->far_m > range->near_m;
}

/* The focus goes to the surface at a place with this time constant, as by the rectangle of
 * `refocus live`: the noise of single maps would make it pump. */
static const double settle_s = 0.08;

/* Focus on the surface at the place of the settings: at once for the first time, and where the
 * frame does not follow on the last. */
static int find_surface(struct rf_gst_shot *shot, const struct rf_gst_settings *settings,
                        const struct rf_gst_depths *depths, float *focus)
{
    const struct refocus_disparity *const map = &depths->disparity;
    const struct rf_gst_aim aim = {settings->focus_x, settings->focus_y, depths->range, shot->time};
    const struct rf_gst_aim *const last = &shot->aim;
    const bool goes_on = shot->aimed && !shot->cut && aim.x == last->x && aim.y == last->y &&
                         aim.range.near_m == last->range.near_m &&
                         aim.range.far_m == last->range.far_m &&
                         GST_CLOCK_TIME_IS_VALID(aim.time) && GST_CLOCK_TIME_IS_VALID(last->time);
    const int status =
        refocus_focus_at_point(map, (int)fmin(aim.x * map->width, map->width - 1),
                               (int)fmin(aim.y * map->height, map->height - 1), 0, focus);

    if (status != REFOCUS_OK)
        return status;
    if (goes_on)
        *focus += (shot->surface - *focus) *
                  (float)exp(-(double)(aim.time - last->time) / GST_SECOND / settle_s);
    shot->surface = *focus;
    shot->aim = aim;
    shot->aimed = true;
    return REFOCUS_OK;
}

static int find_focus(struct rf_gst_shot *shot, const struct rf_gst_settings *settings,
                      const struct rf_gst_depths *depths, float *focus,
                      struct refocus_reason *reason)
{
    const bool at_place =
        !(settings->focus_distance > 0) && settings->focus_x >= 0 && settings->focus_y >= 0;

    shot->aimed &= at_place;
    *focus = (float)settings->focus;
    if (settings->focus_distance > 0) {
        if (!is_known(&depths->range))
            return fail(reason, REFOCUS_ERR_ARGUMENT,
                        "focus-distance needs the metres between which the depth lies: give near "
                        "and far");
        *focus = (float)fmin(
            fmax(refocus_disparity_of_depth(&depths->range, settings->focus_distance), 0), 1);
    }
    return at_place ? find_surface(shot, settings, depths, focus) : REFOCUS_OK;
}

/* The greatest blur of a method. */
static double most_blur(const struct rf_gst_settings *settings)
{
    return refocus_method_traits((uint32_t)settings->method) & REFOCUS_METHOD_ANY_RADIUS
               ? REFOCUS_MAX_BLUR_RADIUS
               : REFOCUS_PLAIN_BLUR_RADIUS;
}

static int find_blur(const struct rf_gst_settings *settings, const struct rf_gst_depths *depths,
                     int32_t width, float *blur, struct refocus_reason *reason)
{
    const struct refocus_lens lens = {settings->focal_length, settings->f_number,
                                      settings->sensor_width};
    double radius = settings->blur;

    if (settings->f_number > 0) {
        if (!is_known(&depths->range))
            return fail(reason, REFOCUS_ERR_ARGUMENT,
                        "f-number needs the metres between which the depth lies: give near and "
                        "far, or blur instead");
        radius = refocus_max_blur_radius(&lens, &depths->range, width);
    }
    *blur = (float)radius;
    return REFOCUS_OK;
}

/* A blur that grows makes a new renderer, so it is made for more than is asked for. */
static float room_for(float blur)
{
    static const float steps[] = {40, REFOCUS_PLAIN_BLUR_RADIUS, 236, 472};

    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        if (blur <= steps[i])
            return steps[i];
    return REFOCUS_MAX_BLUR_RADIUS;
}

/* Whether half-covered pixels of silhouettes are told, which has no time but with the best quality.
 * Frames of R, G and B would get thin structures as well, which flicker. */
static bool has_silhouettes(const struct rf_gst_settings *settings,
                            const struct refocus_image *photo)
{
    return rf_gst_quality_is_best(settings->quality) && refocus_format_is_yuv(photo->format) &&
           !rf_gst_is_deep(photo);
}

static int fit(struct rf_gst_shot *shot, const struct rf_gst_settings *settings,
               const struct refocus_image *photo, float blur, struct refocus_reason *reason)
{
    const int32_t width = photo->width, height = photo->height;
    struct refocus_renderer_params params =
        refocus_renderer_params_default(width, height, room_for(blur));
    int status;

    params.threads = settings->threads;
    params.papers = refocus_papers();
    params.deep = rf_gst_is_deep(photo);
    params.methods = REFOCUS_METHOD_BIT((uint32_t)settings->method);
    params.thin = has_silhouettes(settings, photo);
    params.depth_edges = settings->place_edges ? REFOCUS_DEPTH_EDGES_STEADY : 0;
    if (shot->renderer && width <= shot->made.max_width && height <= shot->made.max_height &&
        blur <= shot->made.max_blur_radius && params.threads == shot->made.threads &&
        params.methods == shot->made.methods && params.depth_edges == shot->made.depth_edges &&
        params.deep == shot->made.deep && params.thin == shot->made.thin)
        return REFOCUS_OK;
    refocus_renderer_destroy(&shot->renderer);
    status = refocus_renderer_create(&shot->renderer, &params);
    if (status != REFOCUS_OK)
        snprintf(reason->text, sizeof reason->text,
                 "%s: frames of %dx%d pixels with blur up to %.4g need %.0f MiB",
                 refocus_strerror(status), (int)width, (int)height, (double)params.max_blur_radius,
                 (double)refocus_renderer_memory(&params) / (1 << 20));
    shot->made = params;
    return status;
}

static int fit_aperture(struct rf_gst_shot *shot, const struct rf_gst_settings *settings,
                        struct refocus_reason *reason)
{
    int status;

    if (shot->shape_number == settings->shape_number)
        return REFOCUS_OK;
    if (!settings->shape_known) {
        snprintf(reason->text, sizeof reason->text,
                 "aperture '%.60s' is not known; give disc, polygon:BLADES, "
                 "polygon:BLADES:DEGREES, heart, star or star:POINTS, of 3 to 16",
                 settings->aperture);
        return REFOCUS_ERR_ARGUMENT;
    }
    refocus_aperture_destroy(&shot->aperture);
    status = refocus_aperture_create(&shot->aperture, &settings->shape);
    if (status == REFOCUS_OK)
        shot->shape_number = settings->shape_number;
    return status;
}

/* The parameters of a render, by the settings. */
static struct refocus_settings params_of(const struct rf_gst_shot *shot,
                                         const struct rf_gst_settings *settings, float focus,
                                         float blur)
{
    struct refocus_settings params = refocus_settings_default(focus, blur);
    const uint32_t traits = refocus_method_traits((uint32_t)settings->method);

    params.render.method = (uint32_t)settings->method;
    params.render.rays = rf_gst_quality_rays(settings->quality);
    if (!(traits & REFOCUS_METHOD_DISC_ONLY))
        params.render.aperture = shot->aperture;
    if (settings->highlights >= 1)
        params.highlights.gain = (float)settings->highlights;
    else if (traits & REFOCUS_METHOD_HIGHLIGHTS)
        params.highlights.estimate = 1;
    /* A render without it forgets the frame before. */
    params.highlights.steady = shot->cut ? 0 : STEADY_LIGHT;
    return params;
}

void rf_gst_shot_forget(struct rf_gst_shot *shot)
{
    shot->cut = shot->begun;
}

/* A frame from before the last, or more than a second after it, shows another moment. */
static void follow_time(struct rf_gst_shot *shot, GstClockTime time)
{
    if (GST_CLOCK_TIME_IS_VALID(time) && GST_CLOCK_TIME_IS_VALID(shot->time) &&
        (time < shot->time || time - shot->time > GST_SECOND))
        rf_gst_shot_forget(shot);
    shot->time = time;
}

int rf_gst_shot_take(struct rf_gst_shot *shot, const struct rf_gst_settings *settings,
                     const struct rf_gst_depths *depths, GstClockTime time,
                     const struct refocus_image *photo, const struct refocus_image *out,
                     struct refocus_reason *reason)
{
    struct refocus_scene scene = refocus_scene_default(photo, &depths->disparity);
    struct refocus_settings params;
    float focus = 0, blur = 0;
    int status;

    follow_time(shot, time);
    status = find_focus(shot, settings, depths, &focus, reason);
    if (status == REFOCUS_OK)
        status = find_blur(settings, depths, photo->width, &blur, reason);
    shot->limited = blur > most_blur(settings);
    blur = (float)fmin(blur, most_blur(settings));
    if (status == REFOCUS_OK)
        status = fit(shot, settings, photo, blur, reason);
    if (status == REFOCUS_OK)
        status = fit_aperture(shot, settings, reason);
    if (status != REFOCUS_OK)
        return status;
    if (settings->place_edges)
        scene.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
    params = params_of(shot, settings, focus, blur);
    params.thin.enabled = has_silhouettes(settings, photo);
    status = refocus_prepare_scene(shot->renderer, &scene);
    if (status == REFOCUS_OK)
        status = refocus_render_settings(shot->renderer, &params, out);
    if (status == REFOCUS_OK) {
        shot->begun = true;
        shot->cut = false;
    }
    return status;
}

void rf_gst_shot_end(struct rf_gst_shot *shot)
{
    refocus_renderer_destroy(&shot->renderer);
    refocus_aperture_destroy(&shot->aperture);
    memset(shot, 0, sizeof *shot);
}
